//! A thin pane of glass (Radiance's `glass`).
//!
//! Reference manual, "Glass"; van Leeuwen's and Ward's formula for a pane with all internal reflections summed:
//! with r the Fresnel reflectance of one face (for each polarisation) and d the transmissivity along the refracted path,
//! transmittance (1-r)² d / (1 - r² d²), reflectance r (1 + (1-2r) d²) / (1 - r² d²).
//! The pane is infinitely thin: transmitted rays go straight on, but for rays from the eye where a texture bends the normal. Radiance
//! turns these by 2 (1 - n) times what the texture adds to the normal, the deflection by two faces that are inclined as much; shadow rays
//! and scattered ones go straight there, so that nothing is found twice.

use super::{Arrival, Scattering, Smooth};
use sunpeak_core::{Rgb, Vec3};

/// At grazing incidence the cosine is taken to be this: a ray in the pane's plane has no Fresnel reflectance.
const GRAZING_COSINE: f64 = 1e-9;

/// A pane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glass {
    /// Logarithm of the fraction not absorbed in one crossing at normal incidence.
    log_transmissivity: Rgb,
    /// Index of refraction.
    index: f64,
}

/// Both faces at one angle.
struct Faces {
    /// Fresnel reflectances, perpendicular and parallel.
    reflectance: [f64; 2],
    /// Fraction not absorbed along the refracted path.
    crossing: Rgb,
}

impl Faces {
    /// Share that goes straight on, unpolarised.
    fn transmittance(&self) -> Rgb {
        self.unpolarised(|r, d| (1.0 - r) * (1.0 - r) * d / (1.0 - r * r * d * d))
    }

    /// Share that is mirrored, unpolarised.
    fn mirrored(&self) -> Rgb {
        self.unpolarised(|r, d| r * (1.0 + (1.0 - 2.0 * r) * d * d) / (1.0 - r * r * d * d))
    }

    fn unpolarised(&self, share: impl Fn(f64, f64) -> f64) -> Rgb {
        let [perpendicular, parallel] = self.reflectance;
        each(self.crossing, |d| 0.5 * (share(perpendicular, d) + share(parallel, d)))
    }
}

/// A function of each colour; of grey, as most glass is, once.
fn each(color: Rgb, function: impl Fn(f64) -> f64) -> Rgb {
    let Rgb { x, y, z } = color;
    if x == y && y == z { Rgb::splat(function(x)) } else { color.map(function) }
}

impl Glass {
    /// `transmissivity`: fraction not absorbed in one crossing at normal incidence; `index`: of refraction.
    pub fn new(transmissivity: Rgb, index: f64) -> Self {
        Self { log_transmissivity: transmissivity.map(f64::ln), index }
    }

    fn faces(&self, cosine: f64) -> Faces {
        let cosine = cosine.max(GRAZING_COSINE);
        let refracted = (1.0 - (1.0 - cosine * cosine) / (self.index * self.index)).sqrt();
        let perpendicular = (cosine - self.index * refracted) / (cosine + self.index * refracted);
        let parallel = (refracted - self.index * cosine) / (refracted + self.index * cosine);
        Faces {
            reflectance: [perpendicular * perpendicular, parallel * parallel],
            crossing: each(self.log_transmissivity, |log| (log / refracted).exp()),
        }
    }

    /// Share that goes straight on, unpolarised.
    pub fn transmittance(&self, cosine: f64) -> Rgb {
        self.faces(cosine).transmittance()
    }

    /// `view`: the ray comes from the camera by straight passes and mirrors alone.
    pub fn scatter(&self, arrival: &Arrival, view: bool) -> Scattering<'static> {
        let faces = self.faces(arrival.cosine());
        // Patterns multiply what comes through, and nothing else, as in Radiance.
        let through = faces.transmittance() * arrival.tint;
        let bent = if view { self.bent(arrival) } else { None };
        Scattering {
            straight: if bent.is_some() { Rgb::ZERO } else { through },
            mirrored: faces.mirrored(),
            refracted: [bent.map(|direction| (direction, through)), None],
            smooth: Smooth::None,
        }
    }

    /// Where a ray goes on behind a bent normal.
    fn bent(&self, arrival: &Arrival) -> Option<Vec3> {
        if arrival.bend == Vec3::ZERO {
            return None;
        }
        let bend = if arrival.at_front() { arrival.bend } else { -arrival.bend };
        (arrival.direction + bend * (2.0 * (1.0 - self.index))).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::gray;

    #[test]
    fn common_glass_transmits_88_percent() {
        // Reference manual: "the transmissivity of standard 88% transmittance glass is 0.96" (rounded).
        let glass = Glass::new(gray(0.96), 1.52);
        assert!((glass.transmittance(1.0).x - 0.88).abs() < 2e-3);
        // The manual's formula from transmittance to transmissivity.
        let t = 0.7f64;
        let tn = ((0.8402528435 + 0.0072522239 * t * t).sqrt() - 0.9166530661) / 0.0036261119 / t;
        let glass = Glass::new(gray(tn), 1.52);
        assert!((glass.transmittance(1.0).x - t).abs() < 1e-6);
    }

    #[test]
    fn without_absorption_all_energy_is_kept() {
        let glass = Glass::new(gray(1.0), 1.52);
        for i in 0..=20 {
            let cosine = f64::from(i) / 20.0;
            let sum = glass.faces(cosine).transmittance() + glass.faces(cosine).mirrored();
            assert!((sum - Rgb::ONE).length() < 1e-9, "{cosine} {sum}");
        }
    }

    #[test]
    fn at_brewsters_angle_parallel_light_is_not_reflected() {
        let glass = Glass::new(gray(0.9), 1.52);
        let cosine = 1.52f64.atan().cos();
        assert!(glass.faces(cosine).reflectance[1] < 1e-20);
    }

    #[test]
    fn black_glass_reflects_its_first_face_only() {
        let glass = Glass::new(Rgb::ZERO, 1.5);
        assert_eq!(glass.transmittance(0.7), Rgb::ZERO);
        assert!((glass.faces(1.0).mirrored().x - 0.04).abs() < 1e-12);
    }
}
