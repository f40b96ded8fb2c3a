"""CPU time of `rpict` and of ours to the same error, in rooms behind shades.

usage, inside benches/: python -m transport [--only NAME ...] [--reference-error E] [--limit-s S] [--out DIR] …

Each room is seen by a 180-degree fisheye of 240 x 240 pixels. Errors are root mean squares over blocks of 3 degrees,
relative to the picture's mean luminance, against a reference that our path tracer makes with other seeds; it says how
far it has converged itself. Blocks within 3 degrees of a sun that the eye sees are left out: neither program's pixels
hold it. Ev is compared without them, DGP with the reference in their place. What ours errs is the root mean square of
several seeds, what `rpict` errs that of several pictures with the eye moved by a tenth of a millimetre, where one takes
less than half a minute, else of its one picture; of the times the least of theirs counts, of ours the mean. `rpict`
runs in one process with several qualities, with and without its ambient cache, two at a time; ours runs with doubling
numbers of paths, loading and compiling counted. Where the room has an `aBSDF`, Radiance extracts its peak by its own
rule, and its reference is made under that rule.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pyradiance

import sunpeak as sp
from sunpeak.images import LUMINOUS_EFFICACY

from .rooms import BenchRoom, rooms

Floats = npt.NDArray[np.float64]

SIZE, BLOCKS = 240, 60
RADIANCE = Path(pyradiance.__file__).parent
COMMON = ("-ps", "1", "-pt", "0", "-t", "0")
WHOLE = ("-aa", "0", "-as", "0", "-lr", "-20", "-lw", "1e-7", "-st", "0")
"""Neither cache nor truncation."""

QUALITIES: dict[str, tuple[str, ...]] = {
    "cache, low": ("-ab", "3", "-aa", ".2", "-ar", "64", "-ad", "512", "-as", "128", "-lw", "2e-3"),
    "cache, middle": ("-ab", "5", "-aa", ".1", "-ar", "128", "-ad", "2048", "-as", "512", "-lw", "5e-5"),
    "cache, high": ("-ab", "7", "-aa", ".07", "-ar", "256", "-ad", "8192", "-as", "2048", "-lw", "1e-5"),
    "no cache, low": (*WHOLE, "-ab", "5", "-ad", "8", "-ss", "16"),
    "no cache, middle": (*WHOLE, "-ab", "6", "-ad", "32", "-ss", "32"),
    "no cache, high": (*WHOLE, "-ab", "7", "-ad", "128", "-ss", "64"),
}
OUR_SEEDS = {1: 6, 2: 6, 4: 4, 8: 3, 16: 2, 32: 1}
"""Of each number of paths."""

RPICT_PICTURES, RPICT_REPEATED_S = 4, 30.0
"""So many pictures of `rpict`, where one takes less than this [s]."""

RPICT_STEP_M = 1e-4
"""How far the eye moves from one to the next."""

QUANTITIES = ("rmse", "ev", "dgp")


class Measured:
    """A room on disk with its references."""

    def __init__(self, room: BenchRoom, folder: Path, reference_error: float, limit_s: float) -> None:
        """Write it and make the references, in so much CPU time each."""
        self.room, self.folder = room, folder
        folder.mkdir(parents=True, exist_ok=True)
        self.files = room.write(folder)
        self.view = sp.View.parse(room.view)
        self.mask = mask(self.view, room.sun)
        cosine = self.view.rays(BLOCKS, BLOCKS).directions @ np.asarray(self.view.direction)
        self.weights = np.nan_to_num(self.view.solid_angles(BLOCKS, BLOCKS) * cosine)
        self.reference, self.reference_error = self.converged(room.peak, reference_error, limit_s)
        if room.rad_peak == room.peak:
            self.rad_reference, self.rad_reference_error = self.reference, self.reference_error
        else:
            self.rad_reference, self.rad_reference_error = self.converged(room.rad_peak, reference_error, limit_s)

    def world(self, peak: str) -> sp.World:
        """Load and compile."""
        place = self.room.files_in or self.folder
        return sp.World.compile(sp.Scene.load(self.files, search_path=[place]), peak)  # type: ignore[arg-type]

    def converged(self, peak: str, goal: float, limit_s: float) -> tuple[Floats, float]:
        """Render with new seeds until the mean of all has the error, or the CPU time is spent; kept between calls."""
        kept = self.folder / f"reference_{peak}.npz"
        if kept.exists():
            with np.load(kept) as file:
                return file["mean"], float(file["error"])
        world, passes = self.world(peak), list[Floats]()
        start = time.process_time()
        while True:
            seed = 1000 + len(passes)
            # Long passes: they learn where the noise is, and their sequences converge faster than by their length.
            passes.append(sp.render(world, self.view, (SIZE, SIZE), samples=128, seed=seed).luminance())
            if len(passes) < 4:
                continue
            mean = np.mean(passes, axis=0)
            spread = np.var([blocks(p) for p in passes], axis=0, ddof=1) / len(passes)
            error = float(np.sqrt(spread[self.mask].mean()) / blocks(mean)[self.mask].mean())
            if error < goal or time.process_time() - start > limit_s:
                np.savez(kept, mean=mean, error=error)
                return mean, error

    def theirs(self, quality: str, limit_s: float) -> dict[str, Any]:
        """Run `rpict`: CPU time and errors."""
        run = run_rpict(self.room, self.folder, quality, limit_s)
        if not run["finished"]:
            return run
        runs, seconds = [], []
        for number in range(RPICT_PICTURES if run["cpu_s"] < RPICT_REPEATED_S else 1):
            one = run_rpict(self.room, self.folder, quality, limit_s, number)
            if not one["finished"]:
                break
            seconds.append(one["cpu_s"])
            luminance = sp.Picture.load(picture_of(self.folder, quality, number)).luminance()
            runs.append(self.errors(luminance, self.rad_reference))
        return {**run, "cpu_s": min(seconds), "pictures": len(runs), **root_mean_squares(runs)}

    def errors(self, luminance: Floats, reference: Floats) -> dict[str, float]:
        """Errors of a picture's blocks, and of Ev without the blocks that are left out."""
        ours, truth = blocks(luminance)[self.mask], blocks(reference)[self.mask]
        difference = ours - truth
        ev, true_ev = (float((blocks(p) * self.weights)[self.mask].sum()) for p in (luminance, reference))
        return {
            "ev": ev / true_ev - 1,
            "dgp": self.dgp(luminance, reference) - self.dgp(reference, reference),
            "rmse": float(np.sqrt(np.mean(difference**2)) / truth.mean()),
            "bias": float(difference.mean() / truth.mean()),
        }

    def dgp(self, luminance: Floats, reference: Floats) -> float:
        """DGP of a picture, the reference in blocks that are left out."""
        edge = SIZE // BLOCKS
        held = np.where(np.kron(self.mask, np.ones((edge, edge), bool)), luminance, reference)
        pixels = np.repeat(held[..., None] / LUMINOUS_EFFICACY, 3, axis=2)
        return sp.glare(sp.Picture.of(pixels, self.view)).dgp


