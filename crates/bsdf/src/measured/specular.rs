//! What goes straight through, or is mirrored, told from what is scattered by the instrument's own width. In a table's points both are
//! where the light comes in.
//!
//! An instrument sees a delta of transmittance T as T times its signature, a Gaussian of constant angular width, in BSDF times cosine. A
//! scatterer's lobe is wider. Around the straight direction the readings are fitted by the signature, one wider lobe and a constant, and
//! by two wider lobes and a constant: a peak is there if the first leaves less than half of what the second leaves.

use super::scan::{Incidence, Reading, Scan};
use crate::{
    kernel::HALF_WIDTH,
    peak::{
        FWHM_RANGE_DEG,
        nonnegative::{Fit, least_squares},
    },
};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use sunpeak_core::{Error, Result};

/// Readings within so many widths (full width at half maximum) of the straight direction are looked at.
const REGION: f64 = 8.0;

/// So many of them have to lie within one width.
const LEAST_READINGS: usize = 6;

/// A peak is there if it leaves less than this share of the misfit that lobes alone leave.
const BETTER: f64 = 0.5;

/// Misfits below this share of the squared readings tell nothing.
const EXACT: f64 = 1e-9;

/// What is wider than the signature by less than this is taken for it: instruments are known to a few percent.
const WIDER: f64 = 1.3;

/// Factor from one width that is tried to the next.
const STEP: f64 = 1.2;

/// Steps in which the signature's own width is looked for, to either side of what is stated.
const OWN_STEPS: i32 = 6;
const OWN_STEP: f64 = 0.02;

/// The signature is taken out of the readings as far as it stands above this share of its middle.
const CORE: f64 = 2e-3;

/// What was found at one incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Straight {
    /// A peak of this transmittance [-].
    Peak(f64),
    /// No lobe as narrow as the instrument.
    None,
    /// Too few readings near the straight direction: so many within one width.
    TooFew(usize),
}

impl Straight {
    /// Transmittance [-].
    pub fn through(self) -> f64 {
        if let Self::Peak(through) = self { through } else { 0.0 }
    }
}

/// Readings around a direction: angle from it [rad], BSDF times cosine [1/sr].
struct Around {
    angles: Vec<f64>,
    values: Vec<f64>,
}

fn lifted(q: DVec2) -> DVec3 {
    q.extend((1.0 - q.length_squared()).max(0.0).sqrt())
}

/// Gaussian of unit flux [1/sr].
fn gaussian(angle: f64, sigma: f64) -> f64 {
    (-0.5 * (angle / sigma).powi(2)).exp() / (2.0 * PI * sigma * sigma)
}

impl Around {
    fn lobe(&self, sigma: f64) -> Vec<f64> {
        self.angles.iter().map(|&a| gaussian(a, sigma)).collect()
    }

    fn ones(&self) -> Vec<f64> {
        vec![1.0; self.values.len()]
    }

    /// The best fit by a first lobe, one of wider ones and a constant, with the width of the second.
    fn fit(&self, first: f64, wider: &[f64]) -> (Fit, f64) {
        let (lobe, ones) = (self.lobe(first), self.ones());
        let fits = wider.iter().map(|&w| (least_squares([&lobe, &self.lobe(w), &ones], &self.values), w));
        let best = fits.min_by(|a, b| a.0.misfit.total_cmp(&b.0.misfit));
        best.unwrap_or_else(|| (least_squares([&lobe, &ones, &ones], &self.values), first))
    }
}

fn ladder(low: f64, high: f64) -> Vec<f64> {
    std::iter::successors(Some(low), |w| Some(w * STEP)).take_while(|&w| w <= high).collect()
}

