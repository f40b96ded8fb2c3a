"""`sunpeak compat`: Radiance's programs on Sunpeak's renderer."""

from pathlib import Path

import typer

from sunpeak.cli.output import emit
from sunpeak.compat.install import install
from sunpeak.compat.programs import PROGRAMS, main

HELP = f"""Radiance's programs by their own names and options, on Sunpeak's renderer.

[cyan]sunpeak compat install DIR[/cyan] puts small programs into a folder; with it first on PATH a script written for
Radiance runs on Sunpeak.

[cyan]sunpeak compat NAME …[/cyan] runs one: {", ".join(PROGRAMS)}. Any other NAME is a program of Radiance's,
where that is installed. [cyan]docs/compat.md[/cyan] says what each option is taken for.
"""


def command(context: typer.Context) -> None:
    """Run a program, or install them all."""
    words = context.args
    if words[:1] == ["install"]:
        if len(words) != 2 or words[1].startswith("-"):
            raise typer.BadParameter("expected: sunpeak compat install DIR")
        programs = install(Path(words[1]))
        emit("".join(f"{program}\n" for program in programs))
        return
    if not words or words[0].startswith("-"):
        emit(context.get_help() + "\n")
        raise typer.Exit(0 if words else 2)
    raise typer.Exit(main(words))
