//! Triangles, without leaks between neighbours.
//!
//! Which side of an edge a ray passes is the sign of the triple product of its direction and the edge's corners, taken from
//! the ray's origin. With the corners swapped, as the neighbour has them, it is exactly the negative, rounding included; and
//! edges belong to both their triangles. So a closest hit never slips through a seam.

use super::{Bounds, Ray};
use sunpeak_core::{Vec3, warp};

/// Three corners; the front is where they turn counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle(pub [Vec3; 3]);

impl Triangle {
    /// Distance at which the ray crosses the triangle, from either side; infinity if it does not.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let [a, b, c] = self.0.map(|corner| corner - ray.origin);
        let d = ray.direction;
        let (u, v, w) = (d.dot(c.cross(b)), d.dot(a.cross(c)), d.dot(b.cross(a)));
        let is_left = (u < 0.0) | (v < 0.0) | (w < 0.0);
        let is_right = (u > 0.0) | (v > 0.0) | (w > 0.0);
        if is_left && is_right {
            return f64::INFINITY;
        }
        let whole = u + v + w;
        if whole == 0.0 {
            return f64::INFINITY;
        }
        // The weights of the corners give the point, from the origin: its distance.
        (u * d.dot(a) + v * d.dot(b) + w * d.dot(c)) / whole
    }

    pub fn area(&self) -> f64 {
        self.area_vector().length()
    }

    /// Normal times area.
    pub fn area_vector(&self) -> Vec3 {
        let [a, b, c] = self.0;
        0.5 * (b - a).cross(c - a)
    }

    /// Solid angle [sr] from a point (Van Oosterom and Strackee 1983).
    pub fn solid_angle(&self, point: Vec3) -> f64 {
        let [a, b, c] = self.0.map(|corner| corner - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let x = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * warp::angle([x, a.dot(b.cross(c)).abs()])
    }

    /// Weights of the corners that make a point of its plane.
    pub fn weights(&self, point: Vec3) -> [f64; 3] {
        let [a, b, c] = self.0;
        let whole = (b - a).cross(c - a);
        let share = |p: Vec3, q: Vec3| (p - point).cross(q - point).dot(whole) / whole.length_squared();
        [share(b, c), share(c, a), share(a, b)]
    }

    /// A uniformly distributed point (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
    pub fn sample([u, v]: [f64; 2], [a, b, c]: [Vec3; 3]) -> Vec3 {
        let (s, t) = if v > u { (0.5 * u, v - 0.5 * u) } else { (u - 0.5 * v, 0.5 * v) };
        a + (b - a) * s + (c - a) * t
    }

    pub fn bounds(&self) -> Bounds {
        Bounds::of_points(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Sampler;

    fn ray(origin: Vec3, direction: Vec3) -> Ray {
        Ray::new(origin, direction.normalize())
    }

    #[test]
    fn distance_is_that_to_the_plane() {
        let t = Triangle([Vec3::new(0.0, 0.0, 2.0), Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 2.0)]);
        for (x, y) in [(0.2, 0.3), (0.0, 0.0), (0.5, 0.5)] {
            assert!((t.crossing(&ray(Vec3::new(x, y, 0.0), Vec3::Z)) - 2.0).abs() < 1e-15);
            assert!((t.crossing(&ray(Vec3::new(x, y, 5.0), Vec3::NEG_Z)) - 3.0).abs() < 1e-15);
        }
        assert!(t.crossing(&ray(Vec3::new(0.6, 0.6, 0.0), Vec3::Z)).is_infinite());
        assert!(t.crossing(&ray(Vec3::new(0.2, 0.2, 0.0), Vec3::X)).is_infinite());
    }

    #[test]
    fn the_solid_angle_of_an_octant_is_half_of_pi() {
        let octant = Triangle([Vec3::X, Vec3::Y, Vec3::Z].map(|axis| 7.0 * axis));
        assert!((octant.solid_angle(Vec3::ZERO) - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
    }

    #[test]
    fn nothing_slips_between_neighbours() {
        // A fan around a vertex; rays are aimed at the shared edges and at the vertex itself.
        let rim: Vec<Vec3> =
            (0..7).map(|i| Vec3::new((i as f64).cos(), (i as f64).sin(), 0.1 * i as f64)).collect();
        let hub = Vec3::new(0.1, 0.05, 0.3);
        let fan: Vec<Triangle> = (0..7).map(|i| Triangle([hub, rim[i], rim[(i + 1) % 7]])).collect();
        let mut sampler = Sampler::new(1, 2, 3);
        for k in 0..2000 {
            let origin = Vec3::new(0.0, 0.0, 4.0) + 0.5 * warp::uniform_sphere(sampler.next_2d());
            let target = hub + (rim[k % 7] - hub) * (sampler.next_1d() * 0.999);
            let r = ray(origin, target - origin);
            assert!(fan.iter().any(|t| t.crossing(&r).is_finite()), "leak at {target}");
        }
    }

    #[test]
    fn samples_are_uniform() {
        let corners = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 1.0)];
        let n = 4096;
        let mean: Vec3 =
            (0..n).map(|i| Triangle::sample(Sampler::new(5, 0, i).next_2d(), corners)).sum::<Vec3>()
                / n as f64;
        assert!((mean - (corners[0] + corners[1] + corners[2]) / 3.0).length() < 1e-3, "{mean}");
    }
}