/// Take the peak of an instrument's width out of the readings of an incidence.
pub fn separate(incidence: &mut Incidence, fwhm_deg: f64) -> Straight {
    let (fwhm, axis) = (fwhm_deg.to_radians(), lifted(incidence.p));
    let angle = |q: DVec2| axis.angle_between(lifted(q));
    let near: Vec<(f64, f64)> = incidence
        .points
        .iter()
        .map(|&(q, f)| (angle(q), f * lifted(q).z))
        .filter(|(angle, _)| *angle < REGION * fwhm)
        .collect();
    let inside = near.iter().filter(|(angle, _)| *angle < fwhm).count();
    if inside < LEAST_READINGS {
        return Straight::TooFew(inside);
    }
    let (angles, values) = near.into_iter().unzip();
    let around = Around { angles, values };
    let sigma = fwhm / HALF_WIDTH;
    let Some((own, fit, width)) = peak(&around, sigma) else { return Straight::None };
    let [through, lobe, constant] = fit.coefficients;
    for (q, value) in &mut incidence.points {
        let (angle, cosine) = (angle(*q), lifted(*q).z);
        if gaussian(angle, own) > CORE * gaussian(0.0, own) {
            *value = (lobe * gaussian(angle, width) + constant) / cosine;
        }
    }
    Straight::Peak(through)
}

/// The signature's width [rad], the fit, and the width of the lobe under it; none if lobes alone do as well.
fn peak(around: &Around, sigma: f64) -> Option<(f64, Fit, f64)> {
    let widest = REGION * HALF_WIDTH * sigma;
    let wide = ladder(WIDER * sigma, widest);
    let own = (-OWN_STEPS..=OWN_STEPS).map(|k| sigma * (1.0 + OWN_STEP * f64::from(k)));
    let with = own.map(|own| {
        let (fit, width) = around.fit(own, &wide[1..]);
        (own, fit, width)
    });
    let with = with.min_by(|a, b| a.1.misfit.total_cmp(&b.1.misfit))?;
    let without = wide.iter().enumerate().map(|(k, &first)| around.fit(first, &wide[k..]).0.misfit);
    let without = without.fold(f64::INFINITY, f64::min);
    let squares: f64 = around.values.iter().map(|v| v * v).sum();
    let better = with.1.misfit < BETTER * without && without > EXACT * squares;
    (better && with.1.coefficients[0] > 0.0).then_some(with)
}

/// Full width at half maximum [deg] of what the instrument makes of its bare beam: a scan without a sample.
pub fn beam_fwhm_deg(scan: &Scan) -> Result<f64> {
    let axis = -scan.to_light;
    let wrong = |message: String| Error::input(scan.place.clone(), message);
    let brightest = |a: &&Reading, b: &&Reading| signal(a).total_cmp(&signal(b));
    let top =
        scan.readings.iter().max_by(brightest).ok_or_else(|| wrong("a beam without readings".into()))?;
    let off_deg = axis.angle_between(top.exit).to_degrees();
    let region = scan.readings.iter().filter(|r| axis.angle_between(r.exit).to_degrees() < FWHM_RANGE_DEG[1]);
    let (angles, values) = region.map(|r| (axis.angle_between(r.exit), signal(r))).unzip();
    let around = Around { angles, values };
    let [low, high] = FWHM_RANGE_DEG.map(|deg| deg.to_radians() / HALF_WIDTH);
    let misfit = |sigma: f64| {
        least_squares([&around.lobe(sigma), &around.ones(), &around.ones()], &around.values).misfit
    };
    let finest = |low: f64, high: f64, step: f64| {
        let widths = std::iter::successors(Some(low), |w| Some(w * step)).take_while(|&w| w <= high);
        widths.min_by(|&a, &b| misfit(a).total_cmp(&misfit(b))).unwrap_or(low)
    };
    let rough = finest(low, high, STEP);
    let sigma = finest(rough / STEP, rough * STEP, 1.003);
    let fwhm_deg = sigma.to_degrees() * HALF_WIDTH;
    let inside = around.angles.iter().filter(|a| a.to_degrees() < fwhm_deg).count();
    if inside < LEAST_READINGS || off_deg > fwhm_deg {
        return Err(wrong(format!(
            "no beam: {inside} readings within {fwhm_deg:.2} degrees of the straight direction, the brightest {off_deg:.2} degrees off; \
             expected {LEAST_READINGS} or more around a beam that passes no sample"
        )));
    }
    Ok(fwhm_deg)
}

