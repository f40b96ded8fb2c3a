"""Each material without functions against Radiance, ray by ray."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import Radiance

Floats = npt.NDArray[np.float64]

SUN = "void light solar 0 0 3 1e5 1e5 1e5\nsolar source sun 0 0 4 {} {} {} 0.2\n"
"""Narrow, since Radiance widens highlights by the size of the source."""

DIRECT = ("-ab", "0", "-st", "1", "-dj", "0", "-ds", "0.01", "-dt", "0", "-dc", "1")
"""Light sources only: no sampled highlights, which need an environment to show."""

SPECULAR = ("-ab", "0", "-lr", "16", "-lw", "1e-6", "-st", "0")
"""Every branch of mirrored and refracted rays."""

COLOURED_BOX = """
void glow east 0 0 4 3 1 .5 0   void glow west 0 0 4 .5 2 1 0   void glow north 0 0 4 1 1 4 0
void glow south 0 0 4 2 2 .2 0  void glow top 0 0 4 5 5 5 0     void glow bottom 0 0 4 .2 .1 .1 0
east polygon e 0 0 12 6 -6 -6 6 -6 6 6 6 6 6 6 -6
west polygon w 0 0 12 -6 -6 -6 -6 6 -6 -6 6 6 -6 -6 6
north polygon n 0 0 12 -6 6 -6 6 6 -6 6 6 6 -6 6 6
south polygon s 0 0 12 -6 -6 -6 -6 -6 6 6 -6 6 6 -6 -6
top polygon t 0 0 12 -6 -6 6 -6 6 6 6 6 6 6 -6 6
bottom polygon b 0 0 12 -6 -6 -6 6 -6 -6 6 6 -6 -6 6 -6
"""


def rays_at(target: Floats, distance: float, count: int, seed: int, lowest: float = -1.0) -> Floats:
    """From points around, not below `lowest` (a sine), towards points near the target (n, 6)."""
    random = np.random.default_rng(seed)
    origins = random.normal(size=(count * 4, 3))
    origins /= np.linalg.norm(origins, axis=1, keepdims=True)
    origins = target + distance * origins[origins[:, 2] > lowest][:count]
    directions = target + random.uniform(-0.4, 0.4, origins.shape) - origins
    return np.hstack([origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)])


def ours(text: str, rays: Floats, samples: int, bounces: int | None = 0) -> Floats:
    scene = sp.Scene.parse(text)
    return np.asarray(sp.trace(scene, rays[:, :3], rays[:, 3:], samples=samples, max_bounces=bounces, seed=1))


def assert_alike(a: Floats, b: Floats, relative: float, absolute: float = 0.0) -> None:
    error = np.abs(a - b) - relative * np.maximum(np.abs(a), np.abs(b)) - absolute
    assert error.max() <= 0, f"{error.max()} over, ours {a.flat[error.argmax()]}, theirs {b.flat[error.argmax()]}"
    assert np.max(b) > 0


@pytest.mark.parametrize(
    "material",
    [
        "void plastic m 0 0 5 .5 .4 .3 .06 .15",
        "void metal m 0 0 5 .9 .7 .3 .8 .2",
        "void trans m 0 0 7 .7 .6 .5 .05 .2 .6 .4",
        "void plastic2 m 4 1 .5 0 . 0 6 .5 .4 .3 .06 .1 .3",
        "void metal2 m 6 1 0 .3 . -rz 40 0 6 .9 .7 .3 .8 .3 .1",
        "void trans2 m 4 .2 1 0 . 0 8 .7 .6 .5 .05 .12 .3 .6 .7",
        "void metal2 m 6 -Py+.2 Px 0 . -rz 30 0 6 .9 .7 .3 .8 .1 .3",
        "void plastic2 m 4 'if(Px-5,1,.3)' A1*A2 0 . 0 6 .5 .4 .3 .06 .1 .3",
        "void ashik2 m 4 1 .3 0 . 0 8 0 0 0 .9 .8 .7 20 100",
    ],
    ids=lambda text: " ".join(text.split()[1:7:2]),
)
@pytest.mark.parametrize("side", ["reflected", "transmitted"])
def test_highlights_of_a_sun(material: str, side: str, radiance: Radiance, tmp_path: Path) -> None:
    """On a plane, rays up to 45 degrees from the normal, sun at 29 degrees before it or 10 behind it.

    Transmission at larger angles is another matter: Radiance's lobe of `trans2` gives out more there than it gets.
    """
    if side == "transmitted" and "trans" not in material:
        pytest.skip("it transmits nothing")
    sign, angle = (1.0, 0.5) if side == "reflected" else (-1.0, 0.17)
    sun = np.array([np.sin(angle) * 0.8, np.sin(angle) * 0.6, np.cos(angle) * sign])
    text = SUN.format(*sun) + f"{material}\nm ring plane 0 0 8 0 0 0 0 0 1 0 9\n"
    rays = rays_at(np.zeros(3), 4.0, 60, seed=3, lowest=0.75)
    # Half of the rays look into the highlight.
    into = sun * [1, 1, -sign] + 0.15 * np.random.default_rng(4).normal(size=(len(rays) // 2, 3))
    rays[: len(into), 3:] = into / np.linalg.norm(into, axis=1, keepdims=True)
    rays[:, :3] = -4.0 * rays[:, 3:]
    theirs = radiance.rtrace(radiance.octree(tmp_path / "s.oct", text=text), rays, *DIRECT)
    assert_alike(ours(text, rays, 64), theirs, relative=6e-3, absolute=1e-3 * float(theirs.max()))


@pytest.mark.parametrize(
    "solid",
    [
        "void dielectric m 0 0 5 .9 .5 .7 1.5 0\n!genbox m cube 2 2 2 | xform -t -1 -1 -1 -rx 20 -rz 30\n",
        "void dielectric m 0 0 5 .9 .5 .7 1.4 60\nm sphere ball 0 0 4 0 0 0 1\n",
        "void dielectric w 0 0 5 .98 .9 .98 1.33 0\n!genbox w cube 2 2 2 | xform -t -1 -1 -1 -rz 17\n"
        "void interface m 0 0 8 .98 .3 .2 1.6 .98 .9 .98 1.33\nm sphere ball 0 0 4 0 0 0 .6\n",
        "void dielectric w 0 0 5 .98 .9 .98 1.33 0\n!genbox w cube 2 2 2 | xform -t -1 -1 -1 -rz 17\n"
        "void interface m 0 0 8 .98 .9 .98 1.33 .98 .3 .2 1.6\nm bubble ball 0 0 4 0 0 0 .6\n",
        "void mist m 0 0 3 .2 .5 1\n!genbox m cube 2 2 2 | xform -t -1 -1 -1 -rx 20\nm sphere ball 0 0 4 .5 0 0 .3\n",
    ],
    ids=["slab", "hartmann", "interface", "bubble", "mist"],
)
def test_solids_before_a_coloured_box(solid: str, radiance: Radiance, tmp_path: Path) -> None:
    text = COLOURED_BOX + solid
    rays = rays_at(np.zeros(3), 4.0, 40, seed=5)
    theirs = radiance.rtrace(radiance.octree(tmp_path / "s.oct", text=text), rays, *SPECULAR)
    # Where a ray's branch meets an edge of the box the two programs may see different sides.
    difference = np.abs(ours(text, rays, 4096, None) / theirs - 1)
    assert np.median(difference) < 0.01
    assert np.quantile(difference, 0.9) < 0.05


def test_antimatter_cuts_a_wall(radiance: Radiance, tmp_path: Path) -> None:
    """A round, bevelled hole; rays see through, the bevel, and the wall beside."""
    text = SUN.format(-0.6, 0.3, 0.74) + (
        "void plastic wall 0 0 5 .5 .4 .3 0 0\n!genbox wall w .2 6 4 | xform -t -.1 -3 -2\n"
        "void plastic floor 0 0 5 .2 .2 .7 0 0\nfloor polygon f 0 0 12 -9 -9 -2 9 -9 -2 9 9 -2 -9 9 -2\n"
        "void antimatter eraser 1 wall 0 0\neraser ring a 0 0 8 -.101 0 0 -1 0 0 0 1\n"
        "eraser cone b 0 0 8 -.101 0 0 .101 0 0 1 1.1\neraser ring c 0 0 8 .101 0 0 1 0 0 0 1.1\n"
    )
    random = np.random.default_rng(6)
    origins = np.column_stack([np.full(150, 3.0), random.uniform(-3, 3, 150), random.uniform(-1.5, 3, 150)])
    target = np.column_stack([np.zeros(150), random.uniform(-1.3, 1.3, (150, 2))])
    rays = np.hstack([origins, target - origins])
    rays[:, 3:] /= np.linalg.norm(rays[:, 3:], axis=1, keepdims=True)
    theirs = radiance.rtrace(radiance.octree(tmp_path / "s.oct", text=text), rays, *DIRECT)
    mine = ours(text, rays, 32)
    # Edges of shadows have penumbras of a sun that is not a point.
    close = np.all(np.abs(mine - theirs) <= 5e-3 * theirs.max(axis=1, keepdims=True), axis=1)
    assert close.mean() > 0.97, rays[~close]
    assert len(np.unique(theirs.round(6), axis=0)) >= 4


def test_thin_mist_in_a_spotlight(radiance: Radiance, tmp_path: Path) -> None:
    """Light scattered once, where Radiance's way is right: so thin that nothing is scattered twice."""
    text = (
        "void spotlight beam 0 0 7 900 600 300 30 0 0 -2\nbeam ring lamp 0 0 8 0 0 2 0 0 -1 0 .05\n"
        "void mist fog 1 lamp 0 7 .002 .002 .004 .5 .5 .5 .4\n!genbox fog box 4 4 3 | xform -t -2 -2 -1.5\n"
    )
    rays = rays_at(np.array([0.0, 0.0, 0.3]), 5.0, 400, seed=7)
    options = ("-ab", "0", "-ms", "0.01", "-dj", "1", "-ds", "0.02")
    theirs = radiance.rtrace(radiance.octree(tmp_path / "s.oct", text=text), rays, *options)
    seen = theirs[:, 0] > 0.2 * np.median(theirs[:, 0])
    mine = ours(text, rays, 1 << 12)
    ratio = mine[seen].sum(axis=0) / theirs[seen].sum(axis=0)
    np.testing.assert_allclose(ratio, 1.0, atol=0.03)


