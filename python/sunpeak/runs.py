"""Long computations by columns: shown while they last, kept where Ctrl-C stops them, gone on with later."""

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import NamedTuple

from sunpeak import _core
from sunpeak.files import check_target
from sunpeak.progress import Callback, progress_bar


class Watch(NamedTuple):
    """What the compiled core asks for: where finished columns go, and whom to tell how far it is."""

    kept: _core.Kept | None
    progress: Callback | None


class Run:
    """One run of a command or a script: several tables after each other, whose finished columns lie in one file.

    Use it as a context: `with Run(state="out.xml.columns") as run: bsdf.convert("t4-4096", run=run).save("out.xml")`.
    Where Ctrl-C ends the block, finished columns are written to `state`; where it comes to its end, `state` is removed.
    """

    def __init__(
        self,
        *,
        progress: bool | Callback = False,
        state: str | PathLike[str] | None = None,
        resume: bool = False,
    ) -> None:
        """Show progress on standard error, or tell it; keep columns in `state`, and go on from there with `resume`.

        Raises `InputError` where `state` is no file of finished columns; the first computation does where they are of
        something else.
        """
        self._progress = progress
        self.state = None if state is None else Path(state)
        self._kept: _core.Kept | None = None
        if self.state is not None:
            check_target(self.state)
            self._kept = _core.Kept(self.state if resume else None)
        elif resume:
            raise _core.InputError("resume without state: nothing says where the finished columns are")

    @contextmanager
    def watching(self, title: str) -> Iterator[Watch]:
        """Watch one of the run's computations under a title."""
        if callable(self._progress):
            yield Watch(self._kept, self._progress)
        else:
            with progress_bar(title, self._progress) as callback:
                yield Watch(self._kept, callback)

    def __enter__(self) -> "Run":
        """Begin."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Keep what is finished after Ctrl-C; forget it when all is done."""
        if self.state is None or self._kept is None:
            return
        if kind is None:
            self.state.unlink(missing_ok=True)
        elif issubclass(kind, KeyboardInterrupt):
            self._kept.save(self.state)


UNWATCHED = Run()
"""Nothing is shown and nothing kept."""
