//! Where the sun of `gendaylit` stands, and whether it is day.

use super::HIGHEST_SUN_DEG;
use super::args::When;
use super::daylit_args::Request;
use super::daylit_radiation::Reason;
use crate::position::{declination_and_solar_time, ies_declination, position_at};
use crate::{RadianceSite, sun_direction};
use std::f64::consts::PI;
use sunpeak_core::Vec3;

/// Where the sun stands.
pub(super) struct Place {
    pub altitude_rad: f64,
    azimuth_west_of_south_rad: f64,
    solar_time_h: f64,
    /// 0 where the angles are given, as in the program.
    pub day_of_year: f64,
    /// Why there is no light, if so.
    pub dark: Option<Reason>,
}

impl Place {
    pub fn find(request: &Request, comments: &mut String) -> Self {
        let mut place = match request.when {
            When::Angles { altitude_deg, azimuth_west_of_south_deg } => Self {
                altitude_rad: altitude_deg.to_radians(),
                azimuth_west_of_south_rad: azimuth_west_of_south_deg.to_radians(),
                solar_time_h: 0.0,
                day_of_year: 0.0,
                dark: None,
            },
            When::Time { date, clock } => {
                let (declination, solar_time) = declination_and_solar_time(&request.site, &date, clock);
                let day_of_year = f64::from(date.day_of_year());
                let daytime = Daytime::new(&request.site, day_of_year, request.interval_min);
                let (solar_time_h, dark) = daytime.correct(solar_time, comments);
                let position = position_at(&request.site, declination, solar_time_h);
                Self {
                    altitude_rad: position.altitude_rad,
                    azimuth_west_of_south_rad: position.azimuth_west_of_south_rad,
                    solar_time_h,
                    day_of_year,
                    dark,
                }
            }
        };
        let highest = HIGHEST_SUN_DEG.to_radians();
        if place.dark.is_none() && !request.cloudy && place.altitude_rad > highest {
            comments.push_str("# warning - sun too close to zenith, reducing altitude to 87 degrees\n");
            place.altitude_rad = highest;
        }
        place
    }

    pub fn sun(&self) -> Vec3 {
        sun_direction(self.altitude_rad.to_degrees(), self.azimuth_west_of_south_rad.to_degrees() + 180.0)
    }

    pub fn comment(&self) -> String {
        format!(
            "# Local solar time: {:.2}\n# Solar altitude and azimuth: {:.1} {:.1}\n",
            self.solar_time_h,
            self.altitude_rad.to_degrees(),
            self.azimuth_west_of_south_rad.to_degrees()
        )
    }
}

/// Sunrise and sunset in solar time [h]; NaN, and never reached, in polar day and night.
struct Daytime {
    sunrise: f64,
    sunset: f64,
    half_interval: f64,
}

impl Daytime {
    fn new(site: &RadianceSite, day_of_year: f64, interval_min: f64) -> Self {
        // Single precision as in the program: the switch at sunrise then falls on the same side.
        let cosine = -(site.latitude_deg.to_radians().tan() * ies_declination(day_of_year).tan()) as f32;
        let half_day_h = f64::from(cosine).acos() * 12.0 / PI;
        Self {
            sunrise: 12.0 - half_day_h,
            sunset: 12.0 + half_day_h,
            half_interval: f64::from(interval_min as f32 / 120.0),
        }
    }

    /// With `-i` the part of the interval that lies in the day stands for it; otherwise the hour as it is.
    fn correct(&self, mut time: f64, comments: &mut String) -> (f64, Option<Reason>) {
        let half = self.half_interval;
        let given = time;
        if half > 0.0 && (self.sunrise - time).abs() <= half {
            time = (time + half + self.sunrise) / 2.0;
        }
        if half > 0.0 && (self.sunset - time).abs() < half {
            time = (time - half + self.sunset) / 2.0;
        }
        if time != given {
            comments.push_str("# Solar position corrected for the time interval\n");
        }
        let night = time < self.sunrise - half || time > self.sunset + half;
        (time, night.then_some("sun below the horizon"))
    }
}
