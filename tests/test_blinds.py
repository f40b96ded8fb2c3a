"""Blinds from formulas: the straight part against slats that rays are traced through."""

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine
from sunpeak import _core

SPACING = 0.05


def slats(blind: sp.Blind) -> str:
    """Black slats in the plane y = 0, up at the front, y > 0, if the tilt is positive; the room is there."""
    half = 0.5 * blind.width * SPACING
    tilt = np.radians(blind.tilt_deg)
    y, z = half * np.cos(tilt), half * np.sin(tilt)
    slat = f"black polygon slat 0 0 12 -9 {-y} {-z} 9 {-y} {-z} 9 {y} {z} -9 {y} {z}\n"
    text = "void plastic black 0 0 5 0 0 0 0 0\n"
    for i in range(-60, 61):
        words = slat.split()
        for k in range(8, len(words), 3):
            words[k] = str(float(words[k]) + i * SPACING)
        text += " ".join(words) + "\n"
    return text


@pytest.mark.parametrize("tilt_deg", [0.0, 30.0, -30.0])
@pytest.mark.parametrize("altitude_deg", [15.0, 40.0])
def test_the_straight_part_is_that_of_slats(tilt_deg: float, altitude_deg: float) -> None:
    blind = sp.Blind(width=0.9, tilt_deg=tilt_deg)
    altitude = np.radians(altitude_deg)
    sun = np.array([0.0, -np.cos(altitude), np.sin(altitude)])
    light = f"void light s 0 0 3 1e6 1e6 1e6\ns source sun 0 0 4 {sun[0]} {sun[1]} {sun[2]} 0.02\n"
    scene = sp.Scene.parse(light + slats(blind))
    height = (np.arange(64) + 0.5) / 64 * SPACING
    points = np.column_stack([np.zeros(64), np.full(64, 0.5), -0.5 * np.tan(altitude) + height])
    normals = np.tile(sun, (64, 1))
    lit = sp.trace(scene, points, normals, irradiance=True, samples=4, max_bounces=0)[:, 0] > 0
    # In the frame of the BSDF: z into the room, y up; w_in is where the ray to the sun comes from.
    w_in = np.array([[0.0, -np.sin(altitude), np.cos(altitude)]])
    expected = _core.synthetic_through("blind", asdict(blind), w_in)[0]
    assert lit.mean() == pytest.approx(expected, abs=1.5 / 64)
    assert 0.0 <= expected < 1.0


def test_the_command_writes_what_python_does(sunpeak: CommandLine, tmp_path: Path) -> None:
    sunpeak("bsdf", "blind", "-o", tmp_path / "a.xml", "--width", 1.2, "--tilt", 20, "--scattered", 0.1)
    sp.Blind(1.2, 20.0, 0.1).write(tmp_path / "b.xml")
    assert (tmp_path / "a.xml").read_text() == (tmp_path / "b.xml").read_text()
    bsdf = sp.Bsdf.load(tmp_path / "a.xml")
    assert 0.0 < bsdf.through(sp.direction([0.0]))[0] < 1.0
