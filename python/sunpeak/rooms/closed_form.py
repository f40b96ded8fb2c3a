"""What the sun's luminance behind a facade must be, from closed forms alone."""

import math
from dataclasses import dataclass

from sunpeak.images import luminance_cd_m2
from sunpeak.rooms.fabric import FABRIC
from sunpeak.rooms.room import Room

GLASS_INDEX = 1.52
"""Refractive index of `glass` in Radiance unless the material states another (reference manual, "Glass")."""


@dataclass(frozen=True)
class Expectation:
    """The sun through glass and fabric."""

    incidence_deg: float
    """Between the sun and the facade's normal."""
    fabric_transmittance: float
    """Straight through the fabric [-]."""
    glazing_transmittance: float
    """Through both panes, the light that is mirrored between them included [-]."""
    sun_cd_m2: float
    """The sun's disc outside."""

    @property
    def luminance_cd_m2(self) -> float:
        """Luminance of the disc behind glass and fabric."""
        return self.fabric_transmittance * self.glazing_transmittance * self.sun_cd_m2

    def in_words(self) -> str:
        """The closed form in a line."""
        return (
            f"T_fabric {self.fabric_transmittance:.5f} x T_glazing {self.glazing_transmittance:.4f}"
            f" x L_sun {self.sun_cd_m2:.4g} = {self.luminance_cd_m2:,.0f} cd/m²"
            f" at {self.incidence_deg:.1f} degrees from the fabric's normal"
        )


def expectation(room: Room) -> Expectation:
    """Work it out for a room; the facade's normal is the y axis."""
    radiance = room.sky().sun_radiance
    assert radiance is not None
    cosine = abs(room.sun_direction[1])
    return Expectation(
        incidence_deg=math.degrees(math.acos(cosine)),
        fabric_transmittance=FABRIC.through(math.acos(cosine)),
        glazing_transmittance=glazing_transmittance(room.glazing.transmissivity, cosine, room.glazing.panes),
        sun_cd_m2=float(luminance_cd_m2(radiance)),
    )


def glazing_transmittance(transmissivity: float, cosine: float, panes: int) -> float:
    """Transmittance [-] of parallel panes, all reflections between them included (geometric series)."""
    transmittance, reflectance = pane(transmissivity, cosine)
    through, back = transmittance, reflectance
    for _ in range(panes - 1):
        between = 1.0 - back * reflectance
        through, back = through * transmittance / between, reflectance + transmittance**2 * back / between
    return through


def pane(transmissivity: float, cosine: float, index: float = GLASS_INDEX) -> tuple[float, float]:
    """Transmittance and reflectance [-] of a clear pane, all reflections inside it included, for unpolarised light.

    `transmissivity` is that of one crossing at normal incidence; the way through the pane grows with 1 / cos of the
    refracted angle. Fresnel's equations; the two polarisations pass the pane apart (Born and Wolf, section 1.6).
    """
    refracted = math.sqrt(1.0 - (1.0 - cosine**2) / index**2)
    crossing: float = transmissivity ** (1.0 / refracted)
    across = ((cosine - index * refracted) / (cosine + index * refracted)) ** 2
    along = ((index * cosine - refracted) / (index * cosine + refracted)) ** 2
    transmittance = sum((1.0 - r) ** 2 * crossing / (1.0 - (r * crossing) ** 2) for r in (across, along)) / 2.0
    reflectance = sum(r + r * ((1.0 - r) * crossing) ** 2 / (1.0 - (r * crossing) ** 2) for r in (across, along)) / 2.0
    return transmittance, reflectance
