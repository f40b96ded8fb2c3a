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
    let mut shares = Shares { left: vec![1.0; blocks.len()], owners: BTreeMap::new() };
    let take = |(source, pixels): (usize, &&[FieldPixel])| {
        let taken = shares.take(source, &blocks, flux_by_block(field, errors, pixels));
        let error = |(block, share): (usize, f64)| {
            share * errors.luminance_cd_m2[block] * blocks[block].solid_angle_sr
        };
        root_of_squares(taken.into_iter().map(error))
    };
    let source_flux = pixels.iter().enumerate().map(take).collect();
    let background = blocks.iter().zip(&shares.left).zip(&errors.luminance_cd_m2);
    Ok(Some(SamplingError {
        background_lux: root_of_squares(
            background.map(|((block, left), error)| left * error * block.projected_sr),
        ),
        source_flux,
        source_solid_angle_sr: shares.solid_angle_errors(&blocks, pixels.len()),
    }))
}

fn root_of_squares(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

/// Who gets how much of the error of each block.
struct Shares {
    /// What is left to the background.
    left: Vec<f64>,
    /// The largest share of a source so far, and the source.
    owners: BTreeMap<usize, (f64, usize)>,
}

impl Shares {
    /// Give a source its shares: blocks and parts of their light.
    fn take(&mut self, source: usize, blocks: &[Block], flux: BTreeMap<usize, f64>) -> Vec<(usize, f64)> {
        let mut taken = Vec::new();
        for (block, flux) in flux {
            let share = (flux / blocks[block].flux).min(1.0);
            self.left[block] = (self.left[block] - share).max(0.0);
            let owner = self.owners.entry(block).or_insert((share, source));
            if share > owner.0 {
                *owner = (share, source);
            }
            taken.push((block, share));
        }
        taken
    }

    /// Standard errors of the sources' solid angles: pixels at the threshold belong to the source with most light in their block.
    fn solid_angle_errors(&self, blocks: &[Block], sources: usize) -> Vec<f64> {
        let mut variance = vec![0.0; sources];
        for (&block, &(_, source)) in &self.owners {
            variance[source] += blocks[block].passing_variance;
        }
        variance.into_iter().map(f64::sqrt).collect()
    }
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
