//! Fabrics: analytic through transmittance with a cut-off, and a scattered part.

use super::{Basis, Goniophotometer, product::Product, tabulate};
use crate::bsdf::Bsdf;
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Error, Result, warp::square_to_disk};

/// An isotropic fabric: a delta straight through, a diffuse part and a lobe around the straight direction; both sides alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fabric {
    /// Through transmittance at normal incidence [-]: the openness factor.
    pub openness: f64,
    /// Angle of incidence past which nothing goes straight through [deg].
    pub cutoff_deg: f64,
    /// Steepness p of `T(theta) = openness cos(90 deg theta / cutoff)^p`.
    pub exponent: f64,
    /// Scattered transmittance [-], the same for every incidence.
    pub scattered: f64,
    /// Share of the scattered part in the lobe; the rest is diffuse.
    pub lobe_share: f64,
    /// Standard deviation of the Gaussian lobe on the disk of projected directions.
    pub lobe_sigma: f64,
    /// Diffuse reflectance [-].
    pub reflectance: f64,
}

impl Default for Fabric {
    /// A 2 % fabric with a cut-off at 68 degrees.
    fn default() -> Self {
        Self {
            openness: 0.02,
            cutoff_deg: 68.0,
            exponent: 0.6,
            scattered: 0.06,
            lobe_share: 0.4,
            lobe_sigma: 0.25,
            reflectance: 0.35,
        }
    }
}

impl Fabric {
    /// Is every number in its domain, and is no more light scattered than comes in?
    pub fn check(&self) -> Result<()> {
        let unit = |name: &str, value: f64| {
            (0.0..=1.0).contains(&value).then_some(()).ok_or_else(|| {
                Error::value(format!("fabric: {name} is {value}; expected a number from 0 to 1"))
            })
        };
        unit("openness", self.openness)?;
        unit("scattered", self.scattered)?;
        unit("lobe_share", self.lobe_share)?;
        unit("reflectance", self.reflectance)?;
        let sum = self.openness + self.scattered + self.reflectance;
        if sum > 1.0 {
            return Err(Error::value(format!(
                "fabric: openness, scattered and reflectance add up to {sum}; expected no more than 1"
            )));
        }
        if !(self.cutoff_deg > 0.0 && self.cutoff_deg <= 90.0) {
            return Err(Error::value(format!("fabric: cutoff_deg is {}; expected 0 to 90", self.cutoff_deg)));
        }
        if !(self.exponent > 0.0
            && self.exponent.is_finite()
            && self.lobe_sigma > 0.0
            && self.lobe_sigma.is_finite())
        {
            return Err(Error::value("fabric: exponent and lobe_sigma must be positive"));
        }
        Ok(())
    }

    /// Through transmittance [-] at an angle of incidence [rad].
    pub fn through(&self, theta: f64) -> f64 {
        let cutoff = self.cutoff_deg.to_radians();
        if theta >= cutoff {
            0.0
        } else {
            self.openness * (0.5 * PI * theta / cutoff).cos().powf(self.exponent)
        }
    }

    /// Tabulate by averages over cells; the delta's share of each cell is exact.
    pub fn tabulate(&self, basis: Basis) -> Result<Bsdf> {
        self.check()?;
        tabulate(&Woven::new(*self), basis, &Goniophotometer::default())
    }
}

/// Steps of the radius at which the lobe's integral is known.
const NORMS: usize = 256;

/// A fabric with what its lobe needs.
#[derive(Clone, Debug)]
pub struct Woven {
    fabric: Fabric,
    /// One over the lobe's integral over the disk, by the radius of incidence.
    norms: Vec<f64>,
}

impl Woven {
    /// Take the lobe's integrals, once.
    pub fn new(fabric: Fabric) -> Self {
        let norms = (0..=NORMS).map(|i| lobe_norm(fabric.lobe_sigma, i as f64 / NORMS as f64)).collect();
        Self { fabric, norms }
    }

    /// Its numbers.
    pub fn fabric(&self) -> &Fabric {
        &self.fabric
    }

    fn norm(&self, r: f64) -> f64 {
        let at = r.min(1.0) * NORMS as f64;
        let i = (at as usize).min(NORMS - 1);
        self.norms[i] + (at - i as f64) * (self.norms[i + 1] - self.norms[i])
    }
}

impl Product for Woven {
    fn name(&self) -> String {
        format!("Sunpeak fabric {:.3} % open", 100.0 * self.fabric.openness)
    }

    fn through(&self, p_in: DVec2) -> f64 {
        self.fabric.through(p_in.length().min(1.0).asin())
    }

    /// Diffuse, and the lobe normalised to its share over the disk.
    fn smooth(&self, p_in: DVec2, p_out: DVec2) -> f64 {
        let Fabric { scattered, lobe_share, lobe_sigma, .. } = self.fabric;
        let lobe = (-0.5 * (p_out - p_in).length_squared() / lobe_sigma.powi(2)).exp();
        scattered * ((1.0 - lobe_share) / PI + lobe_share * lobe * self.norm(p_in.length()))
    }

    fn reflectance(&self) -> [f64; 2] {
        [self.fabric.reflectance; 2]
    }
}

/// One over the lobe's integral over the disk, for incidence at radius `r`: by summing over a fine grid.
fn lobe_norm(sigma: f64, r: f64) -> f64 {
    let n = 200;
    let mut sum = 0.0;
    for i in 0..n * n {
        let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
        let p: DVec2 = square_to_disk(u).into();
        sum += (-0.5 * (p - DVec2::new(r, 0.0)).length_squared() / sigma.powi(2)).exp();
    }
    (n * n) as f64 / (PI * sum)
}
