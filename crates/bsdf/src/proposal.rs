//! Sampling a table: for each column a cumulative distribution over blocks of its cells, and within a block a search.
//!
//! Cells and values are the table's own, and what is stored beside it does not grow with it: shares of blocks and their guide, at
//! most a third of a byte a value past 1.3 megabytes. Sampling is exactly in proportion to value times projected solid angle, along
//! the table and, where it serves by reciprocity, against it; only an isotropic tree against its direction has a proposal made of
//! point samples.

mod leaves;
mod patches;
mod points;
mod shares;

use crate::{distribution::Distribution, table::Table};
use glam::DVec2;
use leaves::Leaves;
use patches::Patches;
use points::Points;
use rayon::prelude::*;
use shares::Shares;
use std::sync::Arc;
use sunpeak_core::{Rgb, luminance};

/// Blocks of a proposal, in all columns together: so many in any case, or one for so many values.
const LEAST_BLOCKS: usize = 1 << 18;
const VALUES_A_BLOCK: usize = 16;

fn most_blocks(values: usize) -> usize {
    LEAST_BLOCKS.max(values / VALUES_A_BLOCK)
}

/// A distribution seen in the direction in which rays are traced.
#[derive(Clone, Debug)]
pub struct Oriented {
    /// The table.
    pub distribution: Arc<Distribution>,
    /// Traced against the table: the traced ray's side is the table's exiting side.
    pub reversed: bool,
}

impl Oriented {
    /// The table's own points for the traced ray's ones.
    pub fn points(&self, p_in: DVec2, p_out: DVec2) -> (DVec2, DVec2) {
        if self.reversed { (-p_out, -p_in) } else { (p_in, p_out) }
    }

    /// Value or residual [1/sr].
    pub fn value(&self, p_in: DVec2, p_out: DVec2, residual: bool) -> Rgb {
        let (a, b) = self.points(p_in, p_out);
        if residual { self.distribution.residual(a, b) } else { self.distribution.value(a, b) }
    }

    /// Value or residual [1/sr] of a cell in a column of the table.
    pub fn cell_value(&self, column: usize, index: usize, residual: bool) -> Rgb {
        let surround = if residual { self.distribution.split().surround(column, index) } else { None };
        surround.unwrap_or_else(|| self.distribution.at_index(index))
    }

    /// Through transmittance [-] by the split.
    pub fn through(&self, p_in: DVec2) -> Rgb {
        let (a, _) = self.points(p_in, p_in);
        self.distribution.split().through(self.distribution.columns(), a)
    }
}

/// What is sampled: a table or, `residual`, what the split left of it.
#[derive(Clone, Debug)]
struct Target {
    oriented: Oriented,
    residual: bool,
}

impl Target {
    /// The value of a cell in a column of the table [1/sr].
    fn value(&self, column: usize, index: usize) -> Rgb {
        self.oriented.cell_value(column, index, self.residual)
    }
}

/// One of several by their weights, as they come; a single random number decides.
struct Choice<T> {
    u: f64,
    sum: f64,
    taken: Option<T>,
}

impl<T> Choice<T> {
    fn new(u: f64) -> Self {
        Self { u, sum: 0.0, taken: None }
    }

    /// The new one takes the place of those before with the chance `weight / sum`; what is left of the number is uniform again.
    fn offer(&mut self, weight: f64, item: T) {
        if weight <= 0.0 {
            return;
        }
        self.sum += weight;
        let chance = weight / self.sum;
        if self.u < chance {
            self.u /= chance;
            self.taken = Some(item);
        } else {
            self.u = (self.u - chance) / (1.0 - chance);
        }
    }

    fn taken(self) -> Option<T> {
        self.taken
    }
}

/// How to sample the exiting point for an incident point.
#[derive(Debug)]
pub struct Proposal {
    target: Target,
    cells: Cells,
    shares: Shares,
    /// Hemispherical value [-] of each column, and the luminous one.
    hemispherical: Vec<Rgb>,
    luminous: Vec<f64>,
}

#[derive(Debug)]
enum Cells {
    Patches(Patches),
    Leaves(Leaves),
    Points(Points),
}

/// A sampled exiting point.
pub struct Sampled {
    /// On the disk.
    pub p_out: DVec2,
    /// Density in projected solid angle [1/sr].
    pub density: f64,
    /// Value there [1/sr].
    pub value: Rgb,
}

