//! Where light comes into a room behind a shade: directions that diffuse surfaces try beside their own.
//!
//! Light that a shade scatters can be found by no shadow ray from the room; a path has to meet the shade and go on from there.
//! Two things are known beforehand: where the shades are, and into which directions they scatter the sun, in a table without its
//! peak extracted a thousandfold within one cell. So directions are drawn in part towards a random point of the shades, in part
//! against the directions in which a shade's table sends the light of a sun, and the rest from the surface's own lobes. The density
//! of the mixture is known, so nothing is biased (Veach 1997, section 9.2: one-sample model with the balance heuristic).

use crate::material::Table;
use crate::shapes::{Ray, Triangle};
use std::f64::consts::PI;
use std::sync::Arc;
use sunpeak_bsdf::{Bsdf, Mode, PeakRule};
use sunpeak_core::{Frame, Sampler, Vec3};

/// Share of directions that go to the shades, and against the scattered suns. The rest, the surface's own, keeps every weight
/// below 1/(1 - these) of what it would be without a guide.
const TO_SHADES: f64 = 0.3;
const AGAINST_SUNS: f64 = 0.2;

/// Share of directions against a scattered sun that are drawn by the table. Seen from the room its cells lie elsewhere than seen
/// from the sun, so that at the edge of a peak a table alone would find too little: the rest are drawn around the sun.
const BY_TABLE: f64 = 0.6;

/// Angle around the sun below which the density is level [deg]: half the cell of a tensor tree of 16384.
const LEVEL_DEG: f64 = 0.5;

/// Mean density of the directions into which a table scatters a sun, over that of an even hemisphere, below which they are not
/// worth looking for apart. An even lobe has 4/3.
const LEAST_CONCENTRATION: f64 = 4.0;

/// Directions from which that is told.
const CONCENTRATION_SAMPLES: u64 = 256;

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
    /// The same in world axes.
    sun: Vec3,
}

impl ScatteredSun {
    /// `None` if the table scatters this sun nowhere in particular on its other side. `sun` and `normal` are unit vectors in world axes.
    pub fn new(table: &Table, normal: Vec3, sun: Vec3) -> Option<Self> {
        let frame = table.level_frame(normal)?;
        let w_in = frame.to_local(sun);
        let scatters =
            table.bsdf.hemispherical_smooth(w_in, Mode::Transmission, table.rule).max_element() > 0.0;
        let found = Self { bsdf: table.bsdf.clone(), rule: table.rule, frame, w_in, sun };
        (scatters && found.concentration() > LEAST_CONCENTRATION).then_some(found)
    }

    /// Mean density of the directions that the table draws, over that of an even hemisphere.
    fn concentration(&self) -> f64 {
        let density = |i: u64| {
            let u = Sampler::new(0, 0, i).next_3d();
            let drawn = self.bsdf.sample_mode(self.w_in, Mode::Transmission, u, self.rule);
            drawn.map_or(0.0, |sample| self.bsdf.pdf_mode(self.w_in, sample.w_out, self.rule))
        };
        2.0 * PI * (0..CONCENTRATION_SAMPLES).map(density).sum::<f64>() / CONCENTRATION_SAMPLES as f64
    }

