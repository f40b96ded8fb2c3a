"""Is the class rule right? Writes `glare_seeds.json` beside.

usage: python validation/glare_seeds.py      (about ten minutes on two cores)

A hundred runs of `--error class` in the demo's room under suns that bring DGP near a border: how often the class is
right, wrong or undecided. (Intervals: `light_transport.py`.)
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

TRUTH_SEEDS = range(1000, 1004)
RUNS = range(100)
CLASS_SIZE, CLASS_TRUTH_SAMPLES = 40, 512
CLASS_CASES = (
    ("t3-1024", "off", 960.0),
    ("t3-1024", "off", 1100.0),
    ("t3-1024", "split", 58.0),
)
"""Basis, rule, direct normal irradiance [W/m²]: DGP comes near 0.35 by a smeared sun, and by an exact one."""


def world_of(folder: Path, basis: str, peak: Peak, direct_normal_w_m2: float) -> sp.World:
    """The demo's room under a sun."""
    room = dataclasses.replace(DEMO_ROOM, direct_normal_w_m2=direct_normal_w_m2)
    return sp.World.compile(sp.Scene.load([*room.write(folder), room.hang(folder, basis)]), peak)


def judged(world: sp.World, size: int, **how: Any) -> sp.GlareReport:
    """Glare of one picture."""
    return sp.glare(sp.render(world, sp.View.parse(DEMO_ROOM.view_options()), (size, size), **how))


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
    """All cases, as JSON."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        found = {
            "class_rule": [class_rule(folder, *case) for case in CLASS_CASES],
        }
    TARGET.write_text(json.dumps(found, indent=1) + "\n")
    print(TARGET.read_text())


if __name__ == "__main__":
    main()
