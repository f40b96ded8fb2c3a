"""`sunpeak glare compare`: why a glare number changed."""

from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from sunpeak.cli import glare_options as options
from sunpeak.cli.output import emit_json, note
from sunpeak.comfort import glare
from sunpeak.glare_compare import GlareComparison, SourceChange, compare
from sunpeak.glare_report import GlareReport
from sunpeak.pictures import Picture

SHOWN = 12
"""Sources in the table; those beyond it add up in a last row."""


def command(
    before: Annotated[Path, typer.Argument(metavar="A.hdr", help="Picture before.")],
    after: Annotated[Path, typer.Argument(metavar="B.hdr", help="Picture after.")],
    rules: options.Rules = "sunpeak",
    threshold: options.Threshold = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")] = False,
) -> None:
    """Split the change of DGP from one picture to another into the Ev term and each source.

    [dim]$[/dim] [cyan]sunpeak glare compare without.hdr with.hdr[/cyan]
    """

    def judge(path: Path) -> GlareReport:
        report = glare(Picture.load(path), rules=rules, threshold_cd_m2=threshold)
        for warning in report.warnings:
            note(f"sunpeak: warning: {path}: {warning}")
        return report

    found = compare(judge(before), judge(after))
    if as_json:
        emit_json(found.to_dict())
    else:
        show(found)


def show(found: GlareComparison) -> None:
    """Print the comparison for people."""
    console = Console(highlight=False)
    before, after = found.before, found.after
    console.print(
        f"DGP  {before.dgp:.3f} → [bold]{after.dgp:.3f}[/bold] ({found.dgp_change:+.4f})  {after.glare_class}"
    )
    console.print(f"Ev   {before.ev_lux:.0f} → {after.ev_lux:.0f} lx")
    table = Table(box=box.SIMPLE_HEAD)
    for heading in ("of DGP", "before", "after", "change"):
        table.add_column(heading, justify="left" if heading == "of DGP" else "right")
    table.add_column("what differs")
    table.add_row(
        "Ev", f"{before.dgp_ev_term:.4f}", f"{after.dgp_ev_term:.4f}", f"{found.ev_change:+.4f}", ratio(found)
    )
    for change in found.sources[:SHOWN]:
        table.add_row(*row(change))
    rest = found.sources[SHOWN:]
    if rest:
        table.add_row(f"{len(rest)} other sources", "", "", f"{sum(c.dgp_change for c in rest):+.4f}", "")
    if abs(found.other_change) > 5e-5:
        table.add_row("limits, factors", "", "", f"{found.other_change:+.4f}", "")
    console.print(table)


def ratio(found: GlareComparison) -> str:
    """By how much Ev changed."""
    return f"× {found.after.ev_lux / found.before.ev_lux:.3g}" if found.before.ev_lux > 0 else ""


def row(change: SourceChange) -> tuple[str, str, str, str, str]:
    """A source in a row of the table."""
    source = change.after or change.before
    assert source is not None
    name = f"{source.luminance_cd_m2:.3g} cd/m², {source.angle_to_sight_deg:.0f}° off"
    parts = [f"{s.dgp_part:.4f}" if s else "–" for s in (change.before, change.after)]
    return name, parts[0], parts[1], f"{change.dgp_change:+.4f}", change.what
