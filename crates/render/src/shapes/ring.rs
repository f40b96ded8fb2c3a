//! Discs, and discs with a hole.

use super::{Bounds, Crossings, MISS, Ray};
use sunpeak_core::{Vec3, warp};

/// A flat ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring {
    pub center: Vec3,
    pub normal: Vec3,
    pub inner_radius: f64,
    pub outer_radius: f64,
}

impl Ring {
    pub fn crossings(&self, ray: &Ray) -> Crossings {
        let t = (self.center - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        if !t.is_finite() {
            return MISS;
        }
        let from_center = ray.at(t).distance_squared(self.center);
        let range = self.inner_radius * self.inner_radius..=self.outer_radius * self.outer_radius;
        if range.contains(&from_center) { [t, f64::INFINITY] } else { MISS }
    }

    pub fn bounds(&self) -> Bounds {
        Bounds::of_disc(self.center, self.normal, self.outer_radius)
    }

    pub fn area(&self) -> f64 {
        std::f64::consts::PI * (self.outer_radius.powi(2) - self.inner_radius.powi(2))
    }

    /// A uniformly distributed point.
    pub fn sample(&self, u: [f64; 2]) -> Vec3 {
        let [x, y] = warp::square_to_disk(u);
        // The disc's r² is uniform on [0, 1]; stretch it to the ring's.
        let (inner, outer) = (self.inner_radius.powi(2), self.outer_radius.powi(2));
        let r = x.hypot(y);
        let scale = if r > 0.0 { (inner + (outer - inner) * r * r).sqrt() / r } else { self.inner_radius };
        let (a, b) = self.normal.any_orthonormal_pair();
        self.center + (a * x + b * y) * scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Sampler;

    #[test]
    fn a_ray_hits_between_the_radii_only() {
        let ring =
            Ring { center: Vec3::new(0.0, 0.0, 1.0), normal: Vec3::Z, inner_radius: 0.5, outer_radius: 1.0 };
        let t = |x: f64| ring.crossings(&Ray::new(Vec3::new(x, 0.0, 0.0), Vec3::Z))[0];
        assert!(t(0.4).is_infinite() && t(1.1).is_infinite());
        assert_eq!(t(0.7), 1.0);
        assert!(ring.crossings(&Ray::new(Vec3::ZERO, Vec3::X))[0].is_infinite());
    }

    #[test]
    fn samples_are_uniform() {
        let ring = Ring {
            center: Vec3::ONE,
            normal: Vec3::new(0.6, 0.0, 0.8),
            inner_radius: 0.5,
            outer_radius: 1.0,
        };
        let n = 4096;
        // r² is uniform between inner² and outer²: its mean is their mean.
        let mean: f64 = (0..n)
            .map(|i| ring.sample(Sampler::new(9, 0, i).next_2d()).distance_squared(ring.center))
            .sum::<f64>()
            / n as f64;
        assert!((mean - 0.625).abs() < 1e-3, "{mean}");
    }
}
