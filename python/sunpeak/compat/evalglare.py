"""`evalglare`: glare of a fisheye picture, printed as evalglare 3 prints it.

The numbers follow `--rules evalglare-3` of `sunpeak glare` (see `docs/glare.md`). The equations of `Lveil` and
`ugr_exp` are not published; those here were found from what evalglare 3 prints, and give it to the last digit.
"""

import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak._core import InputError
from sunpeak.comfort import glare
from sunpeak.compat.options import CommandLine, NotDoneError, Table, expand_arguments, parse
from sunpeak.compat.views import view_of
from sunpeak.files import whole_file
from sunpeak.glare_report import GlareReport, GlareSource
from sunpeak.glare_rules import RULES, Task, chosen_options
from sunpeak.pictures import Picture
from sunpeak.scenes import View

Floats = npt.NDArray[np.float64]

VERSION = "Sunpeak's evalglare, for evalglare 3.06's options and output"
TABLE = Table(
    values={"-b": 1, "-r": 1, "-Y": 1, "-i": 1, "-t": 3, "-T": 3, "-c": 1, "-u": 3, "-C": 1, "-G": 1, "-s": 0},
    switches=frozenset({"-d", "-D", "-y", "-x", "-v", "-V", "-w"}),
    idle=frozenset({"-s", "-C", "-G"}),
    has_view=True,
)
LEFT = frozenset({"-I", "-B", "-A", "-g"})
"""Options that Sunpeak does not do."""
LARGEST_FACTOR = 100.0
"""`-b` up to this is a factor on a mean luminance, above it a luminance [cd/m²]."""
TASK_FACTOR = 5.0
"""Threshold over the mean of the task zone where `-b` says nothing."""
HIGHEST_PEAK_CD_M2 = 50_000.0
BRIEF = "dgp,dgi,ugr,vcp,cgi,Lveil"
FULL = (
    "dgp,av_lum,E_v,lum_backg,E_v_dir,dgi,ugr,vcp,cgi,lum_sources,omega_sources,Lveil,Lveil_cie,dgr,ugp,ugr_exp,"
    "dgi_mod,av_lum_pos,av_lum_pos2,med_lum,med_lum_pos,med_lum_pos2,ugp2"
)
EXTENDED = "dgp,dgi,ugr,vcp,cgi,dgp_ext,Ev_calc,abs_max,Lveil"
SOURCES = (
    "No pixels x-pos y-pos L_s Omega_s Posindx L_b L_t E_v Edir Max_Lum Sigma xdir ydir zdir Eglare Lveil_cie teta "
    "glare_zone r_contrast r_dgp"
)
VEIL_DEG = 5.0
"""`Lveil` is the sum over sources of 5° L ω cos θ / θ, θ to the line of sight [deg]; found from evalglare's output."""
EV_EXPONENT = 1.87
"""Of Ev under DGP's contrasts (Wienold and Christoffersen 2006)."""
CHECK_COLOURS = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1))
"""Of sources in the check picture, in turn."""


def run(arguments: list[str]) -> int:
    """Evaluate a picture, and print what was found."""
    words = expand_arguments(arguments)
    if left := LEFT.intersection(words):
        raise NotDoneError(f"{' '.join(sorted(left))}: Sunpeak's evalglare does not do this")
    line = parse(words, TABLE, {"-w": True})
    if line.is_on("-v"):
        sys.stdout.write(VERSION + "\n")
        return 1
    line.note_idle("evalglare", quiet=not line.is_on("-w"))
    if len(line.rest) > 1:
        raise InputError(f"expected one picture, found {' '.join(line.rest)}")
    picture = read_picture(line)
    task = task_of(line, picture)
    stated = stated_options(line, task)
    report = glare(picture, rules="evalglare-3", **stated)
    sys.stderr.writelines(f"evalglare: warning - {warning}\n" for warning in report.warnings if line.is_on("-w"))
    if line.is_on("-V"):
        # The exit status is the program's own habit.
        sys.stdout.write(f"{report.ev_lux:f}\n")
        return 1
    dgp = report.dgp
    if line.has("-i"):
        # A stated illuminance counts for DGP alone.
        dgp = glare(picture, rules="evalglare-3", ev_lux=line.number("-i", 0.0), **stated).dgp
    sys.stdout.write(text(line, picture, report, dgp))
    if line.has("-c"):
        write_check_picture(line, picture, stated)
    return 0


