"""Rule 2 of peak extraction run through Radiance itself."""

import tempfile
from pathlib import Path

import numpy as np

from sunpeak import _core
from sunpeak.images import LUMINANCE_WEIGHTS
from sunpeak.scattering import Bsdf, Floats
from sunpeak.studies.radiance import Radiance

SOURCE_DEG = 0.2
"""Diameter of the glow exactly behind each ray."""


def through_by_radiance(bsdf: Bsdf, w_in: Floats) -> Floats | None:
    """T that an `aBSDF` polygon of this table has in `rtrace` (n,) [-]: a glow of 0.2 degrees behind each ray."""
    radiance = Radiance.find()
    if radiance is None:
        return None
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
        octree.write_bytes(radiance.run("oconv", "-w", "-", data=scene))
        rays = "".join(" ".join(f"{number:.9g}" for number in (*w, *-w)) + "\n" for w in w_in)
        answer = radiance.run("rtrace", "-h", "-ab", 0, "-st", 1, "-ss", 0, octree, data=rays)
    rgb = np.array([line.split() for line in answer.decode().splitlines()], dtype=np.float64)
    through: Floats = rgb @ LUMINANCE_WEIGHTS
    return through
