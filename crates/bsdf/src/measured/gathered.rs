//! Many lobes as few: those of like width whose middles are close become one Gaussian of the same flux, middle and variance.

use super::lobes::Lobe;
use glam::DVec2;
use std::collections::BTreeMap;

/// Widths are sorted in classes, so many to a factor of two.
const CLASSES: f64 = 2.0;

/// Middles within a square of so many standard deviations come together.
const SQUARE: f64 = 0.5;

/// Class of the width, and square of the middle.
type Key = (i64, i64, i64);

/// Lobes by width and place.
#[derive(Debug, Default)]
pub struct Gathered(BTreeMap<Key, Sums>);

/// Sums over lobes, weighted by flux.
#[derive(Debug, Default)]
struct Sums {
    flux: f64,
    middle: DVec2,
    /// Of the variance along one axis, from the origin.
    square: f64,
}

impl Gathered {
    /// Add a share of a lobe.
    pub fn add(&mut self, lobe: &Lobe, share: f64) {
        let class = (CLASSES * lobe.sigma.log2()).floor();
        let square = SQUARE * (class / CLASSES).exp2();
        let [x, y] = (lobe.middle / square).floor().to_array();
        let sums = self.0.entry((class as i64, x as i64, y as i64)).or_default();
        let flux = lobe.flux * share;
        sums.flux += flux;
        sums.middle += lobe.middle * flux;
        sums.square += flux * (lobe.sigma.powi(2) + 0.5 * lobe.middle.length_squared());
    }

    /// The lobes that are left.
    pub fn lobes(&self) -> impl Iterator<Item = Lobe> + '_ {
        self.0.values().filter(|sums| sums.flux > 0.0).map(|sums| {
            let middle = sums.middle / sums.flux;
            let variance = sums.square / sums.flux - 0.5 * middle.length_squared();
            Lobe { middle, sigma: variance.max(0.0).sqrt(), flux: sums.flux }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flux_middle_and_variance_are_kept() {
        let lobes: Vec<Lobe> = (0..200)
            .map(|k| {
                let at = f64::from(k);
                let middle = DVec2::new((0.7 * at).sin() * 0.1, (1.3 * at).cos() * 0.1);
                Lobe { middle, sigma: 0.1 + 0.02 * (at * 0.37).sin(), flux: 1.0 + at.sin() }
            })
            .collect();
        let mut gathered = Gathered::default();
        lobes.iter().for_each(|lobe| gathered.add(lobe, 0.5));
        let few: Vec<Lobe> = gathered.lobes().collect();
        // Widths of 0.08 to 0.12 are two classes; middles up to 0.1 from the origin lie in 8 by 8 squares of 1/32 and 6 by 6 of 0.044.
        assert!(few.len() <= 64 + 36, "{}", few.len());
        let moments = |lobes: &[Lobe]| {
            let flux: f64 = lobes.iter().map(|l| l.flux).sum();
            let middle = lobes.iter().map(|l| l.middle * l.flux).sum::<DVec2>() / flux;
            let square = |l: &Lobe| l.flux * (l.sigma.powi(2) + 0.5 * l.middle.distance_squared(middle));
            [flux, middle.x, middle.y, lobes.iter().map(square).sum::<f64>() / flux]
        };
        let [flux, rest @ ..] = moments(&lobes);
        let [kept, others @ ..] = moments(&few);
        assert!((kept / flux - 0.5).abs() < 1e-12);
        rest.iter().zip(others).for_each(|(a, b)| assert!((a - b).abs() < 1e-12, "{a} {b}"));
    }
}
