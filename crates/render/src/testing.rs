//! What the tests of several modules need.

use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3};

/// Independent numbers in [0, 1): SplitMix64, so that chi-square tests see no low-discrepancy sequence.
pub(crate) struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

const BINS_Z: usize = 20;
const BINS_PHI: usize = 24;
const POINTS: usize = 24;

fn direction(z: f64, phi: f64) -> Vec3 {
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// Pearson's test of directions against their density, in bins of equal solid angle around a tilted axis.
pub(crate) fn chi_square_of_sampler(
    name: &str,
    sample: impl Fn(f64, [f64; 2]) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f64,
) {
    let n = 200_000;
    let mut random = Random(12345);
    let mut observed = vec![0.0; BINS_Z * BINS_PHI];
    for _ in 0..n {
        let (choice, u) = (random.next(), [random.next(), random.next()]);
        if let Some(d) = sample(choice, u) {
            let z = ((d.z + 1.0) / 2.0 * BINS_Z as f64) as usize;
            let turn = d.y.atan2(d.x) / (2.0 * PI);
            let phi = ((turn - turn.floor()) * BINS_PHI as f64) as usize;
            observed[z.min(BINS_Z - 1) * BINS_PHI + phi.min(BINS_PHI - 1)] += 1.0;
        }
    }
    let expected: Vec<f64> = (0..observed.len()).map(|bin| n as f64 * bin_probability(&pdf, bin)).collect();
    let (mut chi2, mut bins, mut rest) = (0.0, 0.0, (0.0, 0.0));
    for (o, e) in observed.iter().zip(&expected) {
        if *e < 5.0 {
            rest = (rest.0 + o, rest.1 + e);
        } else {
            chi2 += (o - e) * (o - e) / e;
            bins += 1.0;
        }
    }
    if rest.1 > 5.0 {
        chi2 += (rest.0 - rest.1) * (rest.0 - rest.1) / rest.1;
        bins += 1.0;
    } else {
        assert!(rest.0 < 40.0, "{name}: {} samples where {} were expected", rest.0, rest.1);
    }
    // Wilson and Hilferty 1931: the cube root of chi² is nearly normal.
    let spread = 2.0 / (9.0 * bins);
    let z = ((chi2 / bins).cbrt() - (1.0 - spread)) / spread.sqrt();
    assert!(z < 4.0, "{name}: chi² {chi2} in {bins} bins, {z} standard deviations");
}

fn bin_probability(pdf: &impl Fn(Vec3) -> f64, bin: usize) -> f64 {
    let solid_angle = 4.0 * PI / (BINS_Z * BINS_PHI) as f64;
    let at = |i: usize, j: usize| {
        let z = 2.0 * ((bin / BINS_PHI) as f64 + (i as f64 + 0.5) / POINTS as f64) / BINS_Z as f64 - 1.0;
        let phi = 2.0 * PI * ((bin % BINS_PHI) as f64 + (j as f64 + 0.5) / POINTS as f64) / BINS_PHI as f64;
        pdf(direction(z, phi))
    };
    let sum: f64 = (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j))).map(|(i, j)| at(i, j)).sum();
    solid_angle * sum / (POINTS * POINTS) as f64
}

/// Integral of `f` over the sphere.
pub(crate) fn sphere_sum(f: impl Fn(Vec3) -> Rgb) -> Rgb {
    let (nz, nphi) = (600, 600);
    let cell = 4.0 * PI / (nz * nphi) as f64;
    let mut sum = Rgb::ZERO;
    for i in 0..nz {
        for j in 0..nphi {
            let z = 2.0 * (i as f64 + 0.5) / nz as f64 - 1.0;
            sum += f(direction(z, 2.0 * PI * (j as f64 + 0.5) / nphi as f64)) * cell;
        }
    }
    sum
}

/// Integral of `f |z|` over the sphere.
pub(crate) fn hemispherical_sum(f: impl Fn(Vec3) -> Rgb) -> Rgb {
    sphere_sum(|d| f(d) * d.z.abs())
}