def test_mist_between_a_floor_and_the_sky() -> None:
    """Light is scattered many times in a slab that absorbs nothing, and goes back and forth between it and a floor.

    The slab's share of a Lambertian field, isotropic scattering: Heaslet and Warming 1965, as heat through a grey gas
    between black plates, which is the same equation (Modest, Radiative Heat Transfer, table 14.1). What the floor gives
    back is Lambertian again, so that the sum over all its turns is a geometric series.
    """
    passes, floor = np.array([0.7040, 0.5532, 0.3016]), np.array([0.7, 0.5, 0.7])
    scene = sp.Scene.parse(
        "void glow shine 0 0 4 1 1 1 0\nshine source sky 0 0 4 0 0 1 180\n"
        "void plastic grey 0 0 5 .7 .5 .7 0 0\ngrey ring floor 0 0 8 0 0 0 0 0 1 0 2000\n"
        "void mist fog 0 0 7 .5 1 3 1 1 1 0\n!genbox fog slab 1000 1000 1 | xform -t -500 -500 .01\n"
    )
    given = {"irradiance": True, "samples": 1 << 16, "max_bounces": None, "seed": 1}
    lit = sp.trace(scene, np.array([[0, 0, 1e-3]]), np.array([[0.0, 0, 1]]), **given)[0]
    np.testing.assert_allclose(lit / np.pi, passes / (1 - floor * (1 - passes)), rtol=0.01)


