"""A whole furnished room against a converged run of Radiance: sun, sky, a window with a BSDF, desks."""

import re
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance, luminance

PARTS = ("walls", "ceiling", "floor", "windowframe", "extwalls", "ground", "desks")
FILES = ["Objects/materials.mat", *(f"Objects/{part}.rad" for part in PARTS), "Resources/ec60.rad"]

BOUNCES = 4
# Half or twice as many ambient rays move the mean of the sensors by less than 0.2 %.
AMBIENT_RAYS = 16384
# No ambient cache and no truncation: the reference must not be biased.
REFERENCE = [
    *("-I", "-ab", str(BOUNCES), "-ad", str(AMBIENT_RAYS), "-as", "0", "-aa", "0"),
    *("-lr", "-20", "-lw", "1e-7", "-st", "0", "-dj", "0", "-u+", "-n", "2"),
]
SAMPLES, SEEDS = 8192, range(4)


def sky_without_penumbra() -> str:
    """Sun and sky; the sun is shrunk to a point of the same light, which leaves no half-shaded sensors."""
    text = sp.Sky.perez((40.0, 190.0), 500.0, 150.0).to_radiance()
    shrink = 20.0
    sun = re.search(r"light solar\n0\n0\n3 (\S+)", text)
    assert sun is not None
    brighter = f"{float(sun[1]) * shrink**2}"
    return text.replace(sun[1], brighter).replace(" 0.533\n", f" {0.533 / shrink}\n")


@pytest.fixture(scope="module")
def sensors(shared: Path) -> np.ndarray:
    """Fifty of the room's work plane; those in the plane of the window frame are left out."""
    grid = np.loadtxt(shared / "scenes/frads-room/Resources/grid.pts")
    inside = grid[grid[:, 1] > 1]
    return inside[np.linspace(0, len(inside) - 1, 50).astype(int)]


def test_fifty_sensors(shared: Path, sensors: np.ndarray, radiance: Radiance, tmp_path: Path, monkeypatch) -> None:
    folder = shared / "scenes/frads-room"
    monkeypatch.chdir(folder)
    sky = tmp_path / "sky.rad"
    sky.write_text(sky_without_penumbra())
    octree = radiance.octree(tmp_path / "room.oct", *FILES, sky, folder=folder)
    theirs = luminance(radiance.rtrace(octree, sensors, *REFERENCE, folder=folder))

    world = sp.World.compile(sp.Scene.load([*FILES, sky]), "radiance")
    runs = [
        luminance(
            sp.trace(
                world,
                sensors[:, :3],
                sensors[:, 3:],
                irradiance=True,
                samples=SAMPLES,
                seed=seed,
                max_bounces=BOUNCES,
            )
        )
        for seed in SEEDS
    ]
    ours = np.mean(runs, axis=0)
    noise = np.std(runs, axis=0, ddof=1) / np.sqrt(len(runs))

    lit = theirs > 20.0
    assert lit.sum() >= 45
    difference = np.abs(ours - theirs)[lit]
    assert (difference <= 0.02 * theirs[lit] + 3 * noise[lit]).all(), (difference / theirs[lit]).round(4)
    assert np.median(difference / theirs[lit]) < 0.01
    assert np.mean(ours[lit] / theirs[lit]) == pytest.approx(1.0, abs=0.01)
