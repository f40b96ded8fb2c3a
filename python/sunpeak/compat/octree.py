"""What our `oconv` writes: a header as Radiance's, then the parts of a scene.

A part is a scene file by its absolute path, a command, or the text of primitives whose commands are done (`-f`,
standard input). The format is our own, with a name of its own, so that Radiance's programs refuse it and ours
refuse Radiance's.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

from sunpeak import _core
from sunpeak._core import InputError
from sunpeak.compat import header

FORMAT = "Sunpeak_octree"
RADIANCE_FORMAT = "Radiance_octree"
VERSION = 1
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
    surfaces: int
    """How many there were when it was written."""
    history: list[str] = field(default_factory=list)
    """Header lines that say how it was made."""
    name: str = "octree"

    def encode(self) -> bytes:
        """Give the bytes of its file."""
        parts: list[dict[str, Any]] = []
        texts = []
        for part in self.parts:
            if isinstance(part, File):
                parts.append({"file": part.name})
            else:
                parts.append({"text": part.name, "directory": part.directory, "bytes": len(part.text)})
                texts.append(part.text)
        body = {"version": VERSION, "cwd": self.cwd, "surfaces": self.surfaces, "parts": parts}
        lines = header.text([*self.history, f"FORMAT={FORMAT}"])
        return b"".join([lines, json.dumps(body).encode(), b"\n", *texts])

    def scene(self) -> _core.Scene:
        """Read the scene; refuse it where files have other surfaces than they had."""
        # Files that materials name are looked for where the program runs, too, as in Radiance.
        scene = load(self.parts, self.cwd, [str(Path.cwd())])
        found = len(scene.surface_names)
        if found != self.surfaces:
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
    file = BytesIO(data)
    lines = header.read(file, name) if data.startswith(b"#?") else []
    form = header.value(lines, "FORMAT")
    if form == RADIANCE_FORMAT:
        raise InputError(f"{name}: an octree of Radiance's oconv; make it with Sunpeak's (it names its scene: getinfo)")
    if form != FORMAT:
        raise InputError(f"{name}: not an octree; expected a file written by Sunpeak's oconv")
    try:
        body = json.loads(file.readline())
        if body["version"] != VERSION:
            raise InputError(f"{name}: version {body['version']} of the format; expected {VERSION}: run oconv again")
        parts = [read_part(part, file) for part in body["parts"]]
        octree = Octree(str(body["cwd"]), parts, int(body["surfaces"]), name=name)
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{name}: a damaged octree ({error}); run oconv again") from error
    octree.history = [line for line in lines[1:] if not line.startswith("FORMAT=")]
    return octree


def read_part(part: dict[str, Any], file: BytesIO) -> Part:
    """Read one part, and its text."""
    if "file" in part:
        return File(str(part["file"]))
    text = file.read(int(part["bytes"]))
    if len(text) != int(part["bytes"]):
        raise ValueError("it ends too early")
    return Text(str(part["text"]), str(part["directory"]), text)
