"""Daylight through shades and blinds that are known by their BSDF, and how much they glare.

Directions are unit vectors; world axes are Radiance's (x east, y north, z up), lengths in metres. Radiances have three
channels in Radiance's primaries [W sr⁻¹ m⁻²]; luminance [cd/m²] = 179 (0.265 R + 0.670 G + 0.065 B).
"""

from sunpeak._core import InputError, __version__
from sunpeak.scattering import Bsdf, Samples, direction
from sunpeak.skies import Place, Sky, SunPosition, sun_position

__all__ = [
    "Bsdf",
    "InputError",
    "Place",
    "Samples",
    "Sky",
    "SunPosition",
    "__version__",
    "direction",
    "sun_position",
]
