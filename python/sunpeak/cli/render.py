"""`sunpeak render`: a picture of a scene."""

from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak.cli import options
from sunpeak.cli.output import note
from sunpeak.cli.values import parse_size
from sunpeak.files import check_target
from sunpeak.images import save_false_colour, save_png, tonemap
from sunpeak.pictures import Picture
from sunpeak.rad_input import RadInput, is_rad_input
from sunpeak.rendering import render
from sunpeak.scenes import View


def command(
    scenes: options.Scenes,
    output: Annotated[Path, typer.Option("--output", "-o", help="Radiance picture to write.")],
    view: Annotated[
        str | None,
        typer.Option(
            "--view",
            "-v",
            help="View file, picture with a view, or options: '-vta -vp 0 2 1.2 …'; for a .rif file a view's name "
            "(the first one without).",
        ),
    ] = None,
    size: Annotated[
        Any, typer.Option(parser=parse_size, metavar="WxH", help="Pixels; fitted to the view so that they are square.")
    ] = "512x512",
    peak: options.PeakRule = "split",
    samples: options.Samples = None,
    time: options.Seconds = None,
    error: options.PictureGoal = None,
    seed: options.Seed = 0,
    threads: options.Threads = None,
    max_bounces: options.MaxBounces = None,
    portal: options.Portals = None,
    png: Annotated[
        bool, typer.Option("--png", help="Tone-mapped and false-colour PNG beside the picture, too.")
    ] = False,
    search_path: options.SearchPath = None,
    allow_commands: options.AllowCommands = False,
    quiet: options.Quiet = False,
) -> None:
    """Render a picture.

    [dim]$[/dim] [cyan]sunpeak render room.rad sky.rad shade.rad -v eye.vf -o out.hdr --size 800x800[/cyan]
    """
    check_target(output)
    looking = chosen_view(view, scenes)
    scene = options.load_scene(scenes, search_path, allow_commands)
    for warning in scene.warnings:
        note(f"sunpeak: warning: {warning}", quiet)
    picture = render(
        scene,
        looking,
        looking.fit_size(*size),
        peak=peak,
        samples=samples,
        time=time,
        error=error if isinstance(error, float) else None,
        until=None if isinstance(error, float) else error,
        seed=seed,
        threads=threads,
        max_bounces=max_bounces,
        portals=portal or (),
        progress=not quiet,
    )
    picture.save(output)
    if png:
        write_images(picture, output)


def chosen_view(view: str | None, scenes: list[str]) -> View:
    """Give the view that is asked for, or that of a `.rif` file among the scene's."""
    inputs = [RadInput.load(name) for name in scenes if is_rad_input(name)]
    if view is None and not inputs:
        raise typer.BadParameter("expected a view: -v FILE, or options as '-vta -vp 0 2 1.2 -vd 0 -1 0'")
    for rad_input in inputs:
        if view is None or view in rad_input.views:
            return View.parse(" ".join(rad_input.view(view)))
    return View.of(str(view))


def write_images(picture: Picture, output: Path) -> None:
    """Write `NAME.png` and `NAME_false.png` beside `NAME.hdr`."""
    save_png(tonemap(picture.pixels), output.with_suffix(".png"))
    save_false_colour(picture.luminance(), output.with_name(f"{output.stem}_false.png"))
