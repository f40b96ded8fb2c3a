//! A whole sky: sun, sky and ground, made from numbers, and written as a Radiance description.

use crate::SkyDistribution;
use crate::cie::CieWeather;
use crate::distribution::sky_share;
use crate::perez::PerezWeather;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;
use sunpeak_core::{LUMINOUS_EFFICACY, Result, Rgb, SUN_ANGLE_DEG, Vec3, cone_solid_angle, gray, luminance};

/// The zenith luminance of a clear sky is taken for a sun no higher than this, as in `gensky`: 87 degrees.
const HIGHEST_SUN_RAD: f64 = 87.0 * PI / 180.0;

/// The sun's disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector towards its centre.
    pub direction: Vec3,
    /// Radiance [W sr⁻¹ m⁻²].
    pub radiance: Rgb,
    /// Full angle of the disc [deg].
    pub angle_deg: f64,
}

impl Sun {
    /// A gray sun of [`SUN_ANGLE_DEG`] that gives `irradiance_w_m2` on a surface that faces it.
    pub fn from_normal_irradiance(direction: Vec3, irradiance_w_m2: f64) -> Self {
        let radiance = gray(irradiance_w_m2 / cone_solid_angle(SUN_ANGLE_DEG));
        Self { direction, radiance, angle_deg: SUN_ANGLE_DEG }
    }

    /// Solid angle of the disc [sr].
    pub fn solid_angle_sr(&self) -> f64 {
        cone_solid_angle(self.angle_deg)
    }

    /// Irradiance on a surface that faces the sun [W/m²].
    pub fn normal_irradiance(&self) -> Rgb {
        self.radiance * self.solid_angle_sr()
    }
}

/// Sun, sky and ground. All radiances are luminances divided by 179 lm/W, as everywhere in a Radiance scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// The sun, if it shines.
    pub sun: Option<Sun>,
    /// Sky above, ground below the horizon.
    pub distribution: SkyDistribution,
}

impl Sky {
    /// Perez all-weather sky from irradiances of the whole spectrum (as `gendaylit -W … -O 0`).
    ///
    /// Irradiances become illuminances by the luminous efficacy model of Perez et al. 1990, and these radiances by
    /// 179 lm/W. It differs from `gendaylit` in this:
    /// - The sky gives exactly the diffuse illuminance (integral of [`SkyDistribution::brightness`], with the ground
    ///   that it blends in at the horizon); `gendaylit` sums 145 patches, and its sky
    ///   comes out 0.1 to 3 % darker than what it was given (81 skies with a black ground).
    /// - The ground's radiance is reflectance / π times the global illuminance; `gendaylit` estimates it from the
    ///   zenith luminance.
    /// - The sun may stand above 87 degrees. A parameter b above 0, for which `gendaylit` gives a black sky, counts as 0.
    ///
    /// A sun below the horizon is left out, whatever direct irradiance is given with it (EPW rows around sunrise).
    pub fn perez(weather: &PerezWeather) -> Result<Self> {
        let illuminance = weather.illuminance()?;
        let sun_direction = weather.sun_direction.normalize();
        let direct_normal = illuminance.direct_normal_lux / LUMINOUS_EFFICACY;
        let diffuse = illuminance.diffuse_horizontal_lux / LUMINOUS_EFFICACY;
        let global = diffuse + direct_normal * sun_direction.z.max(0.0);
        let ground = weather.ground_reflectance / PI * global;

        let mut coefficients = weather.condition()?.coefficients();
        coefficients[1] = coefficients[1].min(0.0);
        let unit = |normalization, ground| SkyDistribution::Perez {
            normalization,
            ground,
            coefficients,
            sun: sun_direction,
        };
        let from_sky = horizontal_irradiance(&unit(1.0, 0.0), sun_direction);
        let normalization = ((diffuse - ground * ground_share()) / from_sky).max(0.0);
        let sun = (direct_normal > 0.0).then(|| Sun::from_normal_irradiance(sun_direction, direct_normal));
        Ok(Self { sun, distribution: unit(normalization, ground) })
    }

