//! What the smooth BTDF would be under the peak, judged from the cells around it.
//!
//! Around the straight direction a smooth lobe is modelled as `b + a exp(-d²/2s²)`, `d` the distance from it on the disk of projected
//! directions (the lobe follows the straight direction while the incidence moves over its column). Base `b` and height `a` are
//! fitted to each column, by least squares weighted to the nearest cells; the width `s` is chosen where this column and the table
//! as a whole agree best with their cells; equals are averaged. Both the data and the model are averages over
//! cells, so that coarse bases are treated fairly.

use crate::table::{Cell, Columns, Table};
use glam::DVec2;
use rayon::prelude::*;
use sunpeak_core::warp::disk_to_square;

/// How far the fit looks, in widths of the candidate cell.
const REACH: f64 = 4.1;

/// Least factor by which distances grow from the unit square to the disk: with r = a, phi = pi/4 b/a on the square of edge 2 the
/// singular values' product is pi/4 and the sum of their squares at most 1 + pi²/8, so that the smaller one is at least 0.565.
const LEAST_STRETCH: f64 = 2.0 * 0.565;

/// Widest lobe [projected units]: wider ones look flat under any cell.
const WIDEST: f64 = 1.0;

/// Narrowest lobe that a basis can tell from a delta, in cell widths: a Gaussian whose full width at tenth maximum is two cells
/// (4.29 s = 2) still lights its neighbours.
pub const NARROWEST: f64 = 2.0 / 4.29;

/// A width is as good as the best one if its misfit is within this factor of it …
const AS_GOOD: f64 = 1.3;

/// … and still possible within this one.
const PLAUSIBLE: f64 = 4.0;

/// Squared relative misfit below which the data do not tell (0.03 %: the digits that files have).
const GOOD_ENOUGH: f64 = 1e-7;

/// Points a side of a cell for averaging (Gauss-Legendre): exact for cubics over each side.
const QUADRATURE: [(f64, f64); 2] = [(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)];

/// The same for matrices, whose patches are as wide as lobes: exact to the fifth power.
const QUADRATURE_WIDE: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// The smooth BTDF under one candidate cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Most likely value [1/sr].
    pub value: f64,
    /// Its standard error, from the misfit around it [1/sr].
    pub error: f64,
    /// Variance of a cell's value over the value [1/sr], from the same misfit: with counted rays it is the same for bright and
    /// dark cells.
    pub variance_ratio: f64,
    /// Lowest and highest value over all lobe widths that fit about as well [1/sr].
    pub range: [f64; 2],
}

/// A column's candidates and what lies around them.
pub struct Neighbourhood {
    /// Cells that the straight direction touches.
    pub candidates: Vec<Cell>,
    around: Vec<Cell>,
    weights: Vec<f64>,
    /// Points of the column with their weights.
    incident: Vec<(DVec2, f64)>,
}

