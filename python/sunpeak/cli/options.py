"""Options that several commands share."""

from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak.cli.values import parse_goal, parse_percent
from sunpeak.scattering import Peak
from sunpeak.scenes import Scene

SAMPLING = "How long and how exactly"
READING = "How scenes are read"

Scenes = Annotated[
    list[str], typer.Argument(metavar="SCENE.rad …", help="Scene files in order, materials first; '!command' too.")
]
PeakRule = Annotated[
    Peak,
    typer.Option(help="What goes straight through an aBSDF: our split, today's Radiance, the paper's rule, nothing."),
]
Samples = Annotated[int | None, typer.Option(min=1, help="Paths for each pixel or ray (64).", rich_help_panel=SAMPLING)]
Seconds = Annotated[
    float | None, typer.Option("--time", min=0, metavar="SECONDS", help="Time to spend.", rich_help_panel=SAMPLING)
]
Error = Annotated[
    Any,
    typer.Option(
        parser=parse_percent,
        metavar="PCT",
        help="Go on until the error (root mean square over rays or sensors) is below this with 95 % confidence, in "
        "percent of the mean.",
        rich_help_panel=SAMPLING,
    ),
]
PictureGoal = Annotated[
    Any,
    typer.Option(
        "--error",
        parser=parse_goal,
        metavar="PCT|class|dgp:…|ev:…",
        help="Go on until the error (root mean square over blocks of about 3 degrees) is so small (95 % confidence), "
        "in percent of the mean, until the comfort class cannot change (class), or until the 95 % interval of DGP "
        "(dgp:0.005) or Ev (ev:1%) is so narrow.",
        rich_help_panel=SAMPLING,
    ),
]
Seed = Annotated[
    int, typer.Option(min=0, help="The same seed gives the same result, on any threads.", rich_help_panel=SAMPLING)
]
Threads = Annotated[int | None, typer.Option(min=1, help="All cores without it.", rich_help_panel=SAMPLING)]
MaxBounces = Annotated[
    int | None,
    typer.Option(min=0, help="Diffuse bounces, as Radiance's -ab; no limit without it.", rich_help_panel=SAMPLING),
]
Portals = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME",
        help="Surface or modifier through which light comes in, beside shades, windows and holes in polygons, which "
        "are found: an opening between walls, or one polygon (of void) before very many panes; may come again.",
        rich_help_panel=SAMPLING,
    ),
]
SearchPath = Annotated[
    list[Path] | None,
    typer.Option(
        metavar="FOLDER", help="Where files that a scene names are looked for; may come again.", rich_help_panel=READING
    ),
]
AllowCommands = Annotated[
    bool,
    typer.Option(
        "--allow-commands", help="Run !commands that Sunpeak does not know in a shell.", rich_help_panel=READING
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress and no notes.")]


def load_scene(files: list[str], search_path: list[Path] | None, allow_commands: bool) -> Scene:
    """Read the scene that a command line names."""
    return Scene.load(files, search_path=search_path or (), allow_commands=allow_commands)
