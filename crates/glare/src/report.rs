//! What was found.

use crate::GlareClass;
use sunpeak_core::Vec3;

/// One glare source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Unit vector to its luminance-weighted centre, world axes.
    pub direction: Vec3,
    /// Solid angle [sr]; of an exact source its visible part.
    pub solid_angle_sr: f64,
    /// Mean luminance [cd/m²].
    pub luminance_cd_m2: f64,
    /// Position index at its centre [-].
    pub position_index: f64,
    /// Illuminance that it gives at the eye [lx].
    pub illuminance_lux: f64,
    /// Was it known exactly, and not found in the pixels?
    pub exact: bool,
    /// Number of pixels (of an exact source: that it touches).
    pub pixels: usize,
}

impl Source {
    /// Its part of DGP's sum: L² omega / P² [cd² sr m⁻⁴].
    pub fn weight(&self) -> f64 {
        self.luminance_cd_m2.powi(2) * self.solid_angle_sr / self.position_index.powi(2)
    }
}

/// Glare in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GlareReport {
    /// Daylight glare probability [-] (times the low-light factor only if that was asked for).
    pub dgp: f64,
    /// 95 % confidence interval of `dgp` by the stated error of the picture; twice `dgp` if there is none.
    pub dgp_interval: [f64; 2],
    /// DGP times the factor for dim scenes.
    pub dgp_low_light_corrected: f64,
    /// What `dgp` means.
    pub class: GlareClass,
    /// Vertical illuminance at the eye [lx].
    pub ev_lux: f64,
    /// Part of it from glare sources [lx].
    pub ev_sources_lux: f64,
    /// Glare sources, the worst first.
    pub sources: Vec<Source>,
    /// Luminance above which a pixel counted as glaring [cd/m²].
    pub threshold_cd_m2: f64,
    /// How sources were found, in a sentence.
    pub rule: String,
    /// Mean luminance over the solid angle of the field of view [cd/m²], exact sources included.
    pub mean_luminance_cd_m2: f64,
    /// Brightest luminance: pixel, or exact source [cd/m²].
    pub max_luminance_cd_m2: f64,
    /// Luminance of the background: (Ev - Ev of the sources) / pi [cd/m²].
    pub background_cd_m2: f64,
    /// What to beware of.
    pub warnings: Vec<String>,
}
