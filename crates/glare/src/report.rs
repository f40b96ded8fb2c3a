//! What was found.

use crate::uncertainty::Intervals;
use crate::{ClassVerdict, DgpTerms, GlareClass, Metrics};
use sunpeak_core::Vec3;

/// One glare source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
    /// Angle of its centre from the line of sight [rad].
    pub angle_to_sight_rad: f64,
    /// Its share of the contrast term of DGP [-], in proportion to its weight.
    pub dgp_part: f64,
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

/// Mean luminances [cd/m²] of zones of the field of view, exact sources included; `None` for those outside the picture.
///
/// Ergorama and panorama: cones of 60 and 120 degrees around the line of sight (Meyer, Francioli and Kerhoven 1996, "A new model for the
/// assessment of visual comfort at VDT-workstations"). Between task, ergorama and panorama 1:3:10 is the usual limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ZoneLuminances {
    /// Of the task, if its place was stated.
    pub task: Option<f64>,
    /// Of the ergorama without the task.
    pub ergorama: Option<f64>,
    /// Of the panorama without the ergorama and the task.
    pub panorama: Option<f64>,
    /// Of the rest.
    pub periphery: Option<f64>,
}

/// Glare in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GlareReport {
    /// Daylight glare probability [-] (times the low-light factor only if that was asked for).
    pub dgp: f64,
    /// 95 % confidence interval of `dgp` by the statistical error of the picture; twice `dgp` if there is none.
    pub dgp_interval: [f64; 2],
    /// 95 % intervals of DGP, Ev and each rating by the statistical error of the picture, if that is known.
    pub sampling: Option<Intervals>,
    /// The same by the stated tolerances of what goes in.
    pub input: Option<Intervals>,
    /// Probability of each class by both, and whether it is decided.
    pub verdict: ClassVerdict,
    /// DGP times the factor for dim scenes.
    pub dgp_low_light_corrected: f64,
    /// The terms of DGP, before any factor.
    pub dgp_terms: DgpTerms,
    /// Do Ev and DGP lie in the range for which DGP was derived?
    pub dgp_in_range: bool,
    /// Ratings other than DGP.
    pub metrics: Metrics,
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
    /// Luminance that half of the solid angle exceeds [cd/m²].
    pub median_luminance_cd_m2: f64,
    /// Mean luminances by zone.
    pub zones: ZoneLuminances,
    /// Brightest luminance: pixel, or exact source [cd/m²].
    pub max_luminance_cd_m2: f64,
    /// Luminance of the background: (Ev - Ev of the sources) / pi [cd/m²].
    pub background_cd_m2: f64,
    /// What to beware of.
    pub warnings: Vec<String>,
}
