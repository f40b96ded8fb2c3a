"""`sunpeak glare`: glare numbers of a picture."""

from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from sunpeak.cli.output import emit_json, note
from sunpeak.comfort import PEAK_CD_M2, SEARCH_ANGLE_RAD, BelowSight, GlareReport, glare
from sunpeak.pictures import Picture

SEARCH = "How sources are found"


def command(
    picture: Annotated[Path, typer.Argument(help="Fisheye picture, Radiance format, with VIEW= in its header.")],
    threshold: Annotated[
        float | None,
        typer.Option(metavar="CD/M2", help="Luminance above which a pixel may glare.", rich_help_panel=SEARCH),
    ] = None,
    times_mean: Annotated[
        float | None,
        typer.Option(help="Instead: so many times the mean luminance of the view.", rich_help_panel=SEARCH),
    ] = None,
    search_angle: Annotated[
        float,
        typer.Option(metavar="RAD", help="Opening angle within which pixels are one source.", rich_help_panel=SEARCH),
    ] = SEARCH_ANGLE_RAD,
    peak_luminance: Annotated[
        float,
        typer.Option(
            metavar="CD/M2", help="Pixels above this are sources of their own; 0: none are.", rich_help_panel=SEARCH
        ),
    ] = PEAK_CD_M2,
    below_sight: Annotated[
        BelowSight, typer.Option(help="Position index below the line of sight.", rich_help_panel=SEARCH)
    ] = "iwata-osterhaus",
    ev: Annotated[
        float | None, typer.Option(metavar="LUX", help="Vertical illuminance, if known from elsewhere.")
    ] = None,
    low_light: Annotated[bool, typer.Option("--low-light", help="Lower DGP in dim scenes (Wienold 2012).")] = False,
    relative_error: Annotated[float, typer.Option(help="Standard error of the picture, for the interval.")] = 0.0,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")] = False,
) -> None:
    """Vertical illuminance and daylight glare probability of a picture.

    Suns that the picture knows exactly count with their own size.

    [dim]$[/dim] [cyan]sunpeak glare out.hdr[/cyan]
    """
    if threshold is not None and times_mean is not None:
        raise typer.BadParameter("--threshold and --times-mean exclude each other")
    report = glare(
        Picture.load(picture),
        threshold_cd_m2=threshold,
        threshold_times_mean=times_mean,
        search_angle_rad=search_angle,
        peak_cd_m2=peak_luminance or None,
        ev_lux=ev,
        low_light=low_light,
        below_sight=below_sight,
        relative_error=relative_error,
    )
    for warning in report.warnings:
        note(f"sunpeak: warning: {warning}")
    if as_json:
        emit_json(report.to_dict())
    else:
        show(report)


def show(report: GlareReport) -> None:
    """Print the report for people."""
    console = Console(highlight=False)
    low, high = report.dgp_interval
    interval = f" ({low:.3f} to {high:.3f})" if high > low else ""
    console.print(f"DGP         [bold]{report.dgp:.3f}[/bold]{interval}  {report.glare_class}")
    console.print(f"Ev          {report.ev_lux:.0f} lx, {report.ev_sources_lux:.0f} lx of it from glare sources")
    console.print(f"brightest   {report.max_luminance_cd_m2:.4g} cd/m²")
    console.print(f"background  {report.background_cd_m2:.4g} cd/m²")
    console.print(report.rule, style="dim", soft_wrap=True)
    if report.sources:
        console.print(sources(report))


def sources(report: GlareReport) -> Table:
    """Table of the sources, the worst first."""
    table = Table(box=box.SIMPLE_HEAD)
    for heading in ("luminance, cd/m²", "size, sr", "position index", "at the eye, lx", "share of L²ω/P²"):
        table.add_column(heading, justify="right")
    table.add_column("")
    total = sum(source.weight for source in report.sources)
    for source in report.sources:
        table.add_row(
            f"{source.luminance_cd_m2:.4g}",
            f"{source.solid_angle_sr:.3g}",
            f"{source.position_index:.2f}",
            f"{source.illuminance_lux:.1f}",
            f"{100 * source.weight / total:.1f} %",
            "exact" if source.exact else f"{source.pixels} pixels",
        )
    return table
