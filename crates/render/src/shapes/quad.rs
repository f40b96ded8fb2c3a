//! Convex plane pieces with up to four corners: shades and windows as paths look for them.

use super::{COINCIDENT, Triangle};
use sunpeak_core::Vec3;

/// Triangles are in one plane if the corner of one stands out of the other's by less than this, in edges of a square of its size.
const PLANE: f64 = 1e-9;

/// Seen from nearer to its plane than this, in edges of a square of its size, a piece is not looked for: from the piece itself it fills half
/// the sphere by rounding alone, and from beside it there is nothing to see.
const NEAR: f64 = 1e-6;

/// A convex plane piece; of a triangle the last two corners are the same. Both its sides are alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quad {
    /// In turn.
    corners: [Vec3; 4],
    /// Normal times area.
    area_vector: Vec3,
    /// Across each edge, outwards; and how far out the edge is, both from the first corner.
    edges: [(Vec3, f64); 4],
    /// What counts as in its plane: a distance, times the area.
    near: f64,
}

impl Quad {
    fn new(corners: [Vec3; 4]) -> Self {
        let [a, b, c, d] = corners;
        let area_vector = 0.5 * (c - a).cross(d - b);
        let edges = [0, 1, 2, 3].map(|i| {
            let across = (corners[(i + 1) % 4] - corners[i]).cross(area_vector);
            (across, across.dot(corners[i] - a))
        });
        let area = area_vector.length();
        Self { corners, area_vector, edges, near: area * COINCIDENT.max(NEAR * area.sqrt()) }
    }

    /// Triangles, two of them as one wherever they make a convex quadrilateral.
    pub fn joined(triangles: &[Triangle]) -> Vec<Self> {
        let mut left = triangles.to_vec();
        let mut found = Vec::new();
        while let Some(triangle) = left.pop() {
            let pair =
                left.iter().enumerate().rev().find_map(|(i, other)| Some((i, ring_of(&triangle, other)?)));
            found.push(match pair {
                Some((i, ring)) => {
                    left.remove(i);
                    Self::new(ring)
                }
                None => {
                    let [a, b, c] = triangle.0;
                    Self::new([a, b, c, c])
                }
            });
        }
        found
    }

    /// Distance at which a ray crosses it, from either side; nothing if it does not.
    pub fn crossing(&self, origin: Vec3, direction: Vec3) -> Option<f64> {
        let from_corner = origin - self.corners[0];
        let t = -from_corner.dot(self.area_vector) / direction.dot(self.area_vector);
        let point = from_corner + direction * t;
        let is_out = |&(across, edge): &(Vec3, f64)| point.dot(across) > edge;
        // Of a ray along the plane `t` is infinite or not a number.
        (t > 0.0 && t.is_finite() && !self.edges.iter().fold(false, |out, edge| out | is_out(edge)))
            .then_some(t)
    }

    pub fn area_vector(&self) -> Vec3 {
        self.area_vector
    }

    /// The two triangles that it is made of; the second may be empty.
    pub fn halves(&self) -> [Triangle; 2] {
        let [a, b, c, d] = self.corners;
        [Triangle([a, b, c]), Triangle([a, c, d])]
    }

    /// Solid angle [sr] from a point; none from its own plane. Van Oosterom and Strackee (1983) give the half of a triangle's as the angle
    /// of a complex number: the product of two has the angle of both together, which is half of a hemisphere at most.
    pub fn solid_angle(&self, point: Vec3) -> f64 {
        if (point - self.corners[0]).dot(self.area_vector).abs() <= self.near {
            return 0.0;
        }
        let [[x, y], [other_x, other_y]] = self.halves().map(|half| half.half_solid_angle(point));
        2.0 * (x * other_y + other_x * y).max(0.0).atan2(x * other_x - y * other_y)
    }
}

