"""LBNL's pyWinCalc as an oracle for glazing systems: layers as it has them, and standards of our own.

pyWinCalc 3.3.1 solves a shade at each wavelength of its standard, a second each. Layers that are the same at all
wavelengths give the same at a few.
"""

import shutil
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp

pywincalc = pytest.importorskip("pywincalc")

METHODS = {"visible": "PHOTOPIC", "solar": "SOLAR"}
BESIDE_VISIBLE_UM = (0.3799, 0.7801)
"""Just outside of the visible: pyWinCalc joins wavelengths by lines, also where a shade's values jump."""
THEIR_SHARE = 0.49
"""Share of visible sun by which WinCalc 2.4.1 (pyWinCalc 3.3.1) takes a shade's visible values off its solar ones."""


def glass(wavelengths_um: tuple[float, ...], pane: sp.Pane) -> Any:
    """One of our panes as a solid layer."""
    columns = zip(pane.transmittance, pane.front_reflectance, pane.back_reflectance, strict=True)
    values = [pywincalc.OpticalMeasurementComponent(tau, tau, front, back) for tau, front, back in columns]
    points = [pywincalc.WavelengthData(um, value) for um, value in zip(wavelengths_um, values, strict=True)]
    coated = pane.curve != "fresnel"
    kind = pywincalc.MaterialType.COATED if coated else pywincalc.MaterialType.MONOLITHIC
    side = {"coated_side": pywincalc.CoatedSide.FRONT} if coated else {}
    optical = pywincalc.ProductDataOpticalNBand(kind, 0.003, points, **side)
    return pywincalc.ProductDataOpticalAndThermal(optical, pywincalc.ProductDataThermal(1.0, 0.003))


def shade(path: Path) -> Any:
    """A BSDF file as a solid layer; pyWinCalc reads none without a thickness."""
    text = path.read_text()
    if "<Thickness" not in text:
        text = text.replace("<DeviceType>", '<Thickness unit="Millimeter">1</Thickness><DeviceType>', 1)
    return pywincalc.parse_bsdf_xml_string(text)


def as_they_share(ours: Path, theirs: Path, share: float) -> Path:
    """Write a shade with such solar values that pyWinCalc finds the invisible ones that we find by `share`."""
    tree = ElementTree.parse(ours)
    tables: dict[str, dict[str, ElementTree.Element]] = {"Visible": {}, "Solar": {}}
    for data in tree.iterfind(".//{*}WavelengthData"):
        for block in data.iterfind("{*}WavelengthDataBlock"):
            direction = block.findtext("{*}WavelengthDataDirection")
            tables[data.findtext("{*}Wavelength")][direction] = block.find("{*}ScatteringData")
    for direction, element in tables["Solar"].items():
        visible, solar = (
            np.array(table.text.replace(",", " ").split(), float) for table in (tables["Visible"][direction], element)
        )
        rest = np.maximum((solar - share * visible) / (1 - share), 0.0)
        element.text = ", ".join(f"{v:.8g}" for v in THEIR_SHARE * visible + (1 - THEIR_SHARE) * rest)
    ElementTree.register_namespace("", "http://windows.lbl.gov")
    tree.write(theirs, encoding="utf-8", xml_declaration=True)
    return theirs


def few_wavelengths(folder: Path) -> Any:
    """Make a standard of the visible spectrum with five wavelengths."""
    source, detector = "CIE Illuminant D65 1nm.ssp", "ASTM E308 1931 Y.dsp"
    for name in (source, detector):
        shutil.copy(pywincalc.standard_path / name, folder / name)
    (folder / "few.wvl").write_text("\n".join(map(str, (0.38, 0.5, 0.55, 0.6, 0.78))) + "\n")
    return standard(folder / "few.std", "PHOTOPIC", (source, detector, "few.wvl"), (0.38, 0.78))


def sharp_sun(folder: Path) -> Any:
    """Make a standard of the solar band with wavelengths beside the visible, to 2.5 um as in NFRC 300."""
    name = "ASTM E891 Table 1 Direct AM1_5.ssp"
    lines = (pywincalc.standard_path / name).read_text(errors="replace").splitlines()
    first = next(k for k, line in enumerate(lines) if line[:1].isdigit())
    um, power = np.loadtxt(lines[first:]).T
    nodes = np.union1d(um[um <= 2.5], BESIDE_VISIBLE_UM)
    rows = [f"{x:.4f} {y:.6f}" for x, y in zip(nodes, np.interp(nodes, um, power), strict=True)]
    (folder / "sun.ssp").write_text("\n".join(lines[:first] + rows) + "\n")
    return standard(folder / "sharp.std", "SOLAR", ("sun.ssp", "None", "Source"), (0.3, 2.5))


def standard(path: Path, method: str, files: tuple[str, str, str], bounds_um: tuple[float, float]) -> Any:
    """Write and load a standard of one method: files of its source, its detector, its wavelengths."""
    source, detector, wavelengths = files
    path.write_text(
        f"Standard Description : {path.stem}\nStandard Provides Methods: {method}\n\n"
        f"Name : {method}\nDescription : {path.stem}\n"
        f"Source Spectrum : {source}\nDetector Spectrum : {detector}\nWavelength Set : {wavelengths}\n"
        f"Integration Rule : Trapezoidal\nMinimum Wavelength : {bounds_um[0]}\nMaximum Wavelength : {bounds_um[1]}\n\n"
    )
    return pywincalc.load_standard(str(path))


def results(layers: list[Any], band: str, theta_deg: float = 0.0, *, matrices: bool = False, **options: Any) -> Any:
    """Ask it for a system's results at an angle."""
    gap = pywincalc.Layers.gap(thickness=0.0127)
    if matrices:
        options["bsdf_hemisphere"] = pywincalc.BSDFHemisphere.create(pywincalc.BSDFBasisType.FULL)
    system = pywincalc.GlazingSystem(solid_layers=layers, gap_layers=[gap] * (len(layers) - 1), **options)
    return system.optical_method_results(METHODS[band], theta_deg, 0).system_results


def matrix(side: Any, kind: str) -> npt.NDArray[np.float64]:
    """BSDF [1/sr] of `transmittance` or `reflectance`, (145, 145)."""
    return np.array(getattr(side, kind).matrix)


def fine_hemisphere(points: int) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Cosines of incidence and weights by flux of Gauss's rule over the hemisphere."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    cosines = (nodes + 1.0) / 2.0
    return cosines, weights * cosines


def by_ten_degrees(theta_deg: npt.NDArray[np.float64], values: npt.NDArray[np.float64]) -> float:
    """The hemisphere's mean as pyWinCalc takes it for panes: trapezoids of 10 degrees."""
    theta = np.radians(theta_deg)
    return float(np.trapezoid(values * np.sin(2 * theta), theta))
