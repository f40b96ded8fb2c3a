//! Which pixels glare, and what sources they make.

use crate::cluster::clusters;
use crate::field::{Field, FieldPixel};
use crate::options::{GlareOptions, Threshold};
use crate::position_index::position_index;
use crate::report::Source;
use sunpeak_core::{Error, Result, Vec3};

/// The luminance above which a pixel glares [cd/m²], and the rule in words.
pub(crate) fn threshold(field: &Field, options: &GlareOptions) -> Result<(f64, String)> {
    match options.threshold {
        Threshold::Luminance(luminance) => Ok((luminance, format!("pixels above {luminance} cd/m²"))),
        Threshold::TimesMean(factor) => {
            let mean = field.mean_luminance(|_| true).unwrap_or(0.0);
            Ok((
                factor * mean,
                format!("pixels above {factor} times the mean luminance of the field of view"),
            ))
        }
        Threshold::TimesTask(factor, zone) => {
            let cosine = (zone.opening_angle_rad / 2.0).cos();
            let centre = zone.direction.normalize();
            let mean =
                field.mean_luminance(|pixel| pixel.direction.dot(centre) >= cosine).ok_or_else(|| {
                    Error::value(
                        "glare: the task zone lies outside the picture; expected it in the field of view",
                    )
                })?;
            Ok((factor * mean, format!("pixels above {factor} times the mean luminance of the task zone")))
        }
    }
}

/// The sources among the field's pixels: peaks first, then what is left above the threshold.
pub(crate) fn sources(field: &Field, threshold: f64, options: &GlareOptions) -> Vec<Source> {
    let peak = options.peak_cd_m2.unwrap_or(f64::INFINITY);
    let (mut peaks, mut others) = (Vec::new(), Vec::new());
    for pixel in field.pixels.iter().filter(|pixel| pixel.luminance_cd_m2 > threshold) {
        if pixel.luminance_cd_m2 > peak { peaks.push(*pixel) } else { others.push(*pixel) }
    }
    let head = Head { sight: field.sight, up: field.view.up, options };
    [peaks, others]
        .iter()
        .flat_map(|pixels| clusters(pixels, field.width, options.search_angle_rad / 2.0))
        .map(|pixels| head.source(&pixels))
        .collect()
}

/// How the eye looks.
pub(crate) struct Head<'a> {
    pub sight: Vec3,
    pub up: Vec3,
    pub options: &'a GlareOptions,
}

impl Head<'_> {
    pub fn position_index(&self, direction: Vec3) -> f64 {
        position_index(direction, self.sight, self.up, self.options.below_sight)
    }

    fn source(&self, pixels: &[FieldPixel]) -> Source {
        let solid_angle_sr: f64 = pixels.iter().map(|p| p.solid_angle_sr).sum();
        let flux: f64 = pixels.iter().map(|p| p.luminance_cd_m2 * p.solid_angle_sr).sum();
        let direction = self.centre(pixels);
        Source {
            direction,
            solid_angle_sr,
            luminance_cd_m2: flux / solid_angle_sr,
            position_index: self.position_index(direction),
            illuminance_lux: pixels.iter().map(FieldPixel::illuminance_lux).sum(),
            exact: false,
            pixels: pixels.len(),
        }
    }

    /// Centre of gravity, weighted with luminance and solid angle, on the angular fisheye around the line of sight: a
    /// large window's centre then is the same in every kind of view, and in `-vta` the one that evalglare states.
    fn centre(&self, pixels: &[FieldPixel]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut weight = 0.0;
        for pixel in pixels {
            let across = pixel.direction - self.sight * pixel.cosine;
            let angle = pixel.direction.angle_between(self.sight);
            let w = pixel.luminance_cd_m2 * pixel.solid_angle_sr;
            sum += across.normalize_or_zero() * angle * w;
            weight += w;
        }
        let mean = sum / weight;
        let (sin, cos) = mean.length().sin_cos();
        self.sight * cos + mean.normalize_or_zero() * sin
    }
}
