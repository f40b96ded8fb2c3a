"""What is in a BSDF file, whether it is sound, and whether peak extraction will fire: the report of `bsdf info`."""

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from sunpeak.bsdf_report import BsdfReport, Side
from sunpeak.bsdf_verdict import NOTHING, Verdict
from sunpeak.scattering import Bsdf, Description, Floats, direction

SIDES: tuple[Side, Side] = ("front", "back")

ANGLES_DEG = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0)
"""Angles of incidence at which a file is looked at."""


@dataclass(frozen=True)
class Look:
    """One angle of incidence on one side, in the plane of incidence of x."""

    side: Side
    theta_deg: float
    transmittance: float
    reflectance: float
    through_split: float
    through_radiance: float
    through_paper: float
    cell_through: float | None
    contrast: float | None
    detection_limit: float | None
    through_low: float | None
    through_high: float | None


@dataclass(frozen=True)
class Inspection:
    """The report on a file."""

    file: str
    description: Description
    looks: list[Look]
    report: BsdfReport
    instrument_seen_deg: dict[Side, float | None]
    """Width of a lobe that looks like an instrument's, where none was stated: full width at half maximum."""

    def to_dict(self) -> dict[str, Any]:
        """As one JSON object; `warnings` are those of reading, `findings` those of the report."""
        about = self.report.to_dict()
        findings, peaks = about.pop("warnings"), about.pop("peak")
        return {
            "file": self.file,
            **self.description,
            "angles": [asdict(look) for look in self.looks],
            **about,
            "findings": [*findings, *self.hints()],
            "instrument_seen_deg": self.instrument_seen_deg,
            "peak": {side: peaks.get(side) or self.nothing() for side in SIDES},
        }

    def hints(self) -> list[str]:
        """What measured data may need."""
        return [
            f"{side}: a lobe of {width:.2g} degrees (full width at half maximum, the same at all incidences) follows "
            "the straight direction; if an instrument made it of a sharp beam, the peak is taken whole with "
            f"--instrument-fwhm {width:.2g}"
            for side, width in self.instrument_seen_deg.items()
            if width is not None
        ]

    def verdict(self, side: Side) -> Verdict:
        """Whether to use peak extraction for rays at a side, and why."""
        peak = self.report.peak(side)
        return peak.verdict if peak else NOTHING

    @staticmethod
    def nothing() -> dict[str, Any]:
        """A side without transmission."""
        return {"fires": False, "use": NOTHING.use, "verdict": NOTHING.text}


def inspect(file: str, instrument_fwhm_deg: float | Literal["find"] | None = None) -> Inspection:
    """Read a file and look at it from both sides; for measured data see `Bsdf.load`."""
    bsdf = Bsdf.load(file, instrument_fwhm_deg=instrument_fwhm_deg)
    looks = [look for side in SIDES for look in looks_at(bsdf, side)]
    stated = instrument_fwhm_deg is not None
    seen = {side: None if stated else bsdf.instrument_seen(side) for side in SIDES}
    return Inspection(file, bsdf.describe(), looks, bsdf.peak_report(), seen)


def looks_at(bsdf: Bsdf, side: Side) -> list[Look]:
    """Look from one side at each of the angles."""
    theta = np.array(ANGLES_DEG)
    w_in = incident(side, theta)
    evidence = bsdf.evidence(w_in)
    columns = [
        theta,
        bsdf.hemispherical(w_in, "transmission"),
        bsdf.hemispherical(w_in, "reflection"),
        bsdf.through(w_in, "split"),
        bsdf.through(w_in, "radiance"),
        bsdf.through(w_in, "paper"),
    ]
    seen = [evidence.through, evidence.contrast, evidence.detection_limit, evidence.low, evidence.high]
    return [
        Look(side, *(float(column[i]) for column in columns), *(known(column[i]) for column in seen))
        for i in range(len(theta))
    ]


def incident(side: Side, theta_deg: Floats) -> Floats:
    """Unit vectors at angles from the normal of a side, in the plane of x."""
    outward: Floats = direction(theta_deg) * np.array([1.0, 1.0, 1.0 if side == "front" else -1.0])
    return outward


def known(value: float) -> float | None:
    """JSON has neither NaN nor infinity."""
    return float(value) if np.isfinite(value) else None
