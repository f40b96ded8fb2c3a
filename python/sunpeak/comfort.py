"""Glare numbers of a picture."""

from typing import Literal

from sunpeak import _core
from sunpeak.glare_report import GlareReport, GlareSource, ZoneLuminances
from sunpeak.glare_rules import (
    PEAK_CD_M2,
    SEARCH_ANGLE_RAD,
    THRESHOLD_CD_M2,
    BelowSight,
    DgpFit,
    GlareRules,
    RulesName,
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


def glare(
    picture: Picture,
    *,
    rules: RulesName | GlareRules = "sunpeak",
    threshold_cd_m2: float | None = None,
    threshold_times_mean: float | None = None,
    threshold_times_task: tuple[float, Task] | None = None,
    search_angle_rad: float | None = None,
    peak_cd_m2: float | Literal["rules"] | None = "rules",
    ev_lux: float | None = None,
    low_light: bool = False,
    below_sight: BelowSight | None = None,
    dgp_fit: DgpFit | None = None,
    least_solid_angle_sr: float | None = None,
    task: Task | None = None,
    source_distance_m: float | None = None,
    tolerance_through: float = 0.0,
    tolerance_sky: float = 0.0,
    tolerance_position_deg: float = 0.0,
    relative_error: float = 0.0,
) -> GlareReport:
    """Find the glare sources in a fisheye picture and compute the daylight glare probability [1] and its siblings.

    Exact sources of the picture leave their pixels and count with their own size. `rules` is a set of answers to what
    the publications leave open; each can be stated apart:

    - A pixel may glare above `threshold_cd_m2` (2000 unless told otherwise), or above a multiple of the mean luminance
      of the field of view or of a task zone.
    - Glaring pixels within half of `search_angle_rad` of each other (0.2 rad) are one source.
    - Pixels above `peak_cd_m2` (50 000 cd/m²) are sources of their own; `None`: they stay in the larger one.
    - `below_sight` is the position index below the line of sight, `dgp_fit` the coefficients of DGP.
    - Smaller sources than `least_solid_angle_sr` count as if they had it, with as much less luminance [3].

    `ev_lux` states the vertical illuminance instead of taking it from the picture (with a simplified picture that is
    the *enhanced simplified* DGP, `report.edgps`). `low_light` multiplies `dgp` by the factor for dim scenes [2].
    `task` is the zone for `report.zones`. `source_distance_m` is how far away sources are, for UGR of small ones.

    A picture that we rendered knows its statistical error, from which `report.sampling_intervals` follow; for others
    `relative_error` states a standard error that Ev and the sources share. `tolerance_through` (of the through
    transmittance or openness of what suns are seen through, relative), `tolerance_sky` (of sky and sun, relative) and
    `tolerance_position_deg` (of where sources stand in the field of view) are half-widths of 95 % intervals of what
    goes in; `report.input_intervals` say what they do. The class is "undecided" where both together span a border.

    [1] Wienold and Christoffersen 2006, Energy and Buildings 38(7).
    [2] Wienold 2012, "New features of evalglare", 11th International Radiance Workshop.
    [3] Lighting Research & Technology 2025, doi 10.1177/14771535251314413.
    """
    chosen = rules if isinstance(rules, GlareRules) else rules_named(rules)
    options = chosen_options(
        chosen,
        threshold_cd_m2=threshold_cd_m2,
        threshold_times_mean=threshold_times_mean,
        threshold_times_task=threshold_times_task,
        search_angle_rad=search_angle_rad,
        peak_cd_m2=peak_cd_m2,
        below_sight=below_sight,
        dgp_fit=dgp_fit,
        task=task,
    )
    options |= {
        "ev_lux": ev_lux,
        "low_light": low_light,
        "least_solid_angle_sr": least_solid_angle_sr,
        "source_distance_m": source_distance_m,
        "tolerance_through": tolerance_through,
        "tolerance_sky": tolerance_sky,
        "tolerance_position_deg": tolerance_position_deg,
        "relative_error": relative_error,
    }
    found = _core.glare(picture._core, options)
    sources = [GlareSource(**source) for source in found.pop("sources")]
    zones = ZoneLuminances(**found.pop("zones"))
    return GlareReport(**found, zones=zones, sources=sources)
