//! Sampling against an isotropic tree: turning with the incidence cuts across its cells, so that a proposal is made of point
//! samples, with a small uniform share, so that no direction is left out and weights stay bounded.

use super::{Target, shares::Shares};
use crate::table::{Columns, turned, turned_back};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Rgb, warp::square_to_disk};

/// Most columns, and most cells a side of the exiting square.
const MAX_COLUMNS: usize = 128;
const MAX_SIDE: usize = 64;

/// Uniform share.
const UNIFORM_SHARE: f64 = 0.05;

/// Where a cell is looked at, in each coordinate.
const POINTS: [f64; 2] = [0.25, 0.75];

/// A grid of point samples, turning with the incidence.
#[derive(Debug)]
pub struct Points {
    target: Target,
    columns: Columns,
    side: usize,
}

impl Points {
    /// For a tree of `side` cells a side.
    pub fn new(target: &Target, side: usize) -> Self {
        let columns = Columns::Radial { side: side.min(2 * MAX_COLUMNS) };
        Self { target: target.clone(), columns, side: side.min(MAX_SIDE) }
    }

    /// How many columns.
    pub fn columns(&self) -> usize {
        self.columns.len()
    }

    /// The column of an incident point.
    pub fn column(&self, p_in: DVec2) -> usize {
        self.columns.index(p_in)
    }

    /// Cells in a column.
    pub fn blocks(&self) -> usize {
        self.side * self.side
    }

    fn cell_point(&self, cell: usize, [u, v]: [f64; 2], p_in: DVec2) -> DVec2 {
        let at = |cell: usize, u: f64| (cell as f64 + u) / self.side as f64;
        turned_back(p_in, square_to_disk([at(cell / self.side, u), at(cell % self.side, v)]).into())
    }

    /// The flux of each cell [-], with its number.
    pub fn for_each_flux(&self, column: usize, mut visit: impl FnMut(usize, Rgb)) {
        let squares = || POINTS.into_iter().flat_map(|u| POINTS.into_iter().map(move |v| [u, v]));
        let incident: Vec<DVec2> = squares().map(|u| self.columns.point(column, u)).collect();
        let area = PI / self.blocks() as f64;
        for cell in 0..self.blocks() {
            let mut sum = Rgb::ZERO;
            for &p_in in &incident {
                for u in squares() {
                    let p_out = self.cell_point(cell, u, p_in);
                    sum += self.target.oriented.value(p_in, p_out, self.target.residual);
                }
            }
            visit(cell, sum * area / POINTS.len().pow(4) as f64);
        }
    }

    /// A point: mostly in proportion to the cells.
    pub fn point(&self, shares: &Shares, p_in: DVec2, column: usize, [pick, u, v]: [f64; 3]) -> DVec2 {
        if pick < UNIFORM_SHARE {
            return square_to_disk([u, v]).into();
        }
        let cell = shares.pick(column, (pick - UNIFORM_SHARE) / (1.0 - UNIFORM_SHARE));
        self.cell_point(cell, [u, v], p_in)
    }

    /// Density in projected solid angle [1/sr].
    pub fn density(&self, shares: &Shares, p_in: DVec2, column: usize, p_out: DVec2) -> f64 {
        let cell = Columns::Square { side: self.side }.index(turned(p_in, p_out));
        let share = shares.share(column, cell);
        (1.0 - UNIFORM_SHARE) * share * self.blocks() as f64 / PI + UNIFORM_SHARE / PI
    }
}
