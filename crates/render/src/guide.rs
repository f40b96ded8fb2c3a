//! Where light comes into a room behind a shade: directions that diffuse surfaces try beside their own.
//!
//! Light that a shade scatters can be found by no shadow ray from the room; a path has to meet the shade and go on from there.
//! Two things are known beforehand: where the shades are, and that what they scatter is brightest around the straight
//! direction of the sun, in a table without its peak extracted a thousandfold within one cell. So directions are drawn in part
//! towards a random point of the shades, in part from a density around the suns that is the same for all cell sizes, and
//! the rest from the surface's own lobes. The density of the mixture is known, so nothing is biased (Veach 1997, section 9.2:
//! one-sample model with the balance heuristic).

use crate::shapes::{Ray, Triangle};
use std::f64::consts::PI;
use sunpeak_core::{Frame, Vec3};

/// Share of directions that go to the shades, and around the suns. The rest, the surface's own, keeps every weight below
/// 1/(1 - these) of what it would be without a guide.
const TO_SHADES: f64 = 0.3;
const AROUND_SUNS: f64 = 0.2;

/// With more triangles of shades than this, looking at each of them costs more than it brings.
const MAX_TRIANGLES: usize = 32;

/// Angle around the sun below which the density is level [deg]: half the cell of a tensor tree of 16384.
const LEVEL_DEG: f64 = 0.5;

/// Directions worth trying from any diffuse surface.
#[derive(Debug)]
pub(crate) struct Guide {
    shades: Vec<Triangle>,
    suns: Vec<Vec3>,
    to_shades: f64,
    around_suns: f64,
}

impl Guide {
    /// From the triangles of scattering, transmitting surfaces and the directions of suns; `None` if there is nothing to
    /// guide to.
    pub fn new(mut shades: Vec<Triangle>, suns: Vec<Vec3>) -> Option<Self> {
        if shades.is_empty() {
            return None;
        }
        if shades.len() > MAX_TRIANGLES {
            shades.clear();
        }
        let to_shades = if shades.is_empty() { 0.0 } else { TO_SHADES };
        let around_suns = if suns.is_empty() { 0.0 } else { AROUND_SUNS };
        (to_shades + around_suns > 0.0).then_some(Self { shades, suns, to_shades, around_suns })
    }

    /// Share of directions that are the surface's own.
    pub fn own_share(&self) -> f64 {
        1.0 - self.to_shades - self.around_suns
    }

    /// Draw a direction from a point; `choice` in [0, 1) picks the way.
    pub fn sample(&self, point: Vec3, choice: f64, u: [f64; 2]) -> Option<Vec3> {
        let guided = self.to_shades + self.around_suns;
        let choice = choice * guided;
        if choice < self.to_shades {
            self.toward_shade(point, choice / self.to_shades, u)
        } else {
            let at = (choice - self.to_shades) / self.around_suns * self.suns.len() as f64;
            let sun = self.suns.get(at as usize)?;
            Some(around(*sun, u))
        }
    }

    /// Density [1/sr] of the guided share of directions: it integrates to 1 - [`Self::own_share`].
    pub fn pdf(&self, point: Vec3, direction: Vec3) -> f64 {
        let suns: f64 = self.suns.iter().map(|sun| around_pdf(*sun, direction)).sum();
        let suns = if self.suns.is_empty() { 0.0 } else { self.around_suns * suns / self.suns.len() as f64 };
        suns + self.to_shades * self.shades_pdf(point, direction)
    }

    /// Triangles are chosen in proportion to the solid angle that they have, roughly.
    fn importance(triangle: &Triangle, point: Vec3) -> f64 {
        let [a, b, c] = triangle.0;
        let to = (a + b + c) / 3.0 - point;
        let area = 0.5 * (b - a).cross(c - a); // a vector along the normal
        let size = area.length();
        let square = to.length_squared();
        if size <= 0.0 {
            return 0.0;
        }
        // Seen edge-on in the middle it may still be seen elsewhere: never quite nothing.
        (area.dot(to).abs() / square.sqrt().max(f64::MIN_POSITIVE) + 0.05 * size) / (square + size)
    }

    fn toward_shade(&self, point: Vec3, choice: f64, [u, v]: [f64; 2]) -> Option<Vec3> {
        let whole: f64 = self.shades.iter().map(|t| Self::importance(t, point)).sum();
        let mut left = choice * whole;
        let chosen = self.shades.iter().find(|t| {
            left -= Self::importance(t, point);
            left < 0.0
        })?;
        let [a, b, c] = chosen.0;
        let root = u.sqrt();
        let on = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
        (on - point).try_normalize()
    }

