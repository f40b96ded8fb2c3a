"""Radiance's generator against closed forms and against itself: into `generate.json`, see `generate.md`.

usage: python validation/generate_spread.py [black paired spread]      (needs pyradiance; two minutes)

black: a sheet that reflects nothing; what Radiance finds is what its rays' places say, and the truth has a closed form.
paired: the same sheet with its reflectance, less what its rays' places did to the black one.
spread: errors without anybody's converged run: the same product sampled in two places, or with two seeds, differs by
the errors of both.
"""

import json
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import generate as runs
import numpy as np
import pyradiance

import sunpeak as sp
from sunpeak.generation import Box
from sunpeak.periodic import Sheet, Slats

COUNTS = (60, 240, 960)
"""Rays a column that Radiance is asked for."""

RADII = 200
"""Points of a patch over which the closed form is averaged; a sheet of holes is the same at all azimuths."""

ASIDE = (0.37, 0.21)
"""How far the second place is from the first, in periods of the product."""


def through_of_patches(sheet: Sheet) -> runs.Floats:
    """The closed form's mean over each patch of Klems's full basis, by flux (145,)."""
    means, lower = [], 0
    for upper, count in runs.RINGS:
        squares = np.sin(np.radians([lower, upper])) ** 2
        sine = np.sqrt(squares[0] + np.diff(squares)[0] * (np.arange(RADII) + 0.5) / RADII)
        towards = np.column_stack([sine, np.zeros(RADII), np.sqrt(1 - sine**2)])
        means += [sheet.through(towards).mean()] * count
        lower = upper
    return np.array(means)


def by_radiance(sheet: Sheet, count: int, params: list[str], folder: Path) -> runs.Tables:
    """Radiance's tables of light from the back of fifteen by fifteen holes."""
    scene = folder / "sheet.rad"
    scene.write_text(sheet.radiance(repeat=15), encoding="utf-8")
    return runs.radiance_tables(runs.by_radiance(scene, sheet.box, count, params, False), folder)


def mean_of(apart: runs.Floats) -> dict[str, float]:
    """Mean of differences of columns, its standard error, their root mean square."""
    return {
        "mean_difference": float(apart.mean()),
        "error_of_that_mean": float(apart.std() / np.sqrt(len(apart))),
        "rms_difference": float(np.sqrt((apart**2).mean())),
    }


def black_apart(count: int, folder: Path) -> runs.Floats:
    """What Radiance's straight part of a black sheet is above the closed form, by columns (145,)."""
    sheet = Sheet(corners=48, reflectance=0.0)
    found = by_radiance(sheet, count, ["-ab", "1", "-lw", "1e-7"], folder)
    return found["back transmission"] @ runs.AREAS - through_of_patches(sheet)


def black(folder: Path) -> dict[str, Any]:
    """Radiance's straight part of a black sheet against the closed form, by columns."""
    return {str(count): mean_of(black_apart(count, folder)) for count in COUNTS}


def paired(folder: Path) -> dict[str, Any]:
    """Radiance's transmission of the sheet against ours, and less what its rays' places did to the black one."""
    sheet, (count, params) = Sheet(corners=48), runs.CONVERGED_RADIANCE
    world = runs.loaded(sheet.radiance(), folder, "cell.rad")
    made = sp.generate_bsdf(
        world, "klems", box=sheet.box, periodic=True, samples=1 << 12, error=1.0, seed=2, sides=("back",)
    )
    theirs = by_radiance(sheet, count, params, folder)["back transmission"] @ runs.AREAS
    apart, places = theirs - made.sides[0].transmittance, black_apart(count, folder)
    correlation = float(np.corrcoef(apart, places)[0, 1])
    return {"plain": mean_of(apart), "less_places": mean_of(apart - places), "correlation": correlation}


def spread(folder: Path) -> dict[str, Any]:
    """Errors of cells [1/sr] of both generators, each from two runs of its own, at the times of the page."""
    known = json.loads(runs.TARGET.read_text(encoding="utf-8"))
    slats, sheet = Slats(), Sheet(corners=48)
    products: dict[str, tuple[Slats | Sheet, str, Box]] = {
        "slats": (slats, slats.radiance(length=10, slats=101), moved(slats.box, slats.spacing)),
        "sheet": (sheet, sheet.radiance(repeat=15), moved(sheet.box, sheet.pitch)),
    }
    found = {}
    for name, (product, large, other) in products.items():
        scene = folder / "large.rad"
        scene.write_text(large, encoding="utf-8")
        world = runs.loaded(product.radiance(), folder, "cell.rad")

        def theirs(box: Box, scene: Path = scene) -> runs.Tables:
            made = runs.by_radiance(scene, box, runs.RADIANCE_SAMPLES, None, False)
            return runs.of_back(runs.radiance_tables(made, folder))

        def ours(seed: int, world: sp.World = world, box: Box = product.box, name: str = name) -> runs.Tables:
            made = sp.generate_bsdf(
                world,
                "klems",
                box=box,
                periodic=True,
                samples=known[name]["samples_ours"],
                error=1.0,
                seed=seed,
                sides=("back",),
            )
            return runs.of_back(runs.tables_of(made.bsdf.evaluate))

        both = [theirs(product.box), theirs(other)], [ours(11), ours(12)]
        found[name] = {key: compared(*(run[key] for pair in both for run in pair)) for key in both[0][0]}
    return found


def moved(box: Box, period: float) -> Box:
    """A box of the same size elsewhere in the product."""
    x, y = (share * period for share in ASIDE)
    return box[0] + x, box[1] + x, box[2] + y, box[3] + y, box[4], box[5]


def compared(one: runs.Floats, other: runs.Floats, own: runs.Floats, again: runs.Floats) -> dict[str, float]:
    """Errors of single runs from two: of all cells, and of those that no light goes straight into."""
    found: dict[str, float] = {}
    for name, cells in (("", np.ones(one.shape, dtype=bool)), ("_scattered", ~np.eye(len(one), dtype=bool))):
        theirs, ours = (float(np.sqrt(((a - b)[cells] ** 2).mean() / 2)) for a, b in ((one, other), (own, again)))
        found |= {f"rmse_radiance{name}": theirs, f"rmse_ours{name}": ours, f"ratio{name}": theirs / ours}
    return found


PARTS: dict[str, Callable[[Path], dict[str, Any]]] = {"black": black, "paired": paired, "spread": spread}


def main() -> None:
    """Measure what is asked for, and keep the rest as it was."""
    programs = Path(pyradiance.__file__).parent / "bin"
    os.environ["PATH"] = f"{programs}{os.pathsep}{os.environ['PATH']}"
    for part in sys.argv[1:] or list(PARTS):
        with tempfile.TemporaryDirectory() as folder:
            found = PARTS[part](Path(folder))
        known = json.loads(runs.TARGET.read_text(encoding="utf-8"))
        runs.TARGET.write_text(json.dumps(known | {part: found}, indent=1) + "\n", encoding="utf-8")
        sys.stdout.write(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
