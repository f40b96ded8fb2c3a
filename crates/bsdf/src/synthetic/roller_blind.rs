//! Roller blinds by what a datasheet says of them, in the quantities of EN 14500.
//!
//! Away from normal incidence they follow the semi-empirical model of Kotey, Wright and Collins, "Determining off-normal solar
//! optical properties of roller blinds" (ASHRAE Transactions 115(1), 2009): what goes straight through falls to nothing at a cut-off
//! angle that the openness sets, what gets through in all falls more slowly to grazing incidence, and reflection stays.
//!
//! The model says how much is scattered, not where to. Reciprocity does, if the fabric is the same from behind and no two directions know of
//! each other: the scattered light then fades towards grazing exits as it does towards grazing incidence.

use super::{Basis, Goniophotometer, product::Product, tabulate, tabulate_exact};
use crate::{bsdf::Bsdf, work::Work};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Error, Result, Rgb, luminance, rgb_to_xyz};

/// An isotropic fabric that scatters diffusely what does not go straight through; visible, or solar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollerBlind {
    /// Normal-normal transmittance [-]: straight through at normal incidence.
    pub normal_normal: f64,
    /// Normal-hemispherical transmittance [-]: all that is let through at normal incidence.
    pub normal_hemispherical: f64,
    /// Normal-hemispherical reflectance [-] of the sides that a file calls front and back.
    pub reflectance: [f64; 2],
    /// Angle of incidence past which nothing goes straight through [deg]; none: the model's.
    pub cutoff_deg: Option<f64>,
    /// Colour of the threads: what is scattered and reflected, of any luminance; none: gray.
    pub color: Option<Rgb>,
}

impl RollerBlind {
    /// Can a fabric be like that?
    pub fn check(&self) -> Result<()> {
        let shares = [
            ("normal-normal transmittance", self.normal_normal),
            ("normal-hemispherical transmittance", self.normal_hemispherical),
            ("reflectance of the front", self.reflectance[0]),
            ("reflectance of the back", self.reflectance[1]),
        ];
        for (name, value) in shares {
            if !(0.0..=1.0).contains(&value) {
                return Err(Error::value(format!("roller blind: {name} is {value}; expected 0 to 1")));
            }
        }
        if self.normal_normal > self.normal_hemispherical {
            return Err(Error::value(format!(
                "roller blind: normal-normal transmittance {} is part of the normal-hemispherical one, {}; expected no more \
                 than that",
                self.normal_normal, self.normal_hemispherical
            )));
        }
        for (side, reflectance) in ["front", "back"].iter().zip(self.reflectance) {
            let sum = self.normal_hemispherical + reflectance;
            if sum > 1.0 {
                return Err(Error::value(format!(
                    "roller blind: normal-hemispherical transmittance and reflectance of the {side} add up to {sum}; expected \
                     no more than 1"
                )));
            }
        }
        self.check_color()?;
        match self.cutoff_deg {
            Some(deg) if !(deg > 0.0 && deg <= 90.0) => Err(Error::value(format!(
                "roller blind: cut-off at {deg} degrees; expected more than 0, up to 90"
            ))),
            _ => Ok(()),
        }
    }

    /// The brightest channel must not give back more than it gets.
    fn check_color(&self) -> Result<()> {
        let Some(color) = self.color else { return Ok(()) };
        let brightest = color.max_element() / luminance(color);
        if !(color.min_element() >= 0.0 && brightest.is_finite()) {
            return Err(Error::value(format!(
                "roller blind: colour {color}; expected three numbers of 0 or more, not all of them 0"
            )));
        }
        let scattered = self.normal_hemispherical - self.normal_normal;
        for (side, reflectance) in ["front", "back"].iter().zip(self.reflectance) {
            let sum = self.normal_normal + brightest * (scattered + reflectance);
            if sum > 1.0 {
                return Err(Error::value(format!(
                    "roller blind: in the brightest channel of its colour transmittance and reflectance of the {side} add up \
                     to {sum:.3}; expected no more than 1: a paler colour"
                )));
            }
        }
        Ok(())
    }

    /// CIE X and Z over Y of the colour.
    fn tint(&self) -> Option<[f64; 2]> {
        let xyz = rgb_to_xyz(self.color?);
        Some([xyz.x / xyz.y, xyz.z / xyz.y])
    }

    /// Cut-off angle [deg]: 65 for the tightest fabrics, and wider with the openness.
    pub fn cutoff_deg(&self) -> f64 {
        self.cutoff_deg.unwrap_or_else(|| 90.0 - 25.0 * (0.5 * PI * self.normal_normal).cos())
    }

