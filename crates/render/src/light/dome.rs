//! Sampling a sky in proportion to its brightness: the sphere in strips of equal light, and these in cells of equal light.

use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3, luminance, warp};

/// The brightness is looked at in cells of equal solid angle: so many steps of the height z between nadir and zenith, the horizon between
/// two of them, and so many around.
const HEIGHTS: usize = 120;
const AZIMUTHS: usize = 256;
/// The brightness of such a cell is the mean of so many by so many points.
const POINTS: usize = 2;
/// It counts as this share of the mean brightness at least, so that no light is missed where a cell's points saw none.
const FLOOR: f64 = 1e-3;
/// Brightnesses that differ by more than this factor are not put into one strip or cell: what is bright in it would be drawn too seldom.
const LIKE: f64 = 2.0;

/// So many strips, and so many cells of each, hold the same light, or nearly.
const STEPS: usize = 128;
/// Most parts of like brightness that are told apart: each takes a step at least, however dark it is.
const MOST_PARTS: usize = STEPS / 4;

/// A piecewise constant density over the sphere.
#[derive(Debug)]
pub(crate) struct Dome {
    /// In height.
    strips: Quantiles,
    /// Of each strip, in turns around.
    cells: Vec<Quantiles>,
}

impl Dome {
    /// `None` if it is black all over.
    pub fn new(radiance: impl Fn(Vec3) -> Rgb) -> Option<Self> {
        let weights: Vec<f64> =
            (0..HEIGHTS * AZIMUTHS).map(|i| cell_mean(&radiance, i / AZIMUTHS, i % AZIMUTHS)).collect();
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        if mean <= 0.0 {
            return None;
        }
        let weights: Vec<f64> = weights.iter().map(|w| w.max(FLOOR * mean)).collect();
        let rows: Vec<&[f64]> = weights.chunks_exact(AZIMUTHS).collect();
        let sums: Vec<f64> = rows.iter().map(|row| row.iter().sum()).collect();
        let strips = Quantiles::new(&sums);
        let between = |[start, end]: [f64; 2]| {
            // Rows count with as much of their height as lies in the strip.
            let share = |row: usize| (end.min(row as f64 + 1.0) - start.max(row as f64)).max(0.0);
            let touched = start as usize..(end.ceil() as usize).min(HEIGHTS);
            let cell = |i: usize| touched.clone().map(|row| share(row) * rows[row][i]).sum();
            Quantiles::new(&(0..AZIMUTHS).map(cell).collect::<Vec<f64>>())
        };
        let cells = (0..STEPS).map(|strip| between(strips.step(strip).map(|z| z * HEIGHTS as f64))).collect();
        Some(Self { strips, cells })
    }

    /// The heights z between which each strip lies.
    pub fn strips(&self) -> impl Iterator<Item = [f64; 2]> {
        (0..STEPS).map(|strip| self.strips.step(strip).map(|z| 2.0 * z - 1.0))
    }

    /// Density [1/sr].
    pub fn pdf(&self, direction: Vec3) -> f64 {
        let strip = self.strips.find(0.5 * (direction.z + 1.0));
        let from_x = 0.5 / PI * warp::angle([direction.x, direction.y.abs()]);
        let cells = &self.cells[strip];
        let cell = cells.find(if direction.y < 0.0 { 1.0 - from_x } else { from_x });
        density(self.strips.step(strip), cells.step(cell))
    }

    /// A direction, its density [1/sr], and the number of its strip.
    #[inline]
    pub fn sample(&self, [u, v]: [f64; 2]) -> (Vec3, f64, usize) {
        let (strip, z) = self.strips.pick(u);
        let cells = &self.cells[strip];
        let (cell, turns) = cells.pick(v);
        (direction(2.0 * z - 1.0, turns), density(self.strips.step(strip), cells.step(cell)), strip)
    }
}

