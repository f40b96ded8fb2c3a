"""A blind as geometry, as a table and as a proxy: sensors behind it under a uniform sky, by Radiance and by Sunpeak.

usage: python validation/proxy_sensors.py

The blind is that of `tutorial-room/blinds` in the collection of scenes, its table the one that Radiance finds for its
slats and the pane behind them. The room is black, so that only the window counts; slats as geometry need two bounces or
more. All should agree.
"""

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyradiance

import sunpeak as sp

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[0] / "tests")]

from scene_stand_ins import primitives, slats_table  # noqa: E402

from conftest import SHARED, Radiance  # noqa: E402

BLINDS = SHARED / "data/scenes/tutorial-room/blinds"
SENSORS = np.array(
    [[3, 1, 0.1, 0, 0, 1], [3, 2.5, 0.1, 0, 0, 1], [3, 2, 1.5, 0, -1, 0], [3, 1.5, 2.7, 0, 0, -1]], dtype=np.float64
)
"""On the floor near and far, facing the window, under the ceiling."""
SURROUNDINGS = """
void glow sky 0 0 4 1 1 1 0          sky source above 0 0 4 0 0 1 180
void glow ground 0 0 4 .1 .1 .1 0    ground source below 0 0 4 0 0 -1 180
void plastic black 0 0 5 0 0 0 0 0
black polygon under 0 0 12 -9 0 -9 15 0 -9 15 0 .9095 -9 0 .9095
black polygon over 0 0 12 -9 0 2.4384 15 0 2.4384 15 0 12 -9 0 12
black polygon left 0 0 12 -9 0 .9 0 0 .9 0 0 2.45 -9 0 2.45
black polygon right 0 0 12 6.096 0 .9 15 0 .9 15 0 2.45 6.096 0 2.45
"""
TABLE = """
void BSDF table 6 0 ./blinds/blindsT4c.xml 0 0 1 . 0 0
table polygon t 0 0 12 0 .0486 .9095 0 .0486 2.4384 6.096 .0486 2.4384 6.096 .0486 .9095
"""
EXACT = ("-aa", "0", "-as", "0", "-lr", "-20", "-lw", "1e-8", "-st", "0")


def main() -> None:
    """Print a line for each way of saying what the blind is."""
    package = Path(pyradiance.__file__).parent
    radiance = Radiance(package / "bin", package / "lib")
    parts = [" ".join(words) for words in primitives((BLINDS / "blindsWithProxy.rad").read_text())]
    pane, slats, proxy = ([part for part in parts if name in part] for name in ("Glazing", "Blinds", "Poly"))
    variants = {"slats": [*pane, *slats], "table": [TABLE], "proxy": [*pane, *slats, *proxy]}
    with TemporaryDirectory() as temporary:
        folder = Path(temporary)
        os.chdir(folder)
        os.environ |= {"RAYPATH": f".:{radiance.library}", "PATH": f"{radiance.programs}:{os.environ['PATH']}"}
        (folder / "blinds").mkdir()
        (folder / "blinds/blindsT4c.xml").write_bytes(slats_table(BLINDS / "blindsOnly.rad"))
        for name, primitives_of in variants.items():
            scene = folder / f"{name}.rad"
            scene.write_text(SURROUNDINGS + "\n".join(primitives_of) + "\n")
            octree = radiance.octree(folder / f"{name}.oct", scene.name, folder=folder)
            for bounces, directions in ((1, 20_000), (2, 3_000)):
                options = ("-I", "-w", "-ab", str(bounces), "-ad", str(directions), *EXACT)
                theirs = radiance.rtrace(octree, SENSORS, *options, folder=folder)[:, 1]
                ours = sp.trace(
                    sp.Scene.load([scene]), SENSORS[:, :3], SENSORS[:, 3:], irradiance=True, samples=20_000,
                    max_bounces=bounces,
                )[:, 1]  # fmt: skip
                print(f"{name}, {bounces} bounces: Radiance {theirs.round(3)}, Sunpeak {ours.round(3)}", flush=True)


if __name__ == "__main__":
    main()
