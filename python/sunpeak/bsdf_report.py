"""The report on a BSDF: what it resolves, whether it is sound, and what peak extraction makes of it.

Sides are those that rays meet, `front` or `back`; theta counts from that side's normal unless it is said that it
counts from the front normal (above 90 from behind); phi, from x, is the azimuth towards which the ray runs, as in
`sunpeak.side_of_ray`. Numbers come from the compiled core, words from here.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal, NamedTuple

from sunpeak import _core
from sunpeak.bsdf_verdict import Verdict, verdict

Side = Literal["front", "back"]

MATRIX_BANDS = ("Visible", "CIE-X", "CIE-Z")
TREE_BANDS = ("Visible", "CIE-u", "CIE-v")
"""Bands that are read, where a file has colour; without colour it is `Visible` alone."""

ENERGY_TOLERANCE = 1e-3
"""How far reflectance and transmittance may add up past 1 [-]: numbers with three digits do that."""

SUMMED_POINTS_TOLERANCE = 1e-2
"""The same where a tensor tree is met by reciprocity, and summed over points instead of its own cells."""

RECIPROCITY_TOLERANCE = 0.05
"""Mean difference [-] between one way and the other that is worth a word. Our choice: ray-traced tables of fine bases
stay below it."""


class Spread(NamedTuple):
    """Mean over azimuth, least and largest."""

    mean: float
    min: float
    max: float


class Angle(NamedTuple):
    """Hemispherical values at one angle of incidence [-], peak included."""

    theta_deg: float
    transmittance: Spread
    reflectance: Spread


class Through(NamedTuple):
    """Through transmittance in one direction [-], and what the data allow."""

    theta_deg: float
    phi_deg: float
    through: float
    low: float
    high: float


@dataclass(frozen=True)
class TableReport:
    """One table as rays meet it."""

    mode: Literal["transmission", "reflection"]
    side: Side
    basis: str
    incident_cells: int
    """Columns: the finest incident division."""
    values: int
    smallest_cell_sr: float
    """Projected solid angle."""
    smallest_cell_deg: float
    """Square root of the smallest exiting cell's solid angle."""
    isotropic: bool
    colour: bool
    by_reciprocity: bool
    """The table is the other side's."""

    @property
    def bands(self) -> tuple[str, ...]:
        """What is read of the file."""
        if not self.colour:
            return MATRIX_BANDS[:1]
        return TREE_BANDS if self.basis.startswith("TensorTree") else MATRIX_BANDS


@dataclass(frozen=True)
class SideReport:
    """Hemispherical values of one side, and whether more light leaves than came."""

    side: Side
    angles: list[Angle]
    """From 0 to 80 degrees."""
    largest_sum: float
    """Largest transmittance plus reflectance [-]."""
    largest_sum_at_deg: tuple[float, float]
    """Where: theta from the front normal, phi of the ray."""
    share_above_one: float
    """Share of the incidences, by projected solid angle, where the sum is above 1."""
    exact: bool
    """Sums over the table's own cells; else over points (a tensor tree that is met by reciprocity)."""

    @property
    def is_sound(self) -> bool:
        """No more light leaves than came, but for rounding."""
        return self.largest_sum <= 1.0 + (ENERGY_TOLERANCE if self.exact else SUMMED_POINTS_TOLERANCE)


@dataclass(frozen=True)
class Reciprocity:
    """Helmholtz reciprocity: values one way against values the other."""

    compared: Literal["transmission", "through", "reflection front", "reflection back"]
    """The smooth part of transmission, T(w) from the front against T(-w) from the back, the reflections."""
    mean_difference: float
    """Sum of the differences over the sum of the larger values [-]."""
    largest_difference: float
    """Over the larger value, or over the mean value where that is more [-]."""
    largest_at_deg: tuple[float, float, float, float]
    """Where: theta (from the front normal) and azimuth of `w_in`, of `w_out`, as in `sunpeak.direction`."""
    by_construction: bool
    """One table serves both directions."""

    @property
    def holds(self) -> bool:
        """Within what measurements and cell averages do."""
        return self.mean_difference <= RECIPROCITY_TOLERANCE


@dataclass(frozen=True)
class PeakSide:
    """What the split does for rays that meet one side."""

    side: Side
    columns: int
    columns_with_peak: int
    share_of_incidences: float
    """Share of the incidences, by projected solid angle, where a peak is taken."""
    openness: float
    """T at normal incidence [-]: of a fabric its openness factor."""
    openness_interval: tuple[float, float]
    """What the data allow."""
    detection_limit: float
    """What a peak at normal incidence must exceed to be taken [-]."""
    extracted_share_diffuse: float
    """Share of the transmitted flux that goes straight, under a uniform sky."""
    extracted_share_normal: float
    """The same at normal incidence."""
    contrast_min: float | None
    """Flux of the peak over the flux of the scattered light in its cells, over the columns with a peak; may be
    infinite."""
    contrast_median: float | None
    narrowest_lobe_deg: float
    """The narrowest lobe that this basis can tell from a delta, at normal incidence: full width at tenth maximum."""
    narrowest_lobe_range_deg: tuple[float, float]
    """The same over the columns with a peak (over all, where there is none)."""
    taken_between_deg: tuple[float, float] | None
    """Least and largest theta at which a peak is taken."""
    last_angle_deg: tuple[float, float] | None
    """Largest theta by azimuth: its least and its largest value."""
    share_between: float
    """Share of the directions between the first and the last theta of each azimuth with a peak: 1 without gaps."""
    columns_at_edge: int
    """Incident cells within which the peak ends, across a cut-off or at grazing incidence: there T is open."""
    through: list[Through]
    """T by direction; one azimuth where the table is isotropic."""

    @property
    def fires(self) -> bool:
        """A peak is taken somewhere."""
        return self.columns_with_peak > 0

    @property
    def verdict(self) -> Verdict:
        """Whether to use peak extraction on this product, and why."""
        return verdict(self)


