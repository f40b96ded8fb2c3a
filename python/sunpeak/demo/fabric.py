"""The fabric of the demo: its through transmittance is a formula, so that what must come out is known."""

import math

OPENNESS = 0.02
"""Through transmittance at normal incidence [-]."""

CUT_OFF_DEG = 68.0
"""Angle of incidence from which nothing goes straight through."""

EXPONENT = 0.6
"""Shape of the fall towards the cut-off, as of the fabrics of Ward et al. 2021."""

BASES = ("klems", "t3-1024", "t3-4096", "t3-16384")
"""Klems' 145 patches, and isotropic tensor trees by their largest number of cells."""


def through_transmittance(incidence_rad: float) -> float:
    """Through transmittance [-]: openness cos(90 deg incidence / cut-off) ^ exponent, and nothing past the cut-off."""
    share = incidence_rad / math.radians(CUT_OFF_DEG)
    return OPENNESS * math.cos(math.pi / 2 * share) ** EXPONENT if share < 1.0 else 0.0
