//! Tables from counted rays: scattered light by cells with its errors, and what went straight apart from it.
//!
//! A virtual goniophotometer knows which light went straight. So a [`Distribution`] made here has the straight light in its
//! cells, as any file, and beside it the exact split: nothing has to be found.

mod reciprocity;

pub use reciprocity::{average_sides, average_within};

use crate::{
    distribution::Distribution,
    peak::{ColumnPeak, Part, Split},
    synthetic::Basis,
    table::{Columns, Matrix, Table},
    tree::{Regular, Tree},
};
use glam::DVec2;
use sunpeak_core::{Rgb, gray, luminance, rgb_to_xyz, xyz_to_rgb};

/// Standard errors to each side of a 95 % interval.
const NINETY_FIVE: f64 = 1.96;

/// Off the border of two rows, along which the straight direction runs in isotropic trees.
const BESIDE: f64 = 1e-9;

/// One mode of one side as it was counted: `columns * cells` values, one column after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Counted {
    /// The basis of the columns and cells.
    pub basis: Basis,
    /// Scattered light [1/sr], luminous.
    pub luminous: Vec<f32>,
    /// Its CIE X and Z.
    pub color: Option<[Vec<f32>; 2]>,
    /// Standard error of the luminous values [1/sr].
    pub error: Vec<f32>,
    /// By column: how many rays were counted.
    pub rays: Vec<f64>,
    /// By column: standard error of the hemispherical scattered value [-].
    pub whole_error: Vec<f64>,
    /// By column: what goes straight through [-]; empty for reflection.
    pub through: Vec<Rgb>,
    /// By column: its standard error [-], luminous.
    pub through_error: Vec<f64>,
}

impl Counted {
    fn width(&self) -> usize {
        self.luminous.len() / self.rays.len().max(1)
    }

    /// Hemispherical scattered transmittance or reflectance [-] of a column.
    pub fn scattered(&self, column: usize) -> f64 {
        let [_, exiting] = self.basis.divisions();
        self.scattered_in(&exiting, column)
    }

    fn scattered_in(&self, exiting: &Columns, column: usize) -> f64 {
        let width = self.width();
        let own = &self.luminous[column * width..(column + 1) * width];
        own.iter().enumerate().map(|(o, &v)| f64::from(v) * exiting.projected_solid_angle(o)).sum()
    }

    /// The table with its split. Cells of a tree that differ by no more than `tolerance` (relative), or by no more than their errors
    /// explain, come together; cells that light goes straight into stay.
    pub fn distribution(&self, tolerance: f64) -> Distribution {
        let [incident, exiting] = self.basis.divisions();
        let hit: Vec<Vec<usize>> = (0..self.through.len())
            .map(|c| if self.is_through(c) { straight_cells(&incident, &exiting, c) } else { Vec::new() })
            .collect();
        let (table, color) = self.table(tolerance, &hit);
        if hit.iter().all(Vec::is_empty) {
            return Distribution::new(table, color);
        }
        self.with_peaks(table, color, &incident, &exiting, &hit)
    }

    fn is_through(&self, column: usize) -> bool {
        luminance(self.through[column]) > 0.0
    }

    /// The scattered light as a table.
    fn table(&self, tolerance: f64, hit: &[Vec<usize>]) -> (Table, Option<[Vec<f32>; 2]>) {
        let (rank, side) = match self.basis {
            Basis::TensorTree3 { side } => (3, side),
            Basis::TensorTree4 { side } => (4, side),
            Basis::KlemsFull | Basis::KlemsHalf | Basis::KlemsQuarter => {
                return (self.matrix(), self.color.clone());
            }
        };
        let mut planes = vec![self.luminous.clone()];
        planes.extend(self.color.iter().flatten().cloned());
        let mut error = self.error.clone();
        if rank == 3 {
            // The second half of an isotropic tree is not used: as its first, so that it costs no cells.
            let mirrored = |values: &mut Vec<f32>| {
                let last = values[values.len() - side * side..].to_vec();
                (0..side / 2).for_each(|_| values.extend_from_slice(&last));
            };
            planes.iter_mut().for_each(mirrored);
            mirrored(&mut error);
        }
        let width = self.width();
        let regular = Regular {
            rank,
            log2: side.trailing_zeros() as u8,
            planes: &planes,
            error: &error,
            is_kept: &|at| hit.get(at / width).is_some_and(|cells| cells.contains(&(at % width))),
            tolerance,
        };
        let mut trees = regular.reduced().into_iter();
        let luminous = trees.next().unwrap_or_else(|| Tree::regular(rank, 0, |_| 0.0));
        let color =
            self.color.is_some().then(|| [0, 1].map(|_| trees.next().map_or(Vec::new(), Tree::into_values)));
        (Table::Tree(luminous), color)
    }