    /// Through transmittance [-] (beam-beam) at an angle of incidence [rad].
    pub fn through(&self, theta: f64) -> f64 {
        let cutoff = self.cutoff_deg().to_radians();
        if theta >= cutoff {
            return 0.0;
        }
        let exponent = 0.6 * (0.5 * PI * self.normal_normal).cos().powf(0.3);
        let through = self.normal_normal * (0.5 * PI * theta / cutoff).cos().powf(exponent);
        // The two curves were fitted apart: a part is never more than the whole.
        through.min(self.total(theta))
    }

    /// Transmittance [-] in all (beam-total) at an angle of incidence [rad].
    pub fn total(&self, theta: f64) -> f64 {
        if self.normal_normal >= 1.0 {
            return self.normal_hemispherical;
        }
        // What the threads themselves let through.
        let threads = (self.normal_hemispherical - self.normal_normal) / (1.0 - self.normal_normal);
        let exponent =
            if threads <= 0.33 { 0.133 * (threads + 0.003).powf(-0.467) } else { 0.33 * (1.0 - threads) };
        self.normal_hemispherical * theta.cos().max(0.0).powf(exponent)
    }

    /// Tabulate by averages over cells; the delta's share of each cell is exact.
    pub fn tabulate(&self, basis: Basis) -> Result<Bsdf> {
        self.check()?;
        tabulate(&Hung::new(*self), basis, &Goniophotometer::default())
    }

    /// As [`Self::tabulate`], with the through part kept as the model has it rather than found in the table.
    ///
    /// # Errors
    /// Where the numbers contradict each other; when the work is stopped.
    pub fn tabulate_exact(&self, basis: Basis, work: &Work) -> Result<Bsdf> {
        self.check()?;
        tabulate_exact(&Hung::new(*self), basis, work)
    }

    /// Scattered transmittance [-] (beam-diffuse) at an angle of incidence [rad].
    fn scattered(&self, theta: f64) -> f64 {
        self.total(theta) - self.through(theta)
    }
}

/// Rings of equal projected solid angle over which the mean is taken.
const RINGS: u32 = 4096;

/// A roller blind with what its scattering needs.
#[derive(Debug)]
struct Hung {
    blind: RollerBlind,
    /// Mean of the scattered transmittance over the hemisphere, by projected solid angle [-].
    mean: f64,
}

impl Hung {
    fn new(blind: RollerBlind) -> Self {
        let incidence = |ring: u32| ((f64::from(ring) + 0.5) / f64::from(RINGS)).sqrt().asin();
        let sum: f64 = (0..RINGS).map(|ring| blind.scattered(incidence(ring))).sum();
        Self { blind, mean: sum / f64::from(RINGS) }
    }
}

/// Angle of incidence [rad] at a point of the disk.
fn incidence(p: DVec2) -> f64 {
    p.length().min(1.0).asin()
}

impl Product for Hung {
    fn name(&self) -> String {
        format!(
            "Sunpeak roller blind {:.2} % normal-normal, {:.2} % normal-hemispherical",
            100.0 * self.blind.normal_normal,
            100.0 * self.blind.normal_hemispherical
        )
    }

    fn through(&self, p_in: DVec2) -> f64 {
        self.blind.through(incidence(p_in))
    }

    fn smooth(&self, p_in: DVec2, p_out: DVec2) -> f64 {
        let [from, to] = [p_in, p_out].map(|p| self.blind.scattered(incidence(p)));
        from * to / (PI * self.mean.max(f64::MIN_POSITIVE))
    }

    fn reflectance(&self) -> [f64; 2] {
        self.blind.reflectance
    }

    fn tint(&self) -> Option<[f64; 2]> {
        self.blind.tint()
    }

