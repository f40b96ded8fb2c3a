"""BSDFs from a measurement: scans of a goniophotometer, interpolated between incidences, in any basis."""

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Literal, cast

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.bases import basis_name
from sunpeak.progress import Callback
from sunpeak.runs import UNWATCHED, Run
from sunpeak.scattering import Bsdf, Floats, Mode, rows

Symmetry = Literal["find", "isotropic", "quadrilateral", "bilateral", "anisotropic"]
"""What of a sample is the same when it is turned (isotropic) or mirrored; `find` tells it by the azimuths measured."""

Energy = Literal["refuse", "scale"]
"""What to do where more light leaves than comes in."""

GRAZING_DEG = 85.0
"""Incidences and exits up to here count as measured to the horizon, for what is said of them."""

HOLE_DEG = 7.5
"""Holes between readings, half their width, that are worth a word."""


class Scan:
    """The readings of one incidence, in the frame of a BSDF: z is the front normal, y up."""

    def __init__(self, to_light: npt.ArrayLike, exits: npt.ArrayLike, values: npt.ArrayLike, name: str = "") -> None:
        """Unit vectors away from the surface, to the light (3,) and of exit (n, 3), and BSDF values (n,) [1/sr]."""
        numbers = np.ascontiguousarray(values, dtype=np.float64)
        self._core = _core.Scan(name, rows(to_light), rows(exits), numbers)

    @classmethod
    def _wrap(cls, core: _core.Scan) -> "Scan":
        scan = cls.__new__(cls)
        scan._core = core
        return scan

    @property
    def name(self) -> str:
        """Name of the sample."""
        return self._core.name

    @property
    def to_light(self) -> Floats:
        """Unit vector to the light (3,)."""
        light: Floats = self._core.to_light[0]
        return light

    @property
    def exits(self) -> Floats:
        """Unit vectors of exit (n, 3)."""
        return self._core.exits

    @property
    def values(self) -> Floats:
        """BSDF values (n,) [1/sr]."""
        return self._core.values

    def beam_fwhm_deg(self) -> float:
        """Full width at half maximum [deg] of a beam that was scanned without a sample: the instrument's own width.

        Raises `InputError` where there is no beam in the straight direction.
        """
        return self._core.beam_fwhm_deg()


def read_scans(path: str | PathLike[str]) -> list[Scan]:
    """Read the scans of a file: pab-opto's, columns in the manner of ASTM E1392, or CSV (`docs/measured.md`).

    Raises `InputError` with file and line where the file is not sound, `OSError` where it cannot be read.
    """
    return [Scan._wrap(core) for core in _core.read_scans(path)]


@dataclass(frozen=True)
class MeasuredPart:
    """One side and mode as it was measured, by incidence (n,)."""

    side: Literal["front", "back"]
    """The side that the light meets."""
    mode: Mode
    symmetry: str
    """As it was found or asked for."""
    theta_deg: Floats
    """Angle of incidence from the normal of that side."""
    phi_deg: Floats
    """Azimuth of the direction to the light, from x."""
    readings: Floats
    through: Floats
    """What goes straight, or is mirrored [-]; NaN where it was not found or not looked for."""
    readings_in_peak: Floats
    """Readings within the instrument's width of that direction where they are too few; else NaN."""
    scattered: Floats
    """Hemispherical value of the rest [-]."""
    largest_exit_deg: Floats
    """Largest angle of exit from the normal of the side on which light leaves."""
    hole_deg: Floats
    """Half the width of the largest hole between readings."""
    hole_exit_deg: Floats
    """Where its middle is: angle from the normal of the side on which light leaves."""
    hole_phi_deg: Floats
    """And azimuth from x."""

    def summary(self) -> list[str]:
        """What was measured and what was not, one line a fact."""
        name = f"{self.side} {self.mode}"
        theta = self.theta_deg
        whole = self.scattered + np.nan_to_num(self.through)
        lines = [
            f"{name}: {self.symmetry}, {len(theta)} incidences of {theta.min():.4g} to {theta.max():.4g} degrees; "
            f"hemispherical {whole.min():.4f} to {whole.max():.4f}"
        ]
        if theta.max() < GRAZING_DEG:
            lines.append(f"{name}: no incidence past {theta.max():.4g} degrees: the last one is carried on")
        if self.largest_exit_deg.min() < GRAZING_DEG:
            lines.append(f"{name}: exits end at {self.largest_exit_deg.min():.4g} degrees: constant beyond")
        worst = int(self.hole_deg.argmax())
        if self.hole_deg[worst] > HOLE_DEG:
            lines.append(
                f"{name}: no readings within {self.hole_deg[worst]:.3g} degrees of exit "
                f"{self.hole_exit_deg[worst]:.4g}, {self.hole_phi_deg[worst]:.4g} at incidence {theta[worst]:.4g}: "
                "linear across"
            )
        return lines

    def peak_summary(self) -> list[str]:
        """What went straight or was mirrored, where it was looked for."""
        name, found = f"{self.side} {self.mode}", np.isfinite(self.through)
        symbol, where = ("T", "straight") if self.mode == "transmission" else ("R", "mirrored")
        lines = []
        if found.any():
            values = self.through[found]
            lines.append(
                f"{name}: a peak of the instrument's width at {found.sum()} of {len(found)} incidences, "
                f"{symbol} {values.min():.4g} to {values.max():.4g}"
            )
        few = np.isfinite(self.readings_in_peak)
        if few.any():
            lines.append(
                f"{name}: too few readings in the {where} direction at {few.sum()} incidences: {symbol} by their "
                "neighbours"
            )
        if not (found.any() or few.any()):
            lines.append(f"{name}: no lobe as narrow as the instrument's")
        return lines


