//! Solids of glass, water and the like (Radiance's `dielectric`): Fresnel's equations, Snell's law, Beer's law.
//!
//! The normal points out of the solid. Light that enters is squeezed into a smaller solid angle, so radiance grows with the
//! square of the index and falls back when it leaves. Dispersion (Hartmann's constant) shifts the index at 500 nm, as in
//! Radiance; colours are not split.

use super::{Arrival, Scattering, Smooth};
use sunpeak_core::{Rgb, Vec3};

/// Mean wavelength for Hartmann's equation [nm] (Radiance's reference manual, "Dielectric").
const MEAN_WAVELENGTH_NM: f64 = 500.0;

/// Transmission below this (for one metre) is opaque: exp(-92) (Radiance's own limit).
const LARGEST_EXTINCTION: f64 = 92.0;

/// A solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dielectric {
    /// Index of refraction at the mean wavelength.
    index: f64,
    /// Extinction inside [1/m].
    extinction: Rgb,
}

impl Dielectric {
    /// `transmission` for each metre of the way inside.
    pub fn new(transmission: Rgb, index: f64, hartmann: f64) -> Self {
        let extinction = transmission.map(|t| (-t.ln()).clamp(0.0, LARGEST_EXTINCTION));
        Self { index: index + hartmann / MEAN_WAVELENGTH_NM, extinction }
    }

    /// Extinction [1/m] on the way to a point that is reached from inside.
    pub fn extinction(&self) -> Rgb {
        self.extinction
    }

    /// Fresnel reflectance, unpolarised, and the refracted direction (`None` for total reflection).
    pub fn fresnel(&self, arrival: &Arrival) -> (f64, Option<Vec3>) {
        let ratio = self.ratio(arrival);
        let cosine = arrival.cosine();
        let cosine_squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
        if cosine_squared <= 0.0 {
            return (1.0, None);
        }
        let refracted = cosine_squared.sqrt();
        let perpendicular = (ratio * cosine - refracted) / (ratio * cosine + refracted);
        let parallel = (ratio * refracted - cosine) / (ratio * refracted + cosine);
        let direction = arrival.direction * ratio + arrival.facing_normal() * (ratio * cosine - refracted);
        (0.5 * (perpendicular * perpendicular + parallel * parallel), Some(direction.normalize()))
    }

    /// Index on the ray's side over that on the other.
    fn ratio(&self, arrival: &Arrival) -> f64 {
        if arrival.at_front() { 1.0 / self.index } else { self.index }
    }

    /// Refracted direction and share of the radiance.
    pub fn refract(&self, arrival: &Arrival) -> Option<(Vec3, f64)> {
        let (reflectance, direction) = self.fresnel(arrival);
        direction.map(|d| (d, (1.0 - reflectance) * self.ratio(arrival).powi(2)))
    }

    pub fn scatter(&self, arrival: &Arrival) -> Scattering<'static> {
        let (reflectance, _) = self.fresnel(arrival);
        Scattering {
            straight: Rgb::ZERO,
            mirrored: Rgb::splat(reflectance),
            refracted: self.refract(arrival).map(|(d, share)| (d, arrival.tint * share)),
            smooth: Smooth::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::gray;

    fn arrival(theta: f64, from_inside: bool) -> Arrival {
        let z = if from_inside { 1.0 } else { -1.0 };
        let direction = Vec3::new(theta.sin(), 0.0, z * theta.cos());
        Arrival::new(Vec3::ZERO, Vec3::Z, direction)
    }

    #[test]
    fn snells_law_and_fresnel_at_normal_incidence() {
        let water = Dielectric::new(gray(1.0), 1.33, 0.0);
        let (r, d) = water.fresnel(&arrival(0.0, false));
        assert!((r - (0.33f64 / 2.33).powi(2)).abs() < 1e-12 && d == Some(Vec3::NEG_Z));
        let theta = 0.8f64;
        let (_, d) = water.fresnel(&arrival(theta, false));
        assert!((d.expect("refracts").x - theta.sin() / 1.33).abs() < 1e-12);
        assert!(water.fresnel(&arrival(0.9, true)).1.is_none());
    }

    #[test]
    fn in_and_out_again_keeps_radiance() {
        let glass = Dielectric::new(gray(1.0), 1.5, 0.0);
        let (inside, into) = glass.refract(&arrival(0.6, false)).expect("refracts");
        let at_exit = Arrival::new(Vec3::ZERO, Vec3::NEG_Z, inside);
        let (out, out_of) = glass.refract(&at_exit).expect("refracts");
        let (r, _) = glass.fresnel(&arrival(0.6, false));
        assert!((into * out_of - (1.0 - r).powi(2)).abs() < 1e-12);
        assert!((out - arrival(0.6, false).direction).length() < 1e-12);
    }
}
