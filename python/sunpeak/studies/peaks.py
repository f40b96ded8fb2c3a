"""Peak extraction against products whose through transmittance is known, rule by rule, basis by basis."""

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from sunpeak import _core
from sunpeak.scattering import Bsdf, Floats
from sunpeak.studies.products import EXACT, Product, Seen, decoys, fabric, fabrics, panel, see_through
from sunpeak.studies.radiance_through import through_by_radiance

FABRIC_BASES = ("t3-16384", "t3-4096", "t3-1024", "t4-1024", "klems", "klems-half", "klems-quarter")
NOISY = Seen(value_noise=0.15 / 16.0)
"""256 rays a cell with 15 % noise each: 0.94 % of each value."""
COUNTED_BASES = ("klems", "t3-4096")
RAYS = (100, 1000, 10_000, 100_000)
BLURS_DEG = (0.5, 1.0, 2.0, 5.0)
MEASURED_BASES = ("klems", "t3-1024", "t3-4096", "t4-1024")
DECOY_BASES = ("klems", "klems-quarter", "t3-1024", "t3-4096", "t4-1024")

TELLS = 0.2
"""Directions with less than this share of the largest T are left out: next to a cut-off everybody errs."""


@dataclass(frozen=True)
class Plan:
    """How much of it."""

    fabrics: int = 6
    directions: int = 200
    radiance: bool = True
    """Ask Radiance itself as well, where pyradiance is installed."""


@dataclass
class Score:
    """One rule on one product in one basis."""

    error: float
    """Mean of |T / truth - 1| [-]."""
    worst: float
    missed: int
    """Directions in which nothing was taken though something goes through."""
    taken: int
    """Directions in which something was taken."""


@dataclass
class Row:
    """One product, or some of a family, in one basis."""

    part: str
    product: str
    basis: str
    directions: int
    scores: dict[str, Score]
    """By rule: `split`, `paper`, `radiance` (ours), `Radiance` (the program)."""
    holds: float | None = None
    """Share of the directions in which the split's interval holds the truth."""
    more: dict[str, Any] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


Progress = Callable[[int, int], None]


def run_peaks(plan: Plan, progress: Progress | None = None) -> list[Row]:
    """All of the study."""
    jobs = list(all_jobs(plan))
    rows = []
    for number, job in enumerate(jobs):
        if progress:
            progress(number, len(jobs))
        rows.append(job())
    return rows


def all_jobs(plan: Plan) -> Iterator[Callable[[], Row]]:
    """The rows, to be made one after the other."""
    family, steep = fabrics(plan.fabrics), fabrics(plan.fabrics, steep=True)
    for basis in FABRIC_BASES:
        yield partial(measure, plan, "fabrics", "fabrics of the family", family, basis)
    yield partial(measure, plan, "fabrics", "the same, values with 0.94 % noise", family, "t3-4096", seen=NOISY)
    for basis in FABRIC_BASES:
        yield partial(measure, plan, "steep", "fabrics, steep", steep, basis)
    for product in see_through():
        for basis in ("klems", "t3-4096", "t4-1024") if product.isotropic else ("klems", "t4-1024"):
            yield partial(measure, plan, "products", product.name, [product], basis)
    for product in decoys():
        for basis in DECOY_BASES:
            yield partial(decoy, plan, product, basis)
    for basis in COUNTED_BASES:
        for rays in RAYS:
            yield partial(counted, plan, basis, rays)
    for basis in MEASURED_BASES:
        for width in BLURS_DEG:
            yield partial(blurred, plan, basis, width)
            yield partial(scatterer, basis, width)


def measure(plan: Plan, part: str, name: str, products: list[Product], basis: str, *, seen: Seen = EXACT) -> Row:
    """All rules against the truth."""
    found: dict[str, list[Floats]] = {}
    truths, inside = [], []
    for number, product in enumerate(products):
        bsdf = product.tabulate(basis, seen)
        w_in = product.directions(plan.directions, seed=number)
        truth = product.through(w_in)
        w_in = w_in[truth > TELLS * truth.max()] if part == "products" else w_in
        truth = product.through(w_in)
        truths.append(truth)
        low, high = bsdf.through_interval(w_in).T
        inside.append((low <= truth) & (truth <= high))
        for rule, values in by_rule(bsdf, w_in, radiance=plan.radiance).items():
            found.setdefault(rule, []).append(values)
    truth = np.concatenate(truths)
    scores = {rule: score(np.concatenate(values), truth) for rule, values in found.items()}
    return Row(part, name, basis, len(truth), scores, holds=float(np.concatenate(inside).mean()))


