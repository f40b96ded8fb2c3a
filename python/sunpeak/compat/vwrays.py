"""`vwrays`: rays of a view or of a picture."""

import re
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak._core import InputError
from sunpeak.compat import header, numbers
from sunpeak.compat.options import CommandLine, Table, expand_arguments, parse
from sunpeak.compat.views import picture_size, view_of

Floats = npt.NDArray[np.float64]

SIZE = 512
TABLE = Table(
    values={"-x": 1, "-y": 1, "-pa": 1, "-pj": 1, "-pd": 1, "-c": 1},
    switches=frozenset({"-i", "-u", "-d", "-fa", "-ff", "-fd", "-f"}),
    idle=frozenset({"-u"}),
    has_view=True,
)
STANDARD = "-Y", "+X"


def run(arguments: list[str]) -> int:
    """Write the rays to standard output, or with `-d` the options for rtrace."""
    line = parse(expand_arguments(arguments), TABLE)
    form = ([name[2:] for name in line.switches if name in ("-fa", "-ff", "-fd")] or ["a"])[-1]
    if len(line.rest) > 2:
        raise InputError(f"expected a picture and a depth file, found {' '.join(line.rest)}")
    if line.rest:
        view, order, (width, height) = picture_of(Path(line.rest[0]))
    else:
        view, order = view_of(line.view), STANDARD
        width, height = picture_size(view, line.whole("-x", SIZE), line.whole("-y", SIZE), line.number("-pa", 1.0))
    if line.is_on("-d"):
        aft = float(view.fields()["aft"])
        sys.stdout.write(f"-x {width} -y {height}{' -ld+' if aft > 0.0 else ''}\n")
        return 0
    repeats = line.whole("-c", 1)
    if repeats < 1 or min(width, height) < 1:
        raise InputError(f"-c {repeats} -x {width} -y {height}: expected 1 or more of each")
    columns, rows = positions(line, order, width, height)
    columns, rows = np.repeat(columns, repeats), np.repeat(rows, repeats)
    depth = depths(Path(line.rest[1]), order, (width, height), columns, rows) if len(line.rest) > 1 else None
    jitter = line.number("-pj", 0.0)
    if jitter:
        generator = np.random.default_rng()
        columns = columns + jitter * (generator.random(len(columns)) - 0.5)
        rows = rows + jitter * (generator.random(len(rows)) - 0.5)
    write(rays(line, view, columns / width, rows / height, depth), form)
    return 0


def picture_of(path: Path) -> tuple[_core.View, tuple[str, str], tuple[int, int]]:
    """View, scanline order and size (width, height) of a picture."""
    with path.open("rb") as file:
        header.read(file, str(path))
        resolution = file.readline(256).decode("ascii", "replace").strip()
    match = re.fullmatch(r"([-+][XY])\s+(\d+)\s+([-+][XY])\s+(\d+)", resolution)
    if match is None or match[1][1] == match[3][1]:
        raise InputError(f"{path}: expected a resolution as in '-Y 512 +X 512' after the header, found {resolution!r}")
    sizes = {match[1][1]: int(match[2]), match[3][1]: int(match[4])}
    return _core.View.load(path), (match[1], match[3]), (sizes["X"], sizes["Y"])


def positions(line: CommandLine, order: tuple[str, str], width: int, height: int) -> tuple[Floats, Floats]:
    """Middles of pixels, from the left and the bottom: all in scanline order, or those on standard input (`-i`)."""
    if line.is_on("-i"):
        wanted = numbers.read_stdin("a", 2) + 0.5
        return wanted[:, 0], wanted[:, 1]
    extent = {"X": width, "Y": height}
    steps = [np.arange(extent[axis[1]], dtype=np.float64) for axis in order]
    steps = [step if axis[0] == "+" else step[::-1] for axis, step in zip(order, steps, strict=True)]
    slow, fast = np.meshgrid(*steps, indexing="ij")
    columns, rows = (fast, slow) if order[1][1] == "X" else (slow, fast)
    return columns.ravel() + 0.5, rows.ravel() + 0.5


def depths(file: Path, order: tuple[str, str], size: tuple[int, int], columns: Floats, rows: Floats) -> Floats:
    """Depths at pixels, of a file that `rpict -z` wrote."""
    width, height = size
    data = file.read_bytes()
    if len(data) != 4 * width * height:
        raise InputError(f"{file}: {len(data)} bytes; expected {width} x {height} floats, as rpict -z writes")
    values = np.frombuffer(data, dtype=np.float32).astype(np.float64)
    x, y = np.clip(columns.astype(int), 0, width - 1), np.clip(rows.astype(int), 0, height - 1)
    place = {"+X": x, "-X": width - 1 - x, "+Y": y, "-Y": height - 1 - y}
    stride = width if order[1][1] == "X" else height
    found: Floats = values[place[order[0]] * stride + place[order[1]]]
    return found


def rays(line: CommandLine, view: _core.View, x: Floats, y: Floats, depth: Floats | None) -> Floats:
    """Origins and directions (n, 6); nothing but zeros where the view does not reach."""
    origins, directions, lengths = view.rays_at(np.stack([x, y], axis=1))
    if line.has("-pd"):
        origins, directions = through_aperture(line.number("-pd", 0.0), view, origins, directions)
    if depth is not None:
        # From what is seen back to the eye.
        origins, directions = origins + depth[:, None] * directions, -depth[:, None] * directions
    else:
        directions = directions * np.where(np.isfinite(lengths), lengths, 1.0)[:, None]
    all_rays = np.hstack([origins, directions])
    all_rays[~np.isfinite(all_rays).all(axis=1)] = 0.0
    return all_rays


def through_aperture(diameter: float, view: _core.View, origins: Floats, directions: Floats) -> tuple[Floats, Floats]:
    """Rays of a lens of that diameter, in focus at the distance that is the length of `-vd`."""
    generator = np.random.default_rng()
    fields = view.fields()
    forward, up = np.array(fields["direction"]), np.array(fields["up"])
    focus = float(np.linalg.norm(forward))
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward / focus)
    radius, angle = diameter / 2 * np.sqrt(generator.random(len(origins))), 2 * np.pi * generator.random(len(origins))
    offset = (radius * np.cos(angle))[:, None] * right + (radius * np.sin(angle))[:, None] * up
    # Perspective views are in focus on a plane, others on a sphere.
    ahead = directions @ (forward / focus) if fields["kind"] == "-vtv" else np.ones(len(origins))
    target = origins + directions * (focus / ahead)[:, None]
    towards = target - (origins + offset)
    return origins + offset, towards / np.linalg.norm(towards, axis=1, keepdims=True)


def write(all_rays: Floats, form: str) -> None:
    """Write rays to standard output."""
    if form != "a":
        header.write_stdout(numbers.encode(all_rays, form))
        return
    sys.stdout.write(((("%.5e " * 6)[:-1] + "\n") * len(all_rays)) % tuple(all_rays.ravel().tolist()))
