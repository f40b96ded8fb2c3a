"""Fisheye pictures as panels of a figure, with a close-up of the sun."""

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from sunpeak.images import SCALE, Image, Luminance, seen, tonemap
from sunpeak.rooms import Room
from sunpeak.scenes import View

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage

PANEL_PIXELS = 250
"""Larger pictures are averaged down to about this, which takes the noise out."""

CLOSE_UP_DEG = 14.0
CLOSE_UP_SHARE = 0.34
"""Width of the close-up in the scene, and on the panel."""

CLOSE_UP_DARKER = 200.0
"""The close-up is exposed so much less that the sun does not drown its surroundings."""


def sun_place(room: Room) -> tuple[float, float]:
    """Where the sun stands on the fisheye: shares of the width rightwards, of the height downwards."""
    x, y = View.parse(room.view_options()).project([room.sun_direction])[0].tolist()
    return x, 1.0 - y


def draw_fisheye(
    axes: "Axes", pixels: npt.NDArray[np.float32], exposure: float, sun: tuple[float, float] | None = None
) -> None:
    """Draw a tone-mapped fisheye, and the sun close up in its lower right corner."""
    shown = tonemap(smaller(pixels), exposure)
    shown[~seen(shown.shape)] = 255
    axes.imshow(shown, interpolation="nearest")
    bare(axes)
    if sun is not None:
        near = axes.inset_axes((1 - CLOSE_UP_SHARE, 0, CLOSE_UP_SHARE, CLOSE_UP_SHARE))
        near.imshow(close_up(pixels, exposure, sun), interpolation="nearest")
        bare(near)
        for spine in near.spines.values():
            spine.set_color("white")


def bare(axes: "Axes") -> None:
    """Take the ticks away, and the frame."""
    axes.set(xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_color("none")


def close_up(pixels: npt.NDArray[np.float32], exposure: float, sun: tuple[float, float]) -> Image:
    """The surroundings of the sun in an angular fisheye of 180 degrees, exposed for the sun."""
    height, width = pixels.shape[:2]
    half = round(width * CLOSE_UP_DEG / 180.0 / 2)
    column, row = int(sun[0] * width), int(sun[1] * height)
    cut = pixels[max(row - half, 0) : row + half, max(column - half, 0) : column + half]
    return tonemap(cut, exposure / CLOSE_UP_DARKER)


def draw_false_colours(axes: "Axes", luminance: Luminance, limits_cd_m2: tuple[float, float]) -> "AxesImage":
    """Draw the luminance (h, w) [cd/m²] of a fisheye; give what a legend needs."""
    from matplotlib.colors import LogNorm  # noqa: PLC0415

    shown = np.where(seen(luminance.shape), np.clip(luminance, *limits_cd_m2), np.nan)
    bare(axes)
    return axes.imshow(shown, norm=LogNorm(*limits_cd_m2), cmap=SCALE)


def smaller(pixels: npt.NDArray[np.float32], across: int = PANEL_PIXELS) -> npt.NDArray[Any]:
    """Average blocks of pixels, down to about `across` on the shorter side."""
    block = max(1, min(pixels.shape[:2]) // across)
    height, width = (side // block for side in pixels.shape[:2])
    cut = pixels[: height * block, : width * block]
    mean: npt.NDArray[Any] = cut.reshape(height, block, width, block, 3).mean(axis=(1, 3))
    return mean
