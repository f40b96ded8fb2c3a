"""Surfaces as rays meet them and what emits, against `rtrace`; and the page that names a test for every primitive."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest
from test_modifiers import Floats, assert_same, both

from conftest import ROOT, Radiance

PAGE = ROOT / "validation/primitives.md"

SHAPES = {
    "sphere": "sphere s 0 0 4 .1 -.2 .3 .9",
    "bubble": "bubble s 0 0 4 .1 -.2 .3 .9",
    "polygon": "polygon s 0 0 18 -1 -1 -.2 1 -1 .2 1 1 .2 0 1 0 0 0 0 -1 0 -.2",
    "ring": "ring s 0 0 8 .1 .2 -.1 .3 -.4 .8 .4 1.1",
    "cylinder": "cylinder s 0 0 7 -.2 -.3 -.8 .4 .2 .7 .6",
    "tube": "tube s 0 0 7 -.2 -.3 -.8 .4 .2 .7 .6",
    "cone": "cone s 0 0 8 -.2 -.3 -.8 .4 .2 .7 .9 .2",
    "cup": "cup s 0 0 8 -.2 -.3 -.8 .4 .2 .7 .3 1",
    "source": "source s 0 0 4 .2 -.3 .8 150",
}
INWARD = {"bubble": "sphere", "tube": "cylinder", "cup": "cone"}


def rays_through(seed: int = 9, count: int = 300) -> Floats:
    """From all around towards points near the origin, and as many that start there."""
    random = np.random.default_rng(seed)
    targets = random.uniform(-0.7, 0.7, (count, 3))
    towards = random.normal(size=(count, 3))
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    return np.vstack([np.hstack([targets - 4 * towards, towards]), np.hstack([targets, towards])])


@pytest.mark.parametrize("shape", SHAPES)
def test_shapes_as_rays_meet_them(shape: str, radiance: Radiance, tmp_path: Path) -> None:
    """Where, how far away, with which normal and from which side: as colours of what shines at its front."""
    text = f"void colorfunc p 4 Nx+T+2 Ny+Px+5 Nz+Py+5 . 0 0\np glow g 0 0 4 1 1 1 0\ng {SHAPES[shape]}\n"
    if shape == "source":
        text = text.replace("Nx+T+2 Ny+Px+5 Nz+Py+5", "Dx+2 Dy+2 Dz+2")
    ours, theirs = both(radiance, tmp_path, text, rays=rays_through())
    shines = theirs.max(axis=1) > 0
    assert 0.05 < shines.mean() < 0.95
    assert_same(ours, theirs, 2e-6)


@pytest.mark.parametrize(("inward", "outward"), INWARD.items())
def test_shapes_whose_normals_look_inwards(inward: str, outward: str, radiance: Radiance, tmp_path: Path) -> None:
    """In the sun, inside and outside: what looks outwards is lit alike, so both faces count."""
    sun = "void light l 0 0 3 1e6 1e6 1e6\nl source sun 0 0 4 .3 -.5 .8 .2\nvoid plastic m 0 0 5 .6 .5 .4 0 0\n"
    for kind in (inward, outward):
        body = SHAPES[inward].replace(inward, kind, 1)
        ours, theirs = both(radiance, tmp_path, f"{sun}m {body}\n", rays=rays_through(5, 200), samples=16)
        error = np.abs(ours - theirs).max(axis=1) / theirs.max()
        # Edges of shadows have penumbras.
        assert np.mean(error < 3e-3) > 0.97, np.sort(error)[-20:]
        assert 0.05 < np.mean(theirs[:, 0] > 0) < 0.9


LAMP = "polygon q 0 0 12 -.5 -.3 2 -.5 .3 2 .5 .3 2 .5 -.3 2\n"
EMITTERS = {
    "light": f"light l 0 0 3 9 6 3\nl {LAMP}",
    "glow": f"glow l 0 0 4 9 6 3 8\nl {LAMP}",
    "illum": f"plastic seen 0 0 5 .5 .5 .5 0 0\nvoid illum l 1 seen 0 3 9 6 3\nl {LAMP}",
    # Small: Radiance takes a spotlight for a point.
    "spotlight": "spotlight l 0 0 7 9 6 3 100 .1 .2 -3\nl ring r 0 0 8 0 0 2 0 0 -1 0 .02\n",
    "mirror": "light l 0 0 3 1e6 1e6 1e6\nl source sun 0 0 4 .6 .1 .7 .5\n"
    "void mirror m 0 0 3 .9 .8 .7\nm polygon a 0 0 12 -3 -3 -2 3 -3 -2 3 3 -2 -3 3 -2\n",
}
DOWNWARDS = np.array([[x, y, 0, 0, 0, 1] for x in (-2, -0.3, 1.1) for y in (-1, 0.2, 1.5)], dtype=np.float64)


@pytest.mark.parametrize("emitter", EMITTERS)
def test_what_emits_lights_sensors(emitter: str, radiance: Radiance, tmp_path: Path) -> None:
    """Radiance cuts the lamp into small parts, ours samples its area; the mirror throws the sun up."""
    rays = DOWNWARDS * [1, 1, 1, 1, 1, -1] if emitter == "mirror" else DOWNWARDS
    text = f"void {EMITTERS[emitter]}"
    ours, theirs = both(radiance, tmp_path, text, "-I", "-ds", ".01", "-dj", "0", rays=rays, samples=4096)
    assert theirs.max() > 0
    assert np.abs(ours - theirs).max() < 5e-3 * theirs.max(), (ours, theirs)


@pytest.mark.parametrize("emitter", ["light", "glow", "spotlight"])
def test_what_emits_is_seen(emitter: str, radiance: Radiance, tmp_path: Path) -> None:
    """At its front, at its back, and beside it."""
    random = np.random.default_rng(2)
    width = 0.03 if emitter == "spotlight" else 0.8
    points = np.column_stack([random.uniform(-width, width, (80, 2)), np.full(80, 2.0)])
    towards = random.normal(size=(80, 3))
    rays = np.hstack([points - towards, towards / np.linalg.norm(towards, axis=1, keepdims=True)])
    ours, theirs = both(radiance, tmp_path, f"void {EMITTERS[emitter]}", rays=rays)
    assert 0.05 < np.mean(theirs[:, 0] > 0) < 0.9
    assert_same(ours, theirs, 2e-6)


@pytest.mark.parametrize("alternate", ["glass pane 0 0 3 .8 .9 .7", "glow pane 0 0 4 2 3 4 0", ""])
def test_an_illum_shows_what_it_stands_for(alternate: str, radiance: Radiance, tmp_path: Path) -> None:
    """A pane, another emitter, or nothing: as rays see it from both sides."""
    behind = "void colorfunc p 4 Dx+2 Dy+2 Dz+2 . 0 0\np glow b 0 0 4 1 2 3 0\nb source all 0 0 4 0 0 1 360\n"
    pane = f"void {alternate}\n" if alternate else ""
    illum = f"void illum i {'1 pane' if alternate else '1 void'} 0 3 50 60 70\ni ring r 0 0 8 0 0 0 0 0 1 0 .8\n"
    ours, theirs = both(radiance, tmp_path, behind + pane + illum, rays=rays_through(4, 100), samples=4096)
    assert_same(ours, theirs, 6e-3 if "glass" in alternate else 2e-6)


def the_reader_knows() -> list[str]:
    """All types, as the reader's own table names them."""
    text = (ROOT / "crates/scene/src/raw/types.rs").read_text()
    return re.findall(r'(?:plain|function)\("(\w+)", Class::', text)


