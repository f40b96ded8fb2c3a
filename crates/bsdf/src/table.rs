//! Tables over pairs of directions, in the coordinates of the unit disk.
//!
//! A table knows nothing of sides. Its incident point is `p_in` = minus the (x, y) of the direction to the light, its exiting
//! point `p_out` = the (x, y) of the exiting direction; light that goes straight through has `p_out = p_in`. Areas on the disk
//! are projected solid angles.

use crate::{basis::AngleBasis, tree::Tree};
use glam::DVec2;
use std::{f64::consts::PI, sync::Arc};
use sunpeak_core::warp::{disk_to_square, square_to_disk};

/// Keeps the incident radius of an isotropic tree off the middle of the square, where the unused half begins.
const ISOTROPIC_MARGIN: f64 = 1e-6;

/// Values of one side and mode [1/sr], constant in cells.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// Incident patches by exiting patches.
    Matrix(Matrix),
    /// Tensor tree of rank 3 or 4.
    Tree(Tree),
}

/// A matrix over two angle bases.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// Basis of the columns.
    pub incident: Arc<AngleBasis>,
    /// Basis of the rows.
    pub exiting: Arc<AngleBasis>,
    /// `incident.len() * exiting.len()` values, one incident patch after the other.
    pub values: Vec<f32>,
}

/// The incident division: in each column all values are the same for all incident points.
#[derive(Clone, Debug, PartialEq)]
pub enum Columns {
    /// The patches of a basis.
    Patches(Arc<AngleBasis>),
    /// `side * side` cells of the square.
    Square {
        /// Cells a side.
        side: usize,
    },
    /// `side / 2` rings of equal width in sin(theta), the first at grazing incidence.
    Radial {
        /// Cells a side of the square that the tree has for the exiting direction.
        side: usize,
    },
}

/// A cell of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Index of its value in the table.
    pub index: usize,
    /// Projected solid angle [sr].
    pub projected_solid_angle: f64,
    shape: CellShape,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CellShape {
    Patch,
    Square { corner: [f64; 2], size: f64 },
}

/// Place of a cell on the unit square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellSquare {
    /// Lower corner.
    pub corner: [f32; 2],
    /// Edge.
    pub size: f32,
}

impl Cell {
    /// Its place on the unit square; none for a patch of a matrix. Corners and sizes are binary fractions, exact in 32 bits.
    pub fn square(&self) -> Option<CellSquare> {
        match self.shape {
            CellShape::Patch => None,
            CellShape::Square { corner, size } => {
                Some(CellSquare { corner: corner.map(|c| c as f32), size: size as f32 })
            }
        }
    }
}

impl Table {
    /// All values [1/sr].
    pub fn values(&self) -> &[f32] {
        match self {
            Self::Matrix(m) => &m.values,
            Self::Tree(t) => t.values(),
        }
    }

    /// All values, without the cells.
    pub fn into_values(self) -> Vec<f32> {
        match self {
            Self::Matrix(m) => m.values,
            Self::Tree(t) => t.into_values(),
        }
    }

