//! A sheet with round holes.

use super::product::Product;
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Error, Result};

/// Round holes through a sheet of some thickness: what goes straight is what the upper and the lower rim have in common, the overlap
/// of two circles displaced by thickness · tan(theta). What meets the walls of the holes is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perforated {
    /// Share of the area that is holes [-].
    pub open_area: f64,
    /// Thickness of the sheet over the diameter of the holes.
    pub thickness: f64,
    /// Share of the light on the walls that comes out at the other side [-].
    pub from_walls: f64,
    /// Diffuse reflectance of the sheet itself [-], both sides.
    pub reflectance: f64,
}

impl Perforated {
    /// Can a sheet be like that?
    pub fn check(&self) -> Result<()> {
        for (name, share) in [
            ("open area", self.open_area),
            ("share from the walls", self.from_walls),
            ("reflectance", self.reflectance),
        ] {
            if !(0.0..=1.0).contains(&share) {
                return Err(Error::value(format!("perforated sheet: {name} is {share}; expected 0 to 1")));
            }
        }
        if !(self.thickness >= 0.0 && self.thickness.is_finite()) {
            return Err(Error::value(format!(
                "perforated sheet: thickness is {} diameters; expected 0 or more",
                self.thickness
            )));
        }
        Ok(())
    }
}

impl Product for Perforated {
    fn name(&self) -> String {
        format!("Sunpeak perforated sheet {:.3} % open", 100.0 * self.open_area)
    }

    fn through(&self, p_in: DVec2) -> f64 {
        let sine = p_in.length().min(1.0);
        let shift = self.thickness * sine / (1.0 - sine * sine).sqrt().max(f64::MIN_POSITIVE);
        if shift >= 1.0 {
            return 0.0;
        }
        self.open_area * 2.0 / PI * (shift.acos() - shift * (1.0 - shift * shift).sqrt())
    }

    fn smooth(&self, p_in: DVec2, _p_out: DVec2) -> f64 {
        self.from_walls * (self.open_area - self.through(p_in)) / PI
    }

    fn reflectance(&self) -> [f64; 2] {
        [self.reflectance * (1.0 - self.open_area); 2]
    }
}
