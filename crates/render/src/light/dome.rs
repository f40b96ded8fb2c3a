//! Sampling a sky in proportion to its brightness: a table of the sphere in cells of equal solid angle.

use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3, luminance};

/// Cells between nadir and zenith, equal steps of the height z.
const HEIGHTS: usize = 256;
/// Cells around.
const AZIMUTHS: usize = 512;
/// The brightness of a cell is the mean of so many by so many points.
const POINTS: usize = 2;
/// Every cell gets at least this share of the mean brightness, so that no light is missed where a cell's points saw none.
const FLOOR: f64 = 1e-3;

/// A piecewise constant density over the sphere.
#[derive(Debug)]
pub(crate) struct Dome {
    /// Cumulated weight of the rows, from 0 to 1.
    rows: Vec<f64>,
    /// Cumulated weight within each row, from 0 to 1.
    cells: Vec<f64>,
    /// Density of each cell [1/sr].
    density: Vec<f64>,
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
        let whole: f64 = row_sums.iter().sum();
        let cell_solid_angle = 4.0 * PI / weights.len() as f64;
        Some(Self {
            rows: cumulated(&row_sums),
            cells: weights.chunks_exact(AZIMUTHS).flat_map(cumulated_row).collect(),
            density: weights.iter().map(|w| w / whole / cell_solid_angle).collect(),
        })
    }

    /// Density [1/sr].
    pub fn pdf(&self, direction: Vec3) -> f64 {
        let height = (0.5 * (direction.z + 1.0) * HEIGHTS as f64) as usize;
        let turn = direction.y.atan2(direction.x) / (2.0 * PI);
        let azimuth = ((turn - turn.floor()) * AZIMUTHS as f64) as usize;
        self.density[height.min(HEIGHTS - 1) * AZIMUTHS + azimuth.min(AZIMUTHS - 1)]
    }

    /// A direction and its density [1/sr].
    pub fn sample(&self, [u, v]: [f64; 2]) -> (Vec3, f64) {
        let (row, height) = pick(&self.rows, u);
        let (cell, turn) = pick(&self.cells[row * AZIMUTHS..(row + 1) * AZIMUTHS], v);
        let z = 2.0 * (row as f64 + height) / HEIGHTS as f64 - 1.0;
        let phi = 2.0 * PI * (cell as f64 + turn) / AZIMUTHS as f64;
        (direction(z, phi), self.density[row * AZIMUTHS + cell])
    }
}

fn direction(z: f64, phi: f64) -> Vec3 {
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

fn cell_mean(radiance: &impl Fn(Vec3) -> Rgb, row: usize, cell: usize) -> f64 {
    let offsets =
        (0..POINTS * POINTS).map(|k| [k / POINTS, k % POINTS].map(|o| (o as f64 + 0.5) / POINTS as f64));
    let at = |[h, a]: [f64; 2]| {
        let z = 2.0 * (row as f64 + h) / HEIGHTS as f64 - 1.0;
        luminance(radiance(direction(z, 2.0 * PI * (cell as f64 + a) / AZIMUTHS as f64)))
    };
    offsets.map(at).sum::<f64>() / (POINTS * POINTS) as f64
}

/// Running sums, normalised to end at 1.
fn cumulated(weights: &[f64]) -> Vec<f64> {
    let whole: f64 = weights.iter().sum();
    weights
        .iter()
        .scan(0.0, |sum, w| {
            *sum += w / whole;
            Some(*sum)
        })
        .collect()
}

fn cumulated_row(row: &[f64]) -> Vec<f64> {
    cumulated(row)
}

/// The step of the running sums into which `u` falls, and where in it, 0 to 1.
pub(crate) fn pick(cumulated: &[f64], u: f64) -> (usize, f64) {
    let step = cumulated.partition_point(|&c| c <= u).min(cumulated.len() - 1);
    let low = if step > 0 { cumulated[step - 1] } else { 0.0 };
    (step, ((u - low) / (cumulated[step] - low)).clamp(0.0, 1.0 - f64::EPSILON))
}
