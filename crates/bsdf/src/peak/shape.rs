//! The shapes that a smooth lobe around the straight direction may have.

use crate::{
    kernel::{Spread, TENTH_WIDTH},
    table::Table,
};
use glam::DVec2;

/// Widest lobe [rad, or projected units]: wider ones look flat under any cell.
const WIDEST: f64 = 1.0;

/// Narrowest lobe that a basis can tell from a delta, in cell widths: a Gaussian whose full width at tenth maximum is two cells
/// still lights its neighbours.
pub const NARROWEST: f64 = 2.0 / TENTH_WIDTH;

/// A Gaussian lobe that follows the straight direction while the incidence moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Standard deviation.
    pub sigma: f64,
    /// In angle; else on the disk of projected directions, where it stays the same for all incidences if small structures scatter.
    pub in_angle: bool,
}

/// Factor from one width of the ladder to the next: 2^(-1/4).
const STEP: f64 = 0.840_896_415_253_714_6;

/// Through an instrument lobes narrower than so many times its blur look like the blur itself.
const WIDER_THAN_BLUR: f64 = 2.0;

/// The shapes to try for a table that an instrument may have blurred: on the disk, then in angle, each a ladder from the widest down, each
/// squared width 1/sqrt(2) of the one before.
pub fn shapes(table: &Table, blur: Option<Spread>) -> Vec<Shape> {
    let narrowest = NARROWEST * table.smallest_projected_solid_angle().sqrt();
    let narrowest = narrowest.max(WIDER_THAN_BLUR * blur.map_or(0.0, Spread::sigma));
    let mut shapes = Vec::new();
    for in_angle in [false, true] {
        let mut sigma = WIDEST;
        while sigma >= narrowest {
            shapes.push(Shape { sigma, in_angle });
            sigma *= STEP;
        }
    }
    shapes
}

/// Pairs of an incident and an exiting point of one cell with their weights.
#[derive(Clone, Debug)]
pub struct Distances {
    pairs: Vec<Pair>,
}

#[derive(Clone, Copy, Debug)]
struct Pair {
    /// Squared distance from the straight direction on the disk.
    projected: f64,
    /// Squared angle [rad²].
    angle: f64,
    weight: f64,
    /// The same over the exiting cosine: a lobe is even per solid angle, a BSDF is per projected one.
    weight_in_angle: f64,
}

/// Exiting cosines below this are taken for it: a lobe's last degrees before the horizon.
const LEAST_COSINE: f64 = 0.05;

impl Distances {
    /// From points (incident, exiting) and weights that add up to 1.
    pub fn new(points: impl Iterator<Item = (DVec2, DVec2, f64)>) -> Self {
        let height = |p: DVec2| (1.0 - p.length_squared()).max(0.0).sqrt().max(LEAST_COSINE);
        let pairs = points
            .map(|(p, q, weight)| {
                let (a, b) = (height(p), height(q));
                let chord = (p.extend(a) - q.extend(b)).length();
                Pair {
                    projected: (p - q).length_squared(),
                    angle: (2.0 * (0.5 * chord).min(1.0).asin()).powi(2),
                    weight,
                    weight_in_angle: weight / b,
                }
            })
            .collect();
        Self { pairs }
    }

    /// Lobes of height 1 of a part of the ladder averaged over the cell. Two steps down the exponent has doubled: what is two steps
    /// further is the square.
    pub fn ladder(&self, widest: Shape, averages: &mut [f64]) {
        averages.fill(0.0);
        let k = -0.5 / (widest.sigma * widest.sigma);
        for p in &self.pairs {
            let (distance, weight) =
                if widest.in_angle { (p.angle, p.weight_in_angle) } else { (p.projected, p.weight) };
            let mut powers = [(k * distance).exp(), (k * std::f64::consts::SQRT_2 * distance).exp()];
            for two in averages.chunks_mut(2) {
                for (average, power) in two.iter_mut().zip(&mut powers) {
                    *average += weight * *power;
                    *power *= *power;
                }
            }
        }
    }

    /// A lobe of height 1 averaged over the cell.
    pub fn average(&self, shape: Shape) -> f64 {
        let k = -0.5 / (shape.sigma * shape.sigma);
        if shape.in_angle {
            self.pairs.iter().map(|p| p.weight_in_angle * (k * p.angle).exp()).sum()
        } else {
            self.pairs.iter().map(|p| p.weight * (k * p.projected).exp()).sum()
        }
    }
}
