//! BSDF tables: read them, evaluate, sample, and extract their through peak.
//!
//! Directions are unit vectors in the BSDF's frame that point away from the surface; z is the front normal, y up, x = y cross z.
//! `w_in` is the side of the ray that is being traced (minus the ray's direction), `w_out` the other one.

use std::path::Path;
use sunpeak_core::{Result, Rgb, Vec3};

/// Which part of a table goes straight through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PeakRule {
    /// None: the table as it is.
    Off,
    /// The paper's revision (2020/21).
    Paper,
    /// Today's Radiance.
    Radiance,
    /// Ours: once, in the data.
    #[default]
    Split,
}

/// Which half of the scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Both directions on one side.
    Reflection,
    /// On opposite sides.
    Transmission,
}

/// A sampled direction of the smooth lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Unit vector.
    pub w_out: Vec3,
    /// f |cos| / pdf.
    pub weight: Rgb,
    /// Density [1/sr].
    pub pdf: f64,
}

/// One product: front and back, reflection and transmission.
#[derive(Debug)]
pub struct Bsdf {}

impl Bsdf {
    /// Read an LBNL XML file (and split it).
    pub fn load(_path: &Path) -> Result<Bsdf> {
        Ok(Bsdf {})
    }

    /// The table as it is in the file [1/sr].
    pub fn evaluate(&self, _w_in: Vec3, _w_out: Vec3) -> Rgb {
        Rgb::ZERO
    }

    /// What stays after `rule` took its peak [1/sr]: the residual for `Split`, the table itself for the others.
    pub fn evaluate_smooth(&self, _w_in: Vec3, _w_out: Vec3, _rule: PeakRule) -> Rgb {
        Rgb::ZERO
    }

    /// `PeakRule::Radiance`/`Paper` only: BSDF [1/sr] towards a light source of solid angle `solid_angle` around `w_out`, with the
    /// exclusion zone around the straight direction (surround's mean instead of the table). Other rules: `evaluate_smooth`.
    pub fn evaluate_to_source(&self, _w_in: Vec3, _w_out: Vec3, _solid_angle: f64, _rule: PeakRule) -> Rgb {
        Rgb::ZERO
    }

    /// `PeakRule::Radiance`/`Paper` only: is a sample towards `w_out` one that a view ray must drop? Others: `false`.
    pub fn is_muted_for_view(&self, _w_in: Vec3, _w_out: Vec3, _rule: PeakRule) -> bool {
        false
    }

    /// Through transmittance [-] along w_out = -w_in. Zero for `Off`. O(1) for `Split`.
    pub fn through(&self, _w_in: Vec3, _rule: PeakRule) -> Rgb {
        Rgb::ZERO
    }

    /// Hemispherical reflectance or transmittance [-] of what `evaluate_smooth` gives.
    pub fn hemispherical_smooth(&self, _w_in: Vec3, _mode: Mode, _rule: PeakRule) -> Rgb {
        Rgb::ZERO
    }

    /// Sample the smooth part (reflection and transmission together) in proportion to f |cos| (luminous);
    /// `None` if it is zero.
    pub fn sample_smooth(&self, _w_in: Vec3, _u: [f64; 3], _rule: PeakRule) -> Option<Sample> {
        None
    }

    /// Density [1/sr] of `sample_smooth`.
    pub fn pdf_smooth(&self, _w_in: Vec3, _w_out: Vec3, _rule: PeakRule) -> f64 {
        0.0
    }
}