    /// CIE sky (as `gensky`): zenith luminance and sun from the sun's altitude unless the weather states irradiances.
    ///
    /// It differs from `gensky` in this: the sun is [`SUN_ANGLE_DEG`] wide (with the same irradiance), and a stated
    /// diffuse irradiance is met exactly, where `gensky -B` uses a polynomial; likewise the light on the ground.
    pub fn cie(weather: &CieWeather) -> Result<Self> {
        weather.check()?;
        let kind = weather.kind;
        let sun_direction = weather.sun_direction.normalize();
        // As in gensky the formula for the zenith is not used with a sun near it, where it goes to infinity.
        let altitude = sun_direction.z.clamp(-1.0, 1.0).asin();
        let normalization = kind.normalization(altitude);
        let unit =
            |zenith, ground| SkyDistribution::Cie { kind, zenith, ground, normalization, sun: sun_direction };
        let direct_normal = weather.direct_normal_irradiance();
        let direct_horizontal = direct_normal * sun_direction.z.max(0.0);
        let (from_sky, from_ground) = (horizontal_irradiance(&unit(1.0, 0.0), sun_direction), ground_share());
        let reflectance = weather.ground_reflectance / PI;
        let (zenith, ground) = match weather.diffuse_horizontal_w_m2 {
            Some(diffuse) => {
                let ground = reflectance * (diffuse + direct_horizontal);
                (((diffuse - ground * from_ground) / from_sky).max(0.0), ground)
            }
            None => {
                let limited = altitude.min(HIGHEST_SUN_RAD);
                let zenith = kind.zenith_radiance(limited, weather.turbidity);
                // The ground lights the sky's lowest band, which lights the ground: solve for both.
                let diffuse = zenith * from_sky;
                (zenith, reflectance * (diffuse + direct_horizontal) / (1.0 - reflectance * from_ground))
            }
        };
        let shines = weather.with_sun && direct_normal > 0.0;
        let sun = shines.then(|| Sun::from_normal_irradiance(sun_direction, direct_normal));
        Ok(Self { sun, distribution: unit(zenith, ground) })
    }

    /// Direct normal illuminance [lx].
    pub fn direct_normal_lux(&self) -> f64 {
        self.sun.map_or(0.0, |sun| LUMINOUS_EFFICACY * luminance(sun.normal_irradiance()))
    }

    /// Diffuse horizontal illuminance [lx]: the distribution's integral over the upper hemisphere.
    pub fn diffuse_horizontal_lux(&self) -> f64 {
        let (SkyDistribution::Cie { sun, .. } | SkyDistribution::Perez { sun, .. }) = self.distribution;
        LUMINOUS_EFFICACY * horizontal_irradiance(&self.distribution, sun)
    }

    /// A complete Radiance description: the sun (`light` and `source`), `skyfunc`, and two sources of 180 degrees for sky
    /// and ground.
    pub fn to_radiance_text(&self) -> String {
        let mut text = String::new();
        if let Some(Sun { direction: d, radiance: r, angle_deg }) = self.sun {
            let _ = write!(
                text,
                "void light solar\n0\n0\n3 {} {} {}\n\nsolar source sun\n0\n0\n4 {} {} {} {angle_deg}\n\n",
                r.x, r.y, r.z, d.x, d.y, d.z
            );
        }
        text.push_str(&self.distribution.to_radiance_text());
        for (name, z) in [("sky", 1), ("ground", -1)] {
            let _ = write!(
                text,
                "\nskyfunc glow {name}_glow\n0\n0\n4 1 1 1 0\n\n{name}_glow source {name}\n0\n0\n4 0 0 {z} 180\n"
            );
        }
        text
    }
}

impl SkyDistribution {
    /// The `brightfunc` of the name `skyfunc`, with all digits.
    pub fn to_radiance_text(&self) -> String {
        match *self {
            Self::Cie { kind, zenith, ground, .. } if kind.is_overcast() => {
                format!(
                    "void brightfunc skyfunc\n2 skybr skybright.cal\n0\n3 {} {zenith} {ground}\n",
                    kind.number()
                )
            }
            Self::Cie { kind, zenith, ground, normalization, sun } => format!(
                "void brightfunc skyfunc\n2 skybr skybright.cal\n0\n7 {} {zenith} {ground} {normalization} {} {} {}\n",
                kind.number(),
                sun.x,
                sun.y,
                sun.z
            ),
            Self::Perez { normalization, ground, coefficients: [a, b, c, d, e], sun } => format!(
                "void brightfunc skyfunc\n2 skybright perezlum.cal\n0\n\
                 10 {normalization} {ground} {a} {b} {c} {d} {e} {} {} {}\n",
                sun.x, sun.y, sun.z
            ),
        }
    }
}

/// Steps of the sky integral over the zenith angle, and over half the azimuths: the result is exact to about 1e-4.
const INTEGRAL_STEPS: usize = 128;

/// Horizontal irradiance [W/m²] from the upper hemisphere, ground that is blended in at the horizon included.
fn horizontal_irradiance(distribution: &SkyDistribution, sun: Vec3) -> f64 {
    // All skies are symmetric about the sun's meridian: half of the azimuths will do.
    let meridian = Vec3::new(sun.x, sun.y, 0.0).try_normalize().unwrap_or(Vec3::X);
    let across = Vec3::Z.cross(meridian);
    let step = 1.0 / INTEGRAL_STEPS as f64;
    let middle = |i: usize| (i as f64 + 0.5) * step;
    let mut sum = 0.0;
    for i in 0..INTEGRAL_STEPS {
        let (sin_zeta, cos_zeta) = (middle(i) * FRAC_PI_2).sin_cos();
        for j in 0..INTEGRAL_STEPS {
            let (sin_phi, cos_phi) = (middle(j) * PI).sin_cos();
            let direction = (meridian * cos_phi + across * sin_phi) * sin_zeta + Vec3::Z * cos_zeta;
            sum += distribution.brightness(direction) * cos_zeta * sin_zeta;
        }
    }
    2.0 * sum * (step * FRAC_PI_2) * (step * PI)
}

