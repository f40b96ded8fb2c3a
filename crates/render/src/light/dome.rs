//! Sampling a sky in proportion to its brightness: a table of the sphere in cells of equal solid angle.

use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3, luminance, warp};

/// Cells are searched in lines of as many running sums as fill a cache line: the sum before the first cell, and that after each.
const LINE: usize = 16;
const CELLS: usize = LINE - 1;
/// Lines of rows, and of the cells of a row. (Where lines end is compared in whole steps of four.)
const ROW_LINES: usize = 8;
const CELL_LINES: usize = 17;
/// Cells between nadir and zenith, equal steps of the height z; the horizon is between two. With the azimuths: cells of 4e-4 sr, about a
/// degree wide.
const HEIGHTS: usize = ROW_LINES * CELLS;
/// Cells around.
const AZIMUTHS: usize = CELL_LINES * CELLS;
/// The brightness of a cell is the mean of so many by so many points.
const POINTS: usize = 2;
/// Every cell gets at least this share of the mean brightness, so that no light is missed where a cell's points saw none.
const FLOOR: f64 = 1e-3;

/// A piecewise constant density over the sphere. The running sums are the density: what they lose to rounding, samples and
/// density lose alike.
#[derive(Debug)]
pub(crate) struct Dome {
    /// Of the rows, up to 1.
    rows: Sums<ROW_LINES, 8>,
    /// Of the cells within each row, up to 1.
    cells: Vec<Sums<CELL_LINES, 16>>,
    /// Cosine and sine of the azimuths in the middle of the cells.
    azimuths: Vec<[f64; 2]>,
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
        let rows = weights.chunks_exact(AZIMUTHS);
        let row_sums: Vec<f64> = rows.clone().map(|row| row.iter().sum()).collect();
        let middle = |cell: usize| warp::circle((cell as f64 + 0.5) / AZIMUTHS as f64);
        Some(Self {
            rows: Sums::new(&row_sums),
            cells: rows.map(Sums::new).collect(),
            azimuths: (0..AZIMUTHS).map(middle).collect(),
        })
    }

    /// Density [1/sr].
    pub fn pdf(&self, direction: Vec3) -> f64 {
        let height = (0.5 * HEIGHTS as f64 * (direction.z + 1.0)) as u32;
        let from_x = AZIMUTHS as f64 / (2.0 * PI) * warp::angle([direction.x, direction.y.abs()]);
        let azimuth = if direction.y < 0.0 { AZIMUTHS as f64 - from_x } else { from_x } as u32;
        let (row, cell) = (height.min(HEIGHTS as u32 - 1), azimuth.min(AZIMUTHS as u32 - 1));
        density(self.rows.step(row).width(), self.cells[row as usize].step(cell).width())
    }

    /// A direction and its density [1/sr].
    #[inline]
    pub fn sample(&self, [u, v]: [f64; 2]) -> (Vec3, f64) {
        let (row, rows) = self.rows.pick(u);
        let (cell, cells) = self.cells[row as usize].pick(v);
        let z = (f64::from(row) + rows.within(u)) * (2.0 / HEIGHTS as f64) - 1.0;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let [cos, sin] = turned(self.azimuths[cell as usize], cells.within(v) - 0.5);
        (Vec3::new(r * cos, r * sin, z), density(rows.width(), cells.width()))
    }
}

/// Running sums of so many lines of steps, and those where lines end (all, or all but the last).
#[derive(Debug)]
struct Sums<const LINES: usize, const ENDS: usize> {
    ends: [f32; ENDS],
    lines: [[f32; LINE]; LINES],
}

impl<const LINES: usize, const ENDS: usize> Sums<LINES, ENDS> {
    fn new(weights: &[f64]) -> Self {
        let sums = running_sums(weights);
        let until = |step: usize| if step > 0 { sums[step - 1] } else { 0.0 };
        Self {
            ends: std::array::from_fn(|line| until((line + 1) * CELLS)),
            lines: std::array::from_fn(|line| std::array::from_fn(|i| until(line * CELLS + i))),
        }
    }

    /// The step into which `u` falls, by counting: there are no branches to be guessed wrong.
    #[inline]
    fn pick(&self, u: f64) -> (u32, Step) {
        /// The greatest number below 1, where every step has ended.
        const LAST: f32 = 1.0 - f32::EPSILON / 2.0;
        let u = (u as f32).min(LAST);
        let line = passed(&self.ends, u);
        let sums = &self.lines[line as usize];
        let end = passed(sums, u).min(CELLS as u32);
        (line * CELLS as u32 + end - 1, Step::to(sums, end))
    }

    #[inline]
    fn step(&self, step: u32) -> Step {
        Step::to(&self.lines[(step / CELLS as u32) as usize], step % CELLS as u32 + 1)
    }
}

/// How many sums are not above `u`.
#[inline]
fn passed<const N: usize>(sums: &[f32; N], u: f32) -> u32 {
    sums.iter().map(|&sum| u32::from(sum <= u)).sum()
}

/// The running sums before and after a step.
struct Step {
    before: f64,
    after: f64,
}

impl Step {
    #[inline]
    fn to(sums: &[f32; LINE], end: u32) -> Self {
        Self { before: sums[end as usize - 1].into(), after: sums[end as usize].into() }
    }

    fn width(&self) -> f64 {
        self.after - self.before
    }

    /// Where in it, 0 to 1.
    fn within(&self, u: f64) -> f64 {
        ((u - self.before).max(0.0) / self.width()).min(1.0 - f64::EPSILON)
    }
}

/// Density [1/sr] of a cell, from the shares of its row, and of the cell in that.
fn density(row: f64, cell: f64) -> f64 {
    const CELL_SOLID_ANGLE: f64 = 4.0 * PI / (HEIGHTS * AZIMUTHS) as f64;
    row * cell * (1.0 / CELL_SOLID_ANGLE)
}

/// A cosine and sine, turned by at most half a cell to either side: Taylor's series, whose remainders are below 1e-17.
fn turned([cos, sin]: [f64; 2], cells: f64) -> [f64; 2] {
    let angle = cells * (2.0 * PI / AZIMUTHS as f64);
    let x = angle * angle;
    let along = 1.0 - x * (1.0 / 2.0 - x * (1.0 / 24.0 - x * (1.0 / 720.0)));
    let across = angle * (1.0 - x * (1.0 / 6.0 - x * (1.0 / 120.0)));
    [cos * along - sin * across, sin * along + cos * across]
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
    let i = sums.partition_point(|&sum| f64::from(sum) <= u).min(sums.len() - 1);
    let before = if i > 0 { f64::from(sums[i - 1]) } else { 0.0 };
    (i, Step { before, after: sums[i].into() }.within(u))
}
