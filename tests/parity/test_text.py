"""Text patterns and mixtures against `rtrace`, in fonts of our own: random polygons for characters."""

from pathlib import Path

import numpy as np
import pytest
from test_modifiers import Floats, both

import sunpeak as sp
from conftest import Radiance

TEXT = "Some words,  and\n    indented   columns of them\n\n\tno tab in the font; aA bB  cC\nlast line"


def a_font(seed: int) -> str:
    """Letters of both cases, a comma and a space; letters are polygons of up to nine vertices."""
    random = np.random.default_rng(seed)
    lines = ["# code, number of vertices, vertices", "32 0"]
    for code in [44, *range(65, 91), *range(97, 123)]:
        vertices = random.integers(0, 256, (random.integers(3, 10), 2))
        lines.append(f"{code} {len(vertices)}\n\t" + "\n\t".join(f"{x} {y}" for x, y in vertices) + " # done")
    return "\n".join(lines)


def on_a_plane(count: int = 3000) -> Floats:
    """Rays down onto a square from -1 to 5 and from -5 to 1, from all sides."""
    random = np.random.default_rng(7)
    points = np.column_stack([random.uniform(-1, 5, count), random.uniform(-5, 1, count), np.zeros(count)])
    towards = np.column_stack([random.normal(size=(count, 2)), np.full(count, -2.0)])
    return np.hstack([points - towards, towards / np.linalg.norm(towards, axis=1)[:, None]])


PLANE = "polygon q 0 0 12 -2 -6 0 6 -6 0 6 2 0 -2 2 0\n"
LINE = "font.fnt . A line of Words"
FRAME = "-.1 .1 0 .4 0 0 0 -.7 0"
LARGE = "-.9 .8 0 .35 0 0 0 -4 0"
OBLIQUE = "-.1 .1 .3 .4 .03 .1 .1 -.7 .2"
RIGHT_TO_LEFT = "4.5 0 0 -.3 0 0 .05 -3 0"
TEXTS = {
    "a line": f"brighttext t 6 {LINE} 0 11 {LARGE} .9 .1",
    "bright on dark, turned round": f"brighttext t 6 {LINE} 0 11 {RIGHT_TO_LEFT} .1 .9",
    "a file": f"colortext t 2 font.fnt words.txt 0 15 {FRAME} .9 .8 .7 .1 .2 .3",
    "oblique": f"colortext t 2 font.fnt words.txt 0 15 {OBLIQUE} .9 .8 .7 .1 .2 .3",
    "spacing 0": f"brighttext t 2 font.fnt words.txt 0 12 {FRAME} .9 .1 0",
    "columns": f"brighttext t 2 font.fnt words.txt 0 12 {FRAME} .9 .1 .2",
    "wide columns": f"colortext t 2 font.fnt words.txt 0 16 {OBLIQUE} .9 .8 .7 .1 .2 .3 .37",
    "tight": f"brighttext t 2 font.fnt words.txt 0 12 {FRAME} .9 .1 -.15",
    "a tight line": f"brighttext t 6 {LINE} 0 12 {LARGE} .9 .1 -.3",
}


def font_and_words(folder: Path) -> None:
    (folder / "font.fnt").write_text(a_font(1))
    (folder / "words.txt").write_text(TEXT)


def assert_equal(ours: Floats, theirs: Floats) -> None:
    """Each ray: a point is in a character or not."""
    assert np.ptp(theirs[:, 0]) > 0.5
    assert 0.02 < (theirs[:, 0] > 0.5).mean() < 0.98
    wrong = np.abs(ours - theirs).max(axis=1) > 1e-5
    assert not wrong.any(), (wrong.sum(), ours[wrong][:4], theirs[wrong][:4])


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS.keys())
def test_patterns(text: str, radiance: Radiance, tmp_path: Path) -> None:
    font_and_words(tmp_path)
    scene = f"void {text}\nt glow g 0 0 4 1 1 1 0\ng {PLANE}"
    assert_equal(*both(radiance, tmp_path, scene, rays=on_a_plane()))


