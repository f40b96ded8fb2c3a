//! How far are the means from the truth, and where do more samples help most? Told from how passes differ.
//!
//! A pass has a nominal number of samples per item, by which its mean counts in the mean of all; how many samples a group of
//! items really gets in it may differ from that. Whatever the passes before have found, a pass's mean is unbiased, and so is the
//! mean of all: that groups with much noise get more samples does not favour what they found by chance (Kirk and Arvo 1991,
//! "Unbiased sampling techniques for image synthesis").

use sunpeak_core::{Rgb, luminance};

/// Passes before an estimate of the error means something.
const LEAST_PASSES: usize = 4;

/// Samples of an item before it does, or else of the largest group: so many that what is seldom met is not missed by all passes alike.
const LEAST_SAMPLES: u32 = 16;
const LEAST_OF_GROUP: f64 = 1024.0;

/// Passes before noise is told apart by place.
const LEAST_TO_ALLOT: usize = 4;

/// Least and most samples of a group in a pass, over the nominal number.
const ALLOTTED: (f64, f64) = (0.25, 16.0);

/// Standard deviations of a normal distribution below which 95 % of it lie.
const UPPER_95: f64 = 1.645;

/// Items whose error counts together.
pub(crate) struct Groups {
    /// The group of each item, numbered from 0.
    of: Vec<u32>,
    /// Items of each group.
    sizes: Vec<f64>,
    /// Columns of the grid in which groups stand row after row, if they do.
    columns: Option<usize>,
}

impl Groups {
    /// Each item by itself.
    pub fn each(items: usize) -> Self {
        Self { of: (0..items as u32).collect(), sizes: vec![1.0; items], columns: None }
    }

    /// Blocks of a picture: the block of each item, and in how many columns the blocks stand. All have items.
    pub fn grid(of: Vec<u32>, columns: usize) -> Self {
        let mut sizes = vec![0.0; of.iter().max().map_or(0, |&g| g as usize + 1)];
        of.iter().for_each(|&g| sizes[g as usize] += 1.0);
        Self { of, sizes, columns: Some(columns) }
    }

    /// The group of an item.
    pub fn of(&self, item: usize) -> usize {
        self.of[item] as usize
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// Means over each group and its neighbours in a grid of so many columns.
    fn smoothed(&self, values: &[f64], columns: usize) -> Vec<f64> {
        let rows = values.len().div_ceil(columns);
        let around = |i: usize, end: usize| i.saturating_sub(1)..(i + 2).min(end);
        let mean = |group: usize| {
            let near = around(group / columns, rows)
                .flat_map(|row| around(group % columns, columns).map(move |column| row * columns + column));
            let (sum, count) =
                near.filter_map(|i| values.get(i)).fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
            sum / count
        };
        (0..values.len()).map(mean).collect()
    }
}

/// What one pass found.
struct Pass {
    /// Samples by which it counts.
    nominal: f64,
    /// Mean of each group.
    means: Vec<f32>,
}

/// What the passes so far tell.
pub(crate) struct ErrorEstimate {
    groups: Groups,
    passes: Vec<Pass>,
    /// Sums over passes of each group's mean times nominal samples.
    sums: Vec<f64>,
    /// Sums over passes of nominal samples squared over samples that the group got: the variance of the mean of all is that of a
    /// single sample times this, over nominal samples squared.
    spreads: Vec<f64>,
    /// Nominal samples of an item.
    samples: u32,
}

impl ErrorEstimate {
    pub fn new(groups: Groups) -> Self {
        let (sums, spreads) = (vec![0.0; groups.count()], vec![0.0; groups.count()]);
        Self { groups, passes: Vec::new(), sums, spreads, samples: 0 }
    }

    pub fn groups(&self) -> &Groups {
        &self.groups
    }

