"""BSDFs from scans: files, symmetry, what must come back from products in closed form."""

from pathlib import Path

import numpy as np
import pytest

import scans as synthetic
import sunpeak as sp
from conftest import CommandLine

THETAS = (0, 15, 30, 45, 60, 75)
PHONG = sp.Formula("phong", diffuse=0.2, specular=0.5, exponent=60)
HEAD = "#format: theta phi DSF\n#incident_angle 30 10\n"
CSV = "theta_in,phi_in,theta_out,phi_out,bsdf\n"
ASTM = "SAMPLE brass\nNUM_POINTS 1\nVARS theta_i,phi_i,theta_s,phi_s,BRDF\n"


def reflected_scan() -> sp.Scan:
    return synthetic.scan(synthetic.formula(PHONG), 40.0, 25.0, reflection=True)


@pytest.mark.parametrize("quantity", ["BSDF", "DSF"])
@pytest.mark.parametrize("up_deg", [90.0, 0.0])
def test_files_of_pabopto_are_read(tmp_path: Path, quantity: str, up_deg: float) -> None:
    scan = reflected_scan()
    [read] = sp.read_scans(synthetic.write_pabopto(tmp_path / "scan.txt", scan, quantity, up_deg))
    assert read.name == "weave"
    np.testing.assert_allclose(read.to_light, scan.to_light, atol=1e-7)
    np.testing.assert_allclose(read.exits, scan.exits, atol=1e-7)
    np.testing.assert_allclose(read.values, scan.values, rtol=1e-5)


def test_columns_of_cie_xyz_give_their_luminous_one(tmp_path: Path) -> None:
    path = tmp_path / "scan.txt"
    path.write_text("#format: theta phi BTDF\n#colorimetry: CIE-XYZ\n#intheta 20\n#inphi 0\n#upphi 90\n150 0 1 2 3\n")
    [scan] = sp.read_scans(path)
    assert scan.values == [2.0]
    np.testing.assert_allclose(scan.exits, [sp.direction(150, 0)], atol=1e-12)


def test_columns_in_the_manner_of_astm_are_read(tmp_path: Path) -> None:
    path = tmp_path / "brass.astm"
    path.write_text(f"{ASTM}0.5,0.1,0.7,3.0,0.25\n")
    [scan] = sp.read_scans(path)
    assert scan.name == "brass"
    np.testing.assert_allclose(scan.to_light, sp.direction(np.degrees(0.5), np.degrees(0.1)), atol=1e-12)
    np.testing.assert_allclose(scan.exits, [sp.direction(np.degrees(0.7), np.degrees(3.0))], atol=1e-12)
    # A BTDF's exits may be told from the normal of the side on which light leaves; weights of Radiance for R, G, B.
    path.write_text("ANGLE_UNITS degrees\nTYPE BTDF\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\n30,0,20,180,1,2,4\n")
    [scan] = sp.read_scans(path)
    np.testing.assert_allclose(scan.exits, [sp.direction(160, 180)], atol=1e-12)
    assert scan.values == pytest.approx([0.265 + 2 * 0.670 + 4 * 0.065])


