"""What a glare evaluation found."""

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class GlareSource:
    """One source of glare."""

    direction: tuple[float, float, float]
    """Unit vector towards it, in world axes."""
    angle_to_sight_deg: float
    """Of its middle from the line of sight."""
    solid_angle_sr: float
    luminance_cd_m2: float
    position_index: float
    illuminance_lux: float
    """What it gives at the eye."""
    weight: float
    """Its part of DGP's sum, L² ω / P²."""
    dgp_part: float
    """Its share of DGP's contrast term, in proportion to `weight` [-]."""
    exact: bool
    """Whether it was known exactly, not found in the pixels."""
    pixels: int


@dataclass(frozen=True)
class ZoneLuminances:
    """Mean luminances of zones of the field of view; `None` for those that are not in the picture.

    Ergorama and panorama are cones of 60 and 120 degrees around the line of sight (Meyer, Francioli and Kerhoven 1996).
    """

    task_cd_m2: float | None
    """Of the task, if its place was stated."""
    ergorama_cd_m2: float | None
    """Of the ergorama without the task."""
    panorama_cd_m2: float | None
    """Of the panorama without the ergorama and the task."""
    periphery_cd_m2: float | None
    """Of the rest."""

    def ratios_to_task(self) -> dict[str, float]:
        """Luminances over that of the task (1:3:10 is the usual limit); without a task over that of the ergorama."""
        base = self.task_cd_m2 or self.ergorama_cd_m2
        known = {name.removesuffix("_cd_m2"): value for name, value in asdict(self).items() if value is not None}
        return {name: value / base for name, value in known.items()} if base else {}


@dataclass(frozen=True)
class GlareReport:
    """What was found in a picture. Ratings are `None` where their equation has no value, mostly for want of sources."""

    dgp: float
    """Daylight glare probability [-] (Wienold and Christoffersen 2006)."""
    dgp_interval: tuple[float, float]
    """95 % confidence interval of `dgp` by the picture's statistical error; twice `dgp` if that is not known."""
    sampling_intervals: dict[str, tuple[float, float]] | None
    """95 % intervals of `dgp`, `ev_lux` and each rating by the picture's statistical error, if that is known."""
    input_intervals: dict[str, tuple[float, float]] | None
    """The same by the stated tolerances of what goes in."""
    class_probabilities: dict[str, float]
    """Probability of each class by both [-]."""
    verdict: str
    """The class if the whole interval of DGP by both lies in it, otherwise "undecided"."""
    dgp_low_light_corrected: float
    """DGP times the factor for dim scenes (Wienold 2012)."""
    dgp_in_range: bool
    """Whether Ev (380 lx or more) and DGP (0.2 to 0.8) lie where DGP was derived."""
    dgp_offset: float
    """DGP without light; DGP is this plus the next two."""
    dgp_ev_term: float
    """Part of DGP from the vertical illuminance."""
    dgp_contrast_term: float
    """Part of DGP from the contrast of the sources; `dgp_part` of each source adds up to it."""
    glare_class: str
    """imperceptible, perceptible, disturbing or intolerable."""
    ev_lux: float
    """Vertical illuminance at the eye."""
    ev_sources_lux: float
    """Part of it from the glare sources."""
    dgps: float
    """Simplified DGP, from Ev alone [-] (Wienold 2009)."""
    edgps: float | None
    """Enhanced simplified DGP [-] (Wienold 2009): DGP where Ev was stated."""
    dgi: float | None
    """Daylight glare index [-] (Hopkinson 1972)."""
    dgi_modified: float | None
    """DGI with the adaptation luminance (Fisekis et al. 2003)."""
    ugr: float | None
    """Unified glare rating [-] (CIE 117:1995)."""
    ugr_small_source: float | None
    """UGR with the extension for small sources [-] (CIE 147:2002); needs `source_distance_m`."""
    ugp: float | None
    """Unified glare probability [-] (Hirning et al. 2014)."""
    ugp_2017: float | None
    """The same from 0 to 1 (Hirning et al. 2017)."""
    cgi: float | None
    """CIE glare index [-] (Einhorn 1979)."""
    vcp: float | None
    """Visual comfort probability [%] (IES)."""
    dgr: float | None
    """Discomfort glare rating [-], from which VCP follows."""
    pgsv: float | None
    """Predicted glare sensation vote by contrast [-] (Tokura et al. 1996)."""
    pgsv_saturation: float
    """The same by saturation [-]."""
    veiling_luminance_cd_m2: float
    """Equivalent veiling luminance (CIE 146:2002)."""
    max_luminance_cd_m2: float
    """Brightest pixel or exact source."""
    mean_luminance_cd_m2: float
    """Over the solid angle of the field of view."""
    median_luminance_cd_m2: float
    """That half of the solid angle exceeds."""
    background_cd_m2: float
    """(Ev - Ev of the sources) / pi."""
    threshold_cd_m2: float
    """Above which a pixel counted as glaring."""
    rule: str
    """How sources were found."""
    warnings: list[str]
    zones: ZoneLuminances
    """Mean luminances by zone."""
    sources: list[GlareSource]
    """The worst first."""

    def to_dict(self) -> dict[str, Any]:
        """As one JSON object."""
        return asdict(self)
