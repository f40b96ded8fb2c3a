"""Pictures against Radiance's own programs: the same values in, and out again."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import Radiance

WIDTH, HEIGHT = 45, 31


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """Flat areas, gradients and noise over many orders of magnitude."""
    rng = np.random.default_rng(5)
    pixels = rng.lognormal(sigma=6, size=(HEIGHT, WIDTH, 3))
    pixels[8:12] = [0.25, 0.5, 1.0]
    pixels[20:] = np.linspace(0, 1, WIDTH)[:, None]
    path = tmp_path / "made.hdr"
    sp.Picture.of(pixels, sp.View.parse("-vta -vp 1 2 3 -vh 180 -vv 120")).save(path)
    return path


def values(radiance: Radiance, path: Path) -> npt.NDArray[np.float32]:
    """What `pvalue` says, in the order of the file, exposures undone."""
    return np.frombuffer(radiance.run("pvalue", "-o", "-h", "-H", "-df", path), "<f4").reshape(-1, 3)


def test_what_we_write_radiance_reads(picture: Path, radiance: Radiance) -> None:
    read = sp.Picture.load(picture)
    np.testing.assert_array_equal(values(radiance, picture), read.pixels.reshape(-1, 3))
    assert radiance.run("getinfo", "-d", picture).decode().split()[-4:] == ["-Y", str(HEIGHT), "+X", str(WIDTH)]
    view = radiance.run("vwrays", "-vf", picture, "-x", 64, "-y", 64, "-d").decode().split()
    assert view[:4] == ["-x", "64", "-y", "43"]


@pytest.mark.parametrize(
    "command", [["pflip", "-h"], ["pflip", "-v"], ["pflip", "-h", "-v"], ["protate"], ["protate", "-r"]], ids=" ".join
)
def test_all_orientations_come_out_upright(
    command: list[str], picture: Path, tmp_path: Path, radiance: Radiance
) -> None:
    turned = tmp_path / "turned.hdr"
    turned.write_bytes(radiance.run(*command, picture))
    np.testing.assert_array_equal(sp.Picture.load(turned).pixels, sp.Picture.load(picture).pixels)


@pytest.mark.parametrize("options", [("-e", "3"), ("-e", "+2", "-er", "1.5"), ("-x", "/2", "-y", "/2", "-e", "0.1")])
def test_exposures_are_undone(options: tuple[str, ...], picture: Path, tmp_path: Path, radiance: Radiance) -> None:
    exposed = tmp_path / "exposed.hdr"
    once = radiance.run("pfilt", "-1", "-e", "7", picture)
    exposed.write_bytes(radiance.run("pfilt", "-1", *options, data=once))
    theirs = values(radiance, exposed)
    np.testing.assert_allclose(sp.Picture.load(exposed).pixels.reshape(-1, 3), theirs, rtol=3e-7)


def test_flat_pictures_are_read(picture: Path, tmp_path: Path, radiance: Radiance) -> None:
    flat = tmp_path / "flat.hdr"
    flat.write_bytes(radiance.run("ra_rgbe", picture))
    assert flat.stat().st_size >= 4 * WIDTH * HEIGHT
    np.testing.assert_array_equal(sp.Picture.load(flat).pixels, sp.Picture.load(picture).pixels)


def test_xyz_becomes_our_primaries(tmp_path: Path, radiance: Radiance) -> None:
    pixels = np.random.default_rng(7).uniform(0.5, 1.0, size=(9, 11, 3))
    original, converted = tmp_path / "rgb.hdr", tmp_path / "xyz.hdr"
    sp.Picture.of(pixels).save(original)
    converted.write_bytes(radiance.run("ra_xyze", original))
    # Two times half a step of 1/128, and the matrix that stands between.
    np.testing.assert_allclose(sp.Picture.load(converted).pixels, pixels, atol=0.03)


@pytest.mark.parametrize("name", ["evalglare-testimage.hdr", "two-exposures.hdr"])
def test_real_pictures_have_the_values_of_pvalue(name: str, shared: Path, radiance: Radiance) -> None:
    path = shared / "hdr" / name
    picture = sp.Picture.load(path)
    np.testing.assert_allclose(picture.pixels.reshape(-1, 3), values(radiance, path), rtol=3e-7)
    assert picture.view is not None