def by_rule(bsdf: Bsdf, w_in: Floats, *, radiance: bool) -> dict[str, Floats]:
    """T of each rule."""
    found = {rule: bsdf.through(w_in, rule) for rule in ("split", "paper", "radiance")}
    asked = through_by_radiance(bsdf, w_in) if radiance else None
    return found if asked is None else found | {"Radiance": asked}


def score(through: Floats, truth: Floats) -> Score:
    """Errors where something goes through."""
    passes = truth > 0.0
    off = np.abs(through[passes] / truth[passes] - 1.0)
    return Score(
        error=float(off.mean()) if len(off) else 0.0,
        worst=float(off.max()) if len(off) else 0.0,
        missed=int((through[passes] <= 0.0).sum()),
        taken=int((through > 0.0).sum()),
    )


def decoy(plan: Plan, product: Product, basis: str) -> Row:
    """What is taken from a product that one cannot see through; how wide its lobe is in cells."""
    bsdf = product.tabulate(basis)
    w_in = product.directions(plan.directions, seed=3)
    scores = {
        rule: score(values, np.zeros(len(w_in))) for rule, values in by_rule(bsdf, w_in, radiance=plan.radiance).items()
    }
    report = bsdf.peak_report().peak("front")
    assert report is not None
    assert product.tenth_width_deg is not None
    # The narrowest lobe that is told from a delta is two cells wide.
    cells = 2.0 * product.tenth_width_deg / report.narrowest_lobe_deg
    return Row("decoys", product.name, basis, len(w_in), scores, more={"cells_at_normal": cells})


def counted(plan: Plan, basis: str, rays: int) -> Row:
    """Counted rays: the fabrics' errors beside the counting's own, and what is taken from a Lambertian product."""
    row = measure(
        Plan(plan.fabrics, plan.directions, radiance=False),
        "counted",
        "fabrics of the family",
        fabrics(plan.fabrics),
        basis,
        seen=Seen(rays=rays),
    )
    lambertian = decoys()[0]
    noisy = lambertian.tabulate(basis, Seen(rays=rays))
    w_in = lambertian.directions(10 * plan.directions, seed=3)
    spread = []
    for number, product in enumerate(fabrics(plan.fabrics)):
        truth = product.through(product.directions(plan.directions, seed=number))
        # The mean of |x| of a normal number is sqrt(2 / pi) standard deviations.
        spread.append(np.sqrt(2.0 / np.pi * (1.0 - truth) / (rays * truth)))
    row.more = {
        "rays": rays,
        "counting": float(np.concatenate(spread).mean()),
        "false_peaks": float((noisy.through(w_in) > 0.0).mean()),
    }
    return row


def blurred(plan: Plan, basis: str, width_deg: float) -> Row:
    """A fabric seen by an instrument: T without a word, with the width given, and with the width found."""
    product = fabric("fabric 2 % open", 0.02, 68.0, 0.07)
    w_in = product.directions(plan.directions, seed=5)
    truth = product.through(w_in)
    with tempfile.TemporaryDirectory() as folder:
        xml = Path(folder, "blurred.xml")
        bsdf = product.tabulate(basis, Seen(fwhm_deg=width_deg))
        xml.write_text(_core.bsdf_xml(bsdf._core), encoding="utf-8")
        given = Bsdf.load(xml, instrument_fwhm_deg=width_deg)
        found = Bsdf.load(xml, instrument_fwhm_deg="find")
    scores = {
        "split": score(bsdf.through(w_in), truth),
        "radiance": score(bsdf.through(w_in, "radiance"), truth),
        "given": score(given.through(w_in), truth),
        "found": score(found.through(w_in), truth),
    }
    more = {"fwhm_deg": width_deg, "found_deg": found_width(found)}
    return Row("blurred", product.name, basis, len(w_in), scores, more=more)


def scatterer(basis: str, width_deg: float) -> Row:
    """A scatterer as wide at normal incidence, whose lobe grows with the incidence: no instrument may be found."""
    tenth_over_half = float(np.sqrt(np.log(10.0) / np.log(2.0)))
    product = panel(width_deg * tenth_over_half)
    with tempfile.TemporaryDirectory() as folder:
        xml = Path(folder, "panel.xml")
        xml.write_text(_core.bsdf_xml(product.tabulate(basis)._core), encoding="utf-8")
        found = Bsdf.load(xml, instrument_fwhm_deg="find")
    more = {"fwhm_deg": width_deg, "found_deg": found_width(found)}
    return Row("scatterers", f"panel of {width_deg:g}° FWHM", basis, 0, {}, more=more)


def found_width(bsdf: Bsdf) -> float | None:
    """Full width at half maximum of the instrument that was found [deg]."""
    return next(
        (part["instrument_fwhm_deg"] for part in bsdf.describe()["components"] if part["mode"] == "transmission"), None
    )
