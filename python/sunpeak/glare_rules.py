"""Rules of a glare evaluation: what the publications leave open, with the answers that tools give.

An older number can be understood by asking for its rules again.
"""

import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Self, TypedDict, Unpack

import numpy as np

from sunpeak import _core
from sunpeak.scenes import View

THRESHOLD_CD_M2 = 2000.0
"""Above which a pixel may glare (Pierson, Wienold, Bodart 2018, Buildings 8(8))."""

SEARCH_ANGLE_RAD = 0.2
"""Opening angle within which glaring pixels are one source, as evalglare."""

PEAK_CD_M2 = 50_000.0
"""Pixels above this are sources of their own, as evalglare."""

BelowSight = Literal["evalglare-3", "iwata-osterhaus", "iwata-tokura"]
"""Position index below the line of sight: as evalglare 3.06; as at the side (Iwata and Osterhaus 2010); rings around
the line of sight (Iwata and Tokura 1997 in Einhorn's form). Above it is always Levin's fit of 1975 to the data of
Luckiesh and Guth."""

DgpFit = Literal["published", "evalglare-3"]
"""Coefficients of DGP: 5.87e-5, 9.18e-2, 0.16 (Wienold and Christoffersen 2006), or with the 9.2e-2 and 0.159 that
evalglare 3.06 shows."""

Centre = Literal["angular", "sphere", "evalglare-3"]
"""Middle of a source: centre of gravity on the angular fisheye around the line of sight, whatever the picture's kind;
the mean direction of its light; or, as evalglare 3.06 does, the centre of gravity on the picture itself, of the
pixels' lower left corners, then the middle of the pixel in which it lies."""

RulesName = Literal["sunpeak", "evalglare-3", "wienold-2006"]


class Task(NamedTuple):
    """A round zone of the field of view where the task is."""

    direction: tuple[float, float, float]
    """Unit vector towards its middle, in world axes."""
    opening_deg: float
    """Full angle."""

    @classmethod
    def at(cls, view: View | None, right_deg: float, up_deg: float, opening_deg: float) -> Self:
        """Zone at angles from the line of sight of a view: azimuth to the right, then elevation."""
        if view is None:
            raise _core.InputError("task: the picture has no view; expected VIEW= in its header")
        forward = view.direction / np.linalg.norm(view.direction)
        right = np.cross(forward, view.up)
        right /= np.linalg.norm(right)
        azimuth, elevation = np.radians([right_deg, up_deg])
        ahead = np.cos(azimuth) * forward + np.sin(azimuth) * right
        x, y, z = (np.cos(elevation) * ahead + np.sin(elevation) * np.cross(right, forward)).tolist()
        return cls((x, y, z), opening_deg)


@dataclass(frozen=True)
class GlareRules:
    """How sources are found and weighted."""

    threshold_cd_m2: float | None = THRESHOLD_CD_M2
    """A pixel above this may glare; `None` where the threshold is a multiple of a mean."""
    threshold_times_mean: float | None = None
    """Or above so many times the mean of the task zone, if there is one, otherwise of the field of view."""
    search_angle_rad: float = SEARCH_ANGLE_RAD
    peak_cd_m2: float | None = PEAK_CD_M2
    below_sight: BelowSight = "evalglare-3"
    up_as_given: bool = False
    """Whether the view's up vector is taken as it is: not made perpendicular to the line of sight (evalglare 3.06)."""
    dgp_fit: DgpFit = "published"
    centre: Centre = "angular"


RULES: dict[RulesName, GlareRules] = {
    "sunpeak": GlareRules(),
    "evalglare-3": GlareRules(up_as_given=True, dgp_fit="evalglare-3", centre="evalglare-3"),
    "wienold-2006": GlareRules(
        threshold_cd_m2=None, threshold_times_mean=5.0, peak_cd_m2=None, below_sight="iwata-tokura"
    ),
}
"""`sunpeak`: evalglare 3's way to find sources, DGP as published. `evalglare-3`: its coefficients, middles of sources
and vertical too. `wienold-2006`: the publication of DGP: 5 times the mean of the task zone, nothing split off,
Einhorn's position index below the line of sight."""


