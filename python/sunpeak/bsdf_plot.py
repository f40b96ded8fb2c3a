"""Pictures of a BSDF: where light goes for one incidence, what goes straight through, and a cut along the peak.

All discs show directions: the middle is the normal, the radius grows with theta (equal steps for equal angles), azimuth
counts from x to the right, y is up. Cells are those of the table, borders and all.
"""

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.bsdf_draw import (
    CALM,
    GAP,
    INK,
    MARK,
    disc,
    draw_cells,
    draw_hemisphere,
    legend_below,
    limit_to,
    log_limits,
    positions,
)
from sunpeak.files import check_target, whole_file
from sunpeak.scattering import Bsdf, Floats, rows, side_of_ray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

Kind = Literal["exit", "through", "profile", "all"]
"""What to draw: the exit hemisphere with a close-up, T over the incident hemisphere, the profile, or all of it."""

SUFFIXES = (".png", ".svg")
DPI = 160
"""Pixels an inch of PNG, and of cells inside SVG where they are too many to be drawn one by one."""

EDGE_POINTS = 6
"""Points an edge of a cell, enough for the widest patches of quarter Klems to look round."""

CLOSE_UP = 1.7
"""Half width of the close-up, in widths of the probe of rule 2 or of the peak, whichever is more."""

PROFILE_POINTS = 7201
"""Points of the profile: 1/40 degree each."""

BTDF_LABEL = "BTDF of the table [1/sr]"

ON_NORMAL = 1e-9
"""Sine of theta below which a direction has no azimuth of its own."""


@dataclass(frozen=True)
class Incidence:
    """One BSDF and one ray that meets it."""

    bsdf: Bsdf
    theta_deg: float
    phi_deg: float
    label: str

    @property
    def w_in(self) -> Floats:
        """Side of the traced ray, (1, 3)."""
        return rows(side_of_ray(self.theta_deg, self.phi_deg))

    @property
    def front(self) -> bool:
        """The ray meets the frame's front."""
        return bool(self.w_in[0, 2] > 0.0)

    @property
    def through(self) -> float:
        """Through transmittance of the split [-]."""
        return float(self.bsdf.through(self.w_in)[0])

    @property
    def name(self) -> str:
        """What the titles say."""
        azimuth = f", φ = {self.phi_deg:g}°" if self.theta_deg % 180.0 else ""
        return f"θ = {self.theta_deg:g}°{azimuth}"


def plot_bsdf(
    bsdf: Bsdf,
    output: str | PathLike[str],
    *,
    theta_deg: float = 0.0,
    phi_deg: float = 0.0,
    kind: Kind = "all",
    label: str | None = None,
) -> list[Path]:
    """Draw a BSDF for a ray that comes down at `theta_deg` (above 90 from behind) and runs towards azimuth `phi_deg`.

    `output` ends in `.png` or `.svg`, or has no suffix: then both are written. Gives the files' names.
    """
    targets = outputs(output)
    if kind not in get_args(Kind):
        raise _core.InputError(f"kind: {kind!r}; expected {', '.join(get_args(Kind))}")
    incidence = Incidence(bsdf, theta_deg, phi_deg, label or bsdf.describe()["name"] or "BSDF")
    for target in targets:
        check_target(target)
    figure = FIGURES[kind](incidence)
    for target in targets:
        save(figure, target)
    return targets


def is_picture(output: str | PathLike[str]) -> bool:
    """Whether a picture of this name can be written."""
    path = Path(output)
    return bool(path.name) and path.suffix in ("", *SUFFIXES)


def outputs(output: str | PathLike[str]) -> list[Path]:
    """The files that a name stands for."""
    path = Path(output)
    if path.suffix in SUFFIXES:
        return [path]
    if not is_picture(path):
        raise _core.InputError(f"{path}: expected a name that ends in .png or .svg, or without a suffix for both")
    return [path.with_suffix(suffix) for suffix in SUFFIXES]


