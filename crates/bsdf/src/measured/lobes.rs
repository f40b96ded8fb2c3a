//! One incidence as a smooth background and a sum of Gaussian lobes on the disk of projected directions (radial basis functions).
//!
//! Ward, Kurt and Bonneel, "Reducing Anisotropic BSDF Measurement to Common Practice" (Workshop on Material Appearance Modeling 2014),
//! put lobes on a hemisphere; on the disk the mirrored and the straight direction move in a straight line when the incidence does,
//! and areas are projected solid angles, so that masses are flux.

use super::{
    background::Background,
    field::{Field, SIDE},
};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;
use sunpeak_core::warp::square_to_disk;

/// A Gaussian on the disk, of unit flux over the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// Its middle.
    pub middle: DVec2,
    /// Standard deviation.
    pub sigma: f64,
    /// Flux [-].
    pub flux: f64,
}

/// What one incidence scatters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scattered {
    /// What changes slowly over the hemisphere.
    pub background: Background,
    /// The rest.
    pub lobes: Vec<Lobe>,
}

impl Scattered {
    /// Hemispherical transmittance or reflectance [-].
    pub fn flux(&self) -> f64 {
        self.background.flux() + self.lobes.iter().map(|l| l.flux).sum::<f64>()
    }
}

/// Most lobes of an incidence.
pub const MOST_LOBES: usize = 240;

/// Leaves are divided until what they smear is this share of the flux.
const SMEARED: f64 = 2e-3;

/// Flux above the background that is worth lobes [-].
const LEAST_REST: f64 = 1e-9;

/// Smallest leaf, and the leaves of the first division [cells of the field a side].
const SMALLEST: usize = 2;
const FIRST: usize = SIDE / 4;

/// Standard deviation of a lobe over the width of its leaf: neighbours of equal flux then differ by a percent from a constant.
const WIDTH: f64 = 0.6;

/// Rounds in which fluxes are adjusted so that the sum of the lobes has the flux of each leaf (Richardson 1972, Lucy 1974).
const ROUNDS: usize = 60;

/// Points a side of a leaf at which lobes are summed.
const POINTS: usize = 4;

/// A square of the field's cells.
#[derive(Clone, Copy)]
struct Leaf {
    corner: [usize; 2],
    size: usize,
    mean: f64,
    /// What a constant leaves out: mean absolute difference times area.
    smeared: f64,
    centroid: DVec2,
}

/// Split a field into its background and lobes.
pub fn fit(field: &Field) -> Scattered {
    let background = Background::of(field);
    let rest = rest(field, &background);
    let mean = |field: &Field| field.0.iter().sum::<f64>() / field.0.len() as f64;
    let leaves = leaves(&rest, PI * mean(field));
    let area = |leaf: &Leaf| PI * (leaf.size as f64 / SIDE as f64).powi(2);
    let targets: Vec<f64> = leaves.iter().map(|l| area(l) * l.mean.max(0.0)).collect();
    let whole = PI * mean(&rest);
    if whole <= LEAST_REST {
        let all = Background::sum([(1.0, &background), (mean(&rest), &Background::even(1.0))].into_iter());
        return Scattered { background: all, lobes: Vec::new() };
    }
    let mut lobes: Vec<Lobe> = leaves
        .iter()
        .zip(&targets)
        .map(|(l, &flux)| Lobe { middle: l.centroid, sigma: WIDTH * area(l).sqrt(), flux })
        .collect();
    adjust(&mut lobes, &leaves, &targets, area);
    lobes.retain(|l| l.flux > 1e-7 * whole);
    let kept: f64 = lobes.iter().map(|l| l.flux).sum();
    lobes.iter_mut().for_each(|l| l.flux *= whole / kept);
    Scattered { background, lobes }
}

/// What stands above the background; noise may lie below it.
fn rest(field: &Field, background: &Background) -> Field {
    let at = |k: usize| (k as f64 + 0.5) / SIDE as f64;
    let under = |cell: usize| background.at_square([at(cell / SIDE), at(cell % SIDE)]);
    Field(field.0.iter().enumerate().map(|(cell, value)| value - under(cell)).collect())
}

impl Leaf {
    fn new(field: &Field, corner: [usize; 2], size: usize) -> Self {
        let cells = || (0..size * size).map(|k| (corner[0] + k / size) * SIDE + corner[1] + k % size);
        let count = (size * size) as f64;
        let mean = cells().map(|at| field.0[at]).sum::<f64>() / count;
        let off = cells().map(|at| (field.0[at] - mean).abs()).sum::<f64>();
        let weighted = cells().fold((DVec2::ZERO, 0.0), |(sum, weight), at| {
            let value = field.0[at].max(0.0);
            (sum + super::field::middle(at / SIDE, at % SIDE) * value, weight + value)
        });
        let half = 0.5 * size as f64;
        let center = square_to_disk(corner.map(|c| (c as f64 + half) / SIDE as f64)).into();
        let centroid = if weighted.1 > 0.0 { weighted.0 / weighted.1 } else { center };
        Self { corner, size, mean, smeared: off * PI / (SIDE * SIDE) as f64, centroid }
    }

