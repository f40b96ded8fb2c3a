//! Where the sun stands: Radiance's own algorithms, for `gensky` and `gendaylit`, and directions from angles.
//!
//! Without a year: the approximate formulas of the IES Lighting Handbook (1987 reference volume, "Calculation of solar
//! position"). With a year: Michalsky 1988, "The Astronomical Almanac's algorithm for approximate solar position
//! (1950-2050)", Solar Energy 40(3). The two differ by up to 1 degree. Everywhere else Sunpeak leaves this to pvlib.

use std::f64::consts::{PI, TAU};
use sunpeak_core::Vec3;

/// Unit vector towards the sun (x east, y north, z up); azimuth in degrees clockwise from north.
pub fn sun_direction(altitude_deg: f64, azimuth_deg: f64) -> Vec3 {
    let (altitude, azimuth) = (altitude_deg.to_radians(), azimuth_deg.to_radians());
    Vec3::new(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}

/// A place as Radiance's options state it: longitudes are positive to the **west**.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadianceSite {
    /// `-a`: latitude [deg north].
    pub latitude_deg: f64,
    /// `-o`: longitude [deg west of Greenwich].
    pub longitude_west_deg: f64,
    /// `-m`: the time zone's standard meridian [deg west of Greenwich].
    pub meridian_west_deg: f64,
}

impl Default for RadianceSite {
    /// What `gensky -defaults` prints: Berkeley, California.
    fn default() -> Self {
        Self {
            latitude_deg: 0.66_f64.to_degrees(),
            longitude_west_deg: 2.13_f64.to_degrees(),
            meridian_west_deg: 120.0,
        }
    }
}

/// A day; the year, where given, chooses the more exact algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Date {
    /// `-y`
    pub year: Option<i32>,
    /// 1 to 12.
    pub month: u32,
    /// 1 to 31.
    pub day: u32,
}

impl Date {
    /// Day of a year without a leap day, from 1.
    pub fn day_of_year(&self) -> i32 {
        const DAYS_BEFORE_MONTH: [i32; 12] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334];
        let month = self.month.clamp(1, 12) as usize;
        DAYS_BEFORE_MONTH[month - 1] + self.day as i32
    }
}

/// The hour of a day [h].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// Local standard time of the site's meridian.
    Standard(f64),
    /// Local solar time (`+` before the hour): 12 is when the sun stands in the south (or north).
    Solar(f64),
}

impl Clock {
    fn hour(self) -> f64 {
        match self {
            Self::Standard(hour) | Self::Solar(hour) => hour,
        }
    }
}

/// Where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolarPosition {
    /// Above the horizon [rad].
    pub altitude_rad: f64,
    /// Radiance's azimuth: from **south**, positive to the **west** [rad].
    pub azimuth_west_of_south_rad: f64,
    /// Local solar time [h].
    pub solar_time_h: f64,
}

impl SolarPosition {
    /// Unit vector towards the sun.
    pub fn direction(&self) -> Vec3 {
        sun_direction(self.altitude_rad.to_degrees(), self.azimuth_west_of_south_rad.to_degrees() + 180.0)
    }
}

/// The sun's position by Radiance's algorithms: with `date.year` by the Almanac's, without by the IES formulas.
pub fn solar_position_radiance(site: &RadianceSite, date: &Date, clock: Clock) -> SolarPosition {
    let (declination, solar_time_h) = declination_and_solar_time(site, date, clock);
    position_at(site, declination, solar_time_h)
}

/// Solar declination [rad] and local solar time [h].
pub(crate) fn declination_and_solar_time(site: &RadianceSite, date: &Date, clock: Clock) -> (f64, f64) {
    let (declination, from_standard) = match date.year {
        Some(year) => almanac(site, date, year, clock.hour()),
        None => {
            let day = f64::from(date.day_of_year());
            (ies_declination(day), clock.hour() + ies_solar_time_correction(site, day))
        }
    };
    match clock {
        Clock::Solar(hour) => (declination, hour),
        Clock::Standard(_) => (declination, from_standard),
    }
}

/// Altitude and azimuth by spherical trigonometry.
pub(crate) fn position_at(site: &RadianceSite, declination: f64, solar_time_h: f64) -> SolarPosition {
    let hour_angle = solar_time_h * PI / 12.0; // from midnight
    let (sin_lat, cos_lat) = site.latitude_deg.to_radians().sin_cos();
    let (sin_dec, cos_dec) = declination.sin_cos();
    let up = sin_lat * sin_dec - cos_lat * cos_dec * hour_angle.cos();
    let south = -cos_lat * sin_dec - sin_lat * cos_dec * hour_angle.cos();
    let east = cos_dec * hour_angle.sin();
    SolarPosition {
        altitude_rad: up.clamp(-1.0, 1.0).asin(),
        azimuth_west_of_south_rad: -east.atan2(south),
        solar_time_h,
    }
}

