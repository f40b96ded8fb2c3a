"""Rule 2 run through Radiance itself, where pyradiance is installed; Sunpeak never needs it."""

import importlib.util
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from sunpeak import _core
from sunpeak.scattering import Bsdf, Floats

LUMINANCE_WEIGHTS = np.array([0.265, 0.670, 0.065])

SOURCE_DEG = 0.2
"""Diameter of the glow exactly behind each ray."""


def radiance_folder() -> Path | None:
    """Where Radiance is, if it is there."""
    found = importlib.util.find_spec("pyradiance")
    return Path(found.origin).parent if found and found.origin else None


def through_by_radiance(bsdf: Bsdf, w_in: Floats) -> Floats | None:
    """T that an `aBSDF` polygon of this table has in `rtrace` (n,) [-]: a glow of 0.2 degrees behind each ray."""
    root = radiance_folder()
    if root is None:
        return None
    env = os.environ | {"PATH": f"{root / 'bin'}:{os.environ.get('PATH', '')}", "RAYPATH": f".:{root / 'lib'}"}
    with tempfile.TemporaryDirectory() as folder:
        xml = Path(folder, "product.xml")
        xml.write_text(_core.bsdf_xml(bsdf._core), encoding="utf-8")
        sources = "".join(
            f"g source s{i} 0 0 4 {-x:.9f} {-y:.9f} {-z:.9f} {SOURCE_DEG}\n" for i, (x, y, z) in enumerate(w_in)
        )
        scene = (
            f"void aBSDF m 5 {xml} 0 1 0 . 0 0\n"
            "m polygon p 0 0 12 -100 -100 0 100 -100 0 100 100 0 -100 100 0\n"
            f"void glow g 0 0 4 1 1 1 -1\n{sources}"
        )
        octree = Path(folder, "scene.oct")
        made = subprocess.run(["oconv", "-w", "-"], input=scene.encode(), env=env, check=True, capture_output=True)
        octree.write_bytes(made.stdout)
        rays = "".join(" ".join(f"{number:.9g}" for number in (*w, *-w)) + "\n" for w in w_in)
        command = ["rtrace", "-h", "-ab", "0", "-st", "1", "-ss", "0", str(octree)]
        answer = subprocess.run(command, input=rays.encode(), env=env, check=True, capture_output=True).stdout
    rgb = np.array([line.split() for line in answer.decode().splitlines()], dtype=np.float64)
    through: Floats = rgb @ LUMINANCE_WEIGHTS
    return through
