"""Samples per second of the demo's room, on all cores and on one.

usage: python benches/demo_room.py        (prints one JSON object a line)
"""

import json
import os
import tempfile
import time
from pathlib import Path

import sunpeak as sp
from sunpeak.demo.study import write_scene, write_shade

BASIS = "t3-4096"
SIZE = (256, 256)
SAMPLES = 8


def main() -> None:
    """Render the demo's fisheye and count."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        files = write_scene(folder)
        scene = sp.Scene.load([*files, write_shade(folder, BASIS)])
        eye = sp.View.load(folder / "eye.vf")
        for peak in ("off", "split"):
            start = time.perf_counter()
            world = sp.World.compile(scene, peak)
            compile_s = time.perf_counter() - start
            for threads in (1, os.cpu_count() or 1):
                start = time.perf_counter()
                sp.render(world, eye, SIZE, samples=SAMPLES, threads=threads)
                rate = SIZE[0] * SIZE[1] * SAMPLES / (time.perf_counter() - start)
                row = {"room": f"demo, {BASIS}", "peak": peak, "threads": threads, "samples_per_s": round(rate)}
                print(json.dumps(row | {"compile_s": round(compile_s, 2)}))


if __name__ == "__main__":
    main()