@pytest.mark.parametrize("spacing", ["9 " + FRAME, "10 " + FRAME + " -.1", "10 " + FRAME + " .1"])
def test_mixtures_of_materials(spacing: str, radiance: Radiance, tmp_path: Path) -> None:
    font_and_words(tmp_path)
    scene = (
        "void glow a 0 0 4 1 .5 .2 0\nvoid glow b 0 0 4 .1 .2 .3 0\n"
        f"void mixtext t 4 a b font.fnt words.txt 0 {spacing}\nt {PLANE}"
    )
    assert_equal(*both(radiance, tmp_path, scene, rays=on_a_plane()))


def test_holes_in_the_shape_of_letters(radiance: Radiance, tmp_path: Path) -> None:
    font_and_words(tmp_path)
    scene = (
        "void glow a 0 0 4 1 .5 .2 0\nvoid glow b 0 0 4 .1 .2 .3 0\n"
        f"void mixtext t 7 void a {LINE[:-6]} 0 9 {LARGE}\nt {PLANE}b source behind 0 0 4 0 0 -1 180\n"
    )
    ours, theirs = both(radiance, tmp_path, scene, rays=on_a_plane())
    assert_equal(ours, theirs)


@pytest.mark.parametrize("use", ["xform", "instance"])
def test_text_moves(use: str, radiance: Radiance, tmp_path: Path) -> None:
    font_and_words(tmp_path)
    (tmp_path / "sign.rad").write_text(
        f"void brighttext t 2 font.fnt words.txt 0 12 {FRAME} .9 .1 -.1\nt glow g 0 0 4 1 1 1 0\ng {PLANE}"
    )
    radiance.octree(tmp_path / "sign.oct", "sign.rad", folder=tmp_path)
    moved = "-s 1.3 -rz 25 -t .2 -.3 0"
    scene = f"!xform {moved} sign.rad\n" if use == "xform" else f"void instance i 9 sign.oct {moved} 0 0\n"
    assert_equal(*both(radiance, tmp_path, scene, rays=on_a_plane()))


ONE = "brighttext t 2 font.fnt words.txt 0"
MISTAKES = {
    f"{ONE} 9 {FRAME}": "expected 11 real arguments",
    f"{ONE} 11 0 0 0 1 0 0 2 0 0 1 0": "span no plane",
    f"{ONE} 12 {FRAME} 1 0 1e9": "the spacing is 1000000000",
    f"brighttext t 2 no.fnt words.txt 0 11 {FRAME} 1 0": 'font file: cannot find the file "no.fnt"',
    f"brighttext t 2 font.fnt no.txt 0 11 {FRAME} 1 0": 'text file: cannot find the file "no.txt"',
    f"brighttext t 1 font.fnt 0 11 {FRAME} 1 0": "expected at least 2 string arguments",
    f"brighttext t 2 font.fnt long.txt 0 11 {FRAME} 1 0": "line 2 of the text: expected at most",
    f"brighttext t 3 word.fnt . a 0 11 {FRAME} 1 0": 'word.fnt:2:1: expected a coordinate, 0 to 255, found "x"',
    f"brighttext t 3 short.fnt . a 0 11 {FRAME} 1 0": "short.fnt:1:1: the font ends within character 65",
    f"brighttext t 3 twice.fnt . a 0 11 {FRAME} 1 0": "twice.fnt:2:1: character 65 is in the font twice",
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes_are_named(text: str, tmp_path: Path) -> None:
    font_and_words(tmp_path)
    (tmp_path / "long.txt").write_text("short\n" + "x" * 600)
    for name, content in [("word", "65 1\n x 3"), ("short", "65 2 1 1"), ("twice", "65 0\n65 0")]:
        (tmp_path / f"{name}.fnt").write_text(content)
    (tmp_path / "scene.rad").write_text(f"void {text}\nt glow g 0 0 4 1 1 1 0\ng {PLANE}")
    with pytest.raises(sp.InputError) as error:
        sp.Scene.load([tmp_path / "scene.rad"])
    assert MISTAKES[text] in str(error.value)
    assert "scene.rad:1" in str(error.value)
