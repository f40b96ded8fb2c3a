"""Loading a scene of a million polygons: time and memory at its peak.

usage: python benches/large_scene.py        (makes a file of 150 MB in a temporary folder, and removes it)

Read and checked by `Scene.load` in a process of its own, and by Radiance's `oconv`, where it is installed, which builds
its tree besides.
"""

import importlib.util
import random
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from table import heading, row

POLYGONS = 1_000_000

# What we ask of ourselves.
LIMIT_S = 3.0
LIMIT_MB = 500.0

CHILD = "import sys, sunpeak; sunpeak.Scene.load(sys.argv[1])"


def write_scene(path: Path) -> None:
    """Small rectangles all over a cube of 100 m."""
    chance = random.Random(1)
    with path.open("w") as file:
        file.write("void plastic white 0 0 5 .5 .5 .5 0 0\n")
        for number in range(POLYGONS):
            x, y, z = (100 * chance.random() for _ in range(3))
            width, depth = 0.1 * chance.random(), 0.1 * chance.random()
            corners = [(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)]
            lines = "\n".join(f"\t{a:.6f} {b:.6f} {z:.6f}" for a, b in corners)
            file.write(f"white polygon p.{number}\n0\n0\n12\n{lines}\n")


def load(path: Path) -> tuple[float, float]:
    """Seconds, and megabytes at the peak."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", CHILD, path], check=True)
    seconds = time.perf_counter() - start
    return seconds, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3


def oconv(path: Path) -> float | None:
    """Seconds of Radiance's oconv."""
    package = importlib.util.find_spec("pyradiance")
    if package is None or not package.submodule_search_locations:
        return None
    program = Path(package.submodule_search_locations[0], "bin", "oconv")
    start = time.perf_counter()
    with path.with_suffix(".oct").open("wb") as output:
        subprocess.run([program, "-w", path], stdout=output, check=True)
    return time.perf_counter() - start


def main() -> None:
    """Make the scene, load it."""
    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary, "large.rad")
        write_scene(path)
        print(f"\n{POLYGONS / 1e6:.0f} million polygons: {path.stat().st_size / 1e6:.0f} MB")
        seconds, megabytes = load(path)
        heading("reading a scene", "s", "Radiance's oconv")
        row("a million polygons", seconds, oconv(path))
        heading("reading a scene", "s", "the limit")
        row("a million polygons", seconds, LIMIT_S)
        heading("memory at the peak", "MB", "the limit")
        row("a million polygons", megabytes, LIMIT_MB)


if __name__ == "__main__":
    main()
