"""The paper's experiments in rooms of our own, with few pixels; closed forms and Radiance say what is right."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import sunpeak as sp
from conftest import CommandLine
from conftest import Radiance as Oracle
from sunpeak.progress import Steps
from sunpeak.rooms.box import TEST_ROOM
from sunpeak.studies import FiguresPlan, Table1Plan, run_table1, write_figures, write_table1
from sunpeak.studies.figures import TRUTH as OFFICE_TRUTH
from sunpeak.studies.paper import TABLE_1
from sunpeak.studies.radiance import Radiance, RadianceError
from sunpeak.studies.radiance_pictures import RadianceScene, evalglare
from sunpeak.studies.table1 import TRUTH, Found

TREES = ("t3-1024", "t3-4096")
QUICK = ("-ps", 1, "-pj", 0, "-ab", 0, "-ss", 1, "-st", 0.01, "-dc", 1, "-dt", 0, "-w")
"""Radiance's options for the light that comes straight, and that of the fabric."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("table1")


@pytest.fixture(scope="module")
def found(folder: Path) -> list[Found]:
    plan = Table1Plan(folder, size=200, samples=4, bases=TREES)
    return list(run_table1(plan, Steps(None, plan.steps())))


@pytest.fixture(scope="module")
def of(found: list[Found]) -> Callable[[str, bool], Found]:
    cases = {(case.basis, case.extracted): case for case in found}
    return lambda basis, extracted: cases[basis, extracted]


def test_our_table_1_lies_where_the_papers_does(of: Callable[[str, bool], Found]) -> None:
    for basis in TREES:
        paper = TABLE_1[basis]
        for extracted, ev, dgp in (
            (False, paper.ev_without_lux, paper.dgp_without),
            (True, paper.ev_with_lux, paper.dgp_with),
        ):
            assert of(basis, extracted).ev_lux == pytest.approx(ev, rel=0.08)
            assert of(basis, extracted).dgp == pytest.approx(dgp, abs=0.015)


def test_with_peak_extraction_the_sun_is_the_closed_forms_in_every_tree(of: Callable[[str, bool], Found]) -> None:
    with_peak = [of(basis, True) for basis in TREES]
    assert abs(with_peak[0].dgp - with_peak[1].dgp) < 0.005
    for case in with_peak:
        assert case.max_luminance_cd_m2 == pytest.approx(TRUTH.luminance_cd_m2, rel=0.01)
    for basis in TREES:
        assert of(basis, False).max_luminance_cd_m2 < 0.05 * TRUTH.luminance_cd_m2


def test_tables_json_and_picture_are_written(folder: Path, found: list[Found]) -> None:
    written = write_table1(folder, found)
    assert [path.name for path in written] == ["table1.md", "table1.json", "table1.png"]
    text = written[0].read_text()
    assert "| the paper | 440 | 0.267 | 439 | 0.418 |" in text
    assert text.count("| Sunpeak |") == 2 + 4
    content = json.loads(written[1].read_text())
    assert [row["dgp"] for row in content["found"]] == [case.dgp for case in found]
    assert written[2].read_bytes().startswith(b"\x89PNG")
    assert not list(folder.glob(".*"))


def test_radiance_sees_the_same_smear_and_the_same_sun(
    radiance: Oracle, folder: Path, of: Callable[[str, bool], Found], tmp_path: Path
) -> None:
    """The table as it is, to 3 %: cells that both blend; the sun behind it, to what rule 2 makes of T."""
    programs = Radiance(radiance.programs, radiance.library)
    basis = "t3-4096"
    off, extracted = RadianceScene(programs, TEST_ROOM, tmp_path, basis, QUICK).cases(400)
    assert off.max_luminance_cd_m2 == pytest.approx(of(basis, False).max_luminance_cd_m2, rel=0.03)
    bsdf = sp.Bsdf.load(folder / f"fabric_{basis}.xml")
    w_in = sp.side_of_ray(TRUTH.incidence_deg, 37.0)
    rule_2 = float(bsdf.through(w_in, "radiance")[0]) / TRUTH.fabric_transmittance
    assert extracted.max_luminance_cd_m2 == pytest.approx(rule_2 * TRUTH.luminance_cd_m2, rel=0.03)
    assert not [path.name for path in tmp_path.iterdir() if path.suffix == ".oct" or path.name.startswith(".")]
    report = sp.glare(sp.Picture.load(tmp_path / f"radiance_{basis}_off.hdr"), rules="evalglare-3")
    assert evalglare(programs, tmp_path / f"radiance_{basis}_off.hdr")["dgp"] == pytest.approx(report.dgp, abs=0.005)


def test_a_program_that_fails_is_named(radiance: Oracle, tmp_path: Path) -> None:
    programs = Radiance(radiance.programs, radiance.library)
    with pytest.raises(RadianceError, match=r"rpict: .*nothing\.oct"):
        programs.run("rpict", "nothing.oct", folder=tmp_path)


def test_figures_4_to_6(tmp_path: Path) -> None:
    plan = FiguresPlan(tmp_path, size=120, samples=2)
    written = write_figures(plan, Steps(None, plan.steps()))
    assert [path.name for path in written] == ["figure4.png", "figures5-6.png", "figures.md", "figures.json"]
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in written[:2])
    without, with_peak = json.loads(written[3].read_text())["found"]
    assert with_peak["max_luminance_cd_m2"] == pytest.approx(OFFICE_TRUTH.luminance_cd_m2, rel=0.01)
    assert with_peak["dgp"] > 0.35 > without["dgp"], "noticeable and imperceptible, as in the paper"
    assert "| the paper | with |  | 0.359 | 4 260 000 |  |" in written[2].read_text()


def test_the_commands_explain_themselves(sunpeak: CommandLine, tmp_path: Path) -> None:
    for name in ("table1", "figures"):
        assert f"sunpeak study {name} -o" in sunpeak("study", name, "--help").out
        sunpeak("study", name, expect=2)
    (tmp_path / "table1.md").mkdir()
    said = sunpeak("study", "table1", "-o", tmp_path, "--no-radiance", expect=1).err
    assert "table1.md" in said
    assert not (tmp_path / "klems_off.hdr").exists(), "nothing was rendered in vain"
