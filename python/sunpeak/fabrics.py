"""Fabrics of our own making: formulas in, an LBNL XML file out. What a table should give back is known exactly."""

import math
from dataclasses import dataclass
from os import PathLike

from sunpeak import _core
from sunpeak.files import write_text


@dataclass(frozen=True)
class Fabric:
    """An isotropic fabric, both sides alike: holes, a lobe around the straight direction, and a diffuse part."""

    openness: float = 0.02
    """Through transmittance at normal incidence [-]."""
    cut_off_deg: float = 68.0
    """Angle of incidence from which nothing goes straight through."""
    exponent: float = 0.6
    """Steepness of the fall towards the cut-off."""
    scattered: float = 0.06
    """Scattered transmittance, the same at every incidence [-]."""
    lobe_share: float = 0.4
    """Share of the scattered part in the lobe; the rest is diffuse [-]."""
    lobe_sigma: float = 0.25
    """Width of the Gaussian lobe on the disk of projected directions; 0.25 is 14 degrees."""
    reflectance: float = 0.35
    """Diffuse reflectance [-]."""

    def through(self, incidence_rad: float) -> float:
        """Through transmittance [-]: openness cos(90 deg incidence / cut-off) ^ exponent, nothing past the cut-off."""
        share = incidence_rad / math.radians(self.cut_off_deg)
        return self.openness * math.cos(math.pi / 2 * share) ** self.exponent if share < 1.0 else 0.0

    def write(self, path: str | PathLike[str], basis: str = "klems") -> None:
        """Tabulate by exact cell averages and write an LBNL XML file, whole or not at all.

        `basis` is `klems`, `klems-half`, `klems-quarter`, or an isotropic or anisotropic tensor tree by the number of
        its exiting cells: `t3-1024`, `t3-4096`, `t3-16384`, `t4-1024` …
        """
        write_text(
            path,
            _core.fabric_xml(
                basis,
                self.openness,
                self.cut_off_deg,
                self.exponent,
                self.scattered,
                self.lobe_share,
                self.lobe_sigma,
                self.reflectance,
            ),
        )
