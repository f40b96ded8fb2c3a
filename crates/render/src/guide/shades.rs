//! Directions towards shades and windows, evenly over the solid angle that they have.

use super::MAX_TRIANGLES;
use crate::shapes::{Ray, Triangle};
use std::f64::consts::PI;
use sunpeak_core::{Vec3, warp};

/// Below this solid angle [sr] there is nothing to see: the point lies in the triangle's plane but for rounding.
const NOTHING_SR: f64 = 1e-9;

/// Below this solid angle [sr] a point of the triangle is drawn evenly over its area: seen so small the two are alike, and spherical
/// trigonometry loses its digits.
const SMALL_SR: f64 = 1e-4;

/// Shades as a point sees them.
#[derive(Clone, Debug)]
pub(super) struct ShadesAt<'g> {
    triangles: &'g [Triangle],
    point: Vec3,
    /// Of each triangle [sr]; in single precision, since surfaces that are met are handed on by value.
    solid_angles: [f32; MAX_TRIANGLES],
    whole: f64,
}

impl<'g> ShadesAt<'g> {
    /// At most [`MAX_TRIANGLES`].
    pub fn new(triangles: &'g [Triangle], point: Vec3) -> Self {
        let mut solid_angles = [0.0; MAX_TRIANGLES];
        for (solid_angle, triangle) in solid_angles.iter_mut().zip(triangles) {
            *solid_angle = solid_angle_of(triangle, point) as f32;
        }
        let whole = solid_angles[..triangles.len()].iter().map(|&s| f64::from(s)).sum();
        Self { triangles, point, solid_angles, whole }
    }

    fn shades(&self) -> impl Iterator<Item = (&Triangle, f64)> {
        self.triangles
            .iter()
            .zip(&self.solid_angles)
            .map(|(triangle, &solid_angle)| (triangle, f64::from(solid_angle)))
    }

    /// A direction; `None` where no shade can be seen.
    pub fn sample(&self, [choice, u, v]: [f64; 3]) -> Option<Vec3> {
        let mut left = choice * self.whole;
        let (triangle, solid_angle) = self.shades().find(|(_, solid_angle)| {
            left -= solid_angle;
            left < 0.0
        })?;
        if solid_angle < SMALL_SR {
            return (Triangle::sample([u, v], triangle.0) - self.point).try_normalize();
        }
        spherical(triangle.0.map(|corner| (corner - self.point).normalize()), solid_angle, [u, v])
    }

    /// Density [1/sr].
    pub fn pdf(&self, direction: Vec3) -> f64 {
        if self.whole <= 0.0 {
            return 0.0;
        }
        let ray = Ray::new(self.point, direction);
        let share = |(triangle, solid_angle): (&Triangle, f64)| {
            let t = triangle.crossing(&ray);
            if solid_angle <= 0.0 || !(t > 0.0 && t.is_finite()) {
                return 0.0;
            }
            if solid_angle < SMALL_SR {
                let facing = triangle.area_vector().dot(direction).abs();
                return if facing > 0.0 { solid_angle * t * t / facing } else { 0.0 };
            }
            1.0
        };
        self.shades().map(share).sum::<f64>() / self.whole
    }
}

