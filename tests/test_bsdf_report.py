"""Reports on BSDFs against the closed forms of fabrics, splits as files, and pictures that are pictures."""

import csv
import json
import math
import struct
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine
from sunpeak.bsdf_draw import disc, log_limits
from sunpeak.bsdf_plot import plot_bsdf

BASES = ["klems", "klems-half", "klems-quarter", "t3-1024", "t3-4096", "t4-256"]
FILES = {"residual.xml", "peak.json", "peak.csv", "ledger.csv"}
FABRIC = sp.Fabric()


def fabric(folder: Path, basis: str, **properties: float) -> sp.Bsdf:
    path = folder / f"{basis}.xml"
    sp.Fabric(**properties).write(path, basis)
    return sp.Bsdf.load(path)


def directions(count: int, seed: int) -> np.ndarray:
    """Over the whole sphere."""
    random = np.random.default_rng(seed)
    return sp.direction(np.degrees(np.arccos(random.uniform(-1, 1, count))), random.uniform(0, 360, count))


def assert_same(one: sp.Bsdf, other: sp.Bsdf, tolerance: float) -> None:
    w_in, w_out = directions(2000, seed=1), directions(2000, seed=2)
    for residual in (False, True):
        np.testing.assert_allclose(
            other.evaluate(w_in, w_out, colour=True, residual=residual),
            one.evaluate(w_in, w_out, colour=True, residual=residual),
            rtol=tolerance,
            atol=tolerance,
        )
        straight = (w_in, -w_in)
        np.testing.assert_allclose(
            other.evaluate(*straight, residual=residual), one.evaluate(*straight, residual=residual), rtol=tolerance
        )
    np.testing.assert_array_equal(other.through(w_in, colour=True), one.through(w_in, colour=True))
    np.testing.assert_array_equal(other.evidence(w_in), one.evidence(w_in))


def sound_files(shared: Path) -> list[Path]:
    return [path for path in sorted((shared / "bsdf").glob("*.xml")) if path.stem not in {"not-xml", REFUSED}]


REFUSED = "short-matrix_must-be-refused"


def test_splits_of_real_files_read_back_the_same(shared: Path, tmp_path: Path) -> None:
    for path in sound_files(shared):
        bsdf, folder = sp.Bsdf.load(path), tmp_path / path.stem
        assert {written.name for written in bsdf.save_split(folder)} == FILES
        # Colour goes through chromaticities of 32 bits.
        tolerance = 3e-6 if "xyz" in path.stem else 0.0
        assert_same(bsdf, sp.Bsdf.load(folder), tolerance)
        assert_same(bsdf, sp.Bsdf.load(folder / "peak.json"), tolerance)


@pytest.mark.parametrize("basis", BASES)
def test_splits_of_fabrics_read_back_the_same(basis: str, tmp_path: Path) -> None:
    bsdf = fabric(tmp_path, basis)
    bsdf.save_split(tmp_path / "split")
    assert_same(bsdf, sp.Bsdf.load(tmp_path / "split"), 0.0)


def test_the_csv_files_say_what_the_json_file_says(tmp_path: Path) -> None:
    bsdf = fabric(tmp_path, "klems-quarter")
    bsdf.save_split(tmp_path / "split")
    about = json.loads((tmp_path / "split" / "peak.json").read_text())
    with (tmp_path / "split" / "peak.csv").open() as file:
        rows = list(csv.DictReader(file))
    with (tmp_path / "split" / "ledger.csv").open() as file:
        ledger = list(csv.DictReader(file))
    columns = [column for side in about["sides"] for column in side["columns"]]
    assert len(columns) == len(rows) == len(ledger) == 2 * 41
    for column, row, entry in zip(columns, rows, ledger, strict=True):
        assert float(row["through"]) == column["through"]
        assert [float(row["theta_min_deg"]), float(row["theta_max_deg"])] == column["theta_bounds_deg"]
        assert float(entry["table"]) == pytest.approx(float(entry["residual"]) + float(entry["through"]), rel=2e-6)
    # Patch 1 of Klems quarter: 9 to 27 degrees, 8 azimuths.
    front = next(side for side in about["sides"] if side["met_by_rays_at"] == "front")
    patch = front["columns"][1]
    assert (patch["theta_deg"], patch["phi_deg"]) == (pytest.approx(18), pytest.approx(0))
    np.testing.assert_allclose(patch["phi_bounds_deg"], [-22.5, 22.5])
    w_in = sp.side_of_ray(*[[column[key] for column in front["columns"]] for key in ("theta_deg", "phi_deg")])
    np.testing.assert_allclose(bsdf.evidence(w_in).through, [column["through"] for column in front["columns"]])


