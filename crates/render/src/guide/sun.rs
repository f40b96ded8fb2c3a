//! Directions against which a shade's table scatters a sun.

use crate::material::Table;
use std::f64::consts::PI;
use std::sync::Arc;
use sunpeak_bsdf::{Bsdf, Mode, PeakRule};
use sunpeak_core::{Frame, Sampler, Vec3, warp};

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

/// A sun, and the shades of one table and orientation that scatter its light.
#[derive(Clone, Debug)]
pub(crate) struct ScatteredSun {
    bsdf: Arc<Bsdf>,
    rule: PeakRule,
    frame: Frame,
    /// Towards the sun, in the BSDF's frame.
    w_in: Vec3,
    around: Around,
}

impl ScatteredSun {
    /// `None` if the table scatters this sun nowhere in particular on its other side. `sun` and `normal` are unit vectors in world axes.
    pub fn new(table: &Table, normal: Vec3, sun: Vec3) -> Option<Self> {
        let frame = table.level_frame(normal)?;
        let w_in = frame.to_local(sun);
        let scatters =
            table.bsdf.hemispherical_smooth(w_in, Mode::Transmission, table.rule).max_element() > 0.0;
        let found =
            Self { bsdf: table.bsdf.clone(), rule: table.rule, frame, w_in, around: Around::new(sun) };
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

    pub(super) fn sample(&self, u: [f64; 3]) -> Option<Vec3> {
        if u[0] >= BY_TABLE {
            return Some(self.around.sample([u[1], u[2]]));
        }
        let u = [u[0] / BY_TABLE, u[1], u[2]];
        let sample = self.bsdf.sample_mode(self.w_in, Mode::Transmission, u, self.rule)?;
        Some(-self.frame.to_world(sample.w_out))
    }

    pub(super) fn pdf(&self, direction: Vec3) -> f64 {
        let w_out = self.frame.to_local(-direction);
        let is_behind = (w_out.z > 0.0) != (self.w_in.z > 0.0);
        let by_table = if is_behind { self.bsdf.pdf_mode(self.w_in, w_out, self.rule) } else { 0.0 };
        BY_TABLE * by_table + (1.0 - BY_TABLE) * self.around.pdf(direction)
    }
}

/// Directions around a sun with density in proportion to 1/(h + level), h = 1 - cos(angle to the sun): about the same chance for
/// each octave of the angle.
#[derive(Clone, Debug)]
struct Around {
    frame: Frame,
    /// 1 - cos of the angle within which the density is level.
    level: f64,
    /// Logarithm of the density's range.
    octaves: f64,
}

impl Around {
    fn new(sun: Vec3) -> Self {
        let level = 2.0 * (LEVEL_DEG.to_radians() / 2.0).sin().powi(2);
        Self { frame: Frame::from_normal(sun), level, octaves: ((2.0 + level) / level).ln() }
    }

    fn sample(&self, [u, v]: [f64; 2]) -> Vec3 {
        let h = self.level * ((self.octaves * u).exp() - 1.0);
        let sin = (h * (2.0 - h)).max(0.0).sqrt();
        let [x, y] = warp::circle(v);
        self.frame.to_world(Vec3::new(sin * x, sin * y, 1.0 - h))
    }

    /// Density [1/sr].
    fn pdf(&self, direction: Vec3) -> f64 {
        let h = 0.5 * (direction - self.frame.z).length_squared();
        1.0 / (2.0 * PI * (h + self.level) * self.octaves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    /// Share of directions within an angle of the sun: the integral of the density over the cap, in closed form.
    fn share_within(around: &Around, h: f64) -> f64 {
        ((h + around.level) / around.level).ln() / ((2.0 + around.level) / around.level).ln()
    }

    #[test]
    fn directions_around_the_sun_follow_their_density() {
        let sun = Vec3::new(0.3, -0.8, 0.5).normalize();
        let around = Around::new(sun);
        let (mut random, n) = (Random(7), 100_000);
        let directions: Vec<Vec3> = (0..n).map(|_| around.sample([random.next(), random.next()])).collect();
        for degrees in [0.1f64, 0.5, 2.0, 10.0, 45.0, 120.0, 180.0] {
            let h = 2.0 * (degrees.to_radians() / 2.0).sin().powi(2);
            let within = directions.iter().filter(|d| 1.0 - d.dot(sun) <= h + 1e-12).count();
            let share = share_within(&around, h);
            let error = (share * (1.0 - share) / f64::from(n)).sqrt();
            assert!((within as f64 / f64::from(n) - share).abs() <= 4.0 * error + 1e-9, "{degrees} degrees");
            // The density is the derivative of the share by solid angle, 2 pi dh.
            let step = 1e-4 * h;
            let slope =
                (share_within(&around, h + step) - share_within(&around, h - step)) / (4.0 * PI * step);
            let side = sun.any_orthonormal_vector();
            let direction = sun * (1.0 - h) + side * (h * (2.0 - h)).max(0.0).sqrt();
            assert!((around.pdf(direction) / slope - 1.0).abs() < 1e-5, "{degrees} degrees");
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
            let sun = ScatteredSun { bsdf, rule, frame, w_in: frame.to_local(sun), around: Around::new(sun) };
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
            ScatteredSun { bsdf, rule, frame, w_in: frame.to_local(sun), around: Around::new(sun) }
                .concentration()
        };
        assert!(
            of(0.03, 0.5, PeakRule::Off) > LEAST_CONCENTRATION
                && of(0.03, 0.5, PeakRule::Split) < LEAST_CONCENTRATION
        );
        // Without holes and lobe the fabric scatters evenly: 2 pi times the integral of (cos/pi)^2 over the hemisphere.
        let even = of(0.0, 0.0, PeakRule::Off);
        assert!((even / (4.0 / 3.0) - 1.0).abs() < 0.02, "{even}");
    }
}
