//! The all-weather model: what a pair of irradiances says about the sky.
//!
//! Perez et al. 1990, Solar Energy 44(5): sky clearness and brightness, luminous efficacy. Perez et al. 1993, Solar
//! Energy 50(3): how luminance is spread over the sky.

use crate::perez_tables::{CLEARNESS_BOUNDS, DIFFUSE_EFFICACY, DIRECT_EFFICACY, LUMINANCE_TERMS};
use std::f64::consts::{FRAC_PI_2, TAU};
use sunpeak_core::{Error, Result, Vec3};

/// Solar constant [W/m²] of `gendaylit`.
pub(crate) const SOLAR_CONSTANT_W_M2: f64 = 1367.0;

/// Luminous solar constant [lx] of `gendaylit`.
pub(crate) const SOLAR_CONSTANT_LUX: f64 = 127_500.0;

/// Dew point [°C] that gives 2 cm of precipitable water, the value for which Perez et al. 1990 state their efficacies.
pub(crate) const DEFAULT_DEW_POINT_C: f64 = 10.973_531_15;

/// Sky clearness stays in here: the model's table ends at 12.01 (as in `gendaylit`).
const CLEARNESS_RANGE: [f64; 2] = [1.0, 12.01];

/// Sky brightness stays in here (as in `gendaylit`).
const BRIGHTNESS_RANGE: [f64; 2] = [0.01, 0.6];

/// The weather of a Perez sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerezWeather {
    /// Unit vector towards the sun.
    pub sun_direction: Vec3,
    /// Direct normal irradiance, whole spectrum [W/m²].
    pub direct_normal_w_m2: f64,
    /// Diffuse horizontal irradiance, whole spectrum [W/m²].
    pub diffuse_horizontal_w_m2: f64,
    /// Day of the year, 1 to 366: distance of the sun.
    pub day_of_year: u32,
    /// Reflectance of the ground around [-].
    pub ground_reflectance: f64,
    /// Dew point [°C]: precipitable water, which moves the luminous efficacy by a few per cent.
    pub dew_point_c: f64,
}

impl Default for PerezWeather {
    fn default() -> Self {
        Self {
            sun_direction: Vec3::Z,
            direct_normal_w_m2: 0.0,
            diffuse_horizontal_w_m2: 0.0,
            day_of_year: 81,
            ground_reflectance: 0.2,
            dew_point_c: DEFAULT_DEW_POINT_C,
        }
    }
}

/// What the luminous efficacy model makes of the two irradiances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerezIlluminance {
    /// Direct normal illuminance [lx].
    pub direct_normal_lux: f64,
    /// Diffuse horizontal illuminance [lx].
    pub diffuse_horizontal_lux: f64,
    /// Sky clearness ε [-].
    pub clearness: f64,
    /// Sky brightness Δ [-].
    pub brightness: f64,
}

impl PerezWeather {
    /// Direct and diffuse illuminance by the luminous efficacy model of Perez et al. 1990.
    pub fn illuminance(&self) -> Result<PerezIlluminance> {
        let condition = self.condition()?;
        let diffuse_efficacy =
            if self.diffuse_horizontal_w_m2 > 0.0 { condition.diffuse_efficacy() } else { 0.0 };
        let direct_efficacy = if self.sun_is_up() { condition.direct_efficacy() } else { 0.0 };
        Ok(PerezIlluminance {
            direct_normal_lux: self.direct_normal_w_m2 * direct_efficacy,
            diffuse_horizontal_lux: self.diffuse_horizontal_w_m2 * diffuse_efficacy.max(0.0),
            clearness: condition.clearness,
            brightness: condition.brightness,
        })
    }

    /// Is any part of the sun's centre line above the horizon?
    pub(crate) fn sun_is_up(&self) -> bool {
        self.sun_direction.z > 0.0
    }

    /// Clearness and brightness of this weather.
    pub(crate) fn condition(&self) -> Result<Condition> {
        self.check()?;
        let sun_zenith_rad = self.sun_direction.z.clamp(0.0, 1.0).acos();
        let mut condition = Condition {
            clearness: CLEARNESS_RANGE[0],
            brightness: 0.0,
            sun_zenith_rad,
            precipitable_water_cm: precipitable_water_cm(self.dew_point_c),
        };
        if self.diffuse_horizontal_w_m2 > 0.0 || self.direct_normal_w_m2 > 0.0 {
            condition.clearness =
                clearness(self.direct_normal_w_m2, self.diffuse_horizontal_w_m2, sun_zenith_rad);
        }
        condition.brightness =
            brightness(self.diffuse_horizontal_w_m2, sun_zenith_rad, f64::from(self.day_of_year));
        condition.limit();
        Ok(condition)
    }

