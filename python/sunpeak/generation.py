"""BSDFs from geometry: a virtual goniophotometer on the ray tracer, as genBSDF is one on Radiance's."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.files import check_target, whole_file, write_text
from sunpeak.progress import Callback
from sunpeak.rendering import World, compiled, normalized, reporting
from sunpeak.scattering import Bsdf, Floats, Peak, rows
from sunpeak.scenes import Scene

SideName = Literal["front", "back"]
"""Where the light comes from: `front` runs along +z (outside to inside; genBSDF's forward), `back` along -z."""

Errors = npt.NDArray[np.float32]
"""Standard errors of cells, (columns, cells)."""

Box = tuple[float, float, float, float, float, float]
"""xmin, xmax, ymin, ymax, zmin, zmax, as genBSDF's -dim."""


@dataclass(frozen=True)
class GeneratedSide:
    """Hemispherical values [-] of one side, by incident cell (columns,), with their standard errors."""

    side: SideName
    through: Floats
    """Straight through."""
    through_error: Floats
    transmittance: Floats
    """All that is transmitted, straight and scattered."""
    transmittance_error: Floats
    reflectance: Floats
    reflectance_error: Floats
    samples: Floats
    """Rays that came in."""
    transmission_cell_error: float
    """Root mean square standard error of the cells of the scattered transmission, over their root mean square [-]."""
    reflection_cell_error: float
    transmission_errors: Errors | None
    """If asked for: standard error of each cell [1/sr], (columns, cells), of scattered light, before cells merge."""
    reflection_errors: Errors | None
    """The same of the reflection."""


class StraightTransmittance(NamedTuple):
    """What goes straight through, for each direction (n,)."""

    through: Floats
    error: Floats
    """Standard error."""


class GeneratedBsdf:
    """What a virtual goniophotometer has found."""

    def __init__(self, core: _core.Generated, made_by: str) -> None:
        """Wrap the compiled tables; users call `generate_bsdf`."""
        self._core = core
        self._made_by = made_by
        tables = zip(core.sides(), core.cell_errors(), strict=True)
        self.sides = [_side(*side, cells) for side, cells in tables]
        """The sides that were traced."""
        self.samples, self.rays, self.lost = core.totals
        self.box = core.corners
        """Smallest and largest corner of the sampled box (2, 3)."""

    @property
    def bsdf(self) -> Bsdf:
        """The tables; their split is exact: what went straight was counted apart."""
        return Bsdf(self._core.bsdf())

    def summary(self) -> str:
        """Say how it was made and how exact it is, one line a fact."""
        width, height, depth = self.box[1] - self.box[0]
        lines = [self._made_by, f"{self.samples} rays came in through {width:.6g} by {height:.6g}, {depth:.6g} deep"]
        lines += [line for side in self.sides for line in _told(side)]
        if self.lost > 0:
            lines.append(f"up to {100 * self.lost:.2g} % of a column's light was given up on its way")
        return "\n".join(lines)

    def xml(self, geometry: Scene | None = None) -> str:
        """The text of an LBNL XML file, with the summary as a comment, and the `geometry` that was traced as MGF.

        The geometry is moved so that the middle of the box's upper face is the origin, where proxies have it. Raises
        `InputError` where it has a material that MGF has no words for.
        """
        return self._core.xml(self.summary(), None if geometry is None else geometry._core)

    def save(self, path: str | PathLike[str], *, geometry: Scene | None = None) -> None:
        """Write what `xml` gives, whole or not at all."""
        write_text(path, self.xml(geometry))

    def save_errors(self, path: str | PathLike[str]) -> None:
        """Write the standard errors of all cells and of the hemispherical values as NumPy's .npz, whole or not at all.

        `front_transmission`, `front_reflection`, `back_…` are [1/sr], (columns, cells) in the order of the basis, of
        scattered light before cells come together; `…_hemispherical` and `front_through` are [-], (columns,).
        """
        arrays: dict[str, Any] = {}
        for side in self.sides:
            if side.transmission_errors is None or side.reflection_errors is None:
                raise _core.InputError("errors of cells were not kept; expected generate_bsdf(…, cell_errors=True)")
            arrays |= {
                f"{side.side}_transmission": side.transmission_errors,
                f"{side.side}_reflection": side.reflection_errors,
                f"{side.side}_transmission_hemispherical": side.transmittance_error,
                f"{side.side}_reflection_hemispherical": side.reflectance_error,
                f"{side.side}_through": side.through_error,
            }
        with whole_file(path) as temporary, temporary.open("wb") as file:
            np.savez_compressed(file, **arrays)

    def save_split(self, folder: str | PathLike[str]) -> list[Path]:
        """Write the exact split to a folder, as `Bsdf.save_split`."""
        return self.bsdf.save_split(folder)


def generate_bsdf(
    scene: Scene | World,
    basis: str = "klems",
    *,
    box: Box | None = None,
    periodic: bool = False,
    sides: tuple[SideName, ...] = ("front", "back"),
    samples: int | None = None,
    error: float = 0.01,
    tolerance: float = 0.05,
    reciprocity: bool = True,
    colour: bool = False,
    cell_errors: bool = False,
    peak: Peak = "split",
    name: str = "",
    manufacturer: str = "",
    made_by: str = "",
    seed: int = 0,
    threads: int | None = None,
    state: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: bool | Callback = False,
) -> GeneratedBsdf:
    """Trace rays through a product and count where they leave.

    x is to the right, y up, z towards the room. Rays start on the faces of `box` (xmin, xmax, ymin, ymax, zmin, zmax;
    the box around the geometry without it), evenly over the face and over the projected solid angle of each incident
    cell of `basis` (`klems`, `klems-half`, `klems-quarter`, `t3-N`, `t4-N` by the number of exiting cells). With
    `periodic` the box repeats in x and y for ever; without it rays that pass its sides go on, as with genBSDF.

    Each column gets `samples` rays and goes on, up to 16 times as many, until the root sum of squares of its cells'
    standard errors is `error` of what it scatters. Cells of a tensor tree come together where they differ by no more
    than `tolerance` of their mean, or by no more than their errors explain. `reciprocity` averages values that
    Helmholtz's reciprocity makes equal; turn it off for materials that break it. Isotropic trees (`t3`) are the mean
    over all azimuths. `colour` keeps three channels; otherwise all is luminous. `cell_errors` keeps the standard error
    of every cell (`GeneratedBsdf.save_errors`). Lights in the scene are black.

    With `state`, Ctrl-C keeps the finished columns in that file, and `resume` goes on from it; it is removed when all
    is done. The same seed gives the same tables on any number of `threads`.

    Raises `InputError` where box, geometry or numbers do not fit.
    """
    world = compiled(scene, peak)
    corners = None if box is None else (box[0::2], box[1::2])
    if state is not None:
        check_target(state)
    with reporting(progress, "tracing columns") as callback:
        core = _core.generate_bsdf(
            world._core,
            name,
            manufacturer,
            basis,
            corners,
            periodic,
            list(sides),
            samples,
            error,
            tolerance,
            reciprocity,
            colour,
            cell_errors,
            seed,
            threads,
            state,
            resume,
            callback,
        )
    return GeneratedBsdf(core, made_by or f"Generated by Sunpeak {_core.__version__} from geometry")


def straight_transmittance(
    scene: Scene | World,
    directions: npt.ArrayLike,
    *,
    box: Box | None = None,
    periodic: bool = False,
    samples: int = 1 << 16,
    seed: int = 0,
    peak: Peak = "split",
) -> StraightTransmittance:
    """What goes straight through a product, by `samples` rays for each of the `directions` (n, 3) in which light runs.

    Box and edges as for `generate_bsdf`. Luminous (n,), with standard errors.
    """
    world = compiled(scene, peak)
    corners = None if box is None else (box[0::2], box[1::2])
    towards = normalized(rows(directions))
    means, errors = _core.straight_transmittance(world._core, towards, corners, periodic, samples, seed)
    weights = np.array([0.265, 0.670, 0.065])
    return StraightTransmittance(means @ weights, errors @ weights)


def _side(
    name: str, errors: tuple[float, float], table: dict[str, Floats], cells: tuple[Errors, Errors] | None
) -> GeneratedSide:
    side: SideName = "front" if name == "front" else "back"
    columns = len(table["through"])
    transmission, reflection = (None, None) if cells is None else (mode.reshape(columns, -1) for mode in cells)
    return GeneratedSide(
        side,
        **table,
        transmission_cell_error=errors[0],
        reflection_cell_error=errors[1],
        transmission_errors=transmission,
        reflection_errors=reflection,
    )


def _told(side: GeneratedSide) -> list[str]:
    worst = {
        "through": side.through_error.max(),
        "transmittance": side.transmittance_error.max(),
        "reflectance": side.reflectance_error.max(),
    }
    told = ", ".join(f"{name} {value:.1e}" for name, value in worst.items())
    cells = f"{100 * side.transmission_cell_error:.2g} % of transmission, {100 * side.reflection_cell_error:.2g} %"
    return [
        f"{side.side}: largest standard errors of hemispherical values: {told}",
        f"{side.side}: standard error of cells (root mean square, scattered light): {cells} of reflection",
    ]
