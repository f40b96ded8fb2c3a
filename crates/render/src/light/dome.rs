//! Sampling a sky in proportion to its brightness: a table of the sphere in cells of equal solid angle.

use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3, luminance, warp};

/// Cells between nadir and zenith, equal steps of the height z. With the azimuths: cells of 4e-4 sr, about a degree wide.
const HEIGHTS: usize = 128;
/// Cells around.
const AZIMUTHS: usize = 256;
/// Rows, and cells of a row, are searched in blocks of as many as fill a cache line, by way of the blocks' sums.
const BLOCK: usize = 16;
const BLOCKS: usize = AZIMUTHS / BLOCK;
const ROW_BLOCKS: usize = HEIGHTS / BLOCK;
/// The brightness of a cell is the mean of so many by so many points.
const POINTS: usize = 2;
/// Every cell gets at least this share of the mean brightness, so that no light is missed where a cell's points saw none.
const FLOOR: f64 = 1e-3;

/// A piecewise constant density over the sphere. The running sums are the density: what they lose to rounding, samples and
/// density lose alike.
#[derive(Debug)]
pub(crate) struct Dome {
    /// Running sums of the rows, up to 1.
    rows: Vec<f32>,
    /// Running sums of blocks of rows, up to 1.
    row_blocks: Vec<f32>,
    /// Running sums of the blocks within each row, up to 1.
    blocks: Vec<f32>,
    /// Running sums of the cells within each row, up to 1.
    cells: Vec<f32>,
}

impl Dome {
    /// `None` if it is black all over.
    pub fn new(radiance: impl Fn(Vec3) -> Rgb) -> Option<Self> {
        let mut weights: Vec<f64> =
            (0..HEIGHTS * AZIMUTHS).map(|i| cell_mean(&radiance, i / AZIMUTHS, i % AZIMUTHS)).collect();
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        if mean <= 0.0 {
            return None;
        }
        weights.iter_mut().for_each(|w| *w = w.max(FLOOR * mean));
        let row_sums: Vec<f64> = weights.chunks_exact(AZIMUTHS).map(|row| row.iter().sum()).collect();
        let cells: Vec<f32> = weights.chunks_exact(AZIMUTHS).flat_map(running_sums).collect();
        let rows = running_sums(&row_sums);
        let ends = |sums: &[f32]| sums.iter().skip(BLOCK - 1).step_by(BLOCK).copied().collect();
        Some(Self { row_blocks: ends(&rows), blocks: ends(&cells), rows, cells })
    }

    /// Density [1/sr].
    pub fn pdf(&self, direction: Vec3) -> f64 {
        let height = (0.5 * (direction.z + 1.0) * HEIGHTS as f64) as usize;
        let turn = direction.y.atan2(direction.x) / (2.0 * PI);
        let azimuth = ((turn - turn.floor()) * AZIMUTHS as f64) as usize;
        self.density(height.min(HEIGHTS - 1), azimuth.min(AZIMUTHS - 1))
    }

    /// A direction and its density [1/sr].
    pub fn sample(&self, [u, v]: [f64; 2]) -> (Vec3, f64) {
        let row = step_within::<BLOCK>(&self.rows, step_within::<ROW_BLOCKS>(&self.row_blocks, 0, u), u);
        let block = step_within::<BLOCKS>(&self.blocks, row, v);
        let cell = step_within::<BLOCK>(&self.cells, block, v) - row * AZIMUTHS;
        let height = within(&self.rows, row, u);
        let turn = within(self.row(row), cell, v);
        let z = 2.0 * (row as f64 + height) / HEIGHTS as f64 - 1.0;
        let turns = (cell as f64 + turn) / AZIMUTHS as f64;
        (direction(z, turns), self.density(row, cell))
    }

    fn row(&self, row: usize) -> &[f32] {
        &self.cells[row * AZIMUTHS..(row + 1) * AZIMUTHS]
    }

    fn density(&self, row: usize, cell: usize) -> f64 {
        let cell_solid_angle = 4.0 * PI / (HEIGHTS * AZIMUTHS) as f64;
        width(&self.rows, row) * width(self.row(row), cell) / cell_solid_angle
    }
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

/// Running sums, normalised to end at 1.
pub(super) fn running_sums(weights: &[f64]) -> Vec<f32> {
    let whole: f64 = weights.iter().sum();
    let mut sum = 0.0;
    let mut add = |w: &f64| {
        sum += w / whole;
        sum as f32
    };
    weights.iter().map(&mut add).collect()
}

/// The step of running sums into which `u` falls, and where in it, 0 to 1.
pub(super) fn pick(sums: &[f32], u: f64) -> (usize, f64) {
    let i = step(sums, u);
    (i, within(sums, i, u))
}

fn step(sums: &[f32], u: f64) -> usize {
    sums.partition_point(|&sum| f64::from(sum) <= u).min(sums.len() - 1)
}

/// The step of block `index` of so many sums, by counting: there are no branches to be guessed wrong.
fn step_within<const BLOCK: usize>(sums: &[f32], index: usize, u: f64) -> usize {
    let (blocks, _) = sums.as_chunks::<BLOCK>();
    let u = u as f32;
    let passed: u32 = blocks[index].iter().map(|&sum| u32::from(sum <= u)).sum();
    index * BLOCK + (passed as usize).min(BLOCK - 1)
}

fn before(sums: &[f32], step: usize) -> f64 {
    if step > 0 { f64::from(sums[step - 1]) } else { 0.0 }
}

fn width(sums: &[f32], step: usize) -> f64 {
    f64::from(sums[step]) - before(sums, step)
}

fn within(sums: &[f32], step: usize, u: f64) -> f64 {
    ((u - before(sums, step)) / width(sums, step)).clamp(0.0, 1.0 - f64::EPSILON)
}
