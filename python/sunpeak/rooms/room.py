"""A room behind the fabric: what stands in it and outside, its sky, its eye."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from sunpeak.files import write_text
from sunpeak.rooms.fabric import write_fabric
from sunpeak.scenes import View
from sunpeak.skies import Sky, SunPosition

CLOSE_UP_DEG = 12.0
"""Width of the close-up of the sun."""

Material = Literal["aBSDF", "BSDF"]
"""Radiance looks for the peak of an `aBSDF`, and takes a `BSDF` as it is."""

SHADE_MATERIALS: dict[Material, str] = {"aBSDF": "5 {name} 0 0 1 .", "BSDF": "6 0 {name} 0 0 1 ."}
"""Arguments of the materials: table, up vector (z), no transformation; a `BSDF` has its thickness before them."""


@dataclass(frozen=True)
class Glazing:
    """Parallel panes of clear glass."""

    panes: int
    transmissivity: float
    """Of one crossing of a pane at normal incidence [-], as Radiance's `glass` has it."""


@dataclass(frozen=True)
class Room:
    """A room whose facade lies in a plane of constant y; world axes are Radiance's, in metres."""

    text: str
    """Surfaces of the room and of what stands outside, glazing included, in Radiance's language."""
    shade: str
    """Surfaces of the fabric; their modifier is `fabric`."""
    glazing: Glazing
    """Of what the sun comes through."""
    extent_m: float
    """Longest side of a box around everything; Radiance's ambient cache is set by it."""
    sun: SunPosition
    direct_normal_w_m2: float
    diffuse_horizontal_w_m2: float
    eye_m: tuple[float, float, float]
    sight: tuple[float, float, float]
    """Where the eye looks."""

    def sky(self) -> Sky:
        """Make the Perez sky."""
        return Sky.perez(self.sun, self.direct_normal_w_m2, self.diffuse_horizontal_w_m2)

    @property
    def sun_direction(self) -> tuple[float, float, float]:
        """Unit vector towards the sun."""
        direction = self.sky().sun_direction
        if direction is None:
            raise ValueError(f"{self.sun}: this sun does not shine")
        return direction

    def view_options(self) -> str:
        """Write the 180-degree equidistant fisheye of the eye as options."""
        return f"-vta {self.from_eye(self.sight)} -vh 180 -vv 180"

    def close_up(self) -> View:
        """Make the view straight at the sun."""
        return View.parse(f"-vtv {self.from_eye(self.sun_direction)} -vh {CLOSE_UP_DEG} -vv {CLOSE_UP_DEG}")

    def from_eye(self, towards: tuple[float, float, float]) -> str:
        """Write where the eye is and where it looks, as options of a view."""
        return f"-vp {words(self.eye_m)} -vd {words(towards)} -vu 0 0 1"

    def write(self, folder: Path) -> list[Path]:
        """Write room, sky and eye (`eye.vf`); give the scene files."""
        files = [folder / "room.rad", folder / "sky.rad"]
        write_text(files[0], self.text)
        write_text(files[1], self.sky().to_radiance())
        write_text(folder / "eye.vf", f"rvu {self.view_options()}\n")
        return files

    def hang(self, folder: Path, basis: str, material: Material = "aBSDF") -> Path:
        """Write the fabric's table, and the scene file that hangs it into the room; give the scene file."""
        table = write_fabric(folder, basis)
        path = folder / (f"shade_{basis}.rad" if material == "aBSDF" else f"shade_{basis}_table.rad")
        arguments = SHADE_MATERIALS[material].format(name=table.name)
        write_text(path, f"void {material} fabric\n{arguments}\n0\n0\n{self.shade}")
        return path


def words(numbers: tuple[float, ...]) -> str:
    """Numbers with spaces between."""
    return " ".join(f"{number:.9g}" for number in numbers)
