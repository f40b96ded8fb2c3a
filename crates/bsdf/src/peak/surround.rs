//! What the smooth BTDF would be under the peak, judged from the cells around it.
//!
//! Around the straight direction a smooth lobe is modelled as `b + a g`, `g` a Gaussian that follows the straight direction while the
//! incidence moves over its column. Base `b` and height `a` are fitted to each column, by least squares weighted to the nearest
//! cells; the Gaussian's width, and whether it keeps it in angle or on the disk, are chosen where this column and the table as a
//! whole agree best with their cells; equals are averaged. Both the data and the model are averages over cells, so that coarse
//! bases are treated fairly.

use super::{
    fit::Fit,
    neighbourhood::{Neighbourhood, Region},
    noise::{ColumnNoise, Noise, median},
    shape::{Shape, shapes},
};
use crate::{
    kernel::Spread,
    table::{Columns, Table},
};
use rayon::prelude::*;

/// A shape is as good as the best one if its misfit is within this factor of it …
const AS_GOOD: f64 = 1.3;

/// … and still possible within this one.
const PLAUSIBLE: f64 = 4.0;

/// Squared relative misfit below which the data do not tell (0.03 %: the digits that files have).
const GOOD_ENOUGH: f64 = 1e-7;

/// The smooth BTDF under one cell of the peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Most likely value [1/sr].
    pub value: f64,
    /// Standard error of it [1/sr].
    pub error: f64,
    /// Standard deviation of a cell that has this value [1/sr].
    pub spread: f64,
    /// Lowest and highest value over all lobe shapes that fit about as well [1/sr].
    pub range: [f64; 2],
}

/// The surround of one column.
#[derive(Debug)]
pub struct Surround {
    /// Where the peak would be.
    pub region: Region,
    /// No cell lies around it.
    pub alone: bool,
    /// By channel, by cell of the core.
    pub cells: Vec<Vec<Estimate>>,
    /// Standard deviation of the smooth lobe.
    pub lobe_sigma: f64,
    /// How the table's cells scatter around what they should be.
    pub noise: Noise,
    /// The same with what the model of the lobe does not fit around this column.
    pub misfit: Noise,
}

/// The surround of every column's core, by channel; `blur` is what an instrument made of a delta.
pub fn estimate(
    table: &Table,
    columns: &Columns,
    channels: &[&[f32]],
    blur: Option<Spread>,
) -> Vec<Surround> {
    let shapes = shapes(table, blur);
    let fits: Vec<ColumnFits> = (0..columns.len())
        .into_par_iter()
        .map(|column| {
            let neighbourhood = Neighbourhood::of(table, columns, column, blur);
            ColumnFits::new(table, columns, column, neighbourhood, channels, &shapes)
        })
        .collect();
    let table_misfit: Vec<f64> = (0..shapes.len())
        .map(|k| {
            let found = fits.iter().map(|f| &f.channels[0][k]).filter(|f| f.is_something());
            // Not the mean: columns that no shape fits, as at grazing incidence, must not decide for the others.
            median(found.map(Fit::misfit).collect())
        })
        .collect();
    let noise: Vec<ColumnNoise> = fits.iter().map(|f| f.noise).collect();
    let pooled = Noise::of_table(&noise);
    fits.into_par_iter().map(|f| f.surround(&shapes, &table_misfit, pooled)).collect()
}

/// All shapes fitted to one column.
struct ColumnFits {
    region: Region,
    alone: bool,
    /// By channel, by shape.
    channels: Vec<Vec<Fit>>,
    /// By shape, by cell of the core: a lobe of height 1 averaged over the cell.
    at_core: Vec<f64>,
    noise: ColumnNoise,
}

impl ColumnFits {
    fn new(
        table: &Table,
        columns: &Columns,
        column: usize,
        n: Neighbourhood,
        channels: &[&[f32]],
        shapes: &[Shape],
    ) -> Self {
        let averages = n.averages(table, columns, column).of(shapes);
        let mut by_channel = vec![Vec::with_capacity(shapes.len()); channels.len()];
        let mut at_cores = Vec::with_capacity(shapes.len() * n.region.core.len());
        let mut best = (f64::INFINITY, Fit::default(), Vec::new());
        for lobe in averages {
            let (at_core, around) = lobe.split_at(n.region.core.len());
            for (fits, values) in by_channel.iter_mut().zip(channels) {
                fits.push(Fit::new(&n, values, at_core, around));
            }
            if let Some(fit) = by_channel[0].last().filter(|f: &&Fit| f.misfit() < best.0) {
                best = (fit.misfit(), *fit, around.to_vec());
            }
            at_cores.extend_from_slice(at_core);
        }
        let (_, fit, lobe) = best;
        let noise = ColumnNoise::of(
            n.around
                .iter()
                .zip(&lobe)
                .skip(n.region.fringe.len())
                .map(|((cell, _), &g)| (f64::from(channels[0][cell.index]), fit.value(g))),
        );
        let alone = n.around.is_empty();
        Self { region: n.region, alone, channels: by_channel, at_core: at_cores, noise }
    }

    fn surround(self, shapes: &[Shape], table_misfit: &[f64], pooled: Noise) -> Surround {
        let misfit = |k: usize| self.channels[0][k].misfit() + table_misfit[k];
        let best = (0..shapes.len()).map(misfit).fold(f64::INFINITY, f64::min);
        // Shapes that fit about as well share the estimate, so that it is a continuous function of the data.
        let tolerance = (AS_GOOD - 1.0) * best + GOOD_ENOUGH;
        let shares: Vec<f64> =
            (0..shapes.len()).map(|k| (1.0 - (misfit(k) - best) / tolerance).max(0.0)).collect();
        let total: f64 = shares.iter().sum();
        let average = |of: &dyn Fn(usize) -> f64| -> f64 {
            (0..shapes.len()).filter(|&k| shares[k] > 0.0).map(|k| shares[k] / total * of(k)).sum()
        };
        let possible: Vec<usize> =
            (0..shapes.len()).filter(|&k| misfit(k) <= PLAUSIBLE * (best + GOOD_ENOUGH)).collect();
        let local = pooled.at_least(|kind| average(&|k| self.channels[0][k].noise_ratios()[kind]));
        let cells = self.region.core.len();
        let estimate = |fits: &[Fit], cell: usize| {
            let at_core = |k: usize| self.at_core[k * cells + cell];
            let value = |k: usize| fits[k].value(at_core(k));
            let likely = average(&value);
            let variance = |k: usize| fits[k].variance().max(pooled.variance(likely));
            let leverage = |k: usize| fits[k].leverage(at_core(k));
            Estimate {
                value: likely,
                error: average(&|k| (variance(k) * leverage(k)).sqrt()),
                spread: average(&|k| variance(k).sqrt()),
                range: [
                    possible.iter().map(|&k| value(k)).fold(f64::INFINITY, f64::min),
                    possible.iter().map(|&k| value(k)).fold(0.0, f64::max),
                ],
            }
        };
        let by_channel =
            self.channels.iter().map(|fits| (0..cells).map(|cell| estimate(fits, cell)).collect()).collect();
        let lobe_sigma = average(&|k| shapes[k].sigma);
        let (region, alone) = (self.region, self.alone);
        Surround { region, alone, cells: by_channel, lobe_sigma, misfit: local, noise: pooled }
    }
}
