//! Pictures: linear radiance with everything that a glare program needs to know about it.

use crate::View;
use sunpeak_core::{Rgb, Vec3};

/// Linear radiance [W sr⁻¹ m⁻²] in three channels, top row first.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` pixels, top row first, left to right; `EXPOSURE` and `COLORCORR` already undone.
    pub pixels: Vec<[f32; 3]>,
    /// The view; `None` if the header has none (or a picture was cropped or rotated since).
    pub view: Option<View>,
    /// Header lines (without the first `#?RADIANCE`, `FORMAT=`, `VIEW=`, `EXPOSURE=` and `SUNPEAK_SOURCE=`), as read.
    pub header: Vec<String>,
    /// Suns seen through peaks, through glass, in mirrors or directly, exactly.
    pub exact_sources: Vec<ExactSource>,
}

/// A sun disc in a picture, known exactly. Its pixels hold `radiance * visible_fraction * covered share of the
/// pixel` on top of the rest; a glare program takes exactly that back out before it adds the source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactSource {
    /// Unit vector towards it, world axes.
    pub direction: Vec3,
    /// Solid angle of the whole disc [sr].
    pub solid_angle_sr: f64,
    /// Radiance of the disc after transmission [W sr⁻¹ m⁻²].
    pub radiance: Rgb,
    /// Share of the disc that is not hidden.
    pub visible_fraction: f64,
}
