//! Surfaces of small facets: Cook and Torrance, and GGX with refraction.

use super::{Model, fresnel, together, within};
use std::f64::consts::{FRAC_1_PI, PI};
use sunpeak_core::{Result, Vec3};

/// Cook and Torrance 1982, "A Reflectance Model for Computer Graphics": Beckmann's distribution of slopes, their shadowing of
/// V-shaped grooves, Fresnel's equations, beside a diffuse part. With the factor 1/4 of Torrance and Sparrow (and of Walter et al.
/// 2007) where the paper of 1982 has 1/pi, which reflects more than comes in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CookTorrance {
    /// Diffuse reflectance [-].
    pub diffuse: f64,
    /// Weight of the facets' reflection [-].
    pub specular: f64,
    /// Refractive index of the facets [-].
    pub index: f64,
    /// Beckmann's root mean square slope [-].
    pub roughness: f64,
}

impl CookTorrance {
    /// Refuses numbers that are none, or give out more than comes in.
    pub fn check(&self) -> Result<()> {
        within("cook-torrance", "diffuse", self.diffuse, [0.0, 1.0])?;
        within("cook-torrance", "specular", self.specular, [0.0, 1.0])?;
        within("cook-torrance", "index", self.index, [1.0, 1e3])?;
        within("cook-torrance", "roughness", self.roughness, [0.005, 1.0])?;
        together("cook-torrance", "diffuse and specular", self.diffuse + self.specular)
    }
}

impl Model for CookTorrance {
    fn name(&self) -> String {
        let Self { diffuse, specular, index, roughness } = self;
        format!("Cook-Torrance, diffuse {diffuse}, specular {specular}, index {index}, roughness {roughness}")
    }

    fn value(&self, to_light: Vec3, exit: Vec3) -> f64 {
        let (light, out) = (to_light.z.abs(), exit.z.abs());
        if to_light.z * exit.z <= 0.0 {
            return 0.0;
        }
        let half = (to_light + exit).normalize_or_zero();
        let (up, across) = (half.z.abs(), half.dot(exit));
        let tan2 = (1.0 - up * up) / (up * up);
        let m2 = self.roughness.powi(2);
        let facets = (-tan2 / m2).exp() / (PI * m2 * up.powi(4));
        let lit = (2.0 * up * light.min(out) / across).min(1.0);
        let lobe = fresnel::reflectance(across, self.index) * facets * lit / (4.0 * light * out);
        FRAC_1_PI * self.diffuse + self.specular * lobe
    }

    fn width(&self) -> Option<f64> {
        Some(self.roughness)
    }
}

/// A rough face of a clear medium, with the GGX distribution and Smith's shadowing (Walter, Marschner, Li and Torrance 2007,
/// "Microfacet Models for Refraction through Rough Surfaces", equations 20, 21, 23, 33 and 34). One face: light on the front is in
/// air, light on the back in the medium, and angles of exit are those inside. Light that meets a second facet is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    /// Refractive index of the medium [-].
    pub index: f64,
    /// Roughness alpha_g [-].
    pub roughness: f64,
    /// Light goes through; else what enters is absorbed.
    pub transmits: bool,
}

impl Ggx {
    /// Refuses numbers that are none.
    pub fn check(&self) -> Result<()> {
        within("ggx", "index", self.index, [1.0, 1e3])?;
        within("ggx", "roughness", self.roughness, [0.005, 1.0])
    }

    fn facets(&self, up: f64) -> f64 {
        let a2 = self.roughness.powi(2);
        a2 / (PI * (up * up * (a2 - 1.0) + 1.0).powi(2))
    }

    /// Share of the facets that are seen from a direction.
    fn seen(&self, cosine: f64) -> f64 {
        let tan2 = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        2.0 / (1.0 + (1.0 + self.roughness.powi(2) * tan2).sqrt())
    }

    fn indices(&self, front: bool) -> [f64; 2] {
        if front { [1.0, self.index] } else { [self.index, 1.0] }
    }
}

impl Model for Ggx {
    fn name(&self) -> String {
        let kind = if self.transmits { "rough dielectric" } else { "GGX" };
        format!("{kind}, index {}, roughness {}", self.index, self.roughness)
    }

    fn value(&self, to_light: Vec3, exit: Vec3) -> f64 {
        let front = to_light.z > 0.0;
        // The light's side up.
        let turn = if front { 1.0 } else { -1.0 };
        let (light, out) = (to_light * turn, exit * turn);
        let [from, to] = self.indices(front);
        let seen = self.seen(light.z) * self.seen(out.z);
        let reflection = out.z > 0.0;
        if reflection {
            let half = (light + out).normalize_or_zero();
            let across = half.dot(light);
            let reflected = fresnel::reflectance(across, to / from);
            return reflected * self.facets(half.z) * seen / (4.0 * light.z * out.z);
        }
        if from == to || !self.transmits {
            return 0.0;
        }
        let half = -(light * from + out * to).normalize_or_zero();
        let half = if half.z < 0.0 { -half } else { half };
        let (near, far) = (half.dot(light), half.dot(out));
        if near <= 0.0 || far >= 0.0 {
            return 0.0; // the facet is seen from behind
        }
        let transmitted = 1.0 - fresnel::reflectance(near, to / from);
        let turned = to * to / (from * near + to * far).powi(2);
        near * -far / (light.z * -out.z) * transmitted * seen * self.facets(half.z) * turned
    }

    fn width(&self) -> Option<f64> {
        // Refracted lobes are narrower than mirrored ones.
        Some(if self.transmits { 0.3 * self.roughness } else { self.roughness })
    }

    fn transmits(&self) -> bool {
        self.transmits && self.index != 1.0
    }

    fn axis(&self, to_light: Vec3, reflection: bool) -> Vec3 {
        if reflection {
            return Vec3::new(-to_light.x, -to_light.y, to_light.z);
        }
        let [from, to] = self.indices(to_light.z > 0.0);
        let across = -to_light.truncate() * (from / to);
        let height = (1.0 - across.length_squared()).max(0.0).sqrt();
        across.extend(-to_light.z.signum() * height)
    }
}
