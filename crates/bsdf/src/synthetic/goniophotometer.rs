//! A virtual goniophotometer: what a measurement, or a ray-traced table, adds to cell averages.

use crate::kernel::{HALF_WIDTH, Spread};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Binomial, Distribution as _, StandardNormal};

/// How a product is seen. The default is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goniophotometer {
    /// Rays for each incident cell, counted where they exit; none: exact averages.
    pub rays: Option<u64>,
    /// Relative standard deviation of each value [-], beside the counting.
    pub value_noise: f64,
    /// Full width at half maximum of what the instrument makes of a delta [deg]; it acts on what goes straight.
    pub fwhm_deg: f64,
    /// Of the random numbers.
    pub seed: u64,
}

impl Goniophotometer {
    /// Every value is its cell's average.
    pub fn is_exact(&self) -> bool {
        self.rays.is_none() && self.value_noise == 0.0
    }

    pub(super) fn blur(&self) -> Option<Spread> {
        (self.fwhm_deg > 0.0).then(|| Spread::Angle(self.fwhm_deg.to_radians() / HALF_WIDTH))
    }

    /// One column's values [1/sr] as they are seen; `area` gives the projected solid angle of a cell [sr].
    pub(super) fn counts(&self, exact: &[f64], area: impl Fn(usize) -> f64, column: usize) -> Vec<f64> {
        if self.is_exact() {
            return exact.to_vec();
        }
        let mut random = StdRng::seed_from_u64(self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ column as u64);
        // One ray after the other falls into this cell, into another, or is lost: a chain of binomials.
        let (mut left, mut chance) = (self.rays.unwrap_or(0), 1.0);
        let mut seen = Vec::with_capacity(exact.len());
        for (cell, &value) in exact.iter().enumerate() {
            let mut value = value;
            if let Some(rays) = self.rays {
                let share = value * area(cell);
                let p = if chance > 0.0 { (share / chance).clamp(0.0, 1.0) } else { 0.0 };
                let count = Binomial::new(left, p).map_or(0, |b| b.sample(&mut random));
                (left, chance) = (left - count, chance - share);
                value = count as f64 / rays as f64 / area(cell);
            }
            let noise: f64 = StandardNormal.sample(&mut random);
            seen.push(value * (1.0 + self.value_noise * noise).max(0.0));
        }
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_the_mean_and_the_spread_of_counting() {
        let (exact, n) = ([0.3, 0.0, 0.05], 2000);
        let area = |cell: usize| [1.0, 1.0, 2.0][cell];
        let rays = 400;
        let (mut sum, mut square) = ([0.0; 3], [0.0; 3]);
        for seed in 0..n {
            let seen = Goniophotometer { rays: Some(rays), seed, ..Default::default() };
            for (k, value) in seen.counts(&exact, area, 7).into_iter().enumerate() {
                sum[k] += value / n as f64;
                square[k] += value * value / n as f64;
            }
        }
        for k in [0, 2] {
            let share = exact[k] * area(k);
            let variance = share * (1.0 - share) / rays as f64 / area(k).powi(2);
            assert!((sum[k] - exact[k]).abs() < 5.0 * (variance / n as f64).sqrt(), "{k}");
            assert!(((square[k] - sum[k] * sum[k]) / variance - 1.0).abs() < 0.2, "{k}");
        }
        assert_eq!(sum[1], 0.0);
    }
}