    /// Do values of the same index stand for the same cell?
    pub fn has_cells_of(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Matrix(a), Self::Matrix(b)) => a.incident == b.incident && a.exiting == b.exiting,
            (Self::Tree(a), Self::Tree(b)) => a.has_cells_of(b),
            _ => false,
        }
    }

    /// A table of the same cells with other values, in the order of [`Self::values`]; none if their number differs.
    pub fn with_values(&self, values: Vec<f32>) -> Option<Self> {
        if values.len() != self.values().len() {
            return None;
        }
        Some(match self {
            Self::Matrix(m) => {
                Self::Matrix(Matrix { incident: m.incident.clone(), exiting: m.exiting.clone(), values })
            }
            Self::Tree(t) => Self::Tree(t.map_leaves(|leaf, _| values[leaf.index])),
        })
    }

    /// Where the value [1/sr] for a pair of points stands.
    pub fn index(&self, p_in: DVec2, p_out: DVec2) -> usize {
        match self {
            Self::Matrix(m) => m.incident.index(p_in) * m.exiting.len() + m.exiting.index(p_out),
            Self::Tree(t) => t.leaf(position(t.rank(), p_in, p_out)).index,
        }
    }

    /// The value [1/sr] for a pair of points.
    pub fn value(&self, p_in: DVec2, p_out: DVec2) -> f64 {
        f64::from(self.values()[self.index(p_in, p_out)])
    }

    /// Smallest projected solid angle [sr] of the cell at a pair of points: its incident or its exiting side.
    pub fn projected_solid_angle(&self, p_in: DVec2, p_out: DVec2) -> f64 {
        match self {
            Self::Matrix(m) => {
                let incident = m.incident.projected_solid_angle(m.incident.index(p_in));
                incident.min(m.exiting.projected_solid_angle(m.exiting.index(p_out)))
            }
            Self::Tree(t) => PI * t.leaf(position(t.rank(), p_in, p_out)).size.powi(2),
        }
    }

    /// Smallest projected solid angle [sr] in the whole table.
    pub fn smallest_projected_solid_angle(&self) -> f64 {
        let smallest =
            |b: &AngleBasis| (0..b.len()).map(|i| b.projected_solid_angle(i)).fold(f64::INFINITY, f64::min);
        match self {
            Self::Matrix(m) => smallest(&m.incident).min(smallest(&m.exiting)),
            Self::Tree(t) => PI * t.smallest().powi(2),
        }
    }

    /// The finest incident division that occurs in the table.
    pub fn columns(&self) -> Columns {
        match self {
            Self::Matrix(m) => Columns::Patches(m.incident.clone()),
            Self::Tree(t) => {
                let side = (1.0 / t.smallest()).round() as usize;
                if t.rank() == 3 { Columns::Radial { side: side.max(2) } } else { Columns::Square { side } }
            }
        }
    }

    /// All cells of a column.
    pub fn cells(&self, columns: &Columns, column: usize) -> Vec<Cell> {
        match self {
            Self::Matrix(m) => {
                let width = m.exiting.len();
                let cell = |patch| Cell {
                    index: column * width + patch,
                    projected_solid_angle: m.exiting.projected_solid_angle(patch),
                    shape: CellShape::Patch,
                };
                (0..width).map(cell).collect()
            }
            Self::Tree(t) => {
                let p_in = columns.point(column, [0.5, 0.5]);
                let at = position(t.rank(), p_in, p_in);
                let mut cells = Vec::new();
                t.for_each_leaf_over(&at[..t.rank() - 2], |leaf| {
                    let d = t.rank() - 2;
                    cells.push(Cell {
                        index: leaf.index,
                        projected_solid_angle: PI * leaf.size * leaf.size,
                        shape: CellShape::Square {
                            corner: [leaf.corner[d], leaf.corner[d + 1]],
                            size: leaf.size,
                        },
                    });
                });
                cells
            }
        }
    }

    /// A point of a cell, uniform in projected solid angle for uniform `u`; in an isotropic tree in the frame where
    /// the incident point lies on the positive x axis.
    pub fn point(&self, cell: &Cell, u: [f64; 2]) -> DVec2 {
        match (self, cell.shape) {
            (_, CellShape::Square { corner, size }) => {
                square_to_disk([corner[0] + u[0] * size, corner[1] + u[1] * size]).into()
            }
            (Self::Matrix(m), CellShape::Patch) => m.exiting.point(cell.index % m.exiting.len(), u),
            (Self::Tree(_), CellShape::Patch) => DVec2::ZERO,
        }
    }

    /// Name of the basis: that of the angle basis, of both if they differ, or the kind of tree.
    pub fn basis_name(&self) -> String {
        match self {
            Self::Matrix(m) if m.incident.name() == m.exiting.name() => m.incident.name().into(),
            Self::Matrix(m) => format!("{} by {}", m.incident.name(), m.exiting.name()),
            Self::Tree(t) => format!("TensorTree{}", t.rank()),
        }
    }

    /// Turns with the incident point (isotropic)?
    pub fn is_isotropic(&self) -> bool {
        matches!(self, Self::Tree(t) if t.rank() == 3)
    }
}

impl Columns {
    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Self::Patches(basis) => basis.len(),
            Self::Square { side } => side * side,
            Self::Radial { side } => side / 2,
        }
    }

    /// There is at least one.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The column of an incident point.
    pub fn index(&self, p_in: DVec2) -> usize {
        match self {
            Self::Patches(basis) => basis.index(p_in),
            Self::Square { side } => {
                let [x, y] = disk_to_square(p_in.into());
                let cell = |v: f64| ((v * *side as f64) as usize).min(side - 1);
                cell(x) * side + cell(y)
            }
            Self::Radial { side } => ((isotropic_coordinate(p_in) * *side as f64) as usize).min(side / 2 - 1),
        }
    }

    /// A point of a column, uniform in the measure over which tables average; on the x axis if isotropic.
    pub fn point(&self, column: usize, u: [f64; 2]) -> DVec2 {
        match self {
            Self::Patches(basis) => basis.point(column, u),
            Self::Square { side } => {
                let at = |cell: usize, u: f64| (cell as f64 + u) / *side as f64;
                square_to_disk([at(column / side, u[0]), at(column % side, u[1])]).into()
            }
            Self::Radial { side } => {
                DVec2::new((1.0 - 2.0 * (column as f64 + u[0]) / *side as f64).max(0.0), 0.0)
            }
        }
    }
}

