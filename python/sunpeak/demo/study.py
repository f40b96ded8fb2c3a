"""The demo's main job: the same room behind the same fabric, without and with peak extraction."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from sunpeak.comfort import glare
from sunpeak.demo import fabric, room
from sunpeak.demo.results import Case
from sunpeak.files import write_text
from sunpeak.images import luminance_cd_m2
from sunpeak.pictures import Picture
from sunpeak.progress import Callback
from sunpeak.rendering import World, render
from sunpeak.scattering import Peak
from sunpeak.scenes import Scene, View

RULES: tuple[Peak, ...] = ("off", "split")
"""Without and with peak extraction."""

CLOSE_UP_DEG = 12.0
"""Width of the close-up of the sun."""

CLOSE_UP_PIXELS = 120
"""Side of the close-up."""

SEED = 2021


@dataclass(frozen=True)
class Plan:
    """What to compute."""

    folder: Path
    size: tuple[int, int] = (400, 400)
    samples: int = 32
    threads: int | None = None
    bases: tuple[str, ...] = fabric.BASES


Progress = Literal[False] | Callback

Reporter = Callable[[str], Callback | None]
"""Told what is being done; gives the function to call with the progress."""


def cases(plan: Plan, report: Reporter = lambda _: None) -> Iterator[Case]:
    """Write the scene, render the pictures and save them; one case for each basis and rule."""
    scene_files = write_scene(plan.folder)
    eye = View.load(plan.folder / "eye.vf")
    for basis in plan.bases:
        report(f"fabric in {basis}")
        shade = write_shade(plan.folder, basis)
        scene = Scene.load([*scene_files, shade])
        for peak in RULES:
            start = time.monotonic()
            world = World.compile(scene, peak)
            reported = report(f"{basis}, peak {peak}")
            progress: Progress = False if reported is None else reported

            def take(view: View, size: tuple[int, int], world: World = world, progress: Progress = progress) -> Picture:
                return render(
                    world, view, size, samples=plan.samples, seed=SEED, threads=plan.threads, progress=progress
                )

            picture = take(eye, plan.size)
            close_up = take(close_up_view(), (CLOSE_UP_PIXELS, CLOSE_UP_PIXELS))
            picture.save(plan.folder / f"{basis}_{peak}.hdr")
            yield case_of(basis, peak, picture, close_up, time.monotonic() - start)


def case_of(basis: str, peak: Peak, picture: Picture, close_up: Picture, seconds: float) -> Case:
    """Judge one picture."""
    report = glare(picture)
    return Case(
        basis=basis,
        peak=peak,
        ev_lux=report.ev_lux,
        dgp=report.dgp,
        max_luminance_cd_m2=brightest_cd_m2(picture),
        seconds=seconds,
        pixels=picture.pixels,
        close_up=close_up.pixels,
    )


def brightest_cd_m2(picture: Picture) -> float:
    """Luminance of the brightest exact source, or of the brightest pixel where that is brighter."""
    sources = [float(luminance_cd_m2(source.radiance)) for source in picture.exact_sources]
    return max([*sources, float(picture.luminance().max())])


def write_scene(folder: Path) -> list[Path]:
    """Write room, sky and eye; give the scene files."""
    files = [folder / "room.rad", folder / "sky.rad"]
    write_text(files[0], room.room_text())
    write_text(files[1], room.sky().to_radiance())
    write_text(folder / "eye.vf", room.VIEW + "\n")
    return files


def write_shade(folder: Path, basis: str) -> Path:
    """Write the fabric's table and the scene file that hangs it into the room."""
    table = fabric.write_fabric(folder, basis)
    path = folder / f"shade_{basis}.rad"
    write_text(path, room.fabric_text(table))
    return path


def close_up_view() -> View:
    """Make the view straight at the sun."""
    sun = room.sky().sun_direction
    if sun is None:
        raise ValueError("the demo's sky has no sun")
    words = ["-vtv", "-vp", *room.EYE_M, "-vd", *np.array(sun), "-vu 0 0 1", "-vh", CLOSE_UP_DEG, "-vv", CLOSE_UP_DEG]
    return View.parse(" ".join(str(word) for word in words))
