"""Small programs of Radiance's names in a folder."""

import os
import shlex
import sys
from pathlib import Path

from sunpeak._core import InputError
from sunpeak.compat.programs import PROGRAMS
from sunpeak.compat.radiance import MARK, is_ours
from sunpeak.files import whole_file

SCRIPT = """#!/bin/sh
# {name}, on Sunpeak's renderer ({mark}). The folder of this file goes before Radiance's on PATH.
exec {python} -P -m sunpeak.compat {name} "$@"
"""
EXECUTABLE = 0o755


def install(folder: Path) -> list[Path]:
    """Write the programs, each whole or not at all, and give their names.

    A file of that name that is not of our making is not overwritten.
    """
    programs = [folder / name for name in PROGRAMS]
    for program in programs:
        if os.path.lexists(program) and not is_ours(program):
            raise InputError(f"{program}: exists, and is not of Sunpeak's making; expected a folder of its own")
    folder.mkdir(parents=True, exist_ok=True)
    for program in programs:
        text = SCRIPT.format(name=program.name, mark=MARK, python=shlex.quote(sys.executable))
        with whole_file(program) as temporary:
            temporary.write_text(text, encoding="utf-8")
            temporary.chmod(EXECUTABLE)
    return programs