def rows() -> list[tuple[str, str, str]]:
    """Of the page: primitive, whose answer, test."""
    found = re.findall(r"^\| `(\w+)` \| (.+?) \| (.+) \|$", PAGE.read_text(), re.MULTILINE)
    return [(name, answer, test) for name, answer, tests in found for test in re.findall(r"`(.+?)`", tests)]


def test_the_page_has_every_primitive() -> None:
    named = [name for name, _, _ in rows()]
    assert len(the_reader_knows()) > 50
    assert sorted(set(named)) == sorted(the_reader_knows())


@pytest.mark.parametrize(("name", "answer", "test"), rows(), ids=[f"{row[0]}-{row[2]}" for row in rows()])
def test_the_tests_of_the_page_are_there(name: str, answer: str, test: str) -> None:
    """Each has the primitive in its own text or in what it uses, and asks who the page says."""
    file, _, function = test.partition("::")
    text = (rust if file.endswith(".rs") else python)(ROOT / file, function)
    assert re.search(rf"\b{name}\b", text), f"{test} has no {name}"
    assert "Radiance" not in answer or "radiance" in text.lower()


def rust(file: Path, function: str) -> str:
    """A function, and the constants of its file that it names."""
    text = file.read_text()
    body = re.search(rf"^fn {function}\(.*?^}}$", text, re.MULTILINE | re.DOTALL)
    assert body, f"{file} has no {function}"
    constants = re.findall(r"^const (\w+)(: &str = .*?;)$", text, re.MULTILINE | re.DOTALL)
    return body.group() + "".join(value for name, value in constants if re.search(rf"\b{name}\b", body.group()))


def python(file: Path, function: str) -> str:
    """A function, and all of its file that it names, directly or not."""
    text = file.read_text()
    parts: dict[str, ast.stmt] = {}
    for part in ast.parse(text).body:
        if isinstance(part, ast.Assign):
            parts |= {target.id: part for target in part.targets if isinstance(target, ast.Name)}
        elif isinstance(part, ast.FunctionDef):
            parts[part.name] = part
    assert function in parts, f"{file} has no {function}"
    used, new = set[str](), {function}
    while new:
        used |= new
        new = {
            node.id
            for name in new
            for node in ast.walk(parts[name])
            if isinstance(node, ast.Name) and node.id in parts and node.id not in used
        }
    return "\n".join(ast.get_source_segment(text, parts[name]) or "" for name in used) + decorators(text, parts, used)


def decorators(text: str, parts: dict[str, ast.stmt], used: set[str]) -> str:
    """With the cases that functions are called with."""
    functions = (part for name in used if isinstance(part := parts[name], ast.FunctionDef))
    return "\n".join(ast.get_source_segment(text, mark) or "" for part in functions for mark in part.decorator_list)