def root_mean_squares(runs: list[dict[str, float]]) -> dict[str, float]:
    """Of the errors of several pictures; of their bias the mean."""
    errors = {key: float(np.sqrt(np.mean([run[key] ** 2 for run in runs]))) for key in QUANTITIES}
    return {**errors, "bias": float(np.mean([run["bias"] for run in runs]))}


def blocks(luminance: Floats) -> Floats:
    """Means over blocks of 3 degrees."""
    edge = SIZE // BLOCKS
    return luminance.reshape(BLOCKS, edge, BLOCKS, edge).mean(axis=(1, 3))


def mask(view: sp.View, sun: tuple[float, float, float] | None) -> npt.NDArray[np.bool_]:
    """Blocks inside the circle and away from the sun."""
    at = (np.arange(BLOCKS) + 0.5) / BLOCKS * 2 - 1
    x, y = np.meshgrid(at, -at)
    inside = np.hypot(x, y) < 1 - 1.5 / BLOCKS
    if sun is None:
        return inside
    directions = view.rays(BLOCKS, BLOCKS).directions
    cosine = directions.reshape(BLOCKS, BLOCKS, 3) @ np.asarray(sun)
    return inside & (cosine < np.cos(np.radians(4.5)))


def octree_of(room: BenchRoom, folder: Path) -> Path:
    """Make the octree, once."""
    octree = folder / "scene.oct"
    if not octree.exists():
        folder.mkdir(parents=True, exist_ok=True)
        environment = radiance_environment(folder)
        with octree.open("wb") as out:
            place = room.files_in or folder
            subprocess.run(["oconv", *room.write(folder)], cwd=place, env=environment, stdout=out, check=True)
    return octree


