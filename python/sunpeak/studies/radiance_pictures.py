"""The rooms rendered by Radiance and judged by evalglare, where pyradiance is installed."""

import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import NamedTemporaryFile

import numpy as np
import numpy.typing as npt

from sunpeak.files import whole_file
from sunpeak.pictures import Picture
from sunpeak.rooms.room import Material, Room
from sunpeak.studies.radiance import Radiance, RadianceError

MATERIALS: dict[str, Material] = {"off": "BSDF", "radiance": "aBSDF"}
"""Radiance's material by the rule of peak extraction: a `BSDF` is the table as it is, an `aBSDF` has its peak taken."""

AMBIENT_ACCURACY = 0.2
AMBIENT_SPACING_M = 1 / 32
"""The ambient cache keeps values as close as this: its resolution (`-ar`) follows from the scene's extent."""

OPTIONS: tuple[object, ...] = (
    *("-ps", 1, "-pj", 0, "-ab", 4, "-ad", 512, "-as", 128, "-aa", AMBIENT_ACCURACY),
    *("-lw", 1e-4, "-ss", 1, "-st", 0.01, "-dc", 1, "-dt", 0, "-w"),
)
"""Each pixel a ray through its middle, four diffuse bounces with the ambient cache, all of the sun's light."""


@dataclass(frozen=True)
class RadianceCase:
    """One picture and its numbers."""

    basis: str
    peak: str
    """`off` or `radiance`."""
    ev_lux: float
    dgp: float
    max_luminance_cd_m2: float
    seconds: float
    """Of both pictures of the basis, which are rendered at the same time."""
    pixels: npt.NDArray[np.float32]


@dataclass(frozen=True)
class RadianceScene:
    """A room with the fabric in one basis, in a folder."""

    radiance: Radiance
    room: Room
    folder: Path
    basis: str
    options: tuple[object, ...] = OPTIONS
    """Of `rpict`."""

    @property
    def ambient_resolution(self) -> int:
        """Radiance keeps no ambient values closer than the extent of the scene times `-aa` over this."""
        return round(self.room.extent_m * AMBIENT_ACCURACY / AMBIENT_SPACING_M)

    def cases(self, size: int) -> list[RadianceCase]:
        """Render what the eye sees, `size` pixels across, and judge it."""
        start = time.monotonic()
        pictures = self.render(f"-vf eye.vf -x {size} -y {size}", f"radiance_{self.basis}")
        seconds = time.monotonic() - start
        return [judged(self.radiance, path, self.basis, peak, seconds) for peak, path in pictures.items()]

    def render(self, view: str, stem: str) -> dict[str, Path]:
        """Render a view without and with peak extraction at the same time; give the pictures by rule."""
        files = [path.name for path in self.room.write(self.folder)]
        shades = {peak: self.room.hang(self.folder, self.basis, material).name for peak, material in MATERIALS.items()}
        targets = {peak: self.folder / f"{stem}_{peak}.hdr" for peak in MATERIALS}
        with ExitStack() as stack:
            octrees = {peak: Path(stack.enter_context(NamedTemporaryFile(suffix=".oct")).name) for peak in MATERIALS}
            for peak, octree in octrees.items():
                octree.write_bytes(self.radiance.run("oconv", *files, shades[peak], folder=self.folder))
            asked = ("rpict", *view.split(), *self.options, "-ar", self.ambient_resolution)
            commands = [
                (*asked, "-o", stack.enter_context(whole_file(target)).name, octrees[peak])
                for peak, target in targets.items()
            ]
            self.radiance.run_together(commands, folder=self.folder)
        return targets


def judged(radiance: Radiance, path: Path, basis: str, peak: str, seconds: float) -> RadianceCase:
    """Ask evalglare."""
    picture = Picture.load(path)
    numbers = evalglare(radiance, path)
    brightest = float(picture.luminance().max())
    return RadianceCase(basis, peak, numbers["E_v"], numbers["dgp"], brightest, seconds, picture.pixels)


def evalglare(radiance: Radiance, path: Path) -> dict[str, float]:
    """What `evalglare -d` prints in its last line: names, a colon, values."""
    lines = radiance.run("evalglare", "-d", path.resolve()).decode().strip().splitlines()
    names, _, values = (lines[-1] if lines else "").partition(":")
    try:
        return dict(zip(names.split(","), map(float, values.split()), strict=True))
    except ValueError as error:
        raise RadianceError(f"evalglare: {path}: expected a line of names and values, found {lines[-1:]}") from error
