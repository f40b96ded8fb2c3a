"""`sunpeak bsdf …`: what a BSDF file holds."""

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from sunpeak.blinds import Blind
from sunpeak.bsdf_plot import Kind, is_picture, plot_bsdf
from sunpeak.cli.bsdf_convert import convert
from sunpeak.cli.bsdf_fabric import fabric
from sunpeak.cli.bsdf_formula import HELP as FORMULA_HELP
from sunpeak.cli.bsdf_formula import formula
from sunpeak.cli.bsdf_generate import generate
from sunpeak.cli.bsdf_measured import measured
from sunpeak.cli.bsdf_sheets import mesh, perforated
from sunpeak.cli.bsdf_show import show
from sunpeak.cli.bsdf_system import system
from sunpeak.cli.options import Quiet
from sunpeak.cli.output import emit_json, note
from sunpeak.cli.run import Resume, running
from sunpeak.cli.values import parse_instrument, parse_numbers
from sunpeak.inspection import inspect
from sunpeak.scattering import Bsdf, Peak, side_of_ray

app = typer.Typer(no_args_is_help=True, help="Look into a BSDF file.")
app.command("fabric")(fabric)
app.command("mesh")(mesh)
app.command("perforated")(perforated)
app.command("system")(system)
app.command("formula", help=FORMULA_HELP)(formula)
app.command("convert")(convert)
app.command("generate")(generate)
app.command("measured")(measured)

File = Annotated[Path, typer.Argument(help="LBNL XML file, or the folder of a split.")]
Instrument = Annotated[
    Any,
    typer.Option(
        "--instrument-fwhm",
        parser=parse_instrument,
        metavar="DEG|find",
        help="Measured data: full width at half maximum of what the instrument makes of a sharp beam, or find it.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON value on standard output.")]


@app.command("info")
def info(file: File, instrument_fwhm: Instrument = None, as_json: Json = False) -> None:
    """What is in it, is it sound, will peak extraction fire, and why.

    [dim]$[/dim] [cyan]sunpeak bsdf info shade.xml[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf info measured.xml --instrument-fwhm find[/cyan]
    """
    report = inspect(str(file), instrument_fwhm)
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
    phi: Annotated[
        Any, typer.Option(parser=parse_numbers, metavar="DEG,…", help="Azimuth, from x, towards which the ray runs.")
    ] = "0",
    peak: Annotated[Peak, typer.Option(help="Rule that finds the peak.")] = "split",
    instrument_fwhm: Instrument = None,
    as_json: Json = False,
) -> None:
    """Through transmittance by angle: a line of theta, phi and T for each direction.

    [dim]$[/dim] [cyan]sunpeak bsdf through shade.xml --theta 0,10,20 --phi 0,90[/cyan]
    """
    bsdf = Bsdf.load(file, instrument_fwhm_deg=instrument_fwhm)
    angles = np.array([(t, p) for p in phi for t in theta])
    values = bsdf.through(side_of_ray(angles[:, 0], angles[:, 1]), peak)
    if as_json:
        rows = [{"theta_deg": t, "phi_deg": p, "through": float(v)} for (t, p), v in zip(angles, values, strict=True)]
        emit_json({"file": str(file), "peak": peak, "through": rows})
        return
    for (t, p), value in zip(angles, values, strict=True):
        typer.echo(f"{t:g} {p:g} {value:.6f}")


@app.command("blind")
def blind(
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[
        str, typer.Option(help="klems, klems-half, klems-quarter, or t4-256, t4-4096 … by number of cells.")
    ] = "klems",
    width: Annotated[float, typer.Option(help="Width of the slats over their spacing.")] = Blind.width,
    tilt: Annotated[float, typer.Option(help="Tilt from the normal, up at the front, degrees.")] = Blind.tilt_deg,
    scattered: Annotated[float, typer.Option(help="Share that the slats scatter through.")] = Blind.scattered,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Make a venetian blind of flat slats from formulas.

    [dim]$[/dim] [cyan]sunpeak bsdf blind -o blind.xml --tilt 30[/cyan]
    """
    with running(output, resume, quiet) as run:
        Blind(width, tilt, scattered).write(output, basis, run=run)


@app.command("split")
def split(
    file: File,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the files go.")],
    instrument_fwhm: Instrument = None,
    quiet: Quiet = False,
) -> None:
    """Write the split as files: the residual as LBNL XML, the peak as JSON and CSV, and where the flux went.

    Commands that read a BSDF read the folder, too; a scene names the peak.json in it.

    [dim]$[/dim] [cyan]sunpeak bsdf split shade.xml -o shade_split[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf split measured.xml -o measured_split --instrument-fwhm 1.5[/cyan]
    """
    for written in Bsdf.load(file, instrument_fwhm_deg=instrument_fwhm).save_split(output):
        note(str(written), quiet)


@app.command("plot")
def plot(
    file: File,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Picture: .png, .svg, or a name without suffix for both.")
    ],
    theta: Annotated[
        float, typer.Option(min=0, max=180, help="Degrees from the front normal; above 90 from behind.")
    ] = 0.0,
    phi: Annotated[float, typer.Option(help="Azimuth, from x, towards which the ray runs, degrees.")] = 0.0,
    kind: Annotated[Kind, typer.Option(help="What to draw.")] = "all",
    instrument_fwhm: Instrument = None,
    quiet: Quiet = False,
) -> None:
    """Draw the exit hemisphere, the map of T over all incidences, and a profile through the peak.

    [dim]$[/dim] [cyan]sunpeak bsdf plot shade.xml -o shade.png --theta 40 --phi 90[/cyan]
    """
    if not is_picture(output):
        raise typer.BadParameter(f"{output}: expected a name that ends in .png or .svg, or without a suffix")
    bsdf = Bsdf.load(file, instrument_fwhm_deg=instrument_fwhm)
    label = bsdf.describe()["name"] or file.stem
    for written in plot_bsdf(bsdf, output, theta_deg=theta, phi_deg=phi, kind=kind, label=label):
        note(str(written), quiet)
