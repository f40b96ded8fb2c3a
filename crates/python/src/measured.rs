//! BSDFs from goniophotometer scans.

use crate::arrays::{Numbers, Rows, directions, numbers, rows};
use crate::bsdf::PyBsdf;
use crate::error::{InputError, OrRaise};
use crate::kept::{PyKept, run_kept};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_bsdf::measured::{
    IncidenceReport, KindReport, Measured, Options, Reading, Scan, Straight, beam_fwhm_deg, read, sum_up,
    tabulate,
};

/// The readings of one incidence.
#[pyclass(frozen, name = "Scan", module = "sunpeak._core")]
pub struct PyScan(Scan);

#[pymethods]
impl PyScan {
    /// From unit vectors to the light (1, 3) and of exit (n, 3), and BSDF values (n,) [1/sr].
    #[new]
    fn new(
        name: String,
        to_light: PyReadonlyArray2<'_, f64>,
        exits: PyReadonlyArray2<'_, f64>,
        values: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Self> {
        let (light, exits) = (directions(&to_light, "to_light")?, directions(&exits, "exits")?);
        let values = values.as_array();
        let &[light] = &light[..] else {
            return Err(InputError::new_err("to_light: expected one direction"));
        };
        if exits.len() != values.len() {
            let message =
                format!("values: expected {}, one for each exit, found {}", exits.len(), values.len());
            return Err(InputError::new_err(message));
        }
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            return Err(InputError::new_err(format!("values: number {row} is not finite")));
        }
        let mut scan = Scan::new(name.as_str().into(), 0, light);
        scan.readings = exits.into_iter().zip(values).map(|(exit, &value)| Reading { exit, value }).collect();
        scan.name = name;
        Ok(Self(scan))
    }

    /// Name of the sample.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Unit vector to the light (1, 3).
    #[getter]
    fn to_light<'py>(&self, py: Python<'py>) -> Rows<'py> {
        rows(py, &[self.0.to_light])
    }

    /// Unit vectors of exit (n, 3).
    #[getter]
    fn exits<'py>(&self, py: Python<'py>) -> Rows<'py> {
        rows(py, &self.0.readings.iter().map(|r| r.exit).collect::<Vec<_>>())
    }

    /// BSDF values (n,) [1/sr].
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        numbers(py, self.0.readings.iter().map(|r| r.value).collect())
    }

    /// Full width at half maximum [deg] of a bare beam.
    fn beam_fwhm_deg(&self) -> PyResult<f64> {
        beam_fwhm_deg(&self.0).or_raise()
    }
}

/// The scans of a file.
#[pyfunction]
pub fn read_scans(py: Python<'_>, path: PathBuf) -> PyResult<Vec<PyScan>> {
    Ok(py.detach(|| read(&path)).or_raise()?.into_iter().map(PyScan).collect())
}

/// Tables with what is known of how they came about.
#[pyclass(frozen, name = "Measured", module = "sunpeak._core")]
pub struct PyMeasured {
    bsdf: Arc<sunpeak_bsdf::Bsdf>,
    kinds: Vec<KindReport>,
    scaled: Vec<ScaledSide>,
}

/// Name of the side, columns that were scaled, the worst sum [-] and its angle of incidence [deg].
type ScaledSide = (&'static str, usize, f64, f64);

/// Side, mode, symmetry, columns of numbers.
type KindTable<'py> = (&'static str, &'static str, &'static str, Bound<'py, PyDict>);

#[pymethods]
impl PyMeasured {
    /// The tables; what went straight was told apart is their exact split.
    fn bsdf(&self) -> PyBsdf {
        PyBsdf(self.bsdf.clone())
    }

    /// Of each side and mode: what it is, and columns of numbers by incidence.
    fn kinds<'py>(&self, py: Python<'py>) -> PyResult<Vec<KindTable<'py>>> {
        self.kinds
            .iter()
            .map(|k| {
                let mode = if k.kind.reflection { "reflection" } else { "transmission" };
                Ok((side_name(k.kind.front), mode, k.symmetry.name(), columns(py, k)?))
            })
            .collect()
    }

    /// Sides on which more left than came in.
    #[getter]
    fn scaled(&self) -> Vec<ScaledSide> {
        self.scaled.clone()
    }
}

fn side_name(front: bool) -> &'static str {
    if front { "front" } else { "back" }
}

/// What is known of an incidence, by name.
type Field = (&'static str, fn(&IncidenceReport) -> f64);

fn columns<'py>(py: Python<'py>, kind: &KindReport) -> PyResult<Bound<'py, PyDict>> {
    let fields: [Field; 10] = [
        ("theta_deg", |i| i.theta_deg),
        ("phi_deg", |i| i.phi_deg),
        ("readings", |i| i.readings as f64),
        ("through", |i| if let Some(Straight::Peak(through)) = i.straight { through } else { f64::NAN }),
        ("readings_in_peak", |i| {
            if let Some(Straight::TooFew(few)) = i.straight { few as f64 } else { f64::NAN }
        }),
        ("scattered", |i| i.scattered),
        ("largest_exit_deg", |i| i.coverage.largest_exit_deg),
        ("hole_deg", |i| i.coverage.hole_deg),
        ("hole_exit_deg", |i| i.coverage.hole_exit_deg()),
        ("hole_phi_deg", |i| i.coverage.hole_phi_deg()),
    ];
    let table = PyDict::new(py);
    for (name, field) in fields {
        table.set_item(name, numbers(py, kind.incidences.iter().map(field).collect()))?;
    }
    Ok(table)
}

/// Tabulate scans; finished columns go to `kept`, and `progress` is called with their number and that of all.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn measured_bsdf(
    py: Python<'_>,
    scans: Vec<PyRef<'_, PyScan>>,
    basis: &str,
    symmetry: String,
    instrument_fwhm_deg: Option<f64>,
    energy: &str,
    kept: Option<PyRef<'_, PyKept>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyMeasured> {
    let options = Options {
        basis: basis.parse().or_raise()?,
        symmetry,
        instrument_fwhm_deg,
        energy: energy.parse().or_raise()?,
    };
    let scans: Vec<Scan> = scans.iter().map(|scan| scan.0.clone()).collect();
    let Measured { bsdf, kinds, scaled } = run_kept(
        py,
        kept.as_deref(),
        progress.as_ref(),
        |sum| sum_up(&scans, &options, sum),
        |work| tabulate(&scans, &options, work),
    )?;
    let scaled = scaled.iter().map(|s| (side_name(s.front), s.columns, s.worst[0], s.worst[1])).collect();
    Ok(PyMeasured { bsdf: Arc::new(bsdf), kinds, scaled })
}
