"""BSDFs in other bases, as files: what the commands write, and what other programs read in it."""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import CommandLine

SPACE = "{http://windows.lbl.gov}"
KLEMS_FULL = [(5, 1), (15, 8), (25, 16), (35, 20), (45, 24), (55, 24), (65, 24), (75, 16), (90, 12)]


def elements(path: Path) -> list[tuple[str, list[str]]]:
    """All elements with their children's names, in file order."""
    root = ElementTree.parse(path).getroot()
    assert root.tag.startswith(SPACE)
    return [(e.tag.removeprefix(SPACE), [c.tag.removeprefix(SPACE) for c in e]) for e in root.iter()]


def check_structure(path: Path) -> None:
    """LBNL's schema 1.7.5 for matrices, by hand: which elements, in which order, with which values."""
    orders = {
        "Layer": "Material? Geometry? DataDefinition WavelengthData*",
        "DataDefinition": "IncidentDataStructure? AngleBasis+ Comments?",
        "AngleBasis": "AngleBasisName AngleBasisBlock+ Comments?",
        "AngleBasisBlock": "Theta (Phi|nPhis)? (SolidAngle|ThetaBounds)? Comments?",
        "ThetaBounds": "LowerTheta? UpperTheta? Comments?",
        "WavelengthData": "LayerNumber? Angle? Wavelength? SourceSpectrum? DetectorSpectrum? WavelengthDataBlock+",
        "WavelengthDataBlock": "WavelengthDataDirection ColumnAngleBasis? RowAngleBasis? "
        "ScatteringDataType+ ScatteringData+",
        "WindowElement": "WindowElementType FileType Checksum Optical",
    }
    material = {"Name", "ProductName", "Manufacturer", "Thickness", "DeviceType", "ThermalConductivity", "Comments"}
    for name, children in elements(path):
        if name in orders:
            pattern = "".join(re.sub(r"\w+", r"(?:\g<0> )", part) for part in orders[name].split())
            assert re.fullmatch(pattern, "".join(child + " " for child in children)), f"{name}: {children}"
        if name == "Material":
            assert set(children) <= material
            assert len(set(children)) == len(children)
            assert "Name" in children
    root = ElementTree.parse(path).getroot()
    values = {tag: {e.text for e in root.iter(SPACE + tag)} for tag in ("ScatteringDataType", "IncidentDataStructure")}
    assert values == {"ScatteringDataType": {"BTDF"}, "IncidentDataStructure": {"Columns"}}
    assert all(e.get("unit") in ("Meter", "Millimeter") for e in root.iter(SPACE + "Thickness"))


def matrices(path: Path, band: str = "Visible") -> dict[str, npt.NDArray[np.float64]]:
    """Values by direction, rows of exit, columns of incidence; read without Sunpeak."""
    found = {}
    for data in ElementTree.parse(path).getroot().iter(SPACE + "WavelengthData"):
        if (data.findtext(SPACE + "Wavelength") or "").strip() == band:
            for block in data.iter(SPACE + "WavelengthDataBlock"):
                text = block.findtext(SPACE + "ScatteringData") or ""
                values = np.array([float(v) for v in text.replace(",", " ").split()])
                direction = (block.findtext(SPACE + "WavelengthDataDirection") or "").strip()
                found[direction] = values.reshape(round(len(values) ** 0.5), -1)
    return found


def klems_areas() -> npt.NDArray[np.float64]:
    """Projected solid angles of Klems's patches [sr]."""
    edges = np.sin(np.radians([0] + [upper for upper, _ in KLEMS_FULL])) ** 2
    return np.concatenate([np.full(n, np.pi * d / n) for d, (_, n) in zip(np.diff(edges), KLEMS_FULL, strict=True)])


