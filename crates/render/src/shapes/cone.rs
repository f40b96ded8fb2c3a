//! Cones and cylinders, cups and tubes: open at both ends.

use super::{Bounds, Crossings, Ray, quadratic_roots};
use sunpeak_core::{Vec3, warp};

/// A frustum around an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    start: Vec3,
    axis: Vec3,
    length: f64,
    start_radius: f64,
    /// Change of the radius along the axis.
    slope: f64,
    inward: bool,
}

impl Cone {
    /// `None` if the ends coincide or no end has a radius.
    pub fn new(start: Vec3, end: Vec3, start_radius: f64, end_radius: f64, inward: bool) -> Option<Self> {
        let length = (end - start).length();
        let axis = (end - start).try_normalize()?;
        let slope = (end_radius - start_radius) / length;
        (start_radius.max(end_radius) > 0.0).then_some(Self {
            start,
            axis,
            length,
            start_radius,
            slope,
            inward,
        })
    }

    fn radius(&self, height: f64) -> f64 {
        self.start_radius + self.slope * height
    }

    /// Roots of |p - z a|² = (r0 + slope z)² with p the ray's point from the start and z = p.a, cut at both ends.
    pub fn crossings(&self, ray: &Ray) -> Crossings {
        let (o, d) = (ray.origin - self.start, ray.direction);
        let (oz, dz) = (o.dot(self.axis), d.dot(self.axis));
        let (o_side, d_side) = (o - self.axis * oz, d - self.axis * dz);
        let (r, dr) = (self.radius(oz), self.slope * dz);
        let reach = o_side.length();
        let roots = quadratic_roots(
            d_side.dot(d_side) - dr * dr,
            o_side.dot(d_side) - r * dr,
            (reach - r) * (reach + r),
        );
        roots.map(|t| if (0.0..=self.length).contains(&(oz + t * dz)) { t } else { f64::INFINITY })
    }

    pub fn normal(&self, point: Vec3) -> Vec3 {
        let p = point - self.start;
        let side = (p - self.axis * p.dot(self.axis)).normalize_or(self.axis.any_orthonormal_vector());
        let outward = (side - self.axis * self.slope).normalize();
        if self.inward { -outward } else { outward }
    }

    pub fn bounds(&self) -> Bounds {
        let end = self.start + self.axis * self.length;
        Bounds::of_disc(self.start, self.axis, self.start_radius).union(Bounds::of_disc(
            end,
            self.axis,
            self.radius(self.length),
        ))
    }

    /// Area of the side.
    pub fn area(&self) -> f64 {
        let mean = 0.5 * (self.start_radius + self.radius(self.length));
        2.0 * std::f64::consts::PI * mean * self.length.hypot(self.slope * self.length)
    }

    /// A uniformly distributed point of the side.
    pub fn sample(&self, [u, v]: [f64; 2]) -> Vec3 {
        // Area grows with the radius: the height solves r0 z + slope z²/2 = u (r0 l + slope l²/2).
        let whole = self.start_radius * self.length + 0.5 * self.slope * self.length * self.length;
        let [a, b] = quadratic_roots(0.5 * self.slope, 0.5 * self.start_radius, -u * whole);
        let height = [a, b].into_iter().find(|z| (0.0..=self.length).contains(z)).unwrap_or(u * self.length);
        let (x, y) = self.axis.any_orthonormal_pair();
        let [cos, sin] = warp::circle(v);
        self.start + self.axis * height + (x * cos + y * sin) * self.radius(height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::{Sampler, warp};

    fn shapes() -> Vec<Cone> {
        let (a, b) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 2.5, 5.0));
        [(0.5, 0.5), (0.7, 0.2), (0.0, 0.9), (0.8, 0.0)]
            .into_iter()
            .filter_map(|(r0, r1)| Cone::new(a, b, r0, r1, false))
            .collect()
    }

    /// Distance of a point from the cone's side, signed, positive outside; independent of the quadratic.
    fn signed_distance(c: &Cone, p: Vec3) -> f64 {
        let q = p - c.start;
        let z = q.dot(c.axis);
        (q - c.axis * z).length() - c.radius(z)
    }

    #[test]
    fn crossings_agree_with_marching_along_the_ray() {
        let mut sampler = Sampler::new(3, 1, 4);
        for cone in shapes() {
            for _ in 0..300 {
                let origin = Vec3::new(1.5, 2.2, 4.0) + 3.0 * warp::uniform_sphere(sampler.next_2d());
                let aim = Vec3::new(1.5, 2.2, 4.0) + 0.7 * warp::uniform_sphere(sampler.next_2d());
                let ray = Ray::new(origin, (aim - origin).normalize());
                let (steps, step) = (20_000, 6.0 / 20_000.0);
                let mut marched = Vec::new();
                for i in 0..steps {
                    let (t0, t1) = (i as f64 * step, (i + 1) as f64 * step);
                    let z = (ray.at(0.5 * (t0 + t1)) - cone.start).dot(cone.axis);
                    let inside = |t| signed_distance(&cone, ray.at(t)) < 0.0;
                    if inside(t0) != inside(t1) && (0.0..=cone.length).contains(&z) {
                        marched.push(t0);
                    }
                }
                let mut found: Vec<f64> =
                    cone.crossings(&ray).into_iter().filter(|t| t.is_finite() && *t > 0.0).collect();
                found.sort_by(f64::total_cmp);
                // Chords shorter than a step escape the march.
                if found.len() == 2 && found[1] - found[0] < 2.0 * step {
                    continue;
                }
                assert_eq!(found.len(), marched.len(), "{cone:?} {ray:?} {found:?} {marched:?}");
                assert!(found.iter().zip(&marched).all(|(a, b)| (a - b).abs() < 2.0 * step));
            }
        }
    }

    #[test]
    fn normals_are_gradients_and_samples_lie_on_the_side() {
        let mut sampler = Sampler::new(3, 1, 5);
        for cone in shapes() {
            for _ in 0..200 {
                let p = cone.sample(sampler.next_2d());
                assert!(signed_distance(&cone, p).abs() < 1e-12);
                let n = cone.normal(p);
                let rise = signed_distance(&cone, p + n * 1e-6) / 1e-6;
                let cosine = 1.0 / 1f64.hypot(cone.slope);
                assert!((rise - 1.0 / cosine).abs() < 1e-3, "{rise}");
                let b = cone.bounds();
                assert!(p.cmpge(b.min - 1e-12).all() && p.cmple(b.max + 1e-12).all());
            }
        }
    }

    #[test]
    fn samples_are_uniform_in_area() {
        // Mean height of a frustum's side: (r0/2 + slope l/3) / (r0 + slope l/2) of its length.
        for cone in shapes() {
            let n = 1 << 14;
            let mean: f64 = (0..n)
                .map(|i| (cone.sample(Sampler::new(2, 0, i).next_2d()) - cone.start).dot(cone.axis))
                .sum::<f64>()
                / n as f64;
            let (r, s, l) = (cone.start_radius, cone.slope, cone.length);
            let expected = l * (r / 2.0 + s * l / 3.0) / (r + s * l / 2.0);
            assert!((mean - expected).abs() < 1e-3, "{mean} {expected}");
        }
    }
}
