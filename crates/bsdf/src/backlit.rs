//! What a shade that is lit from behind gives off: the transmitted light of a far field, integrated beforehand.
//!
//! Light from far away depends on direction alone, so its radiance behind the table depends on the exiting direction alone:
//! `L(w_in)`, the integral of `f(w_in, w_out) L(w_out) |cos|` over the other hemisphere. In a matrix or a rank-4 tree it is
//! constant in the cells of the table, and the light is summed over their other sides; for an isotropic tree, which turns
//! with the light, it is tabulated by ring and azimuth.

use crate::{
    basis::AngleBasis,
    proposal::Oriented,
    table::{Columns, Table},
};
use glam::DVec2;
use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};
use sunpeak_core::{Rgb, Vec3, warp::square_to_disk};

/// Points a side at which the light is looked at; half of a degree at the zenith.
const POINTS: usize = 256;

/// Rings and azimuths in which the light on an isotropic tree is taken for level, and azimuths for which the result is kept.
const RINGS: usize = 64;
const AZIMUTHS: usize = 128;
const KEPT_AZIMUTHS: usize = 64;

/// Parts a side of the whole square: no larger than one are the pieces of a cell that are counted into rings and azimuths.
const PARTS: usize = 256;

/// Against the table's direction: one look a side of a bin for so many cells a side of the tree, and at most so many.
const LOOKS_PER_SIDE: f64 = 16.0;
const MOST_LOOKS: usize = 6;

/// Radiance behind a table, by direction.
#[derive(Clone, Debug)]
pub struct Backlit {
    cells: Cells,
    /// Traced against the table?
    reversed: bool,
    values: Vec<Rgb>,
}

#[derive(Clone, Debug)]
enum Cells {
    Patches(Arc<AngleBasis>),
    /// Cells a side.
    Square(usize),
    /// Rings of equal width in sin(theta), each with [`KEPT_AZIMUTHS`].
    Polar(usize),
}

impl Backlit {
    /// Integrate; `light` is the radiance that comes from where a point of the exiting disk stands. `residual`: of what the split left.
    pub(crate) fn new(oriented: &Oriented, residual: bool, light: impl Fn(DVec2) -> Rgb) -> Self {
        let reversed = oriented.reversed;
        let (cells, values) = match (oriented.distribution.luminous(), oriented.distribution.columns()) {
            (Table::Matrix(matrix), _) => {
                let basis = if reversed { &matrix.exiting } else { &matrix.incident };
                (Cells::Patches(basis.clone()), patches(oriented, residual, &light))
            }
            (Table::Tree(_), Columns::Square { side }) => {
                (Cells::Square(*side), squares(oriented, residual, *side, &light))
            }
            (Table::Tree(_), columns) => {
                let rings = columns.len().max(RINGS / 2);
                (Cells::Polar(rings), polar(oriented, residual, rings, &light))
            }
        };
        Self { cells, reversed, values }
    }

    /// Radiance towards `w_in` (unit vector in the BSDF's frame), in the light's unit.
    pub fn radiance(&self, w_in: Vec3) -> Rgb {
        let along = -w_in.truncate();
        let point = if self.reversed { -along } else { along };
        match &self.cells {
            Cells::Patches(basis) => self.values[basis.index(point)],
            Cells::Square(side) => self.values[Columns::Square { side: *side }.index(point)],
            Cells::Polar(rings) => {
                let radius = along.length();
                let ring = ((radius * *rings as f64) as usize).min(rings - 1);
                let turn = along.y.atan2(along.x) / TAU;
                let at = (turn - turn.floor()) * KEPT_AZIMUTHS as f64;
                let (low, share) = ((at as usize).min(KEPT_AZIMUTHS - 1), at.fract());
                let of = |azimuth: usize| self.values[ring * KEPT_AZIMUTHS + azimuth % KEPT_AZIMUTHS];
                of(low) * (1.0 - share) + of(low + 1) * share
            }
        }
    }
}

