//! `ashik2`: the model of Ashikhmin and Shirley 2000, "An Anisotropic Phong BRDF Model", Journal of Graphics Tools 5(2).
//!
//! Specular (their equation 4) with Schlick's Fresnel factor at the half vector, and the diffuse lobe that leaves to it what it
//! takes (equation 5). The material's diffuse colour is the reflectance that is left beside the specular one (manual: "total
//! reflectance is the sum of diffuse and specular colors"), so their factor 1 - R_s is in it already.
//!
//! Radiance takes Fresnel's factor at the angle of the ray instead of the half vector, and a diffuse lobe that depends on one
//! of the two directions only; both are not reciprocal, and differ from this near grazing incidence.
//!
//! The surface is two-sided: it is turned to face the ray.

use super::{Arrival, Scattering, Smooth, SmoothSample, SmoothValue};
use std::f64::consts::PI;
use sunpeak_core::{Frame, Rgb, Vec3, luminance, warp};
use sunpeak_scene::Orientation;

/// Smallest cosine to the ray (Radiance keeps it from zero likewise).
const SMALLEST_COSINE: f64 = 1e-3;

/// The material.
#[derive(Clone, Debug)]
pub(crate) struct Ashikhmin {
    pub diffuse: Rgb,
    /// Specular reflectance at normal incidence.
    pub specular: Rgb,
    /// Exponents along and across the orientation.
    pub powers: [f64; 2],
    pub orientation: Orientation,
}

impl Ashikhmin {
    pub fn scatter(&self, arrival: &Arrival) -> Scattering<'static> {
        let normal = arrival.facing_normal();
        let (frame, powers) = match normal.cross(arrival.orientation(&self.orientation)).try_normalize() {
            Some(y) => (Frame { x: y.cross(normal), y, z: normal }, self.powers),
            // Along the normal there is no orientation: one exponent of the same mean square width, as in Radiance.
            None => {
                let mean = 2.0 / self.powers.iter().map(|p| 1.0 / p.max(1e-5)).sum::<f64>();
                (Frame::from_normal(normal), [mean; 2])
            }
        };
        let mut w_in = frame.to_local(-arrival.direction);
        w_in.z = w_in.z.max(SMALLEST_COSINE);
        let w_in = w_in.normalize();
        let specular = self.specular + (1.0 - self.specular) * schlick(w_in.z);
        let has_highlight = self.specular.max_element() > 0.0;
        let diffuse = self.diffuse * arrival.tint;
        let weights = [luminance(diffuse), if has_highlight { luminance(specular) } else { 0.0 }];
        let lobes = AshikhminLobes { diffuse, specular: self.specular, powers, frame, w_in, weights };
        let smooth = if lobes.albedo() > 0.0 { Smooth::Ashikhmin(lobes) } else { Smooth::None };
        Scattering { smooth, ..Scattering::BLACK }
    }
}

/// Schlick's approximation of what Fresnel's law adds at this cosine, of what is not reflected at normal incidence.
fn schlick(cosine: f64) -> f64 {
    (1.0 - cosine).max(0.0).powi(5)
}

/// The lobes at one point, z towards the ray's side, x along the orientation.
#[derive(Clone, Debug)]
pub(crate) struct AshikhminLobes {
    diffuse: Rgb,
    specular: Rgb,
    powers: [f64; 2],
    frame: Frame,
    w_in: Vec3,
    /// Luminous, of the diffuse and the specular lobe.
    weights: [f64; 2],
}

impl AshikhminLobes {
    pub fn albedo(&self) -> f64 {
        self.weights[0] + self.weights[1]
    }

    pub fn evaluate(&self, direction: Vec3) -> SmoothValue {
        let w_out = self.frame.to_local(direction);
        if w_out.z <= 0.0 {
            return SmoothValue::default();
        }
        let kept = |cosine: f64| 1.0 - (1.0 - 0.5 * cosine).powi(5);
        let diffuse = self.diffuse * (28.0 / (23.0 * PI) * kept(self.w_in.z) * kept(w_out.z));
        if self.weights[1] == 0.0 {
            return SmoothValue { diffuse, glossy: Rgb::ZERO };
        }
        let half = (self.w_in + w_out).normalize();
        let cosine = half.dot(w_out);
        let fresnel = self.specular + (1.0 - self.specular) * schlick(cosine);
        let shape = self.half_pdf(half) / (4.0 * cosine * self.w_in.z.max(w_out.z));
        SmoothValue { diffuse, glossy: fresnel * shape }
    }

    /// Density [1/sr] of half vectors: normalisation times cos to the power n_u cos²(phi) + n_v sin²(phi).
    fn half_pdf(&self, half: Vec3) -> f64 {
        let [nu, nv] = self.powers;
        let normalization = ((nu + 1.0) * (nv + 1.0)).sqrt() / (2.0 * PI);
        let sine2 = half.x * half.x + half.y * half.y;
        if sine2 <= 0.0 {
            return normalization;
        }
        let power = (nu * half.x * half.x + nv * half.y * half.y) / sine2;
        normalization * half.z.max(0.0).powf(power)
    }