    /// Samples per item of each group in a pass of `nominal` samples: in proportion to the standard deviation of the group and its
    /// neighbours, so that the sum of the variances becomes smallest; all alike where that is not known.
    pub fn allotment(&self, nominal: u32) -> Vec<u32> {
        let Some(columns) = self.groups.columns.filter(|_| self.passes.len() >= LEAST_TO_ALLOT) else {
            return vec![nominal; self.groups.count()];
        };
        let of_sample = |(variance, spread): (f64, &f64)| variance / spread;
        let variances: Vec<f64> = self.variances().into_iter().zip(&self.spreads).map(of_sample).collect();
        let variances = self.groups.smoothed(&variances, columns);
        // Where there is no noise, as outside a fisheye's circle, samples cost little and bring nothing.
        let noisy = || self.groups.sizes.iter().zip(&variances).filter(|(_, variance)| **variance > 0.0);
        let whole: f64 = noisy().map(|(size, _)| size).sum();
        let (least, most) = ALLOTTED;
        let share = |variance: f64, scale: f64| (variance.sqrt() * scale).clamp(least, most);
        // Limits take from some what others must get: a few rounds settle it.
        let mut scale = noisy().map(|(_, variance)| variance.sqrt()).fold(0.0, f64::max).recip();
        for _ in 0..8 {
            let spent: f64 = noisy().map(|(size, &variance)| size * share(variance, scale)).sum();
            scale *= whole / spent;
        }
        let nominal = f64::from(nominal);
        let rounded = |&variance: &f64| match variance > 0.0 {
            true => (share(variance, scale) * nominal).round().max(1.0) as u32,
            false => (least * nominal).ceil() as u32,
        };
        variances.iter().map(rounded).collect()
    }

    /// Take in a pass: the items' means times `nominal`, and how many samples each group got per item.
    pub fn add(&mut self, items: &[Rgb], nominal: u32, allotment: &[u32]) {
        let mut means = vec![0.0; self.sums.len()];
        for (&group, &item) in self.groups.of.iter().zip(items) {
            means[group as usize] += luminance(item) / self.groups.sizes[group as usize];
        }
        let samples = f64::from(nominal);
        for (group, mean) in means.iter_mut().enumerate() {
            self.sums[group] += *mean;
            self.spreads[group] += samples * samples / f64::from(allotment[group]);
            *mean /= samples;
        }
        self.passes.push(Pass { nominal: samples, means: means.iter().map(|&mean| mean as f32).collect() });
        self.samples += nominal;
    }

    /// Variance of each group's mean of all passes, whatever the variance of each pass is: with weights w that sum to 1 the expected
    /// square of `x - mean` is (1 - 2 w) times the variance of `x` plus that of the mean, which leaves one equation for the latter.
    /// No pass may have half of the weight. (Passes of a low-discrepancy sequence converge faster than 1/n, so that the long ones vary less
    /// than short ones make believe.)
    fn variances(&self) -> Vec<f64> {
        let n = f64::from(self.samples);
        let means: Vec<f64> = self.means().collect();
        let (mut sums, mut whole) = (vec![0.0; means.len()], 1.0);
        for pass in &self.passes {
            let weight = pass.nominal / n;
            let share = weight * weight / (1.0 - 2.0 * weight);
            whole += share;
            for ((sum, &x), mean) in sums.iter_mut().zip(&pass.means).zip(&means) {
                *sum += share * (f64::from(x) - mean).powi(2);
            }
        }
        sums.into_iter().map(|sum| sum / whole).collect()
    }

    /// Independent passes of equal weight that would tell as much about the error.
    fn equal_passes(&self) -> f64 {
        let squares: f64 = self.passes.iter().map(|pass| pass.nominal * pass.nominal).sum();
        f64::from(self.samples).powi(2) / squares
    }

    /// Are there enough passes and samples to tell errors from?
    fn is_known(&self) -> bool {
        let of_group =
            self.groups.sizes.iter().fold(0.0, |most: f64, &size| most.max(size)) * f64::from(self.samples);
        self.passes.len() >= LEAST_PASSES && (self.samples >= LEAST_SAMPLES || of_group >= LEAST_OF_GROUP)
    }

    /// Standard error of each group's mean; `None` while that cannot be told.
    pub fn standard_errors(&self) -> Option<Vec<f64>> {
        self.is_known().then(|| self.variances().into_iter().map(f64::sqrt).collect())
    }

    /// Mean of each group.
    fn means(&self) -> impl Iterator<Item = f64> {
        self.sums.iter().map(|sum| sum / f64::from(self.samples))
    }

    /// 95 % bound of the root mean square of the groups' errors, each relative to the group's own mean, over those that have any
    /// light; `None` while that cannot be told.
    pub fn relative_to_own(&self) -> Option<f64> {
        let errors = self.standard_errors()?;
        let with_light = errors.iter().zip(self.means()).filter(|(_, mean)| *mean > 0.0);
        let relative: Vec<f64> = with_light.map(|(error, mean)| error / mean).collect();
        Some(self.bound(&relative))
    }

