"""Skies against Radiance: what `gendaylit` and `gensky` write, and what `rtrace` sees of ours."""

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance, luminance

SKIES = {
    "perez clear": sp.Sky.perez((35.0, 170.0), 700.0, 90.0),
    "perez hazy": sp.Sky.perez((20.0, 250.0), 250.0, 180.0),
    "perez overcast": sp.Sky.perez((50.0, 100.0), 0.0, 150.0),
    "clear": sp.Sky.cie("clear", (40.0, 200.0)),
    "intermediate": sp.Sky.cie("intermediate", (40.0, 200.0)),
    "overcast": sp.Sky.cie("overcast", (40.0, 200.0)),
    "uniform": sp.Sky.cie("uniform", (40.0, 200.0)),
}


def directions(count: int) -> np.ndarray:
    """Directions over the whole sphere (Fibonacci's spiral)."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    azimuth = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    radius = np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=1)


@pytest.mark.parametrize("name", SKIES)
def test_rtrace_sees_the_brightness_of_our_text(name: str, radiance: Radiance, tmp_path) -> None:
    sky = SKIES[name]
    octree = radiance.octree(tmp_path / "sky.oct", text=sky.to_radiance())
    towards = directions(500)
    if sky.sun_direction is not None:
        towards = towards[towards @ sky.sun_direction < np.cos(np.radians(1.0))]
    rays = np.hstack([np.zeros_like(towards), towards])
    seen = radiance.rtrace(octree, rays, "-ab", "0")[:, 1]
    ours = np.array([sky.brightness(tuple(direction)) for direction in towards])
    np.testing.assert_allclose(ours, seen, rtol=2e-4, atol=1e-6)


@pytest.mark.parametrize("name", ["perez clear", "perez hazy", "clear"])
def test_the_sun_lights_a_surface_that_faces_it(name: str, radiance: Radiance, tmp_path) -> None:
    sky = SKIES[name]
    sun_only = sky.to_radiance().split("void brightfunc")[0]
    octree = radiance.octree(tmp_path / "sun.oct", text=sun_only)
    lit = radiance.rtrace(octree, [[0, 0, 0, *sky.sun_direction]], "-I", "-ab", "0", "-dj", "0")
    assert luminance(lit)[0] == pytest.approx(sky.direct_normal_lux, rel=2e-3)


@pytest.mark.parametrize("name", ["perez clear", "perez overcast", "clear", "overcast"])
def test_the_sky_gives_its_diffuse_illuminance(name: str, radiance: Radiance, tmp_path) -> None:
    sky = SKIES[name]
    octree = radiance.octree(
        tmp_path / "sky.oct", text="void brightfunc" + sky.to_radiance().split("void brightfunc")[1]
    )
    count = 60_000
    towards = directions(count)
    towards = towards[towards[:, 2] > 0]
    seen = radiance.rtrace(octree, np.hstack([np.zeros_like(towards), towards]), "-ab", "0")
    illuminance = 4 * np.pi / count * (luminance(seen) * towards[:, 2]).sum()
    assert illuminance == pytest.approx(sky.diffuse_horizontal_lux, rel=3e-3)


@pytest.mark.parametrize("name", ["perez hazy", "clear", "overcast"])
def test_sensors_under_the_open_sky(name: str, radiance: Radiance, tmp_path) -> None:
    """Irradiance on surfaces of any tilt, to 0.5 % of the integral of what `rtrace` sees."""
    sky = SKIES[name]
    text = "void brightfunc" + sky.to_radiance().split("void brightfunc")[1]
    octree = radiance.octree(tmp_path / "sky.oct", text=text)
    towards = directions(60_000)
    seen = luminance(radiance.rtrace(octree, np.hstack([np.zeros_like(towards), towards]), "-ab", "0"))
    normals = directions(20)
    cosines = np.maximum(normals @ towards.T, 0.0)
    expected = 4 * np.pi / len(towards) * (cosines @ seen)
    lit = sp.trace(sp.Scene.parse(text), np.zeros_like(normals), normals, irradiance=True, samples=16384)
    np.testing.assert_allclose(luminance(lit), expected, rtol=5e-3)
