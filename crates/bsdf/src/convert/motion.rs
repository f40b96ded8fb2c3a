//! What is done to a product before it is tabulated anew: turned over, and turned about its normal.

use crate::overlap::{Polygon, Region};
use glam::DVec2;

/// First mirrored in x, then turned [rad] about the normal, counterclockwise seen from the front.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    pub mirror_x: bool,
    pub turn: f64,
}

impl Motion {
    /// Nothing is moved?
    pub fn is_none(self) -> bool {
        !self.mirror_x && self.turn == 0.0
    }

    /// Where a point was before.
    pub fn undo(self, p: DVec2) -> DVec2 {
        let p = DVec2::from_angle(-self.turn).rotate(p);
        if self.mirror_x { DVec2::new(-p.x, p.y) } else { p }
    }

    /// Where a region was before.
    pub fn undo_region(self, region: Region) -> Region {
        let turned = turned(region, -self.turn);
        if self.mirror_x { mirrored(&turned, true) } else { turned }
    }
}

/// Turned counterclockwise by an angle [rad].
pub fn turned(region: Region, angle: f64) -> Region {
    if angle == 0.0 { region } else { region.iter().flat_map(|p| p.turned(angle)).collect() }
}

/// Mirrored in x, or in y.
pub fn mirrored(region: &[Polygon], x: bool) -> Region {
    region.iter().map(|p| p.mirrored(x)).collect()
}
