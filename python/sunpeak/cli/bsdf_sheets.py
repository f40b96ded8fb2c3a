"""`sunpeak bsdf perforated`, `sunpeak bsdf mesh`: sheets of metal by their geometry."""

from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak.bands import Label
from sunpeak.cli.bsdf_convert import Manufacturer, Name
from sunpeak.cli.options import Quiet
from sunpeak.cli.run import Resume, running
from sunpeak.cli.values import parse_share
from sunpeak.sheets import ExpandedMesh, Pattern, Perforated

Output = Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")]
Basis = Annotated[str, typer.Option(help="klems, klems-half, klems-quarter, t3-N or t4-N.")]
Split = Annotated[Path | None, typer.Option(help="Folder for the exact straight-through part beside the rest.")]
Reflectance = Annotated[
    Any, typer.Option(parser=parse_share, metavar="SHARE", help="Of the metal itself, diffuse.", show_default="50%")
]


def perforated(
    output: Output,
    diameter: Annotated[float, typer.Option(help="Of the holes [mm].")],
    pitch: Annotated[float, typer.Option(help="From the middle of a hole to that of the next [mm].")],
    thickness: Annotated[float, typer.Option(help="Of the sheet [mm].")],
    pattern: Annotated[Pattern, typer.Option(help="Holes at the corners of squares or of triangles.")] = "triangular",
    reflectance: Reflectance = "50%",
    basis: Basis = "klems",
    split: Split = None,
    name: Name = None,
    manufacturer: Manufacturer = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Make a sheet with round holes; light on their walls is lost.

    [dim]$[/dim] [cyan]sunpeak bsdf perforated -o sheet.xml --diameter 2 --pitch 4 --thickness 1[/cyan]
    """
    sheet = Perforated(diameter, pitch, thickness, pattern, reflectance)
    with running(output, resume, quiet) as run:
        sheet.write(output, basis, split=split, label=Label(name, manufacturer), run=run)


def mesh(
    output: Output,
    long_way: Annotated[float, typer.Option(help="From knuckle to knuckle along x, LWD [mm].")],
    short_way: Annotated[float, typer.Option(help="The same along y, SWD [mm].")],
    strand: Annotated[float, typer.Option(help="Width of the strands in the plane of the sheet [mm].")],
    thickness: Annotated[float, typer.Option(help="Of the sheet [mm].")],
    reflectance: Reflectance = "50%",
    basis: Basis = "klems",
    split: Split = None,
    name: Name = None,
    manufacturer: Manufacturer = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Make flattened expanded metal: rhombic openings with upright walls; light on them is lost.

    [dim]$[/dim] [cyan]sunpeak bsdf mesh -o mesh.xml --long-way 10 --short-way 6 --strand 1.2 --thickness 1[/cyan]
    """
    sheet = ExpandedMesh(long_way, short_way, strand, thickness, reflectance)
    with running(output, resume, quiet) as run:
        sheet.write(output, basis, split=split, label=Label(name, manufacturer), run=run)
