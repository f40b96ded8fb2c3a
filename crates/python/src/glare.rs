//! Glare of a picture.

use crate::arrays::{Numbers, directions, numbers};
use crate::error::{InputError, OrRaise};
use crate::picture::PyPicture;
use numpy::{PyArray2, PyReadonlyArray2, ndarray};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sunpeak_core::Vec3;
use sunpeak_glare::{
    BelowSight, ClassVerdict, DgpFit, GlareClass, GlareOptions, GlareReport, Intervals, Source, SourceCentre,
    TaskZone, Threshold, Tolerances, evaluate, evaluate_with_pixels, position_index,
};

/// A round zone: unit vector towards its centre, full opening angle [rad].
type Zone = ([f64; 3], f64);

/// Find glare sources and compute DGP and its siblings: the fields of the report as a dictionary.
#[pyfunction]
pub fn glare<'py>(
    py: Python<'py>,
    picture: &PyPicture,
    options: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = glare_options(options)?;
    let report = py.detach(|| evaluate(&picture.0, &options)).or_raise()?;
    let all = fields(py, &report)?;
    all.set_item("edgps", options.ev_lux.map(|_| report.dgp_terms.dgp()))?;
    Ok(all)
}

/// Which source each pixel belongs to (h, w): 1 for the worst, 0 for none. Exact ones have no pixels.
#[pyfunction]
pub fn glare_sources<'py>(
    py: Python<'py>,
    picture: &PyPicture,
    options: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyArray2<u32>>> {
    let options = glare_options(options)?;
    let (_, sources) = py.detach(|| evaluate_with_pixels(&picture.0, &options)).or_raise()?;
    let (height, width) = (picture.0.height, picture.0.width);
    let mut numbers = ndarray::Array2::zeros((height, width));
    for (number, pixels) in (1..).zip(sources) {
        pixels.iter().for_each(|index| numbers[[index / width, index % width]] = number);
    }
    Ok(PyArray2::from_owned_array(py, numbers))
}

/// Position index (n,) of directions (n, 3) for an eye that looks along `sight`.
#[pyfunction]
pub fn position_indices<'py>(
    py: Python<'py>,
    towards: PyReadonlyArray2<'py, f64>,
    sight: [f64; 3],
    up: [f64; 3],
    below: &str,
) -> PyResult<Numbers<'py>> {
    let (sight, up, below) = (Vec3::from_array(sight).normalize(), Vec3::from_array(up), below_sight(below)?);
    let index = |direction: Vec3| position_index(direction, sight, up, below);
    Ok(numbers(py, directions(&towards, "directions")?.into_iter().map(index).collect()))
}

/// The options from their names in Rust; what is not there has its default.
pub fn glare_options(given: &Bound<'_, PyDict>) -> PyResult<GlareOptions> {
    let given = Given(given);
    let default = GlareOptions::default();
    let task = given.get::<Option<Zone>>("task")?.flatten().map(zone);
    Ok(GlareOptions {
        threshold: threshold(&given, task)?.unwrap_or(default.threshold),
        search_angle_rad: given.get("search_angle_rad")?.unwrap_or(default.search_angle_rad),
        peak_cd_m2: given.get("peak_cd_m2")?.unwrap_or(default.peak_cd_m2),
        ev_lux: given.get("ev_lux")?.flatten(),
        low_light: given.get("low_light")?.unwrap_or(default.low_light),
        below_sight: given.named("below_sight", below_sight)?.unwrap_or(default.below_sight),
        up_as_given: given.get("up_as_given")?.unwrap_or(default.up_as_given),
        dgp_fit: given.named("dgp_fit", dgp_fit)?.unwrap_or(default.dgp_fit),
        centre: given.named("centre", centre)?.unwrap_or(default.centre),
        least_solid_angle_sr: given.get("least_solid_angle_sr")?.flatten(),
        task,
        source_distance_m: given.get("source_distance_m")?.flatten(),
        tolerances: Tolerances {
            through: given.get("tolerance_through")?.unwrap_or(0.0),
            sky: given.get("tolerance_sky")?.unwrap_or(0.0),
            position_deg: given.get("tolerance_position_deg")?.unwrap_or(0.0),
        },
        relative_error: given.get("relative_error")?.unwrap_or(default.relative_error),
    })
}

struct Given<'a, 'py>(&'a Bound<'py, PyDict>);

impl<'py> Given<'_, 'py> {
    fn get<T: for<'a> FromPyObject<'a, 'py>>(&self, name: &str) -> PyResult<Option<T>> {
        let Some(value) = self.0.get_item(name)? else { return Ok(None) };
        value
            .extract::<T>()
            .map(Some)
            .map_err(|_| InputError::new_err(format!("{name}: {value} is not what is expected there")))
    }

    fn named<T>(&self, name: &str, of: fn(&str) -> PyResult<T>) -> PyResult<Option<T>> {
        self.get::<String>(name)?.map(|value| of(&value)).transpose()
    }
}

fn zone((direction, opening_angle_rad): Zone) -> TaskZone {
    TaskZone { direction: Vec3::from_array(direction), opening_angle_rad }
}

