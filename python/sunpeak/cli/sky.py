"""`sunpeak sky …`: skies as Radiance text."""

from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from sunpeak.cli.output import emit
from sunpeak.cli.values import parse_place, parse_time
from sunpeak.skies import EQUINOX, GROUND_REFLECTANCE, CieKind, Place, Sky, SunPosition, sun_position

app = typer.Typer(no_args_is_help=True, help="Make a sky and write it as Radiance text.")

SUN = "Where the sun stands (either way)"

Altitude = Annotated[float | None, typer.Option(help="Sun above the horizon, degrees.", rich_help_panel=SUN)]
Azimuth = Annotated[float | None, typer.Option(help="Sun, degrees clockwise from north.", rich_help_panel=SUN)]
PlaceOption = Annotated[
    Place | None,
    typer.Option(
        parser=parse_place, metavar="LAT,LON", help="Degrees north, degrees [b]east[/b].", rich_help_panel=SUN
    ),
]
TimeOption = Annotated[
    datetime | None,
    typer.Option(parser=parse_time, metavar="TIME", help="With its zone: 2024-06-21T14:30+02:00.", rich_help_panel=SUN),
]
Ground = Annotated[float, typer.Option(help="Reflectance of the ground around.")]
Output = Annotated[Path | None, typer.Option("--output", "-o", help="File to write; standard output without it.")]


@app.command("perez")
def perez(
    direct: Annotated[float, typer.Option(help="Direct normal irradiance, W/m².")],
    diffuse: Annotated[float, typer.Option(help="Diffuse horizontal irradiance, W/m².")],
    altitude: Altitude = None,
    azimuth: Azimuth = None,
    place: PlaceOption = None,
    time: TimeOption = None,
    day_of_year: Annotated[int | None, typer.Option(help="1 to 366; without it, that of the time.")] = None,
    dew_point: Annotated[float | None, typer.Option(help="Dew point, °C.")] = None,
    ground: Ground = GROUND_REFLECTANCE,
    output: Output = None,
) -> None:
    """Perez all-weather sky from irradiances of the whole spectrum.

    [dim]$[/dim] [cyan]sunpeak sky perez --altitude 35 --azimuth 170 --direct 700 --diffuse 90 > sky.rad[/cyan]
    """
    sun = where(altitude, azimuth, place, time)
    day = day_of_year or (time.timetuple().tm_yday if time is not None else EQUINOX)
    sky = Sky.perez(sun, direct, diffuse, day_of_year=day, ground_reflectance=ground, dew_point_c=dew_point)
    emit(described(sky, "Perez all-weather sky", sun), output)


@app.command("cie")
def cie(
    kind: Annotated[CieKind, typer.Argument(help="Which standard sky.")],
    altitude: Altitude = None,
    azimuth: Azimuth = None,
    place: PlaceOption = None,
    time: TimeOption = None,
    sun: Annotated[bool, typer.Option("--sun/--no-sun", help="With the sun's disc.")] = True,
    turbidity: Annotated[float | None, typer.Option(help="Turbidity of the air.")] = None,
    ground: Ground = GROUND_REFLECTANCE,
    output: Output = None,
) -> None:
    """CIE standard sky, as gensky.

    [dim]$[/dim] [cyan]sunpeak sky cie clear --place 47.3,11.4 --time 2024-06-21T14:30+02:00 > sky.rad[/cyan]
    """
    position = where(altitude, azimuth, place, time)
    sky = Sky.cie(kind, position, with_sun=sun, turbidity=turbidity, ground_reflectance=ground)
    emit(described(sky, f"CIE {kind} sky", position), output)


@app.command("epw")
def epw(
    file: Annotated[Path, typer.Argument(help="EPW weather file.")],
    month: Annotated[int, typer.Option(min=1, max=12)],
    day: Annotated[int, typer.Option(min=1, max=31)],
    hour: Annotated[int, typer.Option(min=1, max=24, help="The row's own: the hour that ends then.")],
    ground: Ground = GROUND_REFLECTANCE,
    output: Output = None,
) -> None:
    """Perez sky of one row of a weather file; the sun stands at the middle of the hour.

    [dim]$[/dim] [cyan]sunpeak sky epw oakland.epw --month 3 --day 21 --hour 15 > sky.rad[/cyan]
    """
    sky = Sky.from_epw(file, month, day, hour, ground_reflectance=ground)
    emit(described(sky, f"Perez sky, {file.name}, month {month}, day {day}, hour {hour}", None), output)


def where(altitude: float | None, azimuth: float | None, place: Place | None, time: datetime | None) -> SunPosition:
    """Where the sun stands, by its angles or by place and time."""
    if altitude is not None and azimuth is not None and place is None and time is None:
        return SunPosition(altitude, azimuth)
    if place is not None and time is not None and altitude is None and azimuth is None:
        return sun_position(place, time)
    raise typer.BadParameter("expected either --altitude and --azimuth, or --place and --time")


def described(sky: Sky, what: str, sun: SunPosition | None) -> str:
    """The sky's text under a comment that says what it is."""
    lines = [f"# {what}, by Sunpeak"]
    if sun is not None:
        lines.append(f"# sun: altitude {sun.altitude_deg:.4f}, azimuth {sun.azimuth_deg:.4f} degrees from north")
    lines.append(
        f"# direct normal {sky.direct_normal_lux:.0f} lx, diffuse horizontal {sky.diffuse_horizontal_lux:.0f} lx"
    )
    return "\n".join(lines) + "\n\n" + sky.to_radiance()
