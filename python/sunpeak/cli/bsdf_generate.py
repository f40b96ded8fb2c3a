"""`sunpeak bsdf generate`: a BSDF from geometry."""

import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak import __version__
from sunpeak.cli import options
from sunpeak.cli.output import note
from sunpeak.cli.run import stoppable
from sunpeak.cli.values import parse_numbers, parse_percent
from sunpeak.files import check_target
from sunpeak.generation import Box, GeneratedBsdf, SideName, generate_bsdf
from sunpeak.scenes import Scene

GEOMETRY = "Where light comes in"
TABLES = "What is written"


def parse_box(text: str) -> Box:
    """`0,1,0,0.05,-0.04,0` as xmin, xmax, ymin, ymax, zmin, zmax."""
    numbers = parse_numbers(text)
    if len(numbers) != 6:
        raise typer.BadParameter(f"{text!r}; expected XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX")
    xmin, xmax, ymin, ymax, zmin, zmax = numbers
    return xmin, xmax, ymin, ymax, zmin, zmax


def named_basis(basis: str, resolution: int | None) -> str:
    """`t4` and 64 as `t4-4096`."""
    if basis not in ("t3", "t4"):
        if resolution is not None:
            raise typer.BadParameter("--resolution: for --basis t3 and t4 only")
        return basis
    side = resolution or {"t3": 64, "t4": 32}[basis]
    return f"{basis}-{side * side}"


def generate(
    scenes: options.Scenes,
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[
        str,
        typer.Option(
            help="klems, klems-half, klems-quarter, t3, t4, or with the number of cells t4-4096 …",
            rich_help_panel=TABLES,
        ),
    ] = "klems",
    resolution: Annotated[
        int | None, typer.Option(help="Of t3 and t4: cells a side, 8 to 128 (t4: 64).", rich_help_panel=TABLES)
    ] = None,
    box: Annotated[
        Any,
        typer.Option(
            parser=parse_box,
            metavar="X,X,Y,Y,Z,Z",
            help="XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX of what is sampled; the box around the geometry without it.",
            rich_help_panel=GEOMETRY,
        ),
    ] = None,
    periodic: Annotated[
        bool,
        typer.Option("--periodic", help="The box repeats in x and y for ever.", rich_help_panel=GEOMETRY),
    ] = False,
    front: Annotated[
        bool,
        typer.Option("--front", help="Light from outside (along +z); both sides without it.", rich_help_panel=GEOMETRY),
    ] = False,
    back: Annotated[
        bool,
        typer.Option("--back", help="Light from the room (along -z); both sides without it.", rich_help_panel=GEOMETRY),
    ] = False,
    samples: Annotated[
        int | None,
        typer.Option(min=1, help="Rays for each column at least; by the basis.", rich_help_panel=options.SAMPLING),
    ] = None,
    error: Annotated[
        Any,
        typer.Option(
            parser=parse_percent,
            metavar="PCT",
            help="Columns go on, up to 16 times --samples, until the errors of their cells are so much of the light.",
            rich_help_panel=options.SAMPLING,
        ),
    ] = "1",
    tolerance: Annotated[
        Any,
        typer.Option(
            parser=parse_percent,
            metavar="PCT",
            help="Cells of a tree come together that differ by less, or by no more than their errors.",
            rich_help_panel=TABLES,
        ),
    ] = "5",
    reciprocity: Annotated[
        bool, typer.Option(help="Average what reciprocity makes equal.", rich_help_panel=TABLES)
    ] = True,
    colour: Annotated[bool, typer.Option("--colour", help="CIE X and Z, too.", rich_help_panel=TABLES)] = False,
    split: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write the exact split there, too.", rich_help_panel=TABLES),
    ] = None,
    errors: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.npz",
            help="Write the standard error of every cell there, as NumPy's arrays.",
            rich_help_panel=TABLES,
        ),
    ] = None,
    geometry: Annotated[
        bool,
        typer.Option(
            "--geometry",
            help="Put the geometry into the file, too, as MGF: for proxies (Radiance's pkgBSDF).",
            rich_help_panel=TABLES,
        ),
    ] = False,
    name: Annotated[str | None, typer.Option(help="In the file; the output's name.", rich_help_panel=TABLES)] = None,
    manufacturer: Annotated[str, typer.Option(help="In the file.", rich_help_panel=TABLES)] = "",
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Go on after Ctrl-C, from OUTPUT.columns.", rich_help_panel=options.SAMPLING),
    ] = False,
    peak: options.PeakRule = "split",
    seed: options.Seed = 0,
    threads: options.Threads = None,
    search_path: options.SearchPath = None,
    allow_commands: options.AllowCommands = False,
    quiet: options.Quiet = False,
) -> None:
    """Trace rays through a product and tabulate where they leave, as genBSDF does.

    x is to the right, y up, z towards the room. What goes straight is counted apart: --split writes it exactly.

    [dim]$[/dim] [cyan]sunpeak bsdf generate slats.rad -o blind.xml --box 0,1,0.1,0.15,-0.05,0 --periodic[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf generate sheet.rad -o sheet.xml --basis t4 --resolution 64 --split sheet[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf generate slats.rad -o blind.xml --geometry[/cyan]
    """
    scene = options.load_scene(scenes, search_path, allow_commands)
    for warning in scene.warnings:
        note(f"sunpeak: warning: {warning}", quiet)
    sides: tuple[SideName, ...] = ("front", "back") if front == back else ("front",) if front else ("back",)
    tables = named_basis(basis, resolution)
    if errors is not None:
        check_target(errors)
    if geometry:
        # What MGF has no words for is said before the rays, not after.
        scene.to_mgf()
    with stoppable(output, quiet) as state:
        made = generate_bsdf(
            scene,
            tables,
            box=box,
            periodic=periodic,
            sides=sides,
            samples=samples,
            error=error,
            tolerance=tolerance,
            reciprocity=reciprocity,
            colour=colour,
            cell_errors=errors is not None,
            peak=peak,
            name=output.stem if name is None else name,
            manufacturer=manufacturer,
            made_by=_made_by(scenes, tables, box, periodic, seed),
            seed=seed,
            threads=threads,
            state=state,
            resume=resume,
            progress=not quiet,
        )
    write(made, output, split, errors, quiet, scene if geometry else None)


def write(
    made: GeneratedBsdf,
    output: Path,
    split: Path | None,
    errors: Path | None,
    quiet: bool,
    geometry: Scene | None = None,
) -> None:
    """Write the files, and say how exact they are."""
    made.save(output, geometry=geometry)
    note(made.summary(), quiet)
    if errors is not None:
        made.save_errors(errors)
        note(str(errors), quiet)
    if split is not None:
        for written in made.save_split(split):
            note(str(written), quiet)


def _made_by(scenes: list[str], basis: str, box: Box | None, periodic: bool, seed: int) -> str:
    files = " ".join(shlex.quote(Path(part).name if not part.startswith("!") else part) for part in scenes)
    where = "around the geometry" if box is None else " ".join(f"{x:g}" for x in box)
    edges = ", periodic" if periodic else ""
    return f"Generated by Sunpeak {__version__} from geometry: {files}; basis {basis}, box {where}{edges}, seed {seed}"
