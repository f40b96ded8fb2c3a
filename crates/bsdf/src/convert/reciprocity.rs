//! Averages of a table and its partner: what goes from I to O one way has to go from O to I the other way, f(I, O) = f'(-O, -I) in
//! the points of tables.

use crate::{
    layout::Layout,
    overlap::{Shares, between_azimuths},
    table::{Columns, Table},
};
use rayon::prelude::*;
use sunpeak_core::{Error, Result};

/// Azimuths for each cell of a row of an isotropic tree.
const SLICES_A_CELL: usize = 8;

/// What a table has to be by reciprocity, if its partner is right: values by column and exiting cell.
pub fn partner(of: &Table, layout: &Layout) -> Result<Vec<f32>> {
    let width = layout.exiting.len();
    match (&layout.incident, &layout.exiting) {
        (Columns::Radial { side }, _) => Ok(isotropic(of, layout, *side)),
        (incident, exiting) if incident == exiting => {
            let opposite = (0..width).map(|cell| opposite(exiting, cell)).collect::<Result<Vec<_>>>()?;
            let value = |k: usize| {
                let (i, o) = (k / width, k % width);
                at(of, layout, opposite[o], opposite[i])
            };
            Ok((0..width * width).into_par_iter().map(value).collect())
        }
        _ => Err(Error::value(
            "reciprocity: the incident basis is not the exiting one; expected a conversion into one basis for both",
        )),
    }
}

/// A value of a table in its own layout.
pub fn at(table: &Table, layout: &Layout, column: usize, cell: usize) -> f32 {
    let values = table.values();
    match table {
        // Regular trees have their last coordinate running fastest, as matrices their exiting patches.
        _ if values.len() >= layout.incident.len() * layout.exiting.len() => {
            values[column * layout.exiting.len() + cell]
        }
        _ => 0.0,
    }
}

/// The cell at the opposite point of the disk.
fn opposite(division: &Columns, cell: usize) -> Result<usize> {
    match division {
        Columns::Square { side } => Ok(side * side - 1 - cell),
        Columns::Radial { .. } => Ok(cell),
        Columns::Patches(basis) => {
            let (ring, step) = basis.ring_of(cell);
            match ring.phi_count {
                1 => Ok(cell),
                n if n % 2 == 0 => Ok(ring.first() + (step + n / 2) % n),
                n => Err(Error::value(format!(
                    "reciprocity: angle basis '{}' has {n} azimuths from {} to {} degrees; expected an even number, so that \
                     each patch has an opposite one",
                    basis.name(),
                    ring.lower_theta_deg,
                    ring.upper_theta_deg
                ))),
            }
        }
    }
}

/// In an isotropic tree f(r, q) = f'(|q|, r at minus q's azimuth): by slices of azimuth, in each of which areas are exact.
fn isotropic(of: &Table, layout: &Layout, side: usize) -> Vec<f32> {
    let (rings, width) = (layout.incident.len(), layout.exiting.len());
    let slices = SLICES_A_CELL * side;
    let edges = |k: usize| [k, k + 1].map(|e| 8.0 * e as f64 / slices as f64);
    // Of each slice and ring the exiting cells that it lies over.
    let sectors: Vec<Vec<Shares>> = (0..slices)
        .into_par_iter()
        .map(|k| {
            let cells = |ring: usize| {
                let sector = between_azimuths(&layout.incident.region(ring), edges(k));
                let whole = layout.incident.projected_solid_angle(ring) / slices as f64;
                let shares = layout.exiting.shares(&sector);
                shares.into_iter().map(|(at, shared)| (at, shared / whole)).collect()
            };
            (0..rings).map(cells).collect()
        })
        .collect();
    let mut values = vec![0f32; rings * width];
    let by_cell: Vec<Vec<f32>> = (0..width)
        .into_par_iter()
        .map(|cell| {
            let region = layout.exiting.region(cell);
            let whole = layout.exiting.projected_solid_angle(cell);
            let mut sums = vec![0.0; rings];
            for k in 0..slices {
                let part = between_azimuths(&region, edges(k));
                if part.is_empty() {
                    continue;
                }
                for (column, shared) in layout.incident.shares(&part) {
                    for (ring, sum) in sums.iter_mut().enumerate() {
                        let there = &sectors[slices - 1 - k][ring];
                        let mean: f64 = there
                            .iter()
                            .map(|&(o, share)| share * f64::from(at(of, layout, column as usize, o as usize)))
                            .sum();
                        *sum += shared / whole * mean;
                    }
                }
            }
            sums.into_iter().map(|s| s as f32).collect()
        })
        .collect();
    for (cell, column) in by_cell.into_iter().enumerate() {
        column.into_iter().enumerate().for_each(|(ring, v)| values[ring * width + cell] = v);
    }
    values
}
