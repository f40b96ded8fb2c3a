//! Is what stands above the surround a peak?

use super::{
    neighbourhood::Region,
    split::{ColumnPeak, Part},
    surround::{Estimate, Surround},
};
use crate::table::Cell;
use glam::DVec3;
use sunpeak_core::Rgb;

/// What a peak must exceed.
#[derive(Clone, Copy, Debug)]
struct Threshold {
    /// Flux above the surround over the surround's: models of it are off by so much.
    contrast: f64,
    /// Standard errors.
    significance: f64,
}

/// A peak by itself: lobes that are not Gaussian are a tenth off; one of 16 000 columns of Gaussian noise has as much.
const CERTAIN: Threshold = Threshold { contrast: 0.1, significance: 4.0 };

/// Beside a column with a certain peak: a patch across the cut-off holds little of it, models are right where they were right next
/// door, and few columns are asked.
const LIKELY: Threshold = Threshold { contrast: 0.03, significance: 2.0 };

impl Threshold {
    /// Where rays were counted, few of them scatter lopsidedly: at the same odds a count lies higher by this many rays than the
    /// standard error says (the Cornish-Fisher expansion for Poisson's distribution).
    fn lopsided(self) -> f64 {
        (self.significance * self.significance - 1.0) / 6.0
    }
}

/// Standard errors on either side of an interval that holds 95 %.
const TWO_SIDED: f64 = 2.0;

/// One column: what stands above the surround, and what that is worth.
#[derive(Debug)]
pub struct Judged<'a> {
    surround: &'a Surround,
    /// Flux above the surround [-], luminous, and the surround's in the same cells.
    excess: f64,
    around: f64,
    /// Standard error of that [-], and what one ray adds to it.
    error: f64,
    quantum: f64,
    interval: [f64; 2],
}

impl<'a> Judged<'a> {
    /// Weigh a column's peak.
    pub fn new(channels: &[&[f32]], surround: &'a Surround) -> Self {
        let cells = || surround.region.core.iter().map(|b| &b.cell).zip(&surround.cells[0]);
        let value = |index: usize| f64::from(channels[0][index]);
        let sum = |of: &dyn Fn(&Estimate, f64) -> f64| -> f64 {
            cells().map(|(c, e)| of(e, value(c.index)) * c.projected_solid_angle).sum()
        };
        let variance = |of: &dyn Fn(&Estimate, f64) -> f64| -> f64 {
            cells().map(|(c, e)| of(e, value(c.index)) * c.projected_solid_angle.powi(2)).sum()
        };
        let error = sum(&|e, _| e.error);
        let largest = cells().map(|(c, _)| c.projected_solid_angle).fold(0.0, f64::max);
        let alone = (error * error + variance(&|e, _| e.spread * e.spread)).sqrt();
        let flux = |(c, _): (&Cell, &Estimate)| {
            surround.misfit.flux_variance(value(c.index), c.projected_solid_angle)
        };
        let counted = (error * error + cells().map(flux).sum::<f64>()).sqrt();
        // Where one cell is all there is, nothing tells a peak from a smooth table: it is smooth.
        let excess = if surround.alone { 0.0 } else { sum(&|e, v| v - e.value).max(0.0) };
        Self {
            surround,
            excess,
            around: sum(&|e, _| e.value.max(0.0)),
            error: alone,
            quantum: surround.noise.quantum() * largest,
            interval: [
                (sum(&|e, v| v - e.range[1]) - TWO_SIDED * counted).max(0.0),
                sum(&|e, v| v - e.range[0]).max(0.0) + TWO_SIDED * counted,
            ],
        }
    }

    /// Flux that a peak must exceed [-].
    fn limit(&self, threshold: Threshold) -> f64 {
        let noise = threshold.significance * self.error + threshold.lopsided() * self.quantum;
        noise.max(threshold.contrast * self.around)
    }

    /// A peak by itself.
    pub fn is_certain(&self) -> bool {
        self.excess > 0.0 && self.excess > self.limit(CERTAIN)
    }

    /// A peak if there is one next door.
    pub fn is_likely(&self) -> bool {
        self.excess > 0.0 && self.excess > self.limit(LIKELY)
    }

    /// What the split does in this column; `to_rgb` makes colours of the channels' values.
    pub fn part(&self, accepted: bool, to_rgb: impl Fn(&[f32]) -> Rgb, channels: &[&[f32]]) -> Part {
        let share = self.surround.region.core_share;
        let mut through = Rgb::ZERO;
        let mut cells = Vec::new();
        if accepted {
            let lowered: Vec<Vec<(usize, f64, f32)>> =
                (0..channels.len()).map(|k| self.lowered(channels[k], &self.surround.cells[k])).collect();
            for i in 0..lowered[0].len() {
                let (index, area, _) = lowered[0][i];
                let rest: Vec<f32> = lowered.iter().map(|channel| channel[i].2).collect();
                let whole: Vec<f32> = channels.iter().map(|c| c[index]).collect();
                // A channel may come out higher than the table's: from XYZ to RGB more is not always more.
                let rest = to_rgb(&rest).min(to_rgb(&whole));
                // From the stored numbers, so that residual and peak make up the table exactly.
                let stored = DVec3::from(rest.as_vec3());
                through += (to_rgb(&whole) - stored).max(Rgb::ZERO) * area;
                cells.push((index, rest));
            }
        }
        let limit = self.limit(CERTAIN) / share;
        let column = ColumnPeak {
            through,
            contrast: if self.around > 0.0 {
                self.excess / self.around
            } else if self.excess > 0.0 {
                f64::INFINITY
            } else {
                0.0
            },
            detection_limit: limit,
            interval: if accepted {
                self.interval.map(|bound| bound / share)
            } else {
                [0.0, limit.max(self.excess / share)]
            },
            lobe_sigma: self.surround.lobe_sigma,
        };
        (column, cells)
    }

    /// One channel's cells of the peak: index, projected solid angle [sr], and what stays [1/sr].
    fn lowered(&self, values: &[f32], estimates: &[Estimate]) -> Vec<(usize, f64, f32)> {
        let Region { core, fringe, core_share } = &self.surround.region;
        let above: Vec<f64> = core
            .iter()
            .zip(estimates)
            .map(|(b, e)| f64::from(values[b.cell.index]) - e.value.max(0.0))
            .collect();
        let flux = |only: &dyn Fn(f64) -> f64| -> f64 {
            above.iter().zip(core).map(|(&x, b)| only(x) * b.cell.projected_solid_angle).sum()
        };
        let (net, positive) = (flux(&|x| x).max(0.0), flux(&|x| x.max(0.0)));
        // Cells that noise left below their surround stay as they are; the others give what they have too little.
        let kept = if positive > 0.0 { net / positive } else { 0.0 };
        let lowered_core = above.iter().zip(core).map(|(&x, b)| {
            let value = f64::from(values[b.cell.index]);
            (b.cell.index, b.cell.projected_solid_angle, (value - kept * x.max(0.0)) as f32)
        });
        let through = net / core_share;
        let lowered_fringe = fringe.iter().map(|b| {
            let value = f64::from(values[b.cell.index]);
            let tail = through * b.share / b.cell.projected_solid_angle;
            (b.cell.index, b.cell.projected_solid_angle, (value - tail).max(0.0) as f32)
        });
        lowered_core.chain(lowered_fringe).collect()
    }
}