def test_tables_with_commas_are_read_in_any_order(tmp_path: Path) -> None:
    path = tmp_path / "scan.csv"
    path.write_text(
        "# a remark\ndsf, theta_in,phi_in,theta_out,phi_out\n0.1,30,0,60,180\n0.2,0,0,0,0\n0.3,30,0,45,180\n"
    )
    first, second = sp.read_scans(path)
    np.testing.assert_allclose(first.values, [0.2, 0.3 * np.sqrt(2)])
    np.testing.assert_allclose(second.to_light, [0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no readings; expected lines of angles and a value"),
        ("30 0 0.1\n", "no '#format:'; expected '#format: theta phi DSF' or BSDF"),
        ("#format: theta phi\n30 0 0.1\n", ":1: #format: theta phi; expected 'theta phi DSF'"),
        ("#format: theta phi BSDF\n30 0 0.1\n", "no incidence; expected '#incident_angle THETA PHI'"),
        ("#incident_angle 30\n30 0 0.1\n", ":1: #incident_angle 30; expected two angles"),
        ("#incident_angle 90 0\n#format: theta phi BSDF\n30 0 1\n", ":1: angle of incidence is 90; expected half a"),
        (f"{HEAD}30 0\n", ":3: 2 numbers; expected 3: theta, phi and the value"),
        (f"{HEAD}30 0 0.1\n30 0 x\n", ":4: 'x'; expected a number"),
        (f"{HEAD}30 0 nan\n", ":3: nan; expected a finite number"),
        (f"{HEAD}190 0 0.1\n", ":3: angle of exit is 190; expected 0 to 180 degrees"),
        (f"#colorimetry: CIE-Lab\n{HEAD}30 0 0.1\n", ":1: #colorimetry: CIE-Lab; expected CIE-Y or CIE-XYZ"),
        (CSV.replace("phi_in,", ""), ":1: no column 'phi_in'; expected theta_in,phi_in,theta_out,phi_out and bsdf"),
        (CSV.replace("bsdf", "bsdf,dsf"), ":1: 2 columns of values"),
        (CSV.replace("bsdf", "bsdf,error"), ":1: 6 columns; expected"),
        (f"{CSV}30,0,20,180\n", ":2: 4 numbers; expected 5, as the first line names"),
        (f"{ASTM}0.5,0,0.7,3,0.2\n0.5,0,0.7,3.1,0.2\n", ":2: NUM_POINTS 1, and 2 readings; expected as many"),
        (f"{ASTM}0.5,0,2.7,3,0.2\n", ":4: theta_s is 154.69"),
        (ASTM.replace("BRDF", "450nm,550nm"), ":3: VARS theta_i,phi_i,theta_s,phi_s,450nm,550nm: several values"),
        (ASTM.replace("theta_i", "a"), "other columns; expected theta_i,phi_i,theta_s,phi_s"),
        (f"ANGLE_UNITS gon\n{ASTM}", ":1: ANGLE_UNITS gon; expected degrees or radians"),
    ],
)
def test_what_is_wrong_with_a_file_is_said_with_its_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "scan.txt"
    path.write_text(text)
    with pytest.raises(sp.InputError) as raised:
        sp.read_scans(path)
    assert str(raised.value).startswith(str(path))
    assert message in str(raised.value)


@pytest.mark.parametrize("basis", ["klems", "klems-quarter", "t3-1024", "t4-256"])
def test_a_diffuser_comes_back_at_every_incidence(basis: str) -> None:
    matt = synthetic.formula(sp.Formula("lambert", reflectance=0.6))
    made = sp.measured_bsdf(synthetic.scans(matt, THETAS, reflection=True), basis)
    angles = [1, 20, 37, 52, 70, 85], [0, 40, 80, 170, 200, 300]
    np.testing.assert_allclose(made.bsdf.hemispherical(sp.direction(*angles), "reflection"), 0.6, rtol=1e-6)
    values = made.bsdf.evaluate(sp.direction(*angles), sp.direction([10, 30, 50, 60, 70, 80], 5.0))
    np.testing.assert_allclose(values, 0.6 / np.pi, rtol=1e-6)
    assert not made.bsdf.through([[0, 0, 1]]).any()


def test_lobes_lie_and_shine_as_they_should_where_nothing_was_measured() -> None:
    measured = synthetic.scans(synthetic.formula(PHONG), range(0, 81, 10), reflection=True)
    made = sp.measured_bsdf(measured, "t3", resolution=32).bsdf
    # Means of the formula over the same cells.
    truth = PHONG.tabulate("t3", 32)
    for theta in (5.0, 25.0, 35.0, 55.0, 65.0):
        light = sp.direction(theta, 0.0)
        whole = truth.hemispherical(light, "reflection")
        assert made.hemispherical(light, "reflection") == pytest.approx(whole, rel=0.02), theta
        apart = mean_direction(made.evaluate, light) @ mean_direction(truth.evaluate, light)
        assert np.degrees(np.arccos(min(apart, 1.0))) < 0.5, theta
        mirrored = light * [-1, -1, 1]
        assert made.evaluate(light, mirrored) == pytest.approx(truth.evaluate(light, mirrored), rel=0.15), theta


