//! Panes and mirrors: deltas alone.

use super::{Model, fresnel, within};
use sunpeak_core::{Result, Vec3};

/// A plane pane, all orders of reflection between its faces summed (Born and Wolf, 1.5.2 and 14.3, without interference).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Refractive index [-].
    pub index: f64,
    /// Transmittance of the material at normal incidence, without the faces [-].
    pub internal: f64,
}

impl Glass {
    /// Refuses numbers that are none.
    pub fn check(&self) -> Result<()> {
        within("glass", "index", self.index, [1.0, 10.0])?;
        within("glass", "internal", self.internal, [0.0, 1.0])
    }
}

impl Model for Glass {
    fn name(&self) -> String {
        format!("pane, index {}, internal transmittance {}", self.index, self.internal)
    }

    fn value(&self, _to_light: Vec3, _exit: Vec3) -> f64 {
        0.0
    }

    fn deltas(&self, to_light: Vec3) -> [f64; 2] {
        let cosine = to_light.z.abs().max(1e-9);
        let inside = (1.0 - (1.0 - cosine * cosine) / self.index.powi(2)).sqrt();
        let crossing = self.internal.powf(1.0 / inside);
        let faces = fresnel::polarised(cosine, self.index);
        let through = |r: f64| (1.0 - r).powi(2) * crossing / (1.0 - (r * crossing).powi(2));
        let back = |r: f64| r * (1.0 + crossing * through(r));
        let mean = |of: &dyn Fn(f64) -> f64| 0.5 * (of(faces[0]) + of(faces[1]));
        [mean(&through), mean(&back)]
    }

    fn transmits(&self) -> bool {
        true
    }
}

/// A mirror on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Reflectance [-].
    pub reflectance: f64,
}

impl Mirror {
    /// Refuses numbers that are none.
    pub fn check(&self) -> Result<()> {
        within("mirror", "reflectance", self.reflectance, [0.0, 1.0])
    }
}

impl Model for Mirror {
    fn name(&self) -> String {
        format!("mirror, reflectance {}", self.reflectance)
    }

    fn value(&self, _to_light: Vec3, _exit: Vec3) -> f64 {
        0.0
    }

    fn deltas(&self, _to_light: Vec3) -> [f64; 2] {
        [0.0, self.reflectance]
    }
}
