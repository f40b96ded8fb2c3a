"""Files of `rad`: what a scene is made of, and its views."""

from pathlib import Path

import pytest

import sunpeak as sp
from conftest import CommandLine
from sunpeak.rad_input import RadInput

TEXT = """# comment
OCTREE= x.oct
scene= walls.rad "!genbox white b 1 1 1" \\
    more*.rad
mat = a.mat
illum= window.rad
objects= not_read.rad
view= first -vf eye.vf -vh 90
view= -vp 0 0 1
"""


def test_materials_come_first_and_wildcards_are_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("more2.rad", "more1.rad"):
        Path(name).write_text("")
    Path("x.rif").write_text(TEXT)
    read = RadInput.load("x.rif")
    assert read.files == ["a.mat", "window.rad", "walls.rad", "!genbox white b 1 1 1", "more1.rad", "more2.rad"]
    assert read.views == {"first": ["-vf", "eye.vf", "-vh", "90"], "2": ["-vp", "0", "0", "1"]}
    assert read.view() == read.views["first"]
    with pytest.raises(sp.InputError, match="no view 'third': the file has first, 2"):
        read.view("third")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("scene= a.rad\nwhat is this\n", "x.rif:2: expected NAME= value, found 'what is this'"),
        ("\nscene= 'a.rad\n", "x.rif:2: No closing quotation: expected words"),
        ("QUAL= High\n", "x.rif: no scene: expected scene= FILES"),
    ],
)
def test_mistakes_are_said(text: str, says: str, tmp_path: Path, sunpeak: CommandLine) -> None:
    (tmp_path / "x.rif").write_text(text)
    answer = sunpeak("render", "x.rif", "-o", "x.hdr", folder=tmp_path, expect=1)
    assert says in answer.err


def test_a_view_is_needed(tmp_path: Path, sunpeak: CommandLine) -> None:
    (tmp_path / "x.rad").write_text("")
    assert "expected a view" in sunpeak("render", "x.rad", "-o", "x.hdr", folder=tmp_path, expect=2).err