def test_a_changed_residual_is_refused(tmp_path: Path) -> None:
    fabric(tmp_path, "klems-quarter").save_split(tmp_path / "split")
    path = tmp_path / "split" / "residual.xml"
    path.write_text(path.read_text().replace("Other", "Others"))
    with pytest.raises(sp.InputError, match=r"peak\.json: .*checksum differs.*split the product again"):
        sp.Bsdf.load(tmp_path / "split")


def test_a_missing_split_names_the_file(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(FileNotFoundError, match=r"peak\.json"):
        sp.Bsdf.load(tmp_path / "empty")


def mean_through() -> float:
    """T under a uniform sky: the integral of T(theta) sin(2 theta)."""
    theta = (np.arange(20_000) + 0.5) * math.pi / 2 / 20_000
    through = np.array([FABRIC.through(t) for t in theta])
    return float(np.sum(through * np.sin(2 * theta)) * math.pi / 2 / 20_000)


@pytest.mark.parametrize("basis", BASES)
def test_a_fabric_is_reported_as_it_was_made(basis: str, tmp_path: Path) -> None:
    report = fabric(tmp_path, basis).peak_report()
    assert all(side.is_sound for side in report.sides)
    assert [peak.side for peak in report.peaks] == ["front", "back"]
    coarse = basis.startswith("klems") or basis == "t4-256"
    for peak in report.peaks:
        assert peak.openness == pytest.approx(FABRIC.openness, rel=0.05 if coarse else 0.006)
        low, high = peak.openness_interval
        assert low <= FABRIC.openness <= high
        within_cut_off = math.sin(math.radians(FABRIC.cut_off_deg)) ** 2
        assert peak.share_of_incidences == pytest.approx(within_cut_off, abs=0.15 if coarse else 0.07)
        straight = mean_through()
        share = straight / (straight + FABRIC.scattered)
        assert peak.extracted_share_diffuse == pytest.approx(share, rel=0.05 if coarse else 0.01)
    for side in report.sides:
        assert side.angles[3].theta_deg == 30
        passes = FABRIC.through(math.radians(30)) + FABRIC.scattered
        assert side.angles[3].transmittance.mean == pytest.approx(passes, rel=0.05 if coarse else 0.02)
        assert side.angles[3].reflectance.mean == pytest.approx(FABRIC.reflectance, rel=1e-5)
        assert side.largest_sum == pytest.approx(FABRIC.openness + FABRIC.scattered + FABRIC.reflectance, abs=1e-3)


def test_a_diffuse_fabric_is_reciprocal(tmp_path: Path) -> None:
    """With a lobe it is not: the lobe is normalised for each incidence."""
    for basis in ("klems", "t3-1024"):
        report = fabric(tmp_path, basis, lobe_share=0.0).peak_report()
        assert len(report.reciprocity) == 4
        for check in report.reciprocity:
            assert check.largest_difference < 2e-3, check
        assert report.warnings() == []


CELLS_A_SIDE = {"t3-1024": 32, "t3-4096": 64, "t4-256": 16}


@pytest.mark.parametrize("basis", CELLS_A_SIDE)
def test_the_narrowest_lobe_is_two_cells_wide(basis: str, tmp_path: Path) -> None:
    peak = fabric(tmp_path, basis).peak_report().peaks[0]
    cell = math.degrees(math.sqrt(math.pi)) / CELLS_A_SIDE[basis]
    assert peak.narrowest_lobe_deg == pytest.approx(2 * cell, rel=2e-3)


def test_verdicts(tmp_path: Path) -> None:
    fine = fabric(tmp_path, "t3-4096").peak_report().peaks[0].verdict
    assert fine.use == "yes"
    assert "the peak is taken up to 6" in fine.text
    assert "a lobe wider than 3.2 degrees" in fine.text
    coarse = fabric(tmp_path, "klems").peak_report().peaks[0].verdict
    assert coarse.use == "if one can see through it"
    assert "cannot tell a hole from a scatterer narrower than 17.7 degrees" in coarse.text
    none = fabric(tmp_path, "klems", openness=0.0).peak_report().peaks[0].verdict
    assert none.use == "no"
    assert "see-through part" in none.text


def test_verdicts_of_real_files(shared: Path) -> None:
    def verdict(name: str) -> tuple[str, str]:
        answer = sp.Bsdf.load(shared / "bsdf" / f"{name}.xml").peak_report().peaks[0].verdict
        return answer.use, answer.text

    assert verdict("diffusing-panel_klems-full")[0] == "no"
    assert verdict("clear-glass_t4-4096")[0] == "yes"
    # "Diffuse" glass, and one patch peaks: the paper's warning.
    use, text = verdict("diffuse-glass_klems-full")
    assert use == "if one can see through it"
    assert "translucent panel" in text


def test_too_much_light_is_a_finding(tmp_path: Path) -> None:
    path = tmp_path / "bright.xml"
    sp.Fabric(openness=0.05, scattered=0.2, reflectance=0.75).write(path, "klems")
    reflected = f"{np.float32(0.75 / math.pi):e}".rstrip("0")
    text = path.read_text()
    value = next(word for word in text.split() if word.startswith("2.387"))
    assert reflected.startswith("2.387")
    path.write_text(text.replace(value, "3.0e-1,"))
    report = sp.Bsdf.load(path).peak_report()
    assert not report.sides[0].is_sound
    assert any("add up to 1." in finding for finding in report.warnings())


def test_reports_are_json(shared: Path) -> None:
    for path in sound_files(shared):
        about = sp.Bsdf.load(path).peak_report().to_dict()
        text = json.dumps(about, allow_nan=False)
        assert {"tables", "hemispherical", "energy", "reciprocity", "peak", "warnings"} <= json.loads(text).keys()


def png_size(path: Path) -> tuple[int, int]:
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", head[16:24])
    return width, height


@pytest.mark.parametrize("basis", ["klems-quarter", "t3-1024", "t4-64"])
@pytest.mark.parametrize("kind", ["exit", "through", "profile", "all"])
def test_pictures_are_pictures(basis: str, kind: str, tmp_path: Path) -> None:
    bsdf = fabric(tmp_path, basis)
    written = plot_bsdf(bsdf, tmp_path / kind, theta_deg=30, phi_deg=100, kind=kind)  # type: ignore[arg-type]
    assert [path.suffix for path in written] == [".png", ".svg"]
    assert min(png_size(written[0])) > 500
    root = ElementTree.fromstring(written[1].read_text())
    assert root.tag.endswith("svg")
    assert {path.name for path in tmp_path.iterdir()} == {f"{basis}.xml", f"{kind}.png", f"{kind}.svg"}


def test_pictures_from_behind_and_without_a_peak(tmp_path: Path) -> None:
    for name, bsdf, theta in (
        ("behind", fabric(tmp_path, "t3-256"), 150.0),
        ("none", fabric(tmp_path, "klems", openness=0.0, lobe_share=0.0), 0.0),
    ):
        (written,) = plot_bsdf(bsdf, tmp_path / f"{name}.png", theta_deg=theta)
        assert min(png_size(written)) > 500


def test_the_same_bsdf_gives_the_same_picture(tmp_path: Path) -> None:
    bsdf = fabric(tmp_path, "klems-quarter")
    first, second = (plot_bsdf(bsdf, tmp_path / name)[0].read_bytes() for name in ("a.svg", "b.svg"))
    assert first == second


@pytest.mark.parametrize("name", ["picture.pdf", "picture.hdr", "no/picture.png"])
def test_pictures_of_other_names_are_refused(name: str, tmp_path: Path) -> None:
    bsdf = fabric(tmp_path, "klems-quarter")
    with pytest.raises((sp.InputError, FileNotFoundError), match=r"expected a name that ends in|no folder"):
        plot_bsdf(bsdf, tmp_path / name)
    assert {path.name for path in tmp_path.iterdir()} == {"klems-quarter.xml"}


def test_the_disc_has_equal_steps_for_equal_angles() -> None:
    theta = np.array([0.0, 30.0, 60.0, 90.0])
    points = disc(sp.direction(theta, 90.0)[:, :2])
    np.testing.assert_allclose(points, np.stack([np.zeros(4), theta / 90], axis=1), atol=1e-12)


def test_scales_are_whole_decades() -> None:
    assert log_limits(np.array([0.0, 0.02, 3.0])) == pytest.approx((0.01, 10.0))
    assert log_limits(np.array([1e-9, 5.0])) == pytest.approx((1e-5, 10.0))
    assert log_limits(np.array([2.0, 3.0])) == pytest.approx((0.1, 10.0))
    low, high = log_limits(np.zeros(3))
    assert 0.0 < low < high


def test_commands(sunpeak: CommandLine, tmp_path: Path) -> None:
    fabric(tmp_path, "klems-quarter")
    sunpeak("bsdf", "split", "klems-quarter.xml", "-o", "split", folder=tmp_path)
    assert {path.name for path in (tmp_path / "split").iterdir()} == FILES
    through = [
        sunpeak("bsdf", "through", name, "--theta", "0,20,40", folder=tmp_path).out
        for name in ("klems-quarter.xml", "split")
    ]
    assert through[0] == through[1]
    answer = sunpeak("bsdf", "plot", "split", "-o", "p.png", "--theta", 20, "--kind", "profile", folder=tmp_path)
    assert answer.out == ""
    assert min(png_size(tmp_path / "p.png")) > 500
    sunpeak("bsdf", "plot", "split", "-o", "p.gif", folder=tmp_path, expect=2)
    about = json.loads(sunpeak("bsdf", "info", "split", "--json", folder=tmp_path).out)
    assert about["peak"]["front"]["use"] == "if one can see through it"
    assert about["energy"]["front"]["sound"]
    text = sunpeak("bsdf", "info", "split", folder=tmp_path).out
    assert "front: use peak extraction: if one can see through it. Why: the peak is taken" in " ".join(text.split())


def test_scenes_take_a_split(tmp_path: Path) -> None:
    fabric(tmp_path, "klems-quarter").save_split(tmp_path / "split")
    scenes = {}
    for name in ("klems-quarter.xml", "split/peak.json"):
        text = (
            f"void aBSDF shade\n5 {name} 0 1 0 .\n0\n0\nshade polygon pane\n0\n0\n12 -1 -1 0 1 -1 0 1 1 0 -1 1 0\n"
            "void light sun 0 0 3 1e6 1e6 1e6\nsun source disc 0 0 4 0.1 0 -1 0.533\n"
        )
        (tmp_path / "scene.rad").write_text(text)
        scene = sp.Scene.load([str(tmp_path / "scene.rad")], search_path=[str(tmp_path)])
        origin, toward = np.array([[0.1, 0.0, 1.0]]), np.array([[0.1, 0.0, -1.0]]) / math.hypot(0.1, 1.0)
        scenes[name] = sp.trace(scene, origin, toward, samples=16, seed=1)
    for name, values in scenes.items():
        np.testing.assert_array_equal(values, scenes["klems-quarter.xml"], err_msg=name)
