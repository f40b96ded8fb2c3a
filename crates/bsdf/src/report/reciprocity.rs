//! Helmholtz reciprocity: values for a pair of directions, one way and the other.

use super::{angles, on_side};
use crate::{
    basis::AngleBasis,
    bsdf::{Bsdf, Mode},
    peak::PeakRule,
    table::Table,
};
use rayon::prelude::*;
use sunpeak_core::{Vec3, luminance, warp::cosine_hemisphere};

/// Pairs of directions for the check of reciprocity.
const PAIRS: usize = 1 << 14;

/// What is compared in a check of reciprocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compared {
    /// BTDF from the front against BTDF from the back, without the peak.
    Transmission,
    /// Through transmittance from the front at `w` against that from the back at `-w`.
    Through,
    /// BRDF of the front with its directions swapped.
    ReflectionFront,
    /// BRDF of the back with its directions swapped.
    ReflectionBack,
}

/// One check of reciprocity (Helmholtz).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reciprocity {
    /// What.
    pub compared: Compared,
    /// Sum of the differences over the sum of the larger values [-], by projected solid angle: 0 to 1.
    pub mean_difference: f64,
    /// Largest difference [-] over the larger value, or over the mean of the larger values where that is more.
    pub largest_difference: f64,
    /// Where: theta from the front normal and azimuth of `w_in`, then of `w_out` [deg].
    pub largest_at_deg: [f64; 4],
    /// One table serves both directions.
    pub by_construction: bool,
}

impl Bsdf {
    pub(super) fn reciprocity(&self) -> Vec<Reciprocity> {
        let mut checks = Vec::new();
        let transmits = self.distribution(Vec3::Z, Mode::Transmission);
        if let (Some(front), Some(back)) = (transmits, self.distribution(-Vec3::Z, Mode::Transmission)) {
            let one_table = front.reversed || back.reversed;
            checks.push(self.compare(Compared::Transmission, one_table));
            checks.push(self.compare(Compared::Through, one_table));
        }
        for (front, compared) in [(true, Compared::ReflectionFront), (false, Compared::ReflectionBack)] {
            if self.distribution(on_side(front, 0.0, 0.0), Mode::Reflection).is_some() {
                checks.push(self.compare(compared, false));
            }
        }
        checks
    }

    fn compare(&self, compared: Compared, by_construction: bool) -> Reciprocity {
        let smooth = |a: Vec3, b: Vec3| luminance(self.evaluate_smooth(a, b, PeakRule::Split));
        let through = |w: Vec3| luminance(self.through(w, PeakRule::Split));
        let flip = |w: Vec3| Vec3::new(w.x, w.y, -w.z);
        let values: Vec<Compare> = self
            .pairs(compared)
            .into_par_iter()
            .map(|(a, b, weight)| {
                let [one, other] = match compared {
                    Compared::Transmission => [smooth(a, flip(b)), smooth(flip(b), a)],
                    Compared::Through => [through(a), through(-a)],
                    Compared::ReflectionFront => [smooth(a, b), smooth(b, a)],
                    Compared::ReflectionBack => [smooth(flip(a), flip(b)), smooth(flip(b), flip(a))],
                };
                Compare { a, b, weight, one, other }
            })
            .collect();
        let sum = |of: &dyn Fn(&Compare) -> f64| values.iter().fold(0.0, |s, x| s + x.weight * of(x));
        let (differences, larger) = (sum(&|x| (x.one - x.other).abs()), sum(&|x| x.one.max(x.other)));
        let mean = larger / sum(&|_| 1.0).max(f64::MIN_POSITIVE);
        let relative = |x: &Compare| {
            let scale = x.one.max(x.other).max(mean);
            if scale > 0.0 { (x.one - x.other).abs() / scale } else { 0.0 }
        };
        let largest = values.iter().max_by(|a, b| relative(a).total_cmp(&relative(b)));
        let (largest_difference, largest_at_deg) = largest.map_or((0.0, [0.0; 4]), |x| {
            let (w_in, w_out) = match compared {
                Compared::Transmission => (x.a, flip(x.b)),
                Compared::Through => (x.a, -x.a),
                Compared::ReflectionFront => (x.a, x.b),
                Compared::ReflectionBack => (flip(x.a), flip(x.b)),
            };
            let ([t, p], [u, q]) = (angles(w_in), angles(w_out));
            (relative(x), [t, p, u, q])
        });
        let mean_difference = if larger > 0.0 { differences / larger } else { 0.0 };
        Reciprocity { compared, mean_difference, largest_difference, largest_at_deg, by_construction }
    }

    /// Pairs of directions of the front with weights: the middles of all patches of a matrix, or points all over.
    fn pairs(&self, compared: Compared) -> Vec<(Vec3, Vec3, f64)> {
        let (w_in, mode) = match compared {
            Compared::Transmission | Compared::Through => (Vec3::Z, Mode::Transmission),
            Compared::ReflectionFront => (Vec3::Z, Mode::Reflection),
            Compared::ReflectionBack => (-Vec3::Z, Mode::Reflection),
        };
        match self.distribution(w_in, mode).map(|o| o.distribution.luminous()) {
            Some(Table::Matrix(m)) => {
                let middles = |basis: &AngleBasis, sign: f64| -> Vec<(Vec3, f64)> {
                    let middle = |p| {
                        let at = sign * basis.point(p, [0.5, 0.5]);
                        at.extend((1.0 - at.length_squared()).max(0.0).sqrt())
                    };
                    (0..basis.len()).map(|p| (middle(p), basis.projected_solid_angle(p))).collect()
                };
                let exits = middles(&m.exiting, 1.0);
                let all = middles(&m.incident, -1.0).into_iter();
                all.flat_map(|(a, v)| exits.iter().map(move |&(b, w)| (a, b, v * w))).collect()
            }
            _ => (0..PAIRS).map(pair).map(|[a, b]| (a, b, 1.0)).collect(),
        }
    }
}

/// Values for a pair of directions, one way and the other.
struct Compare {
    a: Vec3,
    b: Vec3,
    weight: f64,
    one: f64,
    other: f64,
}

/// The i-th pair of directions on the front, uniform in projected solid angle: an additive recurrence in four dimensions
/// (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
fn pair(i: usize) -> [Vec3; 2] {
    /// The root of x^5 = x + 1.
    const PHI_4: f64 = 1.167_303_978_261_418_7;
    let at = |d: i32| (0.5 + i as f64 / PHI_4.powi(d)).fract();
    [cosine_hemisphere([at(1), at(2)]), cosine_hemisphere([at(3), at(4)])]
}