    /// Same shade and sun?
    pub fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.bsdf, &other.bsdf) && self.frame.z == other.frame.z && self.w_in == other.w_in
    }

    fn sample(&self, u: [f64; 3]) -> Option<Vec3> {
        if u[0] >= BY_TABLE {
            return Some(around(self.sun, [u[1], u[2]]));
        }
        let u = [u[0] / BY_TABLE, u[1], u[2]];
        let sample = self.bsdf.sample_mode(self.w_in, Mode::Transmission, u, self.rule)?;
        Some(-self.frame.to_world(sample.w_out))
    }

    fn pdf(&self, direction: Vec3) -> f64 {
        let w_out = self.frame.to_local(-direction);
        let is_behind = (w_out.z > 0.0) != (self.w_in.z > 0.0);
        let by_table = if is_behind { self.bsdf.pdf_mode(self.w_in, w_out, self.rule) } else { 0.0 };
        BY_TABLE * by_table + (1.0 - BY_TABLE) * around_pdf(self.sun, direction)
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

/// 1 - cos of the angle within which the density is level.
fn level() -> f64 {
    2.0 * (LEVEL_DEG.to_radians() / 2.0).sin().powi(2)
}

/// A direction with density in proportion to 1/(h + level), h = 1 - cos(angle to the sun): about the same chance for each
/// octave of the angle.
fn around(sun: Vec3, [u, v]: [f64; 2]) -> Vec3 {
    let level = level();
    let h = level * ((2.0 + level) / level).powf(u) - level;
    let sin = (h * (2.0 - h)).max(0.0).sqrt();
    let (y, x) = (2.0 * PI * v).sin_cos();
    Frame::from_normal(sun).to_world(Vec3::new(sin * x, sin * y, 1.0 - h))
}

/// Density [1/sr] of [`around`].
fn around_pdf(sun: Vec3, direction: Vec3) -> f64 {
    let level = level();
    let h = 0.5 * (direction - sun).length_squared();
    1.0 / (2.0 * PI * (h + level) * ((2.0 + level) / level).ln())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    fn triangle(offset: Vec3) -> Triangle {
        Triangle([offset, offset + Vec3::new(2.0, 0.0, 0.0), offset + Vec3::new(0.5, 0.3, 1.5)])
    }

    /// Share of directions within an angle of the sun: the integral of the density over the cap, in closed form.
    fn share_within(h: f64) -> f64 {
        ((h + level()) / level()).ln() / ((2.0 + level()) / level()).ln()
    }

    #[test]
    fn directions_around_the_sun_follow_their_density() {
        let sun = Vec3::new(0.3, -0.8, 0.5).normalize();
        let (mut random, n) = (Random(7), 100_000);
        let directions: Vec<Vec3> = (0..n).map(|_| around(sun, [random.next(), random.next()])).collect();
        for degrees in [0.1f64, 0.5, 2.0, 10.0, 45.0, 120.0, 180.0] {
            let h = 2.0 * (degrees.to_radians() / 2.0).sin().powi(2);
            let within = directions.iter().filter(|d| 1.0 - d.dot(sun) <= h + 1e-12).count();
            let share = share_within(h);
            let error = (share * (1.0 - share) / f64::from(n)).sqrt();
            assert!((within as f64 / f64::from(n) - share).abs() <= 4.0 * error + 1e-9, "{degrees} degrees");
            // The density is the derivative of the share by solid angle, 2 pi dh.
            let step = 1e-4 * h;
            let slope = (share_within(h + step) - share_within(h - step)) / (4.0 * PI * step);
            let side = sun.any_orthonormal_vector();
            let direction = sun * (1.0 - h) + side * (h * (2.0 - h)).max(0.0).sqrt();
            assert!((around_pdf(sun, direction) / slope - 1.0).abs() < 1e-5, "{degrees} degrees");
        }
        let mean: Vec3 = directions.iter().map(|d| *d - sun * d.dot(sun)).sum::<Vec3>() / f64::from(n);
        assert!(mean.length() < 0.01, "uneven in azimuth: {mean}");
    }

    #[test]
    fn directions_against_a_scattered_sun_follow_their_density() {
        use crate::testing::chi_square_of_sampler;
        use sunpeak_bsdf::synthetic::{Basis, Fabric};
        let fabric = Fabric { scattered: 0.05, ..Fabric::default() };
        for rule in [PeakRule::Off, PeakRule::Split] {
            let bsdf = Arc::new(fabric.tabulate(Basis::KlemsFull).expect("tabulates"));
            let frame = Frame::from_normal_up(Vec3::Y, Vec3::Z).expect("a frame");
            let sun = Vec3::new(0.3, -0.8, 0.5).normalize();
            let sun = ScatteredSun { bsdf, rule, frame, w_in: frame.to_local(sun), sun };
            chi_square_of_sampler("scattered sun", |v, u| sun.sample([v, u[0], u[1]]), |d| sun.pdf(d));
        }
    }

    #[test]
    fn a_peak_is_worth_looking_for_and_an_even_lobe_is_not() {
        use sunpeak_bsdf::synthetic::{Basis, Fabric};
        let frame = Frame::from_normal_up(Vec3::Y, Vec3::Z).expect("a frame");
        let sun = Vec3::new(0.3, -0.8, 0.5).normalize();
        let of = |openness, lobe_share, rule| {
            let fabric = Fabric { scattered: 0.05, openness, lobe_share, ..Fabric::default() };
            let bsdf = Arc::new(fabric.tabulate(Basis::KlemsFull).expect("tabulates"));
            ScatteredSun { bsdf, rule, frame, w_in: frame.to_local(sun), sun }.concentration()
        };
        assert!(
            of(0.03, 0.5, PeakRule::Off) > LEAST_CONCENTRATION
                && of(0.03, 0.5, PeakRule::Split) < LEAST_CONCENTRATION
        );
        // Without holes and lobe the fabric scatters evenly: 2 pi times the integral of (cos/pi)^2 over the hemisphere.
        let even = of(0.0, 0.0, PeakRule::Off);
        assert!((even / (4.0 / 3.0) - 1.0).abs() < 0.02, "{even}");
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