def test_a_lamp_behind_mist(radiance: Radiance, tmp_path: Path) -> None:
    """What scatters, green and blue, takes nothing of Radiance's shadow rays, and all by Beer's law of its other rays.

    So a `light` is brighter behind mist than the same lamp as a `glow` that only paths find; Sunpeak's are alike.
    """
    seen = {}
    for lamp in ("light l 0 0 3 100 100 100", "glow l 0 0 4 100 100 100 0"):
        text = (
            f"void {lamp}\nl ring r 0 0 8 0 0 4 0 0 -1 0 2\nvoid mist fog 0 0 7 .2 .2 .2 0 .5 .9 .3\n"
            "!genbox fog b 20 20 2 | xform -t -10 -10 1\n"
        )
        options = ("-I", "-ab", "1", "-ad", "30000", "-aa", "0", "-lw", "1e-8", "-dj", "0", "-ds", ".01")
        sensor = np.array([[0, 0, 0, 0, 0, 1]], dtype=np.float64)
        theirs = radiance.rtrace(radiance.octree(tmp_path / "s.oct", text=text), sensor, *options)[0]
        scene = sp.Scene.parse(text)
        sees = {"irradiance": True, "samples": 1 << 15, "max_bounces": None, "seed": 1}
        seen[lamp.split()[0]] = theirs, sp.trace(scene, sensor[:, :3], sensor[:, 3:], **sees)[0]
    (by_shadows, ours), (by_paths, same) = seen["light"], seen["glow"]
    # The mean over the lamp of Beer's law; the disc fills a cone of 27 degrees.
    cosine = np.cos(np.arctan(0.5 * np.sqrt(np.linspace(0, 1, 20001)[1:])))
    weight = cosine**4
    depths = 0.4 * np.array([[1], [0.5], [0.1]]) / cosine
    absorbed = 100 * np.pi * np.sin(np.arctan(0.5)) ** 2 * np.average(np.exp(-depths), axis=1, weights=weight)
    beer = absorbed[0]
    np.testing.assert_allclose(by_paths, beer, rtol=0.01)
    np.testing.assert_allclose(by_shadows, absorbed, rtol=0.03)
    np.testing.assert_allclose(ours, same, rtol=0.02)
    assert ours[0] == pytest.approx(beer, rel=5e-3)
    assert np.all(ours[1:] > beer)
    assert np.all(ours[1:] < absorbed[1:])
