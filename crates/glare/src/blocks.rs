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
    /// Where sources have pixels that may be theirs or not.
    pub edges: Vec<Edge>,
}

/// Pixels near a threshold, which pass it or not by noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// Whose they are if they pass.
    pub source: usize,
    /// Whose they are otherwise; `None` for the background.
    pub otherwise: Option<usize>,
    pub threshold_cd_m2: f64,
    /// Standard error of their solid angle [sr].
    pub solid_angle_sr: f64,
}

/// What makes a source.
pub(crate) struct Limits {
    /// Pixels above this glare.
    pub threshold_cd_m2: f64,
    /// Pixels above this are sources of their own.
    pub peak_cd_m2: Option<f64>,
}

impl Limits {
    /// Is a source of such pixels one that was split off?
    fn is_peak(&self, pixels: &[FieldPixel]) -> bool {
        self.peak_cd_m2.is_some_and(|peak| pixels.first().is_some_and(|pixel| pixel.luminance_cd_m2 > peak))
    }
}

/// What a block of pixels holds.
#[derive(Clone, Copy, Default)]
struct Block {
    flux: f64,
    solid_angle_sr: f64,
    projected_sr: f64,
}

/// Standard errors of background and sources, the latter in the order of their `pixels`; `None` if the picture does not know its own.
///
/// A block's variance is shared out in proportion to the light in it: pixels are independent, noise stands where light is, and the shares
/// sum to the whole.
pub(crate) fn sampling_error(
    field: &Field,
    limits: &Limits,
    pixels: &[&[FieldPixel]],
) -> Result<Option<SamplingError>> {
    let errors = field.picture.block_errors.as_ref().filter(|errors| errors.fits(field.width, field.height));
    let Some(errors) = errors else { return Ok(None) };
    let blocks = blocks(field, errors)?;
    let mut shares = Shares { left: vec![1.0; blocks.len()], owners: BTreeMap::new() };
    let take = |(source, pixels): (usize, &&[FieldPixel])| {
        let taken =
            shares.take(source, limits.is_peak(pixels), &blocks, flux_by_block(field, errors, pixels));
        let error = |(block, share): (usize, f64)| {
            share.sqrt() * errors.luminance_cd_m2[block] * blocks[block].solid_angle_sr
        };
        root_of_squares(taken.into_iter().map(error))
    };
    let source_flux = pixels.iter().enumerate().map(take).collect();
    let background = blocks.iter().zip(&shares.left).zip(&errors.luminance_cd_m2);
    Ok(Some(SamplingError {
        background_lux: root_of_squares(
            background.map(|((block, left), error)| left.sqrt() * error * block.projected_sr),
        ),
        source_flux,
        edges: shares.edges(limits, |block, threshold| passing_variance(field, errors, block, threshold)),
    }))
}

fn root_of_squares(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

/// Who gets how much of the error of each block.
struct Shares {
    /// What is left to the background.
    left: Vec<f64>,
    /// By block, and whether it is one of those that were split off: the largest share of a source so far, and the source.
    owners: BTreeMap<(usize, bool), (f64, usize)>,
}

impl Shares {
    /// Give a source its shares: blocks and parts of their light.
    fn take(
        &mut self,
        source: usize,
        is_peak: bool,
        blocks: &[Block],
        flux: BTreeMap<usize, f64>,
    ) -> Vec<(usize, f64)> {
        let mut taken = Vec::new();
        for (block, flux) in flux {
            let share = (flux / blocks[block].flux).min(1.0);
            self.left[block] = (self.left[block] - share).max(0.0);
            let owner = self.owners.entry((block, is_peak)).or_insert((share, source));
            if share > owner.0 {
                *owner = (share, source);
            }
            taken.push((block, share));
        }
        taken
    }

    /// Pixels at the threshold belong to the source with most light in their block, or to the background; those at the peak luminance to
    /// what was split off there, or to the source around it.
    fn edges(&self, limits: &Limits, passing_variance: impl Fn(usize, f64) -> f64) -> Vec<Edge> {
        let mut variance = BTreeMap::<(usize, Option<usize>), f64>::new();
        for (&(block, is_peak), &(_, source)) in &self.owners {
            let around = self.owners.get(&(block, false)).map(|&(_, source)| source);
            let (edge, threshold) = match (is_peak, around, limits.peak_cd_m2) {
                (false, _, _) => ((source, None), limits.threshold_cd_m2),
                (true, Some(around), Some(peak)) => ((source, Some(around)), peak),
                // Alone it stays what it is, split off or not.
                _ => continue,
            };
            *variance.entry(edge).or_default() += passing_variance(block, threshold);
        }
        let edge = |((source, otherwise), variance): ((usize, Option<usize>), f64)| {
            let peak = limits.peak_cd_m2.filter(|_| otherwise.is_some());
            let threshold_cd_m2 = peak.unwrap_or(limits.threshold_cd_m2);
            Edge { source, otherwise, threshold_cd_m2, solid_angle_sr: variance.sqrt() }
        };
        variance.into_iter().map(edge).filter(|edge| edge.solid_angle_sr > 0.0).collect()
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

/// Variance of the solid angle of a block's pixels that pass the threshold [sr²].
///
/// Pixels are independent, so the mean of a block is known better than they are; and noise stands where light is, so that the variance of
/// a pixel is in proportion to its luminance. A dim pixel beside a sun does not become a source by the sun's noise.
fn passing_variance(field: &Field, errors: &BlockErrors, block: usize, threshold: f64) -> f64 {
    let indices: Vec<usize> = errors.pixels(block, field.width, field.height).collect();
    let light: f64 = indices.iter().map(|&index| field.luminance(index)).sum();
    let variance_by_light = (errors.luminance_cd_m2[block] * indices.len() as f64).powi(2) / light;
    if variance_by_light.is_nan() || variance_by_light <= 0.0 {
        return 0.0;
    }
    let variance = |pixel: FieldPixel| {
        let error = (variance_by_light * pixel.luminance_cd_m2).sqrt();
        let passes = normal::cumulative((pixel.luminance_cd_m2 - threshold) / error);
        pixel.solid_angle_sr.powi(2) * passes * (1.0 - passes)
    };
    let lit = indices.into_iter().filter_map(|index| field.pixel(index)).filter(|p| p.luminance_cd_m2 > 0.0);
    lit.map(variance).sum()
}

fn blocks(field: &Field, errors: &BlockErrors) -> Result<Vec<Block>> {
    let found = parts(field, |range| {
        let mut blocks = BTreeMap::<usize, Block>::new();
        for (index, luminance) in field.luminances(range) {
            if let Some(pixel) = field.with_luminance(index, luminance) {
                let place = errors.block(index % field.width, index / field.width);
                let block = blocks.entry(place).or_default();
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
    }
    Ok(all)
}
