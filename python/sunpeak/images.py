"""Pictures for people: tone-mapped and false-colour images of luminance.

Both work on linear arrays, so that pictures that are to be compared can share one exposure or one scale.
"""

import io
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from sunpeak.files import whole_file

LUMINOUS_EFFICACY = 179.0
"""Luminous efficacy of Radiance's white [lm/W] (Ward and Shakespeare 1998)."""

LUMINANCE_WEIGHTS = np.array([0.265, 0.670, 0.065])
"""Share of each channel of Radiance's primaries in the luminous value."""

MIDDLE_GRAY = 0.18
"""Where the log-average luminance is put (Reinhard et al. 2002, "Photographic Tone Reproduction", key value)."""

WHITE_PERCENTILE = 99.5
"""Share of the pixels [%] that must not clip: the sun and its like may."""

SCALE = "inferno"
"""Colours of luminance: even steps to the eye, and to eyes that do not tell red from green."""

Image = npt.NDArray[np.uint8]
Luminance = npt.NDArray[np.floating[Any]]


def luminance_cd_m2(pixels: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Luminance [cd/m²] of radiances (..., 3) [W sr⁻¹ m⁻²]."""
    luminance: npt.NDArray[np.float64] = LUMINOUS_EFFICACY * (np.asarray(pixels, dtype=np.float64) @ LUMINANCE_WEIGHTS)
    return luminance


def exposure_of(luminance: Luminance) -> float:
    """Factor [m²/cd] that puts the log-average of the lit pixels at middle gray."""
    lit = luminance[luminance > 0]
    return MIDDLE_GRAY / float(np.exp(np.mean(np.log(lit)))) if lit.size else 1.0


def tonemap(pixels: npt.NDArray[np.floating[Any]], exposure: float | None = None) -> Image:
    """Display image (h, w, 3) of radiances (h, w, 3), by the extended photographic operator (Reinhard et al. 2002).

    `exposure` [m²/cd] multiplies the luminance; by default it follows from the picture. Equal-energy white is shown
    as the display's white.
    """
    luminance = luminance_cd_m2(pixels)
    scaled = luminance * (exposure_of(luminance) if exposure is None else exposure)
    white = max(float(np.percentile(scaled, WHITE_PERCENTILE)), 1.0)
    display = scaled * (1.0 + scaled / white**2) / (1.0 + scaled)
    ratio = np.divide(display, luminance, out=np.zeros_like(luminance), where=luminance > 0)
    return encode_srgb(LUMINOUS_EFFICACY * np.asarray(pixels) * ratio[..., None])


def encode_srgb(linear: npt.NDArray[np.floating[Any]]) -> Image:
    """Eight-bit sRGB (IEC 61966-2-1) of linear values, clipped to [0, 1]."""
    value = np.clip(linear, 0.0, 1.0)
    encoded = np.where(value <= 0.0031308, 12.92 * value, 1.055 * np.power(value, 1 / 2.4) - 0.055)
    image: Image = np.round(255.0 * encoded).astype(np.uint8)
    return image


def seen(shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Pixels (h, w) of a fisheye of 180 degrees that are before the eye; an angular one has corners that look back."""
    height, width = shape[:2]
    y, x = np.mgrid[0:height, 0:width]
    inside: npt.NDArray[np.bool_] = np.hypot((x + 0.5) / width - 0.5, (y + 0.5) / height - 0.5) <= 0.5
    return inside


def false_colour(
    luminance: Luminance, limits_cd_m2: tuple[float, float], seen: npt.NDArray[np.bool_] | None = None
) -> Image:
    """Image (h, w, 3) of luminance (h, w) [cd/m²] on a logarithmic scale; what is not `seen` is white."""
    low, high = limits_cd_m2
    share = np.log(np.clip(luminance, low, high) / low) / np.log(high / low)
    image: Image = np.round(255.0 * colours(share)).astype(np.uint8)
    if seen is not None:
        image[~seen] = 255
    return image


def colours(share: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.float64]:
    """Colours (..., 3) of the false-colour scale, 0 to 1 along it."""
    from matplotlib import colormaps  # noqa: PLC0415  (half a second that `--help` need not spend)

    return np.asarray(colormaps[SCALE](share), dtype=np.float64)[..., :3]


def png_bytes(image: Image) -> bytes:
    """PNG file of an image (h, w, 3)."""
    from matplotlib import image as writer  # noqa: PLC0415

    buffer = io.BytesIO()
    writer.imsave(buffer, image, format="png")
    return buffer.getvalue()


def save_png(image: Image, path: str | PathLike[str]) -> None:
    """Write an image (h, w, 3) as PNG."""
    with whole_file(path) as temporary:
        temporary.write_bytes(png_bytes(image))


def save_false_colour(
    luminance: Luminance,
    path: str | PathLike[str],
    *,
    limits_cd_m2: tuple[float, float] | None = None,
    seen: npt.NDArray[np.bool_] | None = None,
    title: str | None = None,
) -> None:
    """Write luminance (h, w) [cd/m²] in false colours with a legend, on a logarithmic scale, as PNG.

    `limits_cd_m2` are the ends of the scale, by default whole decades around the picture. Pixels that are not `seen`
    (outside a fisheye's circle) stay blank.
    """
    from matplotlib.colors import LogNorm  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    low, high = limits_cd_m2 or decades(luminance)
    height, width = luminance.shape
    figure = Figure(figsize=(width / 100 + 1.2, height / 100 + (0.4 if title else 0.1)), dpi=100, layout="constrained")
    axes = figure.add_subplot()
    clipped = np.clip(luminance, low, high)
    shown = clipped if seen is None else np.where(seen, clipped, np.nan)
    drawn = axes.imshow(shown, norm=LogNorm(low, high), cmap=SCALE, interpolation="nearest")
    axes.set_axis_off()
    if title:
        axes.set_title(title, fontsize=10)
    figure.colorbar(drawn, ax=axes, label="luminance [cd/m²]", fraction=0.046, pad=0.02)
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png")


def decades(luminance: Luminance) -> tuple[float, float]:
    """Whole powers of ten around the lit part of a picture, at most six decades [cd/m²]."""
    lit = luminance[luminance > 0]
    if not lit.size:
        return 1.0, 10.0
    low = np.floor(np.log10(np.percentile(lit, 1.0)))
    high = max(np.ceil(np.log10(lit.max())), low + 1)
    return 10.0 ** max(low, high - 6), 10.0**high