/// Solid angle of a triangle [sr] (Van Oosterom and Strackee 1983); none from its own plane.
fn solid_angle_of(triangle: &Triangle, point: Vec3) -> f64 {
    let [a, b, c] = triangle.0.map(|corner| corner - point);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let volume = a.dot(b.cross(c)).abs();
    let solid_angle = 2.0 * volume.atan2(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    if volume > 0.0 && solid_angle > NOTHING_SR { solid_angle } else { 0.0 }
}

/// A direction drawn evenly from a spherical triangle of this solid angle [sr] (Arvo 1995, "Stratified Sampling of Spherical
/// Triangles"): a great circle through `b` cuts off a triangle of area u, along it the height 1 - cos of the arc is even in v.
fn spherical([a, b, c]: [Vec3; 3], solid_angle: f64, [u, v]: [f64; 2]) -> Option<Vec3> {
    let (ab, ac) = (a.cross(b).try_normalize()?, a.cross(c).try_normalize()?);
    let cos_alpha = ab.dot(ac).clamp(-1.0, 1.0);
    let sin_alpha = ab.cross(ac).length();
    let cos_ab = a.dot(b);
    let [cos_rest, sin_rest] = warp::circle(u * solid_angle / (2.0 * PI));
    // Sine and cosine of the part's area less alpha.
    let s = sin_rest * cos_alpha - cos_rest * sin_alpha;
    let t = cos_rest * cos_alpha + sin_rest * sin_alpha;
    let p = t - cos_alpha;
    let q = s + sin_alpha * cos_ab;
    let along = ((q * t - p * s) * cos_alpha - q) / ((q * s + p * t) * sin_alpha);
    let end = on_arc(a, c, if along.is_nan() { 1.0 } else { along.clamp(-1.0, 1.0) })?;
    on_arc(b, end, 1.0 - v * (1.0 - end.dot(b)))
}

/// The point on the great circle from one direction towards another at this cosine to the first.
fn on_arc(from: Vec3, to: Vec3, cosine: f64) -> Option<Vec3> {
    let across = to - from * to.dot(from);
    let across = across.try_normalize().or_else(|| (cosine >= 1.0).then_some(Vec3::ZERO))?;
    Some(from * cosine + across * (1.0 - cosine * cosine).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    fn triangle(offset: Vec3) -> Triangle {
        Triangle([offset, offset + Vec3::new(2.0, 0.0, 0.0), offset + Vec3::new(0.5, 0.3, 1.5)])
    }

    #[test]
    fn the_solid_angle_of_an_octant_is_half_of_pi() {
        let octant = Triangle([Vec3::X, Vec3::Y, Vec3::Z].map(|axis| 7.0 * axis));
        assert!((solid_angle_of(&octant, Vec3::ZERO) - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
        assert_eq!(solid_angle_of(&octant, Vec3::X * 7.0), 0.0);
        assert_eq!(solid_angle_of(&octant, Vec3::new(7.0, 7.0, -7.0)), 0.0);
    }

    /// A triangle in 64 smaller ones.
    fn pieces(triangle: Triangle) -> Vec<Triangle> {
        (0..3).fold(vec![triangle], |all, _| all.into_iter().flat_map(quarters).collect())
    }

    fn quarters(Triangle([a, b, c]): Triangle) -> [Triangle; 4] {
        let (ab, bc, ca) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(Triangle)
    }

    #[test]
    fn each_piece_gets_its_solid_angle_of_the_directions() {
        let both = [triangle(Vec3::new(-1.0, 2.0, 0.0)), triangle(Vec3::new(-2.0, -1.0, 1.0))];
        // Between them, close before one, and far away from one.
        for (point, shades) in [
            (Vec3::new(0.2, 0.1, 0.3), &both[..]),
            (Vec3::new(0.3, 1.98, 0.3), &both[..]),
            (Vec3::new(90.0, 160.0, 40.0), &both[..1]),
        ] {
            let (at, mut random, n) = (ShadesAt::new(shades, point), Random(5), 50_000);
            let directions: Vec<Vec3> = (0..n)
                .map(|_| at.sample([random.next(), random.next(), random.next()]).expect("a direction"))
                .collect();
            let meets = |piece: &Triangle, direction: Vec3| {
                let t = piece.crossing(&Ray::new(point, direction));
                t > 0.0 && t.is_finite()
            };
            for piece in shades.iter().copied().flat_map(pieces) {
                let count = directions.iter().filter(|direction| meets(&piece, **direction)).count() as f64;
                let expected = f64::from(n) * solid_angle_of(&piece, point) / at.whole;
                assert!(
                    (count - expected).abs() < 4.5 * expected.sqrt() + 1.0,
                    "{point}: {count} {expected}"
                );
            }
        }
    }

    #[test]
    fn the_inverse_density_sums_to_the_solid_angle_near_and_far() {
        let shades = [triangle(Vec3::new(-1.0, 2.0, 0.0)), triangle(Vec3::new(-2.0, -1.0, 1.0))];
        // A hand's breadth before one, and so far that both are small.
        for point in [Vec3::new(0.3, 2.01, 0.3), Vec3::new(90.0, 160.0, 40.0)] {
            let at = ShadesAt::new(&shades, point);
            let (mut random, n) = (Random(7), 20_000);
            let sum: f64 = (0..n)
                .filter_map(|_| at.sample([random.next(), random.next(), random.next()]))
                .map(|d| 1.0 / at.pdf(d))
                .sum();
            let truth: f64 = shades.iter().map(|t| solid_angle_of(t, point)).sum();
            assert!(
                (sum / f64::from(n) / truth - 1.0).abs() < 1e-3,
                "{point}: {} {truth}",
                sum / f64::from(n)
            );
        }
    }
}