def radiance_environment(*folders: Path) -> dict[str, str]:
    """Where Radiance finds its programs and its files."""
    paths = [".", *map(str, folders), str(RADIANCE / "lib")]
    return {**os.environ, "PATH": f"{RADIANCE / 'bin'}:{os.environ['PATH']}", "RAYPATH": ":".join(paths)}


def picture_of(folder: Path, quality: str, number: int) -> Path:
    """Where a picture of `rpict` is."""
    return folder / f"rpict {quality}{f' {number}' if number else ''}.hdr"


def run_rpict(room: BenchRoom, folder: Path, quality: str, limit_s: float, number: int = 0) -> dict[str, Any]:
    """Run `rpict` once: CPU time, and whether it finished. Its picture is kept, and not made again."""
    picture = picture_of(folder, quality, number)
    kept = picture.with_suffix(".json")
    eye = np.array(sp.View.parse(room.view).position) + number * RPICT_STEP_M
    if kept.exists():
        run: dict[str, Any] = json.loads(kept.read_text())
        if run["finished"] or run["cpu_s"] >= limit_s:
            return run
    octree, environment = octree_of(room, folder), radiance_environment(folder)
    command = [
        "rpict",
        *room.view.split(),
        "-vp",
        *map(repr, eye.tolist()),
        "-x",
        str(SIZE),
        "-y",
        str(SIZE),
        *COMMON,
        *QUALITIES[quality],
        str(octree),
    ]
    with picture.open("wb") as out:
        place = room.files_in or folder
        process = subprocess.Popen(command, cwd=place, env=environment, stdout=out, stderr=subprocess.DEVNULL)
        cpu_s = 0.0
        while process.poll() is None:
            time.sleep(0.05)
            cpu_s = cpu_of(process.pid) or cpu_s
            if cpu_s > limit_s:
                process.kill()
                process.wait()
    run = {"quality": quality, "cpu_s": cpu_s, "finished": process.returncode == 0}
    kept.write_text(json.dumps(run) + "\n")
    return run