def test_what_a_command_writes(sunpeak: CommandLine, tmp_path: Path, shared: Path) -> None:
    real = shared / "bsdf" / "escreen-3pct-charcoal_klems-full.xml"
    half, again = tmp_path / "half.xml", tmp_path / "again.xml"
    options = ("--basis", "klems-half", "--name", "A < B", "--manufacturer", "M", "--thickness", "0.43mm")
    sunpeak("bsdf", "convert", real, "-o", half, *options)
    sunpeak("bsdf", "convert", real, "-o", again, *options)
    assert half.read_bytes() == again.read_bytes()
    check_structure(half)
    with pytest.raises(AssertionError, match="WindowElement"):
        check_structure(real)  # it has no FileType
    about = sp.Bsdf.load(half).describe()
    assert (about["name"], about["manufacturer"]) == ("A < B", "M")
    assert about["thickness_m"] == pytest.approx(4.3e-4)
    assert about["bands"] == ["Visible", "Solar"]
    assert "converted to klems-half by flux" in about["comments"]
    # Nothing asked: the same tables, both bands.
    same = tmp_path / "same.xml"
    sunpeak("bsdf", "convert", real, "-o", same)
    for band in ("Visible", "Solar"):
        old, new = matrices(real, band), matrices(same, band)
        assert all(np.allclose(old[name], new[name], rtol=1e-6) for name in new)


def test_visible_and_solar_files_become_one(sunpeak: CommandLine, tmp_path: Path) -> None:
    visible, solar, both = (tmp_path / f"{name}.xml" for name in ("visible", "solar", "both"))
    sp.Formula("lambert", reflectance=0.3, transmittance=0.2).write(visible, "klems-quarter")
    sp.Formula("lambert", reflectance=0.4, transmittance=0.1).write(solar, "klems-quarter")
    sunpeak("bsdf", "convert", visible, "--combine", solar, "-o", both)
    check_structure(both)
    normal = [0.0, 0.0, 1.0]
    bands = sp.Bsdf.load(both), sp.Bsdf.load_solar(both)
    assert [b.hemispherical(normal, "reflection")[0] for b in bands] == pytest.approx([0.3, 0.4], rel=1e-6)
    assert [b.hemispherical(normal)[0] for b in bands] == pytest.approx([0.2, 0.1], rel=1e-6)
    with pytest.raises(sp.InputError, match="no WavelengthData for the Solar band"):
        sp.Bsdf.load_solar(visible)
    sp.Formula("lambert").write(solar, "t3", 8)
    said = sunpeak("bsdf", "convert", visible, "--solar", solar, "-o", tmp_path / "x.xml", expect=1)
    assert "expected both in the same basis" in said.err
    assert not (tmp_path / "x.xml").exists()


@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (("--basis", "t4"), 1, "expected cells a side: 8, 16, 32, 64 or 128"),
        (("--basis", "t4", "--resolution", "48"), 1, "expected cells a side"),
        (("--basis", "klems-full", "--resolution", "64"), 1, "expected it with t3 or t4 alone"),
        (("--resolution", "64"), 2, "--resolution without --basis"),
        (("--basis", "klems-third"), 1, "expected klems"),
        (("--thickness", "thin"), 2, "expected a length"),
        (("--rotate", "nan"), 1, "expected a finite angle"),
    ],
)
def test_what_cannot_be_done_is_said(
    sunpeak: CommandLine, tmp_path: Path, options: tuple[str, ...], status: int, message: str
) -> None:
    source, target = tmp_path / "a.xml", tmp_path / "b.xml"
    sp.Formula("lambert").write(source, "klems-quarter")
    assert message in sunpeak("bsdf", "convert", source, "-o", target, *options, expect=status).err
    assert not target.exists()


def test_moves_of_a_real_blind_keep_what_it_lets_through(shared: Path) -> None:
    blind = sp.Bsdf.load(shared / "bsdf" / "louvre_t4-256.xml")
    w_in = sp.direction([17, 44, 66], [80, 95, 260])
    turned_over = blind.convert(flip=True)
    assert turned_over.hemispherical(w_in) == pytest.approx(blind.hemispherical(w_in * [-1, 1, -1]), rel=1e-6)
    quarter = blind.convert(rotate_deg=90.0)
    before = np.stack([w_in[:, 1], -w_in[:, 0], w_in[:, 2]], axis=-1)
    assert quarter.hemispherical(w_in) == pytest.approx(blind.hemispherical(before), rel=1e-6)
    mended = blind.convert(reciprocity="average")
    assert all(check.largest_difference < 1e-5 for check in mended.peak_report().reciprocity)
