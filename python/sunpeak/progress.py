"""Progress of long computations, on standard error."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

Callback = Callable[[int, int], None]
"""Called about five times a second with the units of work done and in all (0: not known yet)."""


@contextmanager
def progress_bar(title: str, wanted: bool = True) -> Iterator[Callback | None]:
    """Show a progress bar, where standard error is a terminal."""
    console = Console(stderr=True)
    if not (wanted and console.is_terminal):
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


class Steps:
    """Several computations, one after the other, as one bar of equal steps."""

    UNITS = 1000
    """Of the bar for each step."""

    def __init__(self, bar: Callback | None, count: int) -> None:
        """`count` steps on a bar, or on none."""
        self.bar, self.count, self.finished = bar, count, 0

    @property
    def callback(self) -> Callback | None:
        """To be called with the progress of the step under way."""
        bar, before = self.bar, self.UNITS * self.finished
        if bar is None:
            return None
        return lambda done, total: bar(before + (self.UNITS * done // total if total else 0), self.UNITS * self.count)

    def finish(self) -> None:
        """The step under way is done."""
        self.finished += 1
        if self.bar is not None:
            self.bar(self.UNITS * self.finished, self.UNITS * self.count)
