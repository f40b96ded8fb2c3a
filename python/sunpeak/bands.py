"""Files with a visible and a solar band, and the exact split beside them."""

from os import PathLike

from sunpeak.scattering import Bsdf


def write_bands(
    visible: Bsdf,
    solar: Bsdf | None,
    path: str | PathLike[str],
    split: str | PathLike[str] | None = None,
    comments: str | None = None,
) -> None:
    """Write an LBNL XML file of one or both bands, whole or not at all; the visible one's split to a folder."""
    if split is not None:
        visible.save_split(split)
    visible.save(path, solar=solar, comments=comments)
