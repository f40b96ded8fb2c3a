//! When is a picture good enough? Its standard error, from how the passes differ.

use sunpeak_core::{Rgb, luminance};

/// Passes and samples before an estimate of the error means something.
const LEAST_PASSES: u32 = 5;
const LEAST_SAMPLES: u32 = 16;

/// Sums over groups of items, pass by pass.
pub(crate) struct ErrorEstimate {
    /// Which group an item belongs to.
    group: Vec<u32>,
    sizes: Vec<f64>,
    /// Sum of the groups' means after the last pass, times samples.
    sums: Vec<f64>,
    /// Sum over passes of samples times squared mean.
    squares: Vec<f64>,
    passes: u32,
    samples: u32,
}

impl ErrorEstimate {
    /// With the group of each item, numbered from 0.
    pub fn new(group: Vec<u32>) -> Self {
        let groups = group.iter().max().map_or(0, |&g| g as usize + 1);
        let mut sizes = vec![0.0; groups];
        group.iter().for_each(|&g| sizes[g as usize] += 1.0);
        let (sums, squares) = (vec![0.0; groups], vec![0.0; groups]);
        Self { group, sizes, sums, squares, passes: 0, samples: 0 }
    }

    /// Take in the items' sums after a pass that brought the number of samples to `samples`.
    pub fn add(&mut self, items: &[Rgb], samples: u32) {
        let pass = f64::from(samples - self.samples);
        let mut sums = vec![0.0; self.sums.len()];
        for (&group, &item) in self.group.iter().zip(items) {
            sums[group as usize] += luminance(item) / self.sizes[group as usize];
        }
        for ((square, before), now) in self.squares.iter_mut().zip(&self.sums).zip(&sums) {
            *square += (now - before).powi(2) / pass;
        }
        self.sums = sums;
        self.passes += 1;
        self.samples = samples;
    }

    /// Standard error of each group's mean; `None` while that cannot be told.
    pub fn standard_errors(&self) -> Option<Vec<f64>> {
        if self.passes < LEAST_PASSES || self.samples < LEAST_SAMPLES {
            return None;
        }
        let n = f64::from(self.samples);
        // The variance of one sample from the means of passes of unequal length, then that of the mean of all samples.
        let error = |(&square, &sum): (&f64, &f64)| {
            (((square - sum * sum / n) / f64::from(self.passes - 1)).max(0.0) / n).sqrt()
        };
        Some(self.squares.iter().zip(&self.sums).map(error).collect())
    }

    /// Root mean square of the groups' standard errors, each relative to the group's own mean, over those that have any light;
    /// `None` while that cannot be told.
    pub fn relative_to_own(&self) -> Option<f64> {
        let errors = self.standard_errors()?;
        let means = self.sums.iter().map(|sum| sum / f64::from(self.samples));
        let parts = errors.iter().zip(means).filter(|(_, mean)| *mean > 0.0);
        let (count, squares) =
            parts.fold((0.0, 0.0), |(n, sum), (error, mean)| (n + 1.0, sum + (error / mean).powi(2)));
        Some(if count > 0.0 { (squares / count).sqrt() } else { 0.0 })
    }

    /// Root mean square of the groups' standard errors, relative to the mean over all groups; `None` while that cannot be told.
    pub fn relative(&self) -> Option<f64> {
        let errors = self.standard_errors()?;
        let groups = errors.len() as f64;
        let variance: f64 = errors.iter().map(|error| error * error).sum();
        let mean = self.sums.iter().sum::<f64>() / f64::from(self.samples) / groups;
        Some(if mean > 0.0 { (variance / groups).sqrt() / mean } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;
    use sunpeak_core::gray;

    #[test]
    fn the_error_of_independent_numbers_is_their_deviation_over_the_root_of_their_count() {
        // Uniform numbers: mean 1/2, variance 1/12; four of them in a group.
        let (items, mut random) = (4000, Random(3));
        let mut estimate = ErrorEstimate::new((0..items).map(|i| i / 4).collect());
        let mut sums = vec![Rgb::ZERO; items as usize];
        let mut done = 0;
        for pass in [1, 1, 2, 4, 8, 16, 16] {
            for sum in &mut sums {
                for _ in 0..pass {
                    *sum += gray(random.next());
                }
            }
            done += pass;
            estimate.add(&sums, done);
        }
        let truth = (1.0f64 / 12.0 / 4.0 / f64::from(done)).sqrt() / 0.5;
        let error = estimate.relative().expect("enough samples");
        assert!((error / truth - 1.0).abs() < 0.05, "{error} {truth}");
    }

    #[test]
    fn a_dim_group_counts_as_much_as_a_bright_one() {
        let (mut random, mut estimate) = (Random(5), ErrorEstimate::new(vec![0, 1, 2]));
        let mut sums = vec![Rgb::ZERO; 3];
        for done in 1..=64 {
            sums[0] += gray(1e6);
            sums[1] += gray(random.next());
            estimate.add(&sums, done);
        }
        let own = estimate.relative_to_own().expect("enough samples");
        // Uniform numbers, and what is without error; the dark group does not count.
        let expected = (1.0f64 / 12.0 / 64.0).sqrt() / 0.5 / 2.0_f64.sqrt();
        assert!((own / expected - 1.0).abs() < 0.2, "{own} {expected}");
        assert!(estimate.relative().expect("enough samples") < 1e-6);
    }

    #[test]
    fn too_few_samples_say_nothing() {
        let mut estimate = ErrorEstimate::new(vec![0, 0]);
        estimate.add(&[Rgb::ONE, Rgb::ONE], 16);
        assert_eq!(estimate.relative(), None);
    }
}
