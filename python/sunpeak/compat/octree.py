"""Octree files: the parts of a scene, as oconv puts them together and rpict and rtrace read them.

A part is a scene file by its absolute path, a command, or the text of primitives whose commands are done (`-f`,
standard input). Our `oconv` writes a format of its own (`crates/scene/src/compiled/parts.rs`); Radiance's octrees
are read too.
"""

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from sunpeak import _core
from sunpeak._core import InputError

ALLOW_COMMANDS = "SUNPEAK_ALLOW_COMMANDS"


@dataclass(frozen=True)
class File:
    """A scene file by its absolute path, or a command with its `!`."""

    name: str


@dataclass(frozen=True)
class Text:
    """Scene text."""

    name: str
    """What messages call it."""
    directory: str
    """Where files that it names are looked for."""
    text: bytes


Part = File | Text


@dataclass
class Octree:
    """A scene as it stands in a file."""

    cwd: str
    """The folder that names in it are relative to."""
    parts: list[Part]
    surfaces: int | None = None
    """How many there were when it was written, if that is known."""
    history: list[str] = field(default_factory=list)
    """Header lines that say how it was made."""
    name: str = "octree"

    def encode(self) -> bytes:
        """Give the bytes of its file."""
        return _core.write_octree(self.history, self.cwd, self.surfaces, core_parts(self.parts))

    def scene(self) -> _core.Scene:
        """Read the scene; refuse it where files have other surfaces than they had."""
        # Files that materials name are looked for where the program runs, too, as in Radiance.
        scene = load(self.parts, self.cwd, [str(Path.cwd())])
        found = len(scene.surface_names)
        if self.surfaces not in (None, found):
            raise InputError(
                f"{self.name}: out of date: its files have {found} surfaces now, and had {self.surfaces} when it was "
                "made; run oconv again"
            )
        return scene


def core_parts(parts: Sequence[Part]) -> list[str | tuple[str, bytes, str]]:
    """Parts as the compiled core wants them."""
    return [part.name if isinstance(part, File) else (part.name, part.text, part.directory) for part in parts]


def load(parts: Sequence[Part], cwd: str, search_path: Sequence[str] = ()) -> _core.Scene:
    """Read parts as a scene."""
    return _core.Scene.load_parts(core_parts(parts), cwd, list(search_path), commands_allowed())


def freeze(parts: Sequence[Part], cwd: str) -> list[Part]:
    """Do all commands and take the files in."""
    texts = _core.expanded_scene(core_parts(parts), cwd, [], commands_allowed())
    return [Text("frozen scene", str(Path(cwd, directory)), text.encode()) for directory, text in texts]


def commands_allowed() -> bool:
    """Say whether commands that Sunpeak does not do itself may run in a shell."""
    return os.environ.get(ALLOW_COMMANDS, "").lower() in ("1", "yes", "true", "on")


def read(name: str | None) -> Octree:
    """Read an octree file, the output of a `!command`, or standard input (`None`)."""
    if name is None:
        return decode(sys.stdin.buffer.read(), "standard input")
    if name.startswith("!"):
        made = subprocess.run(name[1:], shell=True, stdout=subprocess.PIPE, check=False)
        if made.returncode != 0:
            raise InputError(f'bad status from "{name}"')
        return decode(made.stdout, name)
    return decode(Path(name).read_bytes(), name)


def decode(data: bytes, name: str) -> Octree:
    """Read the bytes of an octree file."""
    history, cwd, surfaces, parts = _core.read_octree(data, name)
    read = [Text(part[0], str(part[2]), part[1]) if isinstance(part, tuple) else File(str(part)) for part in parts]
    # Radiance's names are relative to where the program runs.
    return Octree(str(Path.cwd() / cwd), read, surfaces, history, name)
