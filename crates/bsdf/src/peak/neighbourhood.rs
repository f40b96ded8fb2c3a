//! Where a column's peak lies, and what lies around it.

use super::{
    instrument,
    shape::{Distances, Shape},
};
use crate::{
    kernel::Spread,
    table::{Cell, Columns, Table},
};
use glam::DVec2;
use std::cell::OnceCell;
use sunpeak_core::warp::disk_to_square;

/// How far the fit looks, in widths of the peak's region.
const REACH: f64 = 4.1;

/// Least factor by which distances grow from the unit square to the disk: with r = a, phi = pi/4 b/a on the square of edge 2 the
/// singular values' product is pi/4 and the sum of their squares at most 1 + pi²/8, so that the smaller one is at least 0.565.
const LEAST_STRETCH: f64 = 2.0 * 0.565;

/// Share of an instrument's blurred peak whose cells are measured; the rest of it is known from its shape.
const CORE: f64 = 0.9;

/// Share of the blurred peak in one cell below which it is nothing.
const LEAST_SHARE: f64 = 1e-6;

/// Off the border on which the straight direction runs in isotropic trees.
const BESIDE: f64 = 1e-7;

/// Points a side of a cell for averaging with their weights (Gauss-Legendre): exact to the third, fifth, seventh, ninth power.
pub const RULES: [&[(f64, f64)]; 4] = [
    &[(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)],
    &[(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)],
    &[
        (0.069_431_844_202_973_7, 0.173_927_422_568_727),
        (0.330_009_478_207_571_9, 0.326_072_577_431_273),
        (0.669_990_521_792_428_1, 0.326_072_577_431_273),
        (0.930_568_155_797_026_3, 0.173_927_422_568_727),
    ],
    &[
        (0.046_910_077_030_668, 0.118_463_442_528_094_5),
        (0.230_765_344_947_158_5, 0.239_314_335_249_683_2),
        (0.5, 0.284_444_444_444_444_4),
        (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
        (0.953_089_922_969_332, 0.118_463_442_528_094_5),
    ],
];

/// Widths of a lobe in cells from which the first rule is enough, and the second.
const ENOUGH: [f64; 2] = [1.2, 0.7];

/// The finest rule pays in trees of no more columns than this: cells across the diagonals of the square have a kink.
const MOST_FINE_COLUMNS: usize = 256;

/// A cell and the part of the straight flux that an instrument's blur puts there.
#[derive(Clone, Copy, Debug)]
pub struct Blurred {
    /// The cell.
    pub cell: Cell,
    /// Share of the column's straight flux [-].
    pub share: f64,
}

/// The cells that hold a column's peak.
#[derive(Debug)]
pub struct Region {
    /// Cells whose excess is measured: those that the straight direction touches or, with a blur, most of it.
    pub core: Vec<Blurred>,
    /// Cells with the blur's tails.
    pub fringe: Vec<Blurred>,
    /// Share of the straight flux that the core holds.
    pub core_share: f64,
}

/// A column's cells: those that hold its peak, and those from which the rest is judged.
#[derive(Debug)]
pub struct Neighbourhood {
    /// Where the peak is.
    pub region: Region,
    /// Cells around the core with their weights, the fringe first.
    pub around: Vec<(Cell, f64)>,
    cell_width: f64,
}

impl Neighbourhood {
    /// Find a column's cells; `blur` is what the instrument made of a delta.
    pub fn of(table: &Table, columns: &Columns, column: usize, blur: Option<Spread>) -> Self {
        let touched = path(table, columns, column);
        let cells = table.cells(columns, column);
        let shares = match blur {
            // All of it lies in the cells that the straight direction touches.
            None => vec![1.0 / touched.len() as f64; cells.len()],
            Some(spread) => instrument::shares(table, columns, column, &cells, spread),
        };
        let (mut core, mut fringe, mut others) = (Vec::new(), Vec::new(), Vec::new());
        for (cell, share) in cells.into_iter().zip(shares) {
            if touched.contains(&cell.index) {
                core.push(Blurred { cell, share });
            } else if blur.is_some() && share > LEAST_SHARE {
                fringe.push(Blurred { cell, share });
            } else {
                others.push(cell);
            }
        }
        let mut core_share: f64 = core.iter().map(|c| c.share).sum();
        // The densest part of the blur belongs to the core.
        let density = |b: &Blurred| b.share / b.cell.projected_solid_angle;
        fringe.sort_by(|a, b| density(b).total_cmp(&density(a)));
        let mut taken = 0;
        while taken < fringe.len() && core_share < CORE {
            core_share += fringe[taken].share;
            taken += 1;
        }
        core.extend(fringe.drain(..taken));
        let region = Region { core, fringe, core_share };
        let mut found = Self { region, around: Vec::new(), cell_width: 0.0 };
        found.look_around(table, columns.point(column, [0.5, 0.5]), others);
        found
    }

    fn look_around(&mut self, table: &Table, straight: DVec2, others: Vec<Cell>) {
        let distance = |cell: &Cell| (table.point(cell, [0.5, 0.5]) - straight).length();
        let width = |b: &Blurred| b.cell.projected_solid_angle.sqrt();
        let Region { core, fringe, .. } = &self.region;
        self.cell_width = core.iter().map(width).fold(0.0, f64::max);
        let radius = core.iter().map(|b| distance(&b.cell)).fold(0.0, f64::max);
        let region = self.cell_width.max(radius);
        let mut near: Vec<(Cell, f64)> = fringe.iter().map(|b| (b.cell, distance(&b.cell))).collect();
        near.extend(within(table, &others, straight, REACH * region));
        if near.is_empty() {
            // In bases whose patches are long and narrow all others may lie further away: then the nearest ones.
            let all = within(table, &others, straight, f64::INFINITY);
            let nearest = all.iter().map(|n| n.1).fold(f64::INFINITY, f64::min);
            near = all.into_iter().filter(|n| n.1 <= nearest).collect();
        }
        let weight = |distance: f64| 1.0 / (1.0 + (distance / region).powi(2));
        self.around = near.into_iter().map(|(cell, distance)| (cell, weight(distance))).collect();
    }

    /// What a lobe's averages over the core's cells and over those around it follow from.
    pub fn averages<'a>(&'a self, table: &'a Table, columns: &'a Columns, column: usize) -> Averages<'a> {
        Averages { n: self, table, columns, column, distances: Default::default() }
    }
}

