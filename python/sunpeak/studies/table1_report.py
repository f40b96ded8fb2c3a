"""The study of Table 1 as tables in Markdown, as JSON, and as a picture in the manner of the paper's Figure 7."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

from sunpeak.bsdf_plot import new_figure
from sunpeak.files import check_target, whole_file, write_text
from sunpeak.images import exposure_of, luminance_cd_m2
from sunpeak.rooms import LABELS
from sunpeak.rooms.box import TEST_ROOM
from sunpeak.studies.fisheyes import draw_fisheye, sun_place
from sunpeak.studies.markdown import Column, spaced, table_of, text_table
from sunpeak.studies.paper import PROGRAMS, TABLE_1
from sunpeak.studies.table1 import TRUTH, Found

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PANEL_INCHES = 2.1
FIGURE_DPI = 100


def table1_targets(folder: Path) -> tuple[Path, Path, Path]:
    """Give the names of the Markdown, JSON and PNG files, which must be possible."""
    paths = folder / "table1.md", folder / "table1.json", folder / "table1.png"
    for path in paths:
        check_target(path)
    return paths


def write_table1(folder: Path, found: list[Found]) -> list[Path]:
    """Write `table1.md`, `table1.json` and `table1.png`."""
    text, numbers, picture = table1_targets(folder)
    figure = figure7(found)
    with whole_file(picture) as temporary:
        figure.savefig(temporary, format="png")
    content = {
        "closed_form_cd_m2": TRUTH.luminance_cd_m2,
        "found": [case.to_dict() for case in found],
        "paper": {basis: case._asdict() for basis, case in TABLE_1.items()},
    }
    write_text(numbers, json.dumps(content, indent=2) + "\n")
    write_text(text, markdown(found))
    return [text, numbers, picture]


def markdown(found: list[Found]) -> str:
    """Ev and DGP beside the paper's; then the brightest luminance beside the truth."""
    return f"{numbers_table(found)}\n\n{brightest_table(found)}\n\nClosed form: {TRUTH.in_words()}.\n"


def bases_of(found: list[Found]) -> list[str]:
    """In their order."""
    return list(dict.fromkeys(case.basis for case in found))


def by_program(found: list[Found], program: str, basis: str) -> tuple[Found, Found] | None:
    """Without and with peak extraction."""
    pair = {case.extracted: case for case in found if (case.program, case.basis) == (program, basis)}
    return (pair[False], pair[True]) if len(pair) == 2 else None


def numbers_table(found: list[Found]) -> str:
    """A row for each basis and program."""
    rows: list[list[str]] = []
    for basis in bases_of(found):
        paper = TABLE_1[basis]
        rows.append(
            [
                LABELS[basis],
                "the paper",
                f"{paper.ev_without_lux:.0f}",
                f"{paper.dgp_without:.3f}",
                f"{paper.ev_with_lux:.0f}",
                f"{paper.dgp_with:.3f}",
            ]
        )
        for program, name in PROGRAMS.items():
            pair = by_program(found, program, basis)
            if pair is not None:
                rows.append(["", name, *(cell for case in pair for cell in (f"{case.ev_lux:.0f}", dgp_cell(case)))])
    return text_table(("BSDF", "by", "Ev without PE [lx]", "DGP without", "Ev with PE [lx]", "DGP with"), rows)


def dgp_cell(case: Found) -> str:
    """DGP, and how far the noise of the picture may move it where that shows."""
    if case.dgp_interval is None:
        return f"{case.dgp:.3f}"
    low, high = case.dgp_interval
    return f"{case.dgp:.3f}" + (f" ({low:.3f} to {high:.3f})" if high - low > 0.001 else "")


def brightest_table(found: list[Found]) -> str:
    """Brightest luminance, and what of the closed form's it is."""
    columns: list[Column[Found]] = [
        ("BSDF", lambda case: LABELS[case.basis]),
        ("by", lambda case: PROGRAMS[case.program]),
        ("PE", lambda case: "with" if case.extracted else "without"),
        ("brightest [cd/m²]", lambda case: spaced(case.max_luminance_cd_m2)),
        ("to the closed form", lambda case: f"{100 * case.to_truth:+.2f} %"),
    ]
    return table_of(columns, sorted(found, key=lambda case: bases_of(found).index(case.basis)))


def figure7(found: list[Found]) -> "Figure":
    """A row for each basis: each program without and with peak extraction, with a close-up of the sun."""
    bases, programs = bases_of(found), [name for name in PROGRAMS if any(case.program == name for case in found)]
    width, height = PANEL_INCHES * 2 * len(programs) + 0.4, (PANEL_INCHES + 0.28) * len(bases) + 0.5
    figure = new_figure(width, height, "")
    figure.set_dpi(FIGURE_DPI)
    grid = figure.subplots(len(bases), 2 * len(programs), squeeze=False)
    exposure = exposure_of(luminance_cd_m2(found[0].pixels))
    place = sun_place(TEST_ROOM)
    for row, basis in zip(grid, bases, strict=True):
        for column, program in enumerate(programs):
            pair = by_program(found, program, basis)
            for axes, case in zip(row[2 * column : 2 * column + 2], pair or (), strict=False):
                draw_fisheye(axes, case.pixels, exposure, place)
                axes.set_title(f"{case.ev_lux:.0f} lx, DGP {case.dgp:.3f}", fontsize=8)
        row[0].set_ylabel(LABELS[basis], fontsize=8)
    for column, program in enumerate(programs):
        for extracted in (0, 1):
            axes = grid[0][2 * column + extracted]
            peak = "with PE" if extracted else "without PE"
            axes.set_title(f"{PROGRAMS[program]}, {peak}\n{axes.get_title()}", fontsize=8)
    return figure
