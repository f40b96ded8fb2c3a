"""Radiance's programs as Sunpeak does them, without Radiance: what they refuse, what they say, what they write."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine
from sunpeak.compat import numbers, options, quality, radiance
from sunpeak.compat.install import install
from sunpeak.compat.programs import main as run_program

ROOM = """void plastic white 0 0 5 .5 .5 .5 0 0
void light lamp 0 0 3 10 10 10
!genbox white room 4 5 3 -i
lamp polygon shade 0 0 12 1.5 2 2.99 1.5 3 2.99 2.5 3 2.99 2.5 2 2.99
"""


@pytest.fixture
def room(tmp_path: Path, sunpeak: CommandLine) -> Path:
    """A folder with a scene and its octree."""
    (tmp_path / "room.rad").write_text(ROOM)
    (tmp_path / "room.oct").write_bytes(program("oconv", "room.rad", folder=tmp_path))
    return tmp_path


def program(name: str, *arguments: str, folder: Path, data: bytes = b"", expect: int = 0, says: str = "") -> bytes:
    """What a program writes to standard output."""
    command = [sys.executable, "-P", "-m", "sunpeak.compat", name, *arguments]
    done = subprocess.run(command, cwd=folder, input=data, capture_output=True, check=False)
    error = done.stderr.decode()
    assert done.returncode == expect, error
    assert "Traceback" not in error
    assert says in error
    return done.stdout


def test_installed_programs_run_and_other_files_are_not_overwritten(tmp_path: Path) -> None:
    folder = tmp_path / "bin"
    programs = install(folder)
    assert sorted(p.name for p in programs) == ["evalglare", "getinfo", "oconv", "rpict", "rtrace", "vwrays"]
    done = subprocess.run([folder / "vwrays", "-d", "-x", "8", "-y", "4"], capture_output=True, text=True, check=True)
    assert done.stdout == "-x 4 -y 4\n"
    install(folder)
    (folder / "rpict").write_text("somebody else's")
    with pytest.raises(sp.InputError, match=r"rpict: exists, and is not of Sunpeak's making"):
        install(folder)
    assert (folder / "rpict").read_text() == "somebody else's"


def test_an_octree_names_its_files_and_refuses_others(room: Path) -> None:
    made = (room / "room.oct").read_bytes()
    assert made.startswith(b"#?RADIANCE\noconv room.rad\nFORMAT=Sunpeak_octree\n\n")
    assert f"file\t{room}/room.rad\n".encode() in made
    rays = b"2 2 1 0 0 1\n"
    lit = program("rtrace", "-h", "-ab", "0", "-w-", "room.oct", folder=room, data=rays)
    assert [float(word) for word in lit.split()] == [10, 10, 10]
    # Another material counts, another number of surfaces does not.
    (room / "room.rad").write_text(ROOM.replace("10 10 10", "20 20 20"))
    lit = program("rtrace", "-h", "-ab", "0", "-w-", "../room.oct", folder=subfolder(room), data=rays)
    assert [float(word) for word in lit.split()] == [20, 20, 20]
    (room / "room.rad").write_text(ROOM + "white sphere ball 0 0 4 1 1 1 .2\n")
    says = "room.oct: out of date: its files have 8 surfaces now, and had 7"
    program("rpict", "room.oct", folder=room, expect=1, says=says)


def subfolder(folder: Path) -> Path:
    """Make a folder in a folder."""
    inner = folder / "inner"
    inner.mkdir()
    return inner


def test_a_frozen_octree_needs_no_files(room: Path) -> None:
    frozen = program("oconv", "-f", "-", "!genbox white cube 1 1 1", folder=room, data=ROOM.encode())
    included = program("oconv", "-w-", "-i", "frozen.oct", folder=write(room, "frozen.oct", frozen))
    write(room, "both.oct", included)
    (room / "room.rad").unlink()
    rays = b".5 .5 2 0 0 -1\n"
    for name in ("frozen.oct", "both.oct"):
        names = program("rtrace", "-h", "-w-", "-osL", name, folder=room, data=rays)
        assert names == b"cube.5137\t1.000000e+00\t\n" or names.split()[1] == b"1.000000e+00"


def write(folder: Path, name: str, data: bytes) -> Path:
    """Write a file; give its folder."""
    (folder / name).write_bytes(data)
    return folder


def test_an_instance_reads_our_octrees(room: Path) -> None:
    cube = program("oconv", "-f", "-w-", "-", folder=room, data=b"void plastic w 0 0 5 .5 .5 .5 0 0\n!genbox w c 1 1 1")
    write(room, "cube.oct", cube)
    scene = b"void instance i 7 cube.oct -t 0 0 2 -s 1 0 0\n"
    write(room, "scene.oct", program("oconv", "-", folder=room, data=scene))
    depth = program("rtrace", "-h", "-w-", "-oL", "scene.oct", folder=room, data=b".5 .5 5 0 0 -1\n")
    assert float(depth) == pytest.approx(2)


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (["rpict", "-q", "room.oct"], "rpict: command line error at '-q': unknown option"),
        (["rpict", "-vp", "1", "2"], "rpict: command line error at '-vp': expected 3 value(s)"),
        (["rpict", "-ab", "x", "room.oct"], "-ab x: expected 1 number(s)"),
        (["rpict", "none.oct"], "none.oct: No such file"),
        (["rpict", "room.rad"], "room.rad: expected lines of text and an empty one, found no header"),
        (["rpict", "@none.opt"], "none.opt: No such file"),
        (["rpict", "$NO_SUCH_VARIABLE"], "there is no environment variable NO_SUCH_VARIABLE"),
        (["rpict", "@loop.opt"], "names itself, directly or through others"),
        (["rpict", "-x", "0", "room.oct"], "a picture needs at least one pixel each way"),
        (["rpict", "-vth", "-vh", "200", "room.oct"], "the view cannot be used"),
        (["rtrace"], "rtrace: missing octree argument"),
        (["rtrace", "-fz", "room.oct"], "command line error at '-fz'"),
        (["rtrace", "-fac", "-oL", "room.oct"], "-fc: expected -ov, -or or -ox"),
        (["rtrace", "-ff", "-os", "room.oct"], "-os: names are text; expected -fa"),
        (["oconv"], "oconv: no scene"),
        (["oconv", "none.rad"], "none.rad: cannot open scene file"),
        (["oconv", "!nosuch 1"], 'the command "nosuch" is not run'),
        (["vwrays", "-c", "0"], "expected 1 or more of each"),
        (["vwrays", "room.rad"], "room.rad: bad header"),
        (["evalglare", "room.rad"], "room.rad"),
        (["nosuchprogram"], "nosuchprogram: Sunpeak does oconv, rpict"),
    ],
)
def test_mistakes_are_said_in_a_line(command: list[str], says: str, room: Path) -> None:
    (room / "loop.opt").write_text("-w- @loop.opt")
    if command[0] == "nosuchprogram":
        done = subprocess.run(
            [sys.executable, "-m", "sunpeak", "compat", *command], capture_output=True, text=True, check=False
        )
        assert done.returncode == 1
        assert says in done.stderr
        return
    # As Radiance's programs: 2 where the system refuses a file.
    is_system = "No such file" in says or "cannot open" in says
    program(*command, folder=room, data=b"1 1 1 0 0 1\n", expect=2 if is_system else 1, says=says)


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (["rtrace", "-ort", "room.oct"], "-ort: 't' asks for the tree of rays, which random paths have not"),
        (["rtrace", "-pXYZ", "room.oct"], "-pXYZ: Sunpeak's colours are Radiance's RGB alone"),
        (["rpict", "-cs", "18", "-co+", "room.oct"], "-co+: Sunpeak's colours are Radiance's RGB alone"),
        (["evalglare", "-I", "1", "2", "3", "x.hdr"], "-I: Sunpeak's evalglare does not do this"),
    ],
)
def test_what_only_radiance_does_is_said_where_it_is_missing(
    command: list[str], says: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(radiance, "find_program", lambda name: None)
    assert run_program(command) == 1
    assert capsys.readouterr().err == f"{command[0]}: {says} (Radiance's {command[0]} does, and is not on PATH)\n"


def test_rays_that_are_none_and_numbers_that_are_none(room: Path) -> None:
    rays = b"2 2 1 0 0 1\n2 2 1 0 0 0\n2 2 1 0 1 0 5 5\n"
    lines = program("rtrace", "-h", "-w-", "-oodL", "room.oct", folder=room, data=rays).decode().splitlines()
    assert len(lines) == 3
    assert [float(word) for word in lines[1].split()] == [2, 2, 1, 0, 0, 0, 1e10]
    says = "standard input:2: expected a number, found 'x'"
    program("rtrace", "room.oct", folder=room, data=b"1 2 3\n4 x 6\n", expect=1, says=says)


def test_what_has_no_meaning_is_named_once(room: Path) -> None:
    says = "rtrace: warning - accepted, without meaning in Sunpeak: -aa -dv -as\n"
    program("rtrace", "-aa", ".1", "-dv-", "-as", "3", "-aa", "0", "room.oct", folder=room, says=says)


def test_a_sequence_and_depths(room: Path) -> None:
    (room / "fast.opt").write_text("-x 6 -y 4 -pa 0 --samples 2 -ab 0 -w-")
    views = b"rvu -vp 2 2 1 -vd 0 1 0\n\n-vp 2 2 1 -vd 1 0 0\n"
    arguments = ["-S", "7", "-o", "f%02d.hdr", "-z", "f%02d.z", "@fast.opt", "room.oct"]
    assert program("rpict", *arguments, folder=room, data=views) == b""
    first, second = (sp.Picture.load(room / f"f0{number}.hdr") for number in (7, 8))
    assert first.shape == second.shape == (4, 6)
    assert second.view is not None
    assert second.view.direction.tolist() == [1, 0, 0]
    depth = np.fromfile(room / "f07.z", dtype=np.float32).reshape(4, 6)
    assert depth.min() == pytest.approx(3.0, rel=0.02)
    rays = program("vwrays", "-ff", "f07.hdr", "f07.z", folder=room)
    places = np.frombuffer(rays, dtype=np.float32).reshape(-1, 6)
    # What is seen lies on the walls of the room; the way back ends at the eye.
    assert np.allclose(places[:, :3] + places[:, 3:], [2, 2, 1], atol=1e-5)
    assert np.allclose(places[:, 1], 5, atol=1e-4)


def test_irradiance_of_what_is_seen(room: Path) -> None:
    rays = b"2 2.5 1.5 0 0 -1\n2 2.5 1.5 0 0 1\n"
    arguments = ["-h", "-w-", "-ab", "0", "--samples", "4096", "room.oct"]
    floor, lamp = program("rtrace", "-i", *arguments, folder=room, data=rays).decode().splitlines()
    sensor = program("rtrace", "-I", *arguments, folder=room, data=b"2 2.5 0 0 0 1\n").split()
    assert float(floor.split()[0]) == pytest.approx(float(sensor[0]), rel=0.01)
    # A lamp shines; it is not lit.
    assert float(lamp.split()[0]) == 10


def test_the_colours_of_a_picture_are_radiances() -> None:
    colours = np.array([[1.0, 0.5, 0.25], [0.0, 0.0, 0.0], [1000.0, 1.0, 0.0], [1e-3, 2e-3, 0.0]])
    data = np.frombuffer(numbers.rgbe(colours), dtype=np.uint8).reshape(-1, 4)
    assert data[0].tolist() == [128, 64, 32, 129]
    assert data[1].tolist() == [0, 0, 0, 0]
    back = np.ldexp((data[:, :3] + 0.5) / 256, data[:, 3:].astype(int) - 128)
    assert np.abs(back - colours)[[0, 2, 3]].max(axis=1) == pytest.approx(0, abs=1000 / 256)


def test_quality_follows_the_directions() -> None:
    def line(text: str) -> options.CommandLine:
        return options.parse(text.split(), options.Table(values=quality.RENDER_VALUES))

    fine, coarse = (quality.sensors(line(f"-ad {ad}"), 1024) for ad in (4096, 64))
    assert fine.error is not None
    assert coarse.error is not None
    assert coarse.error / fine.error == pytest.approx(8)
    assert (fine.samples, coarse.samples) == (65536, 1024)
    own = quality.picture(line("-ad 64 --samples 5 --seed 3 -ab 2 -av .1 .2 .3 -n 2"), 512)
    assert (own.samples, own.error, own.seed, own.max_bounces, own.threads) == (5, None, 3, 2, 2)
    assert own.ambient == (0.1, 0.2, 0.3)


def test_headers_are_read_and_changed(room: Path) -> None:
    text = b"#?RADIANCE\nA=1\nFORMAT=ascii\n\n1 2\n"
    changed = program("getinfo", "-a", "B=2", folder=room, data=text)
    assert changed == b"#?RADIANCE\nA=1\nB=2\nFORMAT=ascii\n\n1 2\n"
    assert program("getinfo", "-r", "A=3", folder=room, data=text) == text.replace(b"A=1", b"A=3")
    assert program("getinfo", "-", folder=room, data=text) == b"1 2\n"
    assert program("getinfo", "-c", "tr", "1", "7", folder=room, data=text).endswith(b"tr 1 7\n\n7 2\n")
    cube = program("getinfo", "-d", "none", "room.oct", folder=room, says="none: cannot open")
    # 4 m by 5 m by 3 m, in the middle of the cube that oconv lays around it.
    assert cube == b"room.oct: -0.50001 -1e-05 -1.00001 5.00002\n"


def test_scene_check_lists_all_mistakes(tmp_path: Path, sunpeak: CommandLine) -> None:
    (tmp_path / "bad.rad").write_text(
        "void plastic white 0 0 5 .5 .5 .5 0\nvoid plastik grey 0 0 5 .5 .5 .5 0 0\n"
        "void glass pane 0 0 2 1 1\npane sphere s 0 0 4 0 0 0 1\nnone sphere t 0 0 4 0 0 0 1\n"
        "void aBSDF cloth 5 none.xml 0 0 1 . 0 0\ncloth sphere u 0 0 4 0 0 0 1\n"
    )
    answer = sunpeak("scene", "check", "bad.rad", folder=tmp_path, expect=1)
    lines = [line for line in answer.out.splitlines() if line.startswith("error: ")]
    expected = ["bad.rad:2:1", "bad.rad:2:6", "bad.rad:3:1", "bad.rad:5:1", "bad.rad:6:1"]
    assert sorted(line.split()[1].rstrip(":") for line in lines) == expected
    (tmp_path / "functions.rad").write_text(
        "void brightfunc p 2 stripes nothere.cal 0 0\np plastic m 0 0 5 .5 .5 .5 0 0\nm sphere s 0 0 4 0 0 0 1\n"
        "void colorfunc q 4 1 wrong(Px) 1 wrong.cal 0 0\nq plastic n 0 0 5 .5 .5 .5 0 0\nn sphere t 0 0 4 0 0 0 1\n"
    )
    (tmp_path / "wrong.cal").write_text("right(x) = x;\nwrong(x) = x + ;\n")
    answer = sunpeak("scene", "check", "functions.rad", folder=tmp_path, expect=1)
    missing, wrong = [line for line in answer.out.splitlines() if line.startswith("error: ")]
    assert missing.startswith(
        'error: functions.rad:1:1: brightfunc "p": function file: cannot find the file "nothere.cal"'
    )
    assert "looked for nothere.cal" in missing
    assert "functions.rad:4:1: colorfunc" in wrong
    assert "wrong.cal:2:16: expected" in wrong
    (tmp_path / "good.rad").write_text(ROOM + "void plastic spare 0 0 5 .5 .5 .5 0 0\n")
    answer = sunpeak("scene", "check", "good.rad", "--json", folder=tmp_path)
    assert '"errors": []' in answer.out
    assert 'nothing uses plastic \\"spare\\"' in answer.out
