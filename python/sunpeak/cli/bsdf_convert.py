"""`sunpeak bsdf convert`: a BSDF in another basis, turned, mended, with its bands put together."""

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from sunpeak.bases import basis_name
from sunpeak.cli.options import Quiet
from sunpeak.cli.output import note
from sunpeak.cli.run import Resume, running
from sunpeak.cli.values import parse_length
from sunpeak.runs import Run
from sunpeak.scattering import Bsdf

WRITTEN = "What the file says"

Name = Annotated[str | None, typer.Option(help="Name of the product.", rich_help_panel=WRITTEN)]
Manufacturer = Annotated[str | None, typer.Option(help="Who makes it.", rich_help_panel=WRITTEN)]
Thickness = Annotated[
    Any,
    typer.Option(
        parser=parse_length, metavar="LENGTH", help="As in 0.4mm or 0.0004 (metres).", rich_help_panel=WRITTEN
    ),
]


def convert(
    file: Annotated[Path, typer.Argument(help="LBNL XML file, or the folder of a split.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[
        str | None,
        typer.Option(
            help="klems-full, klems-half, klems-quarter, t3, t4; or t3-4096, t4-256 … by cells.",
            show_default="as it is",
        ),
    ] = None,
    resolution: Annotated[int | None, typer.Option(help="Cells a side of t3 and t4: 8, 16, 32, 64, 128.")] = None,
    rotate: Annotated[
        float, typer.Option(metavar="DEG", help="Turn about the normal, counterclockwise seen from the front.")
    ] = 0.0,
    flip: Annotated[
        bool, typer.Option("--flip", help="Turn over about the up axis: the front comes to the back.")
    ] = False,
    swap_sides: Annotated[
        bool, typer.Option("--swap-sides", help="Only exchange the names of front and back.")
    ] = False,
    reciprocity: Annotated[Literal["average"] | None, typer.Option(help="Make both ways alike by their mean.")] = None,
    keep_peak: Annotated[
        bool, typer.Option("--keep-peak", help="Put the split's peak where a delta lies in the new basis.")
    ] = False,
    solar: Annotated[
        Path | None,
        typer.Option(
            "--solar", "--combine", help="File whose solar band (or else its visible one) becomes the solar band."
        ),
    ] = None,
    name: Name = None,
    manufacturer: Manufacturer = None,
    thickness: Thickness = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Tabulate a BSDF in another basis by flux, turn it, mend it, put visible and solar together.

    A solar band in the file is converted, too.

    [dim]$[/dim] [cyan]sunpeak bsdf convert shade.xml -o shade_t4.xml --basis t4 --resolution 64[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf convert visible.xml --solar solar.xml -o both.xml[/cyan]
    """
    wanted = None if basis is None else basis_name(basis, resolution)
    if basis is None and resolution is not None:
        raise typer.BadParameter("--resolution without --basis; expected --basis t3 or t4 beside it")

    def converted(bsdf: Bsdf, run: Run) -> Bsdf:
        return bsdf.convert(
            wanted,
            rotate_deg=rotate,
            flip=flip,
            swap_sides=swap_sides,
            reciprocity=reciprocity,
            keep_peak=keep_peak,
            run=run,
        )

    with running(output, resume, quiet) as run:
        visible = Bsdf.load(file)
        beside = solar_beside(visible, file, solar)
        converted(visible, run).save(
            output,
            solar=None if beside is None else converted(beside, run),
            name=name,
            manufacturer=manufacturer,
            thickness_m=thickness,
        )
    note(str(output), quiet)


def solar_beside(visible: Bsdf, file: Path, solar: Path | None) -> Bsdf | None:
    """Find what becomes the solar band: of the file named for it, or of the file itself, or none."""
    if solar is None:
        return Bsdf.load_solar(file) if has_solar(visible) else None
    other = Bsdf.load(solar)
    return Bsdf.load_solar(solar) if has_solar(other) else other


def has_solar(bsdf: Bsdf) -> bool:
    """Whether the file has a solar band."""
    return any(band.lower() == "solar" for band in bsdf.describe()["bands"])
