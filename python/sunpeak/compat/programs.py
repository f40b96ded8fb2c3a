"""Which programs there are, and how one is run.

Nothing heavy is imported here: a script calls these programs many times, and each start counts.
"""

import os
import signal
import sys
from collections.abc import Callable, Sequence
from importlib import import_module

from sunpeak._core import InputError
from sunpeak.compat import radiance
from sunpeak.compat.options import NotDoneError

Program = Callable[[list[str]], int]

PROGRAMS = ("oconv", "rpict", "rtrace", "getinfo", "vwrays", "evalglare")
"""Done by Sunpeak; the module of each has the same name and a function `run` that gives the exit status."""

FAILED = 1
"""Exit status of Radiance's programs for what is wrong."""

SYSTEM_FAILED = 2
"""Theirs where the system refuses a file, but for those named next."""

ALWAYS_FAILED = frozenset({"vwrays", "evalglare"})

INTERRUPTED = 130


def main(arguments: Sequence[str]) -> int:
    """Run `NAME ARGUMENT …`; give the exit status."""
    name, *rest = arguments
    if name not in PROGRAMS:
        return pass_through(name, rest)
    # A reader that has seen enough (`| head`) ends the program without a word.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    run: Program = import_module(f"sunpeak.compat.{name}").run
    try:
        status = run_or_leave(name, run, rest)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except (InputError, OSError) as error:
        sys.stderr.write(f"{name}: {describe(error)}\n")
        is_system = isinstance(error, OSError) and name not in ALWAYS_FAILED
        return SYSTEM_FAILED if is_system else FAILED
    return status


def run_or_leave(name: str, run: Program, arguments: list[str]) -> int:
    """Run a program of ours, or Radiance's where an option asks for what ours does not do."""
    try:
        return run(arguments)
    except NotDoneError as refusal:
        return radiance.run_instead(name, arguments, refusal)


def describe(error: InputError | OSError) -> str:
    """What went wrong, with the file in front where the system named one."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def pass_through(name: str, arguments: Sequence[str]) -> int:
    """Become a program of Radiance's that Sunpeak lacks."""
    program = radiance.find_program(name)
    if program is None:
        raise InputError(
            f"{name}: Sunpeak does {', '.join(PROGRAMS)} itself; {name} is neither one of them nor on PATH "
            "(is Radiance installed?)"
        )
    sys.stdout.flush()
    os.execv(program, [str(program), *arguments])