/// The light at points that stand for equal projected solid angles, and that angle [sr]; in the table's own points.
fn points_of_light(oriented: &Oriented, light: impl Fn(DVec2) -> Rgb) -> Vec<Rgb> {
    let at = |i: usize| (i as f64 + 0.5) / POINTS as f64;
    let sign = if oriented.reversed { -1.0 } else { 1.0 };
    let angle = PI / (POINTS * POINTS) as f64;
    let point = |k: usize| sign * DVec2::from(square_to_disk([at(k / POINTS), at(k % POINTS)]));
    (0..POINTS * POINTS).map(|k| light(point(k)) * angle).collect()
}

fn patches(oriented: &Oriented, residual: bool, light: impl Fn(DVec2) -> Rgb) -> Vec<Rgb> {
    let Table::Matrix(matrix) = oriented.distribution.luminous() else { return Vec::new() };
    let (lit, seen) = if oriented.reversed {
        (&matrix.incident, &matrix.exiting)
    } else {
        (&matrix.exiting, &matrix.incident)
    };
    // Mean radiance of each patch times its exact projected solid angle.
    let (mut sums, mut counts) = (vec![Rgb::ZERO; lit.len()], vec![0.0; lit.len()]);
    for (k, light) in points_of_light(oriented, light).into_iter().enumerate() {
        let at = |i: usize| (i as f64 + 0.5) / POINTS as f64;
        let patch = lit.index(square_to_disk([at(k / POINTS), at(k % POINTS)]).into());
        sums[patch] += light;
        counts[patch] += PI / (POINTS * POINTS) as f64;
    }
    let flux: Vec<Rgb> = (0..lit.len())
        .map(|p| if counts[p] > 0.0 { sums[p] / counts[p] * lit.projected_solid_angle(p) } else { Rgb::ZERO })
        .collect();
    let width = matrix.exiting.len();
    let of = |s: usize, l: usize| {
        let (column, patch) = if oriented.reversed { (l, s) } else { (s, l) };
        oriented.cell_value(column, column * width + patch, residual)
    };
    (0..seen.len()).map(|s| (0..lit.len()).map(|l| of(s, l) * flux[l]).sum()).collect()
}

fn squares(oriented: &Oriented, residual: bool, side: usize, light: impl Fn(DVec2) -> Rgb) -> Vec<Rgb> {
    let (table, columns) = (oriented.distribution.luminous(), oriented.distribution.columns());
    let sums = RunningSums::new(side, &points_of_light(oriented, light));
    if !oriented.reversed {
        let of = |column| {
            let cells = table.cells(columns, column).into_iter();
            cells
                .map(|c| oriented.cell_value(column, c.index, residual) * sums.within(c.square(), side))
                .sum()
        };
        return (0..columns.len()).map(of).collect();
    }
    // Cells of the exiting side in the light of the columns: each adds to all that it covers, by its corners.
    let edge = side + 1;
    let mut corners = vec![Rgb::ZERO; edge * edge];
    for column in 0..columns.len() {
        let flux = sums.cell(column / side, column % side);
        for cell in table.cells(columns, column) {
            let Some([x0, y0, x1, y1]) = bounds(cell.square(), side) else { continue };
            let add = oriented.cell_value(column, cell.index, residual) * flux;
            corners[x0 * edge + y0] += add;
            corners[x1 * edge + y0] -= add;
            corners[x0 * edge + y1] -= add;
            corners[x1 * edge + y1] += add;
        }
    }
    for x in 0..edge {
        for y in 0..edge {
            let left = if x > 0 { corners[(x - 1) * edge + y] } else { Rgb::ZERO };
            let below = if y > 0 { corners[x * edge + y - 1] } else { Rgb::ZERO };
            let both = if x > 0 && y > 0 { corners[(x - 1) * edge + y - 1] } else { Rgb::ZERO };
            corners[x * edge + y] += left + below - both;
        }
    }
    (0..side * side).map(|k| corners[k / side * edge + k % side]).collect()
}

