"""View options, and the size of a picture."""

from collections.abc import Sequence

from sunpeak import _core


def view_of(words: Sequence[str]) -> _core.View:
    """Give the view of options as words; what they leave out is as in Radiance."""
    return _core.View.parse_words(list(words))


def picture_size(view: _core.View, width: int, height: int, pixel_aspect: float) -> tuple[int, int]:
    """Give the largest picture within limits whose pixels are so many times as high as wide; 0 keeps the limits."""
    if pixel_aspect <= 0.0:
        return width, height
    # Rows over columns.
    shape = view.aspect / pixel_aspect
    if shape * width > height:
        return max(int(height / shape + 0.5), 1), height
    return width, max(int(width * shape + 0.5), 1)
