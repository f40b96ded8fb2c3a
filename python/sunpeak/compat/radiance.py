"""Radiance's own programs, for what Sunpeak does not do.

A program that Sunpeak lacks is Radiance's, where that is installed; so is one of the same name where an option asks
for what Sunpeak does not give (the tree of rays, other primaries). Its octree is made anew by Radiance's `oconv`.
"""

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from sunpeak._core import InputError
from sunpeak.compat import octree
from sunpeak.compat.options import NotDoneError, expand_arguments
from sunpeak.compat.quality import OWN_VALUES

MARK = "written by `sunpeak compat install`"
"""Stands in the small programs of Radiance's names that run Sunpeak."""
WITH_OCTREE = frozenset({"rpict", "rtrace"})
"""Programs whose last argument is an octree."""


def run_instead(name: str, arguments: Sequence[str], refusal: NotDoneError) -> int:
    """Run Radiance's program on the same input, and give its exit status."""
    program = find_program(name)
    if program is None:
        raise InputError(f"{refusal} (Radiance's {name} does, and is not on PATH)")
    words = without_own(expand_arguments(arguments))
    if "-w-" not in words:
        sys.stderr.write(f"{name}: warning - {refusal}: left to {program}\n")
        sys.stderr.flush()
    with TemporaryDirectory(prefix="sunpeak-") as folder:
        if name in WITH_OCTREE and words and not words[-1].startswith(("-", "!")):
            words[-1] = radiance_octree(words[-1], Path(folder))
        return subprocess.run([str(program), *words], check=False).returncode


def without_own(words: list[str]) -> list[str]:
    """Leave out options that Sunpeak alone has."""
    kept: list[str] = []
    rest = iter(words)
    for word in rest:
        if word in OWN_VALUES:
            next(rest, None)
        else:
            kept.append(word)
    return kept


def radiance_octree(name: str, folder: Path) -> str:
    """Give the name of an octree that Radiance reads; one of ours is made anew in a folder."""
    ours = octree.read(name)
    if ours.surfaces is None:
        return name
    oconv = find_program("oconv")
    if oconv is None:
        raise InputError(f"{name}: Radiance's oconv, which has to read its scene, is not on PATH")
    words, folders = [], []
    for number, part in enumerate(ours.parts):
        if isinstance(part, octree.File):
            words.append(part.name)
            continue
        text = folder / f"part{number}.rad"
        text.write_bytes(part.text)
        words.append(str(text))
        folders.append(part.directory)
    path = os.pathsep.join([*dict.fromkeys(folders), os.environ.get("RAYPATH", ".")])
    made = folder / "scene.oct"
    with made.open("wb") as file:
        done = subprocess.run(
            [str(oconv), "-w", *words], stdout=file, cwd=ours.cwd, env=os.environ | {"RAYPATH": path}, check=False
        )
    if done.returncode != 0:
        raise InputError(f"{name}: Radiance's oconv does not read its scene")
    return str(made)


def find_program(name: str) -> Path | None:
    """Find a program on PATH that is not of our making, or else among those that the package pyradiance brings."""
    return next((program for program in candidates(name) if is_program(program)), None)


def candidates(name: str) -> Iterator[Path]:
    """Give the places where a program may be, in order."""
    if os.sep in name:
        return
    yield from (Path(folder or ".", name) for folder in os.environ.get("PATH", os.defpath).split(os.pathsep))
    package = find_spec("pyradiance")
    folders = package.submodule_search_locations if package is not None else None
    yield from (Path(folder, "bin", name) for folder in folders or ())


def is_program(path: Path) -> bool:
    """Say whether a file can be run, and is not of our making."""
    return path.is_file() and os.access(path, os.X_OK) and not is_ours(path)


def is_ours(program: Path) -> bool:
    """Say whether `sunpeak compat install` wrote it."""
    try:
        with program.open("rb") as file:
            return MARK.encode() in file.read(1000)
    except OSError:
        return False
