//! Panes by their spectra at normal incidence, and what they do at other angles.
//!
//! Uncoated panes follow Fresnel's equations: index and absorption are those that give the measured transmittance and reflectance
//! (Finlayson, Arasteh, Huizenga, Rubin, Reilly, "WINDOW 4.0: documentation of calculation procedures", LBL-33943, 1993). What a
//! coating does depends on its films, which nobody tells; LBL-33943 has regressions of clear and of bronze glass in their
//! place, and WINDOW and EnergyPlus (Engineering Reference, "Angular properties for coated glass") use them.

use super::optics::Optics;
use sunpeak_core::{Error, Result};

/// Whose angular curve stands for a pane's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curve {
    /// Fresnel's equations: no coating.
    #[default]
    Fresnel,
    /// A coating: at each wavelength the regression of clear glass if more than 64.5 % is transmitted, else that of bronze glass.
    Coated,
    /// A coating, by the regression of clear glass.
    Clear,
    /// A coating, by the regression of bronze glass.
    Bronze,
}

/// A pane at normal incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Pane {
    /// Wavelengths [um], ascending.
    pub wavelengths_um: Vec<f64>,
    /// Normal transmittance [-].
    pub transmittance: Vec<f64>,
    /// Normal reflectance [-] from outside and from inside.
    pub reflectance: [Vec<f64>; 2],
    /// Its angular curve.
    pub curve: Curve,
}

/// Transmittance above which a coated pane is like clear glass (LBL-33943; EnergyPlus Engineering Reference).
const CLEAR_FROM: f64 = 0.645;

/// Coefficients of cos^0 … cos^4: transmittance over that at normal incidence, and the sum of it and the reflectance curve
/// (LBL-33943; EnergyPlus Engineering Reference, "Angular properties for coated glass").
const CLEAR: [[f64; 5]; 2] = [[-0.0015, 3.355, -3.840, 1.460, 0.0288], [0.999, -0.563, 2.043, -2.532, 1.054]];
const BRONZE: [[f64; 5]; 2] =
    [[-0.002, 2.813, -2.341, -0.05725, 0.599], [0.997, -1.868, 6.513, -7.862, 3.225]];

/// Cosines from here on are normal incidence: there a pane is as measured, which the regressions miss by up to 1 %.
const NORMAL: f64 = 1.0 - 1e-9;

/// Reflectance below which no index can be derived.
const LEAST_REFLECTANCE: f64 = 1e-9;

impl Pane {
    /// Can a pane be like that?
    pub fn check(&self) -> Result<()> {
        let n = self.wavelengths_um.len();
        if n == 0 {
            return Err(Error::value("pane: no wavelengths; expected at least one"));
        }
        let bounds = f64::MIN_POSITIVE..f64::INFINITY;
        let ascending = self.wavelengths_um.windows(2).all(|w| w[0] < w[1]);
        if !ascending || !self.wavelengths_um.iter().all(|um| bounds.contains(um)) {
            return Err(Error::value("pane: wavelengths; expected them positive and ascending, in um"));
        }
        let lists = [
            ("transmittance", &self.transmittance),
            ("front reflectance", &self.reflectance[0]),
            ("back reflectance", &self.reflectance[1]),
        ];
        for (name, values) in lists {
            if values.len() != n {
                return Err(Error::value(format!(
                    "pane: {} of {name}; expected {n}, one a wavelength",
                    values.len()
                )));
            }
            if let Some(at) = values.iter().position(|v| !(0.0..=1.0).contains(v)) {
                let (um, value) = (self.wavelengths_um[at], values[at]);
                return Err(Error::value(format!("pane: {name} at {um} um is {value}; expected 0 to 1")));
            }
        }
        for side in 0..2 {
            let sums = self.transmittance.iter().zip(&self.reflectance[side]).map(|(t, r)| t + r);
            if let Some(at) = sums.clone().position(|sum| sum > 1.0 + 1e-6) {
                let um = self.wavelengths_um[at];
                return Err(Error::value(format!(
                    "pane: transmittance and reflectance at {um} um add up to more than 1; expected no more"
                )));
            }
        }
        Ok(())
    }

    /// The other side out.
    pub fn flipped(mut self) -> Self {
        self.reflectance.swap(0, 1);
        self
    }

