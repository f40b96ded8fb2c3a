//! A fabric whose warp and weft differ.

use super::{
    fabric::{Fabric, Woven},
    product::Product,
};
use glam::DVec2;
use sunpeak_core::{Error, Result};

/// A [`Fabric`] with two cut-offs: its own in the plane of x, another in the plane of y; between them 1/cut-off² runs as an ellipse's
/// 1/r². Dyed, if one likes: what it scatters has a colour, its holes have none.
#[derive(Clone, Debug)]
pub struct Weave {
    woven: Woven,
    cutoff_y_deg: f64,
    tint: Option<[f64; 2]>,
}

impl Weave {
    /// From the fabric, the cut-off in the plane of y [deg], and CIE X and Z of the scattered light over its Y.
    pub fn new(fabric: Fabric, cutoff_y_deg: f64, tint: Option<[f64; 2]>) -> Result<Self> {
        fabric.check()?;
        if !(cutoff_y_deg > 0.0 && cutoff_y_deg <= 90.0) {
            return Err(Error::value(format!("weave: cutoff_y_deg is {cutoff_y_deg}; expected 0 to 90")));
        }
        Ok(Self { woven: Woven::new(fabric), cutoff_y_deg, tint })
    }
}

impl Product for Weave {
    fn name(&self) -> String {
        format!("{}, cut-offs apart", self.woven.name())
    }

    fn through(&self, p_in: DVec2) -> f64 {
        let fabric = self.woven.fabric();
        let axis = p_in.normalize_or(DVec2::X);
        let cutoffs = DVec2::new(fabric.cutoff_deg, self.cutoff_y_deg);
        let cutoff_deg = 1.0 / (axis / cutoffs).length();
        Fabric { cutoff_deg, ..*fabric }.through(p_in.length().min(1.0).asin())
    }

    fn smooth(&self, p_in: DVec2, p_out: DVec2) -> f64 {
        self.woven.smooth(p_in, p_out)
    }

    fn tint(&self) -> Option<[f64; 2]> {
        self.tint
    }

    fn reflectance(&self) -> [f64; 2] {
        self.woven.reflectance()
    }

    fn is_isotropic(&self) -> bool {
        self.woven.fabric().cutoff_deg == self.cutoff_y_deg
    }
}
