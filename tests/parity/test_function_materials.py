"""Materials with functions and data, and prisms, in the sun: against `rtrace`."""

from pathlib import Path

import numpy as np
import pytest
from test_modifiers import SUN, assert_same, both

from conftest import Radiance

MATERIALS = {
    "plasfunc": "plasfunc x 4 lobe2 mine.cal -rz 30 0 5 .6 .5 .4 .3 2",
    "metfunc": "colorfunc p 4 1 Px+1 .5 . 0 0\np metfunc x 4 lobe2 mine.cal -rx 20 0 5 .6 .5 .4 .3 2",
    "transfunc": "transfunc x 2 lobe2 mine.cal 0 7 .6 .5 .4 .3 .4 .6 2",
    "plasdata": "plasdata x 5 shade grid.dat mine.cal first second 0 4 .6 .5 .4 .3",
    "metdata": "metdata x 7 shade grid.dat mine.cal first second -rz 45 0 4 .6 .5 .4 .3",
    "transdata": "transdata x 5 shade grid.dat mine.cal first second 0 6 .6 .5 .4 .3 .4 .6",
    "BRTDfunc": "BRTDfunc x 10 0 0 0 0 0 0 lobe2 lobe3 0 mine.cal 0 10 .1 .2 .3 .3 .2 .1 .05 .1 .02 2",
    "BRTDfunc with a pattern": "brightfunc p 2 Px+1 . 0 0\n"
    "p BRTDfunc x 10 0 0 0 0 0 0 0 0 0 . 0 9 .1 .2 .3 .3 .2 .1 .05 .1 .02",
    "a texture": "texfunc t 4 .2*sin(3*Px) .1*Px 0 . 0 0\nt plasfunc x 2 lobe2 mine.cal 0 5 .6 .5 .4 .3 2",
}
LOBES = """
lobe2(dx,dy,dz,s) = arg(AC) * .1 + .3 * sq(dx * NxP + dy * NyP + dz * NzP) * RdotP + .1 * CrP + 100 * s;
lobe3(dx,dy,dz,s) = .2 + .1 * Dx + .05 * dz; first(dx,dy,dz,s) = dx + 1; second(dx,dy,dz,s) = abs(dz) + .1 * Dz;
shade(v,dx,dy,dz) = v / 4 + .1 * dx;
"""


@pytest.mark.parametrize("material", MATERIALS.values(), ids=MATERIALS.keys())
def test_functions_scatter_sunlight(material: str, radiance: Radiance, tmp_path: Path) -> None:
    """Direct light alone: for light that comes by a bounce Radiance does not ask the functions."""
    # Flat, so that no light comes back through it.
    ring = "x ring r 0 0 8 0 0 0 .3 -.2 1 0 1"
    ours, theirs = both(radiance, tmp_path, f"{SUN}void {material}\n{ring}", samples=64, definitions=LOBES)
    assert_same(ours, theirs, 3e-3)


def test_brtdfunc_mirrors_and_lets_through(radiance: Radiance, tmp_path: Path) -> None:
    text = (
        "void BRTDfunc x 10 .3+.2*Rdot .3 .1 .2 .1 if(Px,.5,.1) 0 0 0 . 0 9 0 0 0 0 0 0 0 0 0\n"
        "x ring r 0 0 8 0 0 0 0 0 1 0 3\nvoid colorfunc p 4 Dx+1 Dy+2 2-Dz . 0 0\np glow g 0 0 4 1 1 1 0\n"
        "g source all 0 0 4 0 0 1 360\n"
    )
    ours, theirs = both(radiance, tmp_path, text, samples=32768)
    assert_same(ours, theirs, 1e-2)


PRISMS = {
    "prism1": "prism1 x 5 share bent bent2 bent3 mine.cal 0 1 .7",
    "prism2": "prism2 x 9 share bent bent2 bent3 1-share -.2 Dy Dz mine.cal 0 1 .7",
}
BENDING = "share = A1; bent = Dx + .3; bent2 = Dy; bent3 = Dz;"