    /// Transmittance, front and back reflectance [-] at normal incidence; the ends go on past the measured range.
    pub fn normal(&self, wavelength_um: f64) -> [f64; 3] {
        let at = self.wavelengths_um.partition_point(|&w| w <= wavelength_um);
        let last = self.wavelengths_um.len() - 1;
        let (i, j) = (at.saturating_sub(1), at.min(last));
        let (a, b) = (self.wavelengths_um[i], self.wavelengths_um[j]);
        let share = if b > a { ((wavelength_um - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        [&self.transmittance, &self.reflectance[0], &self.reflectance[1]]
            .map(|values| values[i] + share * (values[j] - values[i]))
    }

    /// Its optics at a wavelength [um] and a cosine of the angle of incidence.
    pub fn optics(&self, wavelength_um: f64, cosine: f64) -> Optics {
        let [t, front, back] = self.normal(wavelength_um);
        let each = [front, back].map(|r| self.side(t, r, cosine));
        // Both ways the same is let through (reciprocity): what follows from the front.
        Optics { t: [each[0][0]; 2], r: each.map(|s| s[1]) }
    }

    fn side(&self, t: f64, r: f64, cosine: f64) -> [f64; 2] {
        if cosine > NORMAL {
            return [t, r];
        }
        match self.curve {
            Curve::Fresnel => fresnel(t, r, cosine),
            Curve::Clear => regression(&CLEAR, t, r, cosine),
            Curve::Bronze => regression(&BRONZE, t, r, cosine),
            Curve::Coated => regression(if t > CLEAR_FROM { &CLEAR } else { &BRONZE }, t, r, cosine),
        }
    }
}

/// Transmittance and reflectance at an angle by what they are at the normal (LBL-33943).
fn fresnel(t: f64, r: f64, cosine: f64) -> [f64; 2] {
    // Reflectance of one face, from T and R of both with all rounds between them.
    let beta = t * t - r * r + 2.0 * r + 1.0;
    let face = (beta - (beta * beta - 4.0 * (2.0 - r) * r).max(0.0).sqrt()) / (2.0 * (2.0 - r));
    if face < LEAST_REFLECTANCE {
        return [t, r];
    }
    let index = (1.0 + face.sqrt()) / (1.0 - face.sqrt());
    // What one pass through the material leaves.
    let pass = if t > 0.0 { ((r - face) / (face * t)).clamp(0.0, 1.0) } else { 0.0 };
    slab(index, pass, cosine)
}

/// A slab of an index with what one perpendicular pass leaves: both polarisations, all orders (Born and Wolf, Principles of
/// Optics, 1.5.2 and 14.3).
pub fn slab(index: f64, pass: f64, cosine: f64) -> [f64; 2] {
    let inside = (1.0 - (1.0 - cosine * cosine) / (index * index)).max(0.0).sqrt();
    let left = if pass > 0.0 { pass.powf(1.0 / inside.max(f64::MIN_POSITIVE)) } else { 0.0 };
    let amplitudes = [
        (cosine - index * inside) / (cosine + index * inside),
        (index * cosine - inside) / (index * cosine + inside),
    ];
    let mut both = [0.0; 2];
    for amplitude in amplitudes {
        let face = amplitude * amplitude;
        let t = (1.0 - face).powi(2) * left / (1.0 - (face * left).powi(2)).max(f64::MIN_POSITIVE);
        both[0] += 0.5 * t;
        both[1] += 0.5 * face * (1.0 + left * t);
    }
    both
}

fn regression(coefficients: &[[f64; 5]; 2], t: f64, r: f64, cosine: f64) -> [f64; 2] {
    let [tau, sum] = coefficients.map(|c| c.iter().rev().fold(0.0, |s, k| s * cosine + k));
    let rho = sum - tau;
    let t = (t * tau).clamp(0.0, 1.0);
    // A regression is not energy: the two never make more than there is.
    [t, (r * (1.0 - rho) + rho).clamp(0.0, 1.0 - t)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_uncoated_pane_is_a_slab_of_its_own_index() {
        let (index, pass) = (1.526, 0.93);
        let [t, r] = slab(index, pass, 1.0);
        let pane = Pane {
            wavelengths_um: vec![0.5],
            transmittance: vec![t],
            reflectance: [vec![r], vec![r]],
            curve: Curve::Fresnel,
        };
        pane.check().unwrap();
        for deg in [0.0f64, 20.0, 45.0, 60.0, 75.0, 85.0] {
            let cosine = deg.to_radians().cos();
            let (got, want) = (pane.optics(0.5, cosine), slab(index, pass, cosine));
            assert!((got.t[0] - want[0]).abs() < 1e-12 && (got.r[1] - want[1]).abs() < 1e-12, "{deg}");
        }
    }

    /// By hand from the published coefficients: cos 60 = 1/2.
    #[test]
    fn coatings_follow_the_published_regressions() {
        let pane = |t: f64, curve| Pane {
            wavelengths_um: vec![0.5],
            transmittance: vec![t],
            reflectance: [vec![0.1], vec![0.2]],
            curve,
        };
        let clear = -0.0015 + 3.355 / 2.0 - 3.84 / 4.0 + 1.46 / 8.0 + 0.0288 / 16.0;
        let bronze = -0.002 + 2.813 / 2.0 - 2.341 / 4.0 - 0.05725 / 8.0 + 0.599 / 16.0;
        assert!((pane(0.7, Curve::Coated).optics(0.5, 0.5).t[0] - 0.7 * clear).abs() < 1e-12);
        assert!((pane(0.6, Curve::Coated).optics(0.5, 0.5).t[1] - 0.6 * bronze).abs() < 1e-12);
        assert!((pane(0.7, Curve::Bronze).optics(0.5, 0.5).t[0] - 0.7 * bronze).abs() < 1e-12);
        assert_eq!(pane(0.7, Curve::Coated).optics(0.5, 1.0).t[0], 0.7);
    }

    #[test]
    fn what_no_pane_can_be_is_refused() {
        let pane = Pane {
            wavelengths_um: vec![0.5, 0.4],
            transmittance: vec![0.5; 2],
            reflectance: [vec![0.1; 2], vec![0.6; 2]],
            curve: Curve::Fresnel,
        };
        assert!(pane.check().unwrap_err().to_string().contains("ascending"));
        let pane = Pane { wavelengths_um: vec![0.4, 0.5], ..pane };
        assert!(pane.check().unwrap_err().to_string().contains("add up to more than 1"));
    }
}
