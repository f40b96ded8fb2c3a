"""Do stated intervals agree with what repetition shows, and is the class rule right? Writes `glare_seeds.json` beside.

usage: python validation/glare_seeds.py      (about ten minutes on two cores)

- The demo's room, twenty seeds, without and with peak extraction: standard deviation of DGP and Ev against the stated
  one, and how many of the intervals hold the truth, a long run.
- A hundred runs of `--error class` in the same room under suns that bring DGP near a border: how often the class is
  right, wrong or undecided.
"""

import dataclasses
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import sunpeak as sp
from sunpeak.demo import DEMO_ROOM
from sunpeak.scattering import Peak

TARGET = Path(__file__).with_suffix(".json")

SEEDS = range(20)
SIZE, SAMPLES = 160, 16
TRUTH_SAMPLES, TRUTH_SEEDS = 64, range(1000, 1004)

RUNS = range(100)
CLASS_SIZE, CLASS_TRUTH_SAMPLES = 40, 512
CLASS_CASES = (
    ("t3-1024", "off", 960.0),
    ("t3-1024", "off", 1100.0),
    ("t3-1024", "split", 58.0),
)
"""Basis, rule, direct normal irradiance [W/m²]: DGP comes near 0.35 by a smeared sun, and by an exact one."""

CONFIDENCE = 1.96


def world_of(folder: Path, basis: str, peak: Peak, direct_normal_w_m2: float) -> sp.World:
    """The demo's room under a sun."""
    room = dataclasses.replace(DEMO_ROOM, direct_normal_w_m2=direct_normal_w_m2)
    return sp.World.compile(sp.Scene.load([*room.write(folder), room.hang(folder, basis)]), peak)


def judged(world: sp.World, size: int, **how: Any) -> sp.GlareReport:
    """Glare of one picture."""
    return sp.glare(sp.render(world, sp.View.parse(DEMO_ROOM.view_options()), (size, size), **how))


def intervals(folder: Path, basis: str, peak: Peak) -> dict[str, Any]:
    """Twenty seeds against what each of them states."""
    world = world_of(folder, basis, peak, DEMO_ROOM.direct_normal_w_m2)
    reports = [judged(world, SIZE, samples=SAMPLES, seed=seed) for seed in SEEDS]
    long_run = [judged(world, SIZE, samples=TRUTH_SAMPLES, seed=seed) for seed in TRUTH_SEEDS]
    row: dict[str, Any] = {"basis": basis, "peak": peak, "size": SIZE, "samples": SAMPLES, "seeds": len(SEEDS)}
    for name in ("dgp", "ev_lux"):
        values = [getattr(report, name) for report in reports]
        ends = np.array([report.sampling_intervals[name] for report in reports if report.sampling_intervals])
        truth = float(np.mean([getattr(report, name) for report in long_run]))
        row[name] = {
            "truth": truth,
            "standard_deviation": float(np.std(values, ddof=1)),
            "stated": float(np.mean(np.diff(ends, axis=1)) / 2 / CONFIDENCE),
            "intervals_that_hold_the_truth": int(((ends[:, 0] <= truth) & (truth <= ends[:, 1])).sum()),
        }
    return row


def class_rule(folder: Path, basis: str, peak: Peak, direct_normal_w_m2: float) -> dict[str, Any]:
    """A hundred runs until the class cannot change, against the class of a long run."""
    world = world_of(folder, basis, peak, direct_normal_w_m2)
    long_run = [judged(world, CLASS_SIZE, samples=CLASS_TRUTH_SAMPLES, seed=seed) for seed in TRUTH_SEEDS]
    truth = float(np.mean([report.dgp for report in long_run]))
    noise = float(np.std([report.dgp for report in long_run], ddof=1) / np.sqrt(len(long_run)))
    right = class_of(truth)
    start = time.monotonic()
    verdicts = [judged(world, CLASS_SIZE, until="class", seed=seed).verdict for seed in RUNS]
    return {
        "basis": basis,
        "peak": peak,
        "direct_normal_w_m2": direct_normal_w_m2,
        "size": CLASS_SIZE,
        "dgp": truth,
        "dgp_standard_error": noise,
        "class": right,
        "right": verdicts.count(right),
        "undecided": verdicts.count("undecided"),
        "wrong": sum(verdict not in (right, "undecided") for verdict in verdicts),
        "seconds_a_run": round((time.monotonic() - start) / len(RUNS), 3),
    }


def class_of(dgp: float) -> str:
    """The published limits (Wienold 2009)."""
    names = ("imperceptible", "perceptible", "disturbing", "intolerable")
    return names[int(np.searchsorted((0.35, 0.40, 0.45), dgp))]


def main() -> None:
    """Both, as JSON."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        found = {
            "intervals": [intervals(folder, basis, peak) for basis, peak in (("t3-4096", "off"), ("t3-4096", "split"))],
            "class_rule": [class_rule(folder, *case) for case in CLASS_CASES],
        }
    TARGET.write_text(json.dumps(found, indent=1) + "\n")
    print(TARGET.read_text())


if __name__ == "__main__":
    main()