def save(figure: "Figure", target: Path, dpi: int = DPI) -> None:
    """Write a figure whole or not at all; the same picture gives the same file."""
    from matplotlib import rc_context  # noqa: PLC0415  (half a second that `--help` need not spend)

    metadata = {"Date": None} if target.suffix == ".svg" else None
    with rc_context({"svg.hashsalt": "sunpeak", "svg.fonttype": "path"}), whole_file(target) as temporary:
        figure.savefig(temporary, format=target.suffix[1:], dpi=dpi, metadata=metadata)


def new_figure(width: float, height: float, title: str) -> "Figure":
    """A figure [inches] with room for its parts."""
    from matplotlib.figure import Figure  # noqa: PLC0415
    from matplotlib.layout_engine import ConstrainedLayoutEngine  # noqa: PLC0415

    layout = ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.10, wspace=0.04, hspace=0.04)
    figure = Figure(figsize=(width, height), layout=layout)
    figure.suptitle(title, fontsize=12, fontweight="bold", color=INK)
    return figure


def exit_figure(incidence: Incidence) -> "Figure":
    """Exit hemisphere and close-up."""
    figure = new_figure(11.2, 5.8, f"{incidence.label}: where light goes for {incidence.name}")
    whole, close = figure.subplots(1, 2)
    draw_exit(figure, whole, close, incidence)
    return figure


def through_figure(incidence: Incidence) -> "Figure":
    """T over the incident hemisphere."""
    figure = new_figure(6.6, 6.2, f"{incidence.label}: what goes straight through")
    draw_through(figure, figure.subplots(), incidence)
    return figure


def profile_figure(incidence: Incidence) -> "Figure":
    """The cut along the peak."""
    figure = new_figure(8.6, 5.0, f"{incidence.label}: the peak for {incidence.name}")
    axes = figure.subplots()
    draw_profile(axes, incidence)
    legend_below(axes, 0.13)
    return figure


def all_figure(incidence: Incidence) -> "Figure":
    """All of it on one page."""
    figure = new_figure(12.4, 11.4, f"{incidence.label}, incidence {incidence.name}")
    axes = figure.subplots(2, 2)
    draw_exit(figure, axes[0, 0], axes[0, 1], incidence)
    draw_through(figure, axes[1, 0], incidence)
    draw_profile(axes[1, 1], incidence)
    legend_below(axes[1, 1], 0.13)
    return figure


FIGURES: dict[str, Callable[[Incidence], "Figure"]] = {
    "exit": exit_figure,
    "through": through_figure,
    "profile": profile_figure,
    "all": all_figure,
}


@dataclass(frozen=True)
class ExitCells:
    """The table's cells on the exit hemisphere of one incidence, on the disc."""

    shapes: Floats
    """Outlines (cells, points, 2)."""
    values: Floats
    """BTDF of the table (cells,) [1/sr]."""
    is_peak: npt.NDArray[np.bool_]
    """The split took something from it."""
    probe: Floats
    """The 29 directions that rules 1 and 2 look at, (29, 2)."""
    straight: Floats
    """The straight direction, (2,)."""

    @property
    def half_width(self) -> float:
        """Of the close-up."""
        reach = float(np.abs(self.probe - self.straight).max())
        if self.is_peak.any():
            reach = max(reach, float(np.abs(self.shapes[self.is_peak] - self.straight).max()))
        return CLOSE_UP * reach

    def within(self, half_width: float) -> npt.NDArray[np.bool_]:
        """Cells that a close-up of this half width shows some of."""
        offset = self.shapes - self.straight
        inside: npt.NDArray[np.bool_] = ((offset.min(axis=1) <= half_width) & (offset.max(axis=1) >= -half_width)).all(
            axis=1
        )
        return inside


def exit_cells(incidence: Incidence) -> ExitCells:
    """Ask the core."""
    core = incidence.bsdf._core
    outlines, numbers, is_peak = _core.exit_cells(core, incidence.w_in, "transmission", EDGE_POINTS)
    if not len(outlines):
        raise _core.InputError(
            f"{incidence.label}: nothing is transmitted at {incidence.name}, there is no exit hemisphere"
        )
    probe = disc(_core.probe_directions(core, incidence.w_in)[:, :2])
    return ExitCells(disc(outlines), numbers[:, 0], is_peak, probe, disc(-incidence.w_in[:, :2])[0])


