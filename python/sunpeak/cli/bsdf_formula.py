"""`sunpeak bsdf formula`: a table of a scattering model."""

from pathlib import Path
from typing import Annotated

import typer

from sunpeak.cli.bsdf_convert import Manufacturer, Name, Thickness
from sunpeak.cli.options import Quiet
from sunpeak.cli.output import note
from sunpeak.cli.run import Resume, running
from sunpeak.cli.values import parse_numbers
from sunpeak.formulas import DEFAULTS, Formula, ModelName

_MODELS = "  ".join(
    f"[bold]{model}[/bold]: " + ", ".join(f"{name} {value:g}" for name, value in numbers.items()) + "."
    for model, numbers in DEFAULTS.items()
)

HELP = f"""Tabulate a scattering model in any basis, by integration over cells.

Models and their numbers, with what they are where nothing is said: {_MODELS}

[dim]$[/dim] [cyan]sunpeak bsdf formula wgmd -p roughness=0.1 -o paint.xml --basis t3 --resolution 64[/cyan]
"""


def formula(
    model: Annotated[ModelName, typer.Argument(help="Which one; see above for its numbers.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    param: Annotated[
        list[str] | None,
        typer.Option("--param", "-p", metavar="NAME=NUMBER", help="A number of the model; may be repeated."),
    ] = None,
    basis: Annotated[
        str, typer.Option(help="klems-full, klems-half, klems-quarter, t3, t4; or t3-4096, t4-256 … by cells.")
    ] = "klems-full",
    resolution: Annotated[int | None, typer.Option(help="Cells a side of t3 and t4: 8, 16, 32, 64, 128.")] = None,
    name: Name = None,
    manufacturer: Manufacturer = None,
    thickness: Thickness = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Tabulate a scattering model and write it."""
    numbers: dict[str, float] = {}
    for each in param or []:
        key, equals, value = each.partition("=")
        if not equals:
            raise typer.BadParameter(f"{each!r}; expected NAME=NUMBER, as in roughness=0.2")
        numbers[key.strip().replace("-", "_")] = parse_numbers(value)[0]
    with running(output, resume, quiet) as run:
        bsdf = Formula(model, **numbers).tabulate(basis, resolution, run=run)
        bsdf.save(output, name=name, manufacturer=manufacturer, thickness_m=thickness)
    note(str(output), quiet)
