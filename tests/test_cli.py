"""The command line: exit status, what is said where, and nothing half-written."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from conftest import CommandLine
from sunpeak import Fabric

ROOM = """\
void plastic wall 0 0 5 .5 .5 .5 0 0
!genbox wall room 4 3 2.5 -i
void light lamp 0 0 3 100 100 100
lamp polygon panel 0 0 12 1.5 1 2.4 1.5 2 2.4 2.5 2 2.4 2.5 1 2.4
"""

EYE = "-vta -vp 2 1.5 1.2 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180"


@pytest.fixture
def room(tmp_path: Path) -> Path:
    path = tmp_path / "room.rad"
    path.write_text(ROOM)
    return path


def files(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


COMMANDS = [
    "render",
    "glare",
    "glare compare",
    "glare draw",
    "trace",
    "demo",
    "bsdf",
    "bsdf info",
    "bsdf through",
    "bsdf split",
    "bsdf plot",
    "sky",
    "sky perez",
    "sky cie",
    "sky epw",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_help(command: str, sunpeak: CommandLine) -> None:
    answer = sunpeak(*command.split(), "--help")
    assert f"sunpeak {command}" in answer.out
    assert answer.err == ""


def test_root_help_names_every_command(sunpeak: CommandLine) -> None:
    answer = sunpeak("--help")
    for command in COMMANDS:
        assert command.split()[0] in answer.out


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["render"],
        ["render", "room.rad", "-v", EYE],
        ["render", "room.rad", "-v", EYE, "-o", "out.hdr", "--size", "0x10"],
        ["render", "room.rad", "-v", EYE, "-o", "out.hdr", "--size", "large"],
        ["render", "room.rad", "-v", EYE, "-o", "out.hdr", "--peak", "sharp"],
        ["bsdf", "through", "file.xml", "--theta", "0,x"],
        ["sky", "perez", "--direct", "1"],
        ["sky", "cie", "clear", "--altitude", "30"],
        ["sky", "cie", "clear", "--place", "47,11", "--time", "2024-06-21T12:00"],
    ],
)
def test_wrong_usage_is_2(arguments: list[str], sunpeak: CommandLine, room: Path) -> None:
    answer = sunpeak(*arguments, folder=room.parent, expect=2)
    assert answer.out == ""
    assert "rror" in answer.err or "Usage" in answer.err
    assert files(room.parent) == {"room.rad"}


WRONG_SCENES = {
    "unknown primitive": ("void plastic a 0 0 5 .5 .5 .5 0 0\na polyhedron p\n0\n0\n3 0 0 0\n", 2),
    "wrong argument count": ("void plastic a\n0\n0\n4 .5 .5 .5 0\na sphere s 0 0 4 0 0 0 1\n", 1),
    "count too large": ("void plastic a\n0\n0\n5 .5 .5 .5 0\n", 4),
    "undefined modifier": ("void plastic a 0 0 5 .5 .5 .5 0 0\nb sphere s 0 0 4 0 0 0 1\n", 2),
    "not a number": ("void plastic a\n0\n0\n5 .5 .5 nan 0 0\n", 4),
    "missing BSDF file": ("void aBSDF a\n5 nowhere.xml 0 0 1 .\n0\n0\na sphere s 0 0 4 0 0 0 1\n", 1),
    "command of the shell": ("!rm -rf nowhere\n", 1),
    "missing include": ("!xform -t 0 0 1 nowhere.rad\n", 1),
}


@pytest.mark.parametrize("name", WRONG_SCENES)
def test_wrong_scenes_are_1_with_file_and_line(name: str, sunpeak: CommandLine, tmp_path: Path) -> None:
    text, line = WRONG_SCENES[name]
    (tmp_path / "wrong.rad").write_text(text)
    answer = sunpeak("render", "wrong.rad", "-v", EYE, "-o", "out.hdr", folder=tmp_path, expect=1)
    assert answer.out == ""
    first = answer.err.splitlines()[0]
    place = re.match(r"sunpeak: wrong\.rad:(\d+)(:\d+)?: ", first)
    assert place, answer.err
    assert int(place[1]) == line, first
    assert files(tmp_path) == {"wrong.rad"}


@pytest.mark.parametrize(
    "view",
    [
        "-vta -vp 0 0 0 -vd 0 1 0 -vu 0 0 1 -vh 0 -vv 0",
        "-vtv -vp 0 0 0 -vd 0 0 0 -vu 0 0 1",
        "-vtv -vp 0 0 0 -vd 0 0 1 -vu 0 0 1",
        "-vtv -vh 200",
        "-vtx",
        "nowhere.vf",
    ],
)
def test_wrong_views_are_1(view: str, sunpeak: CommandLine, room: Path) -> None:
    answer = sunpeak("render", "room.rad", f"--view={view}", "-o", "out.hdr", folder=room.parent, expect=1)
    assert answer.err.startswith("sunpeak: ")
    assert len(answer.err.splitlines()) == 1
    assert files(room.parent) == {"room.rad"}


def test_missing_files_are_1(sunpeak: CommandLine, tmp_path: Path) -> None:
    for arguments in (
        ["render", "nowhere.rad", "-v", EYE, "-o", "out.hdr"],
        ["glare", "nowhere.hdr"],
        ["bsdf", "info", "nowhere.xml"],
        ["bsdf", "through", "nowhere.xml"],
        ["sky", "epw", "nowhere.epw", "--month", 1, "--day", 1, "--hour", 12],
    ):
        answer = sunpeak(*arguments, folder=tmp_path, expect=1)
        assert re.match(r"sunpeak: nowhere\.\w+: ", answer.err), answer.err
        assert files(tmp_path) == set()


def fabric(folder: Path, basis: str) -> Path:
    path = folder / "shade.xml"
    Fabric().write(path, basis)
    return path


@pytest.mark.parametrize("basis", ["klems-quarter", "t3-64"])
@pytest.mark.parametrize("damage", ["truncated", "too few values", "not a number"])
def test_wrong_tables_are_1_with_file_and_line(damage: str, basis: str, sunpeak: CommandLine, tmp_path: Path) -> None:
    text = fabric(tmp_path, basis).read_text()
    start, end = text.index("<ScatteringData>"), text.index("</ScatteringData>")
    numbers = list(re.compile(r"[-+.\de]*\d").finditer(text, start, end))
    last = numbers[len(numbers) // 2]
    wrong = {
        "truncated": text[: last.start()],
        "too few values": text[: last.start()] + text[last.end() :].lstrip(", "),
        "not a number": text[: last.start()] + "nan" + text[last.end() :],
    }[damage]
    (tmp_path / "wrong.xml").write_text(wrong)
    answer = sunpeak("bsdf", "info", "wrong.xml", folder=tmp_path, expect=1)
    assert answer.out == ""
    assert re.match(r"sunpeak: wrong\.xml:\d+:\d+: ", answer.err), answer.err


def test_nothing_is_written_into_a_missing_folder(sunpeak: CommandLine, room: Path) -> None:
    answer = sunpeak("render", "room.rad", "-v", EYE, "-o", "no/out.hdr", folder=room.parent, expect=1)
    assert "no/out.hdr" in answer.err
    assert files(room.parent) == {"room.rad"}


def test_render_and_glare(sunpeak: CommandLine, room: Path) -> None:
    answer = sunpeak(
        "render", "room.rad", "-v", EYE, "-o", "out.hdr", "--size", "40x40", "--samples", 2, "--png", folder=room.parent
    )
    assert answer.out == ""
    assert files(room.parent) == {"room.rad", "out.hdr", "out.png", "out_false.png"}
    report = json.loads(sunpeak("glare", "out.hdr", "--json", folder=room.parent).out)
    assert {"dgp", "dgp_interval", "ev_lux", "sources"} <= report.keys()
    assert sunpeak("glare", "out.hdr", folder=room.parent).out.startswith("DGP")


def test_the_same_seed_gives_the_same_picture_on_any_threads(sunpeak: CommandLine, room: Path) -> None:
    for name, threads in (("one.hdr", 1), ("two.hdr", 2)):
        sampling = ["--size", 32, "--samples", 4, "--seed", 7, "--threads", threads]
        sunpeak("render", "room.rad", "-v", EYE, "-o", name, *sampling, folder=room.parent)
    assert (room.parent / "one.hdr").read_bytes() == (room.parent / "two.hdr").read_bytes()


def test_ctrl_c_leaves_nothing(room: Path) -> None:
    command = [sys.executable, "-m", "sunpeak", "render", "room.rad", "-v", EYE, "-o", "out.hdr"]
    process = subprocess.Popen(
        [*command, "--size", "800", "--samples", "100000"],
        cwd=room.parent,
        stderr=subprocess.PIPE,
        text=True,
        # As from a terminal: what a shell starts in the background has the signal ignored, and would hand that on.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509  (this process has no threads)
    )
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert files(room.parent) == {"room.rad"}


def test_trace_reads_rays_and_sensors(sunpeak: CommandLine, room: Path) -> None:
    sensors = "2 1.5 0.8 0 0 1\n\n2 1.5 0.8 0 0 2\n"
    answer = sunpeak("trace", room, "-I", "--samples", 256, data=sensors)
    values = np.array([line.split() for line in answer.out.splitlines()], dtype=float)
    assert values.shape == (2, 3)
    np.testing.assert_allclose(values[0], values[1], rtol=0.05)
    lux = float(sunpeak("trace", room, "-I", "-p", "--samples", 256, data=sensors.splitlines()[0]).out)
    assert lux == pytest.approx(179 * values[0] @ [0.265, 0.67, 0.065], rel=1e-5)
    stated = sunpeak("trace", room, "-I", "-p", "--errors", "--samples", 256, data=sensors.splitlines()[0]).out.split()
    assert float(stated[0]) == lux
    assert 0 < float(stated[1]) < 0.05 * lux


@pytest.mark.parametrize("line", ["1 2 3 0 0", "1 2 3 0 0 x", "1 2 3 0 0 nan", "1 2 3 0 0 0"])
def test_trace_refuses_wrong_rays(line: str, sunpeak: CommandLine, room: Path) -> None:
    answer = sunpeak("trace", room, data=f"0 0 0 0 0 1\n{line}\n", expect=1)
    assert answer.out == ""
    assert re.match(r"sunpeak: (standard input:2: |directions: row 1 )", answer.err), answer.err


def test_a_named_portal_changes_the_error_alone(sunpeak: CommandLine, tmp_path: Path) -> None:
    """A room whose front leaves an opening between four polygons, under an even sky; the opening's is of `void`."""
    corners = {
        "floor": "0 0 0 4 0 0 4 5 0 0 5 0",
        "ceiling": "0 0 3 0 5 3 4 5 3 4 0 3",
        "left": "0 0 0 0 5 0 0 5 3 0 0 3",
        "right": "4 0 0 4 0 3 4 5 3 4 5 0",
        "back": "0 5 0 4 5 0 4 5 3 0 5 3",
        "below": "0 0 0 0 0 1 4 0 1 4 0 0",
        "above": "0 0 2 0 0 3 4 0 3 4 0 2",
        "beside": "0 0 1 0 0 2 1 0 2 1 0 1",
        "beyond": "3 0 1 3 0 2 4 0 2 4 0 1",
    }
    scene = tmp_path / "room.rad"
    scene.write_text(
        "void plastic wall 0 0 5 .5 .5 .5 0 0\nvoid glow bright 0 0 4 1 1 1 0\nbright source sky 0 0 4 0 0 1 180\n"
        + "".join(f"wall polygon {name} 0 0 12 {points}\n" for name, points in corners.items())
        + "void polygon hole 0 0 12 1 0 1 1 0 2 3 0 2 3 0 1\n"
    )
    options = ("-I", "--errors", "--samples", 1024)
    command = ("trace", scene, *options)
    found = [
        [float(word) for word in sunpeak(*command, *more, data="2 4 0.8 0 0 1\n").out.split()]
        for more in ((), ("--portal", "hole"))
    ]
    (blind, *_, blind_error), (named, *_, named_error) = found
    assert abs(blind - named) < 4 * np.hypot(blind_error, named_error)
    assert named_error < 0.5 * blind_error
    answer = sunpeak(*command, "--portal", "window", data="2 4 0.8 0 0 1\n", expect=1)
    assert "portal 'window': no surface or modifier has this name" in answer.err


