"""`rtrace`: radiance along rays, irradiance at sensors, and what rays meet."""

import math
import sys
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from sunpeak._core import InputError
from sunpeak.compat import header, numbers, octree, quality
from sunpeak.compat.options import CommandLine, NotDoneError, Table, expand_arguments, take
from sunpeak.compat.world import CompiledScene, First

Floats = npt.NDArray[np.float64]
Number = TypeVar("Number", np.float64, np.int64)

DIRECTIONS = 1024
"""`-ad` of Radiance's rtrace."""
FAR = 1e10
"""Distance where nothing is met, as Radiance prints it."""
IDLE = frozenset({"-te", "-ti", "-tE", "-tI"})
TABLE = Table(
    values={**quality.RENDER_VALUES, "-x": 1, "-y": 1, **dict.fromkeys(IDLE, 1)},
    switches=quality.SWITCHES | {"-h", "-I", "-ld", "-cu"},
    idle=quality.IDLE_VALUES | quality.IDLE_SWITCHES | IDLE | {"-cu"},
)
FIELDS = "odvVrRxXlLcpnNsmMwW~"
"""Letters of `-o`."""
COMPONENTS = {
    **dict.fromkeys("odvVrxpnNW", 3),
    **dict.fromkeys("RXlLw", 1),
    "c": 2,
}
TREE_FIELDS = "tT"
"""Letters that ask for the tree of rays: there is none."""
NUDGE = 1e-6
"""How far from a surface rays that leave it start [m]."""
MIRROR_SHARE = 0.5
"""The effective distance is that of the mirrored ray where it brings more than this of the light."""
BRIGHTNESS = np.array([0.265, 0.670, 0.065])


class Options:
    """The command line."""

    def __init__(self, arguments: list[str]) -> None:
        """Take a command line apart."""
        self.line = CommandLine(switches={"-h": True, "-w": True})
        self.fields = "v"
        self.forms = "aa"
        self.only_defaults = False
        words = expand_arguments(arguments)
        at = 0
        while at < len(words) and words[at].startswith("-"):
            at += 1 + self._take(words, at)
        self.line.rest = words[at:]
        quality.check_colours(self.line)
        self.size = (self.line.whole("-x", 0), self.line.whole("-y", 0))

    def _take(self, words: list[str], at: int) -> int:
        word = words[at]
        if word == "-defaults":
            self.only_defaults = True
        elif word.startswith("-f") and 2 <= len(word) <= 4:
            self.forms = forms_of(word)
        elif word.startswith("-o") and len(word) > 2:
            self.fields = fields_of(word)
        else:
            return take(words, at, TABLE, self.line)
        return 0

    @property
    def warn(self) -> bool:
        """Say whether warnings are wanted."""
        return self.line.is_on("-w")


def forms_of(option: str) -> str:
    """Formats of input and output: `-fa` is both, `-faf` text to floats."""
    forms = option[2:] or "a"
    forms = forms if len(forms) == 2 else (forms * 2 if forms in ("a", "f", "d") else f"a{forms}")
    if len(forms) != 2 or forms[0] not in "afd" or forms[1] not in "afdc":
        raise InputError(f"command line error at '{option}': expected -f with input a, f or d and output a, f, d or c")
    return forms


def fields_of(option: str) -> str:
    """Letters after `-o`."""
    for letter in option[2:]:
        if letter in TREE_FIELDS:
            raise NotDoneError(f"{option}: '{letter}' asks for the tree of rays, which random paths have not")
        if letter not in FIELDS:
            raise InputError(f"{option}: Sunpeak's rtrace does not give '{letter}'; expected letters of {FIELDS}")
    return option[2:]


def run(arguments: list[str]) -> int:
    """Trace what stands on standard input."""
    options = Options(arguments)
    line = options.line
    if options.only_defaults:
        sys.stdout.write(f"-f{options.forms}\t\t\t\t# format input/output\n-o{options.fields}\t\t\t\t# output value\n")
        sys.stdout.write(quality.defaults_text(line, DIRECTIONS))
        return 0
    if len(line.rest) != 1:
        raise InputError("missing octree argument" if not line.rest else f"expected one octree, found {line.rest}")
    if line.has("-e"):
        sys.stderr = open(line.values["-e"][0], "a", encoding="utf-8")  # noqa: SIM115, PTH123 (until the program ends)
    line.note_idle("rtrace", quiet=not options.warn)
    scene_file = octree.read(line.rest[0])
    is_picture = options.size[0] > 0 and options.size[1] > 0 and not line.is_on("-I")
    work = quality.rays_of_picture(line, DIRECTIONS) if is_picture else quality.sensors(line, DIRECTIONS)
    scene = CompiledScene(scene_file, work.peak)
    if options.warn:
        sys.stderr.writelines(f"rtrace: warning - {warning}\n" for warning in scene.scene.warnings)
    rays = numbers.read_stdin(options.forms[0], 6)
    output = table(Answers(scene, rays, options, work), options.fields, options.forms[1])
    header.write_stdout(head(options, arguments, scene_file) + output)
    return 0


