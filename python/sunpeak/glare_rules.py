"""Rules of a glare evaluation: what the publications leave open, with the answers that tools give.

An older number can be understood by asking for its rules again.
"""

import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Self

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
pixels' lower left corners."""

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


def threshold_options(
    rules: GlareRules,
    task: Task | None,
    cd_m2: float | None,
    times_mean: float | None,
    times_task: float | None,
) -> dict[str, Any]:
    """The threshold for the compiled core: what is stated, otherwise that of the rules."""
    if cd_m2 is not None:
        return {"threshold": cd_m2, "threshold_kind": "luminance"}
    if times_mean is not None:
        return {"threshold": times_mean, "threshold_kind": "mean"}
    if times_task is not None:
        return {"threshold": times_task, "threshold_kind": "task"}
    if rules.threshold_times_mean is not None:
        return {"threshold": rules.threshold_times_mean, "threshold_kind": "mean" if task is None else "task"}
    return {"threshold": rules.threshold_cd_m2, "threshold_kind": "luminance"}


def chosen_options(
    rules: GlareRules,
    *,
    threshold_cd_m2: float | None = None,
    threshold_times_mean: float | None = None,
    threshold_times_task: tuple[float, Task] | None = None,
    search_angle_rad: float | None = None,
    peak_cd_m2: float | Literal["rules"] | None = "rules",
    below_sight: BelowSight | None = None,
    dgp_fit: DgpFit | None = None,
    task: Task | None = None,
) -> dict[str, Any]:
    """How sources are found, for the compiled core: what is stated, otherwise what the rules say."""
    given = [value for value in (threshold_cd_m2, threshold_times_mean, threshold_times_task) if value is not None]
    if len(given) > 1:
        raise _core.InputError("threshold: several kinds are given; expected one")
    times_task = None
    if threshold_times_task is not None:
        times_task, task = threshold_times_task[0], task or threshold_times_task[1]
    return {
        **threshold_options(rules, task, threshold_cd_m2, threshold_times_mean, times_task),
        "task": None if task is None else (task.direction, math.radians(task.opening_deg)),
        "search_angle_rad": rules.search_angle_rad if search_angle_rad is None else search_angle_rad,
        "peak_cd_m2": rules.peak_cd_m2 if peak_cd_m2 == "rules" else peak_cd_m2,
        "below_sight": below_sight or rules.below_sight,
        "up_as_given": rules.up_as_given,
        "dgp_fit": dgp_fit or rules.dgp_fit,
        "centre": rules.centre,
    }


def rules_named(name: str) -> GlareRules:
    """Give the rules of that name."""
    for known, rules in RULES.items():
        if known == name:
            return rules
    raise _core.InputError(f"rules: {name!r}; expected one of {', '.join(RULES)}")