def test_bsdf_info_and_through(sunpeak: CommandLine, tmp_path: Path) -> None:
    fabric(tmp_path, "t3-1024")
    about = json.loads(sunpeak("bsdf", "info", "shade.xml", "--json", folder=tmp_path).out)
    assert about["peak"]["front"]["fires"]
    assert about["components"][0]["basis"] == "TensorTree3"
    assert "the peak is taken" in sunpeak("bsdf", "info", "shade.xml", folder=tmp_path).out
    text = sunpeak("bsdf", "through", "shade.xml", "--theta", "0,30", "--phi", "0,90", folder=tmp_path).out
    rows = np.array([line.split() for line in text.splitlines()], dtype=float)
    np.testing.assert_allclose(rows[:, :2], [[0, 0], [30, 0], [0, 90], [30, 90]])
    np.testing.assert_allclose(rows[:, 2], 0.02 * np.cos(np.radians(90 * rows[:, 0] / 68)) ** 0.6, rtol=0.01)


def test_sky_is_a_scene(sunpeak: CommandLine, tmp_path: Path) -> None:
    sky = tmp_path / "sky.rad"
    sunpeak("sky", "perez", "--altitude", 40, "--azimuth", 180, "--direct", 600, "--diffuse", 100, "-o", sky)
    lux = float(sunpeak("trace", sky, "-I", "-p", "--samples", 1024, data="0 0 0 0 0 1").out)
    stated = re.search(r"direct normal (\d+) lx, diffuse horizontal (\d+) lx", sky.read_text())
    assert lux == pytest.approx(float(stated[1]) * np.sin(np.radians(40)) + float(stated[2]), rel=0.01)
