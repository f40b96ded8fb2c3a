//! From the errors of a picture's blocks to those of background and sources.

use crate::change::{Change, Covariance, OWNERS, Owner};
use crate::field::{Field, FieldPixel};
use crate::noise::pixel_variances;
use crate::report::Source;
use crate::survey::parts;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use sunpeak_core::Result;
use sunpeak_scene::BlockErrors;

/// Standard errors of what the ratings are made of, each independent of the others.
#[derive(Clone, Debug, Default)]
pub(crate) struct SamplingError {
    /// Illuminance at the eye from where no source is near [lx].
    pub background_lux: f64,
    /// Of sources and what is around them.
    pub changes: Vec<Change>,
}

/// What makes a source.
pub(crate) struct Limits {
    /// Pixels above this glare.
    pub threshold_cd_m2: f64,
    /// Pixels above this are sources of their own.
    pub peak_cd_m2: Option<f64>,
}

/// Whose a pixel may be: a source that was split off, and one that was not.
type Owners = [Option<usize>; OWNERS];

impl Limits {
    /// Place among a pixel's owners of a source of such pixels.
    fn kind(&self, pixels: &[FieldPixel]) -> usize {
        let is_above = |peak: f64| pixels.first().is_some_and(|pixel| pixel.luminance_cd_m2 > peak);
        usize::from(!self.peak_cd_m2.is_some_and(is_above))
    }

    /// By luminance, whose a pixel is. What was split off with nothing around it stays what it is.
    fn owners(&self, owners: Owners, is_of: Option<usize>) -> Vec<Owner> {
        let (threshold, all) = (self.threshold_cd_m2, f64::INFINITY);
        let peak = self.peak_cd_m2.unwrap_or(all).max(threshold);
        let owner = |source, from, to| Owner { source, luminances_cd_m2: from..to };
        match owners {
            [Some(bright), Some(around)] => vec![owner(bright, peak, all), owner(around, threshold, peak)],
            [None, Some(around)] => vec![owner(around, threshold, all)],
            [Some(bright), None] if is_of == Some(bright) => vec![owner(bright, -all, all)],
            _ => Vec::new(),
        }
    }
}

/// Standard errors of background and sources, which are given with their pixels; `None` if the picture does not know its own.
pub(crate) fn sampling_error(
    field: &Field,
    limits: &Limits,
    sources: &[(Source, Vec<FieldPixel>)],
) -> Result<Option<SamplingError>> {
    let errors = field.picture.block_errors.as_ref().filter(|errors| errors.fits(field.width, field.height));
    let Some(errors) = errors else { return Ok(None) };
    let map = Map::new(field, errors, limits, sources);
    let near: Vec<BlockNoise> = map.blocks_near().into_par_iter().map(|block| map.noise(block)).collect();
    let mut is_near = vec![false; errors.luminance_cd_m2.len()];
    let mut background_lux2 = 0.0;
    let mut sums = BTreeMap::<Owners, Covariance>::new();
    for noise in near {
        is_near[noise.block] = true;
        background_lux2 += noise.background_lux2;
        for (owners, covariance) in noise.sources {
            sums.entry(owners).and_modify(|sum| sum.merge(&covariance)).or_insert(covariance);
        }
    }
    let far = projected_solid_angles(field, errors)?.into_iter().zip(&errors.luminance_cd_m2).zip(is_near);
    let far = far.filter(|(_, is_near)| !is_near);
    background_lux2 += far.map(|((projected_sr, error), _)| (projected_sr * error).powi(2)).sum::<f64>();
    let changes = sums.values().flat_map(Covariance::changes).collect();
    Ok(Some(SamplingError { background_lux: background_lux2.sqrt(), changes }))
}

/// The variances of a block.
struct BlockNoise {
    block: usize,
    sources: BTreeMap<Owners, Covariance>,
    /// Of the illuminance from pixels that are nobody's [lx²].
    background_lux2: f64,
}

/// Where sources are.
struct Map<'a> {
    field: &'a Field<'a>,
    errors: &'a BlockErrors,
    limits: &'a Limits,
    sources: &'a [(Source, Vec<FieldPixel>)],
    /// Place of each source among a pixel's owners.
    kinds: Vec<usize>,
    /// By block that holds some of a source.
    blocks: BTreeMap<usize, SourcesHere>,
}

/// What a block holds of sources.
#[derive(Default)]
struct SourcesHere {
    /// Pixels, and whose they are.
    pixels: HashMap<usize, usize>,
    /// Of each kind the source with most light, and that light.
    most: [Option<(f64, usize)>; OWNERS],
}