class MeasuredBsdf:
    """A BSDF from scans, with what is known of how it came about."""

    def __init__(self, core: _core.Measured, basis: str, instrument_fwhm_deg: float | None) -> None:
        """Wrap the compiled tables; users call `measured_bsdf`."""
        self.bsdf = Bsdf(core.bsdf())
        """The tables; what was found to go straight is their exact split."""
        self.instrument_fwhm_deg = instrument_fwhm_deg
        """Width of the instrument that was taken for a sharp beam; none: nothing was told apart."""
        self.parts = [
            MeasuredPart(cast("Literal['front', 'back']", side), cast("Mode", mode), symmetry, **table)
            for side, mode, symmetry, table in core.kinds()
        ]
        """The sides and modes that were measured."""
        self.scaled = core.scaled
        """Sides whose incidences gave more than they got, with `energy="scale"`: side, cells, worst sum, its angle."""
        self._basis = basis

    def summary(self) -> str:
        """Say how it was made and what was not measured, one line a fact."""
        lines = [f"Made by Sunpeak {_core.__version__} from scans, in {self._basis}: lobes moved between incidences"]
        lines += [line for part in self.parts for line in part.summary()]
        if self.instrument_fwhm_deg is None:
            lines.append("instrument's width not stated: what goes straight is not told from what is scattered")
        else:
            lines.append(f"instrument: {self.instrument_fwhm_deg:.4g} degrees, full width at half maximum")
            lines += [line for part in self.parts for line in part.peak_summary()]
        for side, cells, worst, theta in self.scaled:
            lines.append(
                f"warning: {side}: transmittance and reflectance up to {worst:.4f} (at {theta:.1f} degrees): "
                f"scaled to 1 in {cells} incident cells"
            )
        return "\n".join(lines)

    def save(
        self,
        path: str | PathLike[str],
        *,
        name: str | None = None,
        manufacturer: str | None = None,
        thickness_m: float | None = None,
    ) -> None:
        """Write an LBNL XML file with the summary as a comment, whole or not at all."""
        self.bsdf.save(path, name=name, manufacturer=manufacturer, thickness_m=thickness_m, comments=self.summary())

    def save_split(self, folder: str | PathLike[str]) -> list[Path]:
        """Write the exact split to a folder, as `Bsdf.save_split`."""
        return self.bsdf.save_split(folder)


def measured_bsdf(
    scans: Sequence[Scan | str | PathLike[str]],
    basis: str = "klems",
    *,
    resolution: int | None = None,
    symmetry: Symmetry = "find",
    instrument_fwhm_deg: float | None = None,
    beam: Scan | str | PathLike[str] | None = None,
    energy: Energy = "refuse",
    progress: bool | Callback = False,
    run: Run = UNWATCHED,
) -> MeasuredBsdf:
    """Make a BSDF of scans, or of the files that hold them: all sides and modes that they have.

    `basis` and `resolution` as for `Bsdf.convert`. `symmetry` completes what was measured; `find` takes one azimuth of
    incidence for an isotropic sample, a quarter of the hemisphere for a quadrilateral one, a half for a bilateral one.

    `instrument_fwhm_deg` (full width at half maximum, 0.05 to 20) is what the instrument makes of a sharp beam; `beam`
    is a scan of the bare beam to take it from. With either, a lobe of that width in the straight direction becomes an
    exact peak, and one in the mirrored direction lies in its cells as sharp as they are. Where transmittance and
    reflectance add up to more than 1 the measurement is refused, or with `energy="scale"` scaled. A `run` keeps
    finished columns after Ctrl-C and shows its own progress.

    Raises `InputError` where scans, symmetry or basis do not fit.
    """
    given = [part for scan in scans for part in _scans(scan)]
    if beam is not None:
        if instrument_fwhm_deg is not None:
            raise _core.InputError("instrument_fwhm_deg and beam; expected one of them")
        alone = _scans(beam)
        if len(alone) != 1:
            raise _core.InputError(f"beam: {len(alone)} incidences; expected the scan of one bare beam")
        instrument_fwhm_deg = alone[0].beam_fwhm_deg()
    name = basis_name(basis, resolution)
    watched = Run(progress=progress) if run is UNWATCHED else run
    with watched.watching("tabulating") as watch:
        core = _core.measured_bsdf([scan._core for scan in given], name, symmetry, instrument_fwhm_deg, energy, *watch)
    return MeasuredBsdf(core, name, instrument_fwhm_deg)


def _scans(source: Scan | str | PathLike[str]) -> list[Scan]:
    return [source] if isinstance(source, Scan) else read_scans(source)
