"""`sunpeak bsdf info` for people."""

from rich import box
from rich.console import Console
from rich.table import Table

from sunpeak.bsdf_report import BsdfReport, PeakSide, Reciprocity, SideReport
from sunpeak.inspection import SIDES, Inspection

COMPARED = {
    "transmission": "scattered transmission, front against back",
    "through": "straight transmission, front against back",
    "reflection front": "reflection at the front, there and back",
    "reflection back": "reflection at the back, there and back",
}


def show(inspection: Inspection) -> None:
    """Print the report."""
    console = Console(highlight=False)
    about, report = inspection.description, inspection.report
    console.print(f"[bold]{about['name'] or inspection.file}[/bold] {about['manufacturer']}".rstrip())
    console.print(f"{inspection.file}: {about['structure']}")
    for warning in about["warnings"]:
        console.print(f"[yellow]warning:[/yellow] {warning}", soft_wrap=True)
    for part in about["components"]:
        if part["instrument_fwhm_deg"] is not None:
            width = f"{part['instrument_fwhm_deg']:.2g} degrees"
            console.print(f"{part['side']}: the peak is taken as a beam that an instrument widened to {width}")
    console.print(tables(report))
    console.print(hemispherical(report))
    console.print(checks(report))
    for finding in [*report.warnings(), *inspection.hints()]:
        console.print(f"[yellow]warning:[/yellow] {finding}", soft_wrap=True)
    console.print(angles(inspection))
    for peak in report.peaks:
        if peak.fires:
            console.print(through(peak))
    for side in SIDES:
        verdict = inspection.verdict(side)
        answer = f"[bold]{side}: use peak extraction: {verdict.use}.[/bold]"
        console.print(f"{answer} Why: {verdict.text}.", soft_wrap=True)


def new_table(title: str, left: tuple[str, ...], right: tuple[str, ...] = ()) -> Table:
    """A table with columns of words and of numbers."""
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    for heading in left:
        table.add_column(heading)
    for heading in right:
        table.add_column(heading, justify="right")
    return table


def tables(report: BsdfReport) -> Table:
    """The file's parts."""
    table = new_table(
        "Tables, by the side that rays meet", ("side", "mode", "basis", "bands"), ("columns", "smallest cell")
    )
    for part in report.tables:
        table.add_row(
            part.side,
            part.mode + (" (by reciprocity)" if part.by_reciprocity else ""),
            part.basis + (" (isotropic)" if part.isotropic else ""),
            ", ".join(part.bands),
            str(part.incident_cells),
            f"{part.smallest_cell_deg:.2g}°, {part.smallest_cell_sr:.2g} sr",
        )
    return table


def hemispherical(report: BsdfReport) -> Table:
    """What passes and what is reflected, by angle of incidence."""
    headings = tuple(f"{side.side} {what}" for side in report.sides for what in ("passes", "reflects"))
    table = new_table("Hemispherical values, mean over azimuth", (), ("theta", *headings))
    for angles in zip(*(side.angles for side in report.sides), strict=True):
        values = [value.mean for angle in angles for value in (angle.transmittance, angle.reflectance)]
        table.add_row(f"{angles[0].theta_deg:g}°", *(f"{value:.4f}" for value in values))
    return table


def checks(report: BsdfReport) -> Table:
    """Energy and reciprocity."""
    table = new_table("Is it sound?", ("check", "result"), ("mean", "largest"))
    for side in report.sides:
        table.add_row(f"passes + reflected, {side.side}: at most 1", energy(side), "", f"{side.largest_sum:.4f}")
    for check in report.reciprocity:
        numbers = (check.mean_difference, check.largest_difference)
        table.add_row(COMPARED[check.compared], agreement(check), *(f"{100 * number:.1f} %" for number in numbers))
    return table


def energy(side: SideReport) -> str:
    """Whether more light leaves than came."""
    return "sound" if side.is_sound else "[yellow]too much light[/yellow]"


def agreement(check: Reciprocity) -> str:
    """Whether one way agrees with the other."""
    if check.by_construction:
        return "the same table"
    return "agrees" if check.holds else "[yellow]differs[/yellow]"


def angles(inspection: Inspection) -> Table:
    """Through transmittance by angle and rule."""
    table = new_table(
        "Through transmittance by rule, in the plane of x", ("side",), ("theta", "passes", "split", "radiance", "paper")
    )
    for look in inspection.looks:
        numbers = (look.transmittance, look.through_split, look.through_radiance, look.through_paper)
        table.add_row(look.side, f"{look.theta_deg:g}°", *(f"{number:.4f}" for number in numbers))
    return table


def through(peak: PeakSide) -> Table:
    """T by direction; of an isotropic table with what the data allow."""
    azimuths = sorted({row.phi_deg for row in peak.through})
    if len(azimuths) == 1:
        table = new_table(f"T of the split, {peak.side} (all azimuths)", (), ("theta", "T", "at least", "at most"))
        for row in peak.through:
            table.add_row(f"{row.theta_deg:g}°", *(f"{number:.4f}" for number in (row.through, row.low, row.high)))
        return table
    headings = ("theta", *(f"phi {phi:g}°" for phi in azimuths))
    table = new_table(f"T of the split, {peak.side}", (), headings)
    for start in range(0, len(peak.through), len(azimuths)):
        part = peak.through[start : start + len(azimuths)]
        table.add_row(f"{part[0].theta_deg:g}°", *(f"{row.through:.4f}" for row in part))
    return table
