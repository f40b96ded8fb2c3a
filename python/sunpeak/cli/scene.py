"""`sunpeak scene`: what scene files say, and what is wrong with them."""

from typing import Annotated

import typer

from sunpeak.cli import options
from sunpeak.cli.output import emit, emit_json
from sunpeak.scene_check import check_scene

app = typer.Typer(help="Scene files: what is wrong with them.", no_args_is_help=True)


@app.callback()
def group() -> None:
    """Keep `check` a command of its own."""


@app.command("check")
def check(
    scenes: options.Scenes,
    json: Annotated[bool, typer.Option("--json", help="One JSON object.")] = False,
    search_path: options.SearchPath = None,
    allow_commands: options.AllowCommands = False,
) -> None:
    """List all problems of scene files at once, and draw nothing.

    Errors: unknown types, wrong numbers of arguments, undefined names, missing files, commands that fail. Warnings:
    surfaces without area or off their plane, what nothing uses. Exit status 1 where there is an error.

    [dim]$[/dim] [cyan]sunpeak scene check materials.rad room.rad sky.rad[/cyan]
    """
    found = check_scene(scenes, search_path=search_path or (), allow_commands=allow_commands)
    if json:
        emit_json({"errors": found.errors, "warnings": found.warnings, "surfaces": found.surfaces})
    else:
        lines = [f"error: {error}" for error in found.errors] + [f"warning: {text}" for text in found.warnings]
        emit("".join(f"{line}\n" for line in lines))
        emit(f"{found.surfaces} surfaces, {len(found.errors)} errors, {len(found.warnings)} warnings\n")
    if found.errors:
        raise typer.Exit(1)