def head(options: Options, arguments: list[str], scene_file: octree.Octree) -> bytes:
    """Header and resolution line, as far as they are wanted."""
    data = b""
    # The octree is a word of its own in the command, and stands in the history already.
    if options.line.is_on("-h"):
        lines = header.history(scene_file.history, "rtrace", arguments[:-1])
        lines.append(f"NCOMP={sum(COMPONENTS.get(letter, 1) for letter in options.fields)}")
        if options.forms[1] in "fd":
            lines.append(f"BigEndian={int(sys.byteorder == 'big')}")
        data = header.text([*lines, f"FORMAT={numbers.FORMAT_NAMES[options.forms[1]]}"])
    width, height = options.size
    return data + (f"-Y {height:8d} +X {width:8d}\n".encode() if width > 0 and height > 0 else b"")


class Deltas(NamedTuple):
    """What the first surfaces mirror and let through straight, and what is seen by these ways."""

    mirrored: Floats
    """Radiance that comes by the mirrored ray (n, 3)."""
    mirrored_distance: Floats
    """Length of the ray, and of the mirrored one where glass or a mirror is plane (n,)."""
    straight_distance: Floats
    """Length of the ray, and of the one that goes straight on (n,)."""


class Answers:
    """Everything that can be asked about rays; each is worked out once, when it is asked for."""

    def __init__(self, scene: CompiledScene, rays: Floats, options: Options, work: quality.Quality) -> None:
        """Take the rays (n, 6) in."""
        self.scene, self.options, self.work = scene, options, work
        self.rays = rays
        self.origins, self.directions = rays[:, :3], rays[:, 3:]
        self.lengths = np.linalg.norm(self.directions, axis=1)
        self.is_ray = np.isfinite(rays).all(axis=1) & (self.lengths > 0)
        self._first: First | None = None
        self._values: Floats | None = None
        self._deltas: Deltas | None = None

    @property
    def first(self) -> First:
        """What rays meet, at any distance."""
        if self._first is None:
            good = self.is_ray
            found = self.scene.first(self.origins[good], self.directions[good])
            self._first = First(
                spread(found.distance, good, math.inf),
                spread(found.point, good, 0.0),
                spread(found.normal, good, 0.0),
                spread(found.flat_normal, good, 0.0),
                spread(found.bent_normal, good, 0.0),
                spread(found.local, good, 0.0),
                spread(found.surface, good, -1),
            )
        return self._first

    def values(self) -> Floats:
        """Radiance or irradiance (n, 3); 0 for what is no ray, as in Radiance."""
        if self._values is None:
            self._values = self._find_values()
        return self._values

    def _find_values(self) -> Floats:
        good = self.is_ray
        line = self.options.line
        if line.is_on("-ld"):
            # The length of a direction is as far as the ray sees.
            good = good & (self.first.distance <= self.lengths)
        ask: Callable[[Floats, Floats, quality.Quality], Floats] = self.scene.radiance
        if line.is_on("-I"):
            ask = self.scene.irradiance
        elif line.is_on("-i"):
            ask = self.scene.irradiance_of_surfaces
        return spread(ask(self.origins[good], self.directions[good], self.work), good, 0.0)

    @property
    def deltas(self) -> Deltas:
        """What comes by mirrored and straight rays."""
        if self._deltas is None:
            self._deltas = self._find_deltas()
        return self._deltas

    def _find_deltas(self) -> Deltas:
        good = self.is_ray
        found = self.scene.world.first_deltas(self.origins[good], self.directions[good])
        point, share, towards, straight = (spread(part, good, 0.0) for part in found[:4])
        is_plane = spread(found[4].astype(np.int64), good, 0).astype(bool)
        mirrors, passes = share.max(axis=1, initial=0.0) > 0, straight.max(axis=1, initial=0.0) > 0
        mirrored = np.zeros_like(self.origins)
        leaving = point + NUDGE * towards
        mirrored[mirrors] = share[mirrors] * self.scene.radiance(leaving[mirrors], towards[mirrors], self.work)
        met = np.minimum(self.first.distance, FAR)
        mirrored_distance = np.where(mirrors, met, FAR)
        adds = mirrors & is_plane
        mirrored_distance[adds] += self.scene.first(leaving[adds], towards[adds]).distance
        straight_distance = met.copy()
        ahead = self.directions[passes] / self.lengths[passes, None]
        straight_distance[passes] += self.scene.first(point[passes] + NUDGE * ahead, ahead).distance
        return Deltas(mirrored, np.minimum(mirrored_distance, FAR), np.minimum(straight_distance, FAR))

    def effective_distance(self) -> Floats:
        """By whichever way more light comes (n,)."""
        mirrored = self.deltas.mirrored @ BRIGHTNESS > MIRROR_SHARE * (self.values() @ BRIGHTNESS)
        return np.where(mirrored, self.deltas.mirrored_distance, self.deltas.straight_distance)

    def column(self, letter: str) -> Floats:
        """Give the numbers of a letter (n, k)."""
        return COLUMNS[letter](self)

    @property
    def is_met(self) -> npt.NDArray[np.bool_]:
        """Whether each ray meets anything that is not infinitely far."""
        return np.isfinite(self.first.distance)

    @property
    def is_named(self) -> npt.NDArray[np.bool_]:
        """Whether each ray meets anything, sources among it."""
        return self.first.surface >= 0

    def words(self, letter: str) -> list[str]:
        """Give the names of a letter."""
        if letter == "~":
            return ["~"] * len(self.rays)
        labels = self.scene.scene.surface_labels()
        which = "smM".index(letter)
        return [str(labels[surface][which]) if surface >= 0 else "*" for surface in self.first.surface.tolist()]


