//! Spectra in three channels.
//!
//! By the CIE 1931 observer, to XYZ and from there to Radiance's primaries, as Radiance does it where it renders in three channels.
//! A spectrum of 1 from 380 to 780 nm is white, (1, 1, 1). The observer is the multi-lobe fit of Wyman, Sloan and Shirley 2013, "Simple
//! Analytic Approximations to the CIE XYZ Color Matching Functions": within 1 % for smooth spectra.

use std::ops::Range;
use sunpeak_core::{Rgb, Vec3, xyz_to_rgb};

/// Wavelengths that are seen [nm]; a spectrum is nothing outside of what it gives.
const VISIBLE_NM: Range<f64> = 380.0..780.0;

/// Step of the integrals over the observer [nm].
const STEP_NM: f64 = 1.0;

/// Weights of a spectrum's samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    wavelengths_nm: Vec<f64>,
    /// XYZ of 1 in each sample.
    weights: Vec<Vec3>,
}

/// A Gaussian of two widths.
fn lobe(nm: f64, center: f64, below: f64, above: f64) -> f64 {
    let width = if nm < center { below } else { above };
    (-0.5 * ((nm - center) / width).powi(2)).exp()
}

fn observer(nm: f64) -> Vec3 {
    Vec3::new(
        1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7)
            - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
        0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
        1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8),
    )
}

/// Integral of the observer over the visible part of a range.
fn integral(nm: Range<f64>) -> Vec3 {
    let (start, end) = (nm.start.max(VISIBLE_NM.start), nm.end.min(VISIBLE_NM.end));
    if start >= end {
        return Vec3::ZERO;
    }
    let count = ((end - start) / STEP_NM).ceil();
    let step = (end - start) / count;
    (0..count as usize).map(|i| observer(start + (i as f64 + 0.5) * step) * step).sum()
}

impl Spectrum {
    /// `count` samples, evenly from `first` to `last` [nm], in this order; each stands for the wavelengths nearest to it.
    pub fn of_samples(first: f64, last: f64, count: usize) -> Self {
        let step = (last - first) / (count.max(2) - 1) as f64;
        Self::of_intervals(first - 0.5 * step, last + 0.5 * step, count)
    }

    /// `count` even intervals from `begin` to `end` [nm].
    pub fn of_intervals(begin: f64, end: f64, count: usize) -> Self {
        let whole = integral(VISIBLE_NM);
        let step = (end - begin) / count as f64;
        let wavelengths_nm = (0..count).map(|i| begin + step * (i as f64 + 0.5)).collect();
        let weight = |i: usize| {
            let (a, b) = (begin + step * i as f64, begin + step * (i + 1) as f64);
            integral(a.min(b)..a.max(b)) / whole
        };
        Self { wavelengths_nm, weights: (0..count).map(weight).collect() }
    }

    /// Wavelengths of the samples [nm].
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// The colour of a spectrum. One outside of what the primaries can show is mixed with so much grey of the same luminance that no
    /// channel is negative, as in Radiance.
    pub fn color(&self, samples: impl IntoIterator<Item = f64>) -> Rgb {
        let xyz: Vec3 = self.weights.iter().zip(samples).map(|(weight, sample)| *weight * sample).sum();
        let (color, grey) = (xyz_to_rgb(xyz), Rgb::splat(xyz.y.max(0.0)));
        let lowest = color.min_element();
        if lowest >= 0.0 {
            return color;
        }
        let share = grey.x / (grey.x - lowest);
        (grey + (color - grey) * share).max(Rgb::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white_whatever_the_samples() {
        for spectrum in [Spectrum::of_samples(380.0, 780.0, 41), Spectrum::of_intervals(780.0, 380.0, 7)] {
            let count = spectrum.wavelengths_nm().len();
            assert!((spectrum.color(vec![1.0; count]) - Rgb::ONE).length() < 2e-3);
        }
    }

    #[test]
    fn the_fit_is_the_observer() {
        // CIE 1931: 1.0000 at 555 nm; 1.0622 and 0.6310 at 600 nm; 1.7721 at 445 nm (CIE 15, table 1).
        assert!((observer(555.0).y - 1.0).abs() < 0.01);
        assert!((observer(600.0).x - 1.0622).abs() < 0.02 && (observer(600.0).y - 0.6310).abs() < 0.01);
        assert!((observer(445.0).z - 1.7826).abs() < 0.03);
    }
}