    fn shades_pdf(&self, point: Vec3, direction: Vec3) -> f64 {
        if self.shades.is_empty() {
            return 0.0;
        }
        let ray = Ray::new(point, direction);
        let (mut whole, mut sum) = (0.0, 0.0);
        for triangle in &self.shades {
            let importance = Self::importance(triangle, point);
            whole += importance;
            let t = triangle.crossing(&ray);
            if t > 0.0 && t.is_finite() {
                let [a, b, c] = triangle.0;
                let facing_area = 0.5 * (b - a).cross(c - a).dot(direction).abs();
                if facing_area > 0.0 {
                    sum += importance * t * t / facing_area;
                }
            }
        }
        if whole > 0.0 { sum / whole } else { 0.0 }
    }
}

/// 1 - cos of the angle within which the density is level.
fn level() -> f64 {
    2.0 * (LEVEL_DEG.to_radians() / 2.0).sin().powi(2)
}

/// A direction with density in proportion to 1/(h + level), h = 1 - cos(angle to the sun): about the same chance for each
/// octave of the angle.
fn around(sun: Vec3, [u, v]: [f64; 2]) -> Vec3 {
    let level = level();
    let h = level * ((2.0 + level) / level).powf(u) - level;
    let sin = (h * (2.0 - h)).max(0.0).sqrt();
    let (y, x) = (2.0 * PI * v).sin_cos();
    Frame::from_normal(sun).to_world(Vec3::new(sin * x, sin * y, 1.0 - h))
}

/// Density [1/sr] of [`around`].
fn around_pdf(sun: Vec3, direction: Vec3) -> f64 {
    let level = level();
    let h = 0.5 * (direction - sun).length_squared();
    1.0 / (2.0 * PI * (h + level) * ((2.0 + level) / level).ln())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    fn triangle(offset: Vec3) -> Triangle {
        Triangle([offset, offset + Vec3::new(2.0, 0.0, 0.0), offset + Vec3::new(0.5, 0.3, 1.5)])
    }

    /// Share of directions within an angle of the sun: the integral of the density over the cap, in closed form.
    fn share_within(h: f64) -> f64 {
        ((h + level()) / level()).ln() / ((2.0 + level()) / level()).ln()
    }

    #[test]
    fn directions_around_the_sun_follow_their_density() {
        let sun = Vec3::new(0.3, -0.8, 0.5).normalize();
        let (mut random, n) = (Random(7), 100_000);
        let directions: Vec<Vec3> = (0..n).map(|_| around(sun, [random.next(), random.next()])).collect();
        for degrees in [0.1f64, 0.5, 2.0, 10.0, 45.0, 120.0, 180.0] {
            let h = 2.0 * (degrees.to_radians() / 2.0).sin().powi(2);
            let within = directions.iter().filter(|d| 1.0 - d.dot(sun) <= h + 1e-12).count();
            let share = share_within(h);
            let error = (share * (1.0 - share) / f64::from(n)).sqrt();
            assert!((within as f64 / f64::from(n) - share).abs() <= 4.0 * error + 1e-9, "{degrees} degrees");
            // The density is the derivative of the share by solid angle, 2 pi dh.
            let step = 1e-4 * h;
            let slope = (share_within(h + step) - share_within(h - step)) / (4.0 * PI * step);
            let side = sun.any_orthonormal_vector();
            let direction = sun * (1.0 - h) + side * (h * (2.0 - h)).max(0.0).sqrt();
            assert!((around_pdf(sun, direction) / slope - 1.0).abs() < 1e-5, "{degrees} degrees");
        }
        let mean: Vec3 = directions.iter().map(|d| *d - sun * d.dot(sun)).sum::<Vec3>() / f64::from(n);
        assert!(mean.length() < 0.01, "uneven in azimuth: {mean}");
    }

    /// Solid angle of a triangle (Van Oosterom and Strackee 1983).
    fn solid_angle(triangle: &Triangle, point: Vec3) -> f64 {
        let [a, b, c] = triangle.0.map(|v| (v - point).normalize());
        2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    }

    #[test]
    fn the_inverse_density_towards_shades_sums_to_their_solid_angle() {
        let shades = vec![triangle(Vec3::new(-1.0, 2.0, 0.0)), triangle(Vec3::new(-2.0, -1.0, 1.0))];
        for point in [Vec3::new(0.2, 0.1, 0.3), Vec3::new(-0.5, 1.9, 0.5), Vec3::new(5.0, 5.0, 5.0)] {
            let truth: f64 = shades.iter().map(|t| solid_angle(t, point)).sum();
            let guide = Guide::new(shades.clone(), Vec::new()).expect("a guide");
            let guided = 1.0 - guide.own_share();
            let (mut random, n) = (Random(7), 200_000);
            let sum: f64 = (0..n)
                .filter_map(|_| guide.sample(point, random.next(), [random.next(), random.next()]))
                .map(|d| guided / guide.pdf(point, d))
                .sum();
            assert!(
                (sum / f64::from(n) / truth - 1.0).abs() < 0.01,
                "{point}: {} {truth}",
                sum / f64::from(n)
            );
        }
    }

    #[test]
    fn without_shades_there_is_no_guide() {
        assert!(Guide::new(Vec::new(), vec![Vec3::Z]).is_none());
    }
}
