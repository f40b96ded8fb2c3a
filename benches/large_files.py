"""Loading large BSDF files: time the first and the second time, and memory at rest.

usage: python benches/large_files.py        (makes a file of 400 MB in a temporary folder, and removes it)

A tensor tree of rank 4 with 64 cells a side, on both sides, loaded by processes of their own: beside Radiance's
library, where it is installed, and the limits that we set ourselves.
"""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from table import heading, row

import sunpeak as sp

BASIS = "t4-4096"

# What we ask of ourselves: seconds for the first load, bytes a value at rest.
LIMIT_S = 5.0
LIMIT_BYTES = 6.0

OURS = "import sunpeak as sp; load = sp.Bsdf.load"
THEIRS = "import pyradiance.bsdf as library; load = library.load_file"

# Prints seconds, seconds of all processors together, and how much memory came with the file [bytes] beside what any
# file takes: code, threads, buffers.
CHILD = """
import json, sys, time
{imports}
def resident():
    line = next(line for line in open("/proc/self/status") if line.startswith("VmRSS"))
    return 1024 * int(line.split()[1])
small = load(sys.argv[2])
before, start, busy = resident(), time.perf_counter(), time.process_time()
bsdf = load(sys.argv[1])
print(json.dumps([time.perf_counter() - start, time.process_time() - busy, resident() - before]))
"""


class Load(NamedTuple):
    """What loading took."""

    wall_s: float
    processors_s: float
    memory: int


def load(path: Path, small: Path, imports: str, cache: Path) -> Load:
    """Load a file in a process of its own, after a small one."""
    command = [sys.executable, "-c", CHILD.format(imports=imports), path, small]
    env = os.environ | {"SUNPEAK_CACHE": str(cache)}
    return Load(*json.loads(subprocess.run(command, env=env, capture_output=True, check=True).stdout))


def values_in(path: Path) -> int:
    """Numbers of the trees, which stand on lines that begin with a brace."""
    with path.open() as lines:
        return sum(len(line.split()) - line.count("{") - line.count("}") for line in map(spaced, lines) if line)


def spaced(line: str) -> str:
    """The line with its braces apart; nothing if it is markup."""
    return "" if line.lstrip()[:1] == "<" else line.replace("{", " { ").replace("}", " } ")


def main() -> None:
    """Make a file, load it three times."""
    with tempfile.TemporaryDirectory() as temporary:
        path, cache = Path(temporary, "large.xml"), Path(temporary, "cache")
        sp.Fabric().write(path, BASIS)
        small = Path(temporary, "small.xml")
        sp.Fabric().write(small, "t4-256")
        values = values_in(path)
        print(f"\n{BASIS}, both sides: {path.stat().st_size / 1e6:.0f} MB, {values / 1e6:.1f} million values")
        first, second = (load(path, small, OURS, cache) for _ in range(2))
        theirs = load(path, small, THEIRS, cache) if importlib.util.find_spec("pyradiance") else None
        heading("loading", "s", "Radiance's library")
        row("first time", first.wall_s, theirs and theirs.wall_s)
        row("first time, all processors", first.processors_s, theirs and theirs.processors_s)
        row("second time, from the cache", second.wall_s, theirs and theirs.wall_s)
        heading("loading", "s", "the limit")
        row("first time", first.wall_s, LIMIT_S)
        heading("memory at rest", "bytes a value", "the limit")
        row("after the first time", first.memory / values, LIMIT_BYTES)
        row("from the cache", second.memory / values, LIMIT_BYTES)


if __name__ == "__main__":
    main()
