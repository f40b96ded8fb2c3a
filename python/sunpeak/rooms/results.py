"""What an experiment finds, one case for each basis without and with peak extraction."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sunpeak.rooms.fabric import LABELS


@dataclass(frozen=True)
class Case:
    """One picture and its numbers."""

    basis: str
    peak: str
    ev_lux: float
    dgp: float
    dgp_interval: tuple[float, float]
    """95 % interval by the noise of the picture."""
    max_luminance_cd_m2: float
    seconds: float
    pixels: npt.NDArray[np.float32]
    """Radiances of the fisheye (h, w, 3) [W sr⁻¹ m⁻²]."""
    close_up: npt.NDArray[np.float32]
    """Radiances around the sun (h, w, 3) [W sr⁻¹ m⁻²]."""

    @property
    def name(self) -> str:
        """Stem of the files of this case."""
        return f"{self.basis}_{self.peak}"

    def row(self) -> dict[str, Any]:
        """Row of `table.json`."""
        return {
            "basis": self.basis,
            "peak": self.peak,
            "ev_lux": self.ev_lux,
            "dgp": self.dgp,
            "max_luminance_cd_m2": self.max_luminance_cd_m2,
            "seconds": round(self.seconds, 2),
        }


@dataclass(frozen=True)
class Pair:
    """A basis without and with peak extraction."""

    without: Case
    with_peak: Case

    @property
    def label(self) -> str:
        """How people call the basis."""
        return LABELS[self.without.basis]


def pairs(cases: list[Case]) -> list[Pair]:
    """Cases by basis, in their order."""
    found = {(case.basis, case.peak): case for case in cases}
    bases = dict.fromkeys(case.basis for case in cases)
    return [Pair(found[basis, "off"], found[basis, "split"]) for basis in bases]
