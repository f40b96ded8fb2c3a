"""BSDFs from geometry against closed forms and Radiance. Writes `generate.json` beside; `generate.md` tells it.

usage: python validation/generate.py [slats] [sheet] [tree] [direct]    (all: about ten minutes of one core)

- direct: what goes straight through slats, sheets and screens, against closed forms in 50 directions each.
- slats, sheet: the same product by our generator and by pyradiance's `generate_bsdf` with its default
  parameters, at the same processor time; converged runs of both; our file read by Radiance's library.
- tree: an anisotropic tensor tree of 64^4 cells of slats, its through transmittance against the closed form.
"""

import json
import math
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pyradiance
import pyradiance.bsdf as library
from pyradiance.genbsdf import BSDFDataBytes, SamplingBox

import sunpeak as sp
from sunpeak.periodic import Screen, Sheet, Slats
from sunpeak.scattering import Mode

TARGET = Path(__file__).with_suffix(".json")

DIRECTIONS, LEAST_THROUGH = 50, 0.01
DIRECT_RAYS = 1 << 19

RADIANCE_SAMPLES = 24
"""Rays a column of pyradiance's run; everything else as it comes: -ab 5 -ad 700 -lw 3e-6."""

CONVERGED_RADIANCE = 60, ["-ab", "20", "-lw", "1e-7"]
CONVERGED_SAMPLES = 1 << 16

TREE_SAMPLES = 1 << 11

RINGS = ((5, 1), (15, 8), (25, 16), (35, 20), (45, 24), (55, 24), (65, 24), (75, 16), (90, 12))
"""Upper theta [deg] and azimuths of LBNL/Klems Full."""

MODES: tuple[Mode, ...] = ("transmission", "reflection")

Floats = npt.NDArray[np.float64]
Tables = dict[str, Floats]


def processor_time() -> float:
    """Of this process and of those that it has waited for [s]."""
    own, children = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + children.ru_utime


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """Result and processor time [s]."""
    start = processor_time()
    result = work()
    return result, processor_time() - start


def loaded(text: str, folder: Path, name: str) -> sp.World:
    """A scene text, compiled."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return sp.World.compile(sp.Scene.load([path]))


def direct(folder: Path) -> dict[str, Any]:
    """What goes straight, against closed forms."""
    products = {
        "slats 30 deg": Slats(),
        "slats -45 deg, wider than apart": Slats(width=0.06, tilt_deg=-45),
        "sheet 38 % open": Sheet(),
        "sheet, thin": Sheet(thickness=0.1),
        "screen 16 % open": Screen(),
        "screen 4 % open": Screen(diameter=0.8),
    }
    random = np.random.default_rng(1)
    found = {}
    for name, product in products.items():
        world = loaded(product.radiance(), folder, "product.rad")
        many = random.normal(size=(20 * DIRECTIONS, 3))
        many /= np.linalg.norm(many, axis=1)[:, None]
        towards = many[product.through(many) > LEAST_THROUGH][:DIRECTIONS]
        truth = product.through(towards)
        work = lambda w=world, d=towards, p=product: sp.straight_transmittance(  # noqa: E731
            w, d, box=p.box, periodic=True, samples=DIRECT_RAYS
        )
        traced, seconds = timed(work)
        found[name] = {
            "directions": len(towards),
            "largest_relative_error": float(np.abs(traced.through / truth - 1).max()),
            "largest_error": float(np.abs(traced.through - truth).max()),
            "largest_standard_error": float(traced.error.max()),
            "processor_time_s": round(seconds, 1),
        }
    return found


def patches() -> tuple[Floats, Floats]:
    """Middles of the Klems patches on the unit disk (145, 2), and their projected solid angles [sr]."""
    points, areas, lower = [], [], 0
    for upper, count in RINGS:
        theta = 0.0 if count == 1 else math.radians((lower + upper) / 2)
        for k in range(count):
            phi = 2 * math.pi * k / count
            points.append((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi)))
            squares = [math.sin(math.radians(angle)) ** 2 for angle in (lower, upper)]
            areas.append(math.pi * (squares[1] - squares[0]) / count)
        lower = upper
    return np.array(points), np.array(areas)


POINTS, AREAS = patches()


def upwards(points: Floats, side: int) -> Floats:
    """Unit vectors over points of the disk."""
    return np.column_stack([points, side * np.sqrt(1 - (points**2).sum(1))])


def tables_of(evaluate: Callable[[Floats, Floats], Floats]) -> Tables:
    """The four matrices [1/sr], incident by exiting, of a BSDF in the Radiance library's order of arguments."""
    n = len(POINTS)
    sides = {"front transmission": (-1, 1), "back transmission": (1, -1), "front reflection": (-1, -1)}
    sides["back reflection"] = (1, 1)
    found = {}
    for name, (side_in, side_out) in sides.items():
        w_in = np.repeat(upwards(-POINTS, side_in), n, axis=0)
        w_out = np.tile(upwards(POINTS, side_out), (n, 1))
        found[name] = evaluate(w_in, w_out).reshape(n, n)
    return found


