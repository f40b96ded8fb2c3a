//! Sampling a table: for each column a cumulative distribution over its cells.
//!
//! Where light is traced the way the table was written, cells and values are the table's own and sampling is exactly in
//! proportion to value times projected solid angle. Where it is traced against it (by reciprocity), rows become columns:
//! exact again for matrices and for anisotropic trees up to a size; else a proposal made of point samples with a small uniform share, so that
//! no direction is left out and weights stay bounded.

use crate::{
    basis::AngleBasis,
    distribution::Distribution,
    table::{CellSquare, Columns, Table, turned_back},
};
use glam::DVec2;
use rayon::prelude::*;
use std::{f64::consts::PI, sync::Arc};
use sunpeak_core::{Rgb, luminance, warp::square_to_disk};

/// Largest number of columns, and of exiting cells, a side in a proposal against a tree's own direction.
const MAX_REVERSED: usize = 64;

/// Uniform share of a proposal that is not exact.
const UNIFORM_SHARE: f64 = 0.05;

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

    /// Through transmittance [-] by the split.
    pub fn through(&self, p_in: DVec2) -> Rgb {
        let (a, _) = self.points(p_in, p_in);
        self.distribution.split().through(self.distribution.columns(), a)
    }
}

/// How to sample the exiting point for an incident point.
#[derive(Debug)]
pub struct Proposal {
    columns: Columns,
    cells: Cells,
    /// Upper ends of the cells' shares of one, for each column.
    cumulative: Vec<Vec<f32>>,
    /// Hemispherical value [-] of each column.
    hemispherical: Vec<Rgb>,
    /// In proportion to the values themselves?
    exact: bool,
    reversed: bool,
}

#[derive(Debug)]
enum Cells {
    Patches(Arc<AngleBasis>),
    /// Squares of each column.
    Leaves(Vec<Vec<CellSquare>>),
    Grid(usize),
}

/// A sampled exiting point.
pub struct Sampled {
    /// On the disk.
    pub p_out: DVec2,
    /// Density in projected solid angle [1/sr].
    pub density: f64,
}

impl Proposal {
    /// For the table or, `residual`, for what the split left of it.
    pub fn new(oriented: &Oriented, residual: bool) -> Self {
        if oriented.reversed { Self::against(oriented, residual) } else { Self::along(oriented, residual) }
    }

    fn along(oriented: &Oriented, residual: bool) -> Self {
        let d = &*oriented.distribution;
        let (table, columns) = (d.luminous(), d.columns().clone());
        let each: Vec<_> = (0..columns.len())
            .into_par_iter()
            .map(|column| {
                let cells = table.cells(&columns, column);
                let mut hemispherical = Rgb::ZERO;
                let weights: Vec<f64> = cells
                    .iter()
                    .map(|c| {
                        let surround = if residual { d.split().surround(column, c.index) } else { None };
                        let value = surround.unwrap_or_else(|| d.at_index(c.index));
                        hemispherical += value * c.projected_solid_angle;
                        luminance(value) * c.projected_solid_angle
                    })
                    .collect();
                let squares: Vec<CellSquare> = cells.iter().filter_map(|c| c.square()).collect();
                (squares, cumulate(&weights), hemispherical)
            })
            .collect();
        let mut leaves = Vec::new();
        let (mut cumulative, mut hemispherical) = (Vec::new(), Vec::new());
        for (squares, shares, total) in each {
            leaves.push(squares);
            cumulative.push(shares);
            hemispherical.push(total);
        }
        let cells = match table {
            Table::Matrix(m) => Cells::Patches(m.exiting.clone()),
            Table::Tree(_) => Cells::Leaves(leaves),
        };
        Self { columns, cells, cumulative, hemispherical, exact: true, reversed: false }
    }

    fn against(oriented: &Oriented, residual: bool) -> Self {
        // A tree's proposal is never exact: a point on the border of two cells falls to one side here, to the other there.
        let (columns, cells, exact) =
            match (oriented.distribution.luminous(), oriented.distribution.columns()) {
                (Table::Matrix(m), _) => {
                    (Columns::Patches(m.exiting.clone()), Cells::Patches(m.incident.clone()), true)
                }
                (_, Columns::Radial { side }) => {
                    (Columns::Radial { side: *side }, Cells::Grid((*side).min(MAX_REVERSED)), false)
                }
                (_, Columns::Square { side }) => {
                    let side = (*side).min(MAX_REVERSED);
                    (Columns::Square { side }, Cells::Grid(side), false)
                }
                (Table::Tree(_), Columns::Patches(_)) => unreachable!("trees have no patches"),
            };
        // One point where the table is constant over column and cell.
        let constant = match oriented.distribution.columns() {
            Columns::Patches(_) => true,
            Columns::Square { side } => *side <= MAX_REVERSED,
            Columns::Radial { .. } => false,
        };
        let points: &[f64] = if constant { &[0.5] } else { &[0.25, 0.75] };
        let (cumulative, hemispherical) = (Vec::new(), Vec::new());
        let mut proposal = Self { columns, cells, cumulative, hemispherical, exact, reversed: true };
        let each: Vec<_> = (0..proposal.columns.len())
            .into_par_iter()
            .map(|column| {
                let mut total = Rgb::ZERO;
                let weights: Vec<f64> = (0..proposal.cell_count(column))
                    .map(|cell| {
                        let mean = proposal.mean_value(oriented, residual, column, cell, points);
                        let flux = mean * proposal.cell_area(column, cell);
                        total += flux;
                        luminance(flux)
                    })
                    .collect();
                (cumulate(&weights), total)
            })
            .collect();
        (proposal.cumulative, proposal.hemispherical) = each.into_iter().unzip();
        proposal
    }