    fn check(&self) -> Result<()> {
        let in_range = |name: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::value(format!("Perez sky: {name} is {value}, expected {low} to {high}")))
        };
        in_range(
            "direct normal irradiance [W/m²]",
            self.direct_normal_w_m2,
            0.0,
            1.05 * SOLAR_CONSTANT_W_M2,
        )?;
        in_range(
            "diffuse horizontal irradiance [W/m²]",
            self.diffuse_horizontal_w_m2,
            0.0,
            1.05 * SOLAR_CONSTANT_W_M2,
        )?;
        in_range("ground reflectance", self.ground_reflectance, 0.0, 1.0)?;
        in_range("dew point [°C]", self.dew_point_c, -100.0, 60.0)?;
        in_range("day of the year", f64::from(self.day_of_year), 1.0, 366.0)?;
        in_range("length of the sun's direction", self.sun_direction.length(), 1.0 - 1e-6, 1.0 + 1e-6)
    }
}

/// The three numbers that the model sorts skies by, and the water in the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Condition {
    /// ε
    pub clearness: f64,
    /// Δ
    pub brightness: f64,
    pub sun_zenith_rad: f64,
    pub precipitable_water_cm: f64,
}

impl Condition {
    /// Keep clearness and brightness where the model was fitted.
    pub fn limit(&mut self) {
        let [low, high] = CLEARNESS_RANGE;
        if self.clearness < low {
            self.clearness = low;
        }
        if self.clearness > high {
            self.clearness = high - 0.001;
        }
        // `max` and `min` would turn a NaN into a number; a caller may want to see it.
        self.brightness = self.brightness.clamp(BRIGHTNESS_RANGE[0], BRIGHTNESS_RANGE[1]);
    }

    fn bin(&self) -> usize {
        CLEARNESS_BOUNDS.iter().rposition(|&bound| self.clearness >= bound).unwrap_or(0)
    }

    /// Luminous efficacy of the diffuse horizontal irradiance [lm/W] (1990, equation 7).
    pub fn diffuse_efficacy(&self) -> f64 {
        let [a, b, c, d] = DIFFUSE_EFFICACY[self.bin()];
        a + b * self.precipitable_water_cm + c * self.sun_zenith_rad.cos() + d * self.brightness.ln()
    }

    /// Luminous efficacy of the direct normal irradiance [lm/W] (1990, equation 8).
    pub fn direct_efficacy(&self) -> f64 {
        let [a, b, c, d] = DIRECT_EFFICACY[self.bin()];
        let horizon = (5.73 * self.sun_zenith_rad - 5.0).exp();
        (a + b * self.precipitable_water_cm + c * horizon + d * self.brightness).max(0.0)
    }

    /// Parameters a to e of the luminance distribution (1993, equations 6 to 8).
    pub fn coefficients(&self) -> [f64; 5] {
        let (zenith, delta) = (self.sun_zenith_rad, self.fitted_brightness());
        let bin = self.bin();
        let terms = LUMINANCE_TERMS[bin].map(|row| row.map(f64::from));
        let mut parameters = terms.map(|[x1, x2, x3, x4]| x1 + x2 * zenith + delta * (x3 + x4 * zenith));
        if bin == 0 {
            let [c1, c2, c3, c4] = terms[2];
            let [d1, d2, d3, d4] = terms[3];
            parameters[2] = (delta * (c1 + c2 * zenith)).powf(c3).exp() - c4;
            parameters[3] = -(delta * (d1 + d2 * zenith)).exp() + d3 + delta * d4;
        }
        parameters
    }

    /// In the partly clear bins the fit turns wild where the sky is dark; `gendaylit` and Sunpeak keep Δ from 0.2 up there.
    fn fitted_brightness(&self) -> f64 {
        let partly_clear = self.clearness > 1.065 && self.clearness < 2.8;
        if partly_clear { self.brightness.max(0.2) } else { self.brightness }
    }
}

