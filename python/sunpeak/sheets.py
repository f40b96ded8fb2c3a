"""Sheets of metal with openings, by their geometry: what goes straight through in closed form."""

import math
from dataclasses import dataclass
from os import PathLike
from typing import Literal

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.bands import UNLABELLED, Label, write_bands
from sunpeak.runs import UNWATCHED, Run
from sunpeak.scattering import Bsdf, Floats, rows

Pattern = Literal["square", "triangular"]
"""Holes at the corners of squares, or of equilateral triangles (staggered by 60 degrees)."""


class _Sheet:
    """What both have: tabulated, written, asked for its closed form."""

    _kind: str
    thickness_mm: float

    def _numbers(self) -> dict[str, float]:
        raise NotImplementedError

    def through(self, w_in: npt.ArrayLike) -> Floats:
        """Through transmittance [-] for light from `w_in` (n, 3), in closed form."""
        return np.asarray(_core.synthetic_through(self._kind, self._numbers(), rows(w_in)))

    def bsdf(self, basis: str = "klems", *, run: Run = UNWATCHED) -> Bsdf:
        """Tabulate by exact cell averages; what goes straight through is kept as its closed form has it."""
        with run.watching("averaging over cells") as watch:
            return Bsdf(_core.exact_bsdf(self._kind, self._numbers(), basis, *watch))

    def write(
        self,
        path: str | PathLike[str],
        basis: str = "klems",
        *,
        split: str | PathLike[str] | None = None,
        label: Label = UNLABELLED,
        run: Run = UNWATCHED,
    ) -> None:
        """Write an LBNL XML file of what `bsdf` gives, whole or not at all; bases as for `Fabric.write`.

        `split` names a folder for the exact straight part beside the rest, which `Bsdf.load` reads.
        """
        lengths = ", ".join(f"{name} {value:g}" for name, value in vars(self).items() if name.endswith("_mm"))
        comments = f"{type(self).__name__} sheet in closed form, exact means over cells: {lengths}"
        thick = label if label.thickness_m is not None else label._replace(thickness_m=self.thickness_mm / 1e3)
        write_bands(self.bsdf(basis, run=run), None, path, split, comments=comments, label=thick)


@dataclass(frozen=True)
class Perforated(_Sheet):
    """Round holes through a sheet. Light that meets the walls of the holes is lost; the sheet reflects diffusely."""

    diameter_mm: float
    """Diameter of the holes [mm]."""
    pitch_mm: float
    """Distance of the middles of neighbouring holes [mm]."""
    thickness_mm: float
    """Thickness of the sheet [mm]."""
    pattern: Pattern = "triangular"
    """How the holes are arranged."""
    reflectance: float = 0.5
    """Diffuse reflectance of the sheet itself [-]."""
    _kind = "perforated"

    def open_area(self) -> float:
        """Share of the area that is holes [-]."""
        if not (0.0 < self.diameter_mm < self.pitch_mm and math.isfinite(self.pitch_mm)):
            raise _core.InputError(
                f"perforated sheet: holes of {self.diameter_mm} mm, {self.pitch_mm} mm apart; expected them to fit "
                "beside each other"
            )
        cell = self.pitch_mm**2 * (1.0 if self.pattern == "square" else math.sqrt(3.0) / 2.0)
        return math.pi * self.diameter_mm**2 / 4.0 / cell

    def _numbers(self) -> dict[str, float]:
        return {
            "open_area": self.open_area(),
            "thickness": self.thickness_mm / self.diameter_mm,
            "from_walls": 0.0,
            "reflectance": self.reflectance,
        }


@dataclass(frozen=True)
class ExpandedMesh(_Sheet):
    """Flattened expanded metal: rhombic openings with upright walls, their long way along x (horizontal).

    Light that meets the walls is lost; the strands reflect diffusely. Strands that stand oblique, as before flattening,
    are not what this is.
    """

    long_way_mm: float
    """From the middle of a knuckle to that of the next, the long way (LWD) [mm]."""
    short_way_mm: float
    """The same the short way (SWD) [mm]."""
    strand_mm: float
    """Width of the strands in the plane of the sheet [mm]."""
    thickness_mm: float
    """Thickness of the sheet [mm]."""
    reflectance: float = 0.5
    """Diffuse reflectance of the strands [-]."""
    _kind = "mesh"

    def _numbers(self) -> dict[str, float]:
        return {
            "long_way": self.long_way_mm,
            "short_way": self.short_way_mm,
            "strand": self.strand_mm,
            "thickness": self.thickness_mm,
            "reflectance": self.reflectance,
        }
