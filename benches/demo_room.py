"""Samples per second of the demo's room with peak extraction, on all cores and on one; beside it the same without.

usage: python benches/demo_room.py
"""

import os
import tempfile
import time
from pathlib import Path

from table import heading, row

import sunpeak as sp
from sunpeak.demo import DEMO_ROOM

BASIS = "t3-4096"
SIZE = (256, 256)
SAMPLES = 8


def samples_per_second(world: sp.World, eye: sp.View, threads: int) -> float:
    """Render the demo's fisheye and count."""
    start = time.perf_counter()
    sp.render(world, eye, SIZE, samples=SAMPLES, threads=threads)
    return SIZE[0] * SIZE[1] * SAMPLES / (time.perf_counter() - start)


def main() -> None:
    """Compile the room twice and render it in turn."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        files = DEMO_ROOM.write(folder)
        scene = sp.Scene.load([*files, DEMO_ROOM.hang(folder, BASIS)])
        eye = sp.View.load(folder / "eye.vf")
        split, off = (sp.World.compile(scene, peak) for peak in ("split", "off"))
        heading(f"demo's room, {BASIS}", "samples/s", "without peak extraction")
        for threads in sorted({1, os.cpu_count() or 1}):
            ours, theirs = (samples_per_second(world, eye, threads) for world in (split, off))
            row(f"threads: {threads}", ours, theirs, higher_is_better=True)


if __name__ == "__main__":
    main()
