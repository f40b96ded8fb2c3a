"""Seconds to read and to judge a fisheye picture of ten million pixels, and the memory that takes.

usage: python benches/glare_picture.py [PIXELS ACROSS]        (prints one JSON object)
"""

import json
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import sunpeak as sp

ACROSS = 3200
VIEW = "-vta -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180"


def draw(across: int, path: Path) -> None:
    """Write noise around 300 cd/m², so that it is not compressed, and a window in it."""
    pixels = np.random.default_rng(1).lognormal(0.5, 1.0, (across, across, 1)).astype(np.float32) * np.ones(
        3, np.float32
    )
    pixels[across // 3 : across // 2, across // 4 : across // 3] *= 20
    sp.Picture.of(pixels, sp.View.parse(VIEW)).save(path)


def main() -> None:
    """Draw, read and judge."""
    across = int(sys.argv[1]) if len(sys.argv) > 1 else ACROSS
    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary) / "large.hdr"
        draw(across, path)
        start = time.perf_counter()
        picture = sp.Picture.load(path)
        read_s = time.perf_counter() - start
        used = resource.getrusage(resource.RUSAGE_SELF).ru_utime
        start = time.perf_counter()
        report = sp.glare(picture)
        row = {
            "pixels": across**2,
            "file_mb": round(path.stat().st_size / 1e6),
            "read_s": round(read_s, 2),
            "glare_s": round(time.perf_counter() - start, 2),
            "glare_cpu_s": round(resource.getrusage(resource.RUSAGE_SELF).ru_utime - used, 2),
            "sources": len(report.sources),
        }
        print(json.dumps(row))


if __name__ == "__main__":
    main()
