//! Pictures: linear radiance with everything that a glare program needs to know about it.
//!
//! The codec is our own: those that exist drop header lines (`VIEW=`, several `EXPOSURE=`), know one orientation of eight
//! and not XYZE, and decode to other values than Radiance does (by half a step).

mod errors;
mod header;
mod orientation;
mod read;
mod rgbe;
mod scanline;
mod spectral;
mod write;

pub use errors::BlockErrors;
pub use spectral::SpectralPicture;

use crate::View;
use sunpeak_core::{Rgb, Vec3, luminance_cd_m2};

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
    /// Header lines (without the first `#?RADIANCE`, `FORMAT=`, `VIEW=`, `EXPOSURE=`, `COLORCORR=`, `SUNPEAK_SOURCE=` and `SUNPEAK_ERROR=`), as
    /// read.
    pub header: Vec<String>,
    /// Suns seen through peaks, through glass, in mirrors or directly, exactly.
    pub exact_sources: Vec<ExactSource>,
    /// What the header said in its `EXPOSURE=` lines, in order; undone in `pixels`, and not written again.
    pub exposures: Vec<f64>,
    /// Statistical error, if it is known.
    pub block_errors: Option<BlockErrors>,
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

impl Picture {
    /// A black picture.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[0.0; 3]; width * height],
            view: None,
            header: Vec::new(),
            exact_sources: Vec::new(),
            exposures: Vec::new(),
            block_errors: None,
        }
    }

    /// Luminance of each pixel [cd/m²], top row first.
    pub fn luminance(&self) -> Vec<f64> {
        self.pixels.iter().map(|&[r, g, b]| luminance_cd_m2(Rgb::new(r.into(), g.into(), b.into()))).collect()
    }
}

#[cfg(test)]
mod tests;
