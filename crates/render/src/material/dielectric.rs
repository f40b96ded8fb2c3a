//! Solids of glass, water and the like (Radiance's `dielectric`), and where two of them meet (`interface`): Fresnel's equations,
//! Snell's law, Beer's law.
//!
//! The normal points out of the solid. Light that enters is squeezed into a smaller solid angle, so radiance grows with the
//! square of the index and falls back when it leaves. Dispersion (Hartmann's constant) shifts the index at 500 nm, as in
//! Radiance; colours are not split.

use super::{Arrival, Scattering, Smooth};
use sunpeak_core::{Rgb, Vec3};
use sunpeak_scene::Medium;

/// Mean wavelength for Hartmann's equation [nm] (Radiance's reference manual, "Dielectric").
const MEAN_WAVELENGTH_NM: f64 = 500.0;

/// Transmission below this (for one metre) is opaque: exp(-92) (Radiance's own limit).
const LARGEST_EXTINCTION: f64 = 92.0;

/// The face of a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dielectric {
    /// Index of refraction inside at the mean wavelength, over that outside.
    index: f64,
    /// Extinction inside [1/m].
    inside: Rgb,
    /// Extinction outside [1/m]; `None` where that is for others to say.
    outside: Option<Rgb>,
}

/// Beer's law for a transmission in each metre.
fn extinction(transmission: Rgb) -> Rgb {
    transmission.map(|t| (-t.ln()).clamp(0.0, LARGEST_EXTINCTION))
}

impl Dielectric {
    /// `transmission` for each metre of the way inside.
    pub fn new(transmission: Rgb, index: f64, hartmann: f64) -> Self {
        Self { index: index + hartmann / MEAN_WAVELENGTH_NM, inside: extinction(transmission), outside: None }
    }

    /// Between two media; the normal points out of `inside`.
    pub fn interface(inside: &Medium, outside: &Medium) -> Self {
        Self {
            index: inside.index / outside.index,
            inside: extinction(inside.transmission),
            outside: Some(extinction(outside.transmission)),
        }
    }

    /// Extinction [1/m] on the side that a ray comes from, if the surface knows it.
    pub fn extinction_before(&self, arrival: &Arrival) -> Option<Rgb> {
        if arrival.at_front() { self.outside } else { Some(self.inside) }
    }

    /// Extinction [1/m] on the other side.
    pub fn extinction_behind(&self, arrival: &Arrival) -> Rgb {
        if arrival.at_front() { self.inside } else { self.outside.unwrap_or(Rgb::ZERO) }
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
            refracted: [self.refract(arrival).map(|(d, share)| (d, arrival.tint * share)), None],
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
    fn an_interface_of_equal_indices_is_nothing_and_others_have_their_ratio() {
        let medium = |index| Medium { transmission: gray(0.5), index };
        let nothing = Dielectric::interface(&medium(1.4), &medium(1.4));
        let (r, d) = nothing.fresnel(&arrival(0.7, true));
        assert!(r < 1e-12 && (d.expect("refracts") - arrival(0.7, true).direction).length() < 1e-12);
        let theta = 0.8f64;
        let (_, d) = Dielectric::interface(&medium(1.6), &medium(1.33)).fresnel(&arrival(theta, false));
        assert!((d.expect("refracts").x - theta.sin() * 1.33 / 1.6).abs() < 1e-12);
        // From the denser to the lighter medium there is total reflection past asin(1.33 / 1.6) = 56.2 degrees.
        assert!(Dielectric::interface(&medium(1.6), &medium(1.33)).fresnel(&arrival(1.0, true)).1.is_none());
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
