"""The root of the command line, and the one place where exceptions become exit codes.

Exit status: 0 done, 1 the input is wrong (the message is on standard error), 2 wrong usage, 130 stopped by Ctrl-C.
"""

import sys
from typing import Annotated

import typer

from sunpeak import InputError, __version__
from sunpeak.cli import bsdf, compat, demo, glare, render, scene, sky, study, trace

EXIT_WRONG_INPUT = 1
EXIT_INTERRUPTED = 130

app = typer.Typer(
    name="sunpeak",
    help="Daylight through shades and blinds that are known by their BSDF, and how much they glare.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("demo", rich_help_panel="Results")(demo.command)
app.command("render", rich_help_panel="Results")(render.command)
app.command("trace", rich_help_panel="Results")(trace.command)
app.add_typer(glare.app, name="glare", rich_help_panel="Results")
app.add_typer(scene.app, name="scene", rich_help_panel="Input")
app.add_typer(bsdf.app, name="bsdf", rich_help_panel="Input")
app.add_typer(sky.app, name="sky", rich_help_panel="Input")
app.add_typer(study.app, name="study", rich_help_panel="Results")
app.command(
    "compat",
    help=compat.HELP,
    rich_help_panel="Radiance's programs",
    context_settings={"ignore_unknown_options": True, "allow_extra_args": True, "help_option_names": []},
)(compat.command)


def show_version(wanted: bool) -> None:
    """Print the version and leave."""
    if wanted:
        print(f"sunpeak {__version__}")  # noqa: T201
        raise typer.Exit


@app.callback()
def root(
    version: Annotated[
        bool,
        typer.Option("--version", callback=show_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Take the options that stand before the command."""


def main() -> None:
    """Run the command line; the message of wrong input is one line on standard error."""
    try:
        app(prog_name="sunpeak")
    except KeyboardInterrupt:
        sys.exit(EXIT_INTERRUPTED)
    except (InputError, OSError) as error:
        sys.stderr.write(f"sunpeak: {describe(error)}\n")
        sys.exit(EXIT_WRONG_INPUT)


def describe(error: InputError | OSError) -> str:
    """What went wrong, with the file in front where the system named one."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error)