@pytest.mark.parametrize("prism", PRISMS)
def test_rays_go_on_as_the_functions_say(prism: str, radiance: Radiance, tmp_path: Path) -> None:
    text = (
        f"void {PRISMS[prism]}\nx ring r 0 0 8 0 0 0 0 0 1 0 3\nvoid colorfunc p 4 Dx+1 Dy+2 2-Dz . 0 0\n"
        "p glow g 0 0 4 1 1 1 0\ng source all 0 0 4 0 0 1 360\n"
    )
    ours, theirs = both(radiance, tmp_path, text, samples=32768, definitions=BENDING)
    assert_same(ours, theirs, 1e-2)


def test_a_sun_shines_through_a_prism(radiance: Radiance, tmp_path: Path) -> None:
    """A receiver behind it gets light only by the virtual sun."""
    text = (
        "void light l 0 0 3 1e6 1e6 1e6\nl source sun 0 0 4 .1 -.2 1 .02\n"
        "void prism1 x 5 .8 if(Dz,1,-1)*.3+Dx Dy Dz . 0 0\nx ring r 0 0 8 0 0 2 0 0 1 0 1\n"
    )
    sensors = np.array([[x, y, 0, 0, 0, 1] for x in (-1.2, -0.6, 0, 0.5) for y in (-0.3, 0.3)], dtype=np.float64)
    ours, theirs = both(radiance, tmp_path, text, "-I", "-dj", "0", rays=sensors, samples=256)
    assert (theirs > 0).any()
    assert (theirs == 0).any()
    assert np.array_equal(ours > 0, theirs > 0)
    assert np.abs(ours - theirs).max() < 0.02 * theirs.max(), (ours, theirs)


def test_a_sun_is_as_large_behind_a_prism_as_rays_find_it(radiance: Radiance, tmp_path: Path) -> None:
    """A prism that halves what leaves along x and y: a quarter of the projected solid angle, the same radiance.

    Radiance's rays find that too; its virtual sun keeps the size of the sun, and gives about four times as much.
    """
    scale = "zoom = if(Dz, 2, .5); ax = zoom*Dx; ay = zoom*Dy; az = if(Dz, 1, -1)*sqrt(1 - ax*ax - ay*ay);"
    text = (
        "void light l 0 0 3 1e4 1e4 1e4\nl source sun 0 0 4 .2 -.1 1 2\n"
        "void prism1 x 5 1 ax ay az mine.cal 0 0\nx ring r 0 0 8 0 0 2 0 0 1 0 5\n"
    )
    sensor = np.array([[0, 0, 0, 0, 0, 1]], dtype=np.float64)
    ours, virtual = both(radiance, tmp_path, text, "-I", rays=sensor, samples=4096, definitions=scale)
    sun = np.array([0.2, -0.1, 1]) / np.linalg.norm([0.2, -0.1, 1])
    expected = 1e4 * np.pi * np.sin(np.radians(1)) ** 2 * sun[2] / 4
    assert ours == pytest.approx(expected, rel=5e-3)
    assert virtual.mean() > 3 * expected
    # Rays from the sensor over a square that the sun behind the prism lies in, by their cosines along x and y.
    random = np.random.default_rng(5)
    x, y = sun[0] / 2 + random.uniform(-0.02, 0.02, 20_000), sun[1] / 2 + random.uniform(-0.02, 0.02, 20_000)
    rays = np.column_stack([np.zeros((len(x), 3)), x, y, np.sqrt(1 - x**2 - y**2)])
    seen = radiance.rtrace(tmp_path / "scene.oct", rays, "-ab", "0", "-w", folder=tmp_path)
    assert seen[:, 0].mean() * 0.04**2 == pytest.approx(expected, rel=0.03)