impl<'a> Map<'a> {
    fn new(
        field: &'a Field,
        errors: &'a BlockErrors,
        limits: &'a Limits,
        sources: &'a [(Source, Vec<FieldPixel>)],
    ) -> Self {
        let kinds = sources.iter().map(|(_, pixels)| limits.kind(pixels)).collect();
        let mut map = Self { field, errors, limits, sources, kinds, blocks: BTreeMap::new() };
        for (source, (_, pixels)) in sources.iter().enumerate() {
            let mut light = BTreeMap::<usize, f64>::new();
            for pixel in pixels {
                let block = errors.block(pixel.index % field.width, pixel.index / field.width);
                map.blocks.entry(block).or_default().pixels.insert(pixel.index, source);
                *light.entry(block).or_default() += pixel.luminance_cd_m2 * pixel.solid_angle_sr;
            }
            for (block, light) in light {
                let most = &mut map.blocks.entry(block).or_default().most[map.kinds[source]];
                if most.is_none_or(|(most, _)| light > most) {
                    *most = Some((light, source));
                }
            }
        }
        map
    }

    /// Blocks that hold some of a source, or touch one that does.
    fn blocks_near(&self) -> Vec<usize> {
        let all: BTreeSet<usize> = self.blocks.keys().flat_map(|&block| self.around(block)).collect();
        all.into_iter().collect()
    }

    /// A block and those that touch it.
    fn around(&self, block: usize) -> impl Iterator<Item = usize> {
        let columns = self.errors.columns;
        let rows = self.errors.luminance_cd_m2.len() / columns;
        let near = |i: usize, end: usize| i.saturating_sub(1)..(i + 2).min(end);
        near(block / columns, rows)
            .flat_map(move |row| near(block % columns, columns).map(move |column| row * columns + column))
    }

    /// Whose the pixels of a block would be: of each kind the source with most light in it, or else in those around it.
    fn owners(&self, block: usize) -> Owners {
        let most = |block: usize, kind: usize| self.blocks.get(&block).and_then(|here| here.most[kind]);
        std::array::from_fn(|kind| {
            let near =
                || self.around(block).filter_map(|near| most(near, kind)).max_by(|a, b| a.0.total_cmp(&b.0));
            most(block, kind).or_else(near).map(|(_, source)| source)
        })
    }

    /// What the pixels of a block bring.
    fn noise(&self, block: usize) -> BlockNoise {
        let mut noise = BlockNoise { block, sources: BTreeMap::new(), background_lux2: 0.0 };
        let (here, owners_here) = (self.blocks.get(&block), self.owners(block));
        let variances = pixel_variances(self.field, self.errors, block);
        let pixels = self.errors.pixels(block, self.field.width, self.field.height).zip(variances);
        for (index, variance) in pixels.filter(|(_, variance)| *variance > 0.0) {
            let Some(pixel) = self.field.pixel(index) else { continue };
            let is_of = here.and_then(|here| here.pixels.get(&index)).copied();
            let mut owners = owners_here;
            if let Some(source) = is_of {
                owners[self.kinds[source]] = Some(source);
            }
            let by_luminance = self.limits.owners(owners, is_of);
            if by_luminance.is_empty() {
                noise.background_lux2 += variance * (pixel.solid_angle_sr * pixel.cosine).powi(2);
            } else {
                let new = || Covariance::new(&by_luminance, |source| self.sources[source].0.direction);
                noise.sources.entry(owners).or_insert_with(new).add(&pixel, variance, &by_luminance);
            }
        }
        noise
    }
}

/// Of each block, what it weighs in the illuminance at the eye [sr].
fn projected_solid_angles(field: &Field, errors: &BlockErrors) -> Result<Vec<f64>> {
    let found = parts(field, |range| {
        let mut blocks = BTreeMap::<usize, f64>::new();
        for (index, luminance) in field.luminances(range) {
            if let Some(pixel) = field.with_luminance(index, luminance) {
                let block = errors.block(index % field.width, index / field.width);
                *blocks.entry(block).or_default() += pixel.solid_angle_sr * pixel.cosine;
            }
        }
        Ok(blocks)
    })?;
    let mut all = vec![0.0; errors.luminance_cd_m2.len()];
    found.into_iter().flatten().for_each(|(block, projected_sr)| all[block] += projected_sr);
    Ok(all)
}