def read_picture(line: CommandLine) -> Picture:
    """Read the picture, from standard input where none is named, and give it the view of the options."""
    if line.rest:
        picture = Picture.load(line.rest[0])
    else:
        with tempfile.NamedTemporaryFile(suffix=".hdr") as file:
            file.write(sys.stdin.buffer.read())
            file.flush()
            picture = Picture.load(file.name)
    if line.view:
        given = str(picture.view).split() if picture.view is not None else []
        view = View(view_of([*given, *line.view]))
        return Picture.of(picture.pixels, view, header=picture.header, exact_sources=picture.exact_sources)
    return picture


def task_of(line: CommandLine, picture: Picture) -> Task | None:
    """Task zone: pixel from the left and from the bottom, opening angle [rad]."""
    option = "-t" if line.has("-t") else "-T"
    if not line.has(option):
        return None
    x, y, opening = line.numbers(option, [])
    height, width = picture.shape
    view = the_view(picture)
    _, directions, _ = view._core.rays_at(np.array([[(x + 0.5) / width, (y + 0.5) / height]]))
    if not np.isfinite(directions).all():
        raise InputError(f"{option} {x} {y}: no pixel of the view; the picture has {width} x {height} pixels")
    towards = directions[0].tolist()
    return Task((towards[0], towards[1], towards[2]), math.degrees(opening))


def the_view(picture: Picture) -> View:
    """Give the view, which a glare picture must have."""
    if picture.view is None:
        raise InputError("the picture has no view; give -vta -vh 180 -vv 180, or a header with VIEW=")
    return picture.view


def stated_options(line: CommandLine, task: Task | None) -> dict[str, Any]:
    """What the options say about how sources are found."""
    stated: dict[str, Any] = {"task": task}
    factor = line.number("-b", TASK_FACTOR)
    if factor > LARGEST_FACTOR:
        stated["threshold_cd_m2"] = factor
    elif task is not None:
        stated |= {"threshold_times_task": (factor, task)}
    elif line.has("-b"):
        stated["threshold_times_mean"] = factor
    if line.has("-r"):
        stated["search_angle_rad"] = line.number("-r", 0.0)
    if line.is_on("-x"):
        stated["peak_cd_m2"] = None
    elif line.has("-Y") or line.is_on("-y"):
        stated["peak_cd_m2"] = line.number("-Y", HIGHEST_PEAK_CD_M2)
    return stated


def text(line: CommandLine, picture: Picture, report: GlareReport, dgp: float) -> str:
    """All lines of the result."""
    ratings = [dgp, *(or_zero(value) for value in (report.dgi, report.ugr))]
    ratings += [100.0 if report.vcp is None else report.vcp, or_zero(report.cgi)]
    veil = veil_of_sources(report)
    if line.is_on("-D"):
        return f"{EXTENDED}: {numbers([*ratings, 0.0, report.ev_lux, report.max_luminance_cd_m2, veil])} \n"
    if not line.is_on("-d"):
        return f"{BRIEF}: {numbers([*ratings, veil])}  \n"
    lines = [f"{len(report.sources)} {SOURCES}"]
    lines += [source_line(number, source, picture, report) for number, source in enumerate(report.sources, start=1)]
    if not report.sources:
        lines.append(no_source_line(report))
    lines.append(f"{FULL}: {numbers(full_values(picture, report, ratings))}")
    return "\n".join([*lines, ""])


def numbers(values: list[float]) -> str:
    """Numbers as evalglare prints them."""
    # No negative zero.
    return " ".join(f"{value + 0.0:f}" for value in values)


def or_zero(value: float | None) -> float:
    """A rating without a value is 0."""
    return 0.0 if value is None else value


@dataclass(frozen=True)
class FieldMeans:
    """Means of luminance over the field of view, weighted by position."""

    by_index: float
    by_square: float
    median: float
    median_by_index: float
    median_by_square: float


def full_values(picture: Picture, report: GlareReport, ratings: list[float]) -> list[float]:
    """Numbers of `-d`, in order."""
    dgp, dgi, ugr, vcp, cgi = ratings
    omega = sum(source.solid_angle_sr for source in report.sources)
    flux = sum(source.luminance_cd_m2 * source.solid_angle_sr for source in report.sources)
    means = field_means(picture)
    return [
        dgp, report.mean_luminance_cd_m2, report.ev_lux, report.background_cd_m2, report.ev_sources_lux,
        dgi, ugr, vcp, cgi, flux / omega if omega else 0.0, omega, veil_of_sources(report),
        report.veiling_luminance_cd_m2, or_zero(report.dgr), or_zero(report.ugp), ugr_experimental(report),
        or_zero(report.dgi_modified),
        means.by_index, means.by_square, means.median, means.median_by_index, means.median_by_square,
        or_zero(report.ugp_2017),
    ]  # fmt: skip


