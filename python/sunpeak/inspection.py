"""What is in a BSDF file, whether it is sound, and whether peak extraction will fire: the report of `bsdf info`."""

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from sunpeak.scattering import Bsdf, Description, Floats, direction

ANGLES_DEG = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0)
"""Angles of incidence at which a file is looked at."""

SEARCH_STEP_DEG = 1.0
"""Step of the search for the last angle that lets something straight through."""

MANY_TIMES = 1000
"""Contrast from which the exact number tells nothing."""

Side = Literal["front", "back"]


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
    verdicts: dict[Side, str]

    def to_dict(self) -> dict[str, Any]:
        """As one JSON object."""
        return {
            "file": self.file,
            **self.description,
            "angles": [asdict(look) for look in self.looks],
            "peak": {side: {"fires": self.fires(side), "verdict": self.verdicts[side]} for side in self.verdicts},
        }

    def fires(self, side: Side) -> bool:
        """Whether the split takes a peak at any of the angles."""
        return any(look.through_split > 0 for look in self.looks if look.side == side)


def inspect(file: str) -> Inspection:
    """Read a file and look at it from both sides."""
    bsdf = Bsdf.load(file)
    looks = [look for side in ("front", "back") for look in looks_at(bsdf, side)]
    verdicts: dict[Side, str] = {
        side: verdict(bsdf, side, [look for look in looks if look.side == side]) for side in ("front", "back")
    }
    return Inspection(file, bsdf.describe(), looks, verdicts)


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


def verdict(bsdf: Bsdf, side: Side, looks: list[Look]) -> str:
    """Say in a sentence or two whether the peak is taken from this side, and why."""
    normal = looks[0]
    if normal.transmittance <= 0.0:
        return "nothing is transmitted, so there is no peak to extract"
    if not any(look.through_split > 0 for look in looks):
        limit = normal.detection_limit
        hidden = "" if limit is None else f"; at normal incidence a straight part below {limit:.4f} would stay hidden"
        return f"no peak: nothing stands above the scattered light around the straight direction{hidden}"
    theta = np.arange(0.0, 90.0, SEARCH_STEP_DEG)
    fires = bsdf.through(incident(side, theta), "split") > 0
    return f"the peak is taken {where(theta, fires)}; {strength(max(looks, key=lambda look: look.through_split))}"


def where(theta_deg: np.ndarray, fires: np.ndarray) -> str:
    """The angles that let something straight through."""
    if fires.all():
        return "at all angles"
    first, last = theta_deg[fires][0], theta_deg[fires][-1]
    gaps = "" if fires[(theta_deg >= first) & (theta_deg <= last)].all() else ", with gaps"
    return f"up to {last:g} degrees{gaps}" if first == 0 else f"from {first:g} to {last:g} degrees{gaps}"


def strength(look: Look) -> str:
    """How far the peak stands out where it is strongest, as a mean over the cell of incidence."""
    through = look.cell_through or 0.0
    if look.contrast is None:
        height = "nothing is scattered beside it"
    elif look.contrast > MANY_TIMES:
        height = f"more than {MANY_TIMES:g} times the scattered light under it"
    else:
        height = f"{look.contrast:.3g} times the scattered light under it"
    text = f"in the cell around {look.theta_deg:g} degrees T = {through:.4f}"
    if look.through_low is not None and look.through_high is not None:
        text += f" (the data allow {look.through_low:.4f} to {look.through_high:.4f})"
    return f"{text}, {100 * through / look.transmittance:.0f} % of all that passes and {height}"
