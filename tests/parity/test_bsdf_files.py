"""BSDFs made and converted here, as Radiance reads them; made and converted by Radiance, as they are read here."""

import math
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance
from parity.test_bsdf import PERTURBATION, angles, ask
from test_convert import klems_areas, matrices

LOBE = sp.Formula("phong", diffuse=0.2, specular=0.5, exponent=12)


def written(folder: Path, name: str, bsdf: sp.Bsdf) -> Path:
    bsdf.save(folder / f"{name}.xml")
    return folder / f"{name}.xml"


@pytest.mark.parametrize(("basis", "resolution"), [("klems-full", None), ("klems-half", None), ("t3", 32), ("t4", 16)])
def test_converted_and_tabulated_files_say_the_same_there(
    tmp_path: Path, shared: Path, basis: str, resolution: int | None
) -> None:
    blind = sp.Bsdf.load(shared / "bsdf" / "metal-grate_t4-256.xml").convert(basis, resolution=resolution)
    for name, bsdf in (("converted", blind), ("formula", LOBE.tabulate(basis, resolution))):
        path = written(tmp_path, name, bsdf)
        pairs = angles(200, seed=4)
        theirs = ask(path, pairs)
        w_in, w_out = sp.direction(*pairs[:, :2].T), sp.direction(*pairs[:, 2:].T)
        np.testing.assert_allclose(bsdf.evaluate(w_in, w_out), theirs["values"][:, 1], rtol=PERTURBATION, atol=1e-7)
        # Within a tenth of a degree of grazing the library takes another column for a sum over a tree, or none.
        seen = np.abs(w_in[:, 2]) > math.sin(math.radians(0.1))
        for column, mode in enumerate(("transmission", "reflection")):
            ours = bsdf.hemispherical(w_in, mode)
            np.testing.assert_allclose(ours[seen], theirs["hemispherical"][seen, column], rtol=1e-4, atol=1e-6)


def test_trees_become_the_matrices_that_bsdf2klems_makes(radiance: Radiance, tmp_path: Path) -> None:
    tree = written(tmp_path, "tree", LOBE.tabulate("t4", 16))
    # It takes so many random pairs of directions for each pair of patches; values then scatter by their square root.
    (tmp_path / "theirs.xml").write_bytes(radiance.run("bsdf2klems", "-n", "250", tree, folder=tmp_path))
    ours = matrices(written(tmp_path, "ours", sp.Bsdf.load(tree).convert("klems-full")))
    theirs = matrices(tmp_path / "theirs.xml")
    areas = klems_areas()
    assert set(theirs) == {"Reflection Front", "Reflection Back"}
    for side, value in theirs.items():
        flux = np.outer(areas, areas)
        off = (flux * np.abs(ours[side] - value)).sum() / (flux * value).sum()
        assert off < 0.01, side
        np.testing.assert_allclose(areas @ ours[side], areas @ value, rtol=0.01)
    # And theirs is read here.
    read = sp.Bsdf.load(tmp_path / "theirs.xml")
    w_in = sp.direction([12, 40, 130], [10, 100, 200])
    assert read.hemispherical(w_in, "reflection") == pytest.approx(
        sp.Bsdf.load(tree).convert("klems-full").hemispherical(w_in, "reflection"), rel=0.01
    )


def test_trees_that_bsdf2ttree_makes_are_read_and_converted(radiance: Radiance, tmp_path: Path) -> None:
    """The same lobe as an expression of Radiance's, through its own program."""
    mirrored = "(-ix*ox-iy*oy+iz*oz)"
    function = f"lobe(ix,iy,iz,ox,oy,oz)=0.2/PI+0.5*14/(2*PI)*if({mirrored},{mirrored}^12,0)"
    command = ("bsdf2ttree", "-t3", "-g", "5", "-t", "0", "+forward", "-backward", "-e", function, "lobe")
    (tmp_path / "theirs.xml").write_bytes(radiance.run(*command, folder=tmp_path))
    theirs = sp.Bsdf.load(tmp_path / "theirs.xml")
    ours = LOBE.tabulate("t3", 32)
    reflecting = [c for c in theirs.describe()["components"] if c["mode"] == "reflection"]
    assert reflecting, theirs.describe()
    up = 1.0 if reflecting[0]["side"] == "front" else -1.0
    for theta in (10, 35, 60):
        w_in = np.array([math.sin(math.radians(theta)), 0.0, up * math.cos(math.radians(theta))])
        there, here = (b.hemispherical(w_in, "reflection")[0] for b in (theirs, ours))
        assert there == pytest.approx(here, rel=0.02)
        converted = theirs.convert("klems-full").hemispherical(w_in, "reflection")[0]
        assert converted == pytest.approx(ours.convert("klems-full").hemispherical(w_in, "reflection")[0], rel=0.02)
