"""Radiance's generator against closed forms and against itself: into `generate.json`, see `generate.md`.

usage: python validation/generate_spread.py [black paired spread reflected]      (needs pyradiance; three minutes)

black: a sheet that reflects nothing; what Radiance finds is what its rays' places say, and the truth has a closed form.
paired: the same sheet with its reflectance, less what its rays' places did to the black one.
spread: errors without anybody's converged run: the same product sampled in two places, or with two seeds, differs by
the errors of both.
reflected: what the sheet reflects in a few patches, by Radiance's rtrace with as many rays as settle it.
"""

import json
import math
import os
import subprocess
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

REFLECTED_PATCHES = (0, 3, 15, 33, 55, 79, 103, 125)
"""One of each ring up to 75 degrees: round holes are nearly the same at all azimuths."""

REFLECTED_RAYS, REFLECTED_SAMPLES = 100_000, 1 << 15
REFLECTED_PARAMS = "-ab 20 -ad 8 -as 0 -aa 0 -lr -20 -lw 0.01 -st 0 -dt 0"

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


def reflected(folder: Path) -> dict[str, Any]:
    """Hemispherical reflectance from the back in some patches: rays of Radiance under an even sky, and our columns.

    What a ray sees of a sky of radiance 1 on its own side is, by reciprocity, what the sheet reflects of light that
    comes along it.
    """
    sheet = Sheet(corners=48)
    scene = "void glow sky\n0\n0\n4 1 1 1 0\nsky source above\n0\n0\n4 0 0 1 180\n" + sheet.radiance(repeat=15)
    octree = subprocess.run(["oconv", "-"], input=scene.encode(), capture_output=True, check=True).stdout
    (folder / "sheet.oct").write_bytes(octree)
    world = runs.loaded(sheet.radiance(), folder, "cell.rad")
    made = sp.generate_bsdf(
        world, "klems", box=sheet.box, periodic=True, samples=REFLECTED_SAMPLES, error=1.0, seed=4, sides=("back",)
    )
    random = np.random.default_rng(6)
    apart, errors = [], []
    for patch in REFLECTED_PATCHES:
        towards = within(patch, random, REFLECTED_RAYS)
        starts = np.column_stack([random.random((REFLECTED_RAYS, 2)) * sheet.pitch, np.full(REFLECTED_RAYS, 1e-4)])
        rays = np.column_stack([starts, -towards]).astype(np.float32)
        done = subprocess.run(
            ["rtrace", "-h", "-ffd", *REFLECTED_PARAMS.split(), str(folder / "sheet.oct")],
            input=rays.tobytes(),
            capture_output=True,
            check=True,
        )
        seen = np.frombuffer(done.stdout).reshape(-1, 3)[:, 1]
        apart.append(float(seen.mean() - made.sides[0].reflectance[patch]))
        errors.append(math.hypot(seen.std() / math.sqrt(len(seen)), made.sides[0].reflectance_error[patch]))
    return {
        "patches": list(REFLECTED_PATCHES),
        "differences": apart,
        "errors": errors,
        "mean_difference": float(np.mean(apart)),
        "error_of_that_mean": float(np.linalg.norm(errors) / len(errors)),
    }


def within(patch: int, random: np.random.Generator, count: int) -> runs.Floats:
    """Directions to the light (count, 3), even in projected solid angle over a patch of Klems's full basis."""
    lower, first = 0, 0
    for upper, azimuths in runs.RINGS:
        if patch < first + azimuths:
            squares = np.sin(np.radians([lower, upper])) ** 2
            sine = np.sqrt(random.uniform(*squares, count))
            phi = 2 * np.pi * (patch - first + random.random(count) - 0.5) / azimuths
            return np.column_stack([sine * np.cos(phi), sine * np.sin(phi), np.sqrt(1 - sine**2)])
        lower, first = upper, first + azimuths
    raise ValueError(patch)


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


Part = Callable[[Path], dict[str, Any]]

PARTS: dict[str, Part] = {"black": black, "paired": paired, "spread": spread, "reflected": reflected}


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
