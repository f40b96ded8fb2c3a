"""Periodic products as Radiance geometry, whose through transmittance is known in closed form.

Each has a box that repeats in x and y (see `generate_bsdf`), z towards the room.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sunpeak.generation import Box
from sunpeak.scattering import Floats, rows


@dataclass(frozen=True)
class Slats:
    """A venetian blind of flat slats along x, one above the other in y."""

    width: float = 0.05
    """Of a slat, across [m]."""
    spacing: float = 0.05
    """From slat to slat [m]."""
    tilt_deg: float = 30.0
    """From the normal: the edges towards the room are up if it is positive."""
    reflectance: float = 0.6
    """Diffuse, both sides [-]."""

    @property
    def depth(self) -> float:
        """Thickness of the blind [m]."""
        return self.width * math.cos(math.radians(self.tilt_deg))

    @property
    def box(self) -> Box:
        """One spacing."""
        return 0.0, self.spacing, -self.spacing / 2, self.spacing / 2, -self.depth, 0.0

    def radiance(self, length: float = 1.0, slats: int = 9) -> str:
        """Scene text of so many slats of a length [m], around the box."""
        height = slats * self.spacing
        return (
            f"void plastic slat\n0\n0\n5 {self.reflectance} {self.reflectance} {self.reflectance} 0 0\n"
            f"!genblinds slat blind {self.width} {length} {height} {slats} {self.tilt_deg} "
            f"| xform -rz -90 -rx -90 -t {-length / 2} {-height / 2} {-self.depth}\n"
        )

    def through(self, directions: npt.ArrayLike) -> Floats:
        """Through transmittance [-] of light that runs in directions (n, 3).

        In the plane across the slats a ray climbs by tan O = y / z; a slat hides `width |cos(tilt) tan O - sin(tilt)|`
        of each spacing from it.
        """
        _, y, z = rows(directions).T
        tilt = math.radians(self.tilt_deg)
        hidden = self.width / self.spacing * np.abs(math.cos(tilt) * y / z - math.sin(tilt))
        through: Floats = np.maximum(0.0, 1.0 - hidden)
        return through


@dataclass(frozen=True)
class Sheet:
    """A sheet with round holes in a square pattern; the holes are polygons of the circle's area."""

    pitch: float = 1.0
    """From hole to hole [m]."""
    diameter: float = 0.7
    """Of the holes [m]."""
    thickness: float = 0.3
    """Of the sheet [m]."""
    reflectance: float = 0.5
    """Diffuse, also of the holes' walls [-]."""
    corners: int = 120
    """Of the polygons that stand for circles."""

    @property
    def box(self) -> Box:
        """One hole."""
        return 0.0, self.pitch, 0.0, self.pitch, -self.thickness, 0.0

    def radiance(self, repeat: int = 1) -> str:
        """Scene text of `repeat` by `repeat` holes; the middle one is at the box."""
        turn = 2 * math.pi / self.corners
        radius = self.diameter / 2 * math.sqrt(turn / math.sin(turn))
        middle = self.pitch / 2
        rim = [
            (middle + radius * math.cos(k * turn), middle + radius * math.sin(k * turn)) for k in range(self.corners)
        ]
        square = [(self.pitch, 0.0), (self.pitch, self.pitch), (0.0, self.pitch), (0.0, 0.0)]
        # Around the square, in by a seam to the hole, around it the other way, and out again.
        face = [*square, square[0], rim[0], *reversed(rim)]
        shift = (repeat // 2) * self.pitch
        low, high = -self.thickness, 0.0
        faces = [
            _polygon("room", [(x, y, high) for x, y in face]),
            _polygon("outside", [(x, y, low) for x, y in reversed(face)]),
        ]
        walls = [
            _polygon(f"wall{k}", [(*a, low), (*b, low), (*b, high), (*a, high)])
            for k, (b, a) in enumerate(zip(rim, rim[1:] + rim[:1], strict=True))
        ]
        r = self.reflectance
        text = f"void plastic sheet\n0\n0\n5 {r} {r} {r} 0 0\n" + "".join(faces + walls)
        return text if repeat == 1 else text + self._copies(text, repeat, shift)

    def _copies(self, text: str, repeat: int, shift: float) -> str:
        lines = []
        cell = [part.split() for part in text.split("sheet polygon ")[1:]]
        for i in range(repeat):
            for j in range(repeat):
                dx, dy = i * self.pitch - shift, j * self.pitch - shift
                if (dx, dy) == (0.0, 0.0):
                    continue
                for words in cell:
                    numbers = [float(word) for word in words[4:]]
                    points = [(x + dx, y + dy, z) for x, y, z in zip(*[iter(numbers)] * 3, strict=True)]
                    lines.append(_polygon(f"{words[0]}_{i}_{j}", points))
        return "".join(lines)

    def through(self, directions: npt.ArrayLike) -> Floats:
        """Through transmittance [-] of light that runs in directions (n, 3).

        What the two rims have in common: the overlap of circles displaced by thickness times tan(theta).
        """
        x, y, z = rows(directions).T
        shift = np.minimum(1.0, self.thickness / self.diameter * np.hypot(x, y) / np.abs(z))
        open_area = math.pi / 4 * (self.diameter / self.pitch) ** 2
        through: Floats = open_area * 2 / math.pi * (np.arccos(shift) - shift * np.sqrt(1 - shift**2))
        return through


@dataclass(frozen=True)
class Screen:
    """Round yarns, one layer along x and one along y behind it."""

    pitch: float = 1.0
    """From yarn to yarn [m]."""
    diameter: float = 0.6
    """Of the yarns [m]."""
    reflectance: float = 0.4
    """Diffuse [-]."""

    @property
    def box(self) -> Box:
        """One mesh."""
        return 0.0, self.pitch, 0.0, self.pitch, -2.02 * self.diameter, 0.0

    def radiance(self) -> str:
        """Scene text of one mesh; the yarns go on past the box."""
        middle, start, end = self.pitch / 2, -self.pitch, 2 * self.pitch
        r = self.reflectance
        # A hundredth of a yarn lies between the layers, and before the faces of the box.
        near, far = -0.505 * self.diameter, -1.515 * self.diameter
        return (
            f"void plastic yarn\n0\n0\n5 {r} {r} {r} 0 0\n"
            f"yarn cylinder weft\n0\n0\n7 {start} {middle} {near} {end} {middle} {near} {self.diameter / 2}\n"
            f"yarn cylinder warp\n0\n0\n7 {middle} {start} {far} {middle} {end} {far} {self.diameter / 2}\n"
        )

    def through(self, directions: npt.ArrayLike) -> Floats:
        """Through transmittance [-] of light that runs in directions (n, 3).

        Each layer hides diameter / cos(profile angle) of each pitch, whatever the other does.
        """
        x, y, z = rows(directions).T
        layers = [1.0 - self.diameter / self.pitch * np.hypot(1.0, across / z) for across in (x, y)]
        product: Floats = np.maximum(0.0, layers[0]) * np.maximum(0.0, layers[1])
        return product


def _polygon(name: str, points: list[tuple[float, float, float]]) -> str:
    numbers = "\n".join(f"\t{x:.9g} {y:.9g} {z:.9g}" for x, y, z in points)
    return f"sheet polygon {name}\n0\n0\n{3 * len(points)}\n{numbers}\n"
