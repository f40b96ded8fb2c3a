"""Glare numbers of a picture."""

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal, NamedTuple

from sunpeak import _core
from sunpeak.pictures import Picture

THRESHOLD_CD_M2 = 2000.0
"""Above which a pixel may glare (Pierson, Wienold, Bodart 2018, Buildings 8(8))."""

SEARCH_ANGLE_RAD = 0.2
"""Opening angle within which glaring pixels are one source, as evalglare."""

PEAK_CD_M2 = 50_000.0
"""Pixels above this are sources of their own, as evalglare."""

BelowSight = Literal["iwata-osterhaus", "iwata-tokura"]
"""Position index below the line of sight."""


class Task(NamedTuple):
    """A round zone of the field of view where the task is."""

    direction: tuple[float, float, float]
    """Unit vector towards its middle, in world axes."""
    opening_deg: float
    """Full angle."""


@dataclass(frozen=True)
class GlareSource:
    """One source of glare."""

    direction: tuple[float, float, float]
    """Unit vector towards it, in world axes."""
    solid_angle_sr: float
    luminance_cd_m2: float
    position_index: float
    illuminance_lux: float
    """What it gives at the eye."""
    weight: float
    """Its part of DGP's sum, L² ω / P²."""
    exact: bool
    """Whether it was known exactly, not found in the pixels."""
    pixels: int


@dataclass(frozen=True)
class GlareReport:
    """What was found in a picture."""

    dgp: float
    """Daylight glare probability [-]."""
    dgp_interval: tuple[float, float]
    """95 % confidence interval of `dgp` by the stated error; twice `dgp` if none was stated."""
    dgp_low_light_corrected: float
    """DGP times the factor for dim scenes."""
    glare_class: str
    """imperceptible, perceptible, disturbing or intolerable."""
    ev_lux: float
    """Vertical illuminance at the eye."""
    ev_sources_lux: float
    """Part of it from the glare sources."""
    max_luminance_cd_m2: float
    """Brightest pixel or exact source."""
    mean_luminance_cd_m2: float
    background_cd_m2: float
    threshold_cd_m2: float
    """Above which a pixel counted as glaring."""
    rule: str
    """How sources were found."""
    warnings: list[str]
    sources: list[GlareSource]
    """The worst first."""

    def to_dict(self) -> dict[str, Any]:
        """As one JSON object."""
        return asdict(self)


def glare(
    picture: Picture,
    *,
    threshold_cd_m2: float | None = None,
    threshold_times_mean: float | None = None,
    threshold_times_task: tuple[float, Task] | None = None,
    search_angle_rad: float = SEARCH_ANGLE_RAD,
    peak_cd_m2: float | None = PEAK_CD_M2,
    ev_lux: float | None = None,
    low_light: bool = False,
    below_sight: BelowSight = "iwata-osterhaus",
    relative_error: float = 0.0,
) -> GlareReport:
    """Find the glare sources in a fisheye picture and compute the daylight glare probability [1].

    Exact sources of the picture leave their pixels and count with their own size. A pixel may glare above
    `threshold_cd_m2` (2000 unless told otherwise), or above a multiple of the mean luminance of the field of view or of
    a task zone. `low_light` multiplies `dgp` by the factor for dim scenes [2]. `relative_error` is the picture's
    standard error, from which the interval follows.

    [1] Wienold and Christoffersen 2006, Energy and Buildings 38(7).
    [2] Wienold 2012, "Dynamic daylight glare evaluation".
    """
    given = [value for value in (threshold_cd_m2, threshold_times_mean, threshold_times_task) if value is not None]
    if len(given) > 1:
        raise _core.InputError("threshold: several kinds are given; expected one")
    task = None
    value, kind = threshold_cd_m2 or THRESHOLD_CD_M2, "luminance"
    if threshold_times_mean is not None:
        value, kind = threshold_times_mean, "mean"
    elif threshold_times_task is not None:
        value, kind = threshold_times_task[0], "task"
        zone = threshold_times_task[1]
        task = (zone.direction, math.radians(zone.opening_deg))
    found = _core.glare(
        picture._core,
        value,
        kind,
        task,
        search_angle_rad,
        peak_cd_m2,
        ev_lux,
        low_light,
        below_sight,
        relative_error,
    )
    sources = [GlareSource(**source) for source in found.pop("sources")]
    return GlareReport(**found, sources=sources)