/// Sky clearness ε (1990, equation 1).
pub(crate) fn clearness(direct_normal: f64, diffuse_horizontal: f64, sun_zenith_rad: f64) -> f64 {
    let k = zenith_term(sun_zenith_rad);
    ((diffuse_horizontal + direct_normal) / diffuse_horizontal + k) / (1.0 + k)
}

/// Direct normal irradiance that belongs to a clearness: the inverse of [`clearness`].
pub(crate) fn direct_normal_of(clearness: f64, diffuse_horizontal: f64, sun_zenith_rad: f64) -> f64 {
    diffuse_horizontal * (clearness - 1.0) * (1.0 + zenith_term(sun_zenith_rad))
}

/// κ Z³ of Perez et al. 1990, equation 1.
fn zenith_term(sun_zenith_rad: f64) -> f64 {
    1.041 * sun_zenith_rad.powi(3)
}

/// Sky brightness Δ (1990, equation 2).
pub(crate) fn brightness(diffuse_horizontal: f64, sun_zenith_rad: f64, day_of_year: f64) -> f64 {
    diffuse_horizontal * air_mass(sun_zenith_rad) / (SOLAR_CONSTANT_W_M2 * eccentricity(day_of_year))
}

/// Diffuse horizontal irradiance that belongs to a brightness: the inverse of [`brightness`].
pub(crate) fn diffuse_horizontal_of(brightness: f64, sun_zenith_rad: f64, day_of_year: f64) -> f64 {
    brightness * SOLAR_CONSTANT_W_M2 * eccentricity(day_of_year) / air_mass(sun_zenith_rad)
}

/// Relative optical air mass (Kasten 1966), from the zenith to the horizon.
fn air_mass(sun_zenith_rad: f64) -> f64 {
    let zenith = sun_zenith_rad.min(FRAC_PI_2);
    1.0 / (zenith.cos() + 0.15 * (93.885 - zenith.to_degrees()).powf(-1.253))
}

/// Square of mean over actual distance of the sun (Spencer 1971).
pub(crate) fn eccentricity(day_of_year: f64) -> f64 {
    let day_angle = TAU * (day_of_year - 1.0) / 365.0;
    let (sin, cos) = day_angle.sin_cos();
    let (sin2, cos2) = (2.0 * day_angle).sin_cos();
    1.00011 + 0.034221 * cos + 0.00128 * sin + 0.000719 * cos2 + 0.000077 * sin2
}

/// Precipitable water [cm] over the surface dew point [°C] (Wright et al. 1989, in Perez et al. 1990).
pub(crate) fn precipitable_water_cm(dew_point_c: f64) -> f64 {
    (0.07 * dew_point_c - 0.075).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sun_direction;

    fn summer_day() -> PerezWeather {
        PerezWeather {
            sun_direction: sun_direction(60.0, 180.0),
            direct_normal_w_m2: 840.0,
            diffuse_horizontal_w_m2: 135.0,
            day_of_year: 172,
            ..PerezWeather::default()
        }
    }

    /// The manual page of gendaylit: a clear sky at 60 degrees is epsilon 6.3, delta 0.12, or 840 and 135 W/m².
    #[test]
    fn clear_sky_of_the_manual_page() {
        let condition = summer_day().condition().unwrap();
        assert!((condition.clearness - 6.3).abs() < 0.3, "{condition:?}");
        assert!((condition.brightness - 0.12).abs() < 0.01, "{condition:?}");
    }

    #[test]
    fn clearness_and_brightness_can_be_inverted() {
        let (epsilon, delta, zenith, day) = (3.2, 0.24, 0.7, 100.0);
        let diffuse = diffuse_horizontal_of(delta, zenith, day);
        assert!((brightness(diffuse, zenith, day) - delta).abs() < 1e-12);
        let direct = direct_normal_of(epsilon, diffuse, zenith);
        assert!((clearness(direct, diffuse, zenith) - epsilon).abs() < 1e-12);
    }

    #[test]
    fn values_out_of_their_domain_are_named() {
        let weather = PerezWeather { direct_normal_w_m2: -3.0, ..summer_day() };
        let message = weather.illuminance().unwrap_err().to_string();
        assert!(message.contains("direct normal irradiance") && message.contains("-3"), "{message}");
        let weather = PerezWeather { diffuse_horizontal_w_m2: f64::NAN, ..summer_day() };
        assert!(weather.illuminance().is_err());
    }
}