def cpu_of(pid: int) -> float | None:
    """CPU time of a process so far [s]."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (OSError, IndexError):
        return None
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run_ours(measured: Measured, samples: int) -> dict[str, Any]:
    """Load, compile and render with several seeds: CPU time, and root mean squares of the errors."""
    runs, seconds = [], []
    for seed in range(OUR_SEEDS[samples]):
        start = time.process_time()
        world = measured.world(measured.room.peak)
        luminance = sp.render(world, measured.view, (SIZE, SIZE), samples=samples, seed=7 + seed).luminance()
        seconds.append(time.process_time() - start)
        runs.append(measured.errors(luminance, measured.reference))
    return {"samples": samples, "seeds": len(runs), "cpu_s": float(np.mean(seconds)), **root_mean_squares(runs)}


def time_to(error: float, ours: list[dict[str, Any]], key: str) -> float:
    """CPU time at which ours has an error, between its runs; by the law of large numbers beyond them."""
    errors = np.minimum.accumulate([run[key] for run in ours])
    times = np.array([run["cpu_s"] for run in ours])
    if error >= errors[0]:
        return float(times[0])
    if error <= errors[-1]:
        return float(times[-1] * (errors[-1] / error) ** 2)
    return float(np.exp(np.interp(-np.log(error), -np.log(errors), np.log(times))))


def compare(theirs: list[dict[str, Any]], ours: list[dict[str, Any]]) -> None:
    """Add to each run of `rpict` our CPU time to its errors, and the ratio of its own cheapest way there to that."""
    for run in theirs:
        for key in QUANTITIES:
            error = abs(run[key])
            run[f"ours_{key}_cpu_s"] = time_to(error, ours, key)
            cheapest = min(other["cpu_s"] for other in theirs if abs(other[key]) <= error)
            run[f"{key}_ratio"] = cheapest / run[f"ours_{key}_cpu_s"]


def main() -> None:
    """Measure, print, and keep the raw results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="rooms whose names begin so")
    parser.add_argument("--reference-error", type=float, default=0.005, help="of the reference [-]")
    parser.add_argument("--reference-limit-s", type=float, default=1200.0, help="CPU time of one reference [s]")
    parser.add_argument("--limit-s", type=float, default=300.0, help="CPU time of one rpict [s]")
    parser.add_argument("--work", type=Path, help="folder for rooms and references, kept (else a temporary one)")
    parser.add_argument("--out", type=Path, help="folder for the raw results")
    parser.add_argument("--qualities", nargs="+", choices=QUALITIES, default=list(QUALITIES), help="of rpict")
    parser.add_argument("--ours-only", action="store_true", help="leave rpict out")
    parser.add_argument(
        "--rpict-only", action="store_true", help="only run rpict, one at a time, and keep its pictures"
    )
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        work = options.work or Path(temporary)
        results = []
        for room in rooms():
            if options.only and not any(room.name.startswith(name) for name in options.only):
                continue
            folder = work / room.name.replace(", ", "-").replace(" ", "-")
            if options.rpict_only:
                for quality in options.qualities:
                    print(room.name, run_rpict(room, folder, quality, options.limit_s), flush=True)
                continue
            results.append(measure(room, folder, options))
            if options.out:
                options.out.mkdir(parents=True, exist_ok=True)
                content = {"machine": f"{platform.machine()}, {os.cpu_count()} cores", "rooms": results}
                (options.out / "transport.json").write_text(json.dumps(content, indent=1) + "\n")


def described(run: dict[str, Any]) -> str:
    """Time and errors on a line."""
    errors = f"{run['rmse']:>8.2%} bias {run['bias']:>+7.2%} Ev {run['ev']:>+7.2%} DGP {run['dgp']:>+7.4f}"
    return f"{run['cpu_s']:>8.2f} s {errors}"


def measure(room: BenchRoom, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    """Measure one room."""
    measured = Measured(room, folder, options.reference_error, options.reference_limit_s)
    errors = f"{measured.reference_error:.2%}, under Radiance's rule {measured.rad_reference_error:.2%}"
    print(f"\n{room.name}: reference {errors}")
    ours = [run_ours(measured, samples) for samples in OUR_SEEDS]
    for run in ours:
        print(f"  ours, {run['samples']:>3} paths       {described(run)}")
    if options.ours_only:
        return {"room": room.name, "ours": ours}
    octree_of(room, folder)
    with ThreadPoolExecutor(2) as two:
        theirs = list(two.map(lambda quality: measured.theirs(quality, options.limit_s), options.qualities))
    finished = [run for run in theirs if run["finished"]]
    compare(finished, ours)
    for run in theirs:
        if not run["finished"]:
            print(f"  rpict, {run['quality']:<16} {run['cpu_s']:>8.1f} s, not finished")
            continue
        ratios = ", ".join(f"{key} {run[f'{key}_ratio']:.1f}" for key in QUANTITIES)
        print(f"  rpict, {run['quality']:<16} {described(run)}   ours {run['ours_rmse_cpu_s']:.2f} s, ratios {ratios}")
    sys.stdout.flush()
    return {
        "room": room.name,
        "reference_error": measured.reference_error,
        "rad_reference_error": measured.rad_reference_error,
        "ours": ours,
        "rpict": theirs,
    }


if __name__ == "__main__":
    sys.exit(main())
