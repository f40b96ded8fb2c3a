"""Glazing systems and their layers: files, command line, what must come back."""

import json
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine

ANGLES = sp.direction([2.0, 20, 40, 50])
WAVELENGTHS = (0.3, 0.5, 1.0, 2.5)
ROWS = [(um, 0.8, 0.08, 0.09) for um in WAVELENGTHS]
CLEAR = sp.Pane(WAVELENGTHS, *zip(*(row[1:] for row in ROWS), strict=True), name="clear")


def igsdb(version: int, coated: str = "Neither") -> str:
    """A product as IGSDB's interface hands it out."""
    about = {"name": "clear", "coated_side": coated}
    if version == 1:
        keys = ("wavelength", "T", "Rf", "Rb")
        points = [dict(zip(keys, row, strict=True)) for row in ROWS]
        return json.dumps(about | {"spectral_data": {"spectral_data": points}, "measured_data": {"thickness": 3.0}})
    data = [{"w": str(um), "specular": {"tf": t, "tb": t, "rf": f, "rb": b}} for um, t, f, b in ROWS]
    optical = {"optical_data": {"angle_blocks": [{"incidence_angle": 0, "wavelength_data": data}]}}
    return json.dumps(about | {"physical_properties": {"optical_properties": optical, "thickness": 3.0}}, indent=1)


@pytest.mark.parametrize("version", [1, 2])
def test_products_of_igsdb_are_read(tmp_path: Path, version: int) -> None:
    path = tmp_path / "clear.json"
    path.write_text(igsdb(version))
    pane = sp.Pane.load(path)
    assert (pane.curve, pane.thickness_mm) == ("fresnel", 3.0)
    assert pane.transmittance == CLEAR.transmittance
    assert pane.back_reflectance == CLEAR.back_reflectance
    path.write_text(igsdb(version, "Back"))
    assert sp.Pane.load(path).curve == "coated"


def walsh(n: float) -> float:
    """Reflectance of a face of index n for diffuse light in closed form (Walsh 1926; Duntley 1942, equation 24)."""
    square = n * n
    return (
        0.5
        + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2)
        + square * (square - 1) ** 2 / (square + 1) ** 3 * np.log((n - 1) / (n + 1))
        - 2 * n**3 * (square + 2 * n - 1) / ((square + 1) * (square**2 - 1))
        + 8 * square**2 * (square**2 + 1) / ((square + 1) * (square**2 - 1) ** 2) * np.log(n)
    )


def test_hemispherical_values_of_a_clear_pane_are_fresnels() -> None:
    n, weights, mu = 1.52, *gauss(200)
    inner = np.sqrt(1 - (1 - mu**2) / n**2)
    faces = np.array([((mu - n * inner) / (mu + n * inner)) ** 2, ((inner - n * mu) / (inner + n * mu)) ** 2])
    # One face has a closed form: so the quadrature is right.
    assert weights @ faces.mean(axis=0) == pytest.approx(walsh(n), rel=1e-6)
    pane = sp.System([sp.Pane.from_index(n, 4)])
    for inside in (False, True):
        found = pane.diffuse(inside=inside)
        # All orders of reflection between two faces that absorb nothing, for both polarisations.
        assert found.transmittance == pytest.approx(weights @ ((1 - faces) / (1 + faces)).mean(axis=0), rel=5e-4)
        assert found.reflectance == pytest.approx(weights @ (2 * faces / (1 + faces)).mean(axis=0), rel=5e-4)
    low = pane.diffuse(window=True).transmittance[0] / pane.diffuse().transmittance[0] - 1
    assert -0.008 < low < -0.004


def gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Weights by flux and cosines of incidence over the hemisphere."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    cosines = (nodes + 1) / 2
    return weights * cosines, cosines


