"""Programs that make surfaces, done inside, against Radiance's: names, order, and numbers as printed."""

import shlex
from pathlib import Path

import pytest

from conftest import Radiance
from sunpeak import _core

PRINTED = 2e-11
"""Twelve digits are printed."""

SMOOTHING = "Px*(A3+A4/sqrt(Px*Px+Py*Py)) Py*(A3+A4/sqrt(Px*Px+Py*Py)) Pz*A1+A2 ."

PRISMS = [
    "4 0 0 1 0 1 1 0 1",
    "4 0 0 0 1 1 1 1 0",
    "5 0 0 1 0 2 1 1 2 0 1 -l 0 0 2.5",
    "5 0 0 0 1 1 2 2 1 1 0 -l .5 .25 -3",
    "5 0 0 1 1 2 0 2 3 0 3 -c",
    "5 0 0 1 1 2 0 2 3 0 3 -e -l 0 0 -1",
    "3 0 0 1 0 0 1 -c -e",
    "4 0 0 1 0 1 1 0 1 -r .1",
    "4 0 0 0 1 1 1 1 0 -r .1 -l 0 0 2",
    "4 0 0 0 1 1 1 1 0 -r .1 -l 0 0 -2",
    "4 0 0 1 0 1 1 0 1 -r .1 -l 0 0 -2",
    "4 0 0 0 1 1 1 1 0 -r .1 -l 0 0 2 -c -e",
    "5 0 0 1 1 2 0 2 3 0 3 -r .1 -l 0 0 2",
    "5 0 3 2 3 2 0 1 1 0 0 -r .2 -l 0 0 2 -c",
    "6 0 0 .5 1.5 1.5 2 3 1.25 2.5 -.5 1 -1 -r .125",
    "outline.txt -l 0 0 .4",
]
BLINDS = [
    ".05 1 1.2 4 30",
    ".05 1 1.2 3 0",
    ".08 2 1 2 -45",
    ".05 1 1.2 2 30 -r .04",
    ".05 1 1.2 1 -30 +r .1",
    ".05 1 1.2 1 90 +r .03",
    ".05 1 1.2 2 0 +r 1",
    ".05 1 1.2 1 12.5 -r .026",
    ".05 1 1.2 1 135 -r .0251",
]
FUNCTIONS = [
    "genrev m r t 1+t 3",
    "genrev m r 0 t 2",
    "genrev m r 0 1-t 2",
    "genrev m r 1-t 1 2",
    "genrev m r 1-t 1-t 1",
    "genrev m r '3*t' 'if(t-.5,1,.5)' 4 -e 'a=1'",
    "genrev m r 'sin(PI*t)' 'hermite(.1,.5,w,-1,t)' 7 -f defs.cal -e 'w=2*half'",
    "genrev m r 't*t' '1-t*.5' 3 -s",
    "genrev m r 'sin(2*PI*t)' '2+cos(2*PI*t)' 5 -s",
    "genrev m r 't*t' 'if(t-.6,.5,1)' 4 -s",
    "genrev m r 'if(t-.4,.5,t)' '1+t*t' 4 -s",
    "genworm m w t 't*t' 0 '.1+t' 2",
    "genworm m w '.1*t' 0 0 '.1+t' 2",
    "genworm m w t t t .1 1",
    "genworm m w 'cos(2*PI*t)' 'sin(2*PI*t)' 'bezier(0,1,half,2,t)' '.1-.05*t' 9 -f defs.cal",
    "gensurf m s s t 0 1 1",
    "gensurf m s s t 's*t' 2 2",
    "gensurf m s s t 's*t' 2 3",
    "gensurf m s s 's*t' t 2 1",
    "gensurf m s 't*cos(s)' 't*sin(s)' 0 2 2",
    "gensurf m s 's*1.5+.1*t' 't+s*.2' '.3*s+.2*t' 2 2",
    "gensurf m s 's+t*t*s' 't+.3*s*t' 0 2 2",
    "gensurf m s 'cos(6.28*s)' 'sin(6.28*s)' t 3 2",
    "gensurf m s s t 's*t*1e-7' 1 1",
    "gensurf m s s t 's*t*1e-5' 1 1",
    "gensurf m s s t 'half*bump(s)*bump(t)' 4 5 -f defs.cal",
    "gensurf m s s t 's*t' 2 2 -e 'valid(s,t):s-t+.1'",
    "gensurf m s s t 's*t' 3 3 -e 'valid(s,t)=if(s+t-.5,if(s-t-.5,-1,1.7-s-t),-1)'",
]


@pytest.mark.parametrize(
    "command",
    FUNCTIONS + [f"genprism m p {prism}" for prism in PRISMS] + [f"genblinds m b {blind}" for blind in BLINDS],
)
def test_surfaces_are_those_of_radiance(
    command: str, radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("outline.txt").write_text("0 0\n1 0\n.5 2 -1 1\n")
    Path("defs.cal").write_text("{ a hump } half : .5; bump(x) = sin(PI*x)^2;")
    # Ours say what these are, without a file of Radiance's.
    theirs_says, ours_says = b"rev_dx rev_dy rev_dz rev.cal", SMOOTHING.encode()
    Path("theirs.rad").write_bytes(radiance.run(*shlex.split(command), folder=tmp_path).replace(theirs_says, ours_says))
    ours, theirs = words(f"!{command}"), words("theirs.rad")
    assert len(ours) == len(theirs) > 0
    for mine, other in zip(ours, theirs, strict=True):
        assert mine == other or abs(float(mine) - float(other)) <= PRINTED * max(1.0, abs(float(other))), (mine, other)


def words(source: str) -> list[str]:
    """Primitives of a file or a `!command`, word by word."""
    return "".join(text for _, text in _core.expanded_scene([source], ".", [], False)).split()


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("genprism m p 2 0 0 1 1", "2 vertices: expected 3 or more"),
        ("genprism m p 3 0 0 1 1", "3 vertices: expected as many pairs"),
        ("genprism m p 3 0 0 1 1 0 1 -l 1 1 0", "expected a z that is not 0"),
        ("genprism m p 3 0 0 1 1 0 0 -r .1", "turns back at vertex"),
        ("genprism m p 3 0 0 1 1 0 1 -r .1 -l 1 0 1", "rounded edges (-r) of an oblique prism"),
        ("genprism m p -", "vertices on standard input"),
        ("genprism m p no.txt", "cannot find the file"),
        ("genprism m p 999999999999 0 0", "expected the number of vertices"),
        ("genblinds m b .05 1 1.2 2 30 -r .01", "the radius 0.01 does not span"),
        ("genblinds m b .05 1 1.2 x 30", "expected the number of slats"),
        ("genblinds m", "expected genblinds material name"),
        ("genrev m r t nosuch(t) 2", "nosuch"),
        ("genworm m w 0 s 0 .1 5", '"s" is not defined'),
        ("gensurf m s s t 1 2 2 -s", "smoothing (-s) is not done inside"),
        ("genrev m r t '1 +' 2", "genrev: "),
        ("genrev m r t 'f(t)' 2 -e 'f(x)=f(x)+1'", "genrev: "),
        ("gensurf m s s t 0 100000 100000", "more than 4000000"),
        ("genworm m w t t t .1", "expected genworm material name"),
        ("genblinds m b 1 1 1 4000000 0 +r .5", "more than 4000000 surfaces"),
    ],
)
def test_mistakes_are_named(command: str, expected: str) -> None:
    with pytest.raises(_core.InputError) as raised:
        words(f"!{command}")
    assert expected in str(raised.value)