def angles(w: Floats) -> list[list[float]]:
    """Theta and phi [deg] of unit vectors (n, 3)."""
    pairs = np.column_stack([np.arccos(w[:, 2]), np.arctan2(w[:, 1], w[:, 0])])
    told: list[list[float]] = np.degrees(pairs).tolist()
    return told


def read_by_radiance(path: Path) -> Callable[[Floats, Floats], Floats]:
    """Luminous values by Radiance's library."""
    table = library.load_file(str(path))

    def evaluate(w_in: Floats, w_out: Floats) -> Floats:
        pairs = zip(angles(w_in), angles(w_out), strict=True)
        return np.array([library.query(table, *a, *b)[1] for a, b in pairs])

    return evaluate


def by_radiance(scene: Path, box: tuple[float, ...], samples: int, params: list[str] | None, front: bool) -> Any:
    """Run pyradiance's generator."""
    return pyradiance.generate_bsdf(
        str(scene), params=params, nsamp=samples, nproc=1, basis="kf", dim=SamplingBox(*box), front=front
    )


def radiance_tables(made: BSDFDataBytes, folder: Path) -> Tables:
    """Their matrices, by way of their file."""
    path = folder / "radiance.xml"
    if not made.front.transmittance:
        made.front = made.back
    path.write_bytes(pyradiance.generate_xml(vis_results=made, basis="kf"))
    return tables_of(sp.Bsdf.load(path).evaluate)


def of_back(tables: Tables) -> Tables:
    """What light from the back does."""
    return {key: table for key, table in tables.items() if key.startswith("back")}


def differences(ours: Tables, theirs: Tables, truth: Tables) -> dict[str, Any]:
    """Root mean square errors against the truth, over all cells and without those that light goes straight into."""
    found = {}
    for name in ours:
        aside = ~np.eye(len(POINTS), dtype=bool) if "transmission" in name else np.full((len(POINTS),) * 2, True)
        rms = [
            [float(np.sqrt(((table[name] - truth[name])[cells] ** 2).mean())) for cells in (aside | True, aside)]
            for table in (ours, theirs)
        ]
        found[name] = {
            "rmse_ours": rms[0][0],
            "rmse_radiance": rms[1][0],
            "ratio": rms[1][0] / rms[0][0],
            "rmse_ours_scattered": rms[0][1],
            "rmse_radiance_scattered": rms[1][1],
            "ratio_scattered": rms[1][1] / rms[0][1],
        }
    return found


