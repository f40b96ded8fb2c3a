"""Glare numbers of a picture."""

from typing import Unpack

from sunpeak import _core
from sunpeak.glare_report import GlareReport, GlareSource, ZoneLuminances
from sunpeak.glare_rules import (
    PEAK_CD_M2,
    SEARCH_ANGLE_RAD,
    THRESHOLD_CD_M2,
    BelowSight,
    GlareRules,
    RulesName,
    Stated,
    Task,
    chosen_options,
    rules_named,
)
from sunpeak.pictures import Picture

__all__ = [
    "PEAK_CD_M2",
    "SEARCH_ANGLE_RAD",
    "THRESHOLD_CD_M2",
    "BelowSight",
    "GlareReport",
    "GlareSource",
    "Task",
    "glare",
]


def glare(picture: Picture, *, rules: RulesName | GlareRules = "sunpeak", **stated: Unpack[Stated]) -> GlareReport:
    """Find the glare sources in a fisheye picture and compute the daylight glare probability [1] and its siblings.

    Exact sources of the picture leave their pixels and count with their own size. `rules` is a set of answers to what
    the publications leave open; each can be stated apart:

    - A pixel may glare above `threshold_cd_m2` (2000 unless told otherwise), above `threshold_times_mean`, a multiple
      of the mean luminance of the field of view, or `threshold_times_task`, a multiple of that of a task zone.
    - Glaring pixels within half of `search_angle_rad` of each other (0.2 rad) are one source.
    - Pixels above `peak_cd_m2` (50 000 cd/m²) are sources of their own; `None`: they stay in the larger one.
    - `below_sight` is the position index below the line of sight, `dgp_fit` the coefficients of DGP.
    - Smaller sources than `least_solid_angle_sr` count as if they had it, with as much less luminance: one number, not
      the one by position that [3] proposes.

    `ev_lux` states the vertical illuminance instead of taking it from the picture (with a simplified picture that is
    the *enhanced simplified* DGP, `report.edgps`). `low_light` multiplies `dgp` by the factor for dim scenes [2].
    `task` is the zone for `report.zones`. `source_distance_m` is how far away sources are, for UGR of small ones.

    A picture that we rendered knows its statistical error, from which `report.sampling_intervals` follow; for others
    `relative_error` states a standard error that Ev and the sources share. `tolerance_through` (of the through
    transmittance or openness of what suns are seen through, relative), `tolerance_sky` (of sky and sun, relative) and
    `tolerance_position_deg` (of where sources stand in the field of view) are half-widths of 95 % intervals of what
    goes in; `report.input_intervals` say what they do. The class is "undecided" where both together span a border.

    `sunpeak.glare_rules.Stated` lists all names and their types.

    [1] Wienold and Christoffersen 2006, Energy and Buildings 38(7).
    [2] Wienold 2012, "New features of evalglare", 11th International Radiance Workshop.
    [3] Lighting Research & Technology 2025, doi 10.1177/14771535251314413.
    """
    chosen = rules if isinstance(rules, GlareRules) else rules_named(rules)
    found = _core.glare(picture._core, chosen_options(chosen, **stated))
    sources = [GlareSource(**source) for source in found.pop("sources")]
    zones = ZoneLuminances(**found.pop("zones"))
    return GlareReport(**found, zones=zones, sources=sources)
