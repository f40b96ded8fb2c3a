"""Daylight through shades and blinds that are known by their BSDF, and how much they glare.

Directions are unit vectors; world axes are Radiance's (x east, y north, z up), lengths in metres. Radiances have three
channels in Radiance's primaries [W sr⁻¹ m⁻²]; luminance [cd/m²] = 179 (0.265 R + 0.670 G + 0.065 B).
"""

from sunpeak._core import InputError, __version__
from sunpeak.blinds import Blind
from sunpeak.bsdf_plot import plot_bsdf
from sunpeak.bsdf_report import BsdfReport
from sunpeak.bsdf_verdict import Verdict
from sunpeak.comfort import glare
from sunpeak.expressions import evaluate
from sunpeak.fabrics import Fabric
from sunpeak.glare_report import GlareReport, GlareSource, ZoneLuminances
from sunpeak.glare_rules import GlareRules, RulesName, Task
from sunpeak.pictures import ExactSource, Picture
from sunpeak.rendering import World, render, trace
from sunpeak.scattering import Bsdf, Evidence, Samples, direction, side_of_ray
from sunpeak.scenes import Rays, Scene, View
from sunpeak.skies import Place, Sky, SunPosition, sun_position

__all__ = [
    "Blind",
    "Bsdf",
    "BsdfReport",
    "Evidence",
    "ExactSource",
    "Fabric",
    "GlareReport",
    "GlareRules",
    "GlareSource",
    "InputError",
    "Picture",
    "Place",
    "Rays",
    "RulesName",
    "Samples",
    "Scene",
    "Sky",
    "SunPosition",
    "Task",
    "Verdict",
    "View",
    "World",
    "ZoneLuminances",
    "__version__",
    "direction",
    "evaluate",
    "glare",
    "plot_bsdf",
    "render",
    "side_of_ray",
    "sun_position",
    "trace",
]
