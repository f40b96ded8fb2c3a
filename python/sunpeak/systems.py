"""Glazing systems: panes and shades behind each other, as one BSDF."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.bands import write_bands
from sunpeak.panes import Pane
from sunpeak.runs import UNWATCHED, Run
from sunpeak.scattering import Bsdf, Floats, rows

Band = Literal["visible", "solar"]
"""CIE photopic observer times illuminant D65, or direct sunlight at air mass 1.5 (ASTM E891-87), as NFRC 300 weighs."""

Panes = Literal["mean", "middle"]
"""What stands for a pane in a patch of a Klems basis: its mean by flux, or its value at the middle angle (WINDOW)."""


WINDOW_STEP_DEG = 10.0
"""Steps of incidence in which WINDOW sums the hemisphere for panes."""


@dataclass(frozen=True)
class Shade:
    """What scatters: a fabric, a blind, a diffusing pane, by its BSDF."""

    visible: Bsdf
    """Visible values."""
    solar: Bsdf | None = None
    """Solar values, if they are known."""
    flipped: bool = False
    """The file's back towards the outside."""
    name: str = "shade"
    """What it is called."""
    _layer: _core.Layer = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Make the compiled layer."""
        solar = None if self.solar is None else self.solar._core
        object.__setattr__(self, "_layer", _core.Layer.shade(self.visible._core, solar, self.flipped))

    @classmethod
    def load(cls, path: str | PathLike[str], *, flipped: bool = False) -> "Shade":
        """Read an LBNL XML file, with its solar band if it has one, or the folder of a split."""
        visible = Bsdf.load(path)
        solar = None
        if not Path(path).is_dir() and "Solar" in visible.describe()["bands"]:
            solar = Bsdf.load_solar(path)
        return cls(visible, solar, flipped, visible.describe()["name"] or Path(path).stem)


class Straight(NamedTuple):
    """Light that keeps its direction, one row for each direction."""

    transmittance: Floats
    """Straight through [-]."""
    reflectance: Floats
    """Mirrored [-]."""


class System:
    """Layers from outside to inside; gaps have no optics. Light is followed through all reflections between them."""

    def __init__(self, layers: Sequence[Pane | Shade], name: str | None = None) -> None:
        """Put layers behind each other, the outermost first."""
        self.layers = tuple(layers)
        self.name = name or " + ".join(layer.name for layer in layers)
        self._core = _core.System(self.name, [layer._layer for layer in layers])

    @property
    def has_solar(self) -> bool:
        """Whether the solar values of all layers are known."""
        return not self._core.lacks_solar()

    def straight(self, w_in: npt.ArrayLike, band: Band = "visible") -> Straight:
        """Light from `w_in` (n, 3) that goes straight through, and that is mirrored; outside is at positive z.

        Exact at each direction: of panes alone it is all of the light. Every pane keeps polarisations apart by itself,
        as WINDOW does; between panes they are not followed.
        """
        return Straight(*self._core.straight(rows(w_in), band).T)

    def diffuse(
        self, band: Band = "visible", *, inside: bool = False, steps: int = 400, window: bool = False
    ) -> Straight:
        """Of light from everywhere alike, what keeps its direction: the mean over the hemisphere by flux.

        `window` gives the number of WINDOW's reports instead: trapezoids of 10 degrees, which come out 0.5 to 0.7 % low
        for the transmittance of panes (`validation/systems.md`).
        """
        if window:
            theta = np.radians(np.arange(0.0, 90.0, WINDOW_STEP_DEG))
            # The sum's ends, at 0 and 90 degrees, have no weight.
            sine, weights = np.sin(theta), np.radians(WINDOW_STEP_DEG) * np.sin(2.0 * theta)
        else:
            sine, weights = np.sqrt((np.arange(steps) + 0.5) / steps), np.full(steps, 1.0 / steps)
        cosine = np.sqrt(1.0 - sine**2) * (-1.0 if inside else 1.0)
        w_in = np.stack([sine, np.zeros_like(sine), cosine], axis=-1)
        return Straight(*(np.atleast_1d(part @ weights) for part in self.straight(w_in, band)))

    def bsdf(
        self, basis: str = "klems", band: Band = "visible", *, panes: Panes = "mean", run: Run = UNWATCHED
    ) -> Bsdf:
        """Tabulate one band; what goes straight through is kept exact beside the table, for `through` and `save_split`.

        Bases as for `Fabric.write`. The outside of the system is the file's front, so the back of the BSDF's frame.
        """
        with run.watching(f"{band} band") as watch:
            return Bsdf(self._core.tabulate(basis, band, panes == "middle", *watch))

    def write(
        self,
        path: str | PathLike[str],
        basis: str = "klems",
        *,
        split: str | PathLike[str] | None = None,
        panes: Panes = "mean",
        run: Run = UNWATCHED,
    ) -> None:
        """Write an LBNL XML file, whole or not at all: visible, and solar if all layers have it.

        `split` names a folder for the visible band with its exact straight part (`Bsdf.load` reads it).
        """
        solar = self.bsdf(basis, "solar", panes=panes, run=run) if self.has_solar else None
        layers = "; ".join(layer.name for layer in self.layers)
        comments = f"Layers from outside to inside: {layers}. Panes in patches: {panes}."
        visible = self.bsdf(basis, "visible", panes=panes, run=run)
        write_bands(visible, solar, path, split, comments=comments)
