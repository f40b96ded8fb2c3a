"""Studies: closed forms from outside, tables that say what was found, files that are whole or absent."""

import json
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine, Radiance
from sunpeak import _core
from sunpeak.studies.peaks import FABRIC_BASES, Plan, Row, blurred, decoy, measure, scatterer
from sunpeak.studies.peaks_report import markdown
from sunpeak.studies.products import EXACT, Product, Seen, decoys, fabrics, panel, see_through
from sunpeak.studies.radiance_through import through_by_radiance

LIMITS = {
    "t3-16384": 0.0005,
    "t3-4096": 0.0015,
    "t3-1024": 0.006,
    "t4-1024": 0.006,
    "klems": 0.015,
    "klems-half": 0.03,
    "klems-quarter": 0.05,
}
"""Mean error of T that the split may have on fabrics of the family [-]."""


@pytest.mark.parametrize("basis", FABRIC_BASES)
def test_the_split_beats_rule_2_run_through_radiance_itself(basis: str, radiance: Radiance) -> None:
    """Fabrics drawn anew, the same table for both; no miss, and the interval holds the truth."""
    row = measure(Plan(fabrics=2, directions=150), "fabrics", "fabrics", fabrics(2, seed=2026), basis)
    ours, theirs = row.scores["split"], row.scores["Radiance"]
    assert ours.error < LIMITS[basis]
    assert ours.missed == 0
    assert ours.error < 0.5 * theirs.error
    assert row.holds is not None
    assert row.holds >= 0.95
    # Our own reading of rule 2 is Radiance's.
    assert row.scores["radiance"].error == pytest.approx(theirs.error, rel=0.01, abs=1e-4)


def by_name(name: str) -> Product:
    """One of the products that one can see through."""
    return next(product for product in see_through() if product.name == name)


def test_closed_forms_are_those_of_the_textbooks() -> None:
    normal = sp.direction([0.0])
    glass = by_name("clear glass")
    # Fresnel at normal incidence, all orders: 2n / (n² + 1).
    assert glass.through(normal)[0] == pytest.approx(2 * 1.52 / (1.52**2 + 1), rel=1e-12)
    sheet = by_name("perforated sheet, 20 % open")
    assert sheet.through(normal)[0] == pytest.approx(0.2, rel=1e-12)
    assert sheet.through(sp.direction([np.degrees(np.arctan(2.0)) + 0.01]))[0] == 0.0
    blind = by_name("venetian blind, slats at 20°")
    # Slats 1.1 wide and 1 apart at 20 degrees: 1 - 1.1 sin 20° stays open.
    assert blind.through(normal)[0] == pytest.approx(1 - 1.1 * np.sin(np.radians(20)), rel=1e-12)
    # A line of sight has no direction: both ends see the same.
    w_in = blind.directions(50, seed=1)
    np.testing.assert_allclose(blind.through(w_in), blind.through(-w_in), rtol=1e-12)


def test_the_blind_is_met_from_both_sides_as_the_table_has_it() -> None:
    blind = by_name("venetian blind, slats at 20°")
    bsdf, w_in = blind.tabulate("t4-1024"), blind.directions(300, seed=2)
    truth = blind.through(w_in)
    open_there = truth > 0.3
    off = np.abs(bsdf.through(w_in)[open_there] / truth[open_there] - 1)
    assert off.mean() < 0.015
    turned = w_in * np.array([1.0, -1.0, 1.0])
    assert np.abs(bsdf.through(turned)[open_there] / truth[open_there] - 1).mean() > 0.2


@pytest.mark.parametrize(("product", "basis"), [(panel(5.0), "t3-4096"), (decoys()[0], "klems")])
def test_scatterers_that_the_basis_resolves_are_left_alone(product: Product, basis: str) -> None:
    row = decoy(Plan(directions=60, radiance=False), product, basis)
    assert row.more["cells_at_normal"] > 2
    assert row.scores["split"].taken == 0


def test_a_panel_of_5_degrees_looks_like_glass_to_every_rule_in_klems_and_the_report_says_so() -> None:
    row = decoy(Plan(directions=60, radiance=False), panel(5.0), "klems")
    assert row.more["cells_at_normal"] < 1
    assert min(score.taken for score in row.scores.values()) > 50
    peak = panel(5.0).tabulate("klems").peak_report().peak("front")
    assert peak is not None
    assert peak.verdict.use == "if one can see through it"