/// The surround of every candidate of every column, and the width of the lobe that it assumes.
pub fn estimate(
    table: &Table,
    neighbourhoods: &[Neighbourhood],
    channels: &[&[f32]],
) -> Vec<(f64, Vec<Vec<Estimate>>)> {
    let widths = widths(table);
    let fits: Vec<Vec<ColumnFit>> = neighbourhoods
        .par_iter()
        .map(|n| {
            let distances = n.squared_distances(table);
            widths.iter().map(|&s| n.fit(channels[0], &lobe_averages(&distances, s))).collect()
        })
        .collect();
    let table_misfit: Vec<f64> = (0..widths.len())
        .map(|k| {
            let (sum, count) = fits.iter().fold((0.0, 0.0), |(s, c), f| match f[k].misfit {
                Some(m) => (s + m, c + 1.0),
                None => (s, c),
            });
            if count > 0.0 { sum / count } else { 0.0 }
        })
        .collect();
    neighbourhoods
        .par_iter()
        .zip(&fits)
        .map(|(n, column)| {
            let misfit = |k: usize| column[k].misfit.unwrap_or(0.0) + table_misfit[k];
            let best = (0..widths.len()).map(misfit).fold(f64::INFINITY, f64::min);
            // Widths that fit about as well share the estimate, so that it is a continuous function of the data.
            let tolerance = (AS_GOOD - 1.0) * best + GOOD_ENOUGH;
            let shares: Vec<f64> =
                (0..widths.len()).map(|k| (1.0 - (misfit(k) - best) / tolerance).max(0.0)).collect();
            let total: f64 = shares.iter().sum();
            let average = |of: &dyn Fn(usize) -> f64| -> f64 {
                (0..widths.len()).filter(|&k| shares[k] > 0.0).map(|k| shares[k] / total * of(k)).sum()
            };
            let plausible = |k: usize| misfit(k) <= PLAUSIBLE * (best + GOOD_ENOUGH);
            let distances = n.squared_distances(table);
            let features: Vec<Option<Vec<f64>>> = (0..widths.len())
                .map(|k| {
                    let counts = shares[k] > 0.0 || plausible(k);
                    counts.then(|| lobe_averages(&distances, widths[k]))
                })
                .collect();
            let estimates = channels
                .iter()
                .map(|values| {
                    let fits: Vec<_> =
                        features.iter().map(|f| f.as_ref().map(|f| n.fit(values, f))).collect();
                    let of = |k: usize, what: &dyn Fn(&ColumnFit) -> f64| fits[k].as_ref().map_or(0.0, what);
                    (0..n.candidates.len())
                        .map(|c| {
                            let value = |k: usize| of(k, &|fit| fit.candidates[c].0);
                            let possible = (0..widths.len()).filter(|&k| plausible(k)).map(value);
                            Estimate {
                                value: average(&value),
                                error: average(&|k| of(k, &|fit| fit.candidates[c].1)),
                                variance_ratio: average(&|k| of(k, &|fit| fit.variance_ratio)),
                                range: [
                                    possible.clone().fold(f64::INFINITY, f64::min),
                                    possible.fold(0.0, f64::max),
                                ],
                            }
                        })
                        .collect()
                })
                .collect();
            (average(&|k| widths[k]), estimates)
        })
        .collect()
}

/// Lobe widths to try, widest first, each squared width 1/sqrt(2) of the one before.
fn widths(table: &Table) -> Vec<f64> {
    let narrowest = NARROWEST * cell_width(table.smallest_projected_solid_angle());
    let mut widths = vec![WIDEST];
    while let Some(&last) = widths.last() {
        let next = last * 0.5f64.powf(0.25);
        if next < narrowest {
            break;
        }
        widths.push(next);
    }
    widths
}

fn cell_width(projected_solid_angle: f64) -> f64 {
    projected_solid_angle.sqrt()
}

struct ColumnFit {
    /// Squared misfit relative to the data; none if there is nothing to fit.
    misfit: Option<f64>,
    /// Variance over value [1/sr].
    variance_ratio: f64,
    /// Value and standard error for each candidate.
    candidates: Vec<(f64, f64)>,
}

impl Neighbourhood {
    /// Find a column's candidates and the cells around them.
    pub fn of(table: &Table, columns: &Columns, column: usize) -> Self {
        let cells = table.cells(columns, column);
        let touched = path(table, columns, column);
        let mut candidates = Vec::new();
        let mut others = Vec::new();
        for cell in cells {
            if touched.contains(&cell.index) { candidates.push(cell) } else { others.push(cell) }
        }
        let straight = columns.point(column, [0.5, 0.5]);
        let width = candidates.iter().map(|c| cell_width(c.projected_solid_angle)).fold(0.0, f64::max);
        let mut near = within(table, &others, straight, REACH * width);
        if near.is_empty() {
            // In bases whose patches are long and narrow all others may lie further away: then the nearest ones.
            let all = within(table, &others, straight, f64::INFINITY);
            let nearest = all.iter().map(|n| n.1).fold(f64::INFINITY, f64::min);
            near = all.into_iter().filter(|n| n.1 <= nearest).collect();
        }
        let weights = near.iter().map(|(_, distance)| 1.0 / (1.0 + (distance / width).powi(2))).collect();
        let around = near.into_iter().map(|(cell, _)| cell).collect();
        let incident =
            product(quadrature(table)).into_iter().map(|(u, w)| (columns.point(column, u), w)).collect();
        Self { candidates, around, weights, incident }
    }