@dataclass(frozen=True)
class BsdfReport:
    """All of it."""

    tables: list[TableReport]
    sides: list[SideReport]
    reciprocity: list[Reciprocity]
    peaks: list[PeakSide]
    """Only sides that transmit."""

    def peak(self, side: Side) -> PeakSide | None:
        """What the split does on a side, if anything is transmitted there."""
        return next((peak for peak in self.peaks if peak.side == side), None)

    def warnings(self) -> list[str]:
        """What is not as physics has it."""
        return [
            *(energy_warning(side) for side in self.sides if not side.is_sound),
            *(reciprocity_warning(check) for check in self.reciprocity if not check.holds),
        ]

    def to_dict(self) -> dict[str, Any]:
        """As one JSON object; infinite contrasts are null."""
        return {
            "tables": [{**asdict(table), "bands": table.bands} for table in self.tables],
            "hemispherical": {
                side.side: [
                    {
                        "theta_deg": angle.theta_deg,
                        "transmittance": angle.transmittance._asdict(),
                        "reflectance": angle.reflectance._asdict(),
                    }
                    for angle in side.angles
                ]
                for side in self.sides
            },
            "energy": {
                side.side: {
                    "largest_sum": side.largest_sum,
                    "at_deg": side.largest_sum_at_deg,
                    "share_above_one": side.share_above_one,
                    "sound": side.is_sound,
                }
                for side in self.sides
            },
            "reciprocity": [{**asdict(check), "holds": check.holds} for check in self.reciprocity],
            "peak": {peak.side: peak_dict(peak) for peak in self.peaks},
            "warnings": self.warnings(),
        }


def peak_dict(peak: PeakSide) -> dict[str, Any]:
    """One side as a JSON object."""
    about = {key: value if finite(value) else None for key, value in asdict(peak).items() if key != "side"}
    about["through"] = [row._asdict() for row in peak.through]
    return {"fires": peak.fires, "use": peak.verdict.use, "verdict": peak.verdict.text, **about}


def finite(value: Any) -> bool:
    """JSON has neither NaN nor infinity."""
    return not isinstance(value, float) or math.isfinite(value)


def energy_warning(side: SideReport) -> str:
    """More light leaves than came."""
    theta, phi = side.largest_sum_at_deg
    return (
        f"{side.side}: reflectance and transmittance add up to {side.largest_sum:.4f} at {place(theta, phi)}"
        f"; they are above 1 in {100 * side.share_above_one:.2g} % of the incidences"
    )


def reciprocity_warning(check: Reciprocity) -> str:
    """One way differs from the other."""
    what = {
        "transmission": "scattered transmission from the front and from the back",
        "through": "straight transmission from the front and from the back",
        "reflection front": "reflection at the front",
        "reflection back": "reflection at the back",
    }[check.compared]
    there, back = place(*check.largest_at_deg[:2]), place(*check.largest_at_deg[2:])
    return (
        f"{what}: one way differs from the other by {100 * check.mean_difference:.0f} % in the mean, most "
        f"({100 * check.largest_difference:.0f} %) between {there} and {back}"
    )


def place(theta_deg: float, phi_deg: float) -> str:
    """A direction in whole degrees."""
    return f"theta {theta_deg:.0f}, phi {round(phi_deg) % 360} degrees"


def report_on(core: _core.Bsdf) -> BsdfReport:
    """Ask the core."""
    numbers = _core.bsdf_report(core)
    return BsdfReport(
        tables=[TableReport(**table) for table in numbers["tables"]],
        sides=[SideReport(**{**side, "angles": angles(side), **pair(side)}) for side in numbers["sides"]],
        reciprocity=[
            Reciprocity(**{**check, "largest_at_deg": tuple(check["largest_at_deg"])})
            for check in numbers["reciprocity"]
        ],
        peaks=[peak_side(peak) for peak in numbers["peaks"]],
    )


def angles(side: dict[str, Any]) -> list[Angle]:
    """Hemispherical values with their names."""
    return [Angle(theta, Spread(*passes), Spread(*reflected)) for theta, passes, reflected in side["angles"]]


def pair(side: dict[str, Any]) -> dict[str, tuple[float, ...]]:
    """Where the sum is largest."""
    return {"largest_sum_at_deg": tuple(side["largest_sum_at_deg"])}


def peak_side(peak: dict[str, Any]) -> PeakSide:
    """One side of the split, its pairs as tuples."""
    through = [Through(*row) for row in peak["through"]]
    pairs = {key: tuple(value) for key, value in peak.items() if isinstance(value, list) and key != "through"}
    return PeakSide(**{**peak, **pairs, "through": through})
