"""Pictures: linear radiance with everything that a glare program needs to know about it."""

from collections.abc import Iterable
from os import PathLike
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.scattering import Floats
from sunpeak.scenes import View


class ExactSource(NamedTuple):
    """A sun disc in a picture, known exactly.

    Its pixels hold `radiance * visible_fraction * covered share of the pixel` on top of the rest.
    """

    direction: tuple[float, float, float]
    """Unit vector towards it, in world axes."""
    solid_angle_sr: float
    """Of the whole disc."""
    radiance: tuple[float, float, float]
    """Of the disc after transmission, three channels [W sr⁻¹ m⁻²]."""
    visible_fraction: float
    """Share of the disc that is not hidden [-]."""


class Picture:
    """Linear radiance in three channels [W sr⁻¹ m⁻²], top row first. Immutable."""

    def __init__(self, core: _core.Picture) -> None:
        """Wrap the compiled picture; users call `load`, `of` or `sunpeak.render`."""
        self._core = core

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a Radiance picture (RGBE or XYZE); `EXPOSURE` and `COLORCORR` are undone."""
        return cls(_core.Picture.load(path))

    @classmethod
    def of(
        cls,
        pixels: npt.ArrayLike,
        view: View | None = None,
        *,
        header: Iterable[str] = (),
        exact_sources: Iterable[ExactSource] = (),
    ) -> Self:
        """Make a picture of radiances (h, w, 3) [W sr⁻¹ m⁻²]."""
        array = np.ascontiguousarray(pixels, dtype=np.float32)
        if array.ndim != 3:
            raise _core.InputError(f"pixels: expected the shape (h, w, 3), found {array.shape}")
        rows = [[*s.direction, s.solid_angle_sr, *s.radiance, s.visible_fraction] for s in exact_sources]
        sources = np.array(rows, dtype=np.float64).reshape(-1, 8)
        return cls(_core.Picture.from_pixels(array, None if view is None else view._core, list(header), sources))

    def save(self, path: str | PathLike[str]) -> None:
        """Write a Radiance picture (run-length RGBE), whole or not at all."""
        self._core.save(path)

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width."""
        return self._core.shape

    @property
    def pixels(self) -> npt.NDArray[np.float32]:
        """Radiances (h, w, 3) [W sr⁻¹ m⁻²]."""
        return self._core.pixels()

    def luminance(self) -> Floats:
        """Luminance of each pixel (h, w) [cd/m²]."""
        return self._core.luminance()

    @property
    def view(self) -> View | None:
        """How directions are laid on it; `None` if it does not say."""
        view = self._core.view
        return None if view is None else View(view)

    @property
    def header(self) -> list[str]:
        """Lines of the header that are not said otherwise (`view`, `exact_sources`, exposure)."""
        return self._core.header

    @property
    def exact_sources(self) -> list[ExactSource]:
        """Suns seen through peaks, through glass, in mirrors or directly."""
        return [ExactSource((r[0], r[1], r[2]), r[3], (r[4], r[5], r[6]), r[7]) for r in self._core.sources().tolist()]

    @property
    def error(self) -> float | None:
        """What the renderer stated: the error of the luminance of blocks of about 3 degrees (root mean square, over the
        mean luminance of all) [-] is below this with 95 % confidence; `None` of other pictures, and of too few paths.
        """
        words = " ".join(line for line in self.header if line.startswith("SUNPEAK_RENDER=")).split()
        stated = [word.removeprefix("error=") for word in words if word.startswith("error=")]
        return float(stated[-1]) if stated else None

    @property
    def block_errors(self) -> Floats | None:
        """Standard errors of the luminance of blocks of pixels (rows, columns) [cd/m²], where known; the blocks are
        squares of a power of two of pixels, about 3 degrees wide.
        """
        found = self._core.block_errors()
        return None if found is None else found[0]

    def __repr__(self) -> str:
        height, width = self.shape
        return f"<Picture {width} x {height}, view {self.view}>"
