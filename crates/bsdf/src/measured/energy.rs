//! No more light may leave than comes in.

use super::{scan::Kind, table::Columnwise};
use crate::{synthetic::Basis, table::Columns};
use sunpeak_core::{Error, Result};

/// What to do with incidences that give more than they get.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Energy {
    /// Refuse the measurement.
    #[default]
    Refuse,
    /// Scale transmission and reflection of such an incidence to what comes in, and say so.
    Scale,
}

impl std::str::FromStr for Energy {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "refuse" => Ok(Self::Refuse),
            "scale" => Ok(Self::Scale),
            _ => Err(Error::value(format!("energy '{name}'; expected refuse or scale"))),
        }
    }
}

/// Above this is more than all: tables are 32-bit numbers.
const ALL: f64 = 1.0 + 1e-6;

/// Incidences of a side that were scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled {
    /// Light meets the front.
    pub front: bool,
    /// How many columns.
    pub columns: usize,
    /// Transmittance and reflectance together in the worst of them [-], and its angle of incidence [deg].
    pub worst: [f64; 2],
}

/// Hold transmission and reflection of each side against what comes in.
pub fn check(tables: &mut [(Kind, Columnwise)], basis: Basis, energy: Energy) -> Result<Vec<Scaled>> {
    let [incident, _] = basis.divisions();
    let mut scaled = Vec::new();
    for front in [true, false] {
        let mut own: Vec<&mut Columnwise> =
            tables.iter_mut().filter(|(kind, _)| kind.front == front).map(|(_, table)| table).collect();
        if own.is_empty() {
            continue;
        }
        let sums: Vec<f64> = (0..incident.len()).map(|c| own.iter().map(|t| t.flux(c)).sum()).collect();
        let over: Vec<usize> = (0..sums.len()).filter(|&c| sums[c] > ALL).collect();
        let Some(&worst) = over.iter().max_by(|&&a, &&b| sums[a].total_cmp(&sums[b])) else { continue };
        let told = Scaled { front, columns: over.len(), worst: [sums[worst], theta_deg(&incident, worst)] };
        if energy == Energy::Refuse {
            return Err(refused(told, incident.len()));
        }
        for column in over {
            own.iter_mut().for_each(|table| table.scale(column, 1.0 / sums[column]));
        }
        scaled.push(told);
    }
    Ok(scaled)
}

fn theta_deg(incident: &Columns, column: usize) -> f64 {
    incident.point(column, [0.5, 0.5]).length().min(1.0).asin().to_degrees()
}

fn refused(told: Scaled, columns: usize) -> Error {
    let side = if told.front { "front" } else { "back" };
    let [sum, theta] = told.worst;
    Error::value(format!(
        "{side}: transmittance and reflectance add up to {sum:.4} at {theta:.1} degrees of incidence, and to more than 1 in {} of {columns} \
         incident cells; expected 1 or less: look at the calibration, or scale them",
        told.columns
    ))
}
