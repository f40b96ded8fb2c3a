"""Skies: the sun, the sky and the ground, from weather, from a place and a time, or from a standard.

Angles are in degrees; the sun's azimuth is clockwise from north. Longitudes and time zones are positive to the east.
The sun is a disc of 0.533 degrees. Its position comes from pvlib (NREL's algorithm, `pvlib.solarposition`).
"""

import math
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from os import PathLike
from typing import Literal, NamedTuple, Self

from sunpeak import _core

CieKind = Literal["clear", "intermediate", "overcast", "uniform"]
"""The four skies of Radiance's `gensky`."""

GROUND_REFLECTANCE = 0.2
"""Reflectance of the ground around, as in Radiance's sky programs [-]."""

EQUINOX = 81
"""Day of the year that is taken where none is given: it moves the sun's distance, 3 % of the clearness."""


class SunPosition(NamedTuple):
    """Where the sun stands."""

    altitude_deg: float
    """Above the horizon, without refraction."""
    azimuth_deg: float
    """Clockwise from north."""


@dataclass(frozen=True)
class Place:
    """A place on the earth."""

    latitude_deg: float
    """Positive to the north."""
    longitude_deg: float
    """Positive to the east."""
    elevation_m: float = 0.0
    """Above the sea."""


class Sky:
    """Sun, sky and ground; `to_radiance` writes them as a scene file."""

    def __init__(self, core: _core.Sky) -> None:
        """Wrap the compiled sky; users call `perez`, `cie` or `from_epw`."""
        self._core = core

    @classmethod
    def perez(
        cls,
        sun: SunPosition | tuple[float, float],
        direct_normal_w_m2: float,
        diffuse_horizontal_w_m2: float,
        *,
        day_of_year: int = EQUINOX,
        ground_reflectance: float = GROUND_REFLECTANCE,
        dew_point_c: float | None = None,
    ) -> Self:
        """Perez all-weather sky [1] from irradiances of the whole spectrum [W/m²].

        `sun` is (altitude, azimuth) [deg]. Illuminances follow from the efficacy model [2], which knows the water in
        the air by the dew point [°C] (2 cm of precipitable water unless it is given).

        [1] Perez, Seals, Michalsky 1993, "All-weather model for sky luminance distribution", Solar Energy 50(3).
        [2] Perez et al. 1990, "Modeling daylight availability and irradiance components", Solar Energy 44(5).
        """
        altitude, azimuth = sun
        return cls(
            _core.Sky.perez(
                altitude,
                azimuth,
                direct_normal_w_m2,
                diffuse_horizontal_w_m2,
                day_of_year,
                ground_reflectance,
                dew_point_c,
            )
        )

    @classmethod
    def cie(
        cls,
        kind: CieKind,
        sun: SunPosition | tuple[float, float],
        *,
        with_sun: bool = True,
        turbidity: float | None = None,
        diffuse_horizontal_w_m2: float | None = None,
        direct_normal_w_m2: float | None = None,
        ground_reflectance: float = GROUND_REFLECTANCE,
    ) -> Self:
        """CIE standard sky, as `gensky` makes it. `sun` is (altitude, azimuth) [deg].

        Irradiances here are luminous: illuminance divided by 179 lm/W. Where none is given it follows from the sun's
        altitude and the turbidity.
        """
        altitude, azimuth = sun
        return cls(
            _core.Sky.cie(
                kind,
                altitude,
                azimuth,
                with_sun,
                turbidity,
                diffuse_horizontal_w_m2,
                direct_normal_w_m2,
                ground_reflectance,
            )
        )

    @classmethod
    def from_epw(
        cls,
        path: str | PathLike[str],
        month: int,
        day: int,
        hour: int,
        *,
        ground_reflectance: float = GROUND_REFLECTANCE,
    ) -> Self:
        """Perez sky of one row of an EPW weather file.

        `hour` is the row's own: 1 to 24, the interval that ends then; the sun stands at its middle.
        """
        return cls(weather_row(path, month, day, hour).sky(ground_reflectance))

    @property
    def sun_direction(self) -> tuple[float, float, float] | None:
        """Unit vector towards the sun, in world axes; `None` if it does not shine."""
        sun = self._core.sun
        return None if sun is None else (sun[0][0], sun[0][1], sun[0][2])

    @property
    def sun_radiance(self) -> tuple[float, float, float] | None:
        """Radiance of the sun's disc, three channels [W sr⁻¹ m⁻²]; `None` if it does not shine."""
        sun = self._core.sun
        return None if sun is None else (sun[1][0], sun[1][1], sun[1][2])

    @property
    def direct_normal_lux(self) -> float:
        """Illuminance by the sun on a surface that faces it [lx]."""
        return self._core.direct_normal_lux

    @property
    def diffuse_horizontal_lux(self) -> float:
        """Illuminance by the sky on a horizontal surface [lx]."""
        return self._core.diffuse_horizontal_lux

    def brightness(self, direction: tuple[float, float, float]) -> float:
        """Radiance [W sr⁻¹ m⁻²] of sky or ground, without the sun, towards a unit vector in world axes."""
        return self._core.brightness(direction)

    def to_radiance(self) -> str:
        """Write a complete Radiance scene text: sun, sky and ground."""
        return self._core.to_radiance()