def test_a_blurred_peak_comes_back_and_a_scatterer_stays() -> None:
    row = blurred(Plan(directions=80), "t3-1024", 2.0)
    assert row.scores["split"].error > 0.2
    assert row.scores["given"].error < 0.05
    assert row.scores["found"].error < 0.05
    assert row.more["found_deg"] == pytest.approx(2.0, rel=0.1)
    assert scatterer("t3-1024", 2.0).more["found_deg"] is None


def test_the_report_says_when_a_lobe_looks_like_an_instrument(sunpeak: CommandLine, tmp_path: Path) -> None:
    product = fabrics(1, seed=5)[0]
    for name, seen in (("sharp", EXACT), ("blurred", Seen(fwhm_deg=1.0))):
        text = _core.bsdf_xml(product.tabulate("t3-1024", seen)._core)
        (tmp_path / f"{name}.xml").write_text(text, encoding="utf-8")
    assert sp.Bsdf.load(tmp_path / "blurred.xml").instrument_seen() == pytest.approx(1.0, rel=0.1)
    found = {name: sunpeak("bsdf", "info", tmp_path / f"{name}.xml").out for name in ("sharp", "blurred")}
    assert "--instrument-fwhm" not in found["sharp"]
    assert "--instrument-fwhm 0.9" in found["blurred"] or "--instrument-fwhm 1" in found["blurred"]


def test_radiance_sees_what_our_reading_of_its_rule_sees(radiance: Radiance) -> None:
    product = fabrics(1, seed=5)[0]
    bsdf, w_in = product.tabulate("klems"), product.directions(100, seed=6)
    theirs = through_by_radiance(bsdf, w_in)
    assert theirs is not None
    np.testing.assert_allclose(bsdf.through(w_in, "radiance"), theirs, rtol=4e-4, atol=1e-5)


def test_the_table_has_a_line_for_each_row() -> None:
    row = measure(Plan(1, 20, radiance=False), "products", "clear glass", [by_name("clear glass")], "klems")
    text = markdown([row, Row("scatterers", "panel", "klems", 0, {}, more={"found_deg": None})])
    assert "| clear glass | klems |" in text
    assert "Radiance itself" not in text, "a column that nobody fills"
    assert "| panel | klems | none |" in text


def test_the_command_writes_both_files(sunpeak: CommandLine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from sunpeak.cli import study  # noqa: PLC0415
    from sunpeak.studies import peaks  # noqa: PLC0415

    monkeypatch.setattr(peaks, "all_jobs", lambda plan: [lambda: scatterer("t3-1024", 1.0)])
    study.peaks(output=tmp_path / "out", quiet=True, radiance=False)
    found = json.loads((tmp_path / "out/peaks.json").read_text(encoding="utf-8"))
    assert [row["part"] for row in found] == ["scatterers"]
    assert "FWHM found" in (tmp_path / "out/peaks.md").read_text(encoding="utf-8")
    assert "sunpeak study peaks" in sunpeak("study", "peaks", "--help").out


def test_measured_peaks_by_command_line_split_and_back(sunpeak: CommandLine, tmp_path: Path) -> None:
    """The width goes into the split's files, and a scene can name them; what is read back is the same."""
    sp.Fabric(openness=0.03).write(tmp_path / "sharp.xml", "t3-1024")
    xml = tmp_path / "sharp.xml"
    sunpeak("bsdf", "split", xml, "-o", tmp_path / "split", "--instrument-fwhm", "1.5")
    back = sp.Bsdf.load(tmp_path / "split")
    given = sp.Bsdf.load(xml, instrument_fwhm_deg=1.5)
    assert back.describe()["components"][0]["instrument_fwhm_deg"] == 1.5
    w_in = sp.direction(np.linspace(0, 80, 30), np.linspace(0, 300, 30))
    np.testing.assert_allclose(back.through(w_in), given.through(w_in), rtol=1e-12)
    np.testing.assert_allclose(
        back.hemispherical(w_in, residual=True) + 0.0, given.hemispherical(w_in, residual=True), rtol=1e-6
    )
    assert "widened to 1.5 degrees" in sunpeak("bsdf", "info", xml, "--instrument-fwhm", "1.5").out
    assert "none" not in sunpeak("bsdf", "info", xml, "--instrument-fwhm", "find").err
    for wrong in ("0", "90", "wide"):
        assert "expected" in sunpeak("bsdf", "info", xml, "--instrument-fwhm", wrong, expect=2).err
    said = sunpeak("bsdf", "through", tmp_path / "split", "--instrument-fwhm", "1", expect=1).err
    assert "split already" in said
    with pytest.raises(sp.InputError, match=r"expected 0\.05 to 20"):
        sp.Bsdf.load(xml, instrument_fwhm_deg=45.0)
