"""The peak study as tables in Markdown."""

from collections.abc import Callable
from functools import partial

from sunpeak.studies.markdown import Column, table_of
from sunpeak.studies.peaks import Row

RULES = {
    "split": "split",
    "paper": "rule 1 (paper)",
    "radiance": "rule 2 (ours)",
    "Radiance": "rule 2 (Radiance itself)",
}

PARTS = {
    "fabrics": (
        "Fabrics of the family",
        "Openness 1 to 5 %, cut-off 60 to 72°, exponent 0.5 to 0.8; random directions up to 90 % of the cut-off.",
    ),
    "steep": ("Steep fabrics", "The same with exponents of 1.3 to 2.1, as roller blinds have them."),
    "products": ("Other products that one can see through", "Directions where T is at least a fifth of its largest."),
    "decoys": (
        "Products that one cannot see through",
        "Share of the directions in which something is taken. A basis can tell a lobe from a delta from two cells on.",
    ),
    "counted": (
        "Counted rays",
        "A virtual goniophotometer with so many rays for each incident cell. *Counting*: what the counting of the "
        "straight rays alone would give, the mean of sqrt(2 (1 - T) / (pi n T)). *False peaks*: on a Lambertian "
        "product.",
    ),
    "blurred": (
        "Peaks that an instrument has widened",
        "A fabric of 2 % openness. *Unsaid*: as if computed. *Given*, *found*: with `--instrument-fwhm`.",
    ),
    "scatterers": (
        "Scatterers as wide as an instrument",
        "Panels whose lobe keeps its width on the disk of directions: `find` must leave them alone.",
    ),
}


def percent(value: float) -> str:
    """Three digits."""
    return f"{100.0 * value:.3g} %"


def error_and_misses(row: Row, rule: str) -> str:
    """`1.2 %, 3 missed`."""
    score = row.scores.get(rule)
    if score is None:
        return "-"
    missed = f", {score.missed} missed" if score.missed else ""
    return percent(score.error) + missed


def taken(row: Row, rule: str) -> str:
    """Share of the directions."""
    score = row.scores.get(rule)
    return "-" if score is None else f"{100.0 * score.taken / row.directions:.0f} %"


def degrees(value: float | None) -> str:
    """A width, or none."""
    return "none" if value is None else f"{value:.2f}°"


def rule_columns(cell: Callable[[Row, str], str]) -> list[Column[Row]]:
    """A column for each rule."""
    return [(title, partial(swapped, cell, rule)) for rule, title in RULES.items()]


def swapped(cell: Callable[[Row, str], str], rule: str, row: Row) -> str:
    """One rule's cell of a row."""
    return cell(row, rule)


NAME: Column[Row] = ("product", lambda row: row.product)
BASIS: Column[Row] = ("basis", lambda row: row.basis)
HOLDS: Column[Row] = ("interval holds T", lambda row: "-" if row.holds is None else f"{100.0 * row.holds:.1f} %")
ACCURACY: list[Column[Row]] = [NAME, BASIS, *rule_columns(error_and_misses), HOLDS]

COLUMNS: dict[str, list[Column[Row]]] = {
    "fabrics": ACCURACY,
    "steep": ACCURACY,
    "products": ACCURACY,
    "decoys": [
        NAME,
        BASIS,
        ("cells at normal incidence", lambda row: f"{row.more['cells_at_normal']:.2g}"),
        *rule_columns(taken),
    ],
    "counted": [
        BASIS,
        ("rays", lambda row: f"{row.more['rays']}"),
        ("split", lambda row: error_and_misses(row, "split")),
        ("rule 2 (ours)", lambda row: error_and_misses(row, "radiance")),
        ("counting", lambda row: percent(row.more["counting"])),
        HOLDS,
        ("false peaks", lambda row: percent(row.more["false_peaks"])),
    ],
    "blurred": [
        BASIS,
        ("FWHM", lambda row: degrees(row.more["fwhm_deg"])),
        ("split, unsaid", lambda row: error_and_misses(row, "split")),
        ("rule 2 (ours)", lambda row: error_and_misses(row, "radiance")),
        ("split, given", lambda row: error_and_misses(row, "given")),
        ("split, found", lambda row: error_and_misses(row, "found")),
        ("FWHM found", lambda row: degrees(row.more["found_deg"])),
    ],
    "scatterers": [NAME, BASIS, ("FWHM found", lambda row: degrees(row.more["found_deg"]))],
}


def markdown(rows: list[Row]) -> str:
    """All parts, one table each: mean error of T and misses."""
    parts = []
    for part, (title, about) in PARTS.items():
        chosen = [row for row in rows if row.part == part]
        if chosen:
            parts.append(f"## {title}\n\n{about}\n\n{table_of(COLUMNS[part], chosen)}\n")
    return "\n".join(parts)