def test_files_of_optics_are_read(tmp_path: Path) -> None:
    path = tmp_path / "clear.dat"
    rows = "\n".join(" ".join(map(str, row)) for row in ROWS)
    path.write_text("{ Units, Wavelength Units } SI Microns\n{ Thickness } 3.0\n{ Coated Side: Neither }\n" + rows)
    pane = sp.Pane.load(path)
    assert pane.front_reflectance == CLEAR.front_reflectance
    assert pane.thickness_mm == 3.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"name": "x"}', "physical_properties"),
        ('{"spectral_data": 3}', "expected its JSON"),
        ("{ Thickness } 3\n0.3 0.5 0.1", "line 2"),
        ("", "no spectrum"),
        ("0.3 0.9 0.2 0.1\n", "add up to more than 1"),
        ("0.3 nan 0.2 0.1\n", "expected 0 to 1"),
    ],
)
def test_what_is_no_pane_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "pane"
    path.write_text(text)
    with pytest.raises(sp.InputError, match=message) as error:
        sp.Pane.load(path)
    assert str(path) in str(error.value)


def test_values_of_a_datasheet_come_back() -> None:
    visible, solar = (0.75, 0.1, 0.12), (0.4, 0.3, 0.35)
    system = sp.System([sp.Pane.from_values(visible, solar, "coated")])
    for band, (tau, front, back) in (("visible", visible), ("solar", solar)):
        assert system.straight([0, 0, 1], band).transmittance == pytest.approx(tau, abs=2e-3)
        assert system.straight([0, 0, 1], band).reflectance == pytest.approx(front, abs=2e-3)
        assert system.straight([0, 0, -1], band).reflectance == pytest.approx(back, abs=2e-3)


def test_a_slab_is_fresnels() -> None:
    """Two faces of index 1.5 at the normal, all orders: T = 2n / (n² + 1)."""
    system = sp.System([sp.Pane.from_index(1.5, 4.0)])
    assert system.straight([0, 0, 1]).transmittance == pytest.approx(2 * 1.5 / (1.5**2 + 1))
    # At Brewster's angle one polarisation passes whole.
    theta = np.degrees(np.arctan(1.5))
    face = ((1.5**2 - 1) / (1.5**2 + 1)) ** 2
    assert system.straight(sp.direction(theta)).transmittance == pytest.approx(0.5 + 0.5 * (1 - face) / (1 + face))


