//! Convex plane pieces with up to four corners: shades and windows as paths look for them.

use super::{COINCIDENT, Triangle};
use std::f64::consts::PI;
use sunpeak_core::{Frame, Vec3, warp};

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
    /// At the first corner: x along the first edge, z across the plane. There the corners turn counter-clockwise.
    frame: Frame,
    /// Corners in it.
    x: [f64; 4],
    y: [f64; 4],
    /// Across each edge, outwards, and how far out the edge is from the first corner.
    across_x: [f64; 4],
    across_y: [f64; 4],
    edges: [f64; 4],
    area: f64,
    /// Of the two triangles that it is made of.
    half_areas: [f64; 2],
    /// What counts as in its plane: a distance.
    near: f64,
    is_rectangle: bool,
}

impl Quad {
    fn new(corners: [Vec3; 4]) -> Self {
        let [a, b, c, d] = corners;
        let x_axis = (b - a).normalize_or_zero();
        let normal = (c - a).cross(d - b);
        let normal = (normal - normal.dot(x_axis) * x_axis).normalize_or_zero();
        let frame = Frame { x: x_axis, y: normal.cross(x_axis), z: normal };
        let [x, y] = [frame.x, frame.y].map(|axis| corners.map(|corner| (corner - a).dot(axis)));
        let [across_x, across_y] =
            [[0, 1, 2, 3].map(|i| y[(i + 1) % 4] - y[i]), [0, 1, 2, 3].map(|i| x[i] - x[(i + 1) % 4])];
        let half_areas = [0.5 * (x[1] * y[2] - x[2] * y[1]), 0.5 * (x[2] * y[3] - x[3] * y[2])];
        let area = half_areas[0] + half_areas[1];
        Self {
            corners,
            frame,
            x,
            y,
            across_x,
            across_y,
            edges: [0, 1, 2, 3].map(|i| x[i] * across_x[i] + y[i] * across_y[i]),
            area,
            half_areas,
            near: COINCIDENT.max(NEAR * area.sqrt()),
            is_rectangle: [c - b - (d - a), (d - a).project_onto(b - a)]
                .iter()
                .all(|v| v.length() <= PLANE * area.sqrt()),
        }
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

    /// A point in the piece's frame.
    #[inline(always)]
    fn local(&self, point: Vec3) -> Vec3 {
        self.frame.to_local(point - self.corners[0])
    }

    /// Distance at which a ray crosses it, from either side; nothing if it does not.
    #[inline(always)]
    pub fn crossing(&self, origin: Vec3, direction: Vec3) -> Option<f64> {
        let from = origin - self.corners[0];
        let (height, along) = (from.dot(self.frame.z), direction.dot(self.frame.z));
        let (height, descent) = if height > 0.0 { (height, -along) } else { (-height, along) };
        if descent <= 0.0 {
            return None;
        }
        // Where it crosses the plane, times its descent.
        let across = from * descent + direction * height;
        let (x, y) = (across.dot(self.frame.x), across.dot(self.frame.y));
        let is_within = |i: usize| self.across_x[i] * x + self.across_y[i] * y <= self.edges[i] * descent;
        (is_within(0) & is_within(1) & is_within(2) & is_within(3)).then(|| height / descent)
    }

    pub fn area(&self) -> f64 {
        self.area
    }

    /// Area across a direction.
    pub fn area_across(&self, direction: Vec3) -> f64 {
        self.area * self.frame.z.dot(direction).abs()
    }

    /// The two triangles that it is made of; the second may be empty.
    pub fn halves(&self) -> [Triangle; 2] {
        let [a, b, c, d] = self.corners;
        [Triangle([a, b, c]), Triangle([a, c, d])]
    }

    /// Solid angle [sr] from a point; none from its own plane. Van Oosterom and Strackee (1983) give the half of a triangle's as the angle
    /// of a complex number: the product of two has the angle of both together, which is half of a hemisphere at most. The triple
    /// products are the height over the plane times twice the areas.
    pub fn solid_angle(&self, point: Vec3) -> f64 {
        let from = self.local(point);
        let height = from.z.abs();
        if height <= self.near {
            return 0.0;
        }
        let (x, y) = (self.x.map(|x| x - from.x), self.y.map(|y| y - from.y));
        let dot = |i: usize, j: usize| x[i] * x[j] + y[i] * y[j] + height * height;
        let [la, lb, lc, ld] = [0, 1, 2, 3].map(|i| dot(i, i).sqrt());
        let [ab, bc, cd, da] = [dot(0, 1), dot(1, 2), dot(2, 3), dot(3, 0)];
        let ac = dot(0, 2);
        let one = [la * (lb * lc + bc) + ab * lc + ac * lb, 2.0 * height * self.half_areas[0]];
        let other = [la * (ld * lc + cd) + da * lc + ac * ld, 2.0 * height * self.half_areas[1]];
        let half = warp::angle([
            one[0] * other[0] - one[1] * other[1],
            (one[0] * other[1] + other[0] * one[1]).max(0.0),
        ]);
        // Rounding knows no angle of zero.
        2.0 * half.max(0.0)
    }

    /// Is there a [map](Self::sample_rectangle) of the whole piece?
    pub fn is_rectangle(&self) -> bool {
        self.is_rectangle
    }

    /// A direction towards a rectangle of this solid angle [sr] from a point, drawn evenly from it (Ureña, Fajardo and King 2013, "An
    /// Area-Preserving Parametrization for Spherical Rectangles"): of the rectangle a line at x cuts off the part u, and along that the
    /// sine of the height is even in v.
    ///
    /// Without their inverse cosines. The lune between the planes of the lower and upper edge that ends at x has solid angle phi, counted
    /// from the foot point, where x/h = sin phi/sqrt((cos phi - cos(b1 - b0)) (cos phi + cos(b1 + b0))) with b0 and b1 the angles of
    /// these planes, tan b = y/h. The lune that ends at the rectangle's left is known by its sine and cosine.
    pub fn sample_rectangle(&self, point: Vec3, solid_angle: f64, [u, v]: [f64; 2]) -> Vec3 {
        let from = self.local(point);
        let (x0, x1, y0, y1) = (-from.x, self.x[2] - from.x, -from.y, self.y[2] - from.y);
        let (height, square) = (from.z.abs(), from.z * from.z);
        let left = x0 * x0 + square;
        let (r0, r1) = ((left + y0 * y0).sqrt(), (left + y1 * y1).sqrt());
        // Sines and cosines of lunes, all times sqrt(y0² + h²) sqrt(y1² + h²) and `left`.
        let [left_cos, left_sin] = [square * r0 * r1 + x0 * x0 * y0 * y1, x0 * height * (y1 * r0 - y0 * r1)];
        let [cos, sin] = warp::circle(u * solid_angle / (2.0 * PI));
        let [cos, sin] = [cos * left_cos - sin * left_sin, sin * left_cos + cos * left_sin];
        let across = (cos - left * (square + y0 * y1)) * (cos + left * (square - y0 * y1));
        let x = (height * sin / across.max(0.0).sqrt()).max(x0).min(x1);
        let distance = x * x + square;
        let sine = |y: f64| y / (distance + y * y).sqrt();
        let y = sine(y0) + v * (sine(y1) - sine(y0));
        let scale = ((1.0 - y * y).max(0.0) / distance).sqrt();
        self.frame.to_world(Vec3::new(x * scale, y, -from.z * scale))
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

    /// A rectangle of 2 by 1, askew, and a point at these places along its edges and over its plane.
    fn askew(x: f64, y: f64, height: f64) -> (Quad, Vec3) {
        let frame = Frame::from_normal(Vec3::new(0.3, -0.5, 0.7).normalize());
        let world = |x: f64, y: f64, z: f64| frame.to_world(Vec3::new(x, y, z)) + Vec3::new(20.0, -3.0, 7.0);
        let [a, b, c, d] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|[x, y]| world(x, y, 0.0));
        (Quad::new([a, b, c, d]), world(x, y, height))
    }

    /// Before its middle, an edge and a corner, beside it, near, far and grazing.
    const PLACES: [[f64; 3]; 13] = [
        [1.0, 0.5, 1.0],
        [0.3, 0.8, -0.4],
        [0.0, 0.4, 0.5],
        [2.0, 1.0, 0.5],
        [2.0, 1.0, -1e-3],
        [0.7, 0.2, 1e-3],
        [0.7, 0.2, 1e-5],
        [-0.01, 0.5, 1e-3],
        [1.5, 1.001, -1e-3],
        [5.0, -3.0, 2.0],
        [-9.0, 0.5, 1.0],
        [1.0, 8.0, 0.3],
        [40.0, 50.0, 60.0],
    ];

    #[test]
    fn of_a_rectangle_lines_cut_off_their_part_of_the_solid_angle() {
        for [x, y, height] in PLACES {
            let (quad, point) = askew(x, y, height);
            let (whole, mut random) = (quad.solid_angle(point), Random(5));
            for _ in 0..2000 {
                let u = [random.next(), random.next()];
                let direction = quad.sample_rectangle(point, whole, u);
                assert!((direction.length() - 1.0).abs() < 1e-14);
                let (from, along) = (quad.local(point), quad.frame.to_local(direction));
                let met = from - along * (from.z / along.z);
                // What is left of the point's column, and below it in that: by the solid angle of rectangles.
                let part = |x0: f64, x1: f64, y1: f64| {
                    let corner = |x, y| quad.corners[0] + quad.frame.to_world(Vec3::new(x, y, 0.0));
                    Quad::new([corner(x0, 0.0), corner(x1, 0.0), corner(x1, y1), corner(x0, y1)])
                        .solid_angle(point)
                };
                let left = part(0.0, met.x, 1.0) / whole;
                assert!((left - u[0]).abs() < 1e-9, "{x} {y} {height}: {left} {u:?}");
                let sine = |y: f64| {
                    let y = y - from.y;
                    y / ((met.x - from.x).powi(2) + from.z.powi(2) + y * y).sqrt()
                };
                let below = (sine(met.y) - sine(0.0)) / (sine(1.0) - sine(0.0));
                assert!((below - u[1]).abs() < 1e-9, "{x} {y} {height}: {below} {u:?}");
            }
        }
    }

    #[test]
    fn no_draw_from_a_rectangle_may_miss() {
        for [x, y, height] in PLACES {
            let (quad, point) = askew(x, y, height);
            let (whole, mut random) = (quad.solid_angle(point), Random(9));
            for i in 0..20_000 {
                // Edges too, but for their rounding.
                let mut at = |edge: bool| {
                    if edge { [1e-9, 1.0 - 1e-9][i / 7 % 2] } else { random.next() }
                };
                let u = [at(i % 5 == 0), at(i % 7 == 0)];
                let direction = quad.sample_rectangle(point, whole, u);
                assert!(quad.crossing(point, direction).is_some(), "{x} {y} {height}: {u:?}");
            }
        }
    }

    #[test]
    fn only_what_has_right_angles_is_a_rectangle() {
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X * 3.0, Vec3::new(3.0, 2.0, 0.0), Vec3::Y * 2.0];
        assert!(Quad::new([a, b, c, d]).is_rectangle());
        assert!(!Quad::new([a, b, c, c]).is_rectangle());
        assert!(!Quad::new([a, b, c + Vec3::X * 1e-6, d + Vec3::X * 1e-6]).is_rectangle());
        assert!(!Quad::new([a, b, c + Vec3::Y * 1e-6, d]).is_rectangle());
    }
}