def hemispheres(ours: sp.GeneratedBsdf, converged: sp.GeneratedBsdf, theirs: Tables, theirs_ours: Tables) -> Any:
    """Hemispherical values of light from the back: ours against both converged runs, in stated errors."""
    side, best = ours.sides[1], converged.sides[0]
    found = {}
    for name, key in (("transmittance", "back transmission"), ("reflectance", "back reflection")):
        value, error = getattr(side, name), getattr(side, f"{name}_error")
        truth, truth_error = getattr(best, name), getattr(best, f"{name}_error")
        off = (value - truth) / np.maximum(np.hypot(error, truth_error), 1e-9)
        radiance = theirs[key] @ AREAS
        # Radiance states no errors: what its columns differ by from ours is its own spread, its mean is what counts.
        apart = radiance - truth
        found[name] = {
            "columns": len(value),
            "off_in_stated_errors_rms": float(np.sqrt((off**2).mean())),
            "off_in_stated_errors_largest": float(np.abs(off).max()),
            "largest_stated_error": float(error.max()),
            "radiance_converged_mean_difference": float(apart.mean()),
            "radiance_converged_error_of_that_mean": float(apart.std() / math.sqrt(len(apart))),
            "radiance_converged_rms_difference": float(np.sqrt((apart**2).mean())),
            "radiance_default_mean_difference": float((theirs_ours[key] @ AREAS - truth).mean()),
        }
    return found


def in_radiance(made: sp.GeneratedBsdf, path: Path) -> dict[str, float]:
    """Our file as Radiance's library reads it: values at the middles of cells, hemispherical values."""
    made.save(path)
    bsdf = sp.Bsdf.load(path)
    ours, theirs = tables_of(bsdf.evaluate), tables_of(read_by_radiance(path))
    lit = {name: table > 1e-3 * table.max() for name, table in ours.items()}
    value = max(float(np.abs(theirs[name][lit[name]] / ours[name][lit[name]] - 1).max()) for name in ours)
    table = library.load_file(str(path))
    halves = {"transmission": library.SAMPLE_SPT, "reflection": library.SAMPLE_SPR}
    hemispherical = 0.0
    for side in (1, -1):
        w_in = upwards(POINTS, side)
        for mode in MODES:
            flags = library.SAMPLE_DF | halves[mode]
            told = [library.direct_hemi(table, *pair, flags) for pair in angles(w_in)]
            hemispherical = max(hemispherical, float(np.abs(told - bsdf.hemispherical(w_in, mode)).max()))
    return {
        "largest_relative_difference_of_values": value,
        "largest_difference_of_hemispherical_values": hemispherical,
    }


def slats_at_equal_time(folder: Path) -> dict[str, Any]:
    """Slats through both generators."""
    slats = Slats()
    return equal_time(folder, slats, slats.radiance(), slats.radiance(length=10, slats=101))


def sheet_at_equal_time(folder: Path) -> dict[str, Any]:
    """A perforated sheet through both generators."""
    sheet = Sheet(corners=48)
    return equal_time(folder, sheet, sheet.radiance(), sheet.radiance(repeat=15))


def equal_time(folder: Path, product: Slats | Sheet, cell: str, large: str) -> dict[str, Any]:
    """The same product through both generators: one cell of it by ours, a large piece by Radiance's."""
    world = loaded(cell, folder, "cell.rad")
    scene = folder / "large.rad"
    scene.write_text(large, encoding="utf-8")

    def generate(samples: int, seed: int, sides: Any = ("front", "back")) -> Any:
        return sp.generate_bsdf(
            world, "klems", box=product.box, periodic=True, samples=samples, error=1.0, seed=seed, sides=sides
        )

    theirs, their_time = timed(lambda: by_radiance(scene, product.box, RADIANCE_SAMPLES, None, True))
    their_tables = radiance_tables(theirs, folder)
    # As many rays as take no longer.
    _, pilot = timed(lambda: generate(1 << 12, 9))
    samples = int(their_time / pilot * (1 << 12) * 0.95)
    ours, our_time = timed(lambda: generate(samples, 1))
    truth, truth_time = timed(lambda: generate(CONVERGED_SAMPLES, 2, ("back",)))
    samples_best, params = CONVERGED_RADIANCE
    best, best_time = timed(lambda: by_radiance(scene, product.box, samples_best, params, False))
    best_tables = radiance_tables(best, folder)
    our_tables, true_tables = (of_back(tables_of(made.bsdf.evaluate)) for made in (ours, truth))
    return {
        "processor_time_radiance_s": round(their_time, 1),
        "processor_time_ours_s": round(our_time, 1),
        "samples_radiance": RADIANCE_SAMPLES,
        "samples_ours": samples,
        "processor_time_converged_ours_s": round(truth_time, 1),
        "processor_time_converged_radiance_s": round(best_time, 1),
        "against_our_converged": differences(our_tables, of_back(their_tables), true_tables),
        "against_radiance_converged": differences(our_tables, of_back(their_tables), of_back(best_tables)),
        "converged_apart": differences(true_tables, of_back(their_tables), of_back(best_tables)),
        "hemispherical": hemispheres(ours, truth, best_tables, their_tables),
        "read_by_radiance": in_radiance(ours, folder / "ours.xml"),
    }


