"""Rendering: pictures, rays and sensors by path tracing."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Literal

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.pictures import Picture
from sunpeak.progress import Callback, progress_bar
from sunpeak.scattering import Floats, Peak, rows
from sunpeak.scenes import Scene, View

DEFAULT_SIZE = (512, 512)


class World:
    """A scene compiled for rendering, with one rule for the peaks. Immutable; use it for many pictures."""

    def __init__(self, core: _core.World) -> None:
        """Wrap the compiled world; users call `compile`."""
        self._core = core

    @classmethod
    def compile(cls, scene: Scene, peak: Peak = "split", portals: Sequence[str] = ()) -> "World":
        """Compile a scene: geometry, materials, lights, and the BSDF files that it names.

        Light comes into rooms through shades, windows and holes in polygons, to which paths are sent; they are found.
        `portals` names more: surfaces or modifiers, of an opening between walls, say, or of one polygon in place of
        very many panes (with the modifier `void` it is invisible). Paths can be sent to 32 triangles; if those that are
        found make it more, to those that are named alone. Portals change how fast numbers converge, and not the
        numbers.

        Raises `InputError` with file, line and column for what the scene does not allow.
        """
        names = [portals] if isinstance(portals, str) else list(portals)
        return cls(_core.World.compile(scene._core, peak, names))


def render(
    scene: Scene | World,
    view: View,
    size: tuple[int, int] = DEFAULT_SIZE,
    *,
    peak: Peak = "split",
    samples: int | None = None,
    time: float | None = None,
    error: float | None = None,
    until: Literal["class"] | tuple[Literal["dgp", "ev"], float] | None = None,
    seed: int = 0,
    threads: int | None = None,
    max_bounces: int | None = None,
    ambient: tuple[float, float, float] = (0.0, 0.0, 0.0),
    portals: Sequence[str] = (),
    progress: bool | Callback = False,
) -> Picture:
    """Render a picture of `size` (width, height) pixels.

    It takes `samples` paths for a pixel in the mean (64 unless told otherwise; noisy blocks of pixels get more, others
    less), or as many as fit in `time` seconds, or as many as bring the error below `error` [-] with 95 % confidence:
    the root mean square over blocks of pixels, about 3 degrees wide (a power of two, 4 to 32 pixels), of the error of
    their luminance, over the mean luminance of all (0.01 is 1 %). The picture says what was reached (`Picture.error`).
    `until` asks for a glare number instead: `"class"` until the comfort class cannot change, `("dgp", 0.005)` or
    `("ev", 0.01)` until the 95 % interval of DGP, or that of Ev over Ev, is no wider than that to each side. With
    several, whatever comes first ends it.

    The same seed and number of samples give the same picture on any number of `threads` (None: all cores).
    `max_bounces` limits diffuse bounces, as Radiance's `-ab`; None is no limit. `ambient` (three channels
    [W sr⁻¹ m⁻²]) stands for all diffuse light past them, as Radiance's `-av`. `peak` says which part of `aBSDF`
    tables goes straight through, and `portals` names where else light comes in (see `World.compile`); a `World` has
    chosen both already.

    `progress` shows a bar on standard error, or is a function that is called with the work done and in all. Ctrl-C
    stops the rendering (`KeyboardInterrupt`).
    """
    width, height = size
    world = compiled(scene, peak, portals)
    goal = (until, 0.0) if isinstance(until, str) else until
    with reporting(progress, "rendering") as callback:
        picture = _core.render(
            world._core,
            view._core,
            width,
            height,
            samples,
            time,
            error,
            seed,
            threads,
            max_bounces,
            ambient,
            goal,
            callback,
        )
    return Picture(picture)


def trace(
    scene: Scene | World,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike,
    *,
    irradiance: bool = False,
    peak: Peak = "split",
    samples: int | None = None,
    time: float | None = None,
    error: float | None = None,
    error_of_each: bool = False,
    with_errors: bool = False,
    seed: int = 0,
    threads: int | None = None,
    max_bounces: int | None = None,
    ambient: tuple[float, float, float] = (0.0, 0.0, 0.0),
    portals: Sequence[str] = (),
    progress: bool | Callback = False,
) -> Floats:
    """Radiance along rays (n, 3) [W sr⁻¹ m⁻²], or irradiance at sensors [W m⁻²]: three channels (n, 3).

    `origins` (n, 3) are points [m]; `directions` (n, 3) are where the rays go, or the normals of the sensors; their
    length does not count. `error` is relative to the mean of all; with `error_of_each` that of each ray is relative to
    its own, so that a dark sensor counts as much as a bright one. `with_errors` gives a fourth column: the standard
    error of the luminous mean of the three, in their unit; NaN after fewer than 16 paths. The other arguments are those
    of `render`.
    179 (0.265 R + 0.670 G + 0.065 B) gives luminance [cd/m²] or illuminance [lx].
    """
    points, towards = rows(origins), normalized(rows(directions))
    if len(points) != len(towards):
        raise _core.InputError(f"{len(points)} origins and {len(towards)} directions; expected as many of both")
    world = compiled(scene, peak, portals)
    with reporting(progress, "tracing") as callback:
        values, errors = _core.trace(
            world._core,
            points,
            towards,
            irradiance,
            samples,
            time,
            error,
            seed,
            threads,
            max_bounces,
            ambient,
            error_of_each,
            callback,
        )
    if not with_errors:
        return values
    return np.column_stack([values, np.full(len(values), np.nan) if errors is None else errors])


def compiled(scene: Scene | World, peak: Peak, portals: Sequence[str] = ()) -> World:
    """Compile the scene unless that was done."""
    return scene if isinstance(scene, World) else World.compile(scene, peak, portals)


def normalized(vectors: Floats) -> Floats:
    """Unit vectors; what has no direction is refused with its row."""
    lengths = np.linalg.norm(vectors, axis=1)
    wrong = np.flatnonzero(~(np.isfinite(lengths) & (lengths > 0)))
    if wrong.size:
        raise _core.InputError(f"directions: row {wrong[0]} is {vectors[wrong[0]].tolist()}; expected a direction")
    unit: Floats = vectors / lengths[:, None]
    return unit


@contextmanager
def reporting(progress: bool | Callback, title: str) -> Iterator[Callback | None]:
    """Give the function to call with the progress, if any."""
    if callable(progress):
        yield progress
    else:
        with progress_bar(title, progress) as callback:
            yield callback
