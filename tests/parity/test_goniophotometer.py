"""BSDFs from geometry against pyradiance's generator, and read by Radiance's library."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import Radiance
from sunpeak.periodic import Slats

# In a process of its own: the library keeps every file that it has seen.
ASK = """
import json, sys
import pyradiance.bsdf as library
table = library.load_file(sys.argv[1])
pairs = json.load(sys.stdin)
halves = [library.SAMPLE_DF | library.SAMPLE_SPT, library.SAMPLE_DF | library.SAMPLE_SPR]
print(json.dumps({
    "values": [library.query(table, *pair)[1] for pair in pairs],
    "hemispherical": [[library.direct_hemi(table, *pair[:2], half) for half in halves] for pair in pairs],
}))
"""

GENERATE = """
import sys
import pyradiance
from pyradiance.genbsdf import SamplingBox
made = pyradiance.generate_bsdf(
    sys.argv[1], params=["-ab", "8", "-ad", "64"], nsamp=60, basis="kq", dim=SamplingBox(*map(float, sys.argv[3:]))
)
open(sys.argv[2], "wb").write(pyradiance.generate_xml(vis_results=made, basis="kq"))
"""

SLATS = Slats()


@pytest.fixture(scope="module")
def world(tmp_path_factory: pytest.TempPathFactory) -> sp.World:
    path = tmp_path_factory.mktemp("slats") / "slats.rad"
    path.write_text(SLATS.radiance(), encoding="utf-8")
    return sp.World.compile(sp.Scene.load([path]))


@pytest.mark.parametrize("basis", ["klems", "t3-256", "t4-256"])
def test_radiance_reads_the_same_from_our_file(basis: str, world: sp.World, radiance: Radiance, tmp_path: Path) -> None:
    path = tmp_path / f"{basis}.xml"
    sp.generate_bsdf(world, basis, box=SLATS.box, periodic=True, samples=64, error=1.0).save(path)
    random = np.random.default_rng(1)
    theta = np.degrees(np.arccos(random.uniform(-1, 1, (200, 2))))
    phi = random.uniform(0, 360, (200, 2))
    pairs = np.stack([theta[:, 0], phi[:, 0], theta[:, 1], phi[:, 1]], axis=1)
    done = subprocess.run(
        [sys.executable, "-c", ASK, path], input=json.dumps(pairs.tolist()), capture_output=True, text=True, check=True
    )
    told = json.loads(done.stdout)
    bsdf, w_in, w_out = sp.Bsdf.load(path), sp.direction(*pairs[:, :2].T), sp.direction(*pairs[:, 2:].T)
    # The library moves values by up to 3e-4, so that neighbouring cells differ.
    np.testing.assert_allclose(told["values"], bsdf.evaluate(w_in, w_out), rtol=4e-4, atol=1e-9)
    whole = np.column_stack([bsdf.hemispherical(w_in, mode) for mode in ("transmission", "reflection")])
    np.testing.assert_allclose(told["hemispherical"], whole, atol=1e-4)


def test_the_same_blind_by_both_generators(world: sp.World, radiance: Radiance, tmp_path: Path) -> None:
    scene, path = tmp_path / "large.rad", tmp_path / "theirs.xml"
    scene.write_text(SLATS.radiance(length=10, slats=101), encoding="utf-8")
    env = os.environ | {"PATH": f"{radiance.programs}:{os.environ['PATH']}", "RAYPATH": f".:{radiance.library}"}
    command = [sys.executable, "-c", GENERATE, scene, path, *map(str, SLATS.box)]
    subprocess.run(command, env=env, check=True, capture_output=True)
    theirs = sp.Bsdf.load(path)
    ours = sp.generate_bsdf(world, "klems-quarter", box=SLATS.box, periodic=True, samples=1024, error=1.0).bsdf
    # Up to 63 degrees: past it a product of 10 m by 5 m still has edges. The 60 rays of their columns make a noise of
    # up to 0.07 each, and of a tenth of that in the mean.
    theta, phi = np.meshgrid([9.5, 26.0, 28.0, 44.0, 46.0, 62.0], np.arange(0, 360, 30) + 7.0)
    angles = theta.ravel(), phi.ravel()
    for w_in in (sp.direction(*angles), -sp.direction(*angles)):
        for mode in ("transmission", "reflection"):
            apart = ours.hemispherical(w_in, mode) - theirs.hemispherical(w_in, mode)
            assert abs(apart.mean()) < 0.02, mode
            assert np.sqrt((apart**2).mean()) < 0.07, mode
        # The sides, the azimuths: a blind that is mirrored or turned round is far off.
        turned = ours.hemispherical(w_in * [1, -1, 1], "transmission") - theirs.hemispherical(w_in, "transmission")
        assert np.sqrt((turned**2).mean()) > 0.15


def test_radiance_unpacks_the_geometry_as_a_proxy(world: sp.World, radiance: Radiance, tmp_path: Path) -> None:
    text = SLATS.radiance()
    made = sp.generate_bsdf(world, "klems-quarter", box=SLATS.box, periodic=True, samples=16, error=1.0)
    made.save(tmp_path / "slats.xml", geometry=sp.Scene.parse(text))
    made.save(tmp_path / "plain.xml")
    radiance.run("pkgBSDF", "slats.xml", folder=tmp_path)
    unpacked = (tmp_path / "slats.rad").read_text(encoding="utf-8")
    proxy = sp.Scene.load([tmp_path / "slats.rad"])
    # The proxy's own two faces come first, those of the box; then what was traced, moved to its middle.
    assert len(proxy.surfaces) == 2 + len(sp.Scene.parse(text).surfaces)
    x0, x1, y0, y1, _, z1 = SLATS.box
    detail = sp.Scene.parse(unpacked[unpacked.index("## Translated from MGF") :])
    traced, moved = (scene._core.bounds() for scene in (sp.Scene.parse(text), detail))
    assert traced is not None
    assert moved is not None
    for before, after in zip(traced, moved, strict=True):
        middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1), z1)
        np.testing.assert_allclose(after, np.asarray(before) - middle, atol=1e-6)
    reflectances = re.search(r"plastic \S+\n0\n0\n5((?: \S+)+)", unpacked)
    assert reflectances is not None
    np.testing.assert_allclose([float(word) for word in reflectances[1].split()], [0.6, 0.6, 0.6, 0, 0], atol=1e-5)
    # Tables are those of the file without geometry, for us and for Radiance.
    w_in, w_out = sp.direction([10.0, 40.0, 130.0], 20.0), sp.direction([30.0, 150.0, 60.0], 200.0)
    both = [sp.Bsdf.load(tmp_path / name).evaluate(w_in, w_out) for name in ("slats.xml", "plain.xml")]
    np.testing.assert_array_equal(*both)
