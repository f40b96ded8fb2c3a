"""A whole furnished room against a converged run of Radiance: sun, sky, a window with a BSDF, desks.

The converged run takes a quarter of an hour, so its result is kept in `room_reference.json`;
`validation/room_reference.py` makes it again.
"""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance, luminance

PARTS = ("walls", "ceiling", "floor", "windowframe", "extwalls", "ground", "desks")
FILES = ["Objects/materials.mat", *(f"Objects/{part}.rad" for part in PARTS), "Resources/ec60.rad"]
REFERENCE_FILE = Path(__file__).with_name("room_reference.json")

BOUNCES = 4
SAMPLES, SEEDS = 4096, range(12)

# Sensors under desks receive a few lux; their reference is not converged.
LIT_LUX = 100.0


def reference_options(ambient_rays: int) -> list[str]:
    """No ambient cache and no truncation: the reference must not be biased."""
    return [
        *("-I", "-ab", str(BOUNCES), "-ad", str(ambient_rays), "-as", "0", "-aa", "0"),
        *("-lr", "-20", "-lw", "1e-7", "-st", "0", "-dj", "0", "-u+", "-n", "2"),
    ]


def sky_without_penumbra() -> str:
    """Sun and sky; the sun is shrunk to a point of the same light, which leaves no half-shaded sensors."""
    text = sp.Sky.perez((40.0, 190.0), 500.0, 150.0).to_radiance()
    shrink = 20.0
    sun = re.search(r"light solar\n0\n0\n3 (\S+)", text)
    assert sun is not None
    brighter = f"{float(sun[1]) * shrink**2}"
    return text.replace(sun[1], brighter).replace(" 0.533\n", f" {0.533 / shrink}\n")


def choose_sensors(folder: Path) -> np.ndarray:
    """Fifty of the room's work plane (n, 6); those in the plane of the window frame are left out."""
    grid = np.loadtxt(folder / "Resources/grid.pts")
    inside = grid[grid[:, 1] > 1]
    return inside[np.linspace(0, len(inside) - 1, 50).astype(int)]


@pytest.fixture
def room(shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Files of the room and its sky, from inside its folder."""
    monkeypatch.chdir(shared / "scenes/frads-room")
    sky = tmp_path / "sky.rad"
    sky.write_text(sky_without_penumbra())
    return [*FILES, str(sky)]


def test_fifty_sensors(room: list[str]) -> None:
    reference = json.loads(REFERENCE_FILE.read_text())
    theirs, sensors = np.array(reference["illuminance_lux"]), np.array(reference["sensors"])
    world = sp.World.compile(sp.Scene.load(room), "radiance")

    def run(seed: int) -> np.ndarray:
        points, normals = sensors[:, :3], sensors[:, 3:]
        return luminance(
            sp.trace(world, points, normals, irradiance=True, samples=SAMPLES, seed=seed, max_bounces=BOUNCES)
        )

    runs = [run(seed) for seed in SEEDS]
    ours, noise = np.mean(runs, axis=0), np.std(runs, axis=0, ddof=1) / np.sqrt(len(runs))
    lit = theirs > LIT_LUX
    assert lit.sum() >= 45
    difference = np.abs(ours / theirs - 1.0)[lit]
    assert (difference <= 0.02 + 3 * (noise / theirs)[lit]).all(), difference.round(4)
    assert np.median(difference) < 0.01
    assert np.mean(ours[lit]) == pytest.approx(np.mean(theirs[lit]), rel=2e-3)


def test_the_reference_is_of_this_room(room: list[str], radiance: Radiance, tmp_path: Path) -> None:
    """A short run of the same kind finds the same mean."""
    reference = json.loads(REFERENCE_FILE.read_text())
    octree = radiance.octree(tmp_path / "room.oct", *room)
    short = luminance(radiance.rtrace(octree, reference["sensors"], *reference_options(1024)))
    assert np.mean(short) == pytest.approx(np.mean(reference["illuminance_lux"]), rel=5e-3)
