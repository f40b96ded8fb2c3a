//! Lobes into the cells of a division: flux by cell, none of it lost.

use super::{background::Background, lobes::Lobe};
use crate::table::Columns;
use glam::DVec2;
use std::f64::consts::PI;

/// Lobes narrower than this share of a cell's width are put into cells point by point, others summed over points of the cells.
const NARROW: f64 = 0.5;

/// Lobes wider than so many cells are taken at the cells' middles.
const WIDE: f64 = 2.0;

/// How far a lobe is followed, in standard deviations.
const EXTENT: f64 = 4.0;

/// Points of a narrow lobe.
const POINTS: usize = 48;

/// Buckets a side of the square around the disk, to find the cells near a lobe.
const BUCKETS: usize = 24;

/// Gauss's two points on the unit interval.
const GAUSS_2: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// Cells of a division with what finds them.
#[derive(Debug)]
pub struct Cells {
    division: Columns,
    areas: Vec<f64>,
    middles: Vec<DVec2>,
    /// Four points of each.
    quarters: Vec<[DVec2; 4]>,
    buckets: Vec<Vec<usize>>,
    /// Farthest that a point of a cell lies from its middle.
    extent: f64,
    unit: Vec<DVec2>,
}

impl Cells {
    /// Of a division.
    pub fn new(division: Columns) -> Self {
        let all = 0..division.len();
        let point = |cell: usize, u: [f64; 2]| division.point(cell, u);
        let middles: Vec<DVec2> = all.clone().map(|c| point(c, [0.5, 0.5])).collect();
        let quarters =
            all.clone().map(|c| [0, 1, 2, 3].map(|k| point(c, [GAUSS_2[k / 2], GAUSS_2[k % 2]]))).collect();
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
        let extents = all.clone().flat_map(|c| corners.map(|u| point(c, u).distance(middles[c])));
        let extent = extents.fold(0.0, f64::max);
        let mut buckets = vec![Vec::new(); BUCKETS * BUCKETS];
        for (cell, middle) in middles.iter().enumerate() {
            buckets[bucket(middle.x) * BUCKETS + bucket(middle.y)].push(cell);
        }
        let areas = all.map(|c| division.projected_solid_angle(c)).collect();
        Self { division, areas, middles, quarters, buckets, extent, unit: spiral() }
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    /// Projected solid angle of a cell [sr].
    pub fn area(&self, cell: usize) -> f64 {
        self.areas[cell]
    }

    /// Add a lobe's flux to that of the cells; what would leave the hemisphere is spread over the rest of it.
    pub fn add(&self, lobe: &Lobe, fluxes: &mut [f64]) {
        let width = self.areas[self.division.index(lobe.middle)].sqrt();
        if lobe.sigma < NARROW * width {
            self.add_points(lobe, fluxes);
        } else {
            self.add_sums(lobe, lobe.sigma > WIDE * width, fluxes);
        }
    }

    /// Add a share of a background to the mean values [1/sr] of the cells.
    pub fn add_background(&self, background: &Background, share: f64, values: &mut [f64]) {
        let is_wide = matches!(self.division, Columns::Patches(_));
        for (cell, value) in values.iter_mut().enumerate() {
            let mean = if is_wide {
                0.25 * self.quarters[cell].iter().map(|&q| background.at(q)).sum::<f64>()
            } else {
                background.at(self.middles[cell])
            };
            *value += share * mean;
        }
    }

    fn add_points(&self, lobe: &Lobe, fluxes: &mut [f64]) {
        let points =
            self.unit.iter().map(|u| lobe.middle + *u * lobe.sigma).filter(|q| q.length_squared() < 1.0);
        let cells: Vec<usize> = points.map(|q| self.division.index(q)).collect();
        if cells.is_empty() {
            fluxes[self.division.index(lobe.middle)] += lobe.flux;
        }
        let share = lobe.flux / cells.len() as f64;
        cells.into_iter().for_each(|cell| fluxes[cell] += share);
    }

    fn add_sums(&self, lobe: &Lobe, wide: bool, fluxes: &mut [f64]) {
        let reach = EXTENT * lobe.sigma;
        let [low, high] = [-1.0, 1.0].map(|side| lobe.middle + DVec2::splat(side * (reach + self.extent)));
        let factor = -0.5 / lobe.sigma.powi(2);
        let mut found: Vec<(usize, f64)> = Vec::new();
        let mut sum = 0.0;
        for i in bucket(low.x)..=bucket(high.x) {
            for j in bucket(low.y)..=bucket(high.y) {
                for &cell in &self.buckets[i * BUCKETS + j] {
                    let squared = self.middles[cell].distance_squared(lobe.middle);
                    if squared > (reach + self.extent).powi(2) {
                        continue;
                    }
                    let mean = if wide {
                        (factor * squared).exp()
                    } else {
                        let at = |q: &DVec2| (factor * q.distance_squared(lobe.middle)).exp();
                        0.25 * self.quarters[cell].iter().map(at).sum::<f64>()
                    };
                    let flux = mean * self.areas[cell];
                    sum += flux;
                    found.push((cell, flux));
                }
            }
        }
        if sum > 0.0 {
            found.into_iter().for_each(|(cell, flux)| fluxes[cell] += lobe.flux * flux / sum);
        }
    }
}

fn bucket(v: f64) -> usize {
    ((0.5 * (v + 1.0) * BUCKETS as f64).max(0.0) as usize).min(BUCKETS - 1)
}

/// Points of equal weight of a Gaussian of unit width: a spiral of Fibonacci's.
fn spiral() -> Vec<DVec2> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let point = |k: usize| {
        let u = (k as f64 + 0.5) / POINTS as f64;
        DVec2::from_angle(golden * k as f64) * (-2.0 * (1.0 - u).ln()).sqrt()
    };
    (0..POINTS).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Basis;

    #[test]
    fn flux_and_middle_of_a_lobe_are_kept_in_every_division() {
        for name in ["klems", "t4-256", "t4-4096"] {
            let [_, division] = name.parse::<Basis>().unwrap().divisions();
            let cells = Cells::new(division);
            for sigma in [0.01, 0.05, 0.12] {
                let lobe = Lobe { middle: DVec2::new(0.3, -0.35), sigma, flux: 0.7 };
                let mut fluxes = vec![0.0; cells.areas.len()];
                cells.add(&lobe, &mut fluxes);
                assert!((fluxes.iter().sum::<f64>() - 0.7).abs() < 1e-12);
                let mean = fluxes.iter().zip(&cells.middles).map(|(f, q)| *q * *f).sum::<DVec2>() / 0.7;
                // A flux in a cell counts at its middle.
                let allowed = if sigma < 0.03 { 0.6 * cells.extent } else { 0.02 };
                assert!(mean.distance(lobe.middle) < allowed, "{name} {sigma}: {mean}");
            }
        }
    }
}