/// The corners of the convex quadrilateral that two triangles make, the diagonal from the first to the third.
fn ring_of(one: &Triangle, other: &Triangle) -> Option<[Vec3; 4]> {
    let apart = |of: &Triangle, from: &Triangle| {
        let mut corners = (0..3).filter(|&i| !from.0.contains(&of.0[i]));
        corners.next().filter(|_| corners.next().is_none())
    };
    let (i, j) = (apart(one, other)?, apart(other, one)?);
    let [p, q, r] = [0, 1, 2].map(|k| one.0[(i + k) % 3]);
    let ring = [q, other.0[j], r, p];
    let normal = one.area_vector();
    let turns_left = (0..4).all(|k| {
        let [before, at, after] = [0, 1, 2].map(|step| ring[(k + step) % 4]);
        (at - before).cross(after - at).dot(normal) > 0.0
    });
    let is_plane = (other.0[j] - q).dot(normal).abs() <= PLANE * normal.length().powf(1.5);
    (turns_left && is_plane).then_some(ring)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Ray;
    use crate::testing::Random;
    use std::f64::consts::PI;

    fn rectangle() -> [Triangle; 2] {
        let [a, b, c, d] =
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|[x, z]| Vec3::new(x, 3.0, z));
        [Triangle([a, b, c]), Triangle([d, a, c])]
    }

    #[test]
    fn triangles_are_joined_where_that_is_convex_and_plane() {
        let [one, other] = rectangle();
        assert_eq!(Quad::joined(&[one, other]).len(), 1);
        // Both sides are alike.
        let [a, b, c] = other.0;
        assert_eq!(Quad::joined(&[one, Triangle([a, c, b])]).len(), 1);
        let bent = Triangle([a + Vec3::Y * 1e-6, b, c]);
        assert_eq!(Quad::joined(&[one, bent]).len(), 2);
        // A dart.
        let inwards = Triangle([Vec3::new(1.9, 3.0, 0.1), one.0[0], one.0[2]]);
        assert_eq!(Quad::joined(&[one, inwards]).len(), 2);
        assert_eq!(
            Quad::joined(&[one, Triangle(one.0.map(|corner| corner + Vec3::X * 5.0)), other]).len(),
            2
        );
    }

    #[test]
    fn the_face_of_a_cube_has_a_sixth_of_the_sphere() {
        let quad = Quad::joined(&rectangle().map(|t| Triangle(t.0.map(|p| p * Vec3::new(1.0, 1.0, 2.0)))))[0];
        let center = Vec3::new(1.0, 2.0, 1.0);
        assert!((quad.solid_angle(center) - 4.0 * PI / 6.0).abs() < 1e-14);
        // From before its middle: 4 atan(a b / (d sqrt(a² + b² + d²))), far away and so close that it is nearly a hemisphere.
        for d in [1e-5f64, 1e-3, 0.5, 20.0] {
            let expected = 4.0 * (d * (2.0 + d * d).sqrt()).recip().atan();
            assert!((quad.solid_angle(Vec3::new(1.0, 3.0 - d, 1.0)) / expected - 1.0).abs() < 1e-9, "{d}");
        }
    }

    #[test]
    fn in_its_own_plane_nothing_is_seen_of_it() {
        let mut random = Random(11);
        let mut any = || Vec3::new(random.next(), random.next(), random.next()) - 0.5;
        for shift in [0.0, 1000.0] {
            for _ in 0..100 {
                let (a, u, v, w) = (any() + shift, any(), any(), any());
                let triangles = [Triangle([a, a + u, a + u + v]), Triangle([a, a + u + v, a + v])];
                let quad = Quad::joined(&triangles)[0];
                // Where a ray from elsewhere meets it, and beside it.
                for (s, t) in [(0.3, 0.8), (0.5, 0.5), (1.0, 0.2), (1.7, -0.4)] {
                    let (target, eye) = (a + u * s + v * t, a + w);
                    let direction = (target - eye).normalize();
                    let point = eye + direction * (target - eye).length();
                    assert_eq!(quad.solid_angle(point), 0.0, "{quad:?} from {point}");
                }
            }
        }
        let octant = Quad::joined(&[Triangle([Vec3::X, Vec3::Y, Vec3::Z])])[0];
        assert!((octant.solid_angle(Vec3::ZERO) - PI / 2.0).abs() < 1e-14);
        assert_eq!(octant.solid_angle(Vec3::ONE / 3.0), 0.0);
    }

    #[test]
    fn it_is_what_its_triangles_are() {
        let triangles = rectangle();
        let quads = [Quad::joined(&triangles), Quad::joined(&triangles[..1])];
        let mut random = Random(3);
        for _ in 0..5000 {
            let mut place = |size: f64| {
                size * (Vec3::new(random.next(), random.next(), random.next()) - Vec3::new(0.5, 0.0, 0.5))
            };
            let (origin, direction) = (place(6.0), (place(1.0) + Vec3::Y * 0.01).normalize());
            let crossings = triangles.map(|t| t.crossing(&Ray::new(origin, direction)));
            let nearest =
                |n: usize| crossings[..n].iter().copied().filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
            for (quads, n) in quads.iter().zip([2, 1]) {
                let t = quads[0].crossing(origin, direction).unwrap_or(f64::INFINITY);
                assert!(t == nearest(n) || (t / nearest(n) - 1.0).abs() < 1e-9, "{t} {}", nearest(n));
            }
        }
    }
}
