"""Fabrics of our own making: formulas in, an LBNL XML file out. What a table should give back is known exactly."""

import math
from dataclasses import asdict, dataclass
from os import PathLike

from sunpeak import _core
from sunpeak.bands import UNLABELLED, Label, write_bands
from sunpeak.glare_control import glare_control_class
from sunpeak.runs import UNWATCHED, Run
from sunpeak.scattering import Bsdf


@dataclass(frozen=True)
class Fabric:
    """An isotropic fabric, both sides alike: holes, a lobe around the straight direction, and a diffuse part."""

    openness: float = 0.02
    """Through transmittance at normal incidence [-]."""
    cut_off_deg: float = 68.0
    """Angle of incidence from which nothing goes straight through."""
    exponent: float = 0.6
    """Steepness of the fall towards the cut-off."""
    scattered: float = 0.06
    """Scattered transmittance, the same at every incidence [-]."""
    lobe_share: float = 0.4
    """Share of the scattered part in the lobe; the rest is diffuse [-]."""
    lobe_sigma: float = 0.25
    """Width of the Gaussian lobe on the disk of projected directions; 0.25 is 14 degrees."""
    reflectance: float = 0.35
    """Diffuse reflectance [-]."""

    def through(self, incidence_rad: float) -> float:
        """Through transmittance [-]: openness cos(90 deg incidence / cut-off) ^ exponent, nothing past the cut-off."""
        share = incidence_rad / math.radians(self.cut_off_deg)
        return self.openness * math.cos(math.pi / 2 * share) ** self.exponent if share < 1.0 else 0.0

    def write(
        self,
        path: str | PathLike[str],
        basis: str = "klems",
        *,
        label: Label = UNLABELLED,
        run: Run = UNWATCHED,
    ) -> None:
        """Tabulate by exact cell averages and write an LBNL XML file, whole or not at all.

        `basis` is `klems`, `klems-half`, `klems-quarter`, or an isotropic or anisotropic tensor tree by the number of
        its exiting cells: `t3-1024`, `t3-4096`, `t3-16384`, `t4-1024` …
        """
        with run.watching("averaging over cells") as watch:
            bsdf = Bsdf(_core.synthetic_bsdf("fabric", asdict(self), basis, None, 0.0, 0.0, 1, *watch))
        write_bands(bsdf, None, path, label=label)


@dataclass(frozen=True)
class RollerBlind:
    """A roller blind by its datasheet, in the quantities of EN 14500, visible or solar.

    Off-normal values follow Kotey, Wright and Collins, "Determining off-normal solar optical properties of roller
    blinds", ASHRAE Transactions 115(1), 2009. Both sides let the same through, and scattered light leaves as
    reciprocity then asks.
    """

    tau_nn: float
    """Normal-normal transmittance [-]: straight through at normal incidence. Not the nominal openness."""
    tau_nh: float
    """Normal-hemispherical transmittance [-]: all that gets through at normal incidence, `tau_nn` included."""
    rho_front: float
    """Normal-hemispherical reflectance of the side towards the sun [-]."""
    rho_back: float
    """The same of the side towards the room [-]."""
    cut_off_deg: float | None = None
    """Angle of incidence from which nothing goes straight through; none: the model's, 65 and more by the openness."""
    colour: tuple[float, float, float] | None = None
    """Of the threads: red to green to blue (Radiance's primaries, linear) of what is scattered and reflected."""

    def through(self, incidence_rad: float) -> float:
        """Through transmittance [-] at an angle of incidence."""
        return self._at(incidence_rad)[0]

    def total(self, incidence_rad: float) -> float:
        """Transmittance in all [-], straight and scattered, at an angle of incidence."""
        return self._at(incidence_rad)[1]

    def cut_off(self) -> float:
        """Angle of incidence from which nothing goes straight through [deg]."""
        return self._at(0.0)[2]

    def glare_control_class(self) -> int:
        """Glare control from 0 to 4, as EN 14501:2005 is quoted; see `sunpeak.glare_control`."""
        return glare_control_class(self.tau_nn, self.tau_nh - self.tau_nn)

    def _numbers(self) -> tuple[float, float, float, float, float | None, tuple[float, float, float] | None]:
        return self.tau_nn, self.tau_nh, self.rho_front, self.rho_back, self.cut_off_deg, self.colour

    def _at(self, incidence_rad: float) -> tuple[float, float, float]:
        return _core.roller_blind_transmittance(*self._numbers(), incidence_rad)

    def bsdf(self, basis: str = "klems", *, run: Run = UNWATCHED) -> Bsdf:
        """Tabulate by exact cell averages and keep what goes straight as the model has it; bases as for `Fabric`.

        Raises `InputError` where the numbers contradict each other.
        """
        with run.watching("averaging over cells") as watch:
            return Bsdf(_core.roller_blind(basis, *self._numbers(), *watch))

    def write(
        self,
        path: str | PathLike[str],
        basis: str = "klems",
        *,
        solar: "RollerBlind | None" = None,
        split: str | PathLike[str] | None = None,
        label: Label = UNLABELLED,
        run: Run = UNWATCHED,
    ) -> None:
        """Write an LBNL XML file of what `bsdf` gives, whole or not at all; with the `solar` values as a second band.

        `split` names a folder for the visible band with its exact straight part, which `Bsdf.load` reads.
        """
        beside = None if solar is None else solar.bsdf(basis, run=run)
        bands = {"visible": self} if solar is None else {"visible": self, "solar": solar}
        told = "; ".join(f"{name}: {sheet._told()}" for name, sheet in bands.items())
        comments = f"Roller blind by Kotey, Wright and Collins (2009), exact means over cells; {told}"
        write_bands(self.bsdf(basis, run=run), beside, path, split, comments=comments, label=label)

    def _told(self) -> str:
        shares = {"tau_nn": self.tau_nn, "tau_nh": self.tau_nh, "rho_front": self.rho_front, "rho_back": self.rho_back}
        told = ", ".join(f"{name} {100 * share:.4g} %" for name, share in shares.items())
        return f"{told}, cut-off {self.cut_off():.4g} degrees"