fn threshold(given: &Given, task: Option<TaskZone>) -> PyResult<Option<Threshold>> {
    let Some(value) = given.get::<f64>("threshold")? else { return Ok(None) };
    let kind = given.get::<String>("threshold_kind")?.unwrap_or_default();
    match (kind.as_str(), task) {
        ("luminance", _) => Ok(Some(Threshold::Luminance(value))),
        ("mean", _) => Ok(Some(Threshold::TimesMean(value))),
        ("task", Some(task)) => Ok(Some(Threshold::TimesTask(value, task))),
        _ => Err(InputError::new_err(format!(
            "threshold: {kind:?}; expected luminance, mean, or task with its zone"
        ))),
    }
}

fn below_sight(name: &str) -> PyResult<BelowSight> {
    match name {
        "evalglare-3" => Ok(BelowSight::Evalglare3),
        "iwata-osterhaus" => Ok(BelowSight::IwataOsterhaus),
        "iwata-tokura" => Ok(BelowSight::IwataTokura),
        _ => Err(InputError::new_err(format!(
            "below_sight: {name:?}; expected evalglare-3, iwata-osterhaus or iwata-tokura"
        ))),
    }
}

fn centre(name: &str) -> PyResult<SourceCentre> {
    match name {
        "angular" => Ok(SourceCentre::Angular),
        "sphere" => Ok(SourceCentre::Sphere),
        "evalglare-3" => Ok(SourceCentre::Evalglare3),
        _ => Err(InputError::new_err(format!("centre: {name:?}; expected angular, sphere or evalglare-3"))),
    }
}

fn dgp_fit(name: &str) -> PyResult<DgpFit> {
    match name {
        "published" => Ok(DgpFit::Published),
        "evalglare-3" => Ok(DgpFit::Evalglare3),
        _ => Err(InputError::new_err(format!("dgp_fit: {name:?}; expected published or evalglare-3"))),
    }
}

fn fields<'py>(py: Python<'py>, report: &GlareReport) -> PyResult<Bound<'py, PyDict>> {
    let sources =
        report.sources.iter().map(|source| source_fields(py, source)).collect::<PyResult<Vec<_>>>()?;
    let all = PyDict::new(py);
    all.set_item("dgp", report.dgp)?;
    all.set_item("dgp_interval", (report.dgp_interval[0], report.dgp_interval[1]))?;
    all.set_item("sampling_intervals", intervals(py, report.sampling.as_ref())?)?;
    all.set_item("input_intervals", intervals(py, report.input.as_ref())?)?;
    all.set_item("class_probabilities", probabilities(py, &report.verdict)?)?;
    all.set_item("verdict", report.verdict.class.map_or("undecided", GlareClass::name))?;
    all.set_item("dgp_low_light_corrected", report.dgp_low_light_corrected)?;
    all.set_item("dgp_in_range", report.dgp_in_range)?;
    all.set_item("dgp_offset", report.dgp_terms.offset)?;
    all.set_item("dgp_ev_term", report.dgp_terms.illuminance)?;
    all.set_item("dgp_contrast_term", report.dgp_terms.contrast)?;
    all.set_item("glare_class", report.class.name())?;
    all.set_item("ev_lux", report.ev_lux)?;
    all.set_item("ev_sources_lux", report.ev_sources_lux)?;
    for (name, value) in report.metrics.values() {
        all.set_item(name, value)?;
    }
    all.set_item("max_luminance_cd_m2", report.max_luminance_cd_m2)?;
    all.set_item("mean_luminance_cd_m2", report.mean_luminance_cd_m2)?;
    all.set_item("median_luminance_cd_m2", report.median_luminance_cd_m2)?;
    all.set_item("background_cd_m2", report.background_cd_m2)?;
    all.set_item("zones", zone_fields(py, report)?)?;
    all.set_item("threshold_cd_m2", report.threshold_cd_m2)?;
    all.set_item("rule", &report.rule)?;
    all.set_item("warnings", &report.warnings)?;
    all.set_item("sources", sources)?;
    Ok(all)
}

fn intervals<'py>(py: Python<'py>, all: Option<&Intervals>) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(all) = all else { return Ok(None) };
    let fields = PyDict::new(py);
    for &(name, [low, high]) in all {
        fields.set_item(name, (low, high))?;
    }
    Ok(Some(fields))
}

fn probabilities<'py>(py: Python<'py>, verdict: &ClassVerdict) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    for (class, probability) in GlareClass::ALL.iter().zip(verdict.probabilities) {
        fields.set_item(class.name(), probability)?;
    }
    Ok(fields)
}

fn zone_fields<'py>(py: Python<'py>, report: &GlareReport) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("task_cd_m2", report.zones.task)?;
    all.set_item("ergorama_cd_m2", report.zones.ergorama)?;
    all.set_item("panorama_cd_m2", report.zones.panorama)?;
    all.set_item("periphery_cd_m2", report.zones.periphery)?;
    Ok(all)
}

fn source_fields<'py>(py: Python<'py>, source: &Source) -> PyResult<Bound<'py, PyDict>> {
    let [x, y, z] = source.direction.to_array();
    let all = PyDict::new(py);
    all.set_item("direction", (x, y, z))?;
    all.set_item("angle_to_sight_deg", source.angle_to_sight_rad.to_degrees())?;
    all.set_item("solid_angle_sr", source.solid_angle_sr)?;
    all.set_item("luminance_cd_m2", source.luminance_cd_m2)?;
    all.set_item("position_index", source.position_index)?;
    all.set_item("illuminance_lux", source.illuminance_lux)?;
    all.set_item("weight", source.weight())?;
    all.set_item("dgp_part", source.dgp_part)?;
    all.set_item("exact", source.exact)?;
    all.set_item("pixels", source.pixels)?;
    Ok(all)
}
