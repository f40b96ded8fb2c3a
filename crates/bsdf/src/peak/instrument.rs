//! Peaks that an instrument has widened: what a blur does to a delta in a table, and how it is found.
//!
//! An instrument sees a delta as a lobe of the width of its own acceptance, the same in angle at every incidence. A structure that
//! scatters keeps its lobe on the disk of projected directions (what it does to a wave follows from the sines), so that in angle it grows
//! as 1/cos(theta) in the plane of incidence. Which of the two a table shows is judged from all incidences together.

use super::{
    neighbourhood::{RULES, distances},
    nonnegative::least_squares,
    shape::Shape,
};
use crate::{
    kernel::{HALF_WIDTH, Kernel, Spread},
    table::{Cell, Columns, Table},
};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::HashMap;
use sunpeak_core::{Error, Result};

/// What an instrument made of a delta before the table was made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Instrument {
    /// Nothing: the table has it in the cells that the straight direction touches (computed tables, fine instruments).
    #[default]
    None,
    /// A lobe of this full width at half maximum [deg] around the straight direction, the same at all incidences.
    FwhmDeg(f64),
    /// Look for it: a lobe of constant angular width that follows the straight direction.
    Find,
}

/// Widths that a blur may have [deg, full width at half maximum].
pub const FWHM_RANGE_DEG: [f64; 2] = [0.05, 20.0];

impl Instrument {
    /// Is its width one that an instrument may have?
    pub fn check(self) -> Result<()> {
        let [low, high] = FWHM_RANGE_DEG;
        match self {
            Self::FwhmDeg(fwhm) if !(low..=high).contains(&fwhm) => Err(Error::value(format!(
                "instrument: full width at half maximum of {fwhm} degrees; expected {low} to {high}"
            ))),
            _ => Ok(()),
        }
    }
}

/// The Gaussian of a full width at half maximum [deg].
pub fn blur(fwhm_deg: f64) -> Spread {
    Spread::Angle(fwhm_deg.to_radians() / HALF_WIDTH)
}

/// Width in cells from which a Gaussian's averages over cells are taken from points of the cells; below, from points of the Gaussian.
const WIDE: f64 = 0.7;

/// Shares of a lobe's flux in cells of a column, which the lobe reaches.
pub fn shares(table: &Table, columns: &Columns, column: usize, cells: &[Cell], spread: Spread) -> Vec<f64> {
    let middle = columns.point(column, [0.5, 0.5]);
    let width = table.projected_solid_angle(middle, middle + DVec2::new(0.0, f64::EPSILON)).sqrt();
    if spread.sigma() < WIDE * width {
        return counted_shares(
            table,
            columns,
            column,
            cells,
            Kernel::new(spread, width),
            width / spread.sigma(),
        );
    }
    // Six standard deviations, and the cells' own extent.
    let reach = 6.0 * spread.sigma() + 2.0 * width;
    let near: Vec<bool> =
        cells.iter().map(|cell| (table.point(cell, [0.5, 0.5]) - middle).length() < reach).collect();
    let shape = Shape { sigma: spread.sigma(), in_angle: matches!(spread, Spread::Angle(_)) };
    let inside: Vec<&Cell> = cells.iter().zip(&near).filter(|(_, near)| **near).map(|(c, _)| c).collect();
    let rule = RULES[if spread.sigma() < 1.5 * width { 2 } else { 1 }];
    let averages = distances(table, columns, column, inside.iter().copied(), rule);
    let mut fluxes = inside.iter().zip(&averages).map(|(c, d)| c.projected_solid_angle * d.average(shape));
    let found: Vec<f64> =
        near.into_iter().map(|near| if near { fluxes.next().unwrap_or(0.0) } else { 0.0 }).collect();
    let sum: f64 = found.iter().sum();
    found.into_iter().map(|f| f / sum.max(f64::MIN_POSITIVE)).collect()
}

/// The same by counting where the lobe's points land; the incidence moves over the column in steps of a standard deviation.
fn counted_shares(
    table: &Table,
    columns: &Columns,
    column: usize,
    cells: &[Cell],
    kernel: Kernel,
    steps: f64,
) -> Vec<f64> {
    let n = steps.clamp(4.0, 16.0).ceil() as usize;
    let mut landed: HashMap<usize, f64> = HashMap::new();
    for i in 0..n * n {
        let u = match columns {
            // One coordinate only.
            Columns::Radial { .. } => [(i as f64 + 0.5) / (n * n) as f64, 0.5],
            _ => [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64],
        };
        let p = columns.point(column, u);
        let weight_of_point = 1.0 / (n * n) as f64;
        kernel.around(p, |q, weight| {
            *landed.entry(table.index(p, q)).or_insert(0.0) += weight * weight_of_point;
        });
    }
    cells.iter().map(|c| landed.get(&c.index).copied().unwrap_or(0.0)).collect()
}

/// So many columns are looked at; more tell nothing new.
const MOST_COLUMNS: usize = 24;

/// Incidences past this are left out: lobes there end at the horizon [sine of the angle].
const GRAZING: f64 = 0.94;

/// Lobes that may lie under the peak, standard deviations on the disk.
const LOBES: [f64; 3] = [0.15, 0.25, 0.4];

/// Cells within this distance on the disk take part, or so many widths of a cell.
const REGION: f64 = 0.35;
const REGION_CELLS: f64 = 3.0;

/// A blur is found if it leaves less than this share of the misfit that a delta leaves, and that the best lobe on the disk leaves.
const BETTER: f64 = 0.5;

