"""`sunpeak bsdf …`: what a BSDF file holds."""

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich import box
from rich.console import Console
from rich.table import Table

from sunpeak.cli.output import emit_json
from sunpeak.cli.values import parse_numbers
from sunpeak.fabrics import Fabric
from sunpeak.inspection import Inspection, inspect
from sunpeak.scattering import Bsdf, Peak, direction

app = typer.Typer(no_args_is_help=True, help="Look into a BSDF file.")

File = Annotated[Path, typer.Argument(help="LBNL XML file.")]
Json = Annotated[bool, typer.Option("--json", help="One JSON value on standard output.")]


@app.command("info")
def info(file: File, as_json: Json = False) -> None:
    """What is in it, is it sound, will peak extraction fire, and why.

    [dim]$[/dim] [cyan]sunpeak bsdf info shade.xml[/cyan]
    """
    report = inspect(str(file))
    if as_json:
        emit_json(report.to_dict())
    else:
        show(report)


@app.command("through")
def through(
    file: File,
    theta: Annotated[
        Any,
        typer.Option(parser=parse_numbers, metavar="DEG,…", help="From the front normal; above 90 from behind."),
    ] = "0",
    phi: Annotated[Any, typer.Option(parser=parse_numbers, metavar="DEG,…", help="Azimuth of the ray from x.")] = "0",
    peak: Annotated[Peak, typer.Option(help="Rule that finds the peak.")] = "split",
    as_json: Json = False,
) -> None:
    """Through transmittance by angle: a line of theta, phi and T for each direction.

    [dim]$[/dim] [cyan]sunpeak bsdf through shade.xml --theta 0,10,20 --phi 0,90[/cyan]
    """
    bsdf = Bsdf.load(file)
    angles = np.array([(t, p) for p in phi for t in theta])
    values = bsdf.through(direction(angles[:, 0], angles[:, 1]), peak)
    if as_json:
        rows = [{"theta_deg": t, "phi_deg": p, "through": float(v)} for (t, p), v in zip(angles, values, strict=True)]
        emit_json({"file": str(file), "peak": peak, "through": rows})
        return
    for (t, p), value in zip(angles, values, strict=True):
        typer.echo(f"{t:g} {p:g} {value:.6f}")


@app.command("fabric")
def fabric(
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[
        str, typer.Option(help="klems, klems-half, klems-quarter, or t3-1024 … t3-16384, t4-256 …, by number of cells.")
    ] = "klems",
    openness: Annotated[float, typer.Option(help="Through transmittance at normal incidence.")] = Fabric.openness,
    cut_off: Annotated[float, typer.Option(help="Degrees from which nothing goes through.")] = Fabric.cut_off_deg,
    exponent: Annotated[float, typer.Option(help="Steepness of the fall to the cut-off.")] = Fabric.exponent,
    scattered: Annotated[float, typer.Option(help="Scattered transmittance.")] = Fabric.scattered,
    lobe_share: Annotated[float, typer.Option(help="Share of it around the straight direction.")] = Fabric.lobe_share,
    lobe_sigma: Annotated[float, typer.Option(help="Width of that lobe, projected.")] = Fabric.lobe_sigma,
    reflectance: Annotated[float, typer.Option(help="Diffuse reflectance.")] = Fabric.reflectance,
) -> None:
    """Make a fabric from formulas: T = openness cos(90 deg theta / cut-off)^exponent.

    [dim]$[/dim] [cyan]sunpeak bsdf fabric -o shade.xml --basis t3-4096 --openness 0.03[/cyan]
    """
    Fabric(openness, cut_off, exponent, scattered, lobe_share, lobe_sigma, reflectance).write(output, basis)


def show(report: Inspection) -> None:
    """Print the report for people."""
    console = Console(highlight=False)
    about = report.description
    console.print(f"[bold]{about['name'] or report.file}[/bold] {about['manufacturer']}".rstrip())
    console.print(f"{report.file}: {about['structure']}")
    for warning in about["warnings"]:
        console.print(f"[yellow]warning:[/yellow] {warning}")
    console.print(components(report))
    console.print(angles(report))
    for side, verdict in report.verdicts.items():
        console.print(f"[bold]{side}:[/bold] {verdict}.", soft_wrap=True)


def components(report: Inspection) -> Table:
    """Table of the file's parts."""
    table = Table(title="Tables, by the side that rays meet", title_justify="left", box=box.SIMPLE_HEAD)
    for heading in ("side", "mode", "basis", "columns", "smallest cell", "channels"):
        table.add_column(heading)
    for part in report.description["components"]:
        reversed_table = part["by_reciprocity"] and part["mode"] == "transmission"
        table.add_row(
            part["side"],
            part["mode"] + (" (by reciprocity)" if reversed_table else ""),
            part["basis"] + (" (isotropic)" if part["isotropic"] else ""),
            str(part["incident_cells"]),
            f"{part['smallest_cell_sr']:.3g} sr",
            "3" if part["colour"] else "1",
        )
    return table


def angles(report: Inspection) -> Table:
    """Table of hemispherical values and through transmittance by angle."""
    table = Table(title="By angle of incidence, in the plane of x", title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column("side")
    for heading in ("theta, deg", "passes", "reflected", "T split", "T radiance", "T paper"):
        table.add_column(heading, justify="right")
    for look in report.looks:
        numbers = (
            look.transmittance,
            look.reflectance,
            look.through_split,
            look.through_radiance,
            look.through_paper,
        )
        table.add_row(look.side, f"{look.theta_deg:g}", *(f"{number:.4f}" for number in numbers))
    return table
