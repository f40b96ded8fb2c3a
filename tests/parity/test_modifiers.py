"""Patterns, textures and mixtures against `rtrace`, on few rays: what shines is seen directly, so that no sample is random."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import Radiance

Floats = npt.NDArray[np.float64]

# Rays from all around to a unit sphere at the origin, from distances of 3 to 5.
RANDOM = np.random.default_rng(4)
TOWARDS = RANDOM.normal(size=(60, 3))
TOWARDS /= np.linalg.norm(TOWARDS, axis=1)[:, None]
ORIGINS = -TOWARDS * RANDOM.uniform(3, 5, (60, 1)) + RANDOM.uniform(-0.4, 0.4, (60, 3))

GRID = "2\n0 2 3\n0 0 4 -1 0 .5 2\n" + " ".join(str(round(v, 3)) for v in np.sin(np.arange(12.0)) + 2)
FALLING = "1 90 0 10 \n" + " ".join(str(v) for v in [0, 0.05, 0.08, 0.1, 0.11, 0.12, 0.14, 0.25, 1, 10])
FUNCTIONS = """
half(v) = v / 2; bright(r,g,b) = r + g / 2 + b / 3; only(v) = v * v;
stripes(n) = if(frac(n * Px) - .5, .9, .2); fine(nm) = sq(sin(nm / 40 + Px)); turned(v, nm) = v * if(nm - 550, 1, Py + 2);
local = A1 * Px + A2; A3x : 3;
"""


def both(
    radiance: Radiance, folder: Path, text: str, *options: str, rays: Floats | None = None, samples: int = 1
) -> tuple[Floats, Floats]:
    """What ours and theirs see along the rays."""
    for name, content in [("grid.dat", GRID), ("falling.dat", FALLING), ("mine.cal", FUNCTIONS)]:
        (folder / name).write_text(content)
    (folder / "scene.rad").write_text(text)
    rays = np.hstack([ORIGINS, TOWARDS]) if rays is None else rays
    octree = radiance.octree(folder / "scene.oct", "scene.rad", folder=folder)
    theirs = radiance.rtrace(octree, rays, "-ab", "0", "-w", *options, folder=folder)
    scene = sp.Scene.load([folder / "scene.rad"], search_path=[folder, radiance.library])
    ours = sp.trace(scene, rays[:, :3], rays[:, 3:], samples=samples, max_bounces=0)
    return ours, theirs


def assert_same(ours: Floats, theirs: Floats, tolerance: float) -> None:
    """Relative to the largest value."""
    assert theirs.max() > 0
    assert np.ptp(theirs) > 1e-3 * theirs.max()
    worst = np.abs(ours - theirs).max() / theirs.max()
    assert worst < tolerance, f"{worst}: {ours[:4]} {theirs[:4]}"


SHINING = "glow g 0 0 4 1 1 1 0\ng sphere s 0 0 4 0 0 0 1\n"
MOVED = "-rz 30 -rx 20 -s 1.7 -t .3 -.2 .1"

PATTERNS = {
    "direction": "colorfunc p 4 Dx+1 Dy+1 Dz+1 . 0 0",
    "normal": f"colorfunc p 15 Nx+1 Ny+1 Nz+1 . {MOVED} 0 0",
    "place": f"colorfunc p 15 Px+3 Py+3 Pz+3 . {MOVED} 0 0",
    "distances": f"colorfunc p 15 T Ts Rdot+.1 . {MOVED} 0 0",
    "mirrored frame": "colorfunc p 11 Px+3 Dy+2 Nz+2 . -mx -rz 20 -t 1 0 0 0 0",
    "axes": f"colorfunc p 15 S+Ix+1+.1*Px Ty+Jy+3 Kz+Jx+2 . {MOVED} 0 0",
    "coordinates": "colorfunc p 4 U+3 V+3 D(1)+N(2)+P(3)+4 . 0 0",
    "noise": "colorfunc p 4 noise3(Px*4,Py*4,Pz*4)+1 noise3x(Px*4,Py*4,Pz*4)+3 noise3y(Px,Py,Pz)+noise3z(Px,Py,Pz)+5 . 0 0",
    "fractal noise": "brightfunc p 2 fnoise3(Px*9,Py*9,Pz*9)+1 . 0 0",
    "turbulence": "colorfunc p 4 turbulence(Px,Py,Pz,.01) turbulencex(Px,Py,Pz,.1)+4 turbulencez(Px,Py,Pz,.1)+4 . 0 0",
    "arguments": "brightfunc p 2 local+A3x+arg(2) mine.cal 0 2 .3 .7",
    "a function file": "brightfunc p 2 stripes(3)*stripes(5) mine.cal 0 0",
    "failing": "brightfunc p 2 sqrt(Px) . 0 0",
    "data": "brightdata p 9 half grid.dat mine.cal Px+1 Py -t .2 0 0 0 0",
    "data outside": "brightdata p 5 noop grid.dat . Px*9 Py*9 0 0",
    "falling data": "brightdata p 4 noop falling.dat . Acos(Dz)/DEGREE/2 0 0",
    "colours of data": "colordata p 9 bright half only grid.dat grid.dat falling.dat mine.cal Px+1 Py 0 0",
    "three data": "colordata p 9 noop noop noop grid.dat grid.dat grid.dat . Px+1 Py 0 0",
    "two patterns": "brightfunc q 2 Px+2 . 0 0\nq colorfunc p 4 1 Py+2 .5 . 0 0",
    "a mixture of patterns": "colorfunc a 4 1 .2 .1 . 0 0\nvoid brightfunc b 2 .5 . 0 0\nvoid mixfunc p 4 a b Px . 0 0",
    
}


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())
def test_patterns_on_what_shines(pattern: str, radiance: Radiance, tmp_path: Path) -> None:
    pattern = pattern.replace("grid.dat grid.dat falling.dat", "grid.dat grid.dat grid.dat")
    ours, theirs = both(radiance, tmp_path, f"void {pattern}\np {SHINING}")
    assert_same(ours, theirs, 2e-6)
