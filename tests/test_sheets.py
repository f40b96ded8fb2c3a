"""Perforated sheets and expanded meshes against closed forms; datasheets in two bands."""

import math
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine

SHEET = sp.Perforated(diameter_mm=2.0, pitch_mm=4.0, thickness_mm=1.0, reflectance=0.6)
MESH = sp.ExpandedMesh(long_way_mm=10.0, short_way_mm=6.0, strand_mm=1.2, thickness_mm=0.8)


def overlap(diameter: float, shift: float) -> float:
    """Area common to two circles of a diameter, by slices."""
    x = np.linspace(-diameter / 2 + shift / 2, diameter / 2 - shift / 2, 20001)
    half = np.sqrt(np.maximum(diameter**2 / 4 - (np.abs(x) + shift / 2) ** 2, 0))
    return float(np.trapezoid(2 * half, x))


def test_a_perforated_sheet_at_fifty_directions() -> None:
    random = np.random.default_rng(5)
    theta, phi = random.uniform(0, 55, 50), random.uniform(0, 360, 50)
    cell = 4.0**2 * math.sqrt(3) / 2
    want = [overlap(2.0, math.tan(angle)) / cell for angle in np.radians(theta)]
    w_in = sp.direction(theta, phi)
    assert SHEET.through(w_in) == pytest.approx(want, rel=2e-3)
    # Between the columns of a fine table; the cusp at the normal itself is rounded off.
    off_normal = theta > 2.0
    table = SHEET.bsdf("t3-16384").through(w_in)
    assert table[off_normal] == pytest.approx(np.array(want)[off_normal], rel=2e-3)
    assert table == pytest.approx(want, rel=5e-3)


def test_openings_and_reflection_are_by_their_shares() -> None:
    open_area = math.pi / (4.0**2 * 2 * math.sqrt(3) / 4)
    assert SHEET.open_area() == pytest.approx(open_area)
    assert SHEET.bsdf().hemispherical([0, 0, 1], "reflection") == pytest.approx(0.6 * (1 - open_area), rel=1e-3)
    assert sp.Perforated(2, 4, 1, "square").open_area() == pytest.approx(math.pi / 16)


def test_a_mesh_is_open_at_the_normal_and_shut_where_its_walls_stand() -> None:
    height = 10 * 6 / math.hypot(10, 6)
    assert MESH.through([0, 0, 1]) == pytest.approx((1 - 1.2 / height) ** 2)
    assert MESH.through(sp.direction(87.0, 90.0)) == 0.0
    # The short way shuts first.
    long, short = (MESH.through(sp.direction(50.0, phi))[0] for phi in (0.0, 90.0))
    assert long > short > 0.0


def test_commands_write_what_the_classes_do(sunpeak: CommandLine, tmp_path: Path) -> None:
    out, split = tmp_path / "sheet.xml", tmp_path / "split"
    sizes = ("--diameter", 2, "--pitch", 4, "--thickness", 1, "--reflectance", "60%")
    sunpeak("bsdf", "perforated", "-o", out, *sizes, "--split", split)
    w_in = sp.direction([2.0, 30])
    assert sp.Bsdf.load(split).through(w_in) == pytest.approx(SHEET.bsdf().through(w_in), rel=1e-6)
    # The split of the table finds nearly the same.
    assert sp.Bsdf.load(out).through(w_in) == pytest.approx(SHEET.bsdf().through(w_in), rel=0.01)
    said = sunpeak(
        "bsdf", "mesh", "-o", out, "--long-way", 10, "--short-way", 6, "--strand", 6, "--thickness", 1, expect=1
    )
    assert "leave no opening" in said.err


def test_a_datasheet_in_two_bands(sunpeak: CommandLine, tmp_path: Path) -> None:
    out = tmp_path / "blind.xml"
    visible = ("--tau-nn", "3%", "--tau-nh", "5%", "--rho-front", "40%")
    solar = ("--solar-tau-nh", "12%", "--solar-rho-front", "45%")
    sunpeak("bsdf", "fabric", "-o", out, *visible, *solar, "--basis", "klems", "--split", tmp_path / "split")
    shade = sp.Shade.load(out)
    assert shade.solar is not None
    w_in = np.array([0.0, 0.0, -1.0])
    assert shade.visible.hemispherical(w_in) == pytest.approx(0.05, rel=0.01)
    assert shade.solar.hemispherical(w_in) == pytest.approx(0.12, rel=0.01)
    assert shade.solar.hemispherical(w_in, "reflection") == pytest.approx(0.45, rel=1e-3)
    model = sp.RollerBlind(0.03, 0.05, 0.4, 0.4)
    at_30 = sp.Bsdf.load(tmp_path / "split").through(sp.direction(30.0))
    assert at_30 == pytest.approx(model.through(math.radians(30)), rel=5e-3)
    said = sunpeak("bsdf", "fabric", "-o", out, *visible, "--solar-tau-nh", "12%", expect=2)
    assert "--solar-rho-front" in said.err
    said = sunpeak("bsdf", "fabric", "-o", out, *visible, *solar[:1], "2%", *solar[2:], expect=1)
    assert "part of" in said.err
