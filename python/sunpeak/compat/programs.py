"""Which programs there are, and how one is run.

Nothing heavy is imported here: a script calls these programs many times, and each start counts.
"""

import os
import shutil
import signal
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from sunpeak._core import InputError

Program = Callable[[list[str]], int]

PROGRAMS = ("oconv", "rpict", "rtrace", "getinfo", "vwrays", "evalglare")
"""Done by Sunpeak; the module of each has the same name and a function `run` that gives the exit status."""

FAILED = 1
"""Exit status of Radiance's programs for whatever went wrong."""

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
        status = run(rest)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except (InputError, OSError) as error:
        sys.stderr.write(f"{name}: {describe(error)}\n")
        return FAILED
    return status


def describe(error: InputError | OSError) -> str:
    """What went wrong, with the file in front where the system named one."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def pass_through(name: str, arguments: Sequence[str]) -> int:
    """Become a program of Radiance's that Sunpeak lacks."""
    program = find_program(name)
    if program is None:
        raise InputError(
            f"{name}: Sunpeak does {', '.join(PROGRAMS)} itself; {name} is neither one of them nor on PATH "
            "(is Radiance installed?)"
        )
    sys.stdout.flush()
    os.execv(program, [str(program), *arguments])


def find_program(name: str) -> Path | None:
    """Find a program on PATH, or else among those that the package pyradiance brings."""
    if os.sep in name:
        return None
    found = shutil.which(name)
    if found is not None:
        return Path(found)
    package = find_spec("pyradiance")
    folders = package.submodule_search_locations if package is not None else None
    candidates = [Path(folder, "bin", name) for folder in folders or ()]
    return next((program for program in candidates if os.access(program, os.X_OK) and program.is_file()), None)
