//! From the errors of a picture's blocks to those of background and sources.

use crate::field::{Field, FieldPixel};
use crate::normal;
use crate::survey::parts;
use std::collections::BTreeMap;
use sunpeak_core::Result;
use sunpeak_scene::BlockErrors;

/// Standard errors of what the ratings are made of. They are independent: blocks are.
#[derive(Clone, Debug, Default)]
pub(crate) struct SamplingError {
    /// Illuminance at the eye that is not from sources [lx].
    pub background_lux: f64,
    /// Luminance times solid angle of each source [cd sr m⁻²]; 0 for exact ones.
    pub source_flux: Vec<f64>,
    /// Solid angle of each source [sr], by pixels that may pass the threshold or not.
    pub source_solid_angle_sr: Vec<f64>,
}

/// What a block of pixels holds.
#[derive(Clone, Copy, Default)]
struct Block {
    flux: f64,
    solid_angle_sr: f64,
    projected_sr: f64,
    /// Variance of the solid angle that passes the threshold [sr²].
    passing_variance: f64,
}

/// Standard errors of background and sources, the latter in the order of their `pixels`; `None` if the picture does not know its own.
///
/// A block's error is shared out in proportion to the light in it: noise stands where light is.
pub(crate) fn sampling_error(
    field: &Field,
    threshold: f64,
    pixels: &[&[FieldPixel]],
) -> Result<Option<SamplingError>> {
    let errors = field.picture.block_errors.as_ref().filter(|errors| errors.fits(field.width, field.height));
    let Some(errors) = errors else { return Ok(None) };
    let blocks = blocks(field, errors, threshold)?;
    let mut left: Vec<f64> = vec![1.0; blocks.len()];
    let mut owners = BTreeMap::new();
    let mut source_flux = Vec::new();
    for (source, pixels) in pixels.iter().enumerate() {
        let mut variance = 0.0;
        for (block, flux) in flux_by_block(field, errors, pixels) {
            let share = (flux / blocks[block].flux).min(1.0);
            left[block] = (left[block] - share).max(0.0);
            variance += (share * errors.luminance_cd_m2[block] * blocks[block].solid_angle_sr).powi(2);
            let owner = owners.entry(block).or_insert((share, source));
            if share > owner.0 {
                *owner = (share, source);
            }
        }
        source_flux.push(variance.sqrt());
    }
    let mut solid_angle_variance = vec![0.0; pixels.len()];
    for (block, (_, source)) in owners {
        solid_angle_variance[source] += blocks[block].passing_variance;
    }
    let background = blocks.iter().zip(&left).zip(&errors.luminance_cd_m2);
    let variance: f64 =
        background.map(|((block, left), error)| (left * error * block.projected_sr).powi(2)).sum();
    Ok(Some(SamplingError {
        background_lux: variance.sqrt(),
        source_flux,
        source_solid_angle_sr: solid_angle_variance.into_iter().map(f64::sqrt).collect(),
    }))
}

/// How much of a source's light each block holds.
fn flux_by_block(field: &Field, errors: &BlockErrors, pixels: &[FieldPixel]) -> BTreeMap<usize, f64> {
    let mut flux = BTreeMap::new();
    for pixel in pixels {
        let block = errors.block(pixel.index % field.width, pixel.index / field.width);
        *flux.entry(block).or_default() += pixel.luminance_cd_m2 * pixel.solid_angle_sr;
    }
    flux
}

/// Variance of "passes the threshold" (0 or 1) for a pixel with a standard error.
fn passing_variance(luminance: f64, error: f64, threshold: f64) -> f64 {
    if error <= 0.0 {
        return 0.0;
    }
    let passes = normal::cumulative((luminance - threshold) / error);
    passes * (1.0 - passes)
}

fn blocks(field: &Field, errors: &BlockErrors, threshold: f64) -> Result<Vec<Block>> {
    let found = parts(field, |range| {
        let mut blocks = BTreeMap::<usize, Block>::new();
        for (index, luminance) in field.luminances(range) {
            if let Some(pixel) = field.with_luminance(index, luminance) {
                let place = errors.block(index % field.width, index / field.width);
                // Pixels are independent: the mean of a block is known better than they are.
                let error = errors.luminance_cd_m2[place] * errors.edge as f64;
                let block = blocks.entry(place).or_default();
                block.passing_variance +=
                    pixel.solid_angle_sr.powi(2) * passing_variance(luminance, error, threshold);
                block.flux += luminance * pixel.solid_angle_sr;
                block.solid_angle_sr += pixel.solid_angle_sr;
                block.projected_sr += pixel.solid_angle_sr * pixel.cosine;
            }
        }
        Ok(blocks)
    })?;
    let mut all = vec![Block::default(); errors.luminance_cd_m2.len()];
    for (index, block) in found.into_iter().flatten() {
        all[index].flux += block.flux;
        all[index].solid_angle_sr += block.solid_angle_sr;
        all[index].projected_sr += block.projected_sr;
        all[index].passing_variance += block.passing_variance;
    }
    Ok(all)
}
