"""Pictures about glare: luminance in false colours, sources outlined and numbered, task zone, position index."""

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Unpack

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.files import whole_file
from sunpeak.glare_report import GlareReport, GlareSource
from sunpeak.glare_rules import RULES, GlareRules, Stated, Task, chosen_options
from sunpeak.images import SCALE
from sunpeak.pictures import Picture
from sunpeak.scattering import Floats
from sunpeak.scenes import View

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage

SOURCE, TASK, INDEX = "#56e39f", "#56b4e9", "#ffffff"
"""Outlines of sources and of the task zone, lines of equal position index: seen on dark and on light."""

POSITION_INDICES = (1.5, 2, 3, 4, 6, 8, 12)
"""Lines that are drawn."""

NUMBERED = 9
"""Sources that get a number, the worst first."""

MOST_DECADES = 4
"""So many are shown."""

LEAST_HIGH_CD_M2 = 10_000.0
"""The scale goes up to this at least, so that what passes the threshold of 2000 cd/m² stands out."""

LABEL_AWAY = 0.045
"""From a source to its number, as a share of the picture's width."""

PANEL_INCHES = 5.2
GRID = 240
"""Points along an edge at which the position index is worked out."""


class Panel(NamedTuple):
    """A picture, what was found in it, and the numbers of its pixels' sources."""

    picture: Picture
    report: GlareReport
    numbers: npt.NDArray[np.uint32]
    title: str


def panel(picture: Picture, report: GlareReport, title: str, rules: GlareRules, **stated: Unpack[Stated]) -> Panel:
    """Gather what is drawn; `rules` and what is `stated` are those that the report was made with."""
    numbers = _core.glare_sources(picture._core, chosen_options(rules, **stated))
    return Panel(picture, report, numbers, title)


def save_glare(
    panels: list[Panel],
    *paths: str | PathLike[str],
    task: Task | None = None,
    position_index: bool = False,
    rules: GlareRules = RULES["sunpeak"],
) -> None:
    """Draw pictures side by side with one scale, and write them as PNG or SVG, by the ends of the paths' names."""
    from matplotlib.colors import LogNorm  # noqa: PLC0415  (half a second that `--help` need not spend)
    from matplotlib.figure import Figure  # noqa: PLC0415

    for path in paths:
        if Path(path).suffix.lower() not in {".png", ".svg"}:
            raise _core.InputError(f"{path}: expected a name that ends in .png or .svg")
    low, high = limits([panel.picture for panel in panels])
    figure = Figure(figsize=(PANEL_INCHES * len(panels) + 1.1, PANEL_INCHES + 0.6), dpi=150, layout="constrained")
    all_axes = figure.subplots(1, len(panels), squeeze=False)[0]
    for axes, drawn in zip(all_axes, panels, strict=True):
        image = draw(axes, drawn, LogNorm(low, high))
        if position_index:
            draw_position_index(axes, drawn.picture, rules)
        if task is not None:
            draw_zone(axes, drawn.picture, task)
    label = "luminance [cd/m²]"
    figure.colorbar(image, ax=list(all_axes), label=label, extend="both", fraction=0.046 / len(panels), pad=0.02)
    for path in paths:
        with whole_file(path) as temporary:
            figure.savefig(temporary, format=Path(path).suffix[1:].lower())


def limits(pictures: list[Picture]) -> tuple[float, float]:
    """Scale [cd/m²] for the room and its windows; suns are beyond it."""
    luminances = [picture.luminance()[ahead(picture)] for picture in pictures]
    lit = np.concatenate([luminance[luminance > 0] for luminance in luminances])
    if not lit.size:
        return 1.0, 10.0
    dark, bright = np.percentile(lit, [5, 99.5])
    high = max(10 ** np.ceil(np.log10(bright)), LEAST_HIGH_CD_M2)
    low = 10 ** np.floor(np.log10(dark))
    return float(max(low, high / 10**MOST_DECADES)), float(high)


def ahead(picture: Picture) -> npt.NDArray[np.bool_]:
    """Pixels in front of the eye (h, w)."""
    view = seen_view(picture)
    height, width = picture.shape
    cosine = view.rays(width, height).directions @ view.direction
    in_front: npt.NDArray[np.bool_] = np.nan_to_num(cosine, nan=-1.0) > 0
    return in_front


def draw(axes: "Axes", drawn: Panel, norm: Any) -> "AxesImage":
    """One picture with its sources."""
    luminance = np.clip(drawn.picture.luminance(), norm.vmin, norm.vmax)
    shown = np.where(ahead(drawn.picture), luminance, np.nan)
    image = axes.imshow(shown, norm=norm, cmap=SCALE, interpolation="nearest")
    axes.set_axis_off()
    axes.set_title(caption(drawn), fontsize=10)
    for number, source in enumerate(drawn.report.sources, 1):
        if number <= NUMBERED or source.exact:
            outline(axes, drawn, number, source)
    number_sources(axes, drawn.picture, drawn.report.sources[:NUMBERED])
    return image


