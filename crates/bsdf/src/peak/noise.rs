//! How the values of a table scatter around what they should be.

/// The noise of a value: counted rays (variance proportional to the value) or a relative error (proportional to its square).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Noise {
    /// Variance over value [1/sr]: what one ray adds to a cell.
    Counted(f64),
    /// Variance over squared value [-].
    Relative(f64),
}

/// Median of a squared standard normal number: medians of squares over this are variances, and a few cells that the model of the lobe
/// does not fit move them little.
const MEDIAN_OF_SQUARES: f64 = 0.454_936;

/// Squared relative error from which it is none: a third, with which nobody measures.
const MOST_RELATIVE: f64 = 0.1;

impl Noise {
    /// Variance of a value [1/sr²].
    pub fn variance(self, value: f64) -> f64 {
        match self {
            Self::Counted(ratio) => ratio * value.max(0.0),
            Self::Relative(ratio) => ratio * value * value,
        }
    }

    /// Variance of the flux [-] in a cell of a projected solid angle [sr]. Of counted rays all that are in the cell cannot be more
    /// than all (binomial).
    pub fn flux_variance(self, value: f64, area: f64) -> f64 {
        let others = match self {
            Self::Counted(_) => (1.0 - value * area).max(0.0),
            Self::Relative(_) => 1.0,
        };
        self.variance(value) * area * area * others
    }

    /// What one ray adds to a cell [1/sr]; nothing where nobody counted.
    pub fn quantum(self) -> f64 {
        match self {
            Self::Counted(ratio) => ratio,
            Self::Relative(_) => 0.0,
        }
    }

    /// The likelier kind for a whole table, and how much: the median of its columns.
    pub fn of_table(columns: &[ColumnNoise]) -> Self {
        let known: Vec<&ColumnNoise> = columns.iter().filter(|c| c.count > 0.0).collect();
        let median = |kind: usize| median(known.iter().map(|c| c.ratios[kind]).collect());
        let count: f64 = known.iter().map(|c| c.count).sum::<f64>().max(1.0);
        let mean = |of: &dyn Fn(&ColumnNoise) -> f64| known.iter().map(|c| of(c)).sum::<f64>() / count;
        // Gaussian likelihoods: the log of the ratio plus that of the value or of its square, the smaller the likelier.
        let score = |kind: usize| {
            let ratio = mean(&|c| c.squares[kind]).max(f64::MIN_POSITIVE);
            ratio.ln() + (kind + 1) as f64 * mean(&|c| c.logarithms)
        };
        let is_relative = score(1) < score(0) && mean(&|c| c.squares[1]) < MOST_RELATIVE;
        if is_relative { Self::Relative(median(1)) } else { Self::Counted(median(0)) }
    }

    /// The same kind, at least as large as the ratio of this kind (0 counted, 1 relative) says.
    pub fn at_least(self, ratio: impl Fn(usize) -> f64) -> Self {
        match self {
            Self::Counted(pooled) => Self::Counted(pooled.max(ratio(0))),
            Self::Relative(pooled) => Self::Relative(pooled.max(ratio(1))),
        }
    }
}

/// What the cells around one peak say of the noise.
#[derive(Clone, Copy, Debug, Default)]
pub struct ColumnNoise {
    count: f64,
    /// Sums of squared misfits over the value, and over its square.
    squares: [f64; 2],
    /// Variance over the value, and over its square, from medians.
    ratios: [f64; 2],
    logarithms: f64,
}

impl ColumnNoise {
    /// From pairs of a value and what it should be.
    pub fn of(pairs: impl Iterator<Item = (f64, f64)>) -> Self {
        let known: Vec<(f64, f64)> = pairs.filter(|(_, fit)| *fit > 0.0).collect();
        let ratio = |power: i32| {
            median(known.iter().map(|(v, fit)| (v - fit).powi(2) / fit.powi(power)).collect())
                / MEDIAN_OF_SQUARES
        };
        Self {
            count: known.len() as f64,
            squares: [1, 2]
                .map(|power| known.iter().map(|(v, fit)| (v - fit).powi(2) / fit.powi(power)).sum()),
            ratios: [ratio(1), ratio(2)],
            logarithms: known.iter().map(|(_, fit)| fit.ln()).sum(),
        }
    }
}

/// The middle one of some values, or 0.
pub fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counted_and_relative_noise_are_told_apart() {
        // Values from 0.01 to 1.
        let column = |sigma: &dyn Fn(f64) -> f64| {
            ColumnNoise::of((0..1000).map(|i| {
                let value = 0.01 * 100f64.powf(f64::from(i) / 999.0);
                // A uniform number with the median square of a normal one.
                let number = ((f64::from(i) * 0.618_034).fract() - 0.5) / 0.25 * MEDIAN_OF_SQUARES.sqrt();
                (value + number * sigma(value), value)
            }))
        };
        let counted = Noise::of_table(&[column(&|v| (1e-4 * v).sqrt())]);
        assert!(matches!(counted, Noise::Counted(r) if (r / 1e-4 - 1.0).abs() < 0.02), "{counted:?}");
        let relative = Noise::of_table(&[column(&|v| 0.01 * v)]);
        assert!(matches!(relative, Noise::Relative(r) if (r / 1e-4 - 1.0).abs() < 0.02), "{relative:?}");
    }
}
