//! A venetian blind of flat slats.

use super::product::Product;
use glam::DVec2;
use std::f64::consts::PI;

/// Flat slats without thickness along x, one above the other in y. Light that travels at the profile angle `O` (tan O = y over z)
/// is blocked over |w cos(b) tan(O) - w sin(b)| of each spacing, `w` the slats' width and `b` their tilt. What meets them is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blind {
    /// Width of the slats over their spacing.
    pub width: f64,
    /// Tilt of the slats from the normal [deg], up at the far side if positive.
    pub tilt_deg: f64,
    /// Share of the light on the slats that comes out at the other side, diffuse [-].
    pub scattered: f64,
}

impl Product for Blind {
    fn name(&self) -> String {
        format!("Sunpeak blind, slats {} wide at {} degrees", self.width, self.tilt_deg)
    }

    fn through(&self, p_in: DVec2) -> f64 {
        let height = (1.0 - p_in.length_squared()).max(0.0).sqrt();
        let (sin, cos) = self.tilt_deg.to_radians().sin_cos();
        let blocked = self.width * (cos * p_in.y / height.max(f64::MIN_POSITIVE) - sin).abs();
        (1.0 - blocked).max(0.0)
    }

    fn smooth(&self, p_in: DVec2, _p_out: DVec2) -> f64 {
        self.scattered * (1.0 - self.through(p_in)) / PI
    }

    fn reflectance(&self) -> [f64; 2] {
        [0.3; 2]
    }

    fn is_isotropic(&self) -> bool {
        false
    }
}
