//! What one cannot see through: nothing may be taken from these.

use super::product::{Lobe, Product};
use crate::kernel::{Spread, TENTH_WIDTH};
use glam::DVec2;
use std::f64::consts::PI;

/// A translucent panel: a lobe around the straight direction, and no hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// Transmittance [-].
    pub transmittance: f64,
    /// Full width of the lobe at tenth maximum, normal incidence [deg].
    pub tenth_width_deg: f64,
    /// The lobe keeps its width in angle; else on the disk of projected directions, so that in angle it grows with the incidence.
    pub same_angle: bool,
}

impl Product for Panel {
    fn name(&self) -> String {
        format!("Sunpeak panel of {} degrees", self.tenth_width_deg)
    }

    fn through(&self, _p_in: DVec2) -> f64 {
        0.0
    }

    fn smooth(&self, _p_in: DVec2, _p_out: DVec2) -> f64 {
        0.0
    }

    fn lobe(&self, _p_in: DVec2) -> Option<Lobe> {
        let sigma = self.tenth_width_deg.to_radians() / TENTH_WIDTH;
        let spread = if self.same_angle { Spread::Angle(sigma) } else { Spread::Projected(sigma) };
        Some(Lobe { flux: self.transmittance, spread })
    }

    fn reflectance(&self) -> [f64; 2] {
        [0.3; 2]
    }
}

/// Lambertian transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuser {
    /// Transmittance [-].
    pub transmittance: f64,
}

impl Product for Diffuser {
    fn name(&self) -> String {
        "Sunpeak diffuser".into()
    }

    fn through(&self, _p_in: DVec2) -> f64 {
        0.0
    }

    fn smooth(&self, _p_in: DVec2, _p_out: DVec2) -> f64 {
        self.transmittance / PI
    }

    fn reflectance(&self) -> [f64; 2] {
        [0.3; 2]
    }
}
