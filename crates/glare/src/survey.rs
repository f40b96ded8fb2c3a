//! Sums over the whole field of view, in one pass on all cores.

use crate::field::{Field, FieldPixel};
use crate::zones::{PERIPHERY, Zones};
use rayon::prelude::*;
use std::f64::consts::PI;
use sunpeak_core::{Result, Vec3};

/// Pixels in a part of the picture that is summed up at once, at least: the result is the same on any number of threads.
const PART: usize = 1 << 18;

/// Parts of a picture, at most: each has sums and histograms of its own.
const MOST_PARTS: usize = 32;

/// Solid angles are counted in whole numbers of this many to the steradian, so that their order does not matter.
const COUNTS_PER_SR: f64 = (1_u64 << 56) as f64;

/// A cone of directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    /// Unit vector along its middle.
    pub axis: Vec3,
    /// Cosine of half its opening angle.
    pub cosine: f64,
}

impl Cone {
    pub fn new(axis: Vec3, opening_angle_rad: f64) -> Self {
        Self { axis: axis.normalize(), cosine: (opening_angle_rad / 2.0).cos() }
    }

    pub fn contains(&self, direction: Vec3) -> bool {
        direction.dot(self.axis) >= self.cosine
    }
}

/// Luminance times solid angle, and solid angle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mean {
    pub flux: f64,
    pub solid_angle_sr: f64,
}

impl Mean {
    pub fn add(&mut self, luminance: f64, solid_angle_sr: f64) {
        self.flux += luminance * solid_angle_sr;
        self.solid_angle_sr += solid_angle_sr;
    }

    /// Mean luminance [cd/m²]; `None` if nothing was added.
    pub fn luminance(&self) -> Option<f64> {
        (self.solid_angle_sr > 0.0).then(|| self.flux / self.solid_angle_sr)
    }
}

/// What the field of view holds (without suns that were taken out).
pub(crate) struct Survey {
    pub illuminance_lux: f64,
    /// Share of the hemisphere in front, weighted as for illuminance, that the picture covers.
    pub coverage: f64,
    pub whole: Mean,
    /// Of each zone.
    pub zones: [Mean; 4],
    pub max_luminance: f64,
    pub median_luminance: f64,
}

/// Share of the hemisphere that a picture must cover to count as whole.
pub(crate) const WHOLE_COVERAGE: f64 = 0.99;

/// Look at each pixel once. Fails on the first that holds what light does not.
pub(crate) fn survey(field: &Field, zones: &Zones) -> Result<Survey> {
    let parts = parts(field, |range| Part::of(field, zones, range))?;
    let mut all = Part::new();
    parts.iter().for_each(|part| all.merge(part));
    all.close_rim();
    let median_luminance = median(field, &all.histogram)?;
    Ok(Survey {
        illuminance_lux: all.illuminance_lux,
        coverage: all.projected_sr / PI,
        whole: all.whole,
        zones: all.zones,
        max_luminance: all.max_luminance,
        median_luminance,
    })
}

/// Do something with each part of the picture (ranges of pixels, whole rows), on all cores.
pub(crate) fn parts<T: Send>(
    field: &Field,
    work: impl Fn(std::ops::Range<usize>) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let rows = (PART / field.width).max(field.height.div_ceil(MOST_PARTS)).max(1);
    (0..field.height.div_ceil(rows))
        .into_par_iter()
        .map(|part| {
            let (first, last) = (part * rows, ((part + 1) * rows).min(field.height));
            work(first * field.width..last * field.width)
        })
        .collect()
}

struct Part {
    illuminance_lux: f64,
    projected_sr: f64,
    whole: Mean,
    rim: Mean,
    zones: [Mean; 4],
    max_luminance: f64,
    histogram: Vec<u64>,
}

impl Part {
    fn new() -> Self {
        Self {
            illuminance_lux: 0.0,
            projected_sr: 0.0,
            whole: Mean::default(),
            rim: Mean::default(),
            zones: [Mean::default(); 4],
            max_luminance: 0.0,
            histogram: vec![0; 1 << 16],
        }
    }

