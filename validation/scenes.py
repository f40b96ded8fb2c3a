"""Every scene of the collection against converged runs of Radiance: what loads, and how far the pictures differ.

usage: python validation/scenes.py [--only NAME ...] [--oversampled N] [--paths N] [--runs N] [--samples N]

Each scene is rendered at 64 x 64 by both programs with the same number of bounces. Radiance runs without its cache and
without any truncation, so that its mean is unbiased; block means of 8 x 8 pixels are compared. Results go to
`scenes.json` beside this file; `scenes.md` says what they mean. Files that the collection lacks are made here, so that
both programs read the same ones.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import astuple, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
import pyradiance

import sunpeak as sp

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[0] / "tests")]

from scene_stand_ins import make_stand_ins, slats_table  # noqa: E402

from conftest import SHARED, Radiance  # noqa: E402

Floats = npt.NDArray[np.float64]

SIZE, BLOCK = 64, 8
RESULTS = HERE / "scenes.json"
BEGIN, END = "<!-- made by scenes.py -->", "<!-- end -->"
MEAN_TOLERANCE, BLOCK_TOLERANCE = 0.03, 0.05

REFERENCE = (
    *("-ps", "1", "-pt", "0", "-pj", "1", "-pa", "0", "-u+", "-aa", "0", "-as", "0", "-lr", "-20", "-lw", "1e-7"),
    *("-st", "0", "-dj", "1", "-ds", "0.05", "-dt", "0", "-dc", "1", "-dr", "2", "-ms", "0.1"),
)

CLEAR_SKY = "!gendaylit 3 21 10 -a 40 -o -10 -m -15 -W 500 150\n" + (
    "skyfunc glow skyglow 0 0 4 1 1 1 0\nskyglow source sky 0 0 4 0 0 1 180\n"
    "skyfunc glow groundglow 0 0 4 1 .9 .8 0\ngroundglow source ground 0 0 4 0 0 -1 180\n"
)


@dataclass(frozen=True)
class Case:
    """A scene, as somebody would call it from inside its folder."""

    name: str
    folder: str
    files: tuple[str, ...]
    view: str
    bounces: int = 2
    sky: str = ""
    changes: tuple[tuple[str, str, str], ...] = ()
    """File, text in it, and what stands there instead: the scene without what the programs treat differently."""


def rif(name: str, view: str, *files: str, bounces: int = 1) -> Case:
    """One of the small scenes of `radiance-renders`, with the files that its .rif names."""
    view = f"-vf {view}" if view.endswith(".vf") else view
    return Case(name, "radiance-renders", files, view, bounces)


WALLS = ("basic.mat", "diorama_walls.rad")
FRADS_PARTS = ("materials.mat", "walls.rad", "ceiling.rad", "floor.rad", "windowframe.rad", "extwalls.rad")
FRADS = tuple(f"Objects/{part}" for part in (*FRADS_PARTS, "ground.rad", "desks.rad"))
TUTORIAL = ("materials.rad", "room.rad")
PROXY = "blinds/blindsWithProxy.rad"
BLINDS_VIEW = "-vf views/eastBlinds.vf"
PRISM_VIEW = "-vts -vp -4.25514 3.89431 1.97742 -vd -0.700687 -1.28443 -0.21925 -vh 140 -vv 140"
DISKS_VIEW = "-vta -vp -0.2 3.07 2.78 -vd -2.64 -0.48 -1.25 -vh 66.6667 -vv 37.5"
MIST_VIEW = "-vp 0.1 3.2 2.8 -vd -2.7336 -0.482008 -1.02483 -vh 45 -vv 45"
COMBINED_VIEW = "-vtv -vp 23.5757 8.58098 5.24274 -vd -12.2856 0.909548 0.48623 -vh 50 -vv 32"
WGMD_VIEW = "-vp -2.60899 4.62728 2.52391 -vd -1.11057 -1.64932 -1.10768 -vh 46.6777 -vv 46.6777"

MESH = (
    *("basic.mat", "chrome.mat", "diorama_walls.rad", "closed_end.rad", "front_cap.rad"),
    "!xform -n plainclothes -s 1.5 -rx 90 -rz -80 -t 1 0 0 -a 9 -rz 40 -i 1 -t -5 2.5 0 ./woman.rad",
    "!xform -m chrome -n shiny -s 1.5 -rx 90 -rz -105 -t 1 0 0 -rz 20 -a 9 -rz 40 -i 1 -t -5 2.5 0 ./woman.rad",
    "rect_fixture.rad",
)
SPECTRA = (
    *("basic.mat", "spectral.mat", "gold.mat", "diorama_walls.rad", "closed_end.rad", "front_cap.rad"),
    *("rect_fixture.rad", "spectral_objs.rad"),
)
MIST = (*WALLS, "closed_end.rad", "gymbal.rad", "mist.rad", "spotlights.rad", "spotcones.rad")
BIG_SUN = "void light sol 0 0 3 2.5e4 2.5e4 2.5e4\nsol source bigsun 0 0 4 -0.9338 -0.35 0.001 1\n"
LAMP_THAT_NOBODY_LOOKS_FOR = (
    "rect_fixture.rad",
    "lum_dist light lum_bright\n0\n0\n3\t20 20 20",
    "lum_dist glow lum_bright\n0\n0\n4\t20 20 20 0",
)

CASES = [
    Case("cornell", "cornell-box", ("cornell.rad",), "-vf cornell.vf", 3),
    Case("cornell_window", "cornell-box", ("cornell_window.rad",), "-vf cornell.vf", 3, CLEAR_SKY),
    Case("frads_view1", "frads-room", (*FRADS, "Resources/ec60.rad"), "-vf Resources/view1.vf", 2, CLEAR_SKY),
    Case("frads_v1a", "frads-room", (*FRADS, "Resources/ec60.rad"), "-vf Resources/v1a.vf", 2, CLEAR_SKY),
    Case("tutorial_glazing", "tutorial-room", (*TUTORIAL, "objects/Glazing.rad"), "-vf views/east.vf", 2, CLEAR_SKY),
    Case(
        "tutorial_grate",
        "tutorial-room",
        (*TUTORIAL, "objects/Glazing.rad", "overhang/aluminiumGrate.rad"),
        "-vf views/east.vf",
        2,
        CLEAR_SKY,
    ),
    Case(
        "tutorial_grate_outside",
        "tutorial-room",
        (*TUTORIAL, "objects/Glazing.rad", "overhang/aluminiumGrate.rad"),
        "-vf views/grateClose.vf",
        2,
        CLEAR_SKY,
    ),
    Case(
        "tutorial_diffuse_glass",
        "tutorial-room",
        (*TUTORIAL, "objects/Glazing.rad", "overhang/diffuseGlass.rad"),
        "-vf views/east.vf",
        2,
        CLEAR_SKY,
    ),
    Case("tutorial_blinds", "tutorial-room", (*TUTORIAL, "blinds/blindsOnly.rad"), BLINDS_VIEW, 2, CLEAR_SKY),
    Case("tutorial_proxy", "tutorial-room", (*TUTORIAL, PROXY), BLINDS_VIEW, 2, CLEAR_SKY),
    # The same without the sun, which Radiance counts twice.
    Case("tutorial_proxy_sky", "tutorial-room", (*TUTORIAL, PROXY), BLINDS_VIEW, 2, CLEAR_SKY.replace(" -W", " -s -W")),
    # All rooms in one; its parts name Radiance's generators and the files that are made here.
    rif("combined", COMBINED_VIEW, "combined_scene.rad"),
    rif("dielectric", "inside.vf", *WALLS, "rect_opening.rad", "front_cap.rad", "vase.rad", "rect_fixture.rad",
        "sunset_sky.rad", "dielectric_pane.rad"),
    rif("glass", "inside.vf", *WALLS, "rect_opening.rad", "front_cap.rad", "torus.rad", "sunset_sky.rad",
        "glass_ill.rad"),
    rif("inst", "inside.vf", *WALLS, "closed_end.rad", "front_cap.rad", "porsches.rad", "spotlights.rad",
        "rect_fixture.rad", "glowbulb.rad"),
    rif("mesh", "inside.vf", *MESH),
    # The same with a lamp that no program looks for, so that both find it by their paths alone, in the chrome as well.
    Case("mesh_glow", "radiance-renders", MESH, "-vf inside.vf", 1, changes=(LAMP_THAT_NOBODY_LOOKS_FOR,)),
    rif("mirror", "fish.vf", *WALLS, "closed_end.rad", "front_cap.rad", "glass_pane.rad", "antimatter_portal.rad",
        "bubble_in_cube.rad", "mirror.rad", "sunset_sky.rad"),
    # Its .rif makes the cap before the camera invisible from behind (-bv-): it is left out.
    rif("mist", MIST_VIEW, *MIST, bounces=0),
    # The same with a fiftieth of the mist, in which light is scattered once at most.
    Case("mist_thin", "radiance-renders", MIST, MIST_VIEW, 0,
         changes=(("mist.rad", "7 .1 .1 .4", "7 .002 .002 .008"),)),
    rif("mixtex", DISKS_VIEW, "basic.mat", "mixtex.mat", "sunset_sky.rad", "glass_pane.rad", "diorama_walls.rad",
        "rect_opening.rad", "front_cap.rad", "disks.rad", "constellation.rad"),
    rif("patterns", DISKS_VIEW, "basic.mat", "patterns.mat", "diorama_walls.rad", "closed_end.rad", "front_cap.rad",
        "disks.rad", "rect_fixture.rad"),
    rif("prism1", PRISM_VIEW, "basic.mat", "gold.mat", "diorama_walls.rad", "rect_opening.rad", "front_cap.rad",
        "!xform -m gold ./vase.rad", "sunset_sky.rad", "prism1.rad"),
    rif("prism2", PRISM_VIEW, "basic.mat", "gold.mat", "diorama_walls.rad", "rect_opening.rad", "front_cap.rad",
        "!xform -m gold ./vase.rad", "sunset_sky.rad", "prism2.rad"),
    rif("spectra", "fish.vf", *SPECTRA),
    Case("spectra_glow", "radiance-renders", SPECTRA, "-vf fish.vf", 1, changes=(LAMP_THAT_NOBODY_LOOKS_FOR,)),
    rif("tfunc", "inside.vf", *WALLS, "rect_opening.rad", "front_cap.rad", "ball_in_cube.rad", "sunset_sky.rad",
        "illum_tfunc.rad"),
    # The same by the sun alone: function materials of Radiance scatter the light of sources, not that of the sky.
    # Without the water, through which rays find a sun by luck.
    Case(
        "tfunc_sun",
        "radiance-renders",
        (*WALLS, "rect_opening.rad", "front_cap.rad", "illum_tfunc.rad"),
        "-vf inside.vf",
        1,
        BIG_SUN,
    ),
    # The same with a dark reveal, so that the sun alone shines on the window.
    Case(
        "tfunc_dark_reveal",
        "radiance-renders",
        (*WALLS, "rect_opening.rad", "front_cap.rad", "illum_tfunc.rad"),
        "-vf inside.vf",
        1,
        BIG_SUN,
        changes=(("rect_opening.rad", "genprism wall_mat", "genprism black_outside"),),
    ),
    rif("trans", "inside.vf", *WALLS, "rect_opening.rad", "front_cap.rad", "ballcompare.rad", "spotlights.rad",
        "rect_fixture.rad", "trans_pane.rad", "sunset_sky.rad"),
    # The same with balls of plastic2 and metal2 in the place of those whose functions say the same model.
    Case(
        "trans_alike",
        "radiance-renders",
        (*WALLS, "rect_opening.rad", "front_cap.rad", "ballcompare.rad", "spotlights.rad", "rect_fixture.rad",
         "trans_pane.rad", "sunset_sky.rad"),
        "-vf inside.vf",
        1,
        changes=(("ballcompare.rad", "plasfunc_mat sphere", "plas2_mat sphere"),
                 ("ballcompare.rad", "metfunc_mat sphere", "met2_mat sphere")),
    ),
    rif("trans2", "inside.vf", *WALLS, "rect_opening.rad", "front_cap.rad", "gymbal.rad", "sunset_sky.rad",
        "illum_trans2.rad"),
    rif("wgmdf", WGMD_VIEW, *WALLS, "closed_end.rad", "front_cap.rad", "ringlight.rad", "gymbal2.rad"),
]  # fmt: skip


class Comparison:
    """One case in a folder of its own."""

    def __init__(self, case: Case, stand_ins: Path, radiance: Radiance) -> None:
        """Copy the scene's folder, and write its sky."""
        self.case, self.radiance = case, radiance
        # A copy, in which a stand-in can lie where a scene names it by its place.
        self.folder = stand_ins / "scenes" / (case.name if case.changes else case.folder)
        is_new = not self.folder.exists()
        if is_new:
            shutil.copytree(SHARED / "data/scenes" / case.folder, self.folder, copy_function=shutil.copyfile)
        for name, old, new in case.changes if is_new else ():
            file = self.folder / name
            if old not in (text := file.read_text()):
                raise ValueError(f"{name}: expected {old!r}")
            file.write_text(text.replace(old, new))
        missing = self.folder / "blinds/blindsT4c.xml"
        if PROXY in case.files and not missing.exists():
            missing.write_bytes(slats_table(self.folder / "blinds/blindsOnly.rad"))
        self.sky = stand_ins / f"{case.name}_sky.rad"
        self.sky.write_text(case.sky)
        self.files = [*case.files, *([str(self.sky)] if case.sky else [])]
        self.octree = stand_ins / f"{case.name}.oct"
        self.path = f"{stand_ins}:.:{self.folder}:{radiance.library}"

    def program(self, *command: object) -> bytes:
        """What a program of Radiance prints."""
        env = os.environ | {"PATH": f"{self.radiance.programs}:{os.environ['PATH']}", "RAYPATH": self.path}
        done = subprocess.run([str(c) for c in command], env=env, cwd=self.folder, capture_output=True, check=False)
        if done.returncode != 0:
            lines = done.stderr.decode().strip().splitlines()
            raise ValueError(next((line for line in lines if "fatal" in line or "system" in line), lines[-1]))
        return done.stdout

    def theirs(self, effort: "Effort") -> list[Floats]:
        """Luminance of pictures by `rpict`; the runs differ in their random numbers only."""
        self.octree.write_bytes(self.program("oconv", "-w", *self.files))
        rays = effort.oversampled
        side = SIZE * rays
        size = ("-x", str(side), "-y", str(side))
        options = (*self.case.view.split(), *REFERENCE, *size, "-ab", str(self.case.bounces), "-ad", str(effort.paths))
        pictures = []
        for run in range(effort.runs):
            target = self.octree.with_suffix(f".{run}.hdr")
            target.write_bytes(self.program("rpict", "-w", *options, self.octree))
            pictures.append(sp.Picture.load(target).luminance())
        return [p.reshape(SIZE, rays, SIZE, rays).mean(axis=(1, 3)) for p in pictures]

    def ours(self, samples: int, seed: int = 1) -> sp.Picture:
        """The same by Sunpeak."""
        os.chdir(self.folder)
        os.environ["RAYPATH"] = self.path
        # Generators that are not done inside are Radiance's own: the same geometry for both.
        os.environ["PATH"] = f"{self.radiance.programs}:{os.environ['PATH']}"
        try:
            scene = sp.Scene.load(self.files, allow_commands=True)
        except sp.InputError as error:
            if "not done inside" not in str(error):
                raise
            expanded = self.octree.with_suffix(".expanded.rad")
            expanded.write_bytes(b"".join(self.program("xform", "-e", file) for file in self.files))
            scene = sp.Scene.load([expanded])
        view = sp.View.parse(self.view())
        return sp.render(scene, view, size=(SIZE, SIZE), samples=samples, seed=seed, max_bounces=self.case.bounces)

    def view(self) -> str:
        """The options of the view, read from its file if it has one."""
        words = self.case.view.split()
        return str(sp.View.load(self.folder / words[1])) if words[0] == "-vf" else self.case.view


