//! Averages over the cells of a division: of panes, of a shade's residual.

use super::shade::{Range, Shade};
use crate::table::Columns;
use glam::DVec2;
use ndarray::Array2;
use rayon::prelude::*;

/// Points a side over which what goes straight is averaged: it is smooth but for the edge of the hemisphere and cut-offs.
pub const STRAIGHT_POINTS: usize = 16;

/// Points a side over which a residual is averaged, incident and exiting.
const RESIDUAL_POINTS: usize = 3;

/// A division for incident and exiting light alike, and the points of its cells.
pub struct Cells {
    /// The division.
    pub division: Columns,
}

impl Cells {
    /// How many.
    pub fn len(&self) -> usize {
        self.division.len()
    }

    /// Share of the flux that a shade scatters from each cell into each other, by the sides where it comes from and goes to.
    pub fn residual(&self, shade: &Shade, range: Range) -> [[Array2<f64>; 2]; 2] {
        let n = if self.has_tables_of(shade) { 1 } else { RESIDUAL_POINTS };
        let points: Vec<Vec<DVec2>> = (0..self.len()).map(|cell| self.division.points(cell, n)).collect();
        let between = |from: usize, to: usize| {
            let columns: Vec<Vec<f64>> = points
                .par_iter()
                .map(|incident| {
                    let mean = |exiting: &Vec<DVec2>| {
                        let pairs = incident.iter().flat_map(|&p| exiting.iter().map(move |&q| (p, q)));
                        let sum: f64 = pairs.map(|(p, q)| shade.residual(range, from, to, p, q)).sum();
                        sum / (incident.len() * exiting.len()) as f64
                    };
                    let flux = |(cell, exiting)| mean(exiting) * self.division.projected_solid_angle(cell);
                    points.iter().enumerate().map(flux).collect()
                })
                .collect();
            Array2::from_shape_fn((points.len(), points.len()), |(o, i)| columns[i][o])
        };
        [[between(0, 0), between(0, 1)], [between(1, 0), between(1, 1)]]
    }

    /// Is the shade tabulated in these very patches?
    fn has_tables_of(&self, shade: &Shade) -> bool {
        let bsdfs = [Some(&shade.visible), shade.solar.as_ref()];
        matches!(self.division, Columns::Patches(_))
            && bsdfs.into_iter().flatten().all(|bsdf| bsdf.is_tabulated_in(&self.division))
    }
}
