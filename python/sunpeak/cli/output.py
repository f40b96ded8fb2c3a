"""What commands write: results on standard output or whole files, progress on standard error."""

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from sunpeak.files import write_text

ProgressCallback = Callable[[int, int], None]


def emit(text: str, output: Path | None = None) -> None:
    """Write a result to a file, or to standard output where none is named."""
    if output is None:
        sys.stdout.write(text)
    else:
        write_text(output, text)


def emit_json(value: Any) -> None:
    """Write one JSON value to standard output."""
    sys.stdout.write(json.dumps(value, indent=2, ensure_ascii=False) + "\n")


def note(text: str, quiet: bool = False) -> None:
    """Say something beside the result, on standard error."""
    if not quiet:
        sys.stderr.write(text + "\n")


@contextmanager
def progress_bar(title: str, quiet: bool) -> Iterator[ProgressCallback | None]:
    """Show a progress bar on standard error, where that is a terminal and nobody asked for quiet."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield None
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total or None)