    /// Mean value [1/sr] over a column and a cell, by the product of `points` in all four coordinates.
    fn mean_value(
        &self,
        oriented: &Oriented,
        residual: bool,
        column: usize,
        cell: usize,
        points: &[f64],
    ) -> Rgb {
        let squares = || points.iter().flat_map(|&u| points.iter().map(move |&v| [u, v]));
        let mut sum = Rgb::ZERO;
        for u in squares() {
            let p_in = self.facing(self.columns.point(column, u));
            for v in squares() {
                sum += oriented.value(p_in, self.cell_point(column, cell, v, p_in), residual);
            }
        }
        sum / (points.len() as f64).powi(4)
    }

    /// Against the table, patches are those of the opposite side: turned by half a circle. Trees are symmetric in it.
    fn facing(&self, p: DVec2) -> DVec2 {
        if self.reversed && matches!(self.columns, Columns::Patches(_)) { -p } else { p }
    }

    fn column(&self, p_in: DVec2) -> usize {
        self.columns.index(self.facing(p_in))
    }

    fn cell_count(&self, column: usize) -> usize {
        match &self.cells {
            Cells::Patches(basis) => basis.len(),
            Cells::Leaves(leaves) => leaves[column].len(),
            Cells::Grid(side) => side * side,
        }
    }

    fn cell_area(&self, column: usize, cell: usize) -> f64 {
        match &self.cells {
            Cells::Patches(basis) => basis.projected_solid_angle(cell),
            Cells::Leaves(leaves) => PI * f64::from(leaves[column][cell].size).powi(2),
            Cells::Grid(side) => PI / (side * side) as f64,
        }
    }

    fn cell_point(&self, column: usize, cell: usize, u: [f64; 2], p_in: DVec2) -> DVec2 {
        let p: DVec2 = match &self.cells {
            Cells::Patches(basis) => return self.facing(basis.point(cell, u)),
            Cells::Leaves(leaves) => {
                let CellSquare { corner, size } = leaves[column][cell];
                let at = |k: usize| f64::from(corner[k]) + u[k] * f64::from(size);
                square_to_disk([at(0), at(1)]).into()
            }
            Cells::Grid(side) => {
                let at = |cell: usize, u: f64| (cell as f64 + u) / *side as f64;
                square_to_disk([at(cell / side, u[0]), at(cell % side, u[1])]).into()
            }
        };
        if matches!(self.columns, Columns::Radial { .. }) { turned_back(p_in, p) } else { p }
    }

    /// Hemispherical reflectance or transmittance [-].
    pub fn hemispherical(&self, p_in: DVec2) -> Rgb {
        self.hemispherical[self.column(p_in)]
    }

    /// Sample the exiting point; `None` if nothing exits. `value` is the luminous value [1/sr] there.
    pub fn sample(&self, p_in: DVec2, u: [f64; 3], value: impl Fn(DVec2) -> f64) -> Option<Sampled> {
        let column = self.column(p_in);
        let total = luminance(self.hemispherical[column]);
        let shares = &self.cumulative[column];
        if total <= 0.0 || shares.is_empty() {
            return None;
        }
        let mut pick = u[0];
        let p_out = if !self.exact && pick < UNIFORM_SHARE {
            square_to_disk([u[1], u[2]]).into()
        } else {
            if !self.exact {
                pick = (pick - UNIFORM_SHARE) / (1.0 - UNIFORM_SHARE);
            }
            let cell = shares.partition_point(|&c| f64::from(c) <= pick).min(last_filled(shares));
            self.cell_point(column, cell, [u[1], u[2]], p_in)
        };
        let density = self.density(p_in, p_out, value(p_out));
        (density > 0.0).then_some(Sampled { p_out, density })
    }

    /// Density in projected solid angle [1/sr] of a sample at `p_out`, where the luminous value is `value` [1/sr].
    pub fn density(&self, p_in: DVec2, p_out: DVec2, value: f64) -> f64 {
        let column = self.column(p_in);
        let total = luminance(self.hemispherical[column]);
        if total <= 0.0 {
            return 0.0;
        }
        if self.exact {
            return value / total;
        }
        let Cells::Grid(side) = self.cells else { return 0.0 };
        let p = if matches!(self.columns, Columns::Radial { .. }) {
            crate::table::turned(p_in, p_out)
        } else {
            p_out
        };
        let cell = Columns::Square { side }.index(p);
        let shares = &self.cumulative[column];
        let below = if cell == 0 { 0.0 } else { shares[cell - 1] };
        let share = f64::from(shares[cell] - below);
        (1.0 - UNIFORM_SHARE) * share / self.cell_area(column, cell) + UNIFORM_SHARE / PI
    }
}

/// The last cell with a share of its own: rounding must not lead into an empty one.
fn last_filled(shares: &[f32]) -> usize {
    let top = shares[shares.len() - 1];
    shares.partition_point(|&c| c < top)
}

fn cumulate(weights: &[f64]) -> Vec<f32> {
    let total: f64 = weights.iter().sum();
    let mut sum = 0.0;
    weights
        .iter()
        .map(|w| {
            sum += w;
            if total > 0.0 { (sum / total) as f32 } else { 0.0 }
        })
        .collect()
}