/// Cells of the finest division that a square covers: lower and upper corner.
fn bounds(square: Option<crate::table::CellSquare>, side: usize) -> Option<[usize; 4]> {
    let square = square?;
    let at = |v: f32| (f64::from(v) * side as f64).round() as usize;
    let [x, y] = square.corner;
    Some([at(x), at(y), at(x + square.size), at(y + square.size)])
}

/// Sums of the light over rectangles of the finest cells.
struct RunningSums {
    edge: usize,
    sums: Vec<Rgb>,
}

impl RunningSums {
    fn new(side: usize, points: &[Rgb]) -> Self {
        let edge = side + 1;
        let mut sums = vec![Rgb::ZERO; edge * edge];
        // Where the cells are finer than the points, a point's light is spread over them.
        let parts = side.div_ceil(POINTS);
        let share = 1.0 / (parts * parts) as f64;
        for (k, light) in points.iter().enumerate() {
            for part in 0..parts * parts {
                let at = |i: usize, p: usize| (i * parts + p) * side / (POINTS * parts);
                let (x, y) = (at(k / POINTS, part / parts), at(k % POINTS, part % parts));
                sums[(x + 1) * edge + y + 1] += *light * share;
            }
        }
        for x in 1..edge {
            for y in 1..edge {
                let before = sums[(x - 1) * edge + y] + sums[x * edge + y - 1] - sums[(x - 1) * edge + y - 1];
                sums[x * edge + y] += before;
            }
        }
        Self { edge, sums }
    }

    fn within(&self, square: Option<crate::table::CellSquare>, side: usize) -> Rgb {
        let Some([x0, y0, x1, y1]) = bounds(square, side) else { return Rgb::ZERO };
        let at = |x: usize, y: usize| self.sums[x * self.edge + y];
        at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0)
    }

    fn cell(&self, x: usize, y: usize) -> Rgb {
        let at = |x: usize, y: usize| self.sums[x * self.edge + y];
        at(x + 1, y + 1) - at(x, y + 1) - at(x + 1, y) + at(x, y)
    }
}

/// For the middle of each ring and each kept azimuth of the incident point.
fn polar(oriented: &Oriented, residual: bool, rings: usize, light: impl Fn(DVec2) -> Rgb) -> Vec<Rgb> {
    // Exiting points in rings of equal width, fine in the middle, where the horizon often is.
    // Twice around, so that a turned ring is one stretch.
    let mut lights = [const { Vec::new() }; 3];
    for ring in 0..RINGS {
        let angle = bin_angle(ring);
        for k in 0..AZIMUTHS {
            let light = light(point(ring as f64 + 0.5, k as f64 + 0.5)) * angle;
            lights.iter_mut().zip(light.to_array()).for_each(|(channel, value)| channel.push(value));
        }
        lights.iter_mut().for_each(|channel| channel.extend_from_within(channel.len() - AZIMUTHS..));
    }
    let bins = if oriented.reversed { Vec::new() } else { bins_of_parts() };
    let step = AZIMUTHS / KEPT_AZIMUTHS;
    let mut values = Vec::with_capacity(rings * KEPT_AZIMUTHS);
    for ring in 0..rings {
        let p_in = DVec2::new((ring as f64 + 0.5) / rings as f64, 0.0);
        let table = if oriented.reversed {
            looked_at(oriented, residual, p_in)
        } else {
            flux(oriented, residual, p_in, &bins)
        };
        let channels: [Vec<f64>; 3] = std::array::from_fn(|c| table.iter().map(|v| v[c]).collect());
        for turn in 0..KEPT_AZIMUTHS {
            let sum = |c: usize| -> f64 {
                let rows = channels[c].chunks_exact(AZIMUTHS).zip(lights[c].chunks_exact(2 * AZIMUTHS));
                rows.map(|(values, lights)| dot(values, &lights[turn * step..])).sum()
            };
            values.push(Rgb::new(sum(0), sum(1), sum(2)));
        }
    }
    values
}

