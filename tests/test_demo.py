"""The demo shows the paper's pattern, with fewer paths than the default so that it is quick."""

import json
from pathlib import Path

import pytest

from conftest import CommandLine
from sunpeak import Picture
from sunpeak.demo import DEMO_ROOM
from sunpeak.rooms import expectation

TREES = ("t3-1024", "t3-4096", "t3-16384")
BASES = ("klems", *TREES)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, sunpeak: CommandLine) -> Path:
    folder = tmp_path_factory.mktemp("demo")
    sunpeak("demo", "-o", folder, "--size", "200x200", "--samples", 16)
    return folder


@pytest.fixture(scope="module")
def rows(folder: Path) -> dict[tuple[str, str], dict[str, float]]:
    table = json.loads((folder / "table.json").read_text())
    return {(row["basis"], row["peak"]): row for row in table}


def test_table_has_a_row_for_each_basis_and_rule(rows) -> None:
    assert list(rows) == [(basis, peak) for basis in BASES for peak in ("off", "split")]
    for row in rows.values():
        assert {"basis", "peak", "ev_lux", "dgp", "max_luminance_cd_m2"} <= row.keys()


def test_the_sun_stands_well_inside_the_cut_off() -> None:
    assert expectation(DEMO_ROOM).incidence_deg <= 0.7 * 68.0


@pytest.mark.parametrize(("basis", "tolerance"), [("klems", 0.06), *((tree, 0.03) for tree in TREES)])
def test_the_eye_receives_the_same_light_either_way(basis: str, tolerance: float, rows) -> None:
    assert rows[basis, "split"]["ev_lux"] == pytest.approx(rows[basis, "off"]["ev_lux"], rel=tolerance)


def test_without_peak_extraction_dgp_rises_with_resolution(rows) -> None:
    dgp = [rows[basis, "off"]["dgp"] for basis in BASES]
    assert dgp == sorted(dgp)
    assert dgp[-1] - dgp[0] > 0.05


def test_with_peak_extraction_dgp_does_not_depend_on_resolution(rows) -> None:
    dgp = {basis: rows[basis, "split"]["dgp"] for basis in BASES}
    trees = [dgp[tree] for tree in TREES]
    assert max(trees) - min(trees) <= 0.01
    assert all(abs(dgp["klems"] - value) <= 0.03 for value in trees)
    assert min(dgp.values()) > max(rows[basis, "off"]["dgp"] for basis in BASES)


@pytest.mark.parametrize(("basis", "tolerance"), [("klems", 0.06), *((tree, 0.02) for tree in TREES)])
def test_the_sun_is_as_bright_as_the_closed_form_says(basis: str, tolerance: float, rows) -> None:
    expected = expectation(DEMO_ROOM).luminance_cd_m2
    assert rows[basis, "split"]["max_luminance_cd_m2"] == pytest.approx(expected, rel=tolerance)


def test_pictures_and_report_are_written(folder: Path) -> None:
    for basis in BASES:
        for peak in ("off", "split"):
            picture = Picture.load(folder / f"{basis}_{peak}.hdr")
            assert picture.shape == (200, 200)
            assert len(picture.exact_sources) == (peak == "split")
            for kind in ("", "_false"):
                assert (folder / f"{basis}_{peak}{kind}.png").read_bytes().startswith(b"\x89PNG")
    report = (folder / "report.html").read_text()
    assert report.count("data:image/png;base64,") == 3 * 8
    assert 'src="http' not in report
    assert not list(folder.glob(".*"))


def test_the_folder_can_be_rendered_again(folder: Path, sunpeak: CommandLine) -> None:
    """The demo's scene is ordinary: the command line renders it, and the sun is in the picture."""
    out = folder / "again.hdr"
    sunpeak(
        "render", "room.rad", "sky.rad", "shade_t3-1024.rad", "-v", "eye.vf", "-o", out, "--size", "60", "--samples", 2,
        folder=folder,
    )  # fmt: skip
    report = json.loads(sunpeak("glare", out, "--json").out)
    expected = expectation(DEMO_ROOM).luminance_cd_m2
    assert report["sources"][0]["exact"]
    assert report["sources"][0]["luminance_cd_m2"] == pytest.approx(expected, rel=0.02)