/// Averages of lobes over a neighbourhood's cells.
#[derive(Debug)]
pub struct Averages<'a> {
    n: &'a Neighbourhood,
    table: &'a Table,
    columns: &'a Columns,
    column: usize,
    /// By rule, made when a lobe asks for it.
    distances: [OnceCell<Vec<Distances>>; RULES.len()],
}

impl Averages<'_> {
    /// Lobes of height 1 averaged over the cells, the core's first, by shape of the table's ladders.
    pub fn of(&self, shapes: &[Shape]) -> Vec<Vec<f64>> {
        let cells = self.n.region.core.len() + self.n.around.len();
        let mut averages = vec![vec![0.0; cells]; shapes.len()];
        let mut start = 0;
        // One after the other what one rule is enough for.
        for part in shapes.chunk_by(|a, b| a.in_angle == b.in_angle && self.rule(*a) == self.rule(*b)) {
            let rule = self.rule(part[0]);
            let distances = self.distances[rule].get_or_init(|| self.distances(RULES[rule]));
            let mut of_cell = vec![0.0; part.len()];
            for (cell, distances) in distances.iter().enumerate() {
                distances.ladder(part[0], &mut of_cell);
                for (shape, average) in of_cell.iter().enumerate() {
                    averages[start + shape][cell] = *average;
                }
            }
            start += part.len();
        }
        averages
    }

    /// The rule of [`RULES`] that is enough for a lobe.
    fn rule(&self, shape: Shape) -> usize {
        let width = shape.sigma / self.n.cell_width;
        let wanted = ENOUGH.iter().position(|&enough| width >= enough).unwrap_or(ENOUGH.len());
        match (wanted, self.table) {
            // Patches differ too much in shape for the coarsest rule, and towards the horizon lobes in angle grow steeply.
            (wanted, Table::Matrix(_)) => wanted.max(1),
            (0, Table::Tree(_)) if self.columns.is_grazing(self.column) => 2,
            (2, Table::Tree(_)) if self.columns.len() <= MOST_FINE_COLUMNS => 3,
            (wanted, Table::Tree(_)) => wanted.min(1),
        }
    }

    fn distances(&self, rule: &[(f64, f64)]) -> Vec<Distances> {
        let cells = self.n.region.core.iter().map(|b| &b.cell).chain(self.n.around.iter().map(|a| &a.0));
        distances(self.table, self.columns, self.column, cells, rule)
    }
}

