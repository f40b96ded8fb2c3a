//! Glare of a picture.

use crate::error::{InputError, OrRaise};
use crate::picture::PyPicture;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sunpeak_core::Vec3;
use sunpeak_glare::{BelowSight, GlareOptions, GlareReport, Source, TaskZone, Threshold, evaluate};

/// Find glare sources and compute DGP: the fields of the report as a dictionary.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn glare<'py>(
    py: Python<'py>,
    picture: &PyPicture,
    threshold: f64,
    threshold_kind: &str,
    task: Option<([f64; 3], f64)>,
    search_angle_rad: f64,
    peak_cd_m2: Option<f64>,
    ev_lux: Option<f64>,
    low_light: bool,
    below_sight: &str,
    relative_error: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let options = GlareOptions {
        threshold: threshold_of(threshold, threshold_kind, task)?,
        search_angle_rad,
        peak_cd_m2,
        ev_lux,
        low_light,
        below_sight: below(below_sight)?,
        relative_error,
    };
    let report = py.detach(|| evaluate(&picture.0, &options)).or_raise()?;
    fields(py, &report)
}

fn threshold_of(value: f64, kind: &str, task: Option<([f64; 3], f64)>) -> PyResult<Threshold> {
    match (kind, task) {
        ("luminance", _) => Ok(Threshold::Luminance(value)),
        ("mean", _) => Ok(Threshold::TimesMean(value)),
        ("task", Some((direction, opening_angle_rad))) => {
            let direction = Vec3::from_array(direction);
            Ok(Threshold::TimesTask(value, TaskZone { direction, opening_angle_rad }))
        }
        _ => Err(InputError::new_err(format!(
            "threshold: {kind:?}; expected luminance, mean, or task with its zone"
        ))),
    }
}

fn below(name: &str) -> PyResult<BelowSight> {
    match name {
        "iwata-osterhaus" => Ok(BelowSight::IwataOsterhaus),
        "iwata-tokura" => Ok(BelowSight::IwataTokura),
        _ => Err(InputError::new_err(format!(
            "below_sight: {name:?}; expected iwata-osterhaus or iwata-tokura"
        ))),
    }
}

fn fields<'py>(py: Python<'py>, report: &GlareReport) -> PyResult<Bound<'py, PyDict>> {
    let sources =
        report.sources.iter().map(|source| source_fields(py, source)).collect::<PyResult<Vec<_>>>()?;
    let all = PyDict::new(py);
    all.set_item("dgp", report.dgp)?;
    all.set_item("dgp_interval", (report.dgp_interval[0], report.dgp_interval[1]))?;
    all.set_item("dgp_low_light_corrected", report.dgp_low_light_corrected)?;
    all.set_item("glare_class", report.class.name())?;
    all.set_item("ev_lux", report.ev_lux)?;
    all.set_item("ev_sources_lux", report.ev_sources_lux)?;
    all.set_item("max_luminance_cd_m2", report.max_luminance_cd_m2)?;
    all.set_item("mean_luminance_cd_m2", report.mean_luminance_cd_m2)?;
    all.set_item("background_cd_m2", report.background_cd_m2)?;
    all.set_item("threshold_cd_m2", report.threshold_cd_m2)?;
    all.set_item("rule", &report.rule)?;
    all.set_item("warnings", &report.warnings)?;
    all.set_item("sources", sources)?;
    Ok(all)
}

fn source_fields<'py>(py: Python<'py>, source: &Source) -> PyResult<Bound<'py, PyDict>> {
    let [x, y, z] = source.direction.to_array();
    let all = PyDict::new(py);
    all.set_item("direction", (x, y, z))?;
    all.set_item("solid_angle_sr", source.solid_angle_sr)?;
    all.set_item("luminance_cd_m2", source.luminance_cd_m2)?;
    all.set_item("position_index", source.position_index)?;
    all.set_item("illuminance_lux", source.illuminance_lux)?;
    all.set_item("weight", source.weight())?;
    all.set_item("exact", source.exact)?;
    all.set_item("pixels", source.pixels)?;
    Ok(all)
}
