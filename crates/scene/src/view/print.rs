//! Views as options.

use super::View;
use std::fmt;

impl fmt::Display for View {
    /// All options in full precision, as they stand after `VIEW=` in a picture's header.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [vp, vd, vu] = [self.position, self.direction, self.up];
        write!(f, "{} -vp {} {} {}", self.kind.option(), vp.x, vp.y, vp.z)?;
        write!(f, " -vd {} {} {} -vu {} {} {}", vd.x, vd.y, vd.z, vu.x, vu.y, vu.z)?;
        write!(f, " -vh {} -vv {}", self.horizontal_deg, self.vertical_deg)?;
        write!(f, " -vo {} -va {} -vs {} -vl {}", self.fore, self.aft, self.shift, self.lift)
    }
}