/// Distances of a column's points from those of cells, by a rule of [`RULES`].
pub fn distances<'a>(
    table: &Table,
    columns: &Columns,
    column: usize,
    cells: impl Iterator<Item = &'a Cell>,
    rule: &[(f64, f64)],
) -> Vec<Distances> {
    let incident: Vec<(DVec2, f64)> = match columns {
        // One coordinate only.
        Columns::Radial { .. } => rule.iter().map(|&(u, w)| (columns.point(column, [u, 0.5]), w)).collect(),
        _ => product(rule).into_iter().map(|(u, w)| (columns.point(column, u), w)).collect(),
    };
    cells
        .map(|cell| {
            let exits = product(rule).into_iter().map(|(u, w)| (table.point(cell, u), w));
            Distances::new(exits.flat_map(|(q, w)| incident.iter().map(move |&(p, v)| (p, q, w * v))))
        })
        .collect()
}

/// The cells whose middles lie within `reach` of a point, with their distances from it.
fn within(table: &Table, cells: &[Cell], point: DVec2, reach: f64) -> Vec<(Cell, f64)> {
    // On the square a cell that is too far away is told without mapping it to the disk.
    let at = disk_to_square(point.into());
    let furthest = reach / LEAST_STRETCH;
    let may_be_near = |cell: &&Cell| {
        cell.square().is_none_or(|square| {
            let middle = |k: usize| f64::from(square.corner[k]) + 0.5 * f64::from(square.size);
            [0, 1].iter().all(|&k| (middle(k) - at[k]).abs() <= furthest)
        })
    };
    let distance = |cell: &Cell| (table.point(cell, [0.5, 0.5]) - point).length();
    let near = cells.iter().filter(may_be_near).map(|cell| (*cell, distance(cell)));
    near.filter(|(_, distance)| *distance <= reach).collect()
}

fn product(rule: &[(f64, f64)]) -> Vec<([f64; 2], f64)> {
    rule.iter().flat_map(|&(u, a)| rule.iter().map(move |&(v, b)| ([u, v], a * b))).collect()
}

/// Indices of the cells that the straight direction sweeps while the incidence moves over its column.
fn path(table: &Table, columns: &Columns, column: usize) -> Vec<usize> {
    let n = if matches!(table, Table::Matrix(_)) { 16 } else { 2 };
    // Columns of isotropic tables have their points on the x axis already.
    let sides: &[f64] = if table.is_isotropic() { &[-BESIDE, BESIDE] } else { &[0.0] };
    let mut touched = Vec::new();
    for i in 0..n * n {
        let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
        let p = columns.point(column, u);
        for &dy in sides {
            let index = table.index(p, p + DVec2::new(0.0, dy));
            if !touched.contains(&index) {
                touched.push(index);
            }
        }
    }
    touched
}
