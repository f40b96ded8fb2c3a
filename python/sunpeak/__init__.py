"""Daylight through shades and blinds that are known by their BSDF, and how much they glare.

Directions are unit vectors; world axes are Radiance's (x east, y north, z up), lengths in metres. Radiances have three
channels in Radiance's primaries [W sr⁻¹ m⁻²]; luminance [cd/m²] = 179 (0.265 R + 0.670 G + 0.065 B).
"""

from sunpeak._core import InputError, __version__

__all__ = ["InputError", "__version__"]