def caption(drawn: Panel) -> str:
    """Title and the main numbers."""
    report = drawn.report
    numbers = f"DGP {report.dgp:.3f} ({report.glare_class}), Ev {report.ev_lux:.0f} lx"
    return f"{drawn.title}\n{numbers}" if drawn.title else numbers


def outline(axes: "Axes", drawn: Panel, number: int, source: GlareSource) -> None:
    """Draw a line around a source: its pixels, or the disc of an exact one."""
    if source.exact:
        disc = Task(source.direction, cone_deg(source.solid_angle_sr))
        draw_cone(axes, drawn.picture, disc, colour=SOURCE, style="-")
        return
    from matplotlib.patheffects import withStroke  # noqa: PLC0415

    # A border of nothing, so that outlines close at the picture's edge.
    mask = np.pad((drawn.numbers == number).astype(float), 1)
    height, width = mask.shape
    line = axes.contour(
        np.arange(width) - 1, np.arange(height) - 1, mask, levels=[0.5], colors=[SOURCE], linewidths=1.0
    )
    line.set_path_effects([withStroke(linewidth=2.2, foreground="black")])


def number_sources(axes: "Axes", picture: Picture, sources: list[GlareSource]) -> None:
    """Number sources beside them, towards the middle of the picture; where one stands already, turned away from it."""
    height, width = picture.shape
    if not sources:
        return
    places = pixels_of(picture, np.array([source.direction for source in sources]))
    taken: list[Floats] = []
    for number, place in enumerate(places, 1):
        away = np.array([width / 2, height / 2]) - place
        angle = np.arctan2(away[1], away[0])
        spots = [angle + turn for turn in np.radians([0, 60, -60, 120, -120, 180])]
        candidates = [place + LABEL_AWAY * width * np.array([np.cos(spot), np.sin(spot)]) for spot in spots]
        free = [spot for spot in candidates if all(np.linalg.norm(spot - t) > LABEL_AWAY * width for t in taken)]
        taken.append((free or candidates)[0])
        axes.annotate(
            str(number),
            tuple(place),
            xytext=tuple(taken[-1]),
            ha="center",
            va="center",
            fontsize=8,
            color="black",
            bbox={"boxstyle": "circle,pad=0.2", "facecolor": SOURCE, "edgecolor": "none"},
            arrowprops={"arrowstyle": "-", "color": SOURCE, "linewidth": 0.8},
        )


def draw_zone(axes: "Axes", picture: Picture, task: Task) -> None:
    """Task zone, dashed."""
    draw_cone(axes, picture, task, colour=TASK, style="--")


def draw_cone(axes: "Axes", picture: Picture, cone: Task, *, colour: str, style: str) -> None:
    """Edge of a cone of directions."""
    direction, opening_deg = cone
    axis = np.array(direction) / np.linalg.norm(direction)
    side = np.cross(axis, [0.0, 0.0, 1.0] if abs(axis[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    turn = np.linspace(0, 2 * np.pi, 181)[:, None]
    half = np.radians(opening_deg / 2)
    rim = np.cos(half) * axis + np.sin(half) * (np.cos(turn) * side + np.sin(turn) * np.cross(axis, side))
    points = pixels_of(picture, rim)
    axes.plot(points[:, 0], points[:, 1], color=colour, linestyle=style, linewidth=1.2)


def draw_position_index(axes: "Axes", picture: Picture, rules: GlareRules) -> None:
    """Draw lines of equal position index."""
    view = seen_view(picture)
    height, width = picture.shape
    directions = view.rays(GRID, GRID).directions
    in_front = np.nan_to_num(directions @ view.direction, nan=-1.0) > 0
    index = np.full((GRID, GRID), np.nan)
    x, y, z = view.direction.tolist()
    right, forward, upward = view.up.tolist()
    index[in_front] = _core.position_indices(
        np.ascontiguousarray(directions[in_front]), (x, y, z), (right, forward, upward), rules.below_sight
    )
    place = (np.arange(GRID) + 0.5) / GRID
    lines = axes.contour(
        place * width - 0.5,
        place * height - 0.5,
        index,
        levels=POSITION_INDICES,
        colors=INDEX,
        linewidths=0.6,
        alpha=0.8,
    )
    axes.clabel(lines, fontsize=7, fmt="%g")


def pixels_of(picture: Picture, directions: Floats) -> Floats:
    """Where directions (n, 3) fall, as (column, row) of the axes, whose pixels have their middles at whole numbers."""
    height, width = picture.shape
    place = seen_view(picture).project(directions)
    points: Floats = np.stack([place[:, 0] * width - 0.5, (1 - place[:, 1]) * height - 0.5], axis=1)
    return points


def seen_view(picture: Picture) -> View:
    """Give the view of a picture that has one."""
    view = picture.view
    if view is None:
        raise _core.InputError("the picture has no view; expected VIEW= in its header")
    return view


def cone_deg(solid_angle_sr: float) -> float:
    """Full opening angle of a cone [deg]."""
    return float(np.degrees(2 * np.arccos(1 - solid_angle_sr / (2 * np.pi))))
