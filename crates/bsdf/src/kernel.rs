//! A narrow lobe as weighted directions: what lands in which cell, however narrow the lobe is against it.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// How far the lobe is followed, in standard deviations: past it lie 4e-6 of a Gaussian's flux.
const EXTENT: f64 = 5.0;

/// Full width at half maximum of a Gaussian over its standard deviation: 2 sqrt(2 ln 2).
pub const HALF_WIDTH: f64 = 2.354_820_045_030_949;

/// Full width at tenth maximum over it: 2 sqrt(2 ln 10).
pub const TENTH_WIDTH: f64 = 4.291_932_052_578;

/// Points a standard deviation, and a cell.
const POINTS_A_SIGMA: f64 = 3.0;
const POINTS_A_CELL: f64 = 6.0;

/// More than so many points a standard deviation tell nothing new.
const MOST_POINTS_A_SIGMA: f64 = 30.0;

/// Gaussians around the straight direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Of constant angular width, as the acceptance of an instrument: standard deviation [rad].
    Angle(f64),
    /// Of constant width on the disk of projected directions, as scattering by small structures: standard deviation. In angle it
    /// grows as 1/cos(theta) in the plane of incidence.
    Projected(f64),
}

impl Spread {
    /// Standard deviation at normal incidence [rad].
    pub fn sigma(self) -> f64 {
        match self {
            Self::Angle(sigma) | Self::Projected(sigma) => sigma,
        }
    }
}

/// Rings and azimuths of a lobe, with weights that add up to 1.
#[derive(Clone, Debug)]
pub struct Kernel {
    spread: Spread,
    points: Vec<Offset>,
}

/// One way off the straight direction.
#[derive(Clone, Copy, Debug)]
struct Offset {
    /// On the disk, or across the direction (its length the sine of the angle).
    across: DVec2,
    /// Along the direction: the cosine of the angle.
    along: f64,
    /// Share of the flux.
    weight: f64,
}

impl Kernel {
    /// For cells of a width [projected units].
    pub fn new(spread: Spread, cell: f64) -> Self {
        let sigma = spread.sigma();
        let step = (sigma / POINTS_A_SIGMA).min((cell / POINTS_A_CELL).max(sigma / MOST_POINTS_A_SIGMA));
        let rings = (EXTENT * sigma / step).ceil() as usize;
        // Even and off the axis: both sides of a border that runs through the middle get the same.
        let azimuths = 4 * (2.0 * PI * 2.0 * sigma / step / 4.0).ceil().max(6.0) as usize;
        let mut points = Vec::with_capacity(rings * azimuths);
        for i in 0..rings {
            let r = (i as f64 + 0.5) / rings as f64 * EXTENT;
            let weight = r * (-0.5 * r * r).exp();
            let (length, along) = match spread {
                Spread::Projected(_) => (r * sigma, 1.0),
                Spread::Angle(_) => (r * sigma).sin_cos(),
            };
            for k in 0..azimuths {
                let psi = 2.0 * PI * (k as f64 + 0.5) / azimuths as f64;
                points.push(Offset { across: length * DVec2::from_angle(psi), along, weight });
            }
        }
        let sum: f64 = points.iter().map(|p| p.weight).sum();
        points.iter_mut().for_each(|p| p.weight /= sum);
        Self { spread, points }
    }

    /// Visit exiting points with their shares of the flux around a straight direction; what would leave the hemisphere is lost.
    pub fn around(&self, straight: DVec2, mut visit: impl FnMut(DVec2, f64)) {
        let axis = straight.extend((1.0 - straight.length_squared()).max(0.0).sqrt());
        let (right, up) = frame(axis);
        for o in &self.points {
            match self.spread {
                Spread::Projected(_) => {
                    let p = straight + o.across;
                    if p.length_squared() < 1.0 {
                        visit(p, o.weight);
                    }
                }
                Spread::Angle(_) => {
                    let w = axis * o.along + right * o.across.x + up * o.across.y;
                    if w.z > 0.0 {
                        visit(w.truncate(), o.weight);
                    }
                }
            }
        }
    }
}

/// Two axes across a direction: one in the plane of incidence, one along the surface.
fn frame(axis: DVec3) -> (DVec3, DVec3) {
    let flat = axis.truncate().try_normalize().unwrap_or(DVec2::X);
    let across = flat.perp().extend(0.0);
    (across.cross(axis), across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kernel_has_its_width_at_every_incidence() {
        let sigma = 0.02;
        let kernel = Kernel::new(Spread::Angle(sigma), 0.05);
        for r in [0.0, 0.5, 0.9] {
            let straight = DVec2::new(r, 0.0);
            let axis = straight.extend((1.0 - r * r).sqrt());
            let (mut variance, mut sum) = (0.0, 0.0);
            kernel.around(straight, |p, weight| {
                let w = p.extend((1.0 - p.length_squared()).sqrt());
                sum += weight;
                variance += weight * w.cross(axis).length().asin().powi(2);
            });
            assert!((sum - 1.0).abs() < 1e-9, "{r}: {sum}");
            // The second moment of a Gaussian in two dimensions; three points a standard deviation sum it to half a percent.
            assert!((variance / (2.0 * sigma * sigma) - 1.0).abs() < 6e-3, "{r}: {variance}");
        }
    }
}