impl Proposal {
    /// For the table or, `residual`, for what the split left of it.
    pub fn new(oriented: &Oriented, residual: bool) -> Self {
        let target = Target { oriented: oriented.clone(), residual };
        let cells = match oriented.distribution.luminous() {
            Table::Matrix(m) => Cells::Patches(Patches::new(&target, m)),
            Table::Tree(tree) => match Leaves::new(&target) {
                Some(leaves) => Cells::Leaves(leaves),
                None => Cells::Points(Points::new(&target, (1.0 / tree.smallest()).round() as usize)),
            },
        };
        let (ends, hemispherical): (Vec<_>, Vec<_>) =
            (0..cells.columns()).into_par_iter().map(|column| cells.sums(column)).unzip();
        let shares = Shares::new(cells.blocks(), ends);
        let luminous = hemispherical.iter().map(|&h| luminance(h)).collect();
        Self { target, cells, shares, hemispherical, luminous }
    }

    /// The column of an incident point: what the other questions are asked with.
    pub fn column(&self, p_in: DVec2) -> usize {
        self.cells.column(p_in)
    }

    /// Hemispherical reflectance or transmittance [-] of a column.
    pub fn hemispherical(&self, column: usize) -> Rgb {
        self.hemispherical[column]
    }

    /// Luminous hemispherical value [-] of a column.
    pub fn luminous(&self, column: usize) -> f64 {
        self.luminous[column]
    }

    /// Sample the exiting point for an incident point and its column; `None` if nothing exits. `u` is uniform in the unit cube.
    #[inline]
    pub fn sample(&self, p_in: DVec2, column: usize, u: [f64; 3]) -> Option<Sampled> {
        let total = self.luminous[column];
        if total <= 0.0 {
            return None;
        }
        let (p_out, value) = match &self.cells {
            Cells::Patches(patches) => {
                let block = self.shares.pick(column, u[0]);
                let rest = || self.shares.rest(column, block, u[0]);
                patches.point(column, block, rest, [u[1], u[2]])?
            }
            Cells::Leaves(leaves) => {
                let block = self.shares.pick(column, u[0]);
                let rest = || self.shares.rest(column, block, u[0]);
                leaves.point(p_in, column, block, rest, [u[1], u[2]])?
            }
            Cells::Points(points) => (points.point(&self.shares, p_in, column, u), None),
        };
        let known = value.is_some();
        let value = value.unwrap_or_else(|| self.target.oriented.value(p_in, p_out, self.target.residual));
        let y = luminance(value);
        let density = if known { y / total } else { self.density_in(column, total, p_in, p_out, y) };
        (density > 0.0).then_some(Sampled { p_out, density, value })
    }

    /// Density in projected solid angle [1/sr] of a sample at `p_out`, where the luminous value is `value` [1/sr].
    pub fn density(&self, p_in: DVec2, column: usize, p_out: DVec2, value: f64) -> f64 {
        let total = self.luminous[column];
        if total > 0.0 { self.density_in(column, total, p_in, p_out, value) } else { 0.0 }
    }

    fn density_in(&self, column: usize, total: f64, p_in: DVec2, p_out: DVec2, value: f64) -> f64 {
        match &self.cells {
            Cells::Patches(_) => value / total,
            Cells::Leaves(leaves) => leaves.sampled_value(p_in, p_out, value) / total,
            Cells::Points(points) => points.density(&self.shares, p_in, column, p_out),
        }
    }
}

impl Cells {
    fn columns(&self) -> usize {
        match self {
            Self::Patches(c) => c.columns(),
            Self::Leaves(c) => c.columns(),
            Self::Points(c) => c.columns(),
        }
    }

    fn column(&self, p_in: DVec2) -> usize {
        match self {
            Self::Patches(c) => c.column(p_in),
            Self::Leaves(c) => c.column(p_in),
            Self::Points(c) => c.column(p_in),
        }
    }

    /// In each column.
    fn blocks(&self) -> usize {
        match self {
            Self::Patches(c) => c.blocks(),
            Self::Leaves(c) => c.blocks(),
            Self::Points(c) => c.blocks(),
        }
    }

    /// A column's shares, and its hemispherical value.
    fn sums(&self, column: usize) -> (Vec<u32>, Rgb) {
        let mut weights = vec![0.0; self.blocks()];
        let mut total = Rgb::ZERO;
        let visit = |block: usize, flux: Rgb| {
            weights[block] += luminance(flux);
            total += flux;
        };
        match self {
            Self::Patches(c) => c.for_each_flux(column, visit),
            Self::Leaves(c) => c.for_each_flux(column, visit),
            Self::Points(c) => c.for_each_flux(column, visit),
        }
        (Shares::ends(&weights), total)
    }
}