/// Declination [rad] on a day of the year (IES).
pub(crate) fn ies_declination(day_of_year: f64) -> f64 {
    0.4093 * (TAU / 365.0 * (day_of_year - 81.0)).sin()
}

/// Solar minus standard time [h]: equation of time (IES) and distance from the standard meridian.
fn ies_solar_time_correction(site: &RadianceSite, day_of_year: f64) -> f64 {
    let equation_of_time_h = 0.170 * (2.0 * TAU / 373.0 * (day_of_year - 80.0)).sin()
        - 0.129 * (TAU / 355.0 * (day_of_year - 8.0)).sin();
    equation_of_time_h + (site.meridian_west_deg - site.longitude_west_deg) / 15.0
}

/// Declination [rad] and solar time [h] by Michalsky 1988, equations 1 to 8.
fn almanac(site: &RadianceSite, date: &Date, year: i32, hour: f64) -> (f64, f64) {
    let days = days_since_2000(site, date, year, hour);
    let deg = f64::to_radians;
    let mean_longitude = deg(280.460 + 0.9856474 * days).rem_euclid(TAU);
    let mean_anomaly = deg(357.528 + 0.9856003 * days).rem_euclid(TAU);
    let longitude =
        mean_longitude + deg(1.915) * mean_anomaly.sin() + deg(0.020) * (2.0 * mean_anomaly).sin();
    let obliquity = deg(23.439 - 4e-7 * days);

    let declination = (obliquity.sin() * longitude.sin()).asin();
    let right_ascension = (longitude.sin() * obliquity.cos()).atan2(longitude.cos());
    let universal_time_h = 24.0 * (days - days.floor()) + 12.0;
    let greenwich_sidereal_h = 6.697375 + 0.0657098242 * days + universal_time_h;
    let local_sidereal_h = greenwich_sidereal_h - site.longitude_west_deg / 15.0;
    let hour_angle_h = local_sidereal_h - right_ascension * 12.0 / PI;
    (declination, (hour_angle_h + 12.0).rem_euclid(24.0))
}

/// Days, with fraction, since noon of 1 January 2000, universal time.
fn days_since_2000(site: &RadianceSite, date: &Date, year: i32, hour: f64) -> f64 {
    // Julian date of the start of 1949 less that of noon, 1 January 2000 (Michalsky 1988, equation 1).
    const START_OF_1949: f64 = 2_432_916.5 - 2_451_545.0;
    let leap_day = i32::from(date.month > 2 && year % 4 == 0);
    let years = year - 1949;
    let whole_days = date.day_of_year() + leap_day + years * 365 + years / 4;
    f64::from(whole_days) + (hour + site.meridian_west_deg / 15.0) / 24.0 + START_OF_1949
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solar_noon_stands_in_the_south_at_ninety_minus_latitude() {
        let site = RadianceSite { latitude_deg: 50.0, ..RadianceSite::default() };
        let equinox = Date { year: None, month: 3, day: 22 }; // day 81: declination 0
        let noon = solar_position_radiance(&site, &equinox, Clock::Solar(12.0));
        assert!((noon.altitude_rad.to_degrees() - 40.0).abs() < 1e-9);
        assert!((noon.direction() - sun_direction(40.0, 180.0)).length() < 1e-9);
        let morning = solar_position_radiance(&site, &equinox, Clock::Solar(6.0)).direction();
        assert!((morning - Vec3::X).length() < 1e-9, "{morning}");
    }

    /// The worked example of Reda and Andreas 2004 (NREL/TP-560-34302, table A5.1): Golden, Colorado.
    #[test]
    fn almanac_agrees_with_the_spa_report_to_a_hundredth_of_a_degree() {
        let site =
            RadianceSite { latitude_deg: 39.742476, longitude_west_deg: 105.1786, meridian_west_deg: 105.0 };
        let date = Date { year: Some(2003), month: 10, day: 17 };
        let hour = 12.0 + 30.5 / 60.0;
        let sun = solar_position_radiance(&site, &date, Clock::Standard(hour)).direction();
        let published = sun_direction(39.872046, 194.340241); // without refraction
        assert!(sun.angle_between(published).to_degrees() < 0.01);
    }
}
