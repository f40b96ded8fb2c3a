"""`rpict`: a picture of an octree."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak._core import InputError
from sunpeak.compat import header, octree, quality
from sunpeak.compat.options import CommandLine, Table, expand_arguments, parse
from sunpeak.compat.views import picture_size, view_of
from sunpeak.compat.world import CompiledScene
from sunpeak.files import whole_file

Floats = npt.NDArray[np.float64]

DIRECTIONS = 512
"""`-ad` of Radiance's rpict."""
FAR = 1e10
"""Depth where nothing is met."""
SIZE = 512
IDLE = frozenset({"-pj", "-pm", "-pd", "-ps", "-pt", "-t", "-r"})
TABLE = Table(
    values={
        **quality.RENDER_VALUES, "-x": 1, "-y": 1, "-pa": 1, "-o": 1, "-z": 1, "-S": 1, "-ro": 1,
        **dict.fromkeys(IDLE, 1),
    },
    switches=quality.SWITCHES | {"-defaults"},
    idle=quality.IDLE_VALUES | quality.IDLE_SWITCHES | IDLE,
    has_view=True,
)  # fmt: skip


@dataclass(frozen=True)
class Task:
    """What all pictures of a run share."""

    line: CommandLine
    scene: CompiledScene
    work: quality.Quality
    header: list[str]


def run(arguments: list[str]) -> int:
    """Render one picture, or with `-S` one for each view on standard input."""
    line = parse(expand_arguments(arguments), TABLE, {"-w": True})
    quality.check_colours(line)
    if "-defaults" in line.switches:
        sys.stdout.write(defaults_text(line))
        return 0
    if line.has("-e"):
        sys.stderr = open(line.values["-e"][0], "a", encoding="utf-8")  # noqa: SIM115, PTH123 (until the program ends)
    warn = line.is_on("-w")
    line.note_idle("rpict", quiet=not warn)
    if len(line.rest) > 1:
        raise InputError(f"expected one octree, found {' '.join(line.rest)}")
    scene_file = octree.read(line.rest[0] if line.rest else None)
    work = quality.picture(line, DIRECTIONS)
    view_of(line.view)
    scene = CompiledScene(scene_file, work.peak)
    if warn:
        sys.stderr.writelines(f"rpict: warning - {warning}\n" for warning in scene.scene.warnings)
    words = arguments[: len(arguments) - len(line.rest)]
    task = Task(line, scene, work, header.history(scene_file.history, "rpict", words))
    if line.has("-S"):
        draw_sequence(task)
    else:
        draw(task, line.view, None)
    return 0


def draw_sequence(task: Task) -> None:
    """Draw a picture for each line of view options on standard input, numbered from `-S`."""
    number = task.line.whole("-S", 0)
    for text in sys.stdin:
        words = text.split()
        if words and words[0].split("/")[-1] in ("rvu", "rpict", "rview", "VIEW="):
            words = words[1:]
        if not words:
            continue
        draw(task, [*task.line.view, *words], number)
        number += 1


def draw(task: Task, view_words: list[str], number: int | None) -> None:
    """Render a picture and write it, and its depths where they are wanted."""
    line, scene, work = task.line, task.scene, task.work
    view = view_of(view_words)
    limits = line.whole("-x", SIZE), line.whole("-y", SIZE)
    if min(limits) < 1:
        raise InputError(f"-x {limits[0]} -y {limits[1]}: a picture needs at least one pixel each way")
    width, height = picture_size(view, *limits, line.number("-pa", 1.0))
    if line.is_on("-i"):
        picture = irradiance_picture(scene, view, width, height, work)
    else:
        picture = _core.render(
            scene.world, view, width, height, work.samples, work.time, work.error, work.seed, work.threads,
            work.max_bounces, work.ambient, None, None,
        )  # fmt: skip
    emit(picture.encode(task.header), line, "-o", number)
    if line.has("-z"):
        emit(depths(scene, view, width, height), line, "-z", number)


def emit(data: bytes, line: CommandLine, option: str, number: int | None) -> None:
    """Write a file, whole or not at all, or standard output; a `%d` in a name is the number in the sequence."""
    if not line.has(option):
        header.write_stdout(data)
        return
    name = line.values[option][0]
    if number is not None and "%" in name:
        try:
            name = name % number
        except (TypeError, ValueError) as error:
            raise InputError(f"{option} {name}: expected a name with one %d in it") from error
    with whole_file(Path(name)) as temporary:
        temporary.write_bytes(data)


def pixel_rays(view: _core.View, width: int, height: int) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
    """Rays through the middles of all pixels (n, 3), top row first, and which of them there are."""
    origins, directions = view.rays(width, height)
    directions = directions.reshape(-1, 3)
    return origins.reshape(-1, 3), directions, np.isfinite(directions.sum(axis=1))


def irradiance_picture(
    scene: CompiledScene, view: _core.View, width: int, height: int, work: quality.Quality
) -> _core.Picture:
    """Irradiance on what is seen (`-i`)."""
    origins, directions, seen = pixel_rays(view, width, height)
    values = np.zeros((height * width, 3), dtype=np.float32)
    values[seen] = scene.irradiance_of_surfaces(origins[seen], directions[seen], work)
    return _core.Picture.from_pixels(values.reshape(height, width, 3), view, [], np.zeros((0, 8)))


def depths(scene: CompiledScene, view: _core.View, width: int, height: int) -> bytes:
    """Distances of what is seen, as floats, top row first."""
    origins, directions, seen = pixel_rays(view, width, height)
    values = np.zeros(height * width, dtype=np.float32)
    values[seen] = np.minimum(scene.first(origins[seen], directions[seen]).distance, FAR)
    return values.tobytes()


def defaults_text(line: CommandLine) -> str:
    """Give the lines of `-defaults` for what has a meaning here."""
    view = view_of(line.view)
    options = str(view.options()).replace(" -v", "\n-v")
    size = f"-x {line.whole('-x', SIZE)}\n-y {line.whole('-y', SIZE)}\n-pa {line.number('-pa', 1.0):f}\n"
    return f"{options}\n{size}{quality.defaults_text(line, DIRECTIONS)}"
