"""BSDFs from scans: as Radiance reads them, and the same scans through Radiance's pabopto2bsdf."""

import math
from pathlib import Path

import numpy as np
import pytest

import scans as synthetic
import sunpeak as sp
from conftest import Radiance
from parity.test_bsdf import PERTURBATION, angles, ask

WARD = sp.Formula("wgmd", diffuse=0.2, specular=0.3, roughness=0.15)
THETAS = (0, 20, 40, 60, 80)


@pytest.fixture(scope="module")
def measured() -> list[sp.Scan]:
    """Reflection of a glossy surface on its front, and what a fabric lets through."""
    reflected = synthetic.scans(synthetic.formula(WARD), THETAS, reflection=True)
    return reflected + synthetic.scans(synthetic.fabric(1.5), (0, 20, 40, 60), reflection=False)


@pytest.mark.parametrize("basis", ["klems", "t3-1024", "t4-256"])
def test_radiance_reads_the_same_from_our_file(basis: str, measured: list[sp.Scan], tmp_path: Path) -> None:
    made = sp.measured_bsdf(measured, basis, instrument_fwhm_deg=1.5)
    made.save(tmp_path / "measured.xml")
    pairs = angles(200, seed=9)
    theirs = ask(tmp_path / "measured.xml", pairs)
    w_in, w_out = sp.direction(*pairs[:, :2].T), sp.direction(*pairs[:, 2:].T)
    np.testing.assert_allclose(made.bsdf.evaluate(w_in, w_out), theirs["values"][:, 1], rtol=PERTURBATION, atol=1e-7)
    # Within a fifth of a degree of grazing the library takes another column for a sum over a tree, or none.
    # Transmission was measured from the front alone: from behind the library has a tree's diffuse part only.
    seen = w_in[:, 2] > math.sin(math.radians(0.2))
    for column, mode in enumerate(("transmission", "reflection")):
        ours = made.bsdf.hemispherical(w_in, mode)
        np.testing.assert_allclose(ours[seen], theirs["hemispherical"][seen, column], atol=1e-4)


def test_light_that_meets_the_front_is_so_in_files_of_both(radiance: Radiance, tmp_path: Path) -> None:
    """An off-specular sample that tells left from right, up from down and front from back."""

    def tilted(light: np.ndarray, out: np.ndarray) -> np.ndarray:
        return 0.3 / np.pi * (1.0 + 0.5 * out[..., 0] + 0.3 * out[..., 1] * light[0] - 0.2 * out[..., 0] * light[1])

    scans = synthetic.scans(tilted, (0, 25, 50, 75), range(0, 360, 45), reflection=True, step_deg=6.0)
    files = [synthetic.write_pabopto(tmp_path / f"{k}.txt", scan, "DSF", 0.0).name for k, scan in enumerate(scans)]
    (tmp_path / "scans.sir").write_bytes(radiance.run("pabopto2bsdf", *files, folder=tmp_path))
    (tmp_path / "theirs.xml").write_bytes(radiance.run("bsdf2klems", "-n", "30", "scans.sir", folder=tmp_path))
    theirs = sp.Bsdf.load(tmp_path / "theirs.xml")
    ours = sp.measured_bsdf([tmp_path / name for name in files], "klems").bsdf
    # Middles of Klems's patches: what is linear is there as in the mean.
    light = sp.direction([30.0, 30, 60, 60, 50], [18.0, 108, 195, 285, 45])
    out = sp.direction([40.0, 60, 30, 50, 20], [15.0, 195, 108, 300, 90])
    truth = np.array([tilted(a, b) for a, b in zip(light, out, strict=True)])
    assert np.ptp(truth) > 0.04
    # Both smooth what they read; with any two sides exchanged nothing would be left of the likeness.
    assert np.corrcoef(ours.evaluate(light, out), truth)[0, 1] > 0.98
    assert np.corrcoef(theirs.evaluate(light, out), truth)[0, 1] > 0.9
    assert not ours.hemispherical(-light, "reflection").any()
    assert not theirs.hemispherical(-light, "reflection").any()
