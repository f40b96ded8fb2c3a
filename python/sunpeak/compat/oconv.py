"""`oconv`: scene files to one file that rpict and rtrace read."""

import sys
from pathlib import Path

from sunpeak._core import InputError
from sunpeak.compat import header, octree
from sunpeak.compat.octree import File, Part, Text
from sunpeak.compat.options import Table, expand_arguments, parse

TABLE = Table(
    values={"-i": 1, "-n": 1, "-r": 1, "-b": 4},
    switches=frozenset({"-f", "-w"}),
    idle=frozenset({"-n", "-r", "-b"}),
)


def run(arguments: list[str]) -> int:
    """Write the octree to standard output."""
    line = parse(expand_arguments(arguments), TABLE, {"-w": True})
    warn = line.is_on("-w")
    line.note_idle("oconv", quiet=not warn)
    cwd = str(Path.cwd())
    frozen = line.is_on("-f")
    parts: list[Part] = []
    history: list[str] = []
    if line.has("-i"):
        included = octree.read(line.values["-i"][0])
        parts += octree.freeze(included.parts, included.cwd)
        history += included.history
    elif not line.rest:
        raise InputError("no scene: expected files, - for standard input, or -i octree")
    parts += [part_of(name, cwd) for name in line.rest]
    scene = octree.load(parts, cwd)
    if frozen:
        parts = octree.freeze(parts, cwd)
    if warn:
        sys.stderr.writelines(f"oconv: warning - {warning}\n" for warning in scene.warnings)
    history.append(header.command_line("oconv", arguments))
    made = octree.Octree(cwd, parts, len(scene.surface_names), history=history)
    header.write_stdout(made.encode())
    return 0


def part_of(name: str, cwd: str) -> Part:
    """A word of the command line: a file, a `!command`, or `-` for standard input."""
    if name == "-":
        return Text("standard input", cwd, sys.stdin.buffer.read())
    if name.startswith("!"):
        return File(name)
    if not Path(name).exists():
        raise FileNotFoundError(2, "cannot open scene file", name)
    return File(str(Path(cwd, name)))
