"""The study of Figures 4 to 6 as pictures, as a table in Markdown, and as JSON."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from sunpeak.bsdf_plot import new_figure
from sunpeak.files import check_target, whole_file, write_text
from sunpeak.images import exposure_of, luminance_cd_m2, tonemap
from sunpeak.progress import Steps
from sunpeak.rooms.office import OFFICE
from sunpeak.studies.figures import TRUTH, FiguresPlan, Judged, Seen, judge, render_figures
from sunpeak.studies.fisheyes import bare, draw_false_colours, draw_fisheye, smaller, sun_place
from sunpeak.studies.markdown import spaced, text_table
from sunpeak.studies.paper import FIGURES_5_AND_6, PROGRAMS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIGURE_DPI = 100
ACROSS_INCHES, ACROSS_PIXELS = 4.2, 400
EYE_INCHES = 2.4

DARKER = 0.5
"""Of the usual exposure: the window counts as much as the room."""

SCALE_CD_M2 = (1.0, 1e6)
"""Ends of the false colours."""


def write_figures(plan: FiguresPlan, steps: Steps, say: Callable[[str], None] = lambda _: None) -> list[Path]:
    """Render both views and write `figure4.png`, `figures5-6.png`, `figures.md` and `figures.json`."""
    names = ("figure4.png", "figures5-6.png", "figures.md", "figures.json")
    across_png, eye_png, text, numbers = targets = [plan.folder / name for name in names]
    for target in targets:
        check_target(target)
    across, eye = render_figures(plan, steps, say)
    judged = [judge(plan, seen) for seen in eye]
    save(figure4(across), across_png)
    save(figures_5_and_6(eye, judged), eye_png)
    write_text(text, markdown(judged))
    content = {
        "closed_form_cd_m2": TRUTH.luminance_cd_m2,
        "found": [case.to_dict() for case in judged],
        "paper": FIGURES_5_AND_6,
    }
    write_text(numbers, json.dumps(content, indent=2) + "\n")
    return targets


def markdown(judged: list[Judged]) -> str:
    """The numbers of Figures 5 and 6 beside the paper's."""
    rows = [
        ["the paper", with_or_without(rule != "off"), "", f"{case['dgp']:.3f}", spaced(case["max_luminance_cd_m2"]), ""]
        for rule, case in FIGURES_5_AND_6.items()
    ]
    rows += [
        [
            PROGRAMS[case.program],
            with_or_without(case.extracted),
            f"{case.ev_lux:.0f}",
            f"{case.dgp:.3f}",
            spaced(case.max_luminance_cd_m2),
            f"{100 * (case.max_luminance_cd_m2 / TRUTH.luminance_cd_m2 - 1):+.2f} %",
        ]
        for case in judged
    ]
    headings = ("by", "PE", "Ev [lx]", "DGP", "brightest [cd/m²]", "to the closed form")
    return f"{text_table(headings, rows)}\n\nClosed form: {TRUTH.in_words()}.\n"


def with_or_without(extracted: bool) -> str:
    """Say whether peaks were extracted."""
    return "with" if extracted else "without"


def title(program: str, extracted: bool) -> str:
    """Above a picture."""
    return f"{PROGRAMS[program]}, {with_or_without(extracted)} PE"


def figure4(across: list[Seen]) -> "Figure":
    """Across the room: the view out, and shadows; a row for each program."""
    height, width = across[0].picture.shape
    rows = len(across) // 2
    figure = new_figure(ACROSS_INCHES * 2, (ACROSS_INCHES * height / width + 0.35) * rows, "")
    exposure = DARKER * exposure_of(across[0].picture.luminance())
    for axes, seen in zip(figure.subplots(rows, 2, squeeze=False).ravel(), across, strict=True):
        axes.imshow(tonemap(smaller(seen.picture.pixels, ACROSS_PIXELS), exposure), interpolation="nearest")
        axes.set_title(title(seen.program, seen.extracted), fontsize=9)
        bare(axes)
    return figure


def figures_5_and_6(eye: list[Seen], judged: list[Judged]) -> "Figure":
    """The fisheye: tone-mapped with the sun close up, and in false colours; a column for each program and rule."""
    columns = len(eye)
    figure = new_figure(EYE_INCHES * columns + 0.8, EYE_INCHES * 2 + 0.5, "")
    exposure = DARKER * exposure_of(eye[0].picture.luminance())
    grid = figure.subplots(2, columns, squeeze=False)
    for mapped, false, seen, case in zip(*grid, eye, judged, strict=True):
        draw_fisheye(mapped, seen.picture.pixels, exposure, sun_place(OFFICE))
        mapped.set_title(f"{title(seen.program, seen.extracted)}\n{case.ev_lux:.0f} lx, DGP {case.dgp:.3f}", fontsize=8)
        drawn = draw_false_colours(false, luminance_cd_m2(seen.picture.pixels), SCALE_CD_M2)
    figure.colorbar(drawn, ax=list(grid[1]), label="luminance [cd/m²]", fraction=0.046 / columns, pad=0.01)
    return figure


def save(figure: "Figure", path: Path) -> None:
    """Write a figure as PNG, whole or not at all."""
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png", dpi=FIGURE_DPI)
