//! BSDFs as files: written under a label, in another basis, the solar band.

use crate::bsdf::PyBsdf;
use crate::error::OrRaise;
use crate::kept::{PyKept, run_kept};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_bsdf::{Bsdf, Conversion, Label};

/// The text of an LBNL XML file; what is not given the BSDF says itself.
#[pyfunction]
#[pyo3(signature = (bsdf, solar=None, name=None, manufacturer=None, thickness_m=None, comments=None))]
pub fn bsdf_xml(
    py: Python<'_>,
    bsdf: &PyBsdf,
    solar: Option<PyRef<'_, PyBsdf>>,
    name: Option<String>,
    manufacturer: Option<String>,
    thickness_m: Option<f64>,
    comments: Option<String>,
) -> PyResult<String> {
    let label = Label { name, manufacturer, thickness_m, comments, geometry: None };
    let solar = solar.map(|solar| solar.0.clone());
    py.detach(|| bsdf.0.to_xml_as(&label, solar.as_deref())).or_raise()
}

/// The tables of a file's solar band, in the place of the luminous ones.
#[pyfunction]
pub fn load_solar(py: Python<'_>, path: PathBuf) -> PyResult<PyBsdf> {
    Ok(PyBsdf(Arc::new(py.detach(|| Bsdf::load_solar(&path)).or_raise()?)))
}

/// The same product in another basis, moved, reciprocal.
#[pyfunction]
#[pyo3(signature = (bsdf, basis, rotate_deg, flip, swap_sides, reciprocal, keep_peak, kept=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn convert_bsdf(
    py: Python<'_>,
    bsdf: &PyBsdf,
    basis: Option<&str>,
    rotate_deg: f64,
    flip: bool,
    swap_sides: bool,
    reciprocal: bool,
    keep_peak: bool,
    kept: Option<PyRef<'_, PyKept>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyBsdf> {
    let basis = basis.map(str::parse).transpose().or_raise()?;
    let to = Conversion { basis, flip, swap_sides, rotate_deg, reciprocal, keep_peak };
    let old = &bsdf.0;
    let new = run_kept(
        py,
        kept.as_deref(),
        progress.as_ref(),
        |sum| sum.text(&format!("{to:?}")).and_then(|()| old.sum_up(sum)),
        |work| old.convert_watched(&to, work),
    )?;
    Ok(PyBsdf(Arc::new(new)))
}
