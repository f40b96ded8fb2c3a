"""Directions of pixels against Radiance's `vwrays`."""

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance

POSE = "-vp 1 2 1.5 -vd 0.4 -0.8 0.1 -vu 0.1 0 1"

VIEWS = {
    "perspective": f"-vtv {POSE} -vh 50 -vv 40",
    "perspective, shifted": f"-vtv {POSE} -vh 50 -vv 50 -vs 0.3 -vl -0.2",
    "parallel": f"-vtl {POSE} -vh 3 -vv 2",
    "parallel, with clipping": f"-vtl {POSE} -vh 3 -vv 2 -vo 0.5 -va 9",
    "angular fisheye": f"-vta {POSE} -vh 180 -vv 180",
    "angular fisheye, wide": f"-vta {POSE} -vh 220 -vv 220",
    "angular fisheye, part": f"-vta {POSE} -vh 90 -vv 60",
    "hemispherical fisheye": f"-vth {POSE} -vh 180 -vv 180",
    "planispheric fisheye": f"-vts {POSE} -vh 200 -vv 150",
    "cylindrical": f"-vtc {POSE} -vh 240 -vv 80",
}


@pytest.mark.parametrize("name", VIEWS)
def test_rays_are_those_of_vwrays(name: str, radiance: Radiance) -> None:
    view = sp.View.parse(VIEWS[name])
    width, height = view.fit_size(48, 48)
    text = radiance.run("vwrays", *VIEWS[name].split(), "-x", 48, "-y", 48, "-d").decode()
    assert text.split()[:4] == ["-x", str(width), "-y", str(height)]
    lines = radiance.run("vwrays", *VIEWS[name].split(), "-x", 48, "-y", 48).decode().splitlines()
    theirs = np.array([line.split() for line in lines], dtype=float).reshape(height, width, 6)
    ours = view.rays(width, height)

    reached = np.linalg.norm(theirs[..., 3:], axis=2) > 0
    np.testing.assert_array_equal(np.isfinite(ours.directions).all(axis=2), reached)
    unit = theirs[reached][:, 3:] / np.linalg.norm(theirs[reached][:, 3:], axis=1, keepdims=True)
    angle = 2 * np.arcsin(np.linalg.norm(ours.directions[reached] - unit, axis=1) / 2)
    assert angle.max() < 1e-4
    np.testing.assert_allclose(ours.origins[reached], theirs[reached][:, :3], atol=1e-4)


@pytest.mark.parametrize("name", [name for name in VIEWS if "parallel" not in name])
def test_project_is_the_way_back(name: str) -> None:
    view = sp.View.parse(VIEWS[name])
    width, height = 24, 20
    directions = view.rays(width, height).directions
    reached = np.isfinite(directions).all(axis=2)
    rows, columns = np.nonzero(reached)
    expected = np.stack([(columns + 0.5) / width, 1 - (rows + 0.5) / height], axis=1)
    np.testing.assert_allclose(view.project(directions[reached]), expected, atol=1e-9)


@pytest.mark.parametrize(
    ("options", "steradians"),
    [
        ("-vta -vh 360 -vv 360", 4 * np.pi),
        ("-vth -vh 180 -vv 180", 2 * np.pi),
        ("-vtv -vh 90 -vv 90", 4 * np.pi / 6),
        ("-vtc -vh 360 -vv 90", 4 * np.pi * np.sin(np.pi / 4)),
    ],
)
def test_solid_angles_make_up_the_whole(options: str, steradians: float) -> None:
    angles = sp.View.parse(options).solid_angles(80, 60)
    assert angles.shape == (60, 80)
    assert angles.sum() == pytest.approx(steradians, rel=1e-6)


def test_a_view_comes_back_from_its_text() -> None:
    view = sp.View.parse(VIEWS["perspective, shifted"])
    assert str(sp.View.parse(str(view))) == str(view)
