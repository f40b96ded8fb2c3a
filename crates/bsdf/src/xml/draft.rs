//! Angle bases and blocks as a file describes them, until all of it is read.

use super::{Block, numbers::Values};
use crate::{
    basis::AngleBasis,
    table::{Matrix, Table},
};
use std::sync::Arc;
use sunpeak_core::{Error, Location, Result};

/// Most patches of a basis: with it on both sides a matrix has as many values as one may read.
const MAX_PATCHES: usize = 1 << 14;

/// An `AngleBasis` as far as it was read.
#[derive(Default)]
pub struct BasisDraft {
    pub name: String,
    pub lower_theta_deg: Option<f64>,
    pub upper_theta_deg: Option<f64>,
    phi_count: Option<usize>,
    /// Upper theta [deg] and number of patches.
    rings: Vec<(f64, usize)>,
    patches: usize,
}

impl BasisDraft {
    /// `nPhis`.
    pub fn set_phi_count(&mut self, count: f64) -> std::result::Result<(), String> {
        if !(1.0..=MAX_PATCHES as f64).contains(&count) || count.fract() != 0.0 {
            return Err(format!("nPhis is {count}; expected a whole number from 1 to {MAX_PATCHES}"));
        }
        self.phi_count = Some(count as usize);
        Ok(())
    }

    /// An `AngleBasisBlock` ends.
    pub fn end_ring(&mut self) -> std::result::Result<(), String> {
        let (Some(upper), Some(count)) = (self.upper_theta_deg.take(), self.phi_count.take()) else {
            return Err("an AngleBasisBlock needs ThetaBounds/UpperTheta and nPhis".into());
        };
        let expected = self.rings.last().map_or(0.0, |r| r.0);
        if let Some(lower) = self.lower_theta_deg.take()
            && !self.rings.is_empty()
            && (lower - expected).abs() > 1e-6 * expected
        {
            return Err(format!("LowerTheta is {lower}; expected {expected}, where the ring before ends"));
        }
        self.patches += count;
        if self.patches > MAX_PATCHES {
            return Err(format!("angle basis '{}' has more than {MAX_PATCHES} patches", self.name));
        }
        self.rings.push((upper, count));
        Ok(())
    }
}

/// The bases of a file.
#[derive(Default)]
pub struct Bases(Vec<Arc<AngleBasis>>);

impl Bases {
    /// A basis of a known name is the known one, whatever the file says of it (as Radiance does).
    pub fn define(&mut self, draft: BasisDraft) -> std::result::Result<(), String> {
        if AngleBasis::known(&draft.name).is_none() && !draft.rings.is_empty() {
            let basis = AngleBasis::new(&draft.name, &draft.rings).map_err(|e| e.to_string())?;
            self.0.push(Arc::new(basis));
        }
        Ok(())
    }

    fn named(&mut self, name: &str, tag: &str, place: &Location) -> Result<Arc<AngleBasis>> {
        if let Some(basis) = self.0.iter().find(|b| b.name().eq_ignore_ascii_case(name)) {
            return Ok(basis.clone());
        }
        let Some(basis) = AngleBasis::known(name).map(Arc::new) else {
            let message = format!(
                "{tag} '{name}' is not defined; expected LBNL/Klems Full, Half or Quarter, or an AngleBasis of the file"
            );
            return Err(Error::input(place.clone(), message));
        };
        self.0.push(basis.clone());
        Ok(basis)
    }
}

/// A `WavelengthDataBlock` as far as it was read.
#[derive(Default)]
pub struct BlockDraft {
    pub band: String,
    pub direction: String,
    pub column_basis: String,
    pub row_basis: String,
    pub angle_basis: String,
    /// Where the block ends in the file.
    pub end: Location,
    /// Its values, and where they end.
    pub values: Option<(Location, Values)>,
}

impl BlockDraft {
    /// Its table.
    pub fn table(self, structure: &str, bases: &mut Bases, warnings: &mut Vec<String>) -> Result<Block> {
        let what = format!("{} {}", self.band, self.direction);
        let by_rows = structure.eq_ignore_ascii_case("Rows");
        let is_matrix = by_rows || structure.eq_ignore_ascii_case("Columns");
        let table = match self.values {
            None => return Err(Error::input(self.end, format!("{what}: no ScatteringData"))),
            Some((data_end, Values::List(values))) if is_matrix => {
                let incident = bases.named(&self.column_basis, "ColumnAngleBasis", &self.end)?;
                let exiting = bases.named(&self.row_basis, "RowAngleBasis", &self.end)?;
                let expected = incident.len() * exiting.len();
                if values.len() < expected {
                    let message = format!(
                        "{what}: {} values; expected {} x {} = {expected} for '{}' by '{}'",
                        values.len(),
                        incident.len(),
                        exiting.len(),
                        incident.name(),
                        exiting.name()
                    );
                    return Err(Error::input(data_end, message));
                }
                if values.len() > expected {
                    let extra = values.len() - expected;
                    warnings.push(format!("{what}: {extra} values more than the basis has were ignored"));
                }
                Table::Matrix(matrix(incident, exiting, &values, by_rows))
            }
            Some((_, Values::Tree(tree))) => {
                if !self.angle_basis.eq_ignore_ascii_case("LBNL/Shirley-Chiu") {
                    let message = format!(
                        "{what}: angle basis '{}' is not supported; a tensor tree has LBNL/Shirley-Chiu",
                        self.angle_basis
                    );
                    return Err(Error::input(self.end, message));
                }
                Table::Tree(tree)
            }
            Some((data_end, Values::List(_))) => {
                let message = format!(
                    "{what}: numbers of a matrix, but IncidentDataStructure is '{structure}'; expected Columns or Rows"
                );
                return Err(Error::input(data_end, message));
            }
        };
        Ok(Block { band: self.band, direction: self.direction, table })
    }
}

/// Values in the order of the file: "Columns" has a line for each exiting patch, "Rows" one for each incident patch.
fn matrix(incident: Arc<AngleBasis>, exiting: Arc<AngleBasis>, values: &[f32], by_rows: bool) -> Matrix {
    let (columns, rows) = (incident.len(), exiting.len());
    let values = if by_rows {
        values[..columns * rows].to_vec()
    } else {
        (0..columns).flat_map(|i| (0..rows).map(move |o| values[o * columns + i])).collect()
    };
    Matrix { incident, exiting, values }
}
