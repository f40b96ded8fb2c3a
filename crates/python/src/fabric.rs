//! Fabrics from their datasheets.

use crate::bsdf::PyBsdf;
use crate::error::OrRaise;
use crate::kept::{PyKept, run_kept};
use pyo3::prelude::*;
use std::sync::Arc;
use sunpeak_bsdf::synthetic::{Basis, RollerBlind};

fn of_datasheet(
    tau_nn: f64,
    tau_nh: f64,
    rho_front: f64,
    rho_back: f64,
    cutoff_deg: Option<f64>,
    color: Option<[f64; 3]>,
) -> PyResult<RollerBlind> {
    let blind = RollerBlind {
        normal_normal: tau_nn,
        normal_hemispherical: tau_nh,
        reflectance: [rho_front, rho_back],
        cutoff_deg,
        color: color.map(Into::into),
    };
    blind.check().or_raise()?;
    Ok(blind)
}

/// Tabulate a roller blind from its datasheet; its through part is kept as the model has it.
#[pyfunction]
#[pyo3(signature = (basis, tau_nn, tau_nh, rho_front, rho_back, cutoff_deg, color, kept=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn roller_blind(
    py: Python<'_>,
    basis: &str,
    tau_nn: f64,
    tau_nh: f64,
    rho_front: f64,
    rho_back: f64,
    cutoff_deg: Option<f64>,
    color: Option<[f64; 3]>,
    kept: Option<PyRef<'_, PyKept>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyBsdf> {
    let blind = of_datasheet(tau_nn, tau_nh, rho_front, rho_back, cutoff_deg, color)?;
    let basis: Basis = basis.parse().or_raise()?;
    let bsdf = run_kept(
        py,
        kept.as_deref(),
        progress.as_ref(),
        |sum| sum.text(&format!("{blind:?} {basis}")),
        |work| blind.tabulate_exact(basis, work),
    )?;
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
    color: Option<[f64; 3]>,
    incidence_rad: f64,
) -> PyResult<(f64, f64, f64)> {
    let blind = of_datasheet(tau_nn, tau_nh, rho_front, rho_back, cutoff_deg, color)?;
    Ok((blind.through(incidence_rad), blind.total(incidence_rad), blind.cutoff_deg()))
}
