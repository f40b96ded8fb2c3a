"""Radiance's quality options as samples and a statistical error.

`-ad N` is the number of directions in which Radiance looks for indirect light. Here it says how long: paths are traced
until the error is below `ERROR_AT_ONE / sqrt(N)` of the mean with 95 % confidence (each sensor's own, or that of a
picture's blocks over the picture's), or up to a number of paths that grows with N. `-ab` limits the diffuse bounces and
`-av` is what lies past them. Options of our own, with two dashes, overrule both.
"""

import math
from dataclasses import dataclass

from sunpeak._core import InputError
from sunpeak.compat.options import CommandLine, NotDoneError

ERROR_AT_ONE = 0.3
"""Error [-] that a single direction would stand for: 1024 of them mean 0.9 %."""
LEAST_PATHS = 64
PATHS_PER_DIRECTION = 16
"""Most paths of a sensor, for each of Radiance's directions; of a pixel one."""
PIXELS_IN_BLOCK = 64
"""A picture's error is that of blocks of so many pixels."""

OWN_VALUES = {"--samples": 1, "--error": 1, "--time": 1, "--seed": 1, "--peak": 1}
RENDER_VALUES = {
    "-ab": 1, "-ad": 1, "-av": 3, "-n": 1,
    "-aw": 1, "-aa": 1, "-ar": 1, "-as": 1, "-af": 1, "-ae": 1, "-ai": 1, "-aE": 1, "-aI": 1, "-am": 1,
    "-dt": 1, "-dc": 1, "-dj": 1, "-ds": 1, "-dr": 1, "-dp": 1, "-ss": 1, "-st": 1, "-sj": 1, "-lr": 1, "-lw": 1,
    "-me": 3, "-ma": 3, "-mg": 1, "-ms": 1, "-cs": 1, "-cw": 2, "-pc": 8, "-P": 1, "-PP": 1, "-e": 1, "-ap": 2,
    **OWN_VALUES,
}  # fmt: skip
"""Options of rendering that rpict and rtrace share."""
IDLE_VALUES = frozenset(RENDER_VALUES) - {"-ab", "-ad", "-av", "-n", "-e", "-cs", "-pc", *OWN_VALUES}
SWITCHES = frozenset({"-w", "-i", "-u", "-bv", "-dv", "-co", "-pRGB", "-pXYZ"})
IDLE_SWITCHES = frozenset({"-u", "-bv", "-dv"})
COLOURS = 3
"""Of a picture, and of `-cs` where no spectra are wanted."""


@dataclass(frozen=True)
class Quality:
    """How long to work, as `sunpeak.render` and `sunpeak.trace` want it."""

    samples: int | None
    error: float | None
    error_of_each: bool
    """Whether it is that of each ray relative to its own mean."""
    time: float | None
    seed: int
    peak: str
    threads: int | None
    max_bounces: int
    ambient: tuple[float, float, float]


def check_colours(line: CommandLine) -> None:
    """Refuse other colours than Radiance's three: other primaries, spectra."""
    asked = [option for option in ("-pXYZ", "-pc") if option in line.switches or line.has(option)]
    if line.is_on("-co") and line.whole("-cs", COLOURS) > COLOURS:
        asked.append("-co+")
    if asked:
        raise NotDoneError(f"{' '.join(asked)}: Sunpeak's colours are Radiance's RGB alone")


def sensors(line: CommandLine, directions: int) -> Quality:
    """Read the options for single rays and sensors; `directions` is the program's own `-ad`."""
    return quality(line, directions, paths=PATHS_PER_DIRECTION, looseness=1.0, each=True)


def rays_of_picture(line: CommandLine, directions: int) -> Quality:
    """Read the options for rays that make a picture: each is a pixel."""
    return quality(line, directions, paths=1, looseness=math.sqrt(PIXELS_IN_BLOCK))


def picture(line: CommandLine, directions: int) -> Quality:
    """Read the options for a picture, whose error is that of blocks."""
    return quality(line, directions, paths=1, looseness=1.0)


def quality(line: CommandLine, directions: int, paths: int, looseness: float, *, each: bool = False) -> Quality:
    """Turn the options into samples and an error."""
    chosen = max(line.whole("-ad", directions), 1)
    bounces = line.whole("-ab", 0)
    if bounces < 0:
        raise InputError(f"-ab {bounces}: expected 0 or more")
    samples: int | None = max(LEAST_PATHS, 1 << math.ceil(math.log2(paths * chosen)))
    error: float | None = looseness * ERROR_AT_ONE / math.sqrt(chosen)
    time: float | None = None
    if any(line.has(option) for option in ("--samples", "--error", "--time")):
        samples = line.whole("--samples", 0) or None
        error = line.number("--error", 0.0) / 100 or None
        time = line.number("--time", 0.0) or None
    red, green, blue = line.numbers("-av", [0.0, 0.0, 0.0])
    return Quality(
        samples=samples,
        error=error,
        error_of_each=each,
        time=time,
        seed=line.whole("--seed", 0),
        peak=line.values.get("--peak", ["split"])[0],
        threads=line.whole("-n", 0) or None,
        max_bounces=bounces,
        ambient=(red, green, blue),
    )


def defaults_text(line: CommandLine, directions: int) -> str:
    """Give the lines of `-defaults` for what has a meaning here."""
    red, green, blue = line.numbers("-av", [0.0, 0.0, 0.0])
    return (
        f"-av {red:f} {green:f} {blue:f}\t# ambient value\n"
        f"-ab {line.whole('-ab', 0):<9}\t\t\t# ambient bounces\n"
        f"-ad {line.whole('-ad', directions):<9}\t\t\t# ambient divisions\n"
    )
