"""The same room behind the same fabric, without and with peak extraction, from several tables of the fabric."""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sunpeak.comfort import glare
from sunpeak.pictures import Picture
from sunpeak.progress import Steps
from sunpeak.rendering import World, render
from sunpeak.rooms.fabric import BASES
from sunpeak.rooms.results import Case
from sunpeak.rooms.room import Room
from sunpeak.scattering import Peak
from sunpeak.scenes import Scene, View

RULES: tuple[Peak, ...] = ("off", "split")
"""Without and with peak extraction."""

CLOSE_UP_PIXELS = 120
"""Side of the close-up of the sun."""

SEED = 2021


@dataclass(frozen=True)
class Plan:
    """What to compute."""

    folder: Path
    room: Room
    size: tuple[int, int] = (400, 400)
    samples: int = 32
    threads: int | None = None
    bases: tuple[str, ...] = BASES

    def steps(self) -> int:
        """How many cases there are."""
        return len(self.bases) * len(RULES)


def cases(plan: Plan, steps: Steps) -> Iterator[Case]:
    """Write the scene, render the pictures and save them; one case for each basis and rule, a step each."""
    scene_files = plan.room.write(plan.folder)
    eye = View.load(plan.folder / "eye.vf")
    for basis in plan.bases:
        shade = plan.room.hang(plan.folder, basis)
        scene = Scene.load([*scene_files, shade])
        for peak in RULES:
            start = time.monotonic()
            world = World.compile(scene, peak)
            picture = take(plan, world, eye, plan.size, steps)
            close_up = take(plan, world, plan.room.close_up(), (CLOSE_UP_PIXELS, CLOSE_UP_PIXELS), steps)
            picture.save(plan.folder / f"{basis}_{peak}.hdr")
            steps.finish()
            yield case_of(basis, peak, picture, close_up, time.monotonic() - start)


def take(plan: Plan, world: World, view: View, size: tuple[int, int], steps: Steps) -> Picture:
    """Render one picture."""
    progress = steps.callback or False
    return render(world, view, size, samples=plan.samples, seed=SEED, threads=plan.threads, progress=progress)


def case_of(basis: str, peak: Peak, picture: Picture, close_up: Picture, seconds: float) -> Case:
    """Judge one picture."""
    report = glare(picture)
    return Case(
        basis=basis,
        peak=peak,
        ev_lux=report.ev_lux,
        dgp=report.dgp,
        dgp_interval=report.dgp_interval,
        max_luminance_cd_m2=report.max_luminance_cd_m2,
        seconds=seconds,
        pixels=picture.pixels,
        close_up=close_up.pixels,
    )
