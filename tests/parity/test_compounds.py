"""Instances and meshes against Radiance: octrees by `oconv`, meshes by `obj2mesh`."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import Radiance

Floats = npt.NDArray[np.float64]

LIGHT = (
    "void light solar 0 0 3 1e6 1e6 1e6\nsolar source sun 0 0 4 .3 -.5 .8 .1\n"
    "void light moonlight 0 0 3 4e5 5e5 6e5\nmoonlight source moon 0 0 4 -.8 .1 .4 .1\n"
)

# Without highlights, which show other surfaces and are left out by Radiance's options below.
OBJECT = """
void plastic red 0 0 5 .7 .2 .1 0 0
void alias crimson red
void plastic grey 0 0 5 .5 .6 .5 0 0
crimson alias dark grey
red sphere ball 0 0 4 0 0 1 .5
grey cylinder stem 0 0 7 0 0 0 0 0 .6 .2
void trans pane 0 0 7 .7 .8 .9 0 0 .6 0
pane polygon sheet 0 0 12 -1 -.5 0 -1 .5 0 -1 .5 1 -1 -.5 1
inherit alias again crimson
again ring disc 0 0 8 1 0 .5 1 .2 .3 .1 .5
"""


def rays_at(height: float, count: int, seed: int) -> Floats:
    random = np.random.default_rng(seed)
    origins = np.array([0, 0, height]) + 8 * normalized(random.normal(size=(count, 3)))
    target = np.array([0, 0, height]) + random.uniform(-1.2, 1.2, (count, 3))
    return np.hstack([origins, normalized(target - origins)])


def normalized(vectors: Floats) -> Floats:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def assert_same_picture(scene: str, radiance: Radiance, folder: Path, rays: Floats) -> Floats:
    """Direct light at a few hundred rays; edges of shadows apart."""
    octree = radiance.octree(folder / "scene.oct", text=scene, folder=folder)
    options = ("-ab", "0", "-st", "1", "-dj", "0", "-ds", "0.02", "-dt", "0", "-dc", "1")
    theirs = radiance.rtrace(octree, rays, *options, folder=folder)
    mine = np.asarray(sp.trace(sp.Scene.parse(scene), rays[:, :3], rays[:, 3:], samples=16, max_bounces=0, seed=1))
    error = np.abs(mine - theirs).max(axis=1) / np.maximum(theirs.max(axis=1), 1e-3 * theirs.max())
    assert np.quantile(error, 0.95) < 0.01, np.sort(error)[-20:]
    lit = theirs.max(axis=1) > 0
    assert lit.mean() > 0.2
    return theirs[lit]


@pytest.mark.parametrize("frozen", [True, False], ids=["frozen", "by name"])
@pytest.mark.parametrize("modifier", ["void", "green"])
def test_instances(
    frozen: bool, modifier: str, radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two of them, turned, scaled and mirrored; in the octree an instance of another one."""
    monkeypatch.chdir(tmp_path)
    Path("object.rad").write_text(OBJECT)
    options = ["-f"] if frozen else []
    Path("object.oct").write_bytes(radiance.run("oconv", *options, "object.rad", folder=tmp_path))
    Path("pair.rad").write_text(
        f"{OBJECT}!genbox red box .4 .4 .4 | xform -t .8 .8 0\nvoid instance inner 7 object.oct -s .4 -t .9 -.9 0 0 0\n"
    )
    Path("pair.oct").write_bytes(radiance.run("oconv", *options, "pair.rad", folder=tmp_path))
    scene = (
        f"{LIGHT}void plastic green 0 0 5 .1 .6 .2 0 0\ngreen ring floor 0 0 8 0 0 -.01 0 0 1 0 4\n"
        f"{modifier} instance one 1 object.oct 0 0\n"
        "void instance two 12 pair.oct -rz 70 -s .7 -mx -rx 20 -t .5 1.8 .4 0 0\n"
    )
    assert_same_picture(scene, radiance, tmp_path, rays_at(0.8, 400, 2))


