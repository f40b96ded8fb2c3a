"""Scripts written for Radiance, run with only their PATH changed, against the same run on Radiance."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from honeybee_radiance_command.evalglare import Evalglare
from honeybee_radiance_command.oconv import Oconv
from honeybee_radiance_command.rcalc import Rcalc
from honeybee_radiance_command.rpict import Rpict
from honeybee_radiance_command.rtrace import Rtrace

import sunpeak as sp
from conftest import ROOT, Radiance
from sunpeak.compat.install import install

Floats = npt.NDArray[np.float64]

SKY = """
skyfunc glow sky_glow 0 0 4 1 1 1 0
sky_glow source sky 0 0 4 0 0 1 180
skyfunc glow ground_glow 0 0 4 1 .8 .5 0
ground_glow source ground 0 0 4 0 0 -1 180
"""
EYE = "rvu -vta -vp 1.8 3.2 1.2 -vd 0 -1 0 -vu 0 0 1 -vh 180 -vv 180\n"
SENSORS = "\n".join(f"{x} {y} 0.8 0 0 1" for y in (1.0, 1.8, 2.6) for x in (0.6, 3.0)) + "\n"

# Neither ambient cache nor truncation.
WHOLE = "-ab 2 -aa 0 -as 0 -lr -12 -lw 1e-8 -st 0 -ds .05 -dj .7"

TUTORIAL = """
set -e
# The sky: a clear one in June, with the sun.
{ gensky 6 21 14 +s -a 40 -o 105 -m 105; cat glows.rad; } > sky.rad
oconv sky.rad room.rad > room.oct
oconv -f -i room.oct > frozen.oct
getinfo room.oct > room.info
# A picture, by options in a file and by others, and a smaller one of it.
echo '-ab 2 -aa .1 -ar 128 -ad 256 -as 64' > fine.opt
rpict @fine.opt -ps 1 -t 30 -vf eye.vf -x 80 -y 80 room.oct > room.hdr
pfilt -1 -x /2 -y /2 room.hdr > small.hdr
getinfo -d room.hdr small.hdr > sizes
# Sensors: illuminance.
rtrace -I -h $FINE -w- room.oct < sensors.pts | rcalc -e '$1=179*(.265*$1+.670*$2+.065*$3)' > lux
rtrace -w- -I -ab 0 -faf -h -x 1 frozen.oct < sensors.pts > direct.flt
# The same picture by rays, and what each of them meets.
vwrays -ff -vf eye.vf -x 32 -y 32 > rays.flt
rtrace -w- -fff `vwrays -d -vf eye.vf -x 32 -y 32` -ab 0 -oLn room.oct < rays.flt > met.flt
vwrays -fd -vf eye.vf -x 24 -y 24 |
    rtrace -w- $(vwrays -d -vf eye.vf -x 24 -y 24) -fdc -ab 1 -ad 512 room.oct > rays.hdr