    pub fn pdf(&self, direction: Vec3) -> f64 {
        let w_out = self.frame.to_local(direction);
        if w_out.z <= 0.0 {
            return 0.0;
        }
        let half = (self.w_in + w_out).normalize();
        let specular = self.half_pdf(half) / (4.0 * half.dot(w_out));
        let diffuse = w_out.z / PI;
        (self.weights[0] * diffuse + self.weights[1] * specular) / self.albedo()
    }

    pub fn sample(&self, choice: f64, u: [f64; 2]) -> Option<SmoothSample> {
        let w_out = self.sample_local(choice, u)?;
        let direction = self.frame.to_world(w_out);
        let pdf = self.pdf(direction);
        let weight = self.evaluate(direction).scaled(w_out.z / pdf);
        (pdf > 0.0).then_some(SmoothSample { direction, weight, pdf, source_factor: 1.0 })
    }

    /// `None` where the highlight reaches through the surface.
    fn sample_local(&self, choice: f64, u: [f64; 2]) -> Option<Vec3> {
        if choice * self.albedo() < self.weights[0] {
            return Some(warp::cosine_hemisphere(u));
        }
        Some(self.sample_specular(u)).filter(|w| w.z > 0.0)
    }

    /// Their equations 9 and 10: the azimuth is that of an ellipse.
    fn sample_specular(&self, [u, v]: [f64; 2]) -> Vec3 {
        let [nu, nv] = self.powers;
        let [cos, sin] = warp::circle(v);
        let [x, y] = [cos * (nv + 1.0).sqrt(), sin * (nu + 1.0).sqrt()];
        let scale = x.hypot(y);
        let [x, y] = [x / scale, y / scale];
        let cosine = (1.0 - u).powf(1.0 / (nu * x * x + nv * y * y + 1.0));
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let half = Vec3::new(sine * x, sine * y, cosine);
        half * (2.0 * half.dot(self.w_in)) - self.w_in
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{chi_square_of_sampler, hemispherical_sum};
    use sunpeak_core::gray;

    fn materials() -> [Ashikhmin; 3] {
        let of = |diffuse, specular, powers| Ashikhmin {
            diffuse: gray(diffuse),
            specular: gray(specular),
            powers,
            orientation: Orientation::Fixed(Vec3::new(1.0, 0.3, 0.2)),
        };
        [of(0.3, 0.05, [5.0, 30.0]), of(0.0, 1.0, [10.0, 10.0]), of(0.5, 0.5, [100.0, 2.0])]
    }

    fn lobes_from(material: &Ashikhmin, w: Vec3) -> AshikhminLobes {
        let arrival = Arrival::new(Vec3::ZERO, Vec3::Z, -w);
        let Smooth::Ashikhmin(lobes) = material.scatter(&arrival).smooth else { panic!("smooth") };
        lobes
    }

    fn from_above(theta: f64) -> Vec3 {
        Vec3::new(theta.sin() * 0.6, theta.sin() * 0.8, theta.cos())
    }

    #[test]
    fn samples_follow_the_density() {
        for (i, material) in materials().iter().enumerate() {
            for theta in [0.0, 0.7, 1.4] {
                let lobes = lobes_from(material, from_above(theta));
                let sample = |choice, u| lobes.sample_local(choice, u).map(|w| lobes.frame.to_world(w));
                chi_square_of_sampler(&format!("{i} at {theta}"), sample, |d| lobes.pdf(d));
            }
        }
    }

    #[test]
    fn light_is_kept_and_goes_both_ways_alike() {
        for material in materials() {
            for theta in [0.0, 0.5, 1.0, 1.3, 1.5] {
                let lobes = lobes_from(&material, from_above(theta));
                let sum = hemispherical_sum(|d| lobes.evaluate(d).total());
                assert!(sum.max_element() < 1.0 + 5e-3, "{theta}: {sum}");
                let other = Vec3::new(-0.5, 0.3, 0.6).normalize();
                let back = lobes_from(&material, other).evaluate(from_above(theta)).total();
                let forth = lobes.evaluate(other).total();
                assert!((forth - back).length() < 1e-9 * (1.0 + forth.length()), "{forth} {back}");
            }
        }
    }

    #[test]
    fn the_diffuse_lobe_is_the_published_one() {
        // Their diffuse albedo at normal incidence, integrated by hand: 28/23 (1 - 1/32) 23/28 R = 31/32 R.
        let material = Ashikhmin { specular: Rgb::ZERO, ..materials()[0].clone() };
        let lobes = lobes_from(&material, Vec3::Z);
        let sum = hemispherical_sum(|d| lobes.evaluate(d).total());
        assert!((sum.x / (0.3 * 31.0 / 32.0) - 1.0).abs() < 1e-3, "{sum}");
    }
}
