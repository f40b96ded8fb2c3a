"""Scenes with commands against what Radiance's `xform` makes of them."""

from pathlib import Path

import pytest

import sunpeak as sp
from conftest import ROOT, Radiance

STRESS = ROOT / "crates/scene/tests/data/stress"


def expanded(radiance: Radiance, folder: Path, name: str) -> str:
    """All commands done by Radiance."""
    return radiance.run("xform", "-e", name, folder=folder).decode()


def test_the_recorded_expansion_is_todays(radiance: Radiance) -> None:
    recorded = (STRESS.parent / "stress-expanded.txt").read_text().split()
    lines = [line for line in expanded(radiance, STRESS, "all.rad").splitlines() if not line.startswith("#")]
    assert " ".join(lines).split() == recorded


@pytest.mark.parametrize(
    ("folder", "name"),
    [
        ("tutorial-room", "room.rad"),
        ("tutorial-room", "overhang/aluminiumGrate.rad"),
        ("frads-room", "Objects/desks.rad"),
        ("radiance-renders", "disks.rad"),
        ("cornell-box", "cornell.rad"),
    ],
)
def test_real_scenes_have_the_surfaces_that_radiance_sees(
    folder: str, name: str, shared: Path, radiance: Radiance, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(shared / "scenes" / folder)
    text = expanded(radiance, Path.cwd(), name)
    modifiers = {line.split()[0] for line in text.splitlines() if line.split()[1:2] and not line.startswith("#")}
    materials = "".join(f"void plastic {m} 0 0 5 .5 .5 .5 0 0\n" for m in sorted(modifiers) if is_name(m))
    ours = sp.Scene.parse(f"{materials}!xform {name}\n")
    theirs = sp.Scene.parse(materials + text)
    assert ours.surfaces == theirs.surfaces
    assert len(ours.surfaces) > 0


def is_name(word: str) -> bool:
    """Not a number: those stand at the beginnings of lines too."""
    return not word.lstrip("-+.").replace(".", "").isdigit() and word != "void"
