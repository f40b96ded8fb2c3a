"""The fabric of the demo: its through transmittance is a formula, so that what must come out is known."""

import math
from pathlib import Path

from sunpeak import _core
from sunpeak.files import write_text

OPENNESS = 0.02
"""Through transmittance at normal incidence [-]."""

CUT_OFF_DEG = 68.0
"""Angle of incidence from which nothing goes straight through."""

EXPONENT = 0.6
"""Shape of the fall towards the cut-off."""

SCATTERED = 0.015
"""Scattered transmittance [-]: a dark fabric, whose yarns let little light through."""

LOBE_SHARE = 0.4
"""Share of the scattered part in a lobe around the straight direction; the rest is diffuse."""

LOBE_SIGMA = 0.25
"""Width of the lobe on the disk of projected directions: 14 degrees."""

REFLECTANCE = 0.1
"""Diffuse reflectance of both sides [-]."""

BASES = ("klems", "t3-1024", "t3-4096", "t3-16384")
"""Klems' 145 patches, and isotropic tensor trees by their number of cells."""


def through_transmittance(incidence_rad: float) -> float:
    """Through transmittance [-]: openness cos(90 deg incidence / cut-off) ^ exponent, and nothing past the cut-off."""
    share = incidence_rad / math.radians(CUT_OFF_DEG)
    return OPENNESS * math.cos(math.pi / 2 * share) ** EXPONENT if share < 1.0 else 0.0


def write_fabric(folder: Path, basis: str) -> Path:
    """Tabulate the fabric by exact cell averages and write it as an LBNL XML file."""
    text = _core.fabric_xml(basis, OPENNESS, CUT_OFF_DEG, EXPONENT, SCATTERED, LOBE_SHARE, LOBE_SIGMA, REFLECTANCE)
    path = folder / f"fabric_{basis}.xml"
    write_text(path, text)
    return path