    fn of(field: &Field, zones: &Zones, range: std::ops::Range<usize>) -> Result<Self> {
        let mut part = Self::new();
        for (index, luminance) in field.luminances(range) {
            if let Some(pixel) = field.with_luminance(index, luminance) {
                if !(luminance >= 0.0 && luminance.is_finite()) {
                    return Err(field.bad_pixel(index));
                }
                part.add(&pixel, zones);
            }
        }
        Ok(part)
    }

    fn add(&mut self, pixel: &FieldPixel, zones: &Zones) {
        let (luminance, solid_angle) = (pixel.luminance_cd_m2, pixel.solid_angle_sr);
        self.illuminance_lux += pixel.illuminance_lux();
        self.projected_sr += solid_angle * pixel.cosine;
        self.whole.add(luminance, solid_angle);
        if pixel.is_at_rim() {
            self.rim.add(luminance, solid_angle);
        }
        self.zones[zones.of(pixel.direction)].add(luminance, solid_angle);
        self.max_luminance = self.max_luminance.max(luminance);
        self.histogram[coarse(luminance)] += count(solid_angle);
    }

    fn merge(&mut self, other: &Self) {
        let join = |a: &mut Mean, b: &Mean| {
            a.flux += b.flux;
            a.solid_angle_sr += b.solid_angle_sr;
        };
        self.illuminance_lux += other.illuminance_lux;
        self.projected_sr += other.projected_sr;
        join(&mut self.whole, &other.whole);
        join(&mut self.rim, &other.rim);
        self.zones.iter_mut().zip(&other.zones).for_each(|(a, b)| join(a, b));
        self.max_luminance = self.max_luminance.max(other.max_luminance);
        self.histogram.iter_mut().zip(&other.histogram).for_each(|(a, b)| *a += b);
    }
}

impl Part {
    /// Pixels at the rim are there or not, by their centres: what is missing to the hemisphere, or too much, is as bright as they are. In
    /// `-vth`, where a rim pixel is large, that is some per cent of the solid angle (and a thousandth of the illuminance).
    fn close_rim(&mut self) {
        let missing = 2.0 * PI - self.whole.solid_angle_sr;
        if self.projected_sr > WHOLE_COVERAGE * PI
            && let Some(luminance) = self.rim.luminance()
        {
            self.whole.add(luminance, missing);
            self.zones[PERIPHERY].add(luminance, missing);
            self.illuminance_lux += (PI - self.projected_sr) * luminance;
        }
    }
}

fn count(solid_angle_sr: f64) -> u64 {
    (solid_angle_sr * COUNTS_PER_SR) as u64
}

/// The upper half of the bits of a number: rising with the number, as it is not negative.
fn coarse(luminance: f64) -> usize {
    ((luminance as f32).to_bits() >> 16) as usize
}

/// The lower half.
fn fine(luminance: f64) -> usize {
    ((luminance as f32).to_bits() & 0xffff) as usize
}

/// Luminance [cd/m²] that half of the solid angle exceeds, from a histogram of the upper bits and one of the lower bits of the pixels
/// that share the median's upper bits. (A median of pixels would depend on the kind of fisheye.)
fn median(field: &Field, histogram: &[u64]) -> Result<f64> {
    let half = histogram.iter().sum::<u64>() / 2;
    let (upper, below) = quantile(histogram, half);
    let finer = parts(field, |range| {
        let mut histogram = vec![0; 1 << 16];
        for (index, luminance) in field.luminances(range).filter(|&(_, l)| coarse(l) == upper) {
            if let Some(pixel) = field.with_luminance(index, luminance) {
                histogram[fine(luminance)] += count(pixel.solid_angle_sr);
            }
        }
        Ok(histogram)
    })?;
    let mut all = vec![0; 1 << 16];
    finer.iter().for_each(|part| all.iter_mut().zip(part).for_each(|(a, b): (&mut u64, &u64)| *a += b));
    let (lower, _) = quantile(&all, half - below);
    Ok(f64::from(f32::from_bits((upper as u32) << 16 | lower as u32)))
}

/// The bin in which the running sum passes `target`, and the sum before it.
fn quantile(histogram: &[u64], target: u64) -> (usize, u64) {
    let mut below = 0;
    for (bin, &count) in histogram.iter().enumerate() {
        if count > 0 && below + count >= target {
            return (bin, below);
        }
        below += count;
    }
    (0, 0)
}
