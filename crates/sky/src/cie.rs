//! CIE skies: zenith luminance, normalisation and sun of `gensky`.
//!
//! Clear: CIE 1973 (Kittler). Overcast: Moon and Spencer 1942. Intermediate: Nakamura et al. 1985. Zenith luminances:
//! Krochmann and Seidl 1974 (overcast), Dogniaux 1967 over turbidity (clear), as in the IES Lighting Handbook.

use crate::CieSky;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use sunpeak_core::{Error, Result, Vec3, cone_solid_angle};

/// Luminous efficacy of sky light [lm/W] in `gensky` (illuminant D65).
const SKY_EFFICACY: f64 = 203.0;

/// Luminous efficacy of sunlight [lm/W] in `gensky` (illuminant B).
const SUN_EFFICACY: f64 = 208.0;

/// Turbidity that `gensky` takes unless told.
pub(crate) const DEFAULT_TURBIDITY: f64 = 2.45;

/// Factor on the clear sky's sun for the intermediate sky in `gensky`.
const INTERMEDIATE_SUN_SHARE: f64 = 0.15;

/// Width of the sun that `gensky` writes [deg].
pub(crate) const GENSKY_SUN_DEG: f64 = 0.5;

/// Solid angle of `gensky`'s sun, 0.5 degrees wide [sr], as rounded there for irradiance to radiance (`-R`)…
pub(crate) const GENSKY_SUN_SR: f64 = 5.98e-5;

/// … and for its light on the ground.
pub(crate) const GENSKY_SUN_ON_GROUND_SR: f64 = 6e-5;

/// The weather of a CIE sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CieWeather {
    /// Which of the four skies.
    pub kind: CieSky,
    /// Unit vector towards the sun.
    pub sun_direction: Vec3,
    /// Does the sun shine? (Clear and intermediate skies only.)
    pub with_sun: bool,
    /// Turbidity of the air [-], for clear and intermediate skies: 1 is ideally clear.
    pub turbidity: f64,
    /// Diffuse horizontal irradiance [W/m², luminous / 179]; `None`: from the sun's altitude and turbidity.
    pub diffuse_horizontal_w_m2: Option<f64>,
    /// Direct normal irradiance [W/m², luminous / 179]; `None`: from the sun's altitude.
    pub direct_normal_w_m2: Option<f64>,
    /// Reflectance of the ground around [-].
    pub ground_reflectance: f64,
}

impl Default for CieWeather {
    fn default() -> Self {
        Self {
            kind: CieSky::Clear,
            sun_direction: Vec3::Z,
            with_sun: true,
            turbidity: DEFAULT_TURBIDITY,
            diffuse_horizontal_w_m2: None,
            direct_normal_w_m2: None,
            ground_reflectance: 0.2,
        }
    }
}

impl CieWeather {
    /// Direct normal irradiance [W/m², luminous / 179]; 0 under an overcast sky and with the sun below the horizon.
    pub(crate) fn direct_normal_irradiance(&self) -> f64 {
        if self.kind.is_overcast() || self.sun_direction.z <= 0.0 {
            return 0.0;
        }
        self.direct_normal_w_m2.unwrap_or_else(|| {
            self.kind.sun_radiance(self.sun_direction.z) * cone_solid_angle(GENSKY_SUN_DEG)
        })
    }

    pub(crate) fn check(&self) -> Result<()> {
        let in_range = |name: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::value(format!("CIE sky: {name} is {value}, expected {low} to {high}")))
        };
        in_range("turbidity", self.turbidity, 1.0, 100.0)?;
        in_range("diffuse horizontal irradiance", self.diffuse_horizontal_w_m2.unwrap_or(0.0), 0.0, 2000.0)?;
        in_range("direct normal irradiance", self.direct_normal_w_m2.unwrap_or(0.0), 0.0, 2000.0)?;
        in_range("ground reflectance", self.ground_reflectance, 0.0, 1.0)?;
        in_range("length of the sun's direction", self.sun_direction.length(), 1.0 - 1e-6, 1.0 + 1e-6)
    }
}

impl CieSky {
    /// Is the sky the same all around, with no sun?
    pub(crate) fn is_overcast(self) -> bool {
        matches!(self, Self::Overcast | Self::Uniform)
    }

    /// The number that `skybright.cal` knows it by.
    pub(crate) fn number(self) -> u32 {
        match self {
            Self::Clear => 1,
            Self::Overcast => 2,
            Self::Uniform => 3,
            Self::Intermediate => 4,
        }
    }

    /// A4 of `skybright.cal`: the formula's value at the zenith, so that the zenith has the zenith's brightness.
    pub(crate) fn normalization(self, altitude_rad: f64) -> f64 {
        let zenith_distance = FRAC_PI_2 - altitude_rad;
        match self {
            Self::Clear => {
                // 0.274 = 1 - exp(-0.32), the gradation at the zenith.
                0.274 * (0.91 + 10.0 * (-3.0 * zenith_distance).exp() + 0.45 * altitude_rad.sin().powi(2))
            }
            Self::Intermediate => {
                (2.739 + 0.9891 * (0.3119 + 2.6 * altitude_rad).sin())
                    * (-zenith_distance * (0.4441 + 1.48 * altitude_rad)).exp()
            }
            Self::Overcast | Self::Uniform => 1.0,
        }
    }

    /// Mean horizontal radiance over zenith radiance, by `gensky`'s polynomials in the sun's altitude.
    pub(crate) fn horizontal_over_zenith(self, altitude_rad: f64) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Overcast => 7.0 / 9.0,
            Self::Clear => {
                const CLEAR: [f64; 5] = [2.766521, 0.547665, -0.369832, 0.009237, 0.059229];
                polynomial(&CLEAR, altitude_rad) / self.normalization(altitude_rad) / PI
            }
            Self::Intermediate => {
                const INTERMEDIATE: [f64; 5] = [3.5556, -2.7152, -1.3081, 1.0660, 0.60227];
                polynomial(&INTERMEDIATE, altitude_rad) / self.normalization(altitude_rad) / PI
            }
        }
    }

    /// Zenith radiance [W sr⁻¹ m⁻²] from the sun's altitude and turbidity.
    pub(crate) fn zenith_radiance(self, altitude_rad: f64, turbidity: f64) -> f64 {
        let overcast_kcd_m2 = 8.6 * altitude_rad.sin() + 0.123;
        let clear_kcd_m2 = (1.376 * turbidity - 1.81) * altitude_rad.tan() + 0.38;
        let zenith_kcd_m2 = match self {
            Self::Overcast | Self::Uniform => overcast_kcd_m2,
            Self::Clear => clear_kcd_m2,
            Self::Intermediate => (clear_kcd_m2 + overcast_kcd_m2) / 2.0,
        };
        zenith_kcd_m2.max(0.0) * 1000.0 / SKY_EFFICACY
    }

    /// Radiance [W sr⁻¹ m⁻²] of `gensky`'s sun, 0.5 degrees wide, above the horizon.
    pub(crate) fn sun_radiance(self, sin_altitude: f64) -> f64 {
        let clear = 1.5e9 / SUN_EFFICACY * (1.147 - 0.147 / sin_altitude.max(0.16));
        if self == Self::Intermediate { clear * INTERMEDIATE_SUN_SHARE } else { clear }
    }
}

/// A polynomial in (altitude - 45°)/45°.
fn polynomial(coefficients: &[f64; 5], altitude_rad: f64) -> f64 {
    let x = (altitude_rad - FRAC_PI_4) / FRAC_PI_4;
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}