def draw_exit(figure: "Figure", whole: "Axes", close: "Axes", incidence: Incidence) -> None:
    """The BTDF over the exit hemisphere; beside it the surroundings of the straight direction."""
    cells = exit_cells(incidence)
    limits = log_limits(cells.values)
    drawn = draw_cells(whole, cells.shapes, cells.values, limits, scale="log", peak=cells.is_peak)
    draw_hemisphere(whole)
    whole.set_title("BTDF over the exit hemisphere", fontsize=10.5)
    mark_straight(whole, cells.straight)
    through = float(incidence.bsdf.through(incidence.w_in, "radiance")[0])
    draw_close_up(close, cells, limits, f"29 probes of rule 2 (T = {through:.4g})")
    close.set_title(close_up_title(incidence, cells.is_peak), fontsize=10.5)
    legend_below(close)
    figure.colorbar(drawn, ax=[whole, close], label=BTDF_LABEL, fraction=0.03, pad=0.02, extend="min")


def draw_close_up(axes: "Axes", cells: ExitCells, limits: tuple[float, float], probe_label: str) -> "PolyCollection":
    """The surroundings of the straight direction, with the probe of rules 1 and 2."""
    near = cells.within(cells.half_width)
    drawn = draw_cells(axes, cells.shapes[near], cells.values[near], limits, scale="log", peak=cells.is_peak[near])
    limit_to(axes, cells.straight, cells.half_width)
    draw_probe(axes, cells.probe, cells.straight, probe_label)
    return drawn


def close_up_title(incidence: Incidence, is_peak: npt.NDArray[np.bool_]) -> str:
    """What the split found here."""
    if not is_peak.any():
        return "Around the straight direction: no peak"
    cells = int(is_peak.sum())
    return f"Around the straight direction: T = {incidence.through:.4g} from {cells} cell{'s' if cells > 1 else ''}"


def mark_straight(axes: "Axes", straight: Floats) -> None:
    """A ring around the straight direction that is seen from afar."""
    axes.plot(*straight, "o", markersize=15, markerfacecolor="none", markeredgecolor=GAP, markeredgewidth=3.0, zorder=5)
    axes.plot(
        *straight, "o", markersize=15, markerfacecolor="none", markeredgecolor=MARK, markeredgewidth=1.4, zorder=6
    )


def draw_probe(axes: "Axes", probe: Floats, straight: Floats, name: str) -> None:
    """The 29 points of rules 1 and 2, and the straight direction."""
    axes.plot(*probe.T, "o", markersize=4.5, markerfacecolor=GAP, markeredgecolor=INK, label=name, zorder=6)
    axes.plot(*straight, "x", markersize=9, markeredgewidth=2.0, color=MARK, label="straight direction", zorder=7)
    axes.plot([], [], "-", color=MARK, linewidth=2.0, label="peak (split)")


def draw_through(figure: "Figure", axes: "Axes", incidence: Incidence) -> None:
    """Each incident cell's through transmittance."""
    outlines, columns = _core.incident_cells(incidence.bsdf._core, incidence.front, EDGE_POINTS * 4)
    if not len(outlines):
        raise _core.InputError(f"{incidence.label}: nothing is transmitted from this side, there is no T to draw")
    through = 100.0 * columns["through"]
    largest = float(through.max())
    drawn = draw_cells(axes, disc(outlines), through, (0.0, largest or 1.0), scale="linear", borders=len(through) > 1)
    draw_hemisphere(axes)
    here = disc(-incidence.w_in[:, :2])[0]
    axes.plot(*here, "x", markersize=11, markeredgewidth=4.0, color=GAP, zorder=6)
    axes.plot(*here, "x", markersize=10, markeredgewidth=2.0, color=MARK, label=f"incidence {incidence.name}", zorder=7)
    side = "front" if incidence.front else "back"
    if largest > 0.0:
        axes.set_title(f"T by the direction of the ray, at the {side}", fontsize=10.5)
        figure.colorbar(drawn, ax=axes, label="through transmittance T [%]", fraction=0.046, pad=0.02)
    else:
        axes.set_title(f"No peak for any ray at the {side}", fontsize=10.5)
    legend_below(axes, 0.0)