def test_what_is_smooth_stays_smooth_between_incidences() -> None:
    """Lobes that move do not add up to a plane: what is wide is blended in its place."""

    def plane(light: np.ndarray, out: np.ndarray) -> np.ndarray:
        return 0.2 + 0.1 * out[:, 0]

    made = sp.measured_bsdf(synthetic.scans(plane, (20, 40, 60), reflection=True), "t3", resolution=64).bsdf
    out = lobe_grid()[::7]
    # A cell is 1.5 % of the plane wide; towards the rim readings lie far apart on the disk.
    seen = out[out[:, 2] > np.cos(np.radians(70.0))]
    for theta in (30.0, 50.0):
        light = sp.direction(theta, 0.0)
        apart = made.evaluate(light, seen) / plane(light[0], seen) - 1.0
        assert np.abs(apart).max() < 0.04, theta
        assert np.sqrt((apart**2).mean()) < 0.01, theta
        assert made.hemispherical(light, "reflection") == pytest.approx(0.2 * np.pi, rel=5e-3)


def lobe_grid() -> np.ndarray:
    """Points even in projected solid angle."""
    radius = np.sqrt((np.arange(200) + 0.5) / 200)[:, None]
    turn = (2 * np.pi * (np.arange(400) + 0.5) / 400)[None, :]
    parts = np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1 - radius**2))
    return np.stack(parts, axis=-1).reshape(-1, 3)


def mean_direction(bsdf: synthetic.Bsdf, light: np.ndarray) -> np.ndarray:
    """The mean direction of what stands above the floor, by flux."""
    out = lobe_grid()
    values = bsdf(light, out)
    mean = ((values - values.min())[:, None] * out).sum(axis=0)
    return mean / np.linalg.norm(mean)


FWHM_DEG = 1.5


@pytest.fixture(scope="module")
def fabric_scans() -> list[sp.Scan]:
    thetas = (0, 10, 20, 30, 40, 50, 60, 66)
    return synthetic.scans(synthetic.fabric(FWHM_DEG), thetas, (180.0,), reflection=False)


def ring(theta_deg: float) -> np.ndarray:
    """Incidences that are even over the ring of Klems's full basis around an angle."""
    low, high = np.sin(np.radians([theta_deg - 5.0, theta_deg + 5.0])) ** 2
    return sp.direction(np.degrees(np.arcsin(np.sqrt(low + (np.arange(20) + 0.5) / 20 * (high - low)))))


@pytest.mark.parametrize("basis", ["klems", "t3-1024"])
def test_what_goes_straight_through_a_fabric_comes_back_as_a_peak(
    basis: str, fabric_scans: list[sp.Scan], tmp_path: Path
) -> None:
    made = sp.measured_bsdf(fabric_scans, basis, instrument_fwhm_deg=FWHM_DEG)
    [part] = made.parts
    expected = [synthetic.FABRIC.through(np.radians(theta)) for theta in part.theta_deg]
    np.testing.assert_allclose(part.through, expected, rtol=0.01)
    theta = np.array([10.0, 20, 30, 40, 50])
    light = sp.direction(theta, 110.0)
    truth = [synthetic.FABRIC.through(t) for t in np.radians(theta)]
    np.testing.assert_allclose(made.bsdf.through(light), truth, rtol=0.02)
    scattered = synthetic.fabric_scatters
    means = [
        np.mean([synthetic.hemispherical(scattered, w, reflection=False, rings=100) for w in ring(t)]) for t in theta
    ]
    # A cell's mean: of a patch 10 degrees wide, or of a ring of the tree, a fifth of that.
    np.testing.assert_allclose(made.bsdf.hemispherical(light, residual=True), means, rtol=0.02)
    made.save_split(tmp_path / "split")
    made.save(tmp_path / "fabric.xml", name="weave")
    kept, table = sp.Bsdf.load(tmp_path / "split"), sp.Bsdf.load(tmp_path / "fabric.xml")
    np.testing.assert_allclose(kept.through(light), made.bsdf.through(light), rtol=1e-6)
    # The file alone has the peak in its cells: no flux is lost.
    np.testing.assert_allclose(table.hemispherical(light), kept.hemispherical(light), rtol=1e-5)
    assert table.describe()["name"] == "weave"
    assert "a peak of the instrument's width at 8 of 8 incidences" in table.describe()["comments"]