def veil_of_sources(report: GlareReport) -> float:
    """`Lveil` [cd/m²]."""
    veil = 0.0
    for source in report.sources:
        angle = source.angle_to_sight_deg
        flux = source.luminance_cd_m2 * source.solid_angle_sr
        veil += VEIL_DEG * flux * math.cos(math.radians(angle)) / angle if angle > 0.0 else math.inf
    return veil


def ugr_experimental(report: GlareReport) -> float:
    """`ugr_exp`: 8 log10 of Ev / (π Lb) times the sum over sources of L ω / P²; found from evalglare's output."""
    seen = sum(s.luminance_cd_m2 * s.solid_angle_sr / s.position_index**2 for s in report.sources)
    ratio = report.ev_lux / math.pi / report.background_cd_m2 * seen if report.background_cd_m2 > 0.0 else 0.0
    return 8.0 * math.log10(ratio) if ratio > 0.0 else 0.0


def field_means(picture: Picture) -> FieldMeans:
    """Mean over solid angle of luminance over position index, and over its square and 2π; medians over pixels."""
    height, width = picture.shape
    view = the_view(picture)
    directions = view.rays(width, height).directions.reshape(-1, 3)
    sight = view.direction / np.linalg.norm(view.direction)
    with np.errstate(invalid="ignore"):
        ahead = np.isfinite(directions).all(axis=1) & (directions @ sight > 0)
    luminance = picture.luminance().ravel()[ahead]
    omega = view.solid_angles(width, height).ravel()[ahead]
    up = tuple(view.up.tolist())
    index = _core.position_indices(np.ascontiguousarray(directions[ahead]), tuple(sight.tolist()), up, "evalglare-3")
    whole = omega.sum()
    return FieldMeans(
        by_index=float((luminance * omega / index).sum() / whole),
        by_square=float((luminance * omega / index**2).sum() / whole / (2 * math.pi)),
        median=float(np.median(luminance)),
        median_by_index=float(np.median(luminance / index)),
        median_by_square=float(np.median(luminance / index**2)),
    )


def source_line(number: int, source: GlareSource, picture: Picture, report: GlareReport) -> str:
    """One source."""
    height, width = picture.shape
    x, y = the_view(picture).project([source.direction])[0]
    angle = source.angle_to_sight_deg
    # Stiles and Holladay, as in Lveil_cie of the whole.
    veil = 10.0 * source.illuminance_lux / angle**2 if angle > 0 else math.inf
    first = [float(source.pixels), x * width, (1 - y) * height, source.luminance_cd_m2]
    middle = [
        source.position_index, report.background_cd_m2, task_luminance(report), report.ev_lux, report.ev_sources_lux,
        report.max_luminance_cd_m2, angle, *source.direction, source.illuminance_lux, veil, angle,
    ]  # fmt: skip
    # A source alone over all of them, each as a logarithm: the shares add up to more than 1.
    share = contrast(report, [source]) / contrast(report, report.sources)
    shares = [share, share * report.dgp_contrast_term / report.dgp]
    return f"{number} {numbers(first)} {source.solid_angle_sr:.10f} {numbers(middle)} 0 {numbers(shares)} "


def no_source_line(report: GlareReport) -> str:
    """What stands in the place of the first source where there is none."""
    seen = [report.background_cd_m2, task_luminance(report), report.ev_lux, 0.0, report.max_luminance_cd_m2]
    return f"0 {numbers([0.0] * 4)} {0.0:.10f} {numbers([0.0, *seen, *[0.0] * 11])}"


def contrast(report: GlareReport, sources: list[GlareSource]) -> float:
    """Logarithm of DGP's contrast term for some of the sources."""
    return math.log10(1 + sum(source.weight for source in sources) / report.ev_lux**EV_EXPONENT)


def task_luminance(report: GlareReport) -> float:
    """Mean luminance of the task zone, or of the field of view."""
    return report.mean_luminance_cd_m2 if report.zones.task_cd_m2 is None else report.zones.task_cd_m2


def write_check_picture(line: CommandLine, picture: Picture, stated: dict[str, Any]) -> None:
    """Write the picture with its sources in colour (`-c`), all of them in one with `-u`."""
    options = chosen_options(RULES["evalglare-3"], **stated)
    sources = _core.glare_sources(picture._core, options)
    pixels = picture.pixels.copy()
    brightness = float(pixels.max())
    for number in range(1, int(sources.max(initial=0)) + 1):
        colour = line.numbers("-u", CHECK_COLOURS[(number - 1) % len(CHECK_COLOURS)])
        pixels[sources == number] = np.array(colour) * brightness / 10
    drawn = Picture.of(pixels, picture.view, header=picture.header)
    with whole_file(Path(line.values["-c"][0])) as temporary:
        drawn.save(temporary)
