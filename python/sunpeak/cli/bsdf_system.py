"""`sunpeak bsdf system`: panes and shades behind each other."""

from pathlib import Path
from typing import Annotated

import typer

from sunpeak._core import InputError
from sunpeak.cli.options import Quiet
from sunpeak.cli.output import note
from sunpeak.cli.run import Resume, running
from sunpeak.panes import Pane
from sunpeak.systems import Panes, Shade, System

GAP = "gap"
FLIP = ":flip"


def system(
    layers: Annotated[
        list[str],
        typer.Argument(
            metavar="LAYER…",
            help="From outside to inside: an IGSDB JSON or Optics file, glass:INDEX,MM or glass:INDEX,MM,ABSORPTION/m, "
            "pane:TAU,RHO_FRONT,RHO_BACK (visible) with /TAU,RHO,RHO after it (solar), a BSDF XML file or the "
            "folder of a split. gap is allowed between them and means nothing; :flip at its end turns a layer.",
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[str, typer.Option(help="klems, klems-half, klems-quarter, t3-N or t4-N.")] = "klems",
    split: Annotated[
        Path | None, typer.Option(help="Folder for the visible band with its exact straight-through part.")
    ] = None,
    panes: Annotated[
        Panes,
        typer.Option(help="In Klems patches a pane's mean, or its value at the middle angle (as WINDOW has it)."),
    ] = "mean",
    name: Annotated[str | None, typer.Option(help="What the file calls it.", show_default="the layers' names")] = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Make one BSDF of panes and shades, with all reflections between them.

    [dim]$[/dim] [cyan]sunpeak bsdf system low-e.json gap clear.json gap shade.xml -o window.xml[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf system glass:1.52,4 fabric --basis t3-4096 -o window.xml --split w[/cyan]
    """
    made = System([_layer(text) for text in layers if text != GAP], name)
    with running(output, resume, quiet) as run:
        made.write(output, basis, split=split, panes=panes, run=run)
    if not made.has_solar:
        note(f"{output}: the visible band alone; a layer's file has no solar values", quiet)


def _layer(text: str) -> Pane | Shade:
    """Read a layer by what the command line calls it."""
    flipped = text.endswith(FLIP)
    bare = text.removesuffix(FLIP)
    kind, colon, numbers = bare.partition(":")
    if colon and kind in ("glass", "pane"):
        pane = _glass(numbers) if kind == "glass" else _by_values(numbers)
        return pane.flipped() if flipped else pane
    path = Path(bare)
    if path.is_dir() or path.suffix.lower() == ".xml" or path.name == "peak.json":
        return Shade.load(path, flipped=flipped)
    if not path.exists():
        raise InputError(f"{bare}: no such file; expected a layer's file, glass:… or pane:…")
    pane = Pane.load(path)
    return pane.flipped() if flipped else pane


def _numbers(text: str, counts: tuple[int, ...], expected: str) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in counts:
        raise typer.BadParameter(f"{text!r}; expected {expected}")
    return numbers


def _glass(text: str) -> Pane:
    return Pane.from_index(*_numbers(text, (2, 3), "glass:INDEX,MM or glass:INDEX,MM,ABSORPTION"))


def _by_values(text: str) -> Pane:
    expected = "pane:TAU,RHO_FRONT,RHO_BACK, or that twice with / between"
    bands = [_numbers(part, (3,), expected) for part in text.split("/")]
    if len(bands) > 2:
        raise typer.BadParameter(f"{text!r}; expected {expected}")
    triples = [(tau, front, back) for tau, front, back in bands]
    return Pane.from_values(triples[0], triples[1] if len(triples) == 2 else None)
