"""Daylight through shades and blinds that are known by their BSDF, and how much they glare.

Directions are unit vectors; world axes are Radiance's (x east, y north, z up), lengths in metres. Radiances have three
channels in Radiance's primaries [W sr⁻¹ m⁻²]; luminance [cd/m²] = 179 (0.265 R + 0.670 G + 0.065 B).
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from sunpeak._core import InputError, __version__

if TYPE_CHECKING:
    from sunpeak.blinds import Blind
    from sunpeak.bsdf_plot import plot_bsdf
    from sunpeak.bsdf_report import BsdfReport
    from sunpeak.bsdf_verdict import Verdict
    from sunpeak.comfort import glare
    from sunpeak.expressions import evaluate
    from sunpeak.fabrics import Fabric, RollerBlind
    from sunpeak.formulas import Formula
    from sunpeak.generation import GeneratedBsdf, GeneratedSide, generate_bsdf, straight_transmittance
    from sunpeak.glare_report import GlareReport, GlareSource, ZoneLuminances
    from sunpeak.glare_rules import GlareRules, RulesName, Task
    from sunpeak.measurement import MeasuredBsdf, MeasuredPart, Scan, measured_bsdf, read_scans
    from sunpeak.panes import Pane
    from sunpeak.pictures import ExactSource, Picture
    from sunpeak.rendering import World, render, trace
    from sunpeak.runs import Run
    from sunpeak.scattering import Bsdf, Evidence, Samples, direction, side_of_ray
    from sunpeak.scene_check import SceneCheck, check_scene
    from sunpeak.scenes import Rays, Scene, View
    from sunpeak.sheets import ExpandedMesh, Perforated
    from sunpeak.skies import Place, Sky, SunPosition, sun_position
    from sunpeak.systems import Shade, Straight, System

__all__ = [
    "Blind",
    "Bsdf",
    "BsdfReport",
    "Evidence",
    "ExactSource",
    "ExpandedMesh",
    "Fabric",
    "Formula",
    "GeneratedBsdf",
    "GeneratedSide",
    "GlareReport",
    "GlareRules",
    "GlareSource",
    "InputError",
    "MeasuredBsdf",
    "MeasuredPart",
    "Pane",
    "Perforated",
    "Picture",
    "Place",
    "Rays",
    "RollerBlind",
    "RulesName",
    "Run",
    "Samples",
    "Scan",
    "Scene",
    "SceneCheck",
    "Shade",
    "Sky",
    "Straight",
    "SunPosition",
    "System",
    "Task",
    "Verdict",
    "View",
    "World",
    "ZoneLuminances",
    "__version__",
    "check_scene",
    "direction",
    "evaluate",
    "generate_bsdf",
    "glare",
    "measured_bsdf",
    "plot_bsdf",
    "read_scans",
    "render",
    "side_of_ray",
    "straight_transmittance",
    "sun_position",
    "trace",
]

_HOMES = {
    "Blind": "blinds",
    "plot_bsdf": "bsdf_plot",
    "BsdfReport": "bsdf_report",
    "Verdict": "bsdf_verdict",
    "glare": "comfort",
    "evaluate": "expressions",
    "Fabric": "fabrics",
    "RollerBlind": "fabrics",
    "Formula": "formulas",
    "GeneratedBsdf": "generation",
    "GeneratedSide": "generation",
    "generate_bsdf": "generation",
    "straight_transmittance": "generation",
    "GlareReport": "glare_report",
    "GlareSource": "glare_report",
    "ZoneLuminances": "glare_report",
    "GlareRules": "glare_rules",
    "RulesName": "glare_rules",
    "Task": "glare_rules",
    "MeasuredBsdf": "measurement",
    "MeasuredPart": "measurement",
    "Scan": "measurement",
    "measured_bsdf": "measurement",
    "read_scans": "measurement",
    "Pane": "panes",
    "ExactSource": "pictures",
    "Picture": "pictures",
    "World": "rendering",
    "render": "rendering",
    "trace": "rendering",
    "Run": "runs",
    "Bsdf": "scattering",
    "Evidence": "scattering",
    "Samples": "scattering",
    "direction": "scattering",
    "side_of_ray": "scattering",
    "SceneCheck": "scene_check",
    "check_scene": "scene_check",
    "Rays": "scenes",
    "Scene": "scenes",
    "View": "scenes",
    "ExpandedMesh": "sheets",
    "Perforated": "sheets",
    "Place": "skies",
    "Sky": "skies",
    "SunPosition": "skies",
    "sun_position": "skies",
    "Shade": "systems",
    "Straight": "systems",
    "System": "systems",
}
"""Where each name lives; a module is read when a name of it is first asked for, so that small commands start fast."""


def __getattr__(name: str) -> Any:
    """Give a public name, from the module that has it."""
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