class Stated(TypedDict, total=False):
    """What can be stated apart from the rules; what is not there, or `None`, is as the rules have it."""

    threshold_cd_m2: float | None
    """A pixel above this may glare (2000 cd/m² unless told otherwise)."""
    threshold_times_mean: float | None
    """Or above so many times the mean luminance of the field of view."""
    threshold_times_task: tuple[float, Task] | None
    """Or above so many times the mean luminance of a task zone."""
    search_angle_rad: float | None
    """Glaring pixels within half of it of each other (0.2 rad) are one source."""
    peak_cd_m2: float | Literal["rules"] | None
    """Pixels above this (50 000 cd/m²) are sources of their own; `None`: they stay in the larger one."""
    below_sight: BelowSight | None
    """Position index below the line of sight."""
    dgp_fit: DgpFit | None
    """Coefficients of DGP."""
    task: Task | None
    """Zone for `report.zones`."""
    least_solid_angle_sr: float | None
    """Smaller sources count as if they had it, with as much less luminance [3]."""
    ev_lux: float | None
    """Vertical illuminance, instead of taking it from the picture (with a simplified picture that is the *enhanced
    simplified* DGP, `report.edgps`)."""
    low_light: bool
    """Whether `dgp` is multiplied by the factor for dim scenes [2]."""
    source_distance_m: float | None
    """How far away sources are, for UGR of small ones."""
    tolerance_through: float
    """Half-width of a 95 % interval of the transmittance or openness of what suns are seen through, relative."""
    tolerance_sky: float
    """The same of sky and sun, relative."""
    tolerance_position_deg: float
    """The same of where sources stand in the field of view."""
    relative_error: float
    """Standard error that Ev and the sources share, for a picture that does not know its own."""


OF_RULES = ("search_angle_rad", "below_sight", "dgp_fit")
"""What is stated or as the rules have it."""

PASSED_ON = (
    "least_solid_angle_sr",
    "ev_lux",
    "low_light",
    "source_distance_m",
    "tolerance_through",
    "tolerance_sky",
    "tolerance_position_deg",
    "relative_error",
)
"""What the rules say nothing about."""


def chosen_options(rules: GlareRules, **stated: Unpack[Stated]) -> dict[str, Any]:
    """All options for the compiled core: what is stated, otherwise what the rules say."""
    unknown = stated.keys() - Stated.__annotations__.keys()
    if unknown:
        raise TypeError(f"glare: unknown {', '.join(sorted(unknown))}; expected {', '.join(Stated.__annotations__)}")
    known: dict[str, Any] = {name: value for name, value in stated.items() if value is not None}
    task = known.get("task") or known.get("threshold_times_task", (None, None))[1]
    peak = stated.get("peak_cd_m2", "rules")
    return {
        **threshold_options(rules, task, known),
        "task": None if task is None else (task.direction, math.radians(task.opening_deg)),
        "peak_cd_m2": rules.peak_cd_m2 if peak == "rules" else peak,
        "up_as_given": rules.up_as_given,
        "centre": rules.centre,
        **{name: known.get(name, getattr(rules, name)) for name in OF_RULES},
        **{name: known[name] for name in PASSED_ON if name in known},
    }


def threshold_options(rules: GlareRules, task: Task | None, known: dict[str, Any]) -> dict[str, Any]:
    """The threshold for the compiled core: what is stated, otherwise that of the rules."""
    given: list[tuple[float, str]] = []
    if "threshold_cd_m2" in known:
        given.append((known["threshold_cd_m2"], "luminance"))
    if "threshold_times_mean" in known:
        given.append((known["threshold_times_mean"], "mean"))
    if "threshold_times_task" in known:
        given.append((known["threshold_times_task"][0], "task"))
    if len(given) > 1:
        raise _core.InputError("threshold: several kinds are given; expected one")
    if not given and rules.threshold_times_mean is not None:
        given.append((rules.threshold_times_mean, "mean" if task is None else "task"))
    value, kind = given[0] if given else (rules.threshold_cd_m2, "luminance")
    return {"threshold": value, "threshold_kind": kind}


def rules_named(name: str) -> GlareRules:
    """Give the rules of that name."""
    for known, rules in RULES.items():
        if known == name:
            return rules
    raise _core.InputError(f"rules: {name!r}; expected one of {', '.join(RULES)}")