    /// 95 % bound of the root mean square of the groups' errors, relative to the mean over all groups; `None` while that cannot
    /// be told.
    pub fn relative(&self) -> Option<f64> {
        let errors = self.standard_errors()?;
        let mean = self.means().sum::<f64>() / errors.len() as f64;
        Some(if mean > 0.0 { self.bound(&errors) / mean } else { 0.0 })
    }

    /// Below what does the root mean square of the groups' true errors lie in 95 of 100 cases? Both the true errors and our estimates of
    /// their spread vary by chance: the more so, the fewer groups make up the sum.
    fn bound(&self, errors: &[f64]) -> f64 {
        let power = |k: i32| errors.iter().map(|error| error.powi(k)).sum::<f64>();
        let (squares, fourths) = (power(2), power(4));
        if squares <= 0.0 {
            return 0.0;
        }
        let concentration = fourths / (squares * squares);
        let deviation = (concentration * (1.0 + 1.0 / (self.equal_passes() - 1.0)) / 2.0).sqrt();
        (squares / errors.len() as f64).sqrt() * (1.0 + UPPER_95 * deviation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;
    use sunpeak_core::gray;

    /// Uniform numbers for groups of four items, pass after pass: nominal samples of each.
    fn uniform(random: &mut Random, estimate: &mut ErrorEstimate, items: usize, passes: &[u32]) {
        for &nominal in passes {
            let allotment = estimate.allotment(nominal);
            let mut draw = |item: usize| {
                let m = allotment[estimate.groups().of(item)];
                let sum: f64 = (0..m).map(|_| random.next()).sum();
                gray(sum * f64::from(nominal) / f64::from(m))
            };
            let means: Vec<Rgb> = (0..items).map(&mut draw).collect();
            estimate.add(&means, nominal, &allotment);
        }
    }

    #[test]
    fn the_error_of_independent_numbers_is_their_deviation_over_the_root_of_their_count() {
        // Uniform numbers: mean 1/2, variance 1/12; four of them in a group.
        let (items, mut random) = (4000, Random(3));
        for columns in [None, Some(20)] {
            let mut groups = Groups::grid((0..items as u32).map(|i| i / 4).collect(), 20);
            groups.columns = columns;
            let mut estimate = ErrorEstimate::new(groups);
            uniform(&mut random, &mut estimate, items, &[1, 1, 1, 1, 2, 2, 4, 4, 8, 8, 16]);
            let truth = (1.0f64 / 12.0 / 4.0 / 48.0).sqrt() / 0.5;
            let error = estimate.relative().expect("enough samples");
            // The bound is above the mean by what a thousand groups vary.
            assert!((0.99..1.09).contains(&(error / truth)), "{error} {truth}");
        }
    }

    #[test]
    fn the_bound_holds_in_19_of_20_cases() {
        let mut random = Random(9);
        for groups in [1, 3, 40] {
            let holds = |_: &u32| {
                let mut estimate = ErrorEstimate::new(Groups::each(groups));
                let mut sums = vec![0.0; groups];
                for _ in 0..24 {
                    // About normal: the mean of twelve uniform numbers.
                    let pass: Vec<f64> =
                        (0..groups).map(|_| (0..12).map(|_| random.next()).sum::<f64>() / 12.0).collect();
                    sums.iter_mut().zip(&pass).for_each(|(sum, x)| *sum += x);
                    estimate.add(&pass.iter().map(|&x| gray(x)).collect::<Vec<_>>(), 1, &vec![1; groups]);
                }
                let square = sums.iter().map(|sum| (sum / 24.0 - 0.5).powi(2)).sum::<f64>() / groups as f64;
                let bound = estimate.relative().expect("enough samples");
                square.sqrt() / (sums.iter().sum::<f64>() / 24.0 / groups as f64) <= bound
            };
            let held = (0..2000).filter(holds).count();
            assert!((1840..1980).contains(&held), "{groups} groups: {held} of 2000");
        }
    }

    #[test]
    fn noisy_blocks_get_more_samples_and_nothing_is_biased() {
        // A grid of 12 by 12 blocks of one item. One corner is ten times as noisy, one is dark. Rare large values would be favoured
        // if samples counted alike.
        let (columns, mut random) = (12, Random(11));
        let scale = |group: usize| match (group / columns, group % columns) {
            (0..=3, 0..=3) => 10.0,
            (8.., 8..) => 0.0,
            _ => 1.0,
        };
        let mut mean = [0.0; 2];
        let mut ratio = 0.0;
        let runs = 3000;
        for _ in 0..runs {
            let mut estimate = ErrorEstimate::new(Groups::grid((0..144).collect(), columns));
            let mut sums = vec![0.0; 144];
            for nominal in [1, 1, 1, 1, 2, 2, 4, 4] {
                let allotment = estimate.allotment(nominal);
                let mut one = |group: usize| {
                    let m = allotment[group];
                    let mut rare = || if random.next() < 0.1 { 10.0 * scale(group) } else { 0.0 };
                    (0..m).map(|_| rare()).sum::<f64>() / f64::from(m) * f64::from(nominal)
                };
                let pass: Vec<f64> = (0..144).map(&mut one).collect();
                sums.iter_mut().zip(&pass).for_each(|(sum, x)| *sum += x);
                estimate.add(&pass.iter().map(|&x| gray(x)).collect::<Vec<_>>(), nominal, &allotment);
                if nominal == 4 {
                    let of = |group: usize| f64::from(allotment[group]);
                    ratio += of(13) / of(78) / f64::from(2 * runs);
                    let spent: f64 = (0..144).filter(|&g| scale(g) > 0.0).map(of).sum();
                    assert!((spent / 4.0 / 128.0 - 1.0).abs() < 0.25, "{spent}");
                }
            }
            mean[0] += sums[13] / 16.0 / f64::from(runs);
            mean[1] += sums[78] / 16.0 / f64::from(runs);
        }
        assert!(ratio > 5.0, "{ratio}");
        // A sample varies by 3; some 16 count in each run.
        let error = 3.0 / (16.0 * f64::from(runs)).sqrt();
        assert!((mean[0] / 10.0 - 1.0).abs() < 4.0 * error, "{mean:?}");
        assert!((mean[1] - 1.0).abs() < 8.0 * error, "{mean:?}");
    }

    #[test]
    fn a_dim_group_counts_as_much_as_a_bright_one() {
        let (mut random, mut estimate) = (Random(5), ErrorEstimate::new(Groups::each(3)));
        for _ in 0..64 {
            estimate.add(&[gray(1e6), gray(random.next()), Rgb::ZERO], 1, &[1; 3]);
        }
        let own = estimate.relative_to_own().expect("enough samples");
        // Uniform numbers, and what is without error; the dark group does not count. One group alone has a wide bound.
        let expected =
            (1.0f64 / 12.0 / 64.0).sqrt() / 0.5 / 2.0_f64.sqrt() * (1.0 + UPPER_95 / 2.0_f64.sqrt());
        assert!((own / expected - 1.0).abs() < 0.2, "{own} {expected}");
        assert!(estimate.relative().expect("enough samples") < 1e-6);
    }

    #[test]
    fn long_passes_may_vary_less_than_short_ones_make_believe() {
        // Normal numbers whose deviation falls as 1/m, in passes of growing length.
        let (mut random, passes, runs) = (Random(13), [1, 1, 1, 1, 2, 2, 4, 4, 8], 4000);
        let mut estimate = ErrorEstimate::new(Groups::each(runs));
        let mut sums = vec![0.0; runs];
        for nominal in passes {
            let mut normal = || (0..12).map(|_| random.next()).sum::<f64>() - 6.0;
            let pass: Vec<f64> = (0..runs).map(|_| 100.0 * f64::from(nominal) + normal()).collect();
            sums.iter_mut().zip(&pass).for_each(|(sum, x)| *sum += x);
            let pass: Vec<Rgb> = pass.iter().map(|&x| gray(x)).collect();
            estimate.add(&pass, nominal, &vec![nominal; runs]);
        }
        let n = f64::from(passes.iter().sum::<u32>());
        let truth = sums.iter().map(|sum| (sum / n - 100.0).powi(2)).sum::<f64>() / runs as f64;
        let stated = estimate.variances().iter().sum::<f64>() / runs as f64;
        assert!((stated / truth - 1.0).abs() < 0.08, "{stated} {truth}");
    }

    #[test]
    fn too_few_samples_say_nothing() {
        let mut estimate = ErrorEstimate::new(Groups::each(2));
        estimate.add(&[Rgb::ONE, Rgb::ONE], 16, &[16, 16]);
        assert_eq!(estimate.relative(), None);
    }
}