/// Ladder of widths: factor from one to the next, and the finer one of a second look.
const STEP: f64 = std::f64::consts::SQRT_2;
const FINE_STEP: f64 = 1.15;

/// Smallest width that is looked for, in widths of a cell: less leaks less than a hundredth of the peak into the cells around.
const LEAST_WIDTH: f64 = 0.02;

/// Full width at half maximum [deg] of the blur that a table shows, if it shows one.
pub fn find(table: &Table, columns: &Columns) -> Option<f64> {
    let inside: Vec<usize> =
        (0..columns.len()).filter(|&c| columns.point(c, [0.5, 0.5]).length() < GRAZING).collect();
    let step = inside.len().div_ceil(MOST_COLUMNS).max(1);
    let views: Vec<View> =
        inside.into_par_iter().step_by(step).filter_map(|c| View::of(table, columns, c)).collect();
    let misfit = |spread: Option<Spread>| -> f64 {
        views.par_iter().map(|v| v.misfit(table, columns, spread)).sum::<f64>() / views.len().max(1) as f64
    };
    let [low, high] = FWHM_RANGE_DEG.map(|deg| deg.to_radians() / HALF_WIDTH);
    let low = low.max(LEAST_WIDTH * table.smallest_projected_solid_angle().sqrt());
    let widths: Vec<f64> =
        std::iter::successors(Some(low), |w| Some(w * STEP)).take_while(|&w| w <= high).collect();
    let delta = misfit(None);
    let in_angle: Vec<f64> = widths.iter().map(|&sigma| misfit(Some(Spread::Angle(sigma)))).collect();
    let best = (0..widths.len()).min_by(|&a, &b| in_angle[a].total_cmp(&in_angle[b]))?;
    if in_angle[best] >= BETTER * delta {
        return None;
    }
    let (sigma, left) = refined(widths[best], in_angle[best], |sigma| misfit(Some(Spread::Angle(sigma))));
    // A lobe on the disk is at least as wide in angle: not all widths have to be tried.
    let on_disk = widths.iter().filter(|&&w| w < STEP * sigma && w > 0.4 * sigma);
    let on_disk = on_disk.map(|&w| (w, misfit(Some(Spread::Projected(w)))));
    let (width, other) = on_disk.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let (_, other) = refined(width, other, |sigma| misfit(Some(Spread::Projected(sigma))));
    (left < BETTER * other).then_some(sigma.to_degrees() * HALF_WIDTH)
}

/// The width with the least misfit near one that has a small one: a finer look, then the vertex of a parabola.
fn refined(sigma: f64, left: f64, misfit: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut best, mut around) = ((sigma, left), [misfit(sigma / FINE_STEP), misfit(sigma * FINE_STEP)]);
    for _ in 0..2 {
        let (factor, side) = if around[0] < best.1 { (1.0 / FINE_STEP, 0) } else { (FINE_STEP, 1) };
        if around[side] >= best.1 {
            break;
        }
        let next = (best.0 * factor, around[side]);
        around[side] = misfit(next.0 * factor);
        around[1 - side] = best.1;
        best = next;
    }
    let shifted = best.0 * FINE_STEP.powf(vertex([around[0], best.1, around[1]]));
    let left = misfit(shifted);
    if left < best.1 { (shifted, left) } else { best }
}

/// Where the parabola through three values, one step apart, has its vertex.
fn vertex([before, here, after]: [f64; 3]) -> f64 {
    let bend = before - 2.0 * here + after;
    if bend > 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// One column's cells around the straight direction.
struct View {
    column: usize,
    cells: Vec<Cell>,
    values: Vec<f64>,
    /// By lobe of [`LOBES`], its averages over the cells.
    lobes: Vec<Vec<f64>>,
}

impl View {
    fn of(table: &Table, columns: &Columns, column: usize) -> Option<Self> {
        let middle = columns.point(column, [0.5, 0.5]);
        let all = table.cells(columns, column);
        let widest = all
            .iter()
            .filter(|c| (table.point(c, [0.5, 0.5]) - middle).length() < REGION)
            .map(|c| c.projected_solid_angle.sqrt())
            .fold(0.0, f64::max);
        let reach = REGION.max(REGION_CELLS * widest);
        let cells: Vec<Cell> =
            all.into_iter().filter(|c| (table.point(c, [0.5, 0.5]) - middle).length() < reach).collect();
        let values: Vec<f64> = cells.iter().map(|c| f64::from(table.values()[c.index])).collect();
        let averages = distances(table, columns, column, cells.iter(), RULES[1]);
        let lobe =
            |&sigma: &f64| averages.iter().map(|d| d.average(Shape { sigma, in_angle: false })).collect();
        let lobes = LOBES.iter().map(lobe).collect();
        values.iter().any(|v| *v > 0.0).then_some(Self { column, cells, values, lobes })
    }

    /// Squared misfit, relative to the values, of base, lobe and a peak of the spread (none: a delta), none of them negative.
    fn misfit(&self, table: &Table, columns: &Columns, spread: Option<Spread>) -> f64 {
        let spread = spread.unwrap_or(Spread::Angle(1e-6));
        let shares = shares(table, columns, self.column, &self.cells, spread);
        let peak: Vec<f64> =
            shares.iter().zip(&self.cells).map(|(s, c)| s / c.projected_solid_angle).collect();
        let base = vec![1.0; self.values.len()];
        let squares: f64 = self.values.iter().map(|v| v * v).sum();
        let fits = self.lobes.iter().map(|lobe| least_squares([&peak, &base, lobe], &self.values).misfit);
        fits.fold(f64::INFINITY, f64::min) / squares
    }
}