def unit_directions(answers: Answers) -> Floats:
    """Directions of length 1; nothing for what is no ray."""
    lengths = np.where(answers.is_ray, answers.lengths, 1.0)
    return np.where(answers.is_ray[:, None], answers.directions / lengths[:, None], 0.0)


COLUMNS: dict[str, Callable[[Answers], Floats]] = {
    "o": lambda answers: answers.origins,
    "d": unit_directions,
    "v": Answers.values,
    "V": Answers.values,
    "r": lambda answers: answers.deltas.mirrored,
    "R": lambda answers: answers.deltas.mirrored_distance[:, None],
    "x": lambda answers: answers.values() - answers.deltas.mirrored,
    "X": lambda answers: answers.deltas.straight_distance[:, None],
    "l": lambda answers: answers.effective_distance()[:, None],
    "L": lambda answers: np.minimum(answers.first.distance, FAR)[:, None],
    "p": lambda answers: np.where(answers.is_met[:, None], answers.first.point, answers.origins),
    "n": lambda answers: np.where(answers.is_named[:, None], answers.first.bent_normal, 0.0),
    "N": lambda answers: np.where(answers.is_named[:, None], answers.first.flat_normal, 0.0),
    "c": lambda answers: np.where(answers.is_met[:, None], answers.first.local[:, :2], 0.0),
    "w": lambda answers: np.ones((len(answers.rays), 1)),
    "W": lambda answers: np.ones((len(answers.rays), 3)),
}
"""Numbers of the letters of `-o` (n, k)."""


def spread(values: npt.NDArray[Number], where: npt.NDArray[np.bool_], otherwise: float) -> npt.NDArray[Number]:
    """Put values to where they belong, and another one elsewhere."""
    whole = np.full((len(where), *values.shape[1:]), otherwise, dtype=values.dtype)
    whole[where] = values
    return whole


def table(answers: Answers, fields: str, form: str) -> bytes:
    """All columns, row by row."""
    if form == "c" and fields not in ("v", "V", "r", "x"):
        raise InputError(f"-fc: expected -ov, -or or -ox, found -o{fields}: only colours are written so")
    if not set(fields) & set("smM~"):
        return numbers.encode(np.hstack([answers.column(letter) for letter in fields]), form)
    if form != "a":
        raise InputError(f"-o{fields}: names are text; expected -fa")
    columns: list[list[str]] = []
    for letter in fields:
        if letter in "smM~":
            columns.append([word + "\t" for word in answers.words(letter)])
        else:
            columns.append(numbers.text(answers.column(letter), "%.6e\t").split("\n")[:-1])
    return "".join("".join(row) + "\n" for row in zip(*columns, strict=True)).encode()
