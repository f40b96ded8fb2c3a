"""Residuals that a split wrote, in Radiance's own library: the same hemispherical values as ours."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp

# In a process of its own: the library keeps every file that it has seen.
ASK = """
import json, sys
import pyradiance.bsdf as library
table = library.load_file(sys.argv[1])
angles = json.load(sys.stdin)
half = library.SAMPLE_DF | library.SAMPLE_SPT
json.dump([library.direct_hemi(table, theta, phi, half) for theta, phi in angles], sys.stdout)
"""

# The library takes a transmission of less than this for none, and serves the other side's [-].
INSIGNIFICANT = 1e-3

FILES = [
    "blinds_klems-full_leading-text",
    "blinds_t3-1024_leading-text",
    "clear-glass-3mm_klems-full",
    "clear-glass_t4-4096",
    "diffuse-glass_klems-full",
    "diffusing-panel_klems-full",
    "escreen-3pct-charcoal_klems-full",
    "escreen-3pct_klems-half",
    "escreen-3pct_klems-quarter",
    "louvre_t4-256",
    "metal-grate_klems-full_xyz",
    "metal-grate_t3-1024",
    "metal-grate_t4-256",
    "shade-020_klems-full",
    "shade-2011-sa1_klems-full",
    "silverscreen-2pct-dark-gray_klems-full",
    "roman-shade_klems-full_crlf_radiance-rejects",
]


def angles() -> np.ndarray:
    """Theta and phi [deg] over the sphere."""
    random = np.random.default_rng(5)
    return np.stack([np.degrees(np.arccos(random.uniform(-1, 1, 60))), random.uniform(0, 360, 60)], axis=1)


def check(bsdf: sp.Bsdf, folder: Path) -> None:
    pytest.importorskip("pyradiance", reason="the oracle pyradiance is not installed")
    bsdf.save_split(folder)
    directions = angles()
    w_in = sp.direction(*directions.T)
    ours = bsdf.hemispherical(w_in, residual=True)
    sides = [ours[w_in[:, 2] > 0], ours[w_in[:, 2] < 0]]
    done = subprocess.run(
        [sys.executable, "-c", ASK, folder / "residual.xml"],
        input=json.dumps(directions.tolist()),
        capture_output=True,
        text=True,
        check=True,
    )
    theirs = np.array(json.loads(done.stdout))
    for side, front in zip(sides, (True, False), strict=True):
        if side.max() > INSIGNIFICANT:
            here = (w_in[:, 2] > 0) == front
            # The library sums trees over cumulative tables of limited size.
            np.testing.assert_allclose(theirs[here], side, rtol=2e-3, atol=2e-5)


@pytest.mark.parametrize("name", FILES)
def test_residuals_of_real_files(name: str, shared: Path, tmp_path: Path) -> None:
    check(sp.Bsdf.load(shared / "bsdf" / f"{name}.xml"), tmp_path / "split")


@pytest.mark.parametrize("basis", ["klems", "klems-half", "klems-quarter", "t3-1024", "t3-4096", "t4-256"])
def test_residuals_of_fabrics(basis: str, tmp_path: Path) -> None:
    sp.Fabric().write(tmp_path / "fabric.xml", basis)
    check(sp.Bsdf.load(tmp_path / "fabric.xml"), tmp_path / "split")
