"""Cells on the disc of directions: what the pictures of BSDFs are drawn with."""

from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from sunpeak.scattering import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.ticker import Locator

INK = "#1a1a1a"
GAP = "#ffffff"
"""Around marks, so that they are seen on any colour."""
MARK = "#d55e00"
"""Peaks and straight directions: vermilion, told from the scales by eyes that do not see red (Okabe and Ito 2008)."""
CALM = "#0072b2"
"""The smooth part: blue, of the same palette."""
EMPTY = "#ececec"
"""Cells without light."""

LOG_COLOURS, LINEAR_COLOURS = "viridis", "cividis"
"""Even steps to the eye."""

FEWEST_DECADES, MOST_DECADES = 2, 6
"""So many are shown."""

RINGS_DEG = (15, 30, 45, 60, 75)
SPOKES_DEG = (0, 45, 90, 135, 180, 225, 270, 315)
RING_LABELS_AT_DEG = 112.5
"""Between spokes, in the upper half."""

MANY_CELLS = 4000
"""Past this, cells are drawn as pixels inside SVG files."""

FEW_CELLS = 1200
"""Up to this, cells have visible borders."""

ROOM = 1.2
"""Half width of a disc with its labels, in radii."""


def disc(points: Floats) -> Floats:
    """(x, y) of directions to the disc where the radius is theta over 90 degrees."""
    sine = np.clip(np.hypot(points[..., 0], points[..., 1]), 0.0, 1.0)
    factor = np.divide(np.arcsin(sine) * (2.0 / np.pi), sine, out=np.full_like(sine, 2.0 / np.pi), where=sine > 0.0)
    stretched: Floats = points * factor[..., None]
    return stretched


def log_limits(values: Floats) -> tuple[float, float]:
    """Whole powers of ten around the values above zero, two to six decades."""
    lit = values[values > 0.0]
    high = np.ceil(np.log10(lit.max())) if lit.size else 0.0
    low = np.floor(np.log10(lit.min())) if lit.size else high
    low = np.clip(low, high - MOST_DECADES, high - FEWEST_DECADES)
    return float(10.0**low), float(10.0**high)


def draw_cells(
    axes: "Axes",
    outlines: Floats,
    values: Floats,
    limits: tuple[float, float],
    *,
    scale: Literal["log", "linear"],
    peak: npt.NDArray[np.bool_] | None = None,
    borders: bool = True,
) -> "PolyCollection":
    """Fill each cell by its value; cells of the `peak` get a border of their own."""
    from matplotlib import colormaps  # noqa: PLC0415
    from matplotlib.collections import PolyCollection  # noqa: PLC0415
    from matplotlib.colors import LogNorm, Normalize  # noqa: PLC0415

    few = borders and len(values) <= FEW_CELLS
    cells = PolyCollection(
        list(outlines),
        array=np.ma.masked_less_equal(values, 0.0),
        norm=LogNorm(*limits) if scale == "log" else Normalize(*limits),
        cmap=colormaps[LOG_COLOURS if scale == "log" else LINEAR_COLOURS].with_extremes(bad=EMPTY),
        edgecolors=(1.0, 1.0, 1.0, 0.35) if few else "face",
        linewidths=0.4 if few else 0.15,
        rasterized=len(values) > MANY_CELLS,
        zorder=1,
    )
    axes.add_collection(cells)
    if peak is not None and peak.any():
        marked = list(outlines[peak])
        axes.add_collection(PolyCollection(marked, facecolors="none", edgecolors=GAP, linewidths=3.2, zorder=3))
        axes.add_collection(PolyCollection(marked, facecolors="none", edgecolors=MARK, linewidths=1.8, zorder=4))
    return cells


def draw_hemisphere(axes: "Axes") -> None:
    """Rings of theta and spokes of azimuth with their labels."""
    from matplotlib import patheffects  # noqa: PLC0415
    from matplotlib.patches import Circle  # noqa: PLC0415

    for theta in RINGS_DEG:
        axes.add_patch(Circle((0, 0), theta / 90, fill=False, edgecolor=GAP, linewidth=0.7, alpha=0.55, zorder=2))
        axes.add_patch(
            Circle(
                (0, 0), theta / 90, fill=False, edgecolor=INK, linewidth=0.5, alpha=0.6, linestyle=(0, (4, 4)), zorder=2
            )
        )
        at = theta / 90 * positions(RING_LABELS_AT_DEG)
        outline = [patheffects.withStroke(linewidth=2.2, foreground=GAP)]
        axes.text(
            at[0], at[1], f"{theta}°", fontsize=7.5, ha="center", va="center", color=INK, path_effects=outline, zorder=4
        )
    axes.add_patch(Circle((0, 0), 1.0, fill=False, edgecolor=INK, linewidth=1.0, zorder=4))
    for phi in SPOKES_DEG:
        end = positions(phi)
        axes.plot(*np.stack([0.98 * end, 1.02 * end]).T, color=INK, linewidth=0.8, zorder=4)
        name = {0: "φ = 0°", 90: "90° (up)"}.get(phi, f"{phi}°")
        across, up = np.round(end, 6)
        axes.text(
            1.045 * across,
            1.045 * up,
            name,
            fontsize=8,
            color=INK,
            ha="left" if across > 0 else "right" if across < 0 else "center",
            va="bottom" if up > 0 else "top" if up < 0 else "center",
        )
    axes.set(xlim=(-ROOM, ROOM), ylim=(-ROOM, ROOM), aspect="equal")
    axes.set_axis_off()


def limit_to(axes: "Axes", middle: Floats, half_width: float) -> None:
    """A close-up, its axes in degrees from its middle."""
    from matplotlib.ticker import FuncFormatter  # noqa: PLC0415

    axes.set(
        xlim=(middle[0] - half_width, middle[0] + half_width),
        ylim=(middle[1] - half_width, middle[1] + half_width),
        aspect="equal",
    )
    for axis, centre in ((axes.xaxis, middle[0]), (axes.yaxis, middle[1])):
        axis.set_major_locator(steps_around(float(centre), half_width))
        axis.set_major_formatter(FuncFormatter(lambda at, _, centre=centre: signed(90 * (at - centre))))
    axes.tick_params(labelsize=8)
    axes.set_xlabel("towards φ = 0° from the straight direction", fontsize=8.5)
    axes.set_ylabel("towards φ = 90°", fontsize=8.5)
    axes.set_facecolor("white")


def signed(angle_deg: float) -> str:
    """An angle with its sign, but for 0."""
    return f"{angle_deg:+.3g}°" if abs(angle_deg) > 1e-9 else "0°"


def steps_around(centre: float, half_width: float) -> "Locator":
    """Ticks at round angles from the middle."""
    from matplotlib.ticker import FixedLocator, MaxNLocator  # noqa: PLC0415

    steps = MaxNLocator(nbins=5, steps=[1, 2, 5, 10]).tick_values(-90 * half_width, 90 * half_width)
    return FixedLocator([centre + step / 90 for step in steps])


def legend_below(axes: "Axes", below: float = 0.1) -> None:
    """The legend under the picture, where it hides nothing; `below`: room for the axis, in heights of the axes."""
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -below),
        ncols=4,
        frameon=False,
        fontsize=8.5,
        handletextpad=0.5,
        columnspacing=1.4,
    )


def positions(phi_deg: float) -> Floats:
    """(x, y) of an azimuth."""
    return np.array([np.cos(np.radians(phi_deg)), np.sin(np.radians(phi_deg))])
