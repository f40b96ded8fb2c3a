"""Products in closed form: what one can see through, and what one cannot."""

from dataclasses import dataclass, field

import numpy as np

from sunpeak import _core
from sunpeak.scattering import Bsdf, Floats, direction


@dataclass(frozen=True)
class Seen:
    """How a product gets into a table; by default by exact cell averages."""

    rays: int | None = None
    """Rays for each incident cell of a virtual goniophotometer."""
    value_noise: float = 0.0
    """Relative standard deviation of each value."""
    fwhm_deg: float = 0.0
    """What the instrument makes of a sharp beam: full width at half maximum."""
    seed: int = 1


EXACT = Seen()


@dataclass(frozen=True)
class Product:
    """One product by its kind and numbers; `crates/bsdf/src/synthetic` has the formulas."""

    name: str
    kind: str
    numbers: dict[str, float] = field(default_factory=dict)
    isotropic: bool = True
    largest_deg: float = 75.0
    """Random directions go up to this angle from the normal."""
    tenth_width_deg: float | None = None
    """Of a scatterer that one cannot see through: full width of its lobe at tenth maximum (infinite: Lambertian)."""

    def tabulate(self, basis: str, seen: Seen = EXACT) -> Bsdf:
        """As a table in a basis (`klems`, `t3-4096` …)."""
        return Bsdf(
            _core.synthetic_bsdf(self.kind, self.numbers, basis, seen.rays, seen.value_noise, seen.fwhm_deg, seen.seed)
        )

    def through(self, w_in: Floats) -> Floats:
        """Through transmittance in closed form (n,) [-]."""
        return _core.synthetic_through(self.kind, self.numbers, w_in)

    def directions(self, count: int, seed: int) -> Floats:
        """Random `w_in` (n, 3) on both sides, uniform in projected solid angle up to the largest angle."""
        random = np.random.default_rng(seed)
        sine = np.sqrt(random.random(count)) * np.sin(np.radians(self.largest_deg))
        theta_deg = np.degrees(np.arcsin(sine))
        behind = random.random(count) < 0.5
        return direction(np.where(behind, 180.0 - theta_deg, theta_deg), random.uniform(0.0, 360.0, count))


def fabrics(count: int, seed: int = 7, *, steep: bool = False) -> list[Product]:
    """Fabrics of the family that the accuracy is measured on, drawn at random.

    Openness 1 to 5 %, cut-off 60 to 72 degrees, exponent 0.5 to 0.8 (steep: 1.3 to 2.1, as roller blinds have it),
    scattered part 5 to 9 %, of which 40 % in a lobe with a standard deviation of 0.22 to 0.30.
    """
    random = np.random.default_rng(seed)
    drawn = []
    for number in range(count):
        cut_off = random.uniform(60.0, 72.0)
        numbers = {
            "openness": random.uniform(0.01, 0.05),
            "cut_off_deg": cut_off,
            "exponent": random.uniform(1.3, 2.1) if steep else random.uniform(0.5, 0.8),
            "scattered": random.uniform(0.05, 0.09),
            "lobe_share": 0.4,
            "lobe_sigma": random.uniform(0.22, 0.30),
            "reflectance": 0.3,
        }
        drawn.append(Product(f"fabric {number + 1}", "fabric", numbers, largest_deg=0.9 * cut_off))
    return drawn


def fabric(name: str, openness: float, cut_off_deg: float, scattered: float) -> Product:
    """One fabric of the same make."""
    numbers = {
        "openness": openness,
        "cut_off_deg": cut_off_deg,
        "exponent": 0.6,
        "scattered": scattered,
        "lobe_share": 0.4,
        "lobe_sigma": 0.25,
        "reflectance": 0.3,
    }
    return Product(name, "fabric", numbers, largest_deg=0.9 * cut_off_deg)


def weave(name: str, cut_off_y_deg: float, tint: tuple[float, float]) -> Product:
    """A fabric whose warp and weft differ; what it scatters has a colour."""
    numbers = fabric(name, 0.03, 68.0, 0.07).numbers | {
        "cut_off_y_deg": cut_off_y_deg,
        "tint_x": tint[0],
        "tint_z": tint[1],
    }
    return Product(name, "weave", numbers, isotropic=False, largest_deg=0.9 * min(68.0, cut_off_y_deg))


def see_through() -> list[Product]:
    """What else one can see through."""
    return [
        fabric("fabric 0.1 % open, black", 0.001, 65.0, 0.002),
        fabric("fabric 14 % open, white", 0.14, 75.0, 0.15),
        fabric("fabric 3 % open, cut-off 50°", 0.03, 50.0, 0.06),
        weave("weave, cut-offs 68° and 55°, white", 55.0, (1.0, 1.0)),
        weave("weave, cut-offs 68° and 60°, dyed red", 60.0, (1.4, 0.3)),
        Product(
            "perforated sheet, 20 % open",
            "perforated",
            {"open_area": 0.2, "thickness": 0.5, "from_walls": 0.2, "reflectance": 0.5},
            largest_deg=0.9 * float(np.degrees(np.arctan(2.0))),
        ),
        clear_glass(),
        Product("tinted glass", "pane", {"index": 1.52, "internal": 0.4}),
        Product(
            "venetian blind, slats at 20°",
            "blind",
            {"width": 1.1, "tilt_deg": 20.0, "scattered": 0.1},
            isotropic=False,
        ),
    ]


def clear_glass() -> Product:
    """A pane that absorbs nothing: all that it transmits goes straight."""
    return Product("clear glass", "pane", {"index": 1.52, "internal": 1.0})


def panel(tenth_width_deg: float) -> Product:
    """A translucent panel: one cannot see through."""
    numbers = {"transmittance": 0.5, "tenth_width_deg": tenth_width_deg, "same_angle": 0.0}
    return Product(f"panel {tenth_width_deg:g}°", "panel", numbers, tenth_width_deg=tenth_width_deg)


def decoys() -> list[Product]:
    """What one cannot see through: nothing may be taken where the basis resolves the lobe."""
    lambertian = Product("Lambertian", "diffuser", {"transmittance": 0.5}, tenth_width_deg=float("inf"))
    return [lambertian, *(panel(width) for width in (20.0, 10.0, 5.0, 2.0, 1.0))]
