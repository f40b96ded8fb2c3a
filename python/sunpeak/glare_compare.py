"""Why did a glare number change? DGP of two pictures, term by term and source by source."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from sunpeak.glare_report import GlareReport, GlareSource

SAME_SOURCE_DEG = 6.0
"""Sources nearer to each other than this (0.1 rad, half of the search angle) are the same one in both pictures."""

NOTABLE = 0.02
"""Relative change of a luminance, solid angle or position index that is worth a word."""


@dataclass(frozen=True)
class SourceChange:
    """A source in one picture or both."""

    before: GlareSource | None
    after: GlareSource | None

    @property
    def dgp_change(self) -> float:
        """What it adds to the change of DGP."""
        return (self.after.dgp_part if self.after else 0.0) - (self.before.dgp_part if self.before else 0.0)

    @property
    def what(self) -> str:
        """What differs, in words."""
        if self.before is None or self.after is None:
            return "new" if self.before is None else "gone"
        changes = [
            relative(name, getattr(self.before, key), getattr(self.after, key))
            for name, key in (("luminance", "luminance_cd_m2"), ("size", "solid_angle_sr"), ("P", "position_index"))
        ]
        if self.before.exact != self.after.exact:
            changes.append("exact now" if self.after.exact else "pixels now")
        return ", ".join(change for change in changes if change) or "same"


@dataclass(frozen=True)
class GlareComparison:
    """The change of DGP and what it is made of: `ev_change`, that of each source, and `other_change`."""

    before: GlareReport
    after: GlareReport
    ev_change: float
    """By the term of the vertical illuminance."""
    sources: list[SourceChange]
    """The largest change first."""

    @property
    def dgp_change(self) -> float:
        """DGP afterwards less DGP before."""
        return self.after.dgp - self.before.dgp

    @property
    def other_change(self) -> float:
        """By other coefficients, the low-light factor or the upper limit of 1."""
        return self.dgp_change - self.ev_change - sum(source.dgp_change for source in self.sources)

    def to_dict(self) -> dict[str, Any]:
        """As one JSON object."""
        return {
            "dgp_before": self.before.dgp,
            "dgp_after": self.after.dgp,
            "dgp_change": self.dgp_change,
            "ev_lux_before": self.before.ev_lux,
            "ev_lux_after": self.after.ev_lux,
            "ev_change": self.ev_change,
            "other_change": self.other_change,
            "sources": [asdict(s) | {"dgp_change": s.dgp_change, "what": s.what} for s in self.sources],
        }


def compare(before: GlareReport, after: GlareReport) -> GlareComparison:
    """Compare two reports: sources within 6 degrees of each other are paired, the nearest first."""
    pairs = sorted(
        (angle_deg(a, b), i, j)
        for i, a in enumerate(before.sources)
        for j, b in enumerate(after.sources)
        if angle_deg(a, b) < SAME_SOURCE_DEG
    )
    partner: dict[int, int] = {}
    for _, i, j in pairs:
        if i not in partner and j not in partner.values():
            partner[i] = j
    after_of = {i: after.sources[j] for i, j in partner.items()}
    changes = [SourceChange(source, after_of.get(i)) for i, source in enumerate(before.sources)]
    changes += [SourceChange(None, b) for j, b in enumerate(after.sources) if j not in partner.values()]
    changes.sort(key=lambda change: -abs(change.dgp_change))
    return GlareComparison(before, after, after.dgp_ev_term - before.dgp_ev_term, changes)


def angle_deg(a: GlareSource, b: GlareSource) -> float:
    """Angle between two sources; what is exact in one picture may be pixels in the other."""
    return float(np.degrees(np.arccos(np.clip(np.dot(a.direction, b.direction), -1, 1))))


def relative(name: str, before: float, after: float) -> str:
    """Say `luminance x 2.3`, or nothing."""
    ratio = after / before
    return "" if abs(ratio - 1) < NOTABLE else f"{name} × {ratio:.3g}"