/// Horizontal irradiance [W/m²] from the upper hemisphere by ground of radiance 1 that is blended in at the horizon.
fn ground_share() -> f64 {
    let step = FRAC_PI_2 / INTEGRAL_STEPS as f64;
    let band = |i: usize| {
        let (sin_zeta, cos_zeta) = ((i as f64 + 0.5) * step).sin_cos();
        (1.0 - sky_share(cos_zeta)) * cos_zeta * sin_zeta
    };
    2.0 * PI * step * (0..INTEGRAL_STEPS).map(band).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CieSky, sun_direction};

    fn clear_day() -> PerezWeather {
        PerezWeather {
            sun_direction: sun_direction(40.0, 200.0),
            direct_normal_w_m2: 750.0,
            diffuse_horizontal_w_m2: 110.0,
            day_of_year: 100,
            ..PerezWeather::default()
        }
    }

    /// An integral that shares nothing with the one above: equal-area points on the hemisphere.
    fn spiral_integral(distribution: &SkyDistribution) -> f64 {
        let n = 2_000_000;
        let golden = PI * (3.0 - 5.0_f64.sqrt());
        let sum: f64 = (0..n)
            .map(|i| {
                let z = (i as f64 + 0.5) / n as f64;
                let (r, phi) = ((1.0 - z * z).sqrt(), golden * i as f64);
                z * distribution.brightness(Vec3::new(r * phi.cos(), r * phi.sin(), z))
            })
            .sum();
        sum * 2.0 * PI / n as f64
    }

    #[test]
    fn perez_sky_gives_the_illuminances_that_went_in() {
        for (altitude, direct, diffuse) in
            [(40.0, 750.0, 110.0), (5.0, 200.0, 40.0), (89.0, 50.0, 400.0), (20.0, 0.0, 90.0)]
        {
            let weather = PerezWeather {
                sun_direction: sun_direction(altitude, 200.0),
                direct_normal_w_m2: direct,
                diffuse_horizontal_w_m2: diffuse,
                ..clear_day()
            };
            let expected = weather.illuminance().unwrap();
            let sky = Sky::perez(&weather).unwrap();
            let diffuse_lux = LUMINOUS_EFFICACY * spiral_integral(&sky.distribution);
            let error = diffuse_lux / expected.diffuse_horizontal_lux - 1.0;
            assert!(error.abs() < 3e-4, "{altitude}: {error}");
            let (found, wanted) = (sky.direct_normal_lux(), expected.direct_normal_lux);
            assert!((found - wanted).abs() <= 1e-9 * wanted);
        }
    }

    #[test]
    fn ground_sends_back_its_share_of_the_global_illuminance() {
        let sky = Sky::perez(&clear_day()).unwrap();
        let global = sky.diffuse_horizontal_lux() + sky.direct_normal_lux() * 40.0_f64.to_radians().sin();
        let nadir = LUMINOUS_EFFICACY * sky.distribution.brightness(-Vec3::Z);
        assert!((nadir * PI / global - 0.2).abs() < 1e-4);
    }

    #[test]
    fn cie_sky_meets_a_stated_irradiance() {
        for kind in [CieSky::Clear, CieSky::Intermediate, CieSky::Overcast, CieSky::Uniform] {
            let weather = CieWeather {
                kind,
                sun_direction: sun_direction(30.0, 90.0),
                diffuse_horizontal_w_m2: Some(80.0),
                ..CieWeather::default()
            };
            let sky = Sky::cie(&weather).unwrap();
            let error = spiral_integral(&sky.distribution) / 80.0 - 1.0;
            assert!(error.abs() < 3e-4, "{kind:?}: {error}");
            assert_eq!(sky.sun.is_some(), !kind.is_overcast());
        }
    }

    #[test]
    fn night_is_dark_and_without_sun() {
        let weather = PerezWeather {
            sun_direction: sun_direction(-5.0, 0.0),
            diffuse_horizontal_w_m2: 0.0,
            ..clear_day()
        };
        let sky = Sky::perez(&weather).unwrap();
        assert_eq!(sky.sun, None);
        assert_eq!(sky.distribution.brightness(Vec3::Z), 0.0);
    }

    #[test]
    fn description_has_all_parts_and_all_digits() {
        let sky = Sky::perez(&clear_day()).unwrap();
        let text = sky.to_radiance_text();
        let sun = sky.sun.unwrap();
        for part in [
            "void light solar",
            "solar source sun",
            "2 skybright perezlum.cal",
            "4 0 0 1 180",
            "4 0 0 -1 180",
            &format!("4 {} {} {} 0.533", sun.direction.x, sun.direction.y, sun.direction.z),
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
    }
}
