//! Through transmittance between the columns of a table.
//!
//! A column's value is a mean over its incident cell. Between the columns it is interpolated linearly: in sin(theta) for isotropic
//! trees, on the square for anisotropic ones, in sin²(theta) and azimuth for rings of patches. In each cell the interpolant
//! is multiplied by the column's value over the interpolant's mean, so that the flux of each cell is exact; where a
//! column has no peak it is zero.

use super::colors::Colors;
use crate::{basis::AngleBasis, table::Columns};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Rgb, luminance, warp::disk_to_square};

/// Values of all columns, and the factors that keep their means.
#[derive(Debug)]
pub struct ThroughMap {
    values: Colors,
    factors: Colors,
}

/// Share of the second difference by which a smooth function can depart from the scaled interpolant: a parabola departs by
/// 1/8 between the columns and 1/12 in their middle; more where the slope runs away or jumps, as at a cut-off or behind slats.
const BEND_SHARE: f64 = 0.5;

impl ThroughMap {
    /// Nothing goes through.
    pub fn none() -> Self {
        Self { values: Colors::new(&[]), factors: Colors::new(&[]) }
    }

    /// From the mean of each column.
    pub fn new(columns: &Columns, values: &[Rgb]) -> Self {
        if values.iter().all(|v| *v == Rgb::ZERO) {
            return Self::none();
        }
        let values = Colors::new(values);
        let factor = |c: usize| {
            let (value, mean) = (values.at(c), mean(columns, &values, c));
            let scaled = value / mean.max(Rgb::splat(f64::MIN_POSITIVE));
            Rgb::select(mean.cmpgt(Rgb::ZERO), scaled, Rgb::ZERO)
        };
        let factors: Vec<Rgb> = (0..values.len()).map(factor).collect();
        Self { factors: Colors::new(&factors), values }
    }

    /// The mean over a column.
    pub fn value(&self, column: usize) -> Rgb {
        if self.is_none() { Rgb::ZERO } else { self.values.at(column) }
    }

    /// Memory that it takes [bytes].
    pub fn bytes(&self) -> usize {
        self.values.bytes() + self.factors.bytes()
    }

    /// Does nothing go through?
    pub fn is_none(&self) -> bool {
        self.values.len() == 0
    }

    /// Does the peak end within the column of a point, at a cut-off or at grazing incidence? Then what T may reach there [-].
    pub fn edge(&self, columns: &Columns, p: DVec2) -> Option<f64> {
        (!self.is_none()).then(|| edge(columns, &self.values, columns.index(p))).filter(|&edge| edge > 0.0)
    }

    /// By how much the truth can depart from the interpolant at a point, if it is as smooth as the columns look [-].
    pub fn bend(&self, columns: &Columns, p: DVec2) -> f64 {
        if self.is_none() { 0.0 } else { BEND_SHARE * bend(columns, &self.values, columns.index(p)) }
    }

    /// The value at a point of incidence.
    pub fn at(&self, columns: &Columns, p: DVec2) -> Rgb {
        if self.is_none() {
            return Rgb::ZERO;
        }
        let factor = self.factors.at(columns.index(p));
        if factor == Rgb::ZERO {
            return Rgb::ZERO;
        }
        factor * interpolant(columns, &self.values, p)
    }
}

fn interpolant(columns: &Columns, values: &Colors, p: DVec2) -> Rgb {
    match columns {
        Columns::Radial { side } => {
            // Columns run from grazing (0) to normal; the value is even in sin(theta).
            let last = side / 2 - 1;
            let (i, t) = between((1.0 - p.length()) * 0.5 * *side as f64, last);
            values.at(i).lerp(values.at((i + 1).min(last)), t)
        }
        Columns::Square { side } => {
            let [x, y] = disk_to_square(p.into());
            let last = side - 1;
            let ((i, s), (j, t)) = (between(x * *side as f64, last), between(y * *side as f64, last));
            let (i1, j1) = ((i + 1).min(last), (j + 1).min(last));
            let at = |i: usize, j: usize| values.at(i * side + j);
            let row = |i: usize| at(i, j).lerp(at(i, j1), t);
            row(i).lerp(row(i1), s)
        }
        Columns::Patches(basis) => on_rings(basis, values, p.length_squared(), p.y.atan2(p.x)),
    }
}

/// Cell centres around a coordinate in cells: the lower one and the share of the upper one.
fn between(at: f64, last: usize) -> (usize, f64) {
    let at = (at - 0.5).clamp(0.0, last as f64);
    let i = at as usize;
    (i, at - i as f64)
}

fn on_rings(basis: &AngleBasis, values: &Colors, sin2: f64, phi: f64) -> Rgb {
    let rings = basis.rings();
    let upper = rings.partition_point(|r| r.sin2(0.5) <= sin2);
    let ring = |n: usize| {
        let ring = &rings[n];
        let at = (phi / (2.0 * PI)).rem_euclid(1.0) * ring.phi_count as f64;
        let i = at as usize;
        let patch = |k: usize| values.at(ring.first() + k % ring.phi_count);
        patch(i).lerp(patch(i + 1), at - i as f64)
    };
    if upper == 0 {
        return ring(0);
    }
    if upper == rings.len() {
        return ring(upper - 1);
    }
    let (a, b) = (rings[upper - 1].sin2(0.5), rings[upper].sin2(0.5));
    ring(upper - 1).lerp(ring(upper), (sin2 - a) / (b - a))
}