@pytest.fixture(scope="module")
def fabric(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("systems") / "fabric.xml"
    sp.RollerBlind(0.05, 0.15, 0.5, 0.4).write(path, "t3-4096", solar=sp.RollerBlind(0.05, 0.25, 0.45, 0.35))
    return path


def test_the_straight_part_of_a_system_is_exact_in_the_table_and_in_its_split(fabric: Path, tmp_path: Path) -> None:
    system = sp.System([CLEAR, sp.Shade.load(fabric)])
    through = system.straight(ANGLES).transmittance
    holes = sp.Bsdf.load(fabric).through(ANGLES)
    glass = sp.System([CLEAR]).straight(ANGLES).transmittance
    assert through == pytest.approx(holes * glass, rel=1e-6)
    bsdf = system.bsdf("t3-1024")
    # Between the middles of columns it is interpolated.
    assert bsdf.through(-ANGLES) == pytest.approx(through, rel=0.01)
    bsdf.save_split(tmp_path / "split")
    assert sp.Bsdf.load(tmp_path / "split").through(-ANGLES) == pytest.approx(bsdf.through(-ANGLES), rel=1e-6)


def test_the_solar_band_of_a_low_e_pane_and_a_diffuser_is_the_suns_integral() -> None:
    """All rounds between the two in closed form, summed over the sun's table by fine steps."""
    table = np.loadtxt(Path(__file__).parents[1] / "crates/bsdf/data/solar_e891.txt")
    um = np.linspace(table[0, 0], table[-1, 0], 500_001)
    power = np.interp(um, *table.T)
    light = (um >= 0.38) & (um <= 0.78)
    share = power[light].sum() / power.sum()
    # Transmittance, front and back reflectance; the diffuser's transmittance and reflectance.
    panes = {True: (0.8, 0.1, 0.1), False: (0.1, 0.6, 0.7)}
    diffusers = {True: (0.2, 0.5), False: (0.4, 0.3)}
    passed = {}
    for visible, values in panes.items():
        gray = sp.System([sp.Pane((0.55,), *((value,) for value in values), curve="bronze")])
        # Half of the innermost patch, 0 to 5 degrees, lies within 3.53 degrees.
        tau, returned = gray.straight(sp.direction(3.53)).transmittance, gray.diffuse(inside=True).reflectance
        through, back = diffusers[visible]
        passed[visible] = tau * through / (1 - back * returned)
    expected = share * passed[True] + (1 - share) * passed[False]

    columns = [tuple(panes[k][i] for k in (False, False, True, True, False, False)) for i in range(3)]
    low_e = sp.Pane((0.3, 0.379999, 0.38, 0.78, 0.780001, 2.5), *columns, curve="bronze")
    solar = [share * light + (1 - share) * rest for light, rest in zip(*diffusers.values(), strict=True)]
    bands = [
        sp.Formula("lambert", transmittance=through, reflectance=back).tabulate("klems")
        for through, back in (diffusers[True], solar)
    ]
    found = sp.System([low_e, sp.Shade(*bands)]).bsdf("klems", "solar")
    assert found.hemispherical([0, 0, -1]) == pytest.approx(expected, rel=1e-3)


def test_bases_agree(fabric: Path) -> None:
    """One system through matrices of patches, and through the cells of a tree."""
    system = sp.System([CLEAR, sp.Shade.load(fabric), CLEAR])
    klems, tree = (system.bsdf(basis) for basis in ("klems", "t3-1024"))
    for mode in ("transmission", "reflection"):
        values = [bsdf.hemispherical(-ANGLES, mode, residual=True) for bsdf in (klems, tree)]
        assert values[0] == pytest.approx(values[1], rel=0.01)


def test_a_flipped_shade_shows_its_other_side(fabric: Path) -> None:
    front, back = (sp.System([sp.Shade.load(fabric, flipped=f)]).bsdf("klems-quarter") for f in (False, True))
    assert front.hemispherical(-ANGLES, "reflection") == pytest.approx(0.5, rel=1e-3)
    assert back.hemispherical(-ANGLES, "reflection") == pytest.approx(0.4, rel=1e-3)


def test_the_command_writes_both_bands(sunpeak: CommandLine, fabric: Path, tmp_path: Path) -> None:
    pane, out = tmp_path / "clear.json", tmp_path / "out.xml"
    pane.write_text(igsdb(1))
    arguments = [pane, "gap", f"{fabric}:flip", "gap", "glass:1.52,4"]
    sunpeak("bsdf", "system", *arguments, "-o", out, "--basis", "klems-quarter", "--split", tmp_path / "split")
    text = out.read_text()
    assert text.count(">Visible<") == text.count(">Solar<") == 4
    made = sp.System([CLEAR, sp.Shade.load(fabric, flipped=True), sp.Pane.from_index(1.52, 4)]).bsdf("klems-quarter")
    assert sp.Bsdf.load(tmp_path / "split").through(-ANGLES) == pytest.approx(made.through(-ANGLES))


def test_a_shade_without_solar_values_leaves_the_visible_band(sunpeak: CommandLine, tmp_path: Path) -> None:
    shade, out = tmp_path / "shade.xml", tmp_path / "out.xml"
    sp.Fabric().write(shade, "klems-quarter")
    said = sunpeak("bsdf", "system", shade, "pane:0.8,0.1,0.1", "-o", out, "--basis", "klems-quarter")
    assert "visible band alone" in said.err
    assert ">Solar<" not in out.read_text()
    with pytest.raises(sp.InputError, match="no solar values"):
        sp.System([sp.Shade.load(shade)]).bsdf("klems-quarter", "solar")


@pytest.mark.parametrize(
    ("layer", "status", "message"),
    [
        ("none.json", 1, "no such file"),
        ("glass:1.5", 2, "glass:INDEX,MM"),
        ("pane:0.8,0.3,0.1", 1, "add up to more than 1"),
        ("glass:0.5,4", 1, "index of 1 to 5"),
    ],
)
def test_wrong_layers_are_refused(sunpeak: CommandLine, tmp_path: Path, layer: str, status: int, message: str) -> None:
    said = sunpeak("bsdf", "system", layer, "-o", tmp_path / "out.xml", expect=status)
    assert message in " ".join(said.err.replace("│", " ").split())
    assert not (tmp_path / "out.xml").exists()
