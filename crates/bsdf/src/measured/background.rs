//! What changes slowly over the hemisphere: blended in its place between incidences, where lobes are moved.
//!
//! Moved lobes of unequal width do not add up to a smooth function. So what is wide is taken off before lobes are fitted: the opening
//! (Serra, "Image Analysis and Mathematical Morphology", 1982) of the distribution by a square keeps what is wider than the square, and
//! takes highlights off, whatever stands under them.

use super::field::{Field, SIDE};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::warp::disk_to_square;

/// Values a side of the square of Shirley and Chiu: 7 degrees at normal incidence.
const GRID: usize = 16;

/// The opening's square reaches so many values to either side: what stays is wider than 45 degrees.
const REACH: usize = 3;

/// A smooth function on the disk [1/sr]: linear between values at the middles of the square's parts, constant past the last ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Background {
    values: Vec<f64>,
    /// The function is turned by this angle, a unit vector.
    turn: DVec2,
}

impl Default for Background {
    fn default() -> Self {
        Self::even(0.0)
    }
}

impl Background {
    /// The same in all directions.
    pub fn even(value: f64) -> Self {
        Self { values: vec![value; GRID * GRID], turn: DVec2::X }
    }

    /// What of a field is wide.
    pub fn of(field: &Field) -> Self {
        const PART: usize = SIDE / GRID;
        let cells = |part: usize| {
            let corner = [part / GRID * PART, part % GRID * PART];
            (0..PART * PART).map(move |k| (corner[0] + k / PART) * SIDE + corner[1] + k % PART)
        };
        let mean = |part: usize| cells(part).map(|at| field.0[at]).sum::<f64>() / (PART * PART) as f64;
        let means: Vec<f64> = (0..GRID * GRID).map(mean).collect();
        Self { values: over_squares(&over_squares(&means, f64::min), f64::max), turn: DVec2::X }
    }

    /// The weighted sum of several that are not turned.
    pub fn sum<'a>(parts: impl Iterator<Item = (f64, &'a Self)>) -> Self {
        let mut values = vec![0.0; GRID * GRID];
        for (weight, part) in parts {
            values.iter_mut().zip(&part.values).for_each(|(sum, value)| *sum += weight * value);
        }
        Self { values, turn: DVec2::X }
    }

    /// Turned about the normal by half a turn, which is one of the square, too.
    pub fn opposite(&self) -> Self {
        Self { values: self.values.iter().rev().copied().collect(), ..*self }
    }

    /// Turned about the normal by an angle, a unit vector.
    pub fn turned(self, by: DVec2) -> Self {
        Self { turn: by.rotate(self.turn), ..self }
    }

    /// [1/sr] at a point of the disk.
    pub fn at(&self, q: DVec2) -> f64 {
        let back = DVec2::new(self.turn.x, -self.turn.y);
        self.at_square(disk_to_square(back.rotate(q).into()))
    }

    /// [1/sr] at a point of the square, where it is not turned.
    pub fn at_square(&self, u: [f64; 2]) -> f64 {
        let [(i, s), (j, t)] = u.map(|u| {
            let at = (u * GRID as f64 - 0.5).clamp(0.0, (GRID - 1) as f64);
            let low = (at as usize).min(GRID - 2);
            (low, at - low as f64)
        });
        let value = |i: usize, j: usize| self.values[i * GRID + j];
        (1.0 - s) * ((1.0 - t) * value(i, j) + t * value(i, j + 1))
            + s * ((1.0 - t) * value(i + 1, j) + t * value(i + 1, j + 1))
    }

    /// Hemispherical value [-]: the parts have equal projected solid angle, and what lies between values is their mean.
    pub fn flux(&self) -> f64 {
        PI * self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}

/// The least or the largest value within reach, along one axis after the other.
fn over_squares(values: &[f64], pick: fn(f64, f64) -> f64) -> Vec<f64> {
    let along = |values: &[f64], stride: usize| -> Vec<f64> {
        let one = |at: usize| {
            let k = at / stride % GRID;
            let first = at - k * stride;
            let near = k.saturating_sub(REACH)..=(k + REACH).min(GRID - 1);
            near.map(|k| values[first + k * stride]).fold(values[at], pick)
        };
        (0..values.len()).map(one).collect()
    };
    along(&along(values, 1), GRID)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::field::middle;

    fn field(value: impl Fn(DVec2) -> f64) -> Field {
        Field((0..SIDE * SIDE).map(|at| value(middle(at / SIDE, at % SIDE))).collect())
    }

    #[test]
    fn what_is_wide_stays_and_a_highlight_goes() {
        let highlight = |q: DVec2| (-0.5 * q.distance_squared(DVec2::new(0.4, 0.1)) / 0.08f64.powi(2)).exp();
        let found = Background::of(&field(|q| 0.2 + 0.1 * q.y + highlight(q)));
        for q in [DVec2::new(0.4, 0.1), DVec2::new(-0.3, 0.3), DVec2::new(0.1, -0.6)] {
            assert!((found.at(q) - (0.2 + 0.1 * q.y)).abs() < 0.015, "{q}: {}", found.at(q));
        }
    }

    #[test]
    fn turned_it_has_its_values_where_they_have_come_to() {
        let found = Background::of(&field(|q| 0.2 + 0.1 * q.x));
        let [q, by] = [DVec2::new(0.3, -0.5), DVec2::from_angle(0.7)];
        assert!((found.clone().turned(by).at(by.rotate(q)) - found.at(q)).abs() < 1e-12);
        // The mean of a function of the disk over parts of equal projected solid angle.
        let even: f64 = (0..SIDE * SIDE).map(|at| found.at(middle(at / SIDE, at % SIDE))).sum::<f64>();
        assert!((PI * even / (SIDE * SIDE) as f64 / found.flux() - 1.0).abs() < 1e-9);
    }
}
