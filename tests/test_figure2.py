"""Figure 2 of the paper on products in closed form: which rule takes what, and whether the figure is one."""

import math
import struct
from pathlib import Path
from xml.etree import ElementTree

import pytest

from conftest import CommandLine
from sunpeak.studies.figure2 import PANEL_DEG, RULES, THETA_DEG, Case, cases

GLASS, PANEL = "clear glass", f"panel {PANEL_DEG:g}°"
KLEMS, TREE = "klems", "t3-4096"


@pytest.fixture(scope="module")
def drawn() -> dict[tuple[str, str], Case]:
    return {(case.product.name, case.basis): case for case in cases()}


def fresnel_pane(theta_deg: float, index: float) -> float:
    """Transmittance of a pane that absorbs nothing: (1 - r) / (1 + r), mean of both polarisations."""
    incident = math.radians(theta_deg)
    refracted = math.asin(math.sin(incident) / index)
    across = math.sin(incident - refracted) / math.sin(incident + refracted)
    along = math.tan(incident - refracted) / math.tan(incident + refracted)
    return sum((1 - r * r) / (1 + r * r) for r in (across, along)) / 2


def test_there_are_four_cases(drawn: dict[tuple[str, str], Case]) -> None:
    assert set(drawn) == {(product, basis) for product in (GLASS, PANEL) for basis in (KLEMS, TREE)}


@pytest.mark.parametrize(("basis", "tolerance"), [(KLEMS, 2e-3), (TREE, 2e-4)])
def test_clear_glass_is_taken_whole_by_every_rule(
    basis: str, tolerance: float, drawn: dict[tuple[str, str], Case]
) -> None:
    case = drawn[GLASS, basis]
    truth = fresnel_pane(THETA_DEG, 1.52)
    assert case.truth == pytest.approx(truth, rel=1e-9)
    for rule in RULES:
        assert case.through(rule) == pytest.approx(truth, rel=tolerance)
        assert case.taken_in(rule) == 1.0
    assert case.left == 0.0
    low, high = case.interval
    assert low <= truth <= high


def test_in_the_tree_the_split_alone_leaves_the_panel_alone(drawn: dict[tuple[str, str], Case]) -> None:
    case = drawn[PANEL, TREE]
    assert case.truth == 0.0
    assert case.through("split") == 0.0
    assert case.taken_in("split") == 0.0
    assert case.left == case.transmitted == pytest.approx(0.5, rel=1e-6)
    for rule in ("paper", "radiance"):
        # Most of what is transmitted, though nothing goes straight.
        assert 0.7 < case.through(rule) / case.transmitted < 0.9
        assert case.taken_in(rule) > 0.99
    assert case.report.verdict.use == "no"
    assert case.report.narrowest_lobe_deg < PANEL_DEG


def test_in_klems_no_rule_can_tell(drawn: dict[tuple[str, str], Case]) -> None:
    glass, panel = drawn[GLASS, KLEMS], drawn[PANEL, KLEMS]
    for rule in RULES:
        assert panel.taken_in(rule) == glass.taken_in(rule) == 1.0
    # The split takes least, and far too much.
    assert 0.25 < panel.through("split") < panel.through("paper") == panel.through("radiance") < panel.transmitted
    assert panel.left > 0.1
    for case in (glass, panel):
        assert case.report.verdict.use == "if one can see through it"
        assert "cannot tell a hole from a scatterer" in case.report.verdict.text
        assert case.report.narrowest_lobe_deg > PANEL_DEG


def test_the_command_writes_a_page_and_its_numbers(
    sunpeak: CommandLine, tmp_path: Path, drawn: dict[tuple[str, str], Case]
) -> None:
    folder = tmp_path / "study"
    answer = sunpeak("study", "figure2", "-o", folder)
    assert answer.out == ""
    assert {path.name for path in folder.iterdir()} == {"figure2.png", "figure2.svg", "figure2.md"}
    head = (folder / "figure2.png").read_bytes()
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    assert head[-8:-4] == b"IEND"
    assert min(struct.unpack(">II", head[16:24])) > 1000
    assert len(head) < 400_000
    assert ElementTree.fromstring((folder / "figure2.svg").read_text()).tag.endswith("svg")
    table = [line.split(" | ") for line in (folder / "figure2.md").read_text().splitlines() if line.startswith("| ")]
    assert len(table) == 1 + len(drawn)
    for cells, case in zip(table[1:], drawn.values(), strict=True):
        assert cells[:2] == [f"| {case.product.name}", case.basis]
        assert float(cells[6]) == pytest.approx(case.through("paper"), abs=1e-4)
        assert float(cells[7]) == pytest.approx(case.through("radiance"), abs=1e-4)


def test_a_folder_is_needed(sunpeak: CommandLine) -> None:
    sunpeak("study", "figure2", expect=2)