def test_what_is_mirrored_is_as_sharp_as_the_cells() -> None:
    """A matt floor of 20 % under a coat that mirrors 4 %, more towards grazing incidence (Schlick)."""

    def mirrored(light: np.ndarray) -> float:
        return float(0.04 + 0.96 * (1.0 - light[2]) ** 5)

    def seen(light: np.ndarray, out: np.ndarray) -> np.ndarray:
        return 0.2 / np.pi + mirrored(light) * synthetic.instrument(light * [-1.0, -1.0, 1.0], out, FWHM_DEG)

    measured = synthetic.scans(seen, (0, 15, 30, 45, 60), reflection=True)
    made = sp.measured_bsdf(measured, "t3-4096", instrument_fwhm_deg=FWHM_DEG)
    [part] = made.parts
    np.testing.assert_allclose(part.through, [mirrored(scan.to_light) for scan in measured], rtol=0.01)
    assert "front reflection: a peak of the instrument's width at 5 of 5 incidences, R 0.0" in made.summary()
    for light in sp.direction([10.0, 25.0, 40.0], 33.0):
        whole = 0.2 + mirrored(light)
        assert made.bsdf.hemispherical(light, "reflection") == pytest.approx(whole, rel=0.02)
        # Beside the cells of the mirrored direction, where the instrument still saw its light.
        beside = sp.direction(np.degrees(np.arccos(light[2])), 33.0 + 180.0 + 12.0)
        assert made.bsdf.evaluate(light, beside) == pytest.approx(0.2 / np.pi, rel=0.05)


def test_without_the_width_nothing_is_told_apart(fabric_scans: list[sp.Scan]) -> None:
    made = sp.measured_bsdf(fabric_scans, "t3", resolution=32)
    assert "not stated" in made.summary()
    light = sp.direction([15.0, 45.0])
    whole = [
        synthetic.hemispherical(synthetic.fabric_scatters, w, reflection=False)
        + synthetic.FABRIC.through(float(np.arccos(w[2])))
        for w in light
    ]
    np.testing.assert_allclose(made.bsdf.hemispherical(light), whole, rtol=0.03)


def test_a_scatterer_is_not_taken_for_a_peak() -> None:
    scatters = synthetic.scans(lambda light, out: synthetic.fabric_scatters(light, out, 0.1), (0, 50), reflection=False)
    made = sp.measured_bsdf(scatters, "klems-quarter", instrument_fwhm_deg=FWHM_DEG)
    assert np.isnan(made.parts[0].through).all()
    assert not made.bsdf.through(sp.direction([5.0, 35.0])).any()
    assert "no lobe as narrow as the instrument's" in made.summary()


def test_a_bare_beam_tells_the_width(fabric_scans: list[sp.Scan], tmp_path: Path) -> None:
    beam = synthetic.scan(lambda light, out: 5.0 * synthetic.instrument(-light, out, 1.2), 0.0, 0.0, reflection=False)
    assert beam.beam_fwhm_deg() == pytest.approx(1.2, rel=0.01)
    with pytest.raises(sp.InputError, match="no beam"):
        reflected_scan().beam_fwhm_deg()
    with pytest.raises(sp.InputError, match="expected one of them"):
        sp.measured_bsdf(fabric_scans, beam=beam, instrument_fwhm_deg=1.0)


WARD = sp.Formula("wgmd", diffuse=0.2, specular=0.2, roughness_x=0.1, roughness_y=0.25)


@pytest.mark.parametrize(
    ("phis", "symmetry"),
    [((0, 45, 90), "quadrilateral"), ((0, 45, 90, 135, 180), "bilateral (above and below alike)")],
)
def test_mirrored_incidences_follow_from_those_measured(phis: tuple[float, ...], symmetry: str) -> None:
    scans = synthetic.scans(synthetic.formula(WARD), (0, 35, 65), phis, reflection=True, step_deg=5.0)
    made = sp.measured_bsdf(scans, "t4", resolution=16)
    assert made.parts[0].symmetry == symmetry
    # Means of the formula over the same cells.
    truth = WARD.tabulate("t4", 16)
    for theta, phi in [(12.0, 200.0), (35.0, 290.0), (60.0, 250.0), (40.0, 20.0), (40.0, 110.0)]:
        light = sp.direction(theta, phi)
        whole = truth.hemispherical(light, "reflection")
        assert made.bsdf.hemispherical(light, "reflection") == pytest.approx(whole, rel=0.04), (theta, phi)
        apart = mean_direction(made.bsdf.evaluate, light) @ mean_direction(truth.evaluate, light)
        assert np.degrees(np.arccos(min(apart, 1.0))) < 3.0, (theta, phi)


