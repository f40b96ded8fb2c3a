//! Spheres, and bubbles whose normal points inward.

use super::{Bounds, Crossings, Ray, quadratic_roots};
use sunpeak_core::Vec3;

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub center: Vec3,
    pub radius: f64,
    /// Does the normal point to the centre?
    pub inward: bool,
}

impl Sphere {
    pub fn crossings(&self, ray: &Ray) -> Crossings {
        let o = ray.origin - self.center;
        let distance = o.length();
        // (|o| - r)(|o| + r) keeps its digits for a ray that starts on the surface.
        quadratic_roots(1.0, o.dot(ray.direction), (distance - self.radius) * (distance + self.radius))
    }

    pub fn normal(&self, point: Vec3) -> Vec3 {
        let outward = (point - self.center).normalize_or(Vec3::Z);
        if self.inward { -outward } else { outward }
    }

    pub fn bounds(&self) -> Bounds {
        Bounds { min: self.center - self.radius, max: self.center + self.radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_lie_on_the_sphere() {
        let s = Sphere { center: Vec3::new(1.0, 2.0, 3.0), radius: 0.5, inward: false };
        let ray = Ray::new(Vec3::new(1.1, 2.2, -4.0), Vec3::Z);
        let mut t = s.crossings(&ray);
        t.sort_by(f64::total_cmp);
        let half_chord = (0.25f64 - 0.05).sqrt();
        assert!((t[0] - (7.0 - half_chord)).abs() < 1e-13 && (t[1] - (7.0 + half_chord)).abs() < 1e-13);
        assert_eq!(s.normal(Vec3::new(1.0, 2.0, 3.5)), Vec3::Z);
    }
}
