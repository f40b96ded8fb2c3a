//! Tables whose through peak is known, not found: what is scattered and what goes straight are put together, and kept apart.

use crate::{
    distribution::Distribution,
    peak::{ColumnPeak, Part, Split},
    synthetic::Basis,
    table::Columns,
};
use glam::DVec2;
use sunpeak_core::{gray, xyz_to_rgb};

/// Off the border of two rows, along which the straight direction runs in isotropic trees.
const BESIDE: f64 = 1e-9;

/// The delta of one column, in the cells that the straight direction sweeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Delta {
    /// Its transmittance [-], the mean over the column.
    pub mean: f64,
    /// Exiting cells and what they have of it [1/sr], in ascending order.
    pub cells: Vec<(usize, f64)>,
}

impl Delta {
    /// From its transmittance [-] at points of a column.
    pub fn over(points: &[(DVec2, f64)], exiting: &Columns, isotropic: bool) -> Self {
        let sides: &[f64] = if isotropic { &[-BESIDE, BESIDE] } else { &[0.0] };
        let mut cells: Vec<(usize, f64)> = Vec::new();
        let mut mean = 0.0;
        for &(p, value) in points {
            let flux = value / points.len() as f64;
            mean += flux;
            for &y in sides {
                let cell = exiting.index(p + DVec2::new(0.0, y));
                let density = flux / sides.len() as f64 / exiting.projected_solid_angle(cell);
                match cells.iter_mut().find(|c| c.0 == cell) {
                    Some(known) => known.1 += density,
                    None => cells.push((cell, density)),
                }
            }
        }
        cells.sort_by_key(|c| c.0);
        Self { mean, cells }
    }

    /// What a cell has of it [1/sr].
    pub fn at(&self, cell: usize) -> f64 {
        self.cells.binary_search_by_key(&cell, |c| c.0).map_or(0.0, |at| self.cells[at].1)
    }
}

impl Columns {
    /// Incident points of a column, `n` a side, `n * n` where it has one coordinate.
    pub(crate) fn points(&self, column: usize, n: usize) -> Vec<DVec2> {
        let middles = |n: usize| (0..n).map(move |i| (i as f64 + 0.5) / n as f64);
        match self {
            Self::Radial { .. } => middles(n * n).map(|u| self.point(column, [u, 0.5])).collect(),
            _ => middles(n).flat_map(|u| middles(n).map(move |v| self.point(column, [u, v]))).collect(),
        }
    }
}

/// What is scattered [1/sr] by column and cell, and the deltas of the columns, as a table with its split. The deltas are gray; `tint`
/// has CIE X and Z of what is scattered over its Y.
pub(crate) fn with_exact_peak(
    basis: Basis,
    scattered: impl Fn(usize, usize) -> f32,
    deltas: &[Delta],
    tint: Option<[f64; 2]>,
) -> Distribution {
    let [incident, exiting] = basis.divisions();
    let plane = |tint: f64| {
        basis.layout().table(|column, cell| {
            let straight = deltas.get(column).map_or(0.0, |d| d.at(cell));
            (tint * f64::from(scattered(column, cell)) + straight) as f32
        })
    };
    let table = plane(1.0);
    let color = tint.map(|xz| xz.map(|tint| plane(tint).into_values()));
    let [x, z] = tint.unwrap_or([1.0; 2]);
    let scattered_color = xyz_to_rgb([x, 1.0, z].into());
    let part = |column: usize, delta: &Delta| -> Part {
        let p_in = incident.point(column, [0.5, 0.5]);
        let mut under = 0.0;
        let cells = delta.cells.iter().filter(|c| c.1 > 0.0).map(|&(cell, _)| {
            let rest = f64::from(scattered(column, cell));
            under += rest * exiting.projected_solid_angle(cell);
            (table.index(p_in, exiting.point(cell, [0.5, 0.5])), rest * scattered_color)
        });
        let cells = cells.collect();
        let peak = ColumnPeak {
            through: gray(delta.mean),
            contrast: delta.mean / under,
            interval: [delta.mean; 2],
            ..ColumnPeak::default()
        };
        (if delta.mean > 0.0 { peak } else { ColumnPeak::default() }, cells)
    };
    let parts: Vec<Part> = deltas.iter().enumerate().map(|(column, delta)| part(column, delta)).collect();
    Distribution::with_known_split(table, color, |columns| Split::from_parts(columns, parts, None))
}
