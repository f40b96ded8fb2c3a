//! A mesh of incidences into a table: means over pairs of cells.

use super::{deposit::Cells, gathered::Gathered, lobes::Lobe, mesh::Mesh};
use crate::{
    distribution::Distribution,
    exact_peak::{Delta, with_exact_peak},
    measured::scan::Kind,
    synthetic::Basis,
    table::Columns,
    work::Work,
};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::Result;

/// Incident points a side of a column, at least and at most, of matrices and of trees: lobes should overlap from one to the next.
const PATCH_POINTS: [usize; 2] = [4, 8];
const TREE_POINTS: [usize; 2] = [2, 4];

/// Points a side over which the through transmittance is averaged.
const THROUGH_POINTS: usize = 32;

/// The narrowest lobes with this share of the flux decide how many points a column has.
const NARROWEST: f64 = 0.1;

/// Scattered flux by column and cell, and what goes straight.
#[derive(Debug)]
pub struct Columnwise {
    basis: Basis,
    /// By column: BSDF [1/sr] of each cell.
    scattered: Vec<Vec<f32>>,
    deltas: Vec<Delta>,
    areas: Vec<f64>,
}

impl Columnwise {
    /// Tabulate one kind; `told_apart`: what goes straight or is mirrored is known.
    pub fn new(kind: Kind, mesh: &Mesh, basis: Basis, told_apart: bool, work: &Work) -> Result<Self> {
        let [incident, exiting] = basis.divisions();
        let cells = Cells::new(exiting.clone());
        let columns = 0..incident.len();
        let scattered =
            work.columns(kind, columns.len(), |column| scattered(mesh, &incident, column, &cells))?;
        let delta = |column: usize| {
            let points = incident.points(column, THROUGH_POINTS).into_iter().map(|p| (p, mesh.through(p)));
            Delta::over(&points.collect::<Vec<_>>(), &exiting, basis.is_isotropic())
        };
        let deltas = if told_apart { columns.map(delta).collect() } else { Vec::new() };
        let areas = (0..exiting.len()).map(|cell| cells.area(cell)).collect();
        Ok(Self { basis, scattered, deltas, areas })
    }

    /// Hemispherical value of a column [-].
    pub fn flux(&self, column: usize) -> f64 {
        let scattered: f64 =
            self.scattered[column].iter().zip(&self.areas).map(|(&v, a)| f64::from(v) * a).sum();
        scattered + self.deltas.get(column).map_or(0.0, |d| d.mean)
    }

    /// Multiply a column by a factor.
    pub fn scale(&mut self, column: usize, factor: f64) {
        self.scattered[column].iter_mut().for_each(|v| *v = (f64::from(*v) * factor) as f32);
        if let Some(delta) = self.deltas.get_mut(column) {
            delta.mean *= factor;
            delta.cells.iter_mut().for_each(|cell| cell.1 *= factor);
        }
    }

    /// The table; with its exact split where what goes straight was told apart. What is mirrored lies in the cells that the mirrored
    /// direction sweeps.
    pub fn distribution(&self, reflection: bool) -> Distribution {
        let value = |column: usize, cell: usize| self.scattered[column][cell];
        if reflection {
            let mirrored =
                |column: usize, cell: usize| self.deltas.get(column).map_or(0.0, |d| d.at(cell)) as f32;
            let table =
                self.basis.layout().table(|column, cell| value(column, cell) + mirrored(column, cell));
            return Distribution::new(table, None);
        }
        if !self.deltas.is_empty() {
            return with_exact_peak(self.basis, value, &self.deltas, None);
        }
        Distribution::with_split(self.basis.layout().table(value), None)
    }
}

/// One column's means [1/sr].
fn scattered(mesh: &Mesh, incident: &Columns, column: usize, cells: &Cells) -> Vec<f32> {
    let (middle, _) = mesh.at(incident.point(column, [0.5, 0.5]));
    let points = incident.points(column, points_a_side(incident, column, &middle.lobes));
    let share = 1.0 / points.len() as f64;
    let mut gathered = Gathered::default();
    let mut values = vec![0.0; cells.len()];
    for p in points {
        let (scattered, _) = mesh.at(off_the_rim(p));
        cells.add_background(&scattered.background, share, &mut values);
        scattered.lobes.iter().for_each(|lobe| gathered.add(lobe, share));
    }
    let mut fluxes = vec![0.0; cells.len()];
    gathered.lobes().for_each(|lobe| cells.add(&lobe, &mut fluxes));
    let value = |(cell, flux): (usize, &f64)| (values[cell] + flux / cells.area(cell)) as f32;
    fluxes.iter().enumerate().map(value).collect()
}

fn off_the_rim(p: DVec2) -> DVec2 {
    p.clamp_length_max(0.9999)
}

fn points_a_side(incident: &Columns, column: usize, lobes: &[Lobe]) -> usize {
    let [least, most] = if matches!(incident, Columns::Patches(_)) { PATCH_POINTS } else { TREE_POINTS };
    let width = match incident {
        Columns::Radial { side } => 2.0 / *side as f64,
        Columns::Square { side } => PI.sqrt() / *side as f64,
        Columns::Patches(basis) => basis.projected_solid_angle(column).sqrt(),
    };
    let mut narrow: Vec<&Lobe> = lobes.iter().collect();
    narrow.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
    let whole: f64 = lobes.iter().map(|l| l.flux).sum();
    let mut sum = 0.0;
    let sigma = narrow.into_iter().find(|l| {
        sum += l.flux;
        sum >= NARROWEST * whole
    });
    let steps = sigma.map_or(0.0, |l| width / l.sigma);
    (steps.ceil() as usize).clamp(least, most)
}
