//! Directions towards shades and windows, evenly over the solid angle that they have.

use super::MAX_TRIANGLES;
use crate::shapes::{Quad, Triangle};
use arrayvec::ArrayVec;
use std::cell::OnceCell;
use std::f64::consts::PI;
use sunpeak_core::{Vec3, warp};

/// Below this solid angle [sr] a point of a shade is drawn evenly over its area: seen so small the two are alike, and spherical
/// trigonometry loses its digits.
const SMALL_SR: f64 = 1e-4;

/// Shades as a point sees them.
#[derive(Clone, Debug)]
pub(super) struct ShadesAt<'g> {
    quads: &'g [Quad],
    point: Vec3,
    /// Most points need not know: they draw no direction towards a shade, and meet none with those that they draw otherwise.
    sizes: OnceCell<Sizes>,
}

/// Solid angles [sr] of each shade, and of all together.
#[derive(Clone, Debug)]
struct Sizes {
    each: ArrayVec<f64, MAX_TRIANGLES>,
    whole: f64,
}

impl<'g> ShadesAt<'g> {
    /// Of at most [`MAX_TRIANGLES`] shades.
    pub fn new(quads: &'g [Quad], point: Vec3) -> Self {
        Self { quads, point, sizes: OnceCell::new() }
    }

    fn sizes(&self) -> &Sizes {
        self.sizes.get_or_init(|| {
            let each: ArrayVec<_, MAX_TRIANGLES> =
                self.quads.iter().map(|quad| quad.solid_angle(self.point)).collect();
            Sizes { whole: each.iter().sum(), each }
        })
    }

    /// A direction; `None` where no shade can be seen.
    pub fn sample(&self, [choice, u, v]: [f64; 3]) -> Option<Vec3> {
        let sizes = self.sizes();
        let mut left = choice * sizes.whole;
        let (quad, &solid_angle) = self.quads.iter().zip(&sizes.each).find(|(_, solid_angle)| {
            left -= **solid_angle;
            left < 0.0
        })?;
        if quad.is_rectangle() && solid_angle >= SMALL_SR {
            return Some(quad.sample_rectangle(self.point, solid_angle, [u, v]));
        }
        // Where in its solid angle, from 0 to 1: that chooses the half.
        self.sample_halves(quad, solid_angle, [(1.0 + left / solid_angle).max(0.0), u, v])
    }

    fn sample_halves(&self, quad: &Quad, solid_angle: f64, [at, u, v]: [f64; 3]) -> Option<Vec3> {
        let halves = quad.halves();
        if solid_angle < SMALL_SR {
            let half = if at * quad.area() < halves[0].area() { &halves[0] } else { &halves[1] };
            return Triangle::sample([u, v], half.0.map(|corner| corner - self.point)).try_normalize();
        }
        let first = halves[0].solid_angle(self.point);
        let (half, solid_angle) =
            if at * solid_angle < first { (&halves[0], first) } else { (&halves[1], solid_angle - first) };
        spherical(half.0.map(|corner| (corner - self.point).normalize()), solid_angle, [u, v])
    }

    /// Density [1/sr].
    #[inline]
    pub fn pdf(&self, direction: Vec3) -> f64 {
        let mut sum = 0.0;
        for (i, quad) in self.quads.iter().enumerate() {
            let Some(t) = quad.crossing(self.point, direction) else { continue };
            let solid_angle = self.sizes().each[i];
            if solid_angle >= SMALL_SR {
                sum += 1.0;
            } else if solid_angle > 0.0 {
                sum += solid_angle * t * t / quad.area_across(direction);
            }
        }
        if sum > 0.0 { sum / self.sizes().whole } else { 0.0 }
    }
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
    use crate::shapes::Ray;
    use crate::testing::Random;

    fn triangle(offset: Vec3) -> Triangle {
        Triangle([offset, offset + Vec3::new(2.0, 0.0, 0.0), offset + Vec3::new(0.5, 0.3, 1.5)])
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
        let [a, b, c] = both[0].0;
        // A trapezoid of unlike halves.
        let window = [both[0], Triangle([a, c, c + 0.3 * (a - b)])];
        // Between them, close before one, and far away from one; a window of two triangles near and far.
        for (point, shades) in [
            (Vec3::new(0.2, 0.1, 0.3), &both[..]),
            (Vec3::new(0.3, 1.98, 0.3), &both[..]),
            (Vec3::new(90.0, 160.0, 40.0), &both[..1]),
            (Vec3::new(0.3, 1.5, 0.3), &window[..]),
            (Vec3::new(90.0, 160.0, 40.0), &window[..]),
        ] {
            let quads = Quad::joined(shades);
            assert!(quads.len() == 1 || shades.len() == both.len());
            let (at, mut random, n) = (ShadesAt::new(&quads, point), Random(5), 50_000);
            let directions: Vec<Vec3> = (0..n)
                .map(|_| at.sample([random.next(), random.next(), random.next()]).expect("a direction"))
                .collect();
            let meets = |piece: &Triangle, direction: Vec3| {
                let t = piece.crossing(&Ray::new(point, direction));
                t > 0.0 && t.is_finite()
            };
            for piece in shades.iter().copied().flat_map(pieces) {
                let count = directions.iter().filter(|direction| meets(&piece, **direction)).count() as f64;
                let expected = f64::from(n) * piece.solid_angle(point) / at.sizes().whole;
                assert!(
                    (count - expected).abs() < 4.5 * expected.sqrt() + 1.0,
                    "{point}: {count} {expected}"
                );
            }
        }
    }

    #[test]
    fn the_inverse_density_sums_to_the_solid_angle_near_and_far() {
        let both = [triangle(Vec3::new(-1.0, 2.0, 0.0)), triangle(Vec3::new(-2.0, -1.0, 1.0))];
        let [a, b, c] = both[0].0;
        let window = [both[0], Triangle([a, c, c + 0.3 * (a - b)])];
        // A hand's breadth before one, and so far that both are small.
        for (point, shades) in [Vec3::new(0.3, 2.01, 0.3), Vec3::new(90.0, 160.0, 40.0)]
            .into_iter()
            .flat_map(|point| [(point, both), (point, window)])
        {
            let quads = Quad::joined(&shades);
            let at = ShadesAt::new(&quads, point);
            let (mut random, n) = (Random(7), 20_000);
            let sum: f64 = (0..n)
                .map(|_| {
                    let direction = at.sample([random.next(), random.next(), random.next()]);
                    1.0 / at.pdf(direction.expect("a direction"))
                })
                .sum();
            let truth: f64 = shades.iter().map(|t| t.solid_angle(point)).sum();
            let mean = sum / f64::from(n);
            assert!((mean / truth - 1.0).abs() < 1e-3, "{point}: {mean} {truth}");
        }
    }
}
