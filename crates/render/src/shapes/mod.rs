//! Shapes that rays can hit. All tests run in double precision; a ray may start on the surface that it left.

mod cone;
mod mesh;
mod polygon;
mod quad;
mod ring;
mod sphere;
mod triangle;

pub(crate) use cone::Cone;
pub(crate) use mesh::MeshSurface;
pub(crate) use polygon::Polygon;
pub(crate) use quad::Quad;
pub(crate) use ring::Ring;
pub(crate) use sphere::Sphere;
pub(crate) use triangle::Triangle;

use sunpeak_core::Vec3;

/// Distances along a ray at which it crosses a shape, in no order; infinity where there is no crossing.
pub(crate) type Crossings = [f64; 2];

/// No crossing at all.
pub(crate) const MISS: Crossings = [f64::INFINITY; 2];

/// Surfaces closer than this [m] are at the same place (Radiance, `FTINY`): one of them counts.
pub(crate) const COINCIDENT: f64 = 1e-6;

/// A ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// Nothing nearer to the origin than this is hit, nor is the surface that the ray leaves.
    pub start: f64,
}

impl Ray {
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, start: 0.0 }
    }

    /// From a point at which a surface was passed: others at the same place are passed with it.
    pub fn past(point: Vec3, direction: Vec3) -> Self {
        Self { origin: point, direction, start: COINCIDENT }
    }

    pub fn at(&self, t: f64) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Smallest and largest corner of an axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds {
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(Self { min: p, max: p }))
    }

    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The disc of a circle around `center`: its extent along axis i is `radius * sqrt(1 - n_i²)`.
    pub fn of_disc(center: Vec3, normal: Vec3, radius: f64) -> Self {
        let extent = (Vec3::ONE - normal * normal).max(Vec3::ZERO).map(f64::sqrt) * radius;
        Self { min: center - extent, max: center + extent }
    }

    /// Where the ray enters and leaves the box; `None` if it misses (slab method, Kay and Kajiya 1986).
    pub fn crossing(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            if d == 0.0 {
                if o < self.min[axis] || o > self.max[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.min[axis] - o) / d, (self.max[axis] - o) / d);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far && far >= 0.0).then_some((near, far))
    }
}

/// Geometry that is not cut into triangles.
#[derive(Clone, Debug)]
pub(crate) enum Analytic {
    Sphere(Sphere),
    Cone(Cone),
    Ring(Ring),
    Polygon(Polygon),
}

impl Analytic {
    pub fn crossings(&self, ray: &Ray) -> Crossings {
        match self {
            Self::Sphere(s) => s.crossings(ray),
            Self::Cone(s) => s.crossings(ray),
            Self::Ring(s) => s.crossings(ray),
            Self::Polygon(s) => s.crossings(ray),
        }
    }

    /// Unit normal at a point of the surface, on the shape's front.
    pub fn normal(&self, point: Vec3) -> Vec3 {
        match self {
            Self::Sphere(s) => s.normal(point),
            Self::Cone(s) => s.normal(point),
            Self::Ring(s) => s.normal,
            Self::Polygon(s) => s.normal,
        }
    }

    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Sphere(s) => s.bounds(),
            Self::Cone(s) => s.bounds(),
            Self::Ring(s) => s.bounds(),
            Self::Polygon(s) => s.bounds(),
        }
    }
}

/// Real roots of `a t² + 2 b t + c`, without cancellation (Numerical Recipes, section 5.6); `MISS` if there are none.
pub(crate) fn quadratic_roots(a: f64, b: f64, c: f64) -> Crossings {
    if a == 0.0 {
        return if b == 0.0 { MISS } else { [-0.5 * c / b, f64::INFINITY] };
    }
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return MISS;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    if q == 0.0 { [0.0, f64::INFINITY] } else { [q / a, c / q] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_keep_their_digits() {
        // t² - 1e8 t + 1: roots 1e8 and 1e-8.
        let mut roots = quadratic_roots(1.0, -0.5e8, 1.0);
        roots.sort_by(f64::total_cmp);
        assert!((roots[0] / 1e-8 - 1.0).abs() < 1e-12 && (roots[1] / 1e8 - 1.0).abs() < 1e-12);
        assert_eq!(quadratic_roots(0.0, -1.0, 4.0)[0], 2.0);
        assert_eq!(quadratic_roots(1.0, 0.0, 1.0), MISS);
    }

    #[test]
    fn a_box_is_crossed_where_it_stands() {
        let b = Bounds { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(1.0, 2.0, 3.0) };
        let ray = |o: [f64; 3], d: [f64; 3]| Ray::new(o.into(), d.into());
        assert_eq!(b.crossing(&ray([-1.0, 1.0, 1.0], [1.0, 0.0, 0.0])), Some((1.0, 2.0)));
        assert_eq!(b.crossing(&ray([-1.0, 2.5, 1.0], [1.0, 0.0, 0.0])), None);
        assert!(b.crossing(&ray([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])).is_some());
        assert_eq!(b.crossing(&ray([2.0, 1.0, 1.0], [1.0, 0.0, 0.0])), None);
    }
}
