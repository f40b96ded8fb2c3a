//! A regular division of both hemispheres, and tables made in it from values by column and exiting cell.

use crate::{
    table::{Columns, Matrix, Table},
    tree::Tree,
};

/// Incident and exiting cells of a table: the same kind on both sides, rings and a square in isotropic tensor trees.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Cells of incidence.
    pub incident: Columns,
    /// Cells of exit.
    pub exiting: Columns,
}

impl Layout {
    /// That of a table; a tree's has its smallest cells everywhere.
    pub fn of(table: &Table) -> Self {
        let incident = table.columns();
        let exiting = match (table, &incident) {
            (Table::Matrix(m), _) => Columns::Patches(m.exiting.clone()),
            (_, Columns::Radial { side }) => Columns::Square { side: *side },
            _ => incident.clone(),
        };
        Self { incident, exiting }
    }

    /// Incidences differ by their angle from the normal alone.
    pub fn is_isotropic(&self) -> bool {
        matches!(self.incident, Columns::Radial { .. })
    }

    /// A table of `value(column, exiting cell)` [1/sr].
    pub fn table(&self, value: impl Fn(usize, usize) -> f32) -> Table {
        let log2 = |side: usize| side.trailing_zeros() as u8;
        match (&self.incident, &self.exiting) {
            (Columns::Patches(incident), Columns::Patches(exiting)) => {
                let rows = exiting.len();
                let values = (0..incident.len() * rows).map(|k| value(k / rows, k % rows)).collect();
                Table::Matrix(Matrix { incident: incident.clone(), exiting: exiting.clone(), values })
            }
            (Columns::Radial { side }, _) => {
                // The second half of an isotropic tree is not used.
                let value =
                    |c: [usize; 4]| if c[0] < side / 2 { value(c[0], c[1] * side + c[2]) } else { 0.0 };
                Table::Tree(Tree::regular(3, log2(*side), value))
            }
            (Columns::Square { side }, _) => {
                let value = |c: [usize; 4]| value(c[0] * side + c[1], c[2] * side + c[3]);
                Table::Tree(Tree::regular(4, log2(*side), value))
            }
            (Columns::Patches(_), _) => unreachable!("patches of incidence have patches of exit"),
        }
    }
}
