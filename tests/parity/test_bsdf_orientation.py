"""`BSDF` and `aBSDF` whose up vector is given by expressions, ray by ray against Radiance."""

from pathlib import Path

import numpy as np
import pytest
from test_materials import DIRECT, SUN, rays_at

import sunpeak as sp
from conftest import Radiance

ORIENTATIONS = {
    "by place": "-Py Px .1*Pz .",
    "by a function file": "turn(1) turn(2) A1 turn.cal",
    "in a frame of its own": "-Py Px .1*Pz . -rz 30 -rx 10 -t .2 .1 0",
    "constant, by a file": "lean(2) .3 1 turn.cal",
}


@pytest.mark.parametrize("kind", ["BSDF", "aBSDF"])
@pytest.mark.parametrize("orientation", ORIENTATIONS.values(), ids=ORIENTATIONS.keys())
def test_up_vectors_by_expressions(kind: str, orientation: str, radiance: Radiance, tmp_path: Path) -> None:
    """A blind's table on a disc, in the sun: what it scatters turns with the up vector."""
    sp.Blind(width=1.0, tilt_deg=30.0, scattered=0.4).write(tmp_path / "blind.xml")
    (tmp_path / "turn.cal").write_text("turn(i) = select(i, -Py, Px + A1); lean(x) = x / 4;")
    words = f"{'0 ' if kind == 'BSDF' else ''}blind.xml {orientation}".split()
    text = f"void {kind} m {len(words)} {' '.join(words)} 0 3 .002 .001 .001\nm ring s 0 0 8 0 0 0 0 0 1 0 2\n"
    (tmp_path / "scene.rad").write_text(SUN.format(0.3, -0.5, 0.8) + text)
    rays = rays_at(np.zeros(3), 4.0, 200, 3)
    octree = radiance.octree(tmp_path / "scene.oct", "scene.rad", folder=tmp_path)
    theirs = radiance.rtrace(octree, rays, *DIRECT, "-ss", "0", folder=tmp_path)
    scene = sp.Scene.load([tmp_path / "scene.rad"])
    ours = sp.trace(scene, rays[:, :3], rays[:, 3:], samples=16, max_bounces=0, peak="radiance")
    lit = theirs[:, 1] > 0.003
    assert lit.sum() > 50
    assert np.ptp(theirs[lit][:, 1]) > 0.01
    error = np.abs(ours[lit] / theirs[lit] - 1).max(axis=1)
    # Rays that meet the border of two cells see one or the other.
    assert np.mean(error < 2e-3) > 0.97, np.sort(error)[-20:]
