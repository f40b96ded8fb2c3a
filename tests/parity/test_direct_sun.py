"""Direct sun on sensors: behind glass and behind a peak, against Radiance and against the closed form."""

from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance
from sunpeak.rooms import FABRIC, write_fabric
from sunpeak.rooms.closed_form import pane

SUN_CD_M2_BY_179 = 5e6
SUNS = [(35.0, 183.0), (20.0, 200.0), (50.0, 165.0), (10.0, 190.0), (42.0, 215.0)]
SUN_DEG = 0.533
# Rule "radiance" jumps from cell to cell: a point of a sun, so that both programs ask for the same direction.
POINT_DEG = 0.02
SENSORS_A_SUN = 40

WINDOW = "12 -3 0 0 -3 0 6 3 0 6 3 0 0"
GLASS = "void glass pane 0 0 3 .92 .95 .9\n" + f"pane polygon window 0 0 {WINDOW}\n"


def sun_direction(altitude_deg: float, azimuth_deg: float) -> np.ndarray:
    altitude, azimuth = np.radians([altitude_deg, azimuth_deg])
    return np.array([np.sin(azimuth) * np.cos(altitude), np.cos(azimuth) * np.cos(altitude), np.sin(altitude)])


def sun_text(direction: np.ndarray, width_deg: float = SUN_DEG) -> str:
    x, y, z = direction
    radiance = " ".join([str(SUN_CD_M2_BY_179)] * 3)
    return f"void light solar 0 0 3 {radiance}\nsolar source sun 0 0 4 {x} {y} {z} {width_deg}\n"


def sensors(seed: int) -> np.ndarray:
    """Points behind the window and beside its light, with normals that see the outside."""
    random = np.random.default_rng(seed)
    points = random.uniform([-3, 0.2, 0], [3, 2, 3], (SENSORS_A_SUN, 3))
    normals = random.normal([0, -1.5, 1], 0.6, (SENSORS_A_SUN, 3))
    return np.hstack([points, normals / np.linalg.norm(normals, axis=1, keepdims=True)])


def in_the_light(sensor: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Which sensors see the sun through the window, wholly: 1 inside, 0 outside, NaN where its edge cuts the disc."""
    distance = -sensor[:, 1] / direction[1]
    x = sensor[:, 0] + distance * direction[0]
    z = sensor[:, 2] + distance * direction[2]
    gap = np.min([x + 3, 3 - x, z, 6 - z], axis=0)
    blur = 2 * distance * np.tan(np.radians(SUN_DEG))
    return np.where(gap > blur, 1.0, np.where(gap < -blur, 0.0, np.nan))


def irradiance(
    sensor: np.ndarray, direction: np.ndarray, through: np.ndarray | float, width_deg: float = SUN_DEG
) -> np.ndarray:
    """Of the sun, behind the window and beside it (n, channels); NaN where window or horizon cut the disc."""
    cosine = sensor[:, 3:] @ direction
    disc = 4 * np.pi * np.sin(np.radians(width_deg) / 4) ** 2
    free = SUN_CD_M2_BY_179 * disc * np.where(np.abs(cosine) > 0.02, np.maximum(cosine, 0.0), np.nan)
    inside = in_the_light(sensor, direction)[:, None]
    return free[:, None] * (inside * np.atleast_1d(through) + 1.0 - inside)


def trace(text: str, sensor: np.ndarray, peak: str) -> np.ndarray:
    scene = sp.Scene.parse(text)
    return sp.trace(scene, sensor[:, :3], sensor[:, 3:], irradiance=True, peak=peak, samples=64, max_bounces=0)


def reference(text: str, sensor: np.ndarray, radiance: Radiance, folder: Path) -> np.ndarray:
    octree = radiance.octree(folder / "sun.oct", text=text)
    return radiance.rtrace(octree, sensor, "-I", "-ab", "0", "-dj", "0", "-ds", "0", "-st", "0")


def assert_alike(ours: np.ndarray, expected: np.ndarray, closed: np.ndarray) -> None:
    """To 0.5 %, on all sensors where the closed form is known."""
    known = np.isfinite(closed).all(axis=1)
    assert known.sum() > 0.7 * SENSORS_A_SUN
    assert (expected[known] > 0).any()
    np.testing.assert_allclose(ours[known], expected[known], rtol=5e-3, atol=1e-6)


@pytest.mark.parametrize("seed", range(len(SUNS)))
def test_behind_glass(seed: int, radiance: Radiance, tmp_path: Path) -> None:
    direction, sensor = sun_direction(*SUNS[seed]), sensors(seed)
    text = GLASS + sun_text(direction)
    ours = trace(text, sensor, "split")
    through = np.array([pane(t, abs(direction[1]))[0] for t in (0.92, 0.95, 0.9)])
    closed = irradiance(sensor, direction, through)
    assert_alike(ours, closed, closed)
    assert_alike(ours, reference(text, sensor, radiance, tmp_path), closed)


@pytest.fixture(scope="module", params=["klems", "t3-4096"])
def cloth(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_fabric(tmp_path_factory.mktemp("fabric"), request.param)


def shade(cloth: Path) -> str:
    return f"void aBSDF fabric 5 {cloth} 0 0 1 . 0 0\nfabric polygon window 0 0 {WINDOW}\n"


@pytest.mark.parametrize("seed", range(len(SUNS)))
def test_behind_a_peak_as_radiance_finds_it(seed: int, cloth: Path, radiance: Radiance, tmp_path: Path) -> None:
    direction, sensor = sun_direction(*SUNS[seed]), sensors(seed)
    text = shade(cloth) + sun_text(direction, POINT_DEG)
    known = irradiance(sensor, direction, 1.0, POINT_DEG)
    assert_alike(trace(text, sensor, "radiance"), reference(text, sensor, radiance, tmp_path), known)


@pytest.mark.parametrize("seed", range(len(SUNS)))
def test_behind_a_peak_by_the_split(seed: int, tmp_path: Path) -> None:
    """The fabric's formula, the split of a fine table, and nothing between them."""
    direction, sensor = sun_direction(*SUNS[seed]), sensors(seed)
    text = shade(write_fabric(tmp_path, "t3-4096")) + sun_text(direction)
    through = FABRIC.through(np.arccos(abs(direction[1])))
    closed = irradiance(sensor, direction, through) * np.ones(3)
    assert through > 0
    assert_alike(trace(text, sensor, "split"), closed, closed)
