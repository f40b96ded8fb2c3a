"""`sunpeak trace`: rays or sensors on standard input, as `rtrace`."""

import sys
from typing import Annotated

import numpy as np
import typer

from sunpeak import InputError
from sunpeak.cli import options
from sunpeak.images import LUMINOUS_EFFICACY, luminance_cd_m2
from sunpeak.rendering import trace
from sunpeak.scattering import Floats

NUMBERS = 6
"""Of a line: point and direction."""


def command(
    scenes: options.Scenes,
    irradiance: Annotated[
        bool, typer.Option("--irradiance", "-I", help="Irradiance at sensors; the direction is their normal.")
    ] = False,
    photometric: Annotated[
        bool, typer.Option("--photometric", "-p", help="One number a line: luminance, cd/m², or illuminance, lx.")
    ] = False,
    errors: Annotated[
        bool, typer.Option("--errors", help="One more number a line: its standard error, in the unit of the others.")
    ] = False,
    peak: options.PeakRule = "split",
    samples: options.Samples = None,
    time: options.Seconds = None,
    error: options.Error = None,
    seed: options.Seed = 0,
    threads: options.Threads = None,
    max_bounces: options.MaxBounces = None,
    portal: options.Portals = None,
    search_path: options.SearchPath = None,
    allow_commands: options.AllowCommands = False,
    quiet: options.Quiet = False,
) -> None:
    """Radiance along rays, or irradiance at sensors.

    Standard input has a line "x y z dx dy dz" for each; standard output a line of red, green and blue.

    With --errors a line ends with the standard error of its luminous mean (of lux or cd/m² with -p); nan for few paths.

    [dim]$[/dim] [cyan]sunpeak trace room.rad sky.rad -I -p --errors < sensors.pts[/cyan]
    """
    scene = options.load_scene(scenes, search_path, allow_commands)
    lines = read_rays(sys.stdin.read().splitlines())
    values = trace(
        scene,
        lines[:, :3],
        lines[:, 3:],
        irradiance=irradiance,
        peak=peak,
        samples=samples,
        time=time,
        error=error,
        with_errors=errors,
        seed=seed,
        threads=threads,
        max_bounces=max_bounces,
        portals=portal or (),
        progress=not quiet,
    )
    if photometric:
        columns = [luminance_cd_m2(values[:, :3]), *(LUMINOUS_EFFICACY * values[:, 3:]).T]
        values = np.column_stack(columns)
    np.savetxt(sys.stdout, values, fmt="%.6e", delimiter="\t")


def read_rays(lines: list[str]) -> Floats:
    """Rows (n, 6) of the lines that are not empty."""
    rays = [read_ray(line, number) for number, line in enumerate(lines, start=1) if line.strip()]
    return np.array(rays, dtype=np.float64).reshape(-1, NUMBERS)


def read_ray(line: str, number: int) -> list[float]:
    """Point and direction of a line."""
    words = line.split()
    try:
        ray = [float(word) for word in words]
    except ValueError as error:
        raise InputError(f"standard input:{number}: {error}; expected six numbers, x y z dx dy dz") from error
    if len(ray) != NUMBERS:
        raise InputError(f"standard input:{number}: found {len(ray)} numbers; expected six, x y z dx dy dz")
    if not np.isfinite(ray).all():
        raise InputError(f"standard input:{number}: found a number that is not finite; expected x y z dx dy dz")
    return ray
