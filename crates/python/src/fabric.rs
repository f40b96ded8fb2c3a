//! Fabrics of our own making, as the text of an LBNL XML file.

use crate::error::OrRaise;
use pyo3::prelude::*;
use sunpeak_bsdf::synthetic::{Basis, Fabric};

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
