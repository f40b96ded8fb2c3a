//! Where light comes into a room behind a shade: directions that diffuse surfaces try beside their own.
//!
//! Light that a shade scatters can be found by no shadow ray from the room; a path has to meet the shade and go on from there.
//! Two things are known beforehand: where the shades are, and into which directions they scatter the sun, in a table without its
//! peak extracted a thousandfold within one cell. So directions are drawn in part towards a random point of the shades, in part
//! against the directions in which a shade's table sends the light of a sun, and the rest from the surface's own lobes. The density
//! of the mixture is known, so nothing is biased (Veach 1997, section 9.2: one-sample model with the balance heuristic).

use crate::material::Table;
use crate::shapes::{Ray, Triangle};
use std::sync::Arc;
use sunpeak_bsdf::{Bsdf, Mode, PeakRule};
use sunpeak_core::{Frame, Vec3};

/// Share of directions that go to the shades, and against the scattered suns. The rest, the surface's own, keeps every weight
/// below 1/(1 - these) of what it would be without a guide.
const TO_SHADES: f64 = 0.3;
const AGAINST_SUNS: f64 = 0.2;

/// With more triangles of shades than this, looking at each of them costs more than it brings.
const MAX_TRIANGLES: usize = 32;

/// With more pairs of sun and shade than this, likewise.
const MAX_SCATTERED_SUNS: usize = 8;

/// Directions worth trying from any diffuse surface.
#[derive(Debug)]
pub(crate) struct Guide {
    shades: Vec<Triangle>,
    suns: Vec<ScatteredSun>,
}

/// How many directions of each kind are drawn at a vertex, on average.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rates {
    /// Of the surface's own lobes.
    pub own: f64,
    /// Towards the shades.
    pub shades: f64,
    /// Against the scattered suns.
    pub suns: f64,
}

/// A sun, and the shades of one table and orientation that scatter its light.
#[derive(Clone, Debug)]
pub(crate) struct ScatteredSun {
    bsdf: Arc<Bsdf>,
    rule: PeakRule,
    frame: Frame,
    /// Towards the sun, in the BSDF's frame.
    w_in: Vec3,
}

impl ScatteredSun {
    /// `None` if the table scatters nothing of this sun to its other side. `sun` and `normal` are unit vectors in world axes.
    pub fn new(table: &Table, normal: Vec3, sun: Vec3) -> Option<Self> {
        let frame = table.level_frame(normal)?;
        let w_in = frame.to_local(sun);
        let scatters =
            table.bsdf.hemispherical_smooth(w_in, Mode::Transmission, table.rule).max_element() > 0.0;
        scatters.then(|| Self { bsdf: table.bsdf.clone(), rule: table.rule, frame, w_in })
    }

    /// Same shade and sun?
    pub fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.bsdf, &other.bsdf) && self.frame.z == other.frame.z && self.w_in == other.w_in
    }

    fn sample(&self, u: [f64; 3]) -> Option<Vec3> {
        let sample = self.bsdf.sample_mode(self.w_in, Mode::Transmission, u, self.rule)?;
        Some(-self.frame.to_world(sample.w_out))
    }

    fn pdf(&self, direction: Vec3) -> f64 {
        let w_out = self.frame.to_local(-direction);
        let is_behind = (w_out.z > 0.0) != (self.w_in.z > 0.0);
        if is_behind { self.bsdf.pdf_mode(self.w_in, w_out, self.rule) } else { 0.0 }
    }
}

impl Guide {
    /// From the triangles of scattering, transmitting surfaces and the suns that they scatter; `None` if there is nothing to
    /// guide to.
    pub fn new(mut shades: Vec<Triangle>, mut suns: Vec<ScatteredSun>) -> Option<Self> {
        suns.truncate(MAX_SCATTERED_SUNS);
        if shades.len() > MAX_TRIANGLES {
            shades.clear();
        }
        (!shades.is_empty() || !suns.is_empty()).then_some(Self { shades, suns })
    }

    /// One direction in all.
    pub fn one_direction(&self) -> Rates {
        let shades = if self.shades.is_empty() { 0.0 } else { TO_SHADES };
        let suns = if self.suns.is_empty() { 0.0 } else { AGAINST_SUNS };
        Rates { own: 1.0 - shades - suns, shades, suns }
    }

    /// One direction each way.
    pub fn one_each(&self) -> Rates {
        let one_if = |is_there: bool| f64::from(u8::from(is_there));
        Rates { own: 1.0, shades: one_if(!self.shades.is_empty()), suns: one_if(!self.suns.is_empty()) }
    }

    /// Draw a direction from a point towards a shade.
    pub fn sample_shades(&self, point: Vec3, u: [f64; 3]) -> Option<Vec3> {
        self.toward_shade(point, u[0], [u[1], u[2]])
    }

    /// Draw a direction against which a sun is scattered.
    pub fn sample_suns(&self, u: [f64; 3]) -> Option<Vec3> {
        let at = u[0] * self.suns.len() as f64;
        self.suns.get(at as usize)?.sample([at.fract(), u[1], u[2]])
    }

    /// Density [1/sr] of the guided directions at these rates.
    pub fn pdf(&self, rates: &Rates, point: Vec3, direction: Vec3) -> f64 {
        let suns: f64 = self.suns.iter().map(|sun| sun.pdf(direction)).sum();
        let suns = if self.suns.is_empty() { 0.0 } else { rates.suns * suns / self.suns.len() as f64 };
        suns + rates.shades * self.shades_pdf(point, direction)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    fn triangle(offset: Vec3) -> Triangle {
        Triangle([offset, offset + Vec3::new(2.0, 0.0, 0.0), offset + Vec3::new(0.5, 0.3, 1.5)])
    }

    #[test]
    fn directions_against_a_scattered_sun_follow_their_density() {
        use crate::testing::chi_square_of_sampler;
        use sunpeak_bsdf::synthetic::{Basis, Fabric};
        let fabric = Fabric { scattered: 0.05, ..Fabric::default() };
        for rule in [PeakRule::Off, PeakRule::Split] {
            let bsdf = Arc::new(fabric.tabulate(Basis::KlemsFull).expect("tabulates"));
            let frame = Frame::from_normal_up(Vec3::Y, Vec3::Z).expect("a frame");
            let w_in = frame.to_local(Vec3::new(0.3, -0.8, 0.5).normalize());
            let sun = ScatteredSun { bsdf, rule, frame, w_in };
            chi_square_of_sampler("scattered sun", |v, u| sun.sample([v, u[0], u[1]]), |d| sun.pdf(d));
        }
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
            let (mut random, n) = (Random(7), 200_000);
            let sum: f64 = (0..n)
                .filter_map(|_| guide.sample_shades(point, [random.next(), random.next(), random.next()]))
                .map(|d| 1.0 / guide.pdf(&guide.one_each(), point, d))
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
        assert!(Guide::new(Vec::new(), Vec::new()).is_none());
    }
}