def sun_position(place: Place, when: datetime) -> SunPosition:
    """Where the sun stands over a place at a time; the time needs its time zone."""
    if when.tzinfo is None:
        text = when.isoformat()
        raise _core.InputError(f"time {text}: has no time zone; expected one, as in {text}+01:00")
    import pandas as pd  # noqa: PLC0415  (a second that most commands need not spend)
    from pvlib import solarposition  # noqa: PLC0415

    row = solarposition.get_solarposition(
        pd.DatetimeIndex([when]), place.latitude_deg, place.longitude_deg, altitude=place.elevation_m
    ).iloc[0]
    return SunPosition(float(row["elevation"]), float(row["azimuth"]))


@dataclass(frozen=True)
class WeatherRow:
    """What a weather file says about one hour."""

    place: Place
    middle: datetime
    direct_normal_w_m2: float
    diffuse_horizontal_w_m2: float
    dew_point_c: float

    def sky(self, ground_reflectance: float = GROUND_REFLECTANCE) -> _core.Sky:
        """Make the Perez sky of this hour."""
        sun = sun_position(self.place, self.middle)
        return _core.Sky.perez(
            sun.altitude_deg,
            sun.azimuth_deg,
            self.direct_normal_w_m2,
            self.diffuse_horizontal_w_m2,
            self.middle.timetuple().tm_yday,
            ground_reflectance,
            self.dew_point_c,
        )


def weather_row(path: str | PathLike[str], month: int, day: int, hour: int) -> WeatherRow:
    """Read one row of an EPW file; `hour` is 1 to 24, the interval that ends then."""
    from pvlib import iotools  # noqa: PLC0415

    try:
        table, about = iotools.read_epw(path)
    except (ValueError, KeyError, IndexError, UnicodeDecodeError) as error:
        raise _core.InputError(f"{path}: is not an EPW weather file: {error}") from error
    rows = table[(table["month"] == month) & (table["day"] == day) & (table["hour"] == hour)]
    if rows.empty:
        raise _core.InputError(f"{path}: has no row for month {month}, day {day}, hour {hour}; hours are 1 to 24")
    row = rows.iloc[0]
    zone = timezone(timedelta(hours=float(about["TZ"])))
    start = datetime(int(row["year"]), month, day, tzinfo=zone) + timedelta(hours=hour - 1)
    numbers = {name: float(row[name]) for name in ("dni", "dhi", "temp_dew")}
    for name, value in numbers.items():
        if not math.isfinite(value):
            raise _core.InputError(f"{path}: month {month}, day {day}, hour {hour}: {name} is missing")
    return WeatherRow(
        place=Place(float(about["latitude"]), float(about["longitude"]), float(about["altitude"])),
        middle=start + timedelta(minutes=30),
        direct_normal_w_m2=numbers["dni"],
        diffuse_horizontal_w_m2=numbers["dhi"],
        dew_point_c=numbers["temp_dew"],
    )