    fn matrix(&self) -> Table {
        let [incident, exiting] = self.basis.divisions().map(|columns| match columns {
            Columns::Patches(basis) => Some(basis),
            _ => None,
        });
        match (incident, exiting) {
            (Some(incident), Some(exiting)) => {
                Table::Matrix(Matrix { incident, exiting, values: self.luminous.clone() })
            }
            _ => Table::Tree(Tree::regular(4, 0, |_| 0.0)),
        }
    }

    /// Put the straight light into its cells, and say what it was.
    fn with_peaks(
        &self,
        table: Table,
        mut color: Option<[Vec<f32>; 2]>,
        incident: &Columns,
        exiting: &Columns,
        hit: &[Vec<usize>],
    ) -> Distribution {
        let mut values = table.values().to_vec();
        let mut parts: Vec<Part> = Vec::with_capacity(hit.len());
        for (column, cells) in hit.iter().enumerate() {
            let through = self.through[column];
            let xyz = rgb_to_xyz(through);
            let (mut lowered, mut under) = (Vec::new(), 0.0);
            for &cell in cells {
                let index = table.index(inner(incident, column), inner(exiting, cell));
                let area = exiting.projected_solid_angle(cell) * cells.len() as f64;
                let y = f64::from(values[index]);
                under += y * area / cells.len() as f64;
                let surround = color.as_ref().map_or(gray(y), |[x, z]| {
                    xyz_to_rgb([f64::from(x[index]), y, f64::from(z[index])].into()).max(Rgb::ZERO)
                });
                lowered.push((index, surround));
                values[index] += (luminance(through) / area) as f32;
                if let Some([x, z]) = &mut color {
                    x[index] += (xyz.x / area) as f32;
                    z[index] += (xyz.z / area) as f32;
                }
            }
            parts.push((self.peak(column, under), lowered));
        }
        let table = table.with_values(values).unwrap_or(table);
        Distribution::with_known_split(table, color, |columns| Split::from_parts(columns, parts, None))
    }

    fn peak(&self, column: usize, under: f64) -> ColumnPeak {
        let (rgb, error) = (self.through[column], self.through_error[column]);
        let through = luminance(rgb);
        ColumnPeak {
            through: rgb,
            contrast: if through > 0.0 { through / under } else { 0.0 },
            detection_limit: NINETY_FIVE * error,
            interval: [(through - NINETY_FIVE * error).max(0.0), through + NINETY_FIVE * error],
            lobe_sigma: 0.0,
        }
    }
}

/// The exiting cells that the straight direction of a column falls into.
fn straight_cells(incident: &Columns, exiting: &Columns, column: usize) -> Vec<usize> {
    let middle = incident.point(column, [0.5, 0.5]);
    match incident {
        Columns::Radial { .. } => {
            [-BESIDE, BESIDE].map(|y| exiting.index(middle + DVec2::new(0.0, y))).to_vec()
        }
        _ => vec![exiting.index(middle)],
    }
}

/// A point in a cell.
fn inner(columns: &Columns, cell: usize) -> DVec2 {
    columns.point(cell, [0.5, 0.5])
}

#[cfg(test)]
mod tests;