/// The unit interval in steps of like weight, so that one is drawn without a search.
#[derive(Debug)]
struct Quantiles {
    /// Where steps end, and before them where the first begins.
    ends: [f32; STEPS + 1],
}

impl Quantiles {
    /// Of weights that lie side by side, as wide as each other and above zero.
    fn new(weights: &[f64]) -> Self {
        let parts = parts_alike(weights);
        let whole: f64 = weights.iter().sum();
        let mut ends = [0.0; STEPS + 1];
        let (mut used, mut first, mut sum) = (0, 0, 0.0);
        for (i, part) in parts.iter().enumerate() {
            sum += part.iter().sum::<f64>();
            // Each part has a step of its own at least.
            let until = i + 1 + ((STEPS - parts.len()) as f64 * (sum / whole)).round() as usize;
            let inner = divided(part, until - used);
            for (end, at) in ends[used + 1..=until].iter_mut().zip(inner) {
                *end = ((first as f64 + at) / weights.len() as f64) as f32;
            }
            (used, first) = (until, first + part.len());
        }
        Self { ends }
    }

    /// The step that `u` falls into, and the place there.
    #[inline]
    fn pick(&self, u: f64) -> (usize, f64) {
        let at = u * STEPS as f64;
        let step = (at as u32).min(STEPS as u32 - 1) as usize;
        let [start, end] = self.step(step);
        (step, start + (at - step as f64) * (end - start))
    }

    /// The step at a place.
    fn find(&self, place: f64) -> usize {
        self.ends[1..STEPS].partition_point(|&end| f64::from(end) <= place)
    }

    /// Where a step begins and ends.
    #[inline]
    fn step(&self, step: usize) -> [f64; 2] {
        [self.ends[step].into(), self.ends[step + 1].into()]
    }
}

/// Weights in parts within which neighbours are alike: in a step that is bright and dark, what is bright would be drawn too seldom.
fn parts_alike(weights: &[f64]) -> Vec<&[f64]> {
    let mut like = LIKE;
    loop {
        let parts: Vec<_> = weights.chunk_by(|a, b| a.max(*b) <= like * a.min(*b)).collect();
        if parts.len() <= MOST_PARTS {
            return parts;
        }
        like *= 2.0;
    }
}

/// Where `n` steps of the same weight end, in widths of a weight.
fn divided(weights: &[f64], n: usize) -> impl Iterator<Item = f64> {
    let whole: f64 = weights.iter().sum();
    let (mut i, mut sum) = (0, 0.0);
    (1..=n).map(move |step| {
        if step == n {
            return weights.len() as f64;
        }
        let wanted = whole * (step as f64 / n as f64);
        while sum + weights[i] < wanted {
            sum += weights[i];
            i += 1;
        }
        i as f64 + (wanted - sum) / weights[i]
    })
}

/// Density [1/sr] in a cell of a strip.
fn density([z0, z1]: [f64; 2], [start, end]: [f64; 2]) -> f64 {
    const OF_ALL: f64 = 1.0 / (4.0 * PI * (STEPS * STEPS) as f64);
    OF_ALL / ((z1 - z0) * (end - start))
}

fn direction(z: f64, turns: f64) -> Vec3 {
    let r = (1.0 - z * z).max(0.0).sqrt();
    let [cos, sin] = warp::circle(turns);
    Vec3::new(r * cos, r * sin, z)
}

fn cell_mean(radiance: &impl Fn(Vec3) -> Rgb, row: usize, cell: usize) -> f64 {
    let offsets =
        (0..POINTS * POINTS).map(|k| [k / POINTS, k % POINTS].map(|o| (o as f64 + 0.5) / POINTS as f64));
    let at = |[h, a]: [f64; 2]| {
        let z = 2.0 * (row as f64 + h) / HEIGHTS as f64 - 1.0;
        luminance(radiance(direction(z, (cell as f64 + a) / AZIMUTHS as f64)))
    };
    offsets.map(at).sum::<f64>() / (POINTS * POINTS) as f64
}