    fn quarters(&self, field: &Field) -> [Self; 4] {
        let half = self.size / 2;
        [[0, 0], [0, half], [half, 0], [half, half]]
            .map(|[i, j]| Self::new(field, [self.corner[0] + i, self.corner[1] + j], half))
    }

    /// Points of the leaf, even in projected solid angle.
    fn points(&self) -> impl Iterator<Item = DVec2> + use<> {
        let (corner, size) = (self.corner, self.size as f64);
        (0..POINTS * POINTS).map(move |k| {
            let at = |c: usize, u: usize| (c as f64 + (u as f64 + 0.5) / POINTS as f64 * size) / SIDE as f64;
            square_to_disk([at(corner[0], k / POINTS), at(corner[1], k % POINTS)]).into()
        })
    }
}

/// Divide where most is smeared, until little of the `whole` flux is.
fn leaves(field: &Field, whole: f64) -> Vec<Leaf> {
    let side = SIDE / FIRST;
    let mut leaves: Vec<Leaf> =
        (0..side * side).map(|k| Leaf::new(field, [k / side * FIRST, k % side * FIRST], FIRST)).collect();
    while leaves.len() + 3 <= MOST_LOBES {
        let divisible = (0..leaves.len()).filter(|&k| leaves[k].size > SMALLEST);
        let Some(worst) = divisible.max_by(|&a, &b| leaves[a].smeared.total_cmp(&leaves[b].smeared)) else {
            break;
        };
        if leaves.iter().map(|l| l.smeared).sum::<f64>() < SMEARED * whole {
            break;
        }
        let quarters = leaves[worst].quarters(field);
        leaves.swap_remove(worst);
        leaves.extend(quarters);
    }
    leaves
}

/// Multiply fluxes until the sum of the lobes has the flux of each leaf.
fn adjust(lobes: &mut [Lobe], leaves: &[Leaf], targets: &[f64], area: impl Fn(&Leaf) -> f64 + Sync) {
    // By lobe: the share of its flux in each leaf.
    let shares: Vec<Vec<f64>> = lobes
        .par_iter()
        .map(|lobe| {
            let value = |q: DVec2| (-0.5 * q.distance_squared(lobe.middle) / lobe.sigma.powi(2)).exp();
            let mut row: Vec<f64> =
                leaves.iter().map(|l| area(l) * l.points().map(value).sum::<f64>()).collect();
            let sum: f64 = row.iter().sum::<f64>().max(f64::MIN_POSITIVE);
            row.iter_mut().for_each(|share| *share /= sum);
            row
        })
        .collect();
    for _ in 0..ROUNDS {
        let mut found = vec![0.0; leaves.len()];
        for (lobe, row) in lobes.iter().zip(&shares) {
            found.iter_mut().zip(row).for_each(|(sum, share)| *sum += lobe.flux * share);
        }
        let ratios: Vec<f64> =
            targets.iter().zip(&found).map(|(t, f)| if *f > 0.0 { t / f } else { 1.0 }).collect();
        for (lobe, row) in lobes.iter_mut().zip(&shares) {
            lobe.flux *= row.iter().zip(&ratios).map(|(share, ratio)| share * ratio).sum::<f64>();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::field::middle;

    fn field(value: impl Fn(DVec2) -> f64) -> Field {
        Field((0..SIDE * SIDE).map(|at| value(middle(at / SIDE, at % SIDE))).collect())
    }

    fn value(scattered: &Scattered, q: DVec2) -> f64 {
        let gauss = |l: &Lobe| {
            l.flux * (-0.5 * q.distance_squared(l.middle) / l.sigma.powi(2)).exp()
                / (2.0 * PI * l.sigma.powi(2))
        };
        scattered.background.at(q) + scattered.lobes.iter().map(gauss).sum::<f64>()
    }

    #[test]
    fn a_diffuser_is_a_background_alone() {
        let found = fit(&field(|_| 0.25));
        assert!(found.lobes.is_empty());
        assert!((found.flux() - 0.25 * PI).abs() < 1e-9);
    }

    #[test]
    fn a_lobe_on_a_floor_comes_back() {
        let (center, sigma) = (DVec2::new(0.35, -0.2), 0.08);
        let truth = |q: DVec2| 0.05 + 2.0 * (-0.5 * q.distance_squared(center) / (sigma * sigma)).exp();
        let found = fit(&field(truth));
        // Closed form: the lobe lies inside the disk.
        let flux = PI * 0.05 + 2.0 * 2.0 * PI * sigma * sigma;
        assert!((found.flux() / flux - 1.0).abs() < 1e-3, "{} {flux}", found.flux());
        assert!((found.background.at(DVec2::new(-0.6, 0.5)) - 0.05).abs() < 1e-6);
        for q in [center, center + DVec2::new(0.08, 0.0), center + DVec2::new(0.0, 0.16)] {
            assert!(
                (value(&found, q) - truth(q)).abs() < 0.05 * 2.0,
                "{q}: {} {}",
                value(&found, q),
                truth(q)
            );
        }
    }
}