def draw_profile(axes: "Axes", incidence: Incidence, limits: tuple[float, float] | None = None) -> None:
    """Table and residual in the plane of incidence, and the delta; `limits` of the BTDF [1/sr] if not the table's."""
    angle, w_out, straight_deg = profile_directions(incidence)
    table = incidence.bsdf.evaluate(incidence.w_in, w_out)
    residual = incidence.bsdf.evaluate(incidence.w_in, w_out, residual=True)
    low, high = limits or log_limits(table)
    # What is less, or nothing, ends below the axis.
    table, residual = np.maximum(table, 0.1 * low), np.maximum(residual, 0.1 * low)
    if (table > residual).any():
        axes.fill_between(angle, residual, table, color=MARK, alpha=0.25, linewidth=0, label="taken as the peak")
    axes.plot(angle, table, color=INK, linewidth=1.0, label="table")
    axes.plot(angle, residual, color=CALM, linewidth=1.8, label="residual")
    draw_delta(axes, incidence, straight_deg, (low, high))
    axes.set_yscale("log")
    axes.set(xlim=(-90, 90), ylim=(low, 6.0 * high), xticks=np.arange(-90, 91, 15))
    axes.set_xlabel("exit angle in the plane of incidence [°], positive on the straight side")
    axes.set_ylabel("BTDF [1/sr]")
    axes.grid(color="0.85", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"Profile through the straight direction, {incidence.name}", fontsize=10.5)


def profile_directions(incidence: Incidence) -> tuple[Floats, Floats, float]:
    """Exit angles [deg] in the plane of incidence, their directions, and the angle of the straight one."""
    straight = -incidence.w_in[0]
    sine = float(np.hypot(*straight[:2]))
    along = straight[:2] / sine if sine > ON_NORMAL else positions(incidence.phi_deg)
    # Off the rim, and off the borders that lie at whole degrees.
    angle = np.linspace(-89.99, 89.99, PROFILE_POINTS)
    across = np.sin(np.radians(angle))[:, None] * along
    height = np.cos(np.radians(angle)) * np.sign(straight[2])
    return angle, np.column_stack([across, height]), float(np.degrees(np.arcsin(min(sine, 1.0))))


def draw_delta(axes: "Axes", incidence: Incidence, straight_deg: float, limits: tuple[float, float]) -> None:
    """An arrow for the delta, with its flux; a delta has no height."""
    if incidence.through <= 0.0:
        axes.axvline(
            straight_deg, color=MARK, linewidth=1.2, linestyle=(0, (5, 4)), label="straight direction: no peak"
        )
        return
    low, high = limits
    top: dict[str, Any] = {"xy": (straight_deg, 2.6 * high), "xytext": (straight_deg, low), "zorder": 5}
    axes.annotate(
        "", **top, arrowprops={"arrowstyle": "-|>", "color": MARK, "linewidth": 2.0, "shrinkA": 0, "shrinkB": 0}
    )
    left = straight_deg > 10.0  # where there is more room
    least, most = incidence.bsdf.through_interval(incidence.w_in)[0]
    axes.annotate(
        f"δ, T = {incidence.through:.4g}\n({least:.4g} to {most:.4g})",
        (straight_deg, 2.6 * high),
        xytext=(-7 if left else 7, 0),
        textcoords="offset points",
        ha="right" if left else "left",
        va="top",
        fontsize=9,
        color=MARK,
        fontweight="bold",
    )


__all__ = ["Incidence", "Kind", "is_picture", "plot_bsdf"]