impl Columns {
    /// The columns that share a border with a column.
    pub fn neighbours(&self, column: usize) -> Vec<usize> {
        match self {
            Self::Radial { side } => {
                let last = side / 2 - 1;
                [column.checked_sub(1), (column < last).then_some(column + 1)].into_iter().flatten().collect()
            }
            Self::Square { side } => {
                let (i, j) = (column / side, column % side);
                let steps = [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)];
                let inside = steps.into_iter().filter(|&(i, j)| i < *side && j < *side);
                inside.map(|(i, j)| i * side + j).collect()
            }
            Self::Patches(basis) => basis.neighbours(column),
        }
    }

    /// Does a column reach grazing incidence?
    pub fn is_grazing(&self, column: usize) -> bool {
        match self {
            Self::Radial { .. } => column == 0,
            Self::Square { side } => [column / side, column % side].iter().any(|&k| k == 0 || k + 1 == *side),
            Self::Patches(basis) => basis.rings().last().is_some_and(|last| column >= last.first()),
        }
    }
}

fn isotropic_coordinate(p_in: DVec2) -> f64 {
    (0.5 - ISOTROPIC_MARGIN - 0.5 * p_in.length()).max(0.0)
}

/// Turn `p_out` so that `p_in` lies on the positive x axis.
pub fn turned(p_in: DVec2, p_out: DVec2) -> DVec2 {
    match p_in.try_normalize() {
        Some(axis) => DVec2::new(axis.dot(p_out), axis.perp_dot(p_out)),
        None => p_out,
    }
}

/// Undo [`turned`].
pub fn turned_back(p_in: DVec2, p_out: DVec2) -> DVec2 {
    match p_in.try_normalize() {
        Some(axis) => axis.rotate(p_out),
        None => p_out,
    }
}

fn position(rank: usize, p_in: DVec2, p_out: DVec2) -> [f64; 4] {
    if rank == 3 {
        let [x, y] = disk_to_square(turned(p_in, p_out).into());
        [isotropic_coordinate(p_in), x, y, 0.0]
    } else {
        let ([a, b], [c, d]) = (disk_to_square(p_in.into()), disk_to_square(p_out.into()));
        [a, b, c, d]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables() -> Vec<Table> {
        let basis = Arc::new(AngleBasis::known("LBNL/Klems Half").unwrap());
        let values = (0..basis.len() * basis.len()).map(|i| i as f32).collect();
        let numbered = |c: [usize; 4]| c.iter().fold(0, |n, &k| n * 8 + k) as f32;
        vec![
            Table::Matrix(Matrix { incident: basis.clone(), exiting: basis, values }),
            Table::Tree(Tree::regular(3, 3, numbered)),
            Table::Tree(Tree::regular(4, 3, numbered)),
        ]
    }

    #[test]
    fn columns_and_cells_lead_back_to_the_same_value() {
        for table in tables() {
            let columns = table.columns();
            for column in 0..columns.len() {
                let p_in = columns.point(column, [0.3, 0.7]);
                assert_eq!(columns.index(p_in), column);
                let cells = table.cells(&columns, column);
                let sum: f64 = cells.iter().map(|c| c.projected_solid_angle).sum();
                assert!((sum - PI).abs() < 1e-9);
                for cell in &cells {
                    assert_eq!(table.index(p_in, table.point(cell, [0.6, 0.2])), cell.index);
                }
            }
        }
    }

    #[test]
    fn an_isotropic_table_turns_with_the_incidence() {
        let table = &tables()[1];
        let (p_in, p_out) = (DVec2::new(0.5, 0.2), DVec2::new(-0.1, 0.6));
        let turn = DVec2::from_angle(1.1);
        assert_eq!(table.value(p_in, p_out), table.value(turn.rotate(p_in), turn.rotate(p_out)));
        let there = turned(p_in, p_out);
        assert!((turned_back(p_in, there) - p_out).length() < 1e-12);
    }
}