def test_an_instance_is_its_scene_moved(radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With orientations too. (Radiance leaves those of anisotropic materials in an instance unturned.)"""
    monkeypatch.chdir(tmp_path)
    brushed = "void metal2 brushed 4 1 .2 0 . 0 6 .8 .6 .4 .9 .05 .3\nbrushed sphere ball 0 0 4 0 0 0 1\n"
    Path("ball.rad").write_text(brushed)
    Path("ball.oct").write_bytes(radiance.run("oconv", "-f", "ball.rad", folder=tmp_path))
    rays = rays_at(0.0, 200, 6)
    texts = [f"{LIGHT}void instance i 5 ball.oct -rx 40 -ry 20 0 0\n", f"{LIGHT}!xform -rx 40 -ry 20 ball.rad\n"]
    runs = [
        sp.trace(sp.Scene.parse(text), rays[:, :3], rays[:, 3:], samples=16, max_bounces=0, seed=1) for text in texts
    ]
    # Numbers in an octree have 31 bits.
    np.testing.assert_allclose(runs[0], runs[1], rtol=1e-5)
    assert np.max(runs[0]) > 0


def wavefront_ball(rows: int = 9, columns: int = 14) -> str:
    """A sphere of quadrilaterals with normals and local coordinates."""
    lines = []
    for i in range(rows + 1):
        for j in range(columns + 1):
            theta, phi = np.pi * (0.03 + 0.94 * i / rows), 2 * np.pi * j / columns
            x, y, z = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)
            lines += [f"v {x} {y} {z}", f"vn {x} {y} {z}", f"vt {j / columns} {i / rows}"]
    for i in range(rows):
        lines.append("usemtl red" if i % 2 else "usemtl grey")
        for j in range(columns):
            a = 1 + i * (columns + 1) + j
            corners = [a, a + columns + 1, a + columns + 2, a + 1]
            lines.append("f " + " ".join(f"{c}/{c}/{c}" for c in corners))
    return "\n".join(lines) + "\n"


MATERIALS = "void plastic red 0 0 5 .7 .2 .1 .05 .15\nvoid plastic grey 0 0 5 .5 .5 .5 0 0\n"


@pytest.mark.parametrize("smooth", [True, False], ids=["smooth", "flat"])
@pytest.mark.parametrize("modifier", ["void", "red"])
def test_meshes(
    smooth: bool, modifier: str, radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = wavefront_ball()
    if not smooth:
        text = "\n".join(line for line in text.splitlines() if not line.startswith("vn"))
        text = text.replace("/", " /").replace(" /", "/")
        text = "\n".join(drop_normals(line) for line in text.splitlines()) + "\n"
    Path("ball.obj").write_text(text)
    Path("materials.rad").write_text(MATERIALS)
    Path("ball.rtm").write_bytes(radiance.run("obj2mesh", "-a", "materials.rad", "ball.obj", folder=tmp_path))
    place = "-s .9 -mx -rx 30 -t .2 .1 .3"
    words = 1 + len(place.split())
    scene = f"{LIGHT}{MATERIALS}{modifier} mesh ball {words} ball.rtm {place} 0 0\n"
    theirs = assert_same_picture(scene, radiance, tmp_path, rays_at(0.3, 400, 3))
    assert len(np.unique(theirs.round(5), axis=0)) > 20
    # The Wavefront file itself is the same mesh, to the steps of the packed one.
    rays = rays_at(0.3, 200, 4)
    runs = [
        np.asarray(sp.trace(sp.Scene.parse(text), rays[:, :3], rays[:, 3:], samples=16, max_bounces=0, seed=1))
        for text in (scene, scene.replace(".rtm", ".obj"))
    ]
    assert np.quantile(np.abs(runs[0] - runs[1]).max(axis=1), 0.9) < 2e-3 * runs[0].max()


def test_local_coordinates_of_a_mesh(radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A pattern over Lu and Lv."""
    monkeypatch.chdir(tmp_path)
    Path("ball.obj").write_text(wavefront_ball())
    Path("materials.rad").write_text(MATERIALS)
    Path("ball.rtm").write_bytes(radiance.run("obj2mesh", "-a", "materials.rad", "ball.obj", folder=tmp_path))
    scene = (
        f"{LIGHT}void colorfunc stripes 4 .2+.7*Lu Lv .5 . 0 0\nstripes plastic painted 0 0 5 1 1 1 0 0\n"
        "painted mesh ball 3 ball.rtm -rx 30 0 0\n"
    )
    assert_same_picture(scene, radiance, tmp_path, rays_at(0.0, 300, 8))


def drop_normals(line: str) -> str:
    """Corners `v/t` of a face instead of `v/t/n`."""
    if not line.startswith("f "):
        return line
    return "f " + " ".join("/".join(corner.split("/")[:2]) for corner in line.split()[1:])


def test_without_the_compiled_mesh_the_wavefront_file_serves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.obj").write_text(wavefront_ball())
    scene = sp.Scene.parse(f"{MATERIALS}void mesh ball 1 ball.rtm 0 0\n")
    assert any("read ball.obj instead" in warning for warning in scene.warnings)
    assert len(scene.surfaces) == 2


@pytest.mark.parametrize("program", ["oconv", "obj2mesh"])
def test_damaged_files_end_in_a_message(
    program: str, radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Cut off anywhere, or with any byte wrong: a message or a scene, nothing else."""
    monkeypatch.chdir(tmp_path)
    if program == "oconv":
        Path("object.rad").write_text(OBJECT)
        whole, scene = radiance.run("oconv", "-f", "object.rad", folder=tmp_path), "void instance i 1 damaged 0 0\n"
    else:
        Path("ball.obj").write_text(wavefront_ball(4, 5))
        Path("materials.rad").write_text(MATERIALS)
        whole = radiance.run("obj2mesh", "-a", "materials.rad", "ball.obj", folder=tmp_path)
        scene = "void mesh m 1 damaged 0 0\n"
    random = np.random.default_rng(5)
    lengths = random.integers(0, len(whole), 100)
    changed = [bytearray(whole) for _ in range(200)]
    for content in changed:
        content[random.integers(len(content))] = random.integers(256)
    refused = 0
    for content in [whole[:n] for n in lengths] + [bytes(c) for c in changed]:
        Path("damaged").write_bytes(content)
        try:
            sp.Scene.parse(scene)
        except sp.InputError as error:
            refused += bool(str(error))
    assert refused >= len(lengths)