def blocks(picture: Floats) -> Floats:
    """Means of blocks of 8 x 8 pixels."""
    count = SIZE // BLOCK
    return np.nanmean(picture.reshape(count, BLOCK, count, BLOCK), axis=(1, 3))


def without_suns(picture: sp.Picture) -> Floats:
    """Luminance; NaN around suns, which are in ours exactly, and which samples find by luck."""
    luminances = picture.luminance().copy()
    for source in picture.exact_sources:
        x, y = picture.view.project([source.direction])[0]
        column, row = int(x * SIZE), int((1 - y) * SIZE)
        luminances[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2] = np.nan
    return luminances


def relative_rms(a: Floats, b: Floats) -> float:
    """Root mean square difference over the mean of the second."""
    return float(np.sqrt(np.mean((a - b) ** 2)) / np.mean(b))


@dataclass(frozen=True)
class Effort:
    """How much each program works."""

    oversampled: int
    """Radiance's rays across a pixel."""
    paths: int
    """Radiance's `-ad`."""
    runs: int
    """Radiance's pictures that are averaged."""
    samples: int
    """Our paths for each pixel."""


def compare(comparison: Comparison, effort: Effort) -> dict[str, object]:
    """Numbers of one case, or who refuses it and why."""
    case, stand_ins = comparison.case, comparison.octree.parent
    result: dict[str, object] = {"files": list(case.files), "view": case.view, "bounces": case.bounces}
    result["effort"] = list(astuple(effort))
    try:
        started = time.monotonic()
        ours = comparison.ours(effort.samples)
        ours.save(stand_ins / f"{case.name}.ours.hdr")
        mine = without_suns(ours)
        result |= {"ours": blocks(mine).round(4).tolist(), "ours_s": round(time.monotonic() - started, 1)}
    except (sp.InputError, OSError, ValueError) as error:
        # Without the folders of this run.
        result["sunpeak"] = str(error).partition("; looked for")[0]
    try:
        started = time.monotonic()
        pictures = comparison.theirs(effort)
        if "ours" in result:
            pictures = [np.where(np.isnan(mine), np.nan, picture) for picture in pictures]
        theirs = np.mean(pictures, axis=0)
        result |= {"theirs": blocks(theirs).round(4).tolist(), "theirs_s": round(time.monotonic() - started, 1)}
        halves = [blocks(np.mean(pictures[k::2], axis=0)) for k in range(2)] if effort.runs > 1 else []
        result["theirs_noise"] = round(relative_rms(*halves) / 2, 5) if halves else None
    except ValueError as error:
        result["radiance"] = str(error)
    if "ours" in result and "theirs" in result:
        ratio, rmse = float(np.nanmean(mine) / np.nanmean(theirs)), relative_rms(blocks(mine), blocks(theirs))
        within = bool(abs(ratio - 1) <= MEAN_TOLERANCE and rmse <= BLOCK_TOLERANCE)
        result |= {"mean_ratio": round(ratio, 5), "block_rmse": round(rmse, 5), "within": within}
    return result