    /// Squared distances of quadrature points with their weights, candidates first. Made anew each time: kept for all columns they
    /// would take more memory than the table.
    fn squared_distances(&self, table: &Table) -> Vec<Vec<(f64, f64)>> {
        let cells = self.candidates.iter().chain(&self.around);
        cells
            .map(|cell| {
                let exits = product(quadrature(table)).into_iter().map(|(u, w)| (table.point(cell, u), w));
                exits
                    .flat_map(|(out, w)| {
                        self.incident.iter().map(move |(p, v)| ((out - *p).length_squared(), w * v))
                    })
                    .collect()
            })
            .collect()
    }

    /// Least squares for base and height, neither negative.
    fn fit(&self, values: &[f32], features: &[f64]) -> ColumnFit {
        if self.around.is_empty() {
            // One cell is all there is: nothing tells a peak from a smooth table, so it is smooth.
            let candidates = self.candidates.iter().map(|c| (f64::from(values[c.index]), 0.0)).collect();
            return ColumnFit { misfit: None, variance_ratio: 0.0, candidates };
        }
        let (at_candidates, at_others) = features.split_at(self.candidates.len());
        let mut m = [0.0; 6]; // sums of w, wg, wgg, wy, wgy, wyy
        for ((cell, &w), &g) in self.around.iter().zip(&self.weights).zip(at_others) {
            let y = f64::from(values[cell.index]);
            for (sum, term) in m.iter_mut().zip([1.0, g, g * g, y, g * y, y * y]) {
                *sum += w * term;
            }
        }
        let [w, wg, wgg, wy, wgy, wyy] = m;
        if w <= 0.0 || wyy <= 0.0 {
            let candidates = vec![(0.0, 0.0); self.candidates.len()];
            return ColumnFit { misfit: None, variance_ratio: 0.0, candidates };
        }
        let determinant = w * wgg - wg * wg;
        let (mut base, mut height) = (wy / w, 0.0);
        let mut two_unknowns = false;
        if determinant > 1e-9 * w * wgg {
            let b = (wgg * wy - wg * wgy) / determinant;
            let a = (w * wgy - wg * wy) / determinant;
            if b >= 0.0 && a >= 0.0 {
                (base, height, two_unknowns) = (b, a, true);
            } else if b < 0.0 && wgg > 0.0 {
                (base, height) = (0.0, wgy / wgg);
            }
        }
        let square = wyy - 2.0 * (base * wy + height * wgy)
            + base * base * w
            + 2.0 * base * height * wg
            + height * height * wgg;
        let square = square.max(0.0);
        // Mean square misfit of a cell next to the peak (weight 1), and how it grows towards the middle of the fit.
        let variance = square / w;
        let candidates = at_candidates
            .iter()
            .map(|&g| {
                let leverage = if two_unknowns {
                    (wgg - 2.0 * g * wg + g * g * w) / determinant
                } else if base == 0.0 && wgg > 0.0 {
                    g * g / wgg
                } else {
                    1.0 / w
                };
                (base + height * g, (variance * (1.0 + leverage.max(0.0))).sqrt())
            })
            .collect();
        ColumnFit { misfit: Some(square / wyy), variance_ratio: square / wy, candidates }
    }
}

/// The lobe of height 1 and a width, averaged over each cell.
fn lobe_averages(squared_distances: &[Vec<(f64, f64)>], width: f64) -> Vec<f64> {
    let k = -0.5 / (width * width);
    squared_distances.iter().map(|d| d.iter().map(|(d2, w)| w * (k * d2).exp()).sum()).collect()
}

fn quadrature(table: &Table) -> &'static [(f64, f64)] {
    if matches!(table, Table::Matrix(_)) { &QUADRATURE_WIDE } else { &QUADRATURE }
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
    // Off the border on which the straight direction runs in isotropic trees.
    const BESIDE: f64 = 1e-7;
    let n = if matches!(table, Table::Matrix(_)) { 16 } else { 2 };
    let mut touched = Vec::new();
    for i in 0..n * n {
        let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
        let p = columns.point(column, u);
        // Columns of isotropic tables have their points on the x axis already.
        let sides: &[f64] = if table.is_isotropic() { &[-BESIDE, BESIDE] } else { &[0.0] };
        for &dy in sides {
            let index = table.index(p, p + DVec2::new(0.0, dy));
            if !touched.contains(&index) {
                touched.push(index);
            }
        }
    }
    touched
}