def tree(folder: Path) -> dict[str, Any]:
    """A tree of 64^4 cells."""
    slats = Slats()
    world = loaded(slats.radiance(), folder, "slats.rad")
    wall = time.monotonic()
    made, seconds = timed(
        lambda: sp.generate_bsdf(world, "t4-4096", box=slats.box, periodic=True, samples=TREE_SAMPLES)
    )
    wall = time.monotonic() - wall
    path = folder / "slats.xml"
    _, write_time = timed(lambda: made.save(path))
    columns = 64
    off, truths = [], []
    random = np.random.default_rng(3)
    for column in range(columns * columns):
        # The closed form's mean over the cell, by points spread over it.
        u = (np.array([column // columns, column % columns]) + random.random((400, 2))) / columns
        truths.append(float(slats.through(upwards(disk(u), 1)).mean()))
    exact = np.array(truths)
    lit = exact > LEAST_THROUGH
    off = np.abs(made.sides[0].through / np.maximum(exact, 1e-9) - 1)[lit]
    read, read_time = timed(lambda: sp.Bsdf.load(path))
    towards = random.normal(size=(2000, 3))
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    towards = towards[np.abs(towards[:, 2]) > 0.2]
    truth = slats.through(towards)
    wide = truth > 0.05
    by_split = made.bsdf.through(-towards)
    by_file = read.through(-towards)
    median = lambda values: float(np.median(np.abs(values[wide] / truth[wide] - 1)))  # noqa: E731
    return {
        "processor_time_s": round(seconds, 1),
        "wall_time_s": round(wall, 1),
        "writing_s": round(write_time, 1),
        "reading_and_splitting_s": round(read_time, 1),
        "file_bytes": path.stat().st_size,
        "samples": made.samples,
        "rays": made.rays,
        "columns_compared": int(lit.sum()),
        "through_median_relative_error": float(np.median(off)),
        "through_95_percent": float(np.quantile(off, 0.95)),
        "through_mean_relative_error": float(made.sides[0].through[lit].sum() / exact[lit].sum() - 1),
        "by_direction_exact_split_median": median(by_split),
        "by_direction_split_found_in_file_median": median(by_file),
        "summary": made.summary(),
    }


def disk(u: Floats) -> Floats:
    """Shirley and Chiu's map from the unit square to the unit disk."""
    a, b = (2 * u - 1).T
    first = np.abs(a) > np.abs(b)
    r = np.where(first, a, b)
    with np.errstate(divide="ignore", invalid="ignore"):
        phi = np.where(first, math.pi / 4 * b / a, math.pi / 2 - math.pi / 4 * a / b)
    phi = np.nan_to_num(phi)
    return np.column_stack([r * np.cos(phi), r * np.sin(phi)])


PARTS = {"slats": slats_at_equal_time, "sheet": sheet_at_equal_time, "tree": tree, "direct": direct}


def main() -> None:
    """Measure what is asked for, and keep the rest as it was."""
    wanted = sys.argv[1:] or list(PARTS)
    # pyradiance finds its own programs; what they call themselves has to be on the path.
    programs = Path(pyradiance.__file__).parent / "bin"
    os.environ["PATH"] = f"{programs}{os.pathsep}{os.environ['PATH']}"
    found = json.loads(TARGET.read_text(encoding="utf-8")) if TARGET.exists() else {}
    for part in wanted:
        with tempfile.TemporaryDirectory() as folder:
            found[part] = PARTS[part](Path(folder))
        TARGET.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        sys.stdout.write(json.dumps(found[part], indent=1) + "\n")


if __name__ == "__main__":
    main()
