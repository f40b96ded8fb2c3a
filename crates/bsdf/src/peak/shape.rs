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

/// Through an instrument lobes narrower than so many times its blur look like the blur itself.
const WIDER_THAN_BLUR: f64 = 2.0;

/// The shapes to try for a table that an instrument may have blurred, widest first, each squared width 1/sqrt(2) of the one before:
/// each on the disk and in angle.
pub fn shapes(table: &Table, blur: Option<Spread>) -> Vec<Shape> {
    let narrowest = NARROWEST * table.smallest_projected_solid_angle().sqrt();
    let narrowest = narrowest.max(WIDER_THAN_BLUR * blur.map_or(0.0, Spread::sigma));
    let mut shapes = Vec::new();
    let mut sigma = WIDEST;
    while sigma >= narrowest {
        shapes.extend([false, true].map(|in_angle| Shape { sigma, in_angle }));
        sigma *= 0.5f64.powf(0.25);
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