def table(results: dict[str, dict[str, object]]) -> str:
    """Rows for `scenes.md`."""
    lines = [
        "| scene | mean, ours over theirs | RMSE of blocks | noise of theirs | |",
        "|---|---|---|---|---|",
    ]
    for name, result in results.items():
        if "mean_ratio" in result:
            noise = result["theirs_noise"]
            numbers = f"{result['mean_ratio']:.3f} | {result['block_rmse']:.1%} | {noise:.1%}"
            lines.append(f"| {name} | {numbers} | {'within' if result['within'] else 'see below'} |")
        else:
            who = [program for program in ("sunpeak", "radiance") if program in result]
            lines.append(f"| {name} | | | | refused by {' and '.join(who)} |")
    return "\n".join(lines)


def write_table(results: dict[str, dict[str, object]]) -> None:
    """Put the rows between the marks of `scenes.md`."""
    page = HERE / "scenes.md"
    before, _, rest = page.read_text().partition(BEGIN)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{BEGIN}\n{table(results)}\n{END}{after}")


def main() -> None:
    """Compare, print a line a case, keep all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="names of cases")
    parser.add_argument("--oversampled", type=int, default=4, help="Radiance's rays across a pixel")
    parser.add_argument("--paths", type=int, default=64, help="Radiance's -ad")
    parser.add_argument("--runs", type=int, default=2, help="runs of rpict that are averaged")
    parser.add_argument("--samples", type=int, default=512, help="our paths for each pixel")
    parser.add_argument("--pictures", type=Path, help="keep the pictures in this folder")
    chosen = parser.parse_args()
    package = Path(pyradiance.__file__).parent
    radiance = Radiance(package / "bin", package / "lib")
    results = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    with TemporaryDirectory() as temporary:
        folder = (chosen.pictures or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        make_stand_ins(folder, radiance)
        for case in CASES:
            if chosen.only and case.name not in chosen.only:
                continue
            effort = Effort(chosen.oversampled, chosen.paths, chosen.runs, chosen.samples)
            result = compare(Comparison(case, folder, radiance), effort)
            results[case.name] = result
            shown = [f"{k} {v}" for k, v in result.items() if k not in ("files", "view", "bounces", "ours", "theirs")]
            print(case.name, *shown, sep=", ", flush=True)
            results = dict(sorted(results.items()))
            RESULTS.write_text(json.dumps(results, separators=(",", ":")) + "\n")
            write_table(results)


if __name__ == "__main__":
    main()
