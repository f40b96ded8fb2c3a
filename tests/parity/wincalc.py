"""LBNL's pyWinCalc as an oracle for glazing systems: layers as it has them, and a standard with few wavelengths.

pyWinCalc 3.3.1 solves a shade at each wavelength of its standard, a second each. Layers that are the same at all
wavelengths give the same at a few.
"""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp

pywincalc = pytest.importorskip("pywincalc")

METHODS = {"visible": "PHOTOPIC", "solar": "SOLAR"}


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


def few_wavelengths(folder: Path) -> Any:
    """Make a standard of the visible spectrum with five wavelengths."""
    spectra = ("CIE Illuminant D65 1nm.ssp", "ASTM E308 1931 Y.dsp")
    for name in spectra:
        shutil.copy(pywincalc.standard_path / name, folder / name)
    (folder / "few.wvl").write_text("\n".join(map(str, (0.38, 0.5, 0.55, 0.6, 0.78))) + "\n")
    standard = folder / "few.std"
    standard.write_text(
        "Standard Description : few\nStandard Provides Methods: PHOTOPIC\n\nName : PHOTOPIC\nDescription : few\n"
        f"Source Spectrum : {spectra[0]}\nDetector Spectrum : {spectra[1]}\nWavelength Set : few.wvl\n"
        "Integration Rule : Trapezoidal\nMinimum Wavelength : 0.38\nMaximum Wavelength : 0.78\n\n"
    )
    return pywincalc.load_standard(str(standard))


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
