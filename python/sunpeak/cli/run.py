"""Commands that take long: a bar while they last, and what Ctrl-C leaves."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from sunpeak.cli.output import note
from sunpeak.files import check_target
from sunpeak.runs import Run

Resume = Annotated[bool, typer.Option("--resume", help="Go on after Ctrl-C, from OUTPUT.columns.")]


def state_of(output: Path) -> Path:
    """Where the finished columns of an output are kept."""
    return output.with_name(output.name + ".columns")


@contextmanager
def stoppable(output: Path, quiet: bool) -> Iterator[Path]:
    """Give the file for finished columns, and say after Ctrl-C how to go on."""
    check_target(output)
    state = state_of(output)
    try:
        yield state
    except KeyboardInterrupt:
        if state.exists():
            note(f"sunpeak: stopped; finished columns are in {state}: the same command with --resume goes on", quiet)
        raise


@contextmanager
def running(output: Path, resume: bool, quiet: bool) -> Iterator[Run]:
    """Watch the making of an output."""
    with stoppable(output, quiet) as state, Run(progress=not quiet, state=state, resume=resume) as run:
        yield run
