//! Fabrics of our own making.

use crate::bsdf::PyBsdf;
use crate::error::OrRaise;
use pyo3::prelude::*;
use std::sync::Arc;
use sunpeak_bsdf::synthetic::{Basis, Fabric, RollerBlind};

/// Tabulate a fabric from its formulas: `basis` is `klems`, `klems-half`, `klems-quarter`, `t3-N` or `t4-N`.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn fabric_xml(
    py: Python<'_>,
    basis: &str,
    openness: f64,
    cutoff_deg: f64,
    exponent: f64,
    scattered: f64,
    lobe_share: f64,
    lobe_sigma: f64,
    reflectance: f64,
) -> PyResult<String> {
    let fabric = Fabric { openness, cutoff_deg, exponent, scattered, lobe_share, lobe_sigma, reflectance };
    let basis: Basis = basis.parse().or_raise()?;
    py.detach(|| Ok(fabric.tabulate(basis)?.to_xml())).or_raise()
}

fn of_datasheet(
    tau_nn: f64,
    tau_nh: f64,
    rho_front: f64,
    rho_back: f64,
    cutoff_deg: Option<f64>,
) -> PyResult<RollerBlind> {
    let blind = RollerBlind {
        normal_normal: tau_nn,
        normal_hemispherical: tau_nh,
        reflectance: [rho_front, rho_back],
        cutoff_deg,
    };
    blind.check().or_raise()?;
    Ok(blind)
}

/// Tabulate a roller blind from its datasheet; its through part is kept as the model has it.
#[pyfunction]
pub fn roller_blind(
    py: Python<'_>,
    basis: &str,
    tau_nn: f64,
    tau_nh: f64,
    rho_front: f64,
    rho_back: f64,
    cutoff_deg: Option<f64>,
) -> PyResult<PyBsdf> {
    let blind = of_datasheet(tau_nn, tau_nh, rho_front, rho_back, cutoff_deg)?;
    let basis: Basis = basis.parse().or_raise()?;
    let bsdf = py.detach(|| blind.tabulate_exact(basis)).or_raise()?;
    Ok(PyBsdf(Arc::new(bsdf)))
}

/// Through transmittance, transmittance in all [-], and the cut-off angle [deg], at an angle of incidence [rad].
#[pyfunction]
pub fn roller_blind_transmittance(
    tau_nn: f64,
    tau_nh: f64,
    rho_front: f64,
    rho_back: f64,
    cutoff_deg: Option<f64>,
    incidence_rad: f64,
) -> PyResult<(f64, f64, f64)> {
    let blind = of_datasheet(tau_nn, tau_nh, rho_front, rho_back, cutoff_deg)?;
    Ok((blind.through(incidence_rad), blind.total(incidence_rad), blind.cutoff_deg()))
}