/// BSDF times cosine [1/sr].
fn signal(reading: &Reading) -> f64 {
    reading.value * reading.exit.z.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FWHM_DEG: f64 = 1.5;

    /// Readings on rings around the straight direction and over the hemisphere: BSDF times cosine by angle.
    fn seen(theta_deg: f64, signal: impl Fn(f64) -> f64) -> Incidence {
        let p = DVec2::new(theta_deg.to_radians().sin(), 0.0);
        let axis = lifted(p);
        let right = DVec3::Y;
        let up = axis.cross(right);
        let mut points = Vec::new();
        for k in 0..60 {
            let angle = (0.15 * f64::from(k) * FWHM_DEG).to_radians();
            for j in 0..36 {
                let turn = f64::from(j) * PI / 18.0;
                let w = axis * angle.cos() + (right * turn.cos() + up * turn.sin()) * angle.sin();
                if w.z > 0.01 {
                    points.push((w.truncate(), signal(angle) / w.z));
                }
            }
        }
        Incidence { p, points }
    }

    fn sigma(fwhm_deg: f64) -> f64 {
        fwhm_deg.to_radians() / HALF_WIDTH
    }

    #[test]
    fn a_delta_comes_back_from_under_a_lobe_as_wide_as_a_few_signatures() {
        for theta in [0.0, 40.0, 65.0] {
            for wide in [4.0, 12.0] {
                let truth =
                    |a: f64| 0.02 * gaussian(a, sigma(FWHM_DEG)) + 0.05 * gaussian(a, sigma(wide)) + 0.01;
                let mut seen = seen(theta, truth);
                let Straight::Peak(through) = separate(&mut seen, FWHM_DEG) else {
                    panic!("no peak {theta} {wide}")
                };
                assert!((through / 0.02 - 1.0).abs() < 0.02, "{theta} {wide}: {through}");
                let left = seen.points.iter().map(|(q, f)| f * lifted(*q).z).fold(0.0, f64::max);
                let smooth = 0.05 * gaussian(0.0, sigma(wide)) + 0.01;
                assert!((left / smooth - 1.0).abs() < 0.1, "{theta} {wide}: {left} {smooth}");
            }
        }
    }

    #[test]
    fn a_scatterer_wider_than_the_instrument_is_no_peak() {
        for wide in [2.2, 3.0, 6.0] {
            let mut seen = seen(30.0, |a| 0.1 * gaussian(a, sigma(wide)) + 0.01);
            assert_eq!(separate(&mut seen, FWHM_DEG), Straight::None, "{wide}");
        }
        let mut few = seen(30.0, |_| 0.01);
        few.points.retain(|(q, _)| q.distance(few.p) > 0.05);
        assert_eq!(separate(&mut few, FWHM_DEG), Straight::TooFew(0));
    }

    #[test]
    fn a_bare_beam_tells_the_width() {
        let seen = seen(0.0, |a| 7.0 * gaussian(a, sigma(0.9)));
        let readings = seen.points.iter().map(|&(q, value)| Reading { exit: -lifted(q), value });
        let mut scan = Scan::new("beam".into(), 1, DVec3::Z);
        scan.readings = readings.collect();
        assert!((beam_fwhm_deg(&scan).unwrap() / 0.9 - 1.0).abs() < 0.005);
        scan.readings.iter_mut().for_each(|r| r.exit.z = -r.exit.z);
        assert!(beam_fwhm_deg(&scan).unwrap_err().to_string().contains("no beam"));
    }
}
