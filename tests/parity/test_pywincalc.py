"""Glazing systems against LBNL's pyWinCalc."""

from pathlib import Path

import numpy as np
import pytest
import wincalc

import sunpeak as sp
from sunpeak.systems import Band

THETA_DEG = np.arange(0.0, 90.0, 10.0)
# Fine steps, so that it does not matter where the two programs interpolate.
UM = tuple(np.round(np.arange(0.3, 2.501, 0.02), 3))


def smooth(start: float, light: float, end: float) -> tuple[float, ...]:
    """A curve from the ultraviolet to the infrared."""
    um = np.array(UM)
    rise, fall = 1 / (1 + np.exp(-(um - 0.36) / 0.02)), 1 / (1 + np.exp((um - 0.9) / 0.15))
    return tuple(np.where(um < 0.5, start + (light - start) * rise, end + (light - end) * fall))


CLEAR = sp.Pane(UM, smooth(0.1, 0.9, 0.82), (0.08,) * len(UM), (0.08,) * len(UM))
TINTED = sp.Pane(UM, smooth(0.05, 0.6, 0.4), (0.055,) * len(UM), (0.055,) * len(UM))
# pyWinCalc 3.3.1 takes every coated pane for bronze glass (Windows-CalcEngine mended it in August 2025).
LOW_E = sp.Pane(UM, smooth(0.1, 0.8, 0.1), smooth(0.3, 0.07, 0.6), smooth(0.3, 0.05, 0.7), curve="bronze")


@pytest.mark.parametrize("band", ["visible", "solar"])
@pytest.mark.parametrize(
    "panes", [[CLEAR], [CLEAR, CLEAR], [LOW_E, CLEAR], [TINTED, LOW_E.flipped(), CLEAR]], ids=lambda p: str(len(p))
)
def test_panes_agree_at_all_angles(panes: list[sp.Pane], band: Band) -> None:
    layers = [wincalc.glass(UM, pane) for pane in panes]
    ours, system = {}, sp.System(panes)
    for side, sign in (("front", 1.0), ("back", -1.0)):
        ours[side] = system.straight(sp.direction(THETA_DEG) * [1, 1, sign], band)
    for k, theta in enumerate(THETA_DEG):
        found = wincalc.results(layers, band, theta)
        for side, straight in ours.items():
            theirs = getattr(found, side)
            assert straight.transmittance[k] == pytest.approx(theirs.transmittance.direct_direct, rel=2e-3)
            assert straight.reflectance[k] == pytest.approx(theirs.reflectance.direct_direct, rel=5e-3)
    # Its hemispherical values are sums over steps of 10 degrees: so are ours, for once. The right ones lie above.
    theirs = found.front.transmittance.diffuse_diffuse
    values = np.append(ours["front"].transmittance, 0.0)
    assert wincalc.by_ten_degrees(np.append(THETA_DEG, 90.0), values) == pytest.approx(theirs, rel=1e-3)
    assert system.diffuse(band).transmittance == pytest.approx(theirs, rel=0.01)


@pytest.mark.parametrize("band", ["visible", "solar"])
def test_hemispherical_values_are_those_of_its_angles(band: Band) -> None:
    """What pyWinCalc says at single angles, integrated finely; what it says of the hemisphere is a coarse sum."""
    panes = [LOW_E, CLEAR]
    layers = [wincalc.glass(UM, pane) for pane in panes]
    cosines, weights = wincalc.fine_hemisphere(8)
    found = [wincalc.results(layers, band, theta) for theta in np.degrees(np.arccos(cosines))]
    system = sp.System(panes)
    for side, inside in (("front", False), ("back", True)):
        ours, theirs = system.diffuse(band, inside=inside), [getattr(f, side) for f in found]
        assert ours.transmittance == pytest.approx(weights @ [t.transmittance.direct_direct for t in theirs], rel=1e-3)
        assert ours.reflectance == pytest.approx(weights @ [t.reflectance.direct_direct for t in theirs], rel=5e-3)
        window = system.diffuse(band, inside=inside, window=True).transmittance
        assert window == pytest.approx(theirs[0].transmittance.diffuse_diffuse, rel=1e-3)


GRAY = sp.Pane.from_values((0.8, 0.1, 0.12))
OTHER = sp.Pane.from_values((0.6, 0.3, 0.2))


@pytest.mark.parametrize("where", ["inside", "outside", "between"])
def test_a_fabric_behind_glass_agrees_patch_by_patch(tmp_path: Path, where: str) -> None:
    path = tmp_path / "fabric.xml"
    sp.RollerBlind(0.05, 0.15, 0.5, 0.4).write(path)
    fabric = sp.Bsdf.load(path)
    # pyWinCalc wants both bands.
    fabric.save(path, solar=fabric)
    compare_with_shade(path, where, tmp_path)


def test_a_product_file_behind_glass_agrees_patch_by_patch(shared: Path, tmp_path: Path) -> None:
    compare_with_shade(shared / "bsdf/shade-2011-sa1_klems-full.xml", "between", tmp_path)


def compare_with_shade(path: Path, where: str, folder: Path) -> None:
    ours = sp.Shade.load(path)
    theirs = wincalc.shade(path)
    outer, inner = (wincalc.glass((0.38, 0.78), sp.Pane((0.38, 0.78), *two(pane))) for pane in (GRAY, OTHER))
    layers, solid = {
        "inside": ([GRAY, ours], [outer, theirs]),
        "outside": ([ours, OTHER], [theirs, inner]),
        "between": ([GRAY, ours, OTHER], [outer, theirs, inner]),
    }[where]
    bsdf = sp.System(layers).bsdf("klems", panes="middle")
    found = wincalc.results(solid, "visible", matrices=True, optical_standard=wincalc.few_wavelengths(folder))
    for side, sign in ((found.front, -1.0), (found.back, 1.0)):
        # The file's front is met by rays at the back of the frame; the middles of the rings.
        theta = np.array([0.0, 10, 20, 30, 40, 50, 60, 70, 82.5])
        first = np.cumsum([0, 1, 8, 16, 20, 24, 24, 24, 16])
        w_in = sp.direction(theta) * [1, 1, sign]
        for kind, mode in (("transmittance", "transmission"), ("reflectance", "reflection")):
            matrix = wincalc.matrix(side, kind)
            area = projected_solid_angles()
            hemispherical = (matrix * area[:, None]).sum(axis=0)[first]
            got = bsdf.hemispherical(w_in, mode)
            assert got == pytest.approx(hemispherical, rel=2e-3), (kind, side)
        straight = wincalc.matrix(side, "transmittance").diagonal()[first]
        assert bsdf.evaluate(w_in, -w_in) == pytest.approx(straight, rel=2e-3)


def two(pane: sp.Pane) -> list[tuple[float, float]]:
    values = (pane.transmittance, pane.front_reflectance, pane.back_reflectance)
    return [(value[0], value[0]) for value in values]


def projected_solid_angles() -> np.ndarray:
    bounds = np.sin(np.radians([0, 5, 15, 25, 35, 45, 55, 65, 75, 90])) ** 2
    counts = np.array([1, 8, 16, 20, 24, 24, 24, 16, 12])
    return np.repeat(np.pi * np.diff(bounds) / counts, counts)