/// Mean of the interpolant over a column: exact, as each piece between centres and borders is linear in each coordinate.
fn mean(columns: &Columns, values: &Colors, column: usize) -> Rgb {
    match columns {
        Columns::Radial { .. } => [0.25, 0.75]
            .into_iter()
            .map(|u| 0.5 * interpolant(columns, values, columns.point(column, [u, 0.5])))
            .sum(),
        Columns::Square { .. } => [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75]]
            .into_iter()
            .map(|u| 0.25 * interpolant(columns, values, columns.point(column, u)))
            .sum(),
        Columns::Patches(basis) => mean_over_patch(basis, values, column),
    }
}

/// The largest luminous value of a column and those next to it, if one of them has none or the column reaches grazing incidence.
fn edge(columns: &Columns, values: &Colors, column: usize) -> f64 {
    let y = |c: usize| luminance(values.at(c));
    let own = y(column);
    let around = columns.neighbours(column).into_iter().map(y);
    let ends = columns.is_grazing(column) || around.clone().any(|v| v <= 0.0);
    if own > 0.0 && ends { around.fold(own, f64::max) } else { 0.0 }
}

/// Sum of the second differences along both coordinates at a column, luminous.
fn bend(columns: &Columns, values: &Colors, column: usize) -> f64 {
    let y = |i: usize| luminance(values.at(i));
    let second = |a: f64, b: f64, c: f64| (a - 2.0 * b + c).abs();
    match columns {
        Columns::Radial { side } => {
            let last = side / 2 - 1;
            let (below, above) = (column.saturating_sub(1), (column + 1).min(last));
            second(y(below), y(column), y(above))
        }
        Columns::Square { side } => {
            let (i, j) = (column / side, column % side);
            let at = |i: usize, j: usize| y(i * side + j);
            let (low, high) = (|k: usize| k.saturating_sub(1), |k: usize| (k + 1).min(side - 1));
            second(at(low(i), j), at(i, j), at(high(i), j)) + second(at(i, low(j)), at(i, j), at(i, high(j)))
        }
        Columns::Patches(basis) => {
            let (ring, step) = basis.ring_of(column);
            let (n, rings) = (ring.phi_count, basis.rings());
            let neighbour = |k: usize| y(ring.first() + k % n);
            let around = second(neighbour(step + n - 1), y(column), neighbour(step + 1));
            let own = rings.iter().position(|r| r.first() == ring.first()).unwrap_or(0);
            let phi = 2.0 * PI * step as f64 / n as f64;
            let at = |k: usize| luminance(on_rings(basis, values, rings[k].sin2(0.5), phi));
            let across = second(at(own.saturating_sub(1)), y(column), at((own + 1).min(rings.len() - 1)));
            around + across
        }
    }
}

fn mean_over_patch(basis: &AngleBasis, values: &Colors, patch: usize) -> Rgb {
    let (ring, step) = basis.ring_of(patch);
    let n = ring.phi_count as f64;
    let (start, end) = ((step as f64 - 0.5) / n, (step as f64 + 0.5) / n);
    // The interpolant bends where this ring or a neighbour has a patch centre.
    let mut bends = vec![start, end];
    let own = basis.rings().iter().position(|r| r.first() == ring.first()).unwrap_or(0);
    for other in &basis.rings()[own.saturating_sub(1)..(own + 2).min(basis.rings().len())] {
        let m = other.phi_count as f64;
        let centres = ((start * m).ceil() as i64)..=((end * m).floor() as i64);
        bends.extend(centres.map(|k| k as f64 / m));
    }
    bends.sort_by(f64::total_cmp);
    let mut sum = Rgb::ZERO;
    for pair in bends.windows(2) {
        let phi = PI * (pair[0] + pair[1]);
        for u in [0.25, 0.75] {
            sum += 0.5 * (pair[1] - pair[0]) / (end - start) * on_rings(basis, values, ring.sin2(u), phi);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    /// Dense midpoint sums: an independent mean over a column.
    fn dense_mean(map: &ThroughMap, columns: &Columns, column: usize, n: usize) -> f64 {
        let mut sum = 0.0;
        for i in 0..n * n {
            let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
            sum += map.at(columns, columns.point(column, u)).x;
        }
        sum / (n * n) as f64
    }

    #[test]
    fn the_mean_over_each_column_is_its_value() {
        let klems = |name| Columns::Patches(Arc::new(AngleBasis::known(name).unwrap()));
        for columns in [
            Columns::Radial { side: 16 },
            Columns::Square { side: 8 },
            klems("LBNL/Klems Full"),
            klems("LBNL/Klems Quarter"),
        ] {
            let values: Vec<Rgb> = (0..columns.len())
                .map(|i| Rgb::splat(if i % 7 == 3 { 0.0 } else { ((i * 37) % 11) as f64 + 1.0 }))
                .collect();
            let map = ThroughMap::new(&columns, &values);
            for (column, value) in values.iter().enumerate() {
                let got = dense_mean(&map, &columns, column, 96);
                assert!((got - value.x).abs() <= 2e-3 * value.x, "{columns:?} {column}: {got} {}", value.x);
            }
        }
    }

    #[test]
    fn a_linear_transmittance_comes_back_exactly() {
        let columns = Columns::Radial { side: 64 };
        let through = |r: f64| 0.1 * (1.0 - r);
        let values = (0..columns.len())
            .map(|c| Rgb::splat(through(columns.point(c, [0.5, 0.5]).x)))
            .collect::<Vec<_>>();
        let map = ThroughMap::new(&columns, &values);
        for r in [0.05, 0.31, 0.5, 0.77, 0.9] {
            // To the 32 bits in which columns are kept.
            assert!((map.at(&columns, DVec2::new(0.0, r)).x - through(r)).abs() < 1e-7 * through(0.0));
        }
    }
}