# Glare.
evalglare room.hdr > dgp 2> evalglare.err
evalglare -d room.hdr | tail -1 > dgp.long
"""


@dataclass(frozen=True)
class Programs:
    """Folders for the front of PATH."""

    path: str
    library: Path
    directions: int
    """Of sensors. At 16384, which do for ours, Radiance's dark ones scatter by a percent, anew in every run."""

    @property
    def fine(self) -> str:
        """Options of sensors that both agree with to a percent."""
        return f"{WHOLE} -ad {self.directions}"

    def run(self, script: str, folder: Path) -> None:
        """Run a shell script."""
        path, library = f"{self.path}:{os.environ['PATH']}", f".:{self.library}"
        env = os.environ | {"PATH": path, "RAYPATH": library, "FINE": self.fine}
        done = subprocess.run(
            ["bash", "-o", "pipefail", "-c", script], cwd=folder, env=env, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def both(radiance: Radiance, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Programs]:
    """Radiance's programs, and ours before them."""
    ours = tmp_path_factory.mktemp("programs")
    install(ours)
    return {
        "radiance": Programs(str(radiance.programs), radiance.library, 262144),
        "sunpeak": Programs(f"{ours}:{radiance.programs}", radiance.library, 16384),
    }


def study(folder: Path) -> Path:
    """A folder with the files of a small office."""
    folder.mkdir()
    (folder / "room.rad").write_bytes((ROOT / "examples/office/room.rad").read_bytes())
    (folder / "glows.rad").write_text(SKY)
    (folder / "eye.vf").write_text(EYE)
    (folder / "sensors.pts").write_text(SENSORS)
    return folder


@pytest.fixture(scope="module")
def tutorial(both: dict[str, Programs], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """What the script leaves behind, with each of them."""
    root = tmp_path_factory.mktemp("tutorial")
    folders = {name: study(root / name) for name in both}
    for name, programs in both.items():
        programs.run(TUTORIAL, folders[name])
    return folders


def near(ours: Floats, theirs: Floats, tolerance: float) -> None:
    """Means agree, relative to the largest."""
    assert ours.shape == theirs.shape
    assert np.abs(ours - theirs).max() <= tolerance * np.abs(theirs).max(), (ours, theirs)


def test_illuminances_agree(tutorial: dict[str, Path]) -> None:
    lux = {name: np.loadtxt(folder / "lux") for name, folder in tutorial.items()}
    assert lux["radiance"].min() > 100
    assert np.abs(lux["sunpeak"] / lux["radiance"] - 1).max() < 0.02
    direct = {name: np.fromfile(folder / "direct.flt", dtype=np.float32) for name, folder in tutorial.items()}
    near(direct["sunpeak"], direct["radiance"], 0.005)


def test_depths_and_normals_agree(tutorial: dict[str, Path]) -> None:
    ours, theirs = (rows_of(tutorial[n] / "met.flt") for n in ("sunpeak", "radiance"))
    same = np.isclose(ours[:, 0], theirs[:, 0], rtol=1e-4)
    assert same.mean() > 0.995
    # Radiance turns the normals of flat surfaces to the ray.
    normals = np.abs((ours[same, 1:] * theirs[same, 1:]).sum(axis=1))
    met = theirs[same, 0] < 1e9
    assert np.abs(normals[met] - 1).max() < 1e-5


def rows_of(path: Path) -> Floats:
    """Rows of four floats after a header and a resolution line."""
    data = path.read_bytes()
    body = data[data.index(b"\n\n") + 2 :]
    assert b"NCOMP=4" in data
    assert b"FORMAT=float" in data
    resolution, values = body.split(b"\n", 1)
    assert resolution.split() == [b"-Y", b"32", b"+X", b"32"]
    return np.frombuffer(values, dtype=np.float32).reshape(-1, 4).astype(np.float64)


def test_the_rays_of_a_view_are_the_same_to_the_last_bit(tutorial: dict[str, Path]) -> None:
    assert (tutorial["sunpeak"] / "rays.flt").read_bytes() == (tutorial["radiance"] / "rays.flt").read_bytes()


def test_pictures_agree(tutorial: dict[str, Path]) -> None:
    ours, theirs = (sp.Picture.load(tutorial[n] / "room.hdr") for n in ("sunpeak", "radiance"))
    assert ours.shape == theirs.shape == (80, 80)
    assert str(ours.view) == str(theirs.view)
    # Blocks without those that the sun's disc touches.
    means = [p.luminance().reshape(10, 8, 10, 8).mean(axis=(1, 3)) for p in (ours, theirs)]
    calm = means[1] < 20_000
    assert calm.mean() > 0.97
    assert abs(means[0][calm].sum() / means[1][calm].sum() - 1) < 0.03
    traced = [sp.Picture.load(tutorial[n] / "rays.hdr").pixels for n in ("sunpeak", "radiance")]
    dim = traced[1].max(axis=2) < 100
    assert abs(traced[0][dim].sum() / traced[1][dim].sum() - 1) < 0.03


def test_other_programs_read_our_pictures(tutorial: dict[str, Path]) -> None:
    sizes = {name: (folder / "sizes").read_text().split() for name, folder in tutorial.items()}
    assert sizes["sunpeak"] == sizes["radiance"]
    small = sp.Picture.load(tutorial["sunpeak"] / "small.hdr")
    assert small.shape == (40, 40)
    assert any(line.lstrip().startswith("oconv sky.rad room.rad") for line in small.header)
    assert any(line.startswith("SOFTWARE= Sunpeak") for line in small.header)


def test_glare_agrees(tutorial: dict[str, Path]) -> None:
    short = {name: (folder / "dgp").read_text().split() for name, folder in tutorial.items()}
    assert short["sunpeak"][0] == short["radiance"][0]
    assert abs(float(short["sunpeak"][1]) - float(short["radiance"][1])) < 0.01
    long = {name: (folder / "dgp.long").read_text().split() for name, folder in tutorial.items()}
    assert long["sunpeak"][0] == long["radiance"][0]
    assert len(long["sunpeak"]) == len(long["radiance"])
    ev = {name: float(words[3]) for name, words in long.items()}
    assert abs(ev["sunpeak"] / ev["radiance"] - 1) < 0.02


def test_headers_and_names_are_radiances(tutorial: dict[str, Path]) -> None:
    ours, theirs = ((tutorial[n] / "room.info").read_text() for n in ("sunpeak", "radiance"))
    assert ours.replace("Sunpeak_octree", "Radiance_octree") == theirs


def test_a_study_by_honeybee_agrees(both: dict[str, Programs], tmp_path: Path) -> None:
    lux, dgp, ev = {}, {}, {}
    for name, programs in both.items():
        folder = study(tmp_path / name)
        programs.run("{ gensky 3 21 12 +s -a 40 -o 105 -m 105; cat glows.rad; } > sky.rad", folder)
        env = {"PATH": programs.path, "RAYPATH": f".:{programs.library}"}
        oconv = Oconv(inputs=["sky.rad", "room.rad"], output="room.oct")
        oconv.options.f = True
        oconv.run(env, cwd=str(folder))
        rtrace = Rtrace(octree="room.oct", sensors="sensors.pts")
        rtrace.options.update_from_string(f"-I -h {programs.fine} -w-")
        rtrace.pipe_to = Rcalc(output="grid.res")
        rtrace.pipe_to.options.e = "$1=179*(.265*$1+.670*$2+.065*$3)"
        rtrace.run(env, cwd=str(folder))
        rpict = Rpict(octree="room.oct", output="eye.hdr", view="eye.vf")
        rpict.options.update_from_string("-ab 2 -aa .1 -ad 256 -as 64 -ps 1 -x 80 -y 80 -w-")
        rpict.run(env, cwd=str(folder))
        glare = Evalglare(input="eye.hdr", output="eye.dgp")
        glare.options.d = True
        glare.run(env, cwd=str(folder))
        lux[name] = np.loadtxt(folder / "grid.res")
        words = (folder / "eye.dgp").read_text().splitlines()[-1].split()
        dgp[name], ev[name] = float(words[1]), float(words[3])
    assert np.abs(lux["sunpeak"] / lux["radiance"] - 1).max() < 0.02
    assert abs(dgp["sunpeak"] - dgp["radiance"]) < 0.01
    assert abs(ev["sunpeak"] / ev["radiance"] - 1) < 0.02


def test_a_program_that_we_lack_is_radiances(both: dict[str, Programs], tmp_path: Path) -> None:
    command = [sys.executable, "-m", "sunpeak", "compat", "xform", "-t", "0", "0", "1"]
    env = os.environ | {"PATH": f"{both['radiance'].path}:{os.environ['PATH']}"}
    text = "void sphere s 0 0 4 0 0 0 1\n"
    done = subprocess.run(command, input=text, env=env, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split()[-4:] == ["0", "0", "1", "1"]


def test_what_ours_do_not_do_is_left_to_radiances(both: dict[str, Programs], tmp_path: Path) -> None:
    """The tree of rays, XYZ, spectra; octrees that name files, and frozen ones, whose patterns lie beside them."""
    (tmp_path / "half.cal").write_text("half = .5;\n")
    scene = "void brightfunc p 2 half half.cal 0 0\np glass pane 0 0 3 .9 .9 .9\n" + MIRRORS
    (tmp_path / "scene.rad").write_text(scene + "pane polygon window 0 0 12 4 0 1 6 0 1 6 1 1 4 1 1\n")
    (tmp_path / "rays").write_text("4.5 .5 3 0 .1 -1\n6.5 .5 3 .05 0 -1\n")
    lines = [
        "oconv scene.rad > scene.oct",
        "oconv -f - < scene.rad > frozen.oct",
        "rtrace -h -w- -ab 0 -oTdwv~ scene.oct < rays > tree",
        "rtrace -h -w- -ab 0 -otLm frozen.oct < rays >> tree",
        "rtrace -h -w- -ab 0 -pXYZ scene.oct < rays > xyz",
        "rtrace -h -w- -ab 0 -cs 6 -co+ scene.oct < rays > spectra",
        "rpict -w- -ps 1 -pj 0 -pXYZ -x 4 -y 4 -vp 4.5 .5 3 -vd 0 0 -1 -vu 0 1 0 scene.oct | getinfo - > picture",
    ]
    for name, programs in both.items():
        folder = tmp_path / name
        folder.mkdir()
        for file in ("half.cal", "scene.rad", "rays"):
            (folder / file).write_bytes((tmp_path / file).read_bytes())
        programs.run("\n".join(lines), folder)
    for file in ("tree", "xyz", "spectra", "picture"):
        ours, theirs = ((tmp_path / name / file).read_bytes() for name in ("sunpeak", "radiance"))
        assert ours == theirs, file
    assert b"\n\t" in (tmp_path / "sunpeak/tree").read_bytes()


def test_vwrays_writes_what_radiances_does(tutorial: dict[str, Path], both: dict[str, Programs]) -> None:
    lines = [
        "-vta -vh 180 -vv 180 -x 7 -y 7",
        "-vth -vh 180 -vv 180 -vs .25 -x 9 -y 9",
        "-vts -vh 200 -vv 200 -x 7 -y 5 -pa 0",
        "-vtc -vh 200 -vv 60 -x 6 -y 5",
        "-vtl -vh 3 -vv 2 -x 6 -y 6 -vo 1",
        "-va 10 -vo 2 -x 5 -y 4 -c 2",
        "-x 100 -y 40 -d -vh 40 -vv 40",
        "-x 100 -y 40 -pa 0 -d -va 3",
        "turned.hdr",
        "eye.hdr eye.z",
        "-d eye.hdr",
        "-i -x 8 -y 8 -vf eye.vf < places",
    ]
    folder = tutorial["radiance"]
    both["radiance"].run(
        "rpict -w- -vf eye.vf -x 12 -y 12 -z eye.z room.oct > eye.hdr; pflip -h eye.hdr > turned.hdr; "
        "echo '1 2 3.5 7 0 0' > places",
        folder,
    )
    for name, programs in both.items():
        programs.run("\n".join(f"(vwrays {line})" for line in lines).join(("{ ", "; }")) + f" > {name}.rays", folder)
    assert (folder / "sunpeak.rays").read_text() == (folder / "radiance.rays").read_text()


@pytest.mark.parametrize("options", ["-d", "-D -b 5", "-t 300 200 .6", "-i 3000", "-d -b 1000000"])
def test_evalglare_prints_what_evalglare_does(
    options: str, shared: Path, both: dict[str, Programs], tmp_path: Path
) -> None:
    picture = shared / "hdr/evalglare-testimage.hdr"
    answers = {}
    for name, programs in both.items():
        programs.run(f"evalglare {options} {picture} > {name}", tmp_path)
        answers[name] = (tmp_path / name).read_text().splitlines()
    assert len(answers["sunpeak"]) == len(answers["radiance"])
    assert [line.split()[0] for line in answers["sunpeak"]] == [line.split()[0] for line in answers["radiance"]]
    ours, theirs = (answers[name][-1].split(":")[1].split() for name in ("sunpeak", "radiance"))
    keys = answers["radiance"][-1].split(":")[0].split(",")
    assert answers["sunpeak"][-1].split(":")[0].split(",") == keys
    for key, mine, other in zip(keys, ours, theirs, strict=True):
        if key == "dgp":
            assert abs(float(mine) - float(other)) < 0.002
        elif key == "vcp":
            assert abs(float(mine) - float(other)) < 1
        else:
            assert float(mine) == pytest.approx(float(other), rel=0.01), key


MIRRORS = """
void plastic polished 0 0 5 .5 .5 .5 .1 0
void plastic matt 0 0 5 .5 .4 .3 0 0
void glass pane 0 0 3 .9 .9 .9
void mirror mirror 0 0 3 .9 .9 .9
void metal chrome 0 0 5 .8 .8 .8 1 0
void light bright 0 0 3 5 5 5
void colorfunc sides 4 1+Dx 1+Dy 2+Dz . 0 0
sides glow around 0 0 4 1 1 1 0
around source sky 0 0 4 0 0 1 180
matt polygon floor 0 0 12 -50 -50 -2 50 -50 -2 50 50 -2 -50 50 -2
polished polygon a 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0
pane polygon b 0 0 12 2 0 0 3 0 0 3 1 0 2 1 0
mirror polygon c 0 0 12 4 0 0 5 0 0 5 1 0 4 1 0
chrome sphere d 0 0 4 6.5 .5 -.5 .5
bright polygon e 0 0 12 8 0 0 9 0 0 9 1 0 8 1 0
matt polygon ceiling 0 0 12 -50 -50 20 -50 50 20 50 50 20 50 -50 20
"""


def test_what_comes_by_mirrors_and_the_rest(both: dict[str, Programs], tmp_path: Path) -> None:
    """Fields `l R X r x`, at distances to the ceiling that mirrors show, to the floor behind glass, and none."""
    (tmp_path / "scene.rad").write_text(MIRRORS)
    rays = [f"{x} .5 3 {dx} .1 -1" for x in (0.5, 2.5, 4.5, 6.5, 8.5, 12) for dx in (0, 0.05)]
    (tmp_path / "rays").write_text("\n".join([*rays, "0 0 30 0 0 1"]) + "\n")
    script = "oconv scene.rad > scene.oct; rtrace -h -w- -ab 0 -av .3 .3 .3 -olRXLrxv scene.oct < rays"
    answers = {}
    for name, programs in both.items():
        programs.run(f"{script} > {name}", tmp_path)
        answers[name] = np.loadtxt(tmp_path / name)
    ours, theirs = answers["sunpeak"], answers["radiance"]
    assert ours[:, :4] == pytest.approx(theirs[:, :4], rel=1e-4)
    assert ours[:, 4:] == pytest.approx(theirs[:, 4:], rel=0.02, abs=0.01)


FIELDS = """
void plastic red 0 0 5 .5 .1 .1 0 0
void texfunc waves 6 .1*sin(9*Px) .05 .1*Py . -rz 30 0 0
waves plastic wavy 0 0 5 .5 .5 .5 0 0
void glass pane 0 0 3 .8 .8 .8
waves dielectric block 0 0 5 .9 .9 .9 1.5 0
void glow shine 0 0 4 1 2 3 0
void glow night 0 0 4 .001 .001 .001 0
red mesh smooth 5 smooth.rtm -t 0 0 1 0 0
red polygon p0 0 0 12 2 0 0 3 0 0 3 1 0 2 1 0
wavy polygon p1 0 0 12 4 0 0 5 0 0 5 1 0 4 1 0
pane polygon p2 0 0 12 6 0 0 7 0 0 7 1 0 6 1 0
block sphere p3 0 0 4 8.5 .5 0 .5
shine polygon p4 0 0 12 10 0 0 11 0 0 11 1 0 10 1 0
wavy bubble p5 0 0 4 12.5 .5 0 .5
night source sky 0 0 4 0 .1 1 120
"""
SMOOTH = """
v 0 0 0\nv 1 0 0\nv 0 1 0\nvn .2 .1 1\nvn -.3 0 1\nvn 0 .4 1\nvt .1 .2\nvt .9 .3\nvt .2 .8
usemtl red\nf 1/1/1 2/2/2 3/3/3
"""


@pytest.mark.parametrize("form", ["a", "f", "d"])
def test_every_field_of_rtrace(form: str, both: dict[str, Programs], tmp_path: Path) -> None:
    """All letters of `-o` but `W` in each format: normals of both sides, local coordinates, names."""
    (tmp_path / "scene.rad").write_text(FIELDS)
    (tmp_path / "smooth.obj").write_text(SMOOTH)
    rays = [f"{x + 0.3} .4 {3 * side} 0 .02 {-side}" for x in (0, 2, 4, 6, 8, 10, 12, 14) for side in (1, -1)]
    kind = {"a": np.float64, "f": np.float32, "d": np.float64}[form]
    data = np.array([ray.split() for ray in rays], dtype=kind)
    (tmp_path / "rays").write_bytes(("\n".join(rays) + "\n").encode() if form == "a" else data.tobytes())
    words = ["odvVrRxXlLcpnNw", *(["soLmM~v"] if form == "a" else [])]
    lines = ["obj2mesh smooth.obj smooth.rtm", "oconv -w scene.rad > scene.oct"]
    lines += [f"rtrace -w- -h -ab 0 -f{form}{form} -o{word} scene.oct < rays > $OUT.{word}" for word in words]
    for name, programs in both.items():
        programs.run("\n".join([f"OUT={name}", *lines]), tmp_path)
    for word in words:
        ours, theirs = (tmp_path / f"{name}.{word}" for name in ("sunpeak", "radiance"))
        if form != "a":
            mine, other = (np.fromfile(file, dtype=kind) for file in (ours, theirs))
            assert mine.shape == other.shape, word
            assert mine == pytest.approx(other, rel=1e-4, abs=1e-5), word
            continue
        columns = [[line.split() for line in file.read_text().splitlines()] for file in (ours, theirs)]
        assert len(columns[0]) == len(columns[1]) == len(rays)
        for ray, mine, other in zip(rays, *columns, strict=True):
            pairs = list(zip(mine, other, strict=True))
            assert all(same(*pair) for pair in pairs), (word, ray, pairs)


def same(mine: str, other: str) -> bool:
    """Whether two words are the same number, nearly, or the same name."""
    try:
        return bool(np.isclose(float(mine), float(other), rtol=1e-4, atol=1e-5))
    except ValueError:
        return mine == other


RIF = """
# An office in June.
OCTREE= office.oct
materials= glows.rad
scene= "!gensky 6 21 14 +s -a 40 -o 105 -m 105" sky.rad
scene= room.rad
ZONE= I 0 3.6 0 4 0 2.8
QUAL= Med
RES= 48
AMB= office.amb
IND= 1
view= back -vta -vp 1.8 3.2 1.2 -vd 0 -1 0 -vh 180 -vv 180
view= up -vf eye.vf -vd 0 -1 .4
"""


def test_rad_runs_on_our_programs_and_its_file_is_a_scene(both: dict[str, Programs], tmp_path: Path) -> None:
    means = {}
    for name, programs in both.items():
        folder = study(tmp_path / name)
        (folder / "glows.rad").write_text("void glow sky_glow 0 0 4 1 1 1 0\n")
        (folder / "sky.rad").write_text("skyfunc alias lit sky_glow\nlit source sky 0 0 4 0 0 1 180\n")
        (folder / "office.rif").write_text(RIF)
        programs.run("rad -s -w -v up office.rif", folder)
        means[name] = calm_mean(folder / "office_up.hdr")
    assert means["sunpeak"] == pytest.approx(means["radiance"], rel=0.06)
    command = [sys.executable, "-m", "sunpeak", "render", "office.rif", "-v", "up", "-o", "ours.hdr"]
    options = ["--size", "48x48", "--samples", "4", "-q"]
    subprocess.run([*command, *options], cwd=tmp_path / "sunpeak", check=True)
    views = [str(sp.View.load(tmp_path / "sunpeak" / name)) for name in ("ours.hdr", "office_up.hdr")]
    assert views[0] == views[1]


def calm_mean(picture: Path) -> float:
    """Mean luminance [cd/m²] of what is not the sun."""
    luminance = sp.Picture.load(picture).luminance()
    return float(luminance[luminance < 20_000].mean())