/// A point of the exiting disk.
fn point(ring: f64, azimuth: f64) -> DVec2 {
    DVec2::from_angle(azimuth * TAU / AZIMUTHS as f64) * (ring / RINGS as f64)
}

/// Projected solid angle of each bin of a ring [sr].
fn bin_angle(ring: usize) -> f64 {
    PI * (2 * ring + 1) as f64 / (RINGS * RINGS * AZIMUTHS) as f64
}

/// The bin of a point of the exiting disk.
fn bin_at(point: DVec2) -> usize {
    let ring = ((point.length() * RINGS as f64) as usize).min(RINGS - 1);
    let turn = point.y.atan2(point.x) / TAU;
    let azimuth = (((turn - turn.floor()) * AZIMUTHS as f64) as usize).min(AZIMUTHS - 1);
    ring * AZIMUTHS + azimuth
}

/// The bins of the middles of all parts of the square.
fn bins_of_parts() -> Vec<usize> {
    let at = |i: usize| (i as f64 + 0.5) / PARTS as f64;
    (0..PARTS * PARTS).map(|k| bin_at(square_to_disk([at(k / PARTS), at(k % PARTS)]).into())).collect()
}

/// Mean values in the bins, by what each cell of the column scatters into them: no flux is lost, however small a cell is.
/// `bins` are those of the parts.
fn flux(oriented: &Oriented, residual: bool, p_in: DVec2, bins: &[usize]) -> Vec<Rgb> {
    let (table, columns) = (oriented.distribution.luminous(), oriented.distribution.columns());
    let column = columns.index(p_in);
    let mut sums = vec![Rgb::ZERO; RINGS * AZIMUTHS];
    for cell in table.cells(columns, column) {
        let flux = oriented.cell_value(column, cell.index, residual) * cell.projected_solid_angle;
        // A power of two of parts, or smaller than one.
        let square = cell.square().filter(|square| square.size * PARTS as f32 >= 1.0);
        match bounds(square, PARTS) {
            Some([x0, y0, x1, y1]) => {
                let share = flux / ((x1 - x0) * (y1 - y0)) as f64;
                for x in x0..x1 {
                    bins[x * PARTS + y0..x * PARTS + y1].iter().for_each(|&bin| sums[bin] += share);
                }
            }
            None => sums[bin_at(table.point(&cell, [0.5, 0.5]))] += flux,
        }
    }
    sums.iter().enumerate().map(|(bin, &sum)| sum / bin_angle(bin / AZIMUTHS)).collect()
}

/// Mean values in the bins by looking at points of them: against the table's direction cells of the exiting side are no columns.
fn looked_at(oriented: &Oriented, residual: bool, p_in: DVec2) -> Vec<Rgb> {
    let side = 1.0 / oriented.distribution.smallest_projected_solid_angle().max(1e-9).sqrt();
    let looks = ((side / LOOKS_PER_SIDE).ceil() as usize).clamp(2, MOST_LOOKS);
    let bin = |i: usize| {
        let look = |n: usize| {
            let within = |k: usize| (k as f64 + 0.5) / looks as f64;
            let p_out =
                point((i / AZIMUTHS) as f64 + within(n / looks), (i % AZIMUTHS) as f64 + within(n % looks));
            oriented.value(p_in, p_out, residual)
        };
        (0..looks * looks).map(look).sum::<Rgb>() / (looks * looks) as f64
    };
    (0..RINGS * AZIMUTHS).map(bin).collect()
}

/// In lanes, so that it is done several at a time.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        lanes.iter_mut().zip(a.iter().zip(b)).for_each(|(lane, (a, b))| *lane += a * b);
    }
    lanes.iter().sum()
}

#[cfg(test)]
mod tests;
