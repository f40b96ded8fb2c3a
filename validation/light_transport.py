"""Does the renderer keep what it states? Writes `light_transport.json` beside.

usage: python validation/light_transport.py [coverage] [sizes] [paths] [threads]   (all: twenty minutes on two cores)

- `coverage`: a hundred seeds of `--error` in three rooms: how often the true error of the picture's blocks is below the
  bound that the picture states, and how often the intervals of Ev and DGP hold the truth. The truth is the mean of the
  other ninety-nine.
- `sizes`: DGP and Ev of the demo's room in pictures of 200 to 2000 pixels.
- `paths`: pictures of one path a pixel: the largest that a single path brought, over the mean of all.
- `threads`: wall time on one and two threads, processor time, and memory, of a picture of 800 by 800 pixels with an
  error of 1 %.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import sunpeak as sp

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "benches"))
from transport.rooms import BenchRoom, rooms  # noqa: E402

TARGET = Path(__file__).with_suffix(".json")

COVERAGE_ROOMS, COVERAGE_SEEDS, COVERAGE_SIZE, COVERAGE_ERROR = ("demo, t3, PE", "demo, Klems", "deep"), 100, 96, 0.06
SIZES = (200, 400, 800, 1200, 2000)
PATHS_SIZE, PATHS_SEEDS = 240, 16
BIG, BIG_ERROR = 800, 0.01


class Room:
    """A room of the benchmark, compiled."""

    def __init__(self, room: BenchRoom) -> None:
        """Write it into a folder that goes away, and compile it."""
        self.name, self.view = room.name, sp.View.parse(room.view)
        with tempfile.TemporaryDirectory() as folder:
            files = room.write(Path(folder))
            scene = sp.Scene.load(files, search_path=[room.files_in or Path(folder)])
            self.world = sp.World.compile(scene, room.peak)  # type: ignore[arg-type]

    def render(self, size: int, **how: Any) -> sp.Picture:
        """Render a square picture."""
        return sp.render(self.world, self.view, (size, size), **how)


def named(*names: str) -> list[Room]:
    """Give the rooms of these names, or all."""
    return [Room(room) for room in rooms() if not names or room.name in names]


def block_means(luminance: Any, rows: int) -> Any:
    """Of so many rows and columns of blocks [cd/m²]."""
    edge = luminance.shape[0] // rows
    return luminance.reshape(rows, edge, rows, edge).mean(axis=(1, 3))


def without_suns(room: Room, picture: sp.Picture) -> Any:
    """Luminance of the pixels (h, w) [cd/m²], 0 where the picture holds an exact sun: that has no error of sampling."""
    luminance = picture.luminance()
    height, width = picture.shape
    directions = room.view.rays(width, height).directions.reshape(height, width, 3)
    for source in picture.exact_sources:
        luminance[directions @ np.asarray(source.direction) > np.cos(np.radians(1.5))] = 0.0
    return luminance


def coverage() -> list[dict[str, Any]]:
    """Stated and true errors over many seeds."""
    return [covered(room) for room in named(*COVERAGE_ROOMS)]


def covered(room: Room) -> dict[str, Any]:
    """Of one room."""
    pictures = [room.render(COVERAGE_SIZE, error=COVERAGE_ERROR, seed=seed) for seed in range(COVERAGE_SEEDS)]
    n = COVERAGE_SEEDS
    rows = {len(picture.block_errors) for picture in pictures if picture.block_errors is not None}
    blocks = np.array([block_means(without_suns(room, picture), *rows) for picture in pictures])
    # To the mean of the others, which has an error of its own.
    others = (blocks.sum(axis=0) - blocks) / (n - 1)
    errors = np.sqrt(((blocks - others) ** 2).mean(axis=(1, 2)) * (n - 1) / n) / blocks.mean()
    stated = np.array([picture.error for picture in pictures])
    row: dict[str, Any] = {
        "room": room.name,
        "size": COVERAGE_SIZE,
        "seeds": n,
        "goal": COVERAGE_ERROR,
        "stated_mean": float(stated.mean()),
        "true_mean": float(errors.mean()),
        "error_below_bound": int((errors <= stated).sum()),
        "error_below_goal": int((errors <= COVERAGE_ERROR).sum()),
    }
    reports = [sp.glare(picture) for picture in pictures]
    for name in ("ev_lux", "dgp"):
        values = np.array([getattr(report, name) for report in reports])
        ends = np.array([report.sampling_intervals[name] for report in reports if report.sampling_intervals])
        truth = (values.sum() - values) / (n - 1)
        row[name] = {
            "mean": float(values.mean()),
            "standard_deviation": float(values.std(ddof=1)),
            "stated": float(np.mean(np.diff(ends, axis=1)) / 2 / 1.96),
            "intervals_that_hold_the_truth": int(((ends[:, 0] <= truth) & (truth <= ends[:, 1])).sum()),
        }
    return row


def sizes() -> list[dict[str, Any]]:
    """DGP and Ev against the size of the picture."""
    found = []
    for room in named("demo, t3, PE", "demo, Klems, PE"):
        for size in SIZES:
            samples = max(1, round(4 * (800 / size) ** 2))
            report = sp.glare(room.render(size, samples=samples, seed=5))
            row = {"room": room.name, "size": size, "samples": samples, "dgp": report.dgp, "ev_lux": report.ev_lux}
            found.append(row)
    return found


def paths() -> list[dict[str, Any]]:
    """The largest contribution of a single path, over the picture's mean; suns that the eye sees are no paths."""
    found = []
    for room in named():
        largest = []
        for seed in range(PATHS_SEEDS):
            picture = room.render(PATHS_SIZE, samples=1, seed=seed)
            luminance = without_suns(room, picture)
            largest.append(luminance.max() / luminance.mean())
        found.append({"room": room.name, "largest_over_mean": float(max(largest)), "median": float(np.median(largest))})
    return found


def threads() -> list[dict[str, Any]]:
    """Time and memory of a large picture, each in a process of its own."""
    return [json.loads(run_apart(number)) for number in (1, 2)]


def run_apart(number: int) -> str:
    """In a new process, so that its memory is its own."""
    command = [sys.executable, __file__, "big", str(number)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def big(number: int) -> None:
    """Render the large picture on so many threads."""
    (room,) = named("demo, t3, PE")
    wall, cpu = time.monotonic(), time.process_time()
    picture = room.render(BIG, error=BIG_ERROR, threads=number, seed=1)
    row = {
        "threads": number,
        "wall_s": time.monotonic() - wall,
        "cpu_s": time.process_time() - cpu,
        "error": picture.error,
        "memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(row))


PARTS: dict[str, Callable[[], list[dict[str, Any]]]] = {
    "coverage": coverage,
    "sizes": sizes,
    "paths": paths,
    "threads": threads,
}


def main() -> None:
    """Measure what is asked for; the rest stays as it is in the file."""
    if sys.argv[1:2] == ["big"]:
        big(int(sys.argv[2]))
        return
    found = json.loads(TARGET.read_text()) if TARGET.exists() else {}
    for name in sys.argv[1:] or PARTS:
        found[name] = PARTS[name]()
        print(name, json.dumps(found[name], indent=1), flush=True)
        TARGET.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
