"""Venetian blinds of our own making: the straight part in closed form, an LBNL XML file out."""

from dataclasses import asdict, dataclass
from os import PathLike

from sunpeak import _core
from sunpeak.files import write_text
from sunpeak.runs import UNWATCHED, Run


@dataclass(frozen=True)
class Blind:
    """Flat slats without thickness, horizontal if the BSDF's up vector is vertical; both sides alike.

    Light that travels at the profile angle O is blocked over `width` |cos(tilt) tan(O) - sin(tilt)| of each spacing.
    What meets the slats is scattered: one diffuse share comes through, another (0.3) back.
    """

    width: float = 1.0
    """Width of the slats over their spacing."""
    tilt_deg: float = 0.0
    """Tilt of the slats from the normal; up at the front if positive."""
    scattered: float = 0.2
    """Share of the light on the slats that comes out at the other side, diffuse [-]."""

    def write(self, path: str | PathLike[str], basis: str = "klems", *, run: Run = UNWATCHED) -> None:
        """Tabulate by exact cell averages and write an LBNL XML file, whole or not at all.

        `basis` as for `Fabric.write`.
        """
        with run.watching("averaging over cells") as watch:
            bsdf = _core.synthetic_bsdf("blind", asdict(self), basis, None, 0.0, 0.0, 1, *watch)
        write_text(path, _core.bsdf_xml(bsdf))