def test_symmetry_has_to_fit_what_was_measured() -> None:
    measured = synthetic.scans(synthetic.formula(PHONG), (0, 50), (0.0, 90.0), reflection=True, step_deg=6.0)
    with pytest.raises(sp.InputError, match="enough for quadrilateral alone"):
        sp.measured_bsdf(measured, symmetry="bilateral")
    with pytest.raises(sp.InputError, match="which a t3 basis cannot hold"):
        sp.measured_bsdf(measured, "t3-256")
    made = sp.measured_bsdf(measured, "t3-256", symmetry="isotropic")
    assert made.parts[0].symmetry == "isotropic"


def test_more_light_than_comes_in_is_refused_or_scaled() -> None:
    bright = synthetic.scans(synthetic.formula(sp.Formula("lambert", reflectance=0.7)), (0, 40, 80), reflection=True)
    clear = synthetic.scans(
        synthetic.formula(sp.Formula("lambert", reflectance=0.0, transmittance=0.5)), (0, 40, 80), reflection=False
    )
    with pytest.raises(sp.InputError, match=r"front: transmittance and reflectance add up to 1\.2000 at .* degrees"):
        sp.measured_bsdf([*bright, *clear], "klems-quarter")
    made = sp.measured_bsdf([*bright, *clear], "klems-quarter", energy="scale")
    light = sp.direction([10.0, 50.0])
    np.testing.assert_allclose(made.bsdf.hemispherical(light, "reflection"), 0.7 / 1.2, rtol=1e-5)
    np.testing.assert_allclose(made.bsdf.hemispherical(light, "transmission"), 0.5 / 1.2, rtol=1e-5)
    assert "scaled to 1 in 41 incident cells" in made.summary()


def test_what_was_not_measured_is_said() -> None:
    shadowed = synthetic.scan(synthetic.formula(PHONG), 30.0, 0.0, reflection=True)
    light = shadowed.to_light
    seen = (shadowed.exits @ light < np.cos(np.radians(12.0))) & (shadowed.exits[:, 2] > 0.2)
    made = sp.measured_bsdf([sp.Scan(light, shadowed.exits[seen], shadowed.values[seen])], "klems-quarter")
    said = made.summary()
    assert "no incidence past 30 degrees" in said
    assert "exits end at 7" in said
    [part] = made.parts
    assert part.hole_deg[0] == pytest.approx(12.0, abs=2.0)
    assert part.hole_exit_deg[0] == pytest.approx(30.0, abs=2.0)


def test_the_command_writes_table_and_split(fabric_scans: list[sp.Scan], sunpeak: CommandLine, tmp_path: Path) -> None:
    for k, scan in enumerate(fabric_scans):
        synthetic.write_pabopto(tmp_path / f"scan_{k}.txt", scan, "DSF")
    files = sorted(tmp_path.glob("scan_*.txt"))
    options = "-o", tmp_path / "out.xml", "--basis", "t3", "--resolution", "32", "--split", tmp_path / "split"
    done = sunpeak("bsdf", "measured", *files, *options, "--instrument-fwhm", FWHM_DEG)
    assert "front transmission: isotropic, 8 incidences of 0 to 66 degrees" in done.err
    light = sp.direction([20.0])
    assert sp.Bsdf.load(tmp_path / "split").through(light) == pytest.approx(
        synthetic.FABRIC.through(np.radians(20)), rel=0.02
    )
    assert sp.Bsdf.load(tmp_path / "out.xml").describe()["name"] == "weave"
    (tmp_path / "bad.txt").write_text("#format: theta phi DSF\nx\n")
    failed = sunpeak("bsdf", "measured", tmp_path / "bad.txt", "-o", tmp_path / "bad.xml", expect=1)
    assert "bad.txt" in failed.err
    assert not (tmp_path / "bad.xml").exists()
    sunpeak("bsdf", "measured", files[0], "-o", tmp_path / "bad.xml", "--instrument-fwhm", "wide", expect=2)
