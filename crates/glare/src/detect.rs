//! Which pixels glare, and what sources they make.

use crate::cluster::clusters;
use crate::field::{Field, FieldPixel};
use crate::options::{GlareOptions, SourceCentre, Threshold};
use crate::position_index::{position_index, position_index_by_given_up};
use crate::report::{Source, ZoneLuminances};
use crate::survey::parts;
use sunpeak_core::{Error, Result, Vec3};

/// The luminance above which a pixel glares [cd/m²], and the rule in words.
///
/// Means are those of the pixels without exact sources: what a source is compared with must not grow with it.
pub(crate) fn threshold(options: &GlareOptions, mean: f64, zones: &ZoneLuminances) -> Result<(f64, String)> {
    match options.threshold {
        Threshold::Luminance(luminance) => Ok((luminance, format!("pixels above {luminance} cd/m²"))),
        Threshold::TimesMean(factor) => Ok((
            factor * mean,
            format!("pixels above {factor} times the mean luminance of the field of view"),
        )),
        Threshold::TimesTask(factor, _) => {
            let mean = zones.task.ok_or_else(|| {
                Error::value(
                    "glare: the task zone lies outside the picture; expected it in the field of view",
                )
            })?;
            Ok((factor * mean, format!("pixels above {factor} times the mean luminance of the task zone")))
        }
    }
}

/// The sources among the field's pixels, and the pixels of each: those above the peak luminance first, then what is left above the threshold.
pub(crate) fn sources(
    field: &Field,
    threshold: f64,
    options: &GlareOptions,
) -> Result<Vec<(Source, Vec<FieldPixel>)>> {
    let peak = options.peak_cd_m2.unwrap_or(f64::INFINITY);
    let (peaks, others): (Vec<_>, Vec<_>) =
        glaring(field, threshold)?.into_iter().partition(|pixel| pixel.luminance_cd_m2 > peak);
    let head = Head { field, options };
    let found = [peaks, others]
        .iter()
        .flat_map(|pixels| clusters(pixels, field.width, options.search_angle_rad / 2.0))
        .map(|pixels| (head.source(&pixels), pixels))
        .collect();
    Ok(found)
}

/// Pixels above the threshold, in picture order.
fn glaring(field: &Field, threshold: f64) -> Result<Vec<FieldPixel>> {
    let found = parts(field, |range| {
        let bright = field.luminances(range).filter(|&(_, luminance)| luminance > threshold);
        Ok(bright.filter_map(|(index, luminance)| field.with_luminance(index, luminance)).collect::<Vec<_>>())
    })?;
    Ok(found.concat())
}

/// How the eye looks.
pub(crate) struct Head<'a> {
    pub field: &'a Field<'a>,
    pub options: &'a GlareOptions,
}

impl Head<'_> {
    pub fn position_index(&self, direction: Vec3) -> f64 {
        let index = if self.options.up_as_given { position_index_by_given_up } else { position_index };
        index(direction, self.field.sight, self.field.view.up, self.options.below_sight)
    }

    /// A source with what follows from its direction, and not smaller than the least solid angle.
    pub fn placed(&self, source: Source) -> Source {
        let least = self.options.least_solid_angle_sr.unwrap_or(0.0).max(source.solid_angle_sr);
        Source {
            position_index: self.position_index(source.direction),
            angle_to_sight_rad: source.direction.angle_between(self.field.sight),
            luminance_cd_m2: source.luminance_cd_m2 * source.solid_angle_sr / least,
            solid_angle_sr: least,
            ..source
        }
    }

    fn source(&self, pixels: &[FieldPixel]) -> Source {
        let solid_angle_sr: f64 = pixels.iter().map(|p| p.solid_angle_sr).sum();
        let flux: f64 = pixels.iter().map(|p| p.luminance_cd_m2 * p.solid_angle_sr).sum();
        self.placed(Source {
            direction: self.centre(pixels),
            solid_angle_sr,
            luminance_cd_m2: flux / solid_angle_sr,
            illuminance_lux: pixels.iter().map(FieldPixel::illuminance_lux).sum(),
            exact: false,
            pixels: pixels.len(),
            ..Source::default()
        })
    }

    fn centre(&self, pixels: &[FieldPixel]) -> Vec3 {
        match self.options.centre {
            SourceCentre::Angular => self.angular_centre(pixels),
            SourceCentre::Sphere => sphere_centre(pixels),
            SourceCentre::Evalglare3 => {
                self.picture_centre(pixels).unwrap_or_else(|| self.angular_centre(pixels))
            }
        }
    }

    /// Centre of gravity, weighted with luminance and solid angle, on the angular fisheye around the line of sight.
    fn angular_centre(&self, pixels: &[FieldPixel]) -> Vec3 {
        let sight = self.field.sight;
        let mut sum = Vec3::ZERO;
        let mut weight = 0.0;
        for pixel in pixels {
            let across = pixel.direction - sight * pixel.direction.dot(sight);
            let angle = pixel.direction.angle_between(sight);
            let w = pixel.luminance_cd_m2 * pixel.solid_angle_sr;
            sum += across.normalize_or_zero() * angle * w;
            weight += w;
        }
        let mean = sum / weight;
        let (sin, cos) = mean.length().sin_cos();
        sight * cos + mean.normalize_or_zero() * sin
    }

    /// Centre of gravity on the picture, weighted with luminance and solid angle, of the pixels' lower left corners; then the middle of the
    /// pixel in which it lies: evalglare 3.06 takes position indices there.
    fn picture_centre(&self, pixels: &[FieldPixel]) -> Option<Vec3> {
        /// What a mean of whole numbers may lose [pixels].
        const ROUNDING: f64 = 1e-6;
        let (mut columns, mut rows, mut weight) = (0.0, 0.0, 0.0);
        for pixel in pixels {
            let w = pixel.luminance_cd_m2 * pixel.solid_angle_sr;
            columns += w * (pixel.index % self.field.width) as f64;
            rows += w * (pixel.index / self.field.width + 1) as f64;
            weight += w;
        }
        self.field
            .towards((columns / weight + ROUNDING).floor() + 0.5, (rows / weight - ROUNDING).ceil() - 0.5)
    }
}

/// Mean direction, weighted with luminance and solid angle.
fn sphere_centre(pixels: &[FieldPixel]) -> Vec3 {
    let weighted = |p: &FieldPixel| p.luminance_cd_m2 * p.solid_angle_sr * p.direction;
    pixels.iter().map(weighted).sum::<Vec3>().normalize_or(pixels[0].direction)
}