    fn reflected_tint(&self) -> Option<[f64; 2]> {
        self.blind.tint()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{Mode, PeakRule};
    use sunpeak_core::Vec3;

    fn blind() -> RollerBlind {
        RollerBlind {
            normal_normal: 0.03,
            normal_hemispherical: 0.05,
            reflectance: [0.4, 0.35],
            cutoff_deg: None,
            color: None,
        }
    }

    /// Worked by hand from the published formulas.
    #[test]
    fn off_normal_values_are_the_models() {
        let blind = blind();
        assert!((blind.cutoff_deg() - 65.027_753).abs() < 1e-6, "{}", blind.cutoff_deg());
        let exponent = 0.6 * 2.7f64.to_radians().cos().powf(0.3);
        let at_40 = 0.03 * (90.0 * 40.0 / 65.027_753_f64).to_radians().cos().powf(exponent);
        assert!((blind.through(40f64.to_radians()) - at_40).abs() < 1e-9);
        assert_eq!(blind.through(65.1f64.to_radians()), 0.0);
        let threads: f64 = 0.02 / 0.97;
        let total = 0.05 * 60f64.to_radians().cos().powf(0.133 * (threads + 0.003).powf(-0.467));
        assert!((blind.total(60f64.to_radians()) - total).abs() < 1e-12);
    }

    #[test]
    fn a_table_has_the_datasheets_values() {
        let blind = blind();
        let bsdf = blind.tabulate("t3-4096".parse().unwrap()).unwrap();
        // In the middles of columns.
        for ring in [0.5f64, 10.5, 20.5, 26.5] {
            let theta = (ring / 32.0).asin();
            let w_in = Vec3::new(theta.sin(), 0.0, theta.cos());
            let through = luminance(bsdf.through(w_in, PeakRule::Split));
            let error = (through - blind.through(theta)).abs();
            // Between columns T is a straight line, which bends most next to the cut-off.
            assert!(error < 3e-3 * blind.normal_normal, "{ring}: {through}");
            let whole = luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Off));
            assert!((whole / blind.total(theta) - 1.0).abs() < 5e-3, "{ring}: {whole}");
        }
        // A BSDF's front is what the file calls back.
        for (w_in, reflectance) in [(Vec3::Z, 0.35), (-Vec3::Z, 0.4)] {
            let got = luminance(bsdf.hemispherical_smooth(w_in, Mode::Reflection, PeakRule::Off));
            assert!((got - reflectance).abs() < 1e-6, "{got}");
        }
    }

    /// In the middle of a column the interpolant is as good as its bend; no peak has to be found, however weak.
    #[test]
    fn the_exact_peak_is_the_models_in_any_basis() {
        let weak = RollerBlind { normal_normal: 0.0004, ..blind() };
        for (basis, tolerance) in [("klems-quarter", 0.06), ("t3-1024", 0.01)] {
            let basis: Basis = basis.parse().unwrap();
            for blind in [blind(), weak] {
                let (exact, found) =
                    (blind.tabulate_exact(basis, &Work::default()).unwrap(), blind.tabulate(basis).unwrap());
                for deg in [12.0f64, 30.0, 45.0] {
                    let w_in = Vec3::new(deg.to_radians().sin(), 0.0, deg.to_radians().cos());
                    let through = luminance(exact.through(w_in, PeakRule::Split));
                    let error = through / blind.through(deg.to_radians()) - 1.0;
                    assert!(error.abs() < tolerance, "{basis:?} {deg}: {error}");
                    let whole = |bsdf: &Bsdf| {
                        luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Off))
                    };
                    assert!((whole(&exact) / whole(&found) - 1.0).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn contradictions_are_refused() {
        let refused = |blind: RollerBlind| blind.check().unwrap_err().to_string();
        assert!(refused(RollerBlind { normal_normal: 0.06, ..blind() }).contains("part of"));
        assert!(
            refused(RollerBlind { reflectance: [0.4, 0.96], ..blind() }).contains("of the back add up to")
        );
        assert!(refused(RollerBlind { normal_hemispherical: 5.0, ..blind() }).contains("expected 0 to 1"));
        assert!(refused(RollerBlind { cutoff_deg: Some(95.0), ..blind() }).contains("cut-off"));
        let color = Some(Rgb::new(0.9, 0.1, 0.0));
        assert!(refused(RollerBlind { color, ..blind() }).contains("a paler colour"));
        assert!(refused(RollerBlind { color: Some(Rgb::ZERO), ..blind() }).contains("not all of them 0"));
    }

    /// Holes have no colour: what goes straight is gray, all else has the threads' ratios of red to green to blue.
    #[test]
    fn the_colour_is_that_of_the_threads() {
        let color = Rgb::new(0.5, 0.4, 0.2);
        let blind = RollerBlind { color: Some(color), ..blind() };
        for basis in ["klems-quarter", "t3-1024"] {
            let bsdf = blind.tabulate_exact(basis.parse().unwrap(), &Work::default()).unwrap();
            let of_threads = color / luminance(color);
            let through = bsdf.through(Vec3::Z, PeakRule::Split);
            assert!((through / luminance(through)).abs_diff_eq(Rgb::ONE, 1e-6));
            for (mode, rule) in [(Mode::Reflection, PeakRule::Off), (Mode::Transmission, PeakRule::Split)] {
                let scattered = bsdf.hemispherical_smooth(Vec3::Z, mode, rule);
                assert!(
                    (scattered / luminance(scattered)).abs_diff_eq(of_threads, 2e-3),
                    "{basis} {mode:?} {scattered}"
                );
            }
        }
    }
}
