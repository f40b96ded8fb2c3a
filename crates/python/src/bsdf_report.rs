//! Reports on BSDFs, their splits as files, and their cells as they are drawn.

use crate::arrays::{Numbers, Rows, directions, numbers, rows};
use crate::bsdf::{PyBsdf, mode};
use crate::error::{InputError, OrRaise};
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray2, ndarray::Array2, ndarray::Array3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use sunpeak_bsdf::{
    Mode,
    peak::reference,
    report::{Compared, PeakReport, Range, Reciprocity, SideReport, TableReport},
};
use sunpeak_core::{Vec3, luminance};

/// Outlines (cells, points, 2).
type Outlines<'py> = Bound<'py, PyArray3<f64>>;

/// All numbers of the report.
#[pyfunction]
pub fn bsdf_report<'py>(py: Python<'py>, bsdf: &PyBsdf) -> PyResult<Bound<'py, PyDict>> {
    let report = py.detach(|| bsdf.0.report());
    let about = PyDict::new(py);
    let each = |items: Vec<PyResult<Bound<'py, PyDict>>>| items.into_iter().collect::<PyResult<Vec<_>>>();
    about.set_item("tables", each(report.tables.iter().map(|t| table(py, t)).collect())?)?;
    about.set_item("sides", each(report.sides.iter().map(|s| side(py, s)).collect())?)?;
    about.set_item("reciprocity", each(report.reciprocity.iter().map(|r| reciprocity(py, r)).collect())?)?;
    about.set_item("peaks", each(report.peaks.iter().map(|p| peak(py, p)).collect())?)?;
    Ok(about)
}

fn side_name(front: bool) -> &'static str {
    if front { "front" } else { "back" }
}

fn mode_name(mode: Mode) -> &'static str {
    if mode == Mode::Transmission { "transmission" } else { "reflection" }
}

fn table<'py>(py: Python<'py>, t: &TableReport) -> PyResult<Bound<'py, PyDict>> {
    let about = PyDict::new(py);
    about.set_item("mode", mode_name(t.mode))?;
    about.set_item("side", side_name(t.front))?;
    about.set_item("basis", &t.basis)?;
    about.set_item("incident_cells", t.columns)?;
    about.set_item("values", t.values)?;
    about.set_item("smallest_cell_sr", t.smallest_cell_sr)?;
    about.set_item("smallest_cell_deg", t.smallest_cell_deg)?;
    about.set_item("isotropic", t.isotropic)?;
    about.set_item("colour", t.colored)?;
    about.set_item("by_reciprocity", t.by_reciprocity)?;
    Ok(about)
}

fn range(r: Range) -> (f64, f64, f64) {
    (r.mean, r.min, r.max)
}

fn side<'py>(py: Python<'py>, s: &SideReport) -> PyResult<Bound<'py, PyDict>> {
    let about = PyDict::new(py);
    about.set_item("side", side_name(s.front))?;
    let angles: Vec<_> =
        s.angles.iter().map(|a| (a.theta_deg, range(a.transmittance), range(a.reflectance))).collect();
    about.set_item("angles", angles)?;
    about.set_item("largest_sum", s.largest_sum)?;
    about.set_item("largest_sum_at_deg", s.largest_sum_at_deg)?;
    about.set_item("share_above_one", s.share_above_one)?;
    about.set_item("exact", s.exact)?;
    Ok(about)
}

fn reciprocity<'py>(py: Python<'py>, r: &Reciprocity) -> PyResult<Bound<'py, PyDict>> {
    let about = PyDict::new(py);
    let compared = match r.compared {
        Compared::Transmission => "transmission",
        Compared::Through => "through",
        Compared::ReflectionFront => "reflection front",
        Compared::ReflectionBack => "reflection back",
    };
    about.set_item("compared", compared)?;
    about.set_item("mean_difference", r.mean_difference)?;
    about.set_item("largest_difference", r.largest_difference)?;
    about.set_item("largest_at_deg", r.largest_at_deg)?;
    about.set_item("by_construction", r.by_construction)?;
    Ok(about)
}

fn peak<'py>(py: Python<'py>, p: &PeakReport) -> PyResult<Bound<'py, PyDict>> {
    let about = PyDict::new(py);
    about.set_item("side", side_name(p.front))?;
    about.set_item("columns", p.columns)?;
    about.set_item("columns_with_peak", p.columns_with_peak)?;
    about.set_item("share_of_incidences", p.share_of_incidences)?;
    about.set_item("openness", p.openness)?;
    about.set_item("openness_interval", p.openness_interval)?;
    about.set_item("detection_limit", p.detection_limit)?;
    about.set_item("extracted_share_diffuse", p.extracted_share_diffuse)?;
    about.set_item("extracted_share_normal", p.extracted_share_normal)?;
    about.set_item("contrast_min", p.contrast.map(|c| c.min))?;
    about.set_item("contrast_median", p.contrast.map(|c| c.median))?;
    about.set_item("narrowest_lobe_deg", p.narrowest_lobe_deg)?;
    about.set_item("narrowest_lobe_range_deg", p.narrowest_lobe_range_deg)?;
    about.set_item("taken_between_deg", p.taken_between_deg)?;
    about.set_item("last_angle_deg", p.last_angle_deg)?;
    about.set_item("share_between", p.share_between)?;
    about.set_item("columns_at_edge", p.columns_at_edge)?;
    let through: Vec<_> =
        p.through.iter().map(|t| (t.theta_deg, t.phi_deg, t.through, t.interval[0], t.interval[1])).collect();
    about.set_item("through", through)?;
    Ok(about)
}

/// Lowest and highest through transmittance that the data allow for each direction, (n, 2).
#[pyfunction]
pub fn through_interval<'py>(
    py: Python<'py>,
    bsdf: &PyBsdf,
    w_in: PyReadonlyArray2<'py, f64>,
) -> PyResult<Rows<'py>> {
    let found: Vec<[f64; 2]> =
        directions(&w_in, "w_in")?.into_iter().map(|w| bsdf.0.through_interval(w)).collect();
    let array = Array2::from_shape_fn((found.len(), 2), |(row, column)| found[row][column]);
    Ok(PyArray2::from_owned_array(py, array))
}

/// Write the split to a folder; gives the files' names.
/// Width [deg] of a lobe at a side that looks like an instrument's.
#[pyfunction]
pub fn instrument_seen(py: Python<'_>, bsdf: &PyBsdf, front: bool) -> Option<f64> {
    py.detach(|| bsdf.0.instrument_seen(front))
}

/// Write the split to a folder.
#[pyfunction]
pub fn save_split(py: Python<'_>, bsdf: &PyBsdf, folder: PathBuf) -> PyResult<Vec<PathBuf>> {
    py.detach(|| bsdf.0.save_split(&folder)).or_raise()
}

fn only(w_in: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec3> {
    match directions(w_in, "w_in")?[..] {
        [w] => Ok(w),
        ref all => Err(InputError::new_err(format!("w_in: expected one direction, found {}", all.len()))),
    }
}

/// All outlines have the same number of points.
fn outlines<'py>(py: Python<'py>, each: &[Vec<[f64; 2]>]) -> Outlines<'py> {
    let points = each.first().map_or(0, Vec::len);
    let array = Array3::from_shape_fn((each.len(), points, 2), |(i, j, k)| each[i][j][k]);
    PyArray3::from_owned_array(py, array)
}

/// Outlines of the exiting cells, and for each: value, residual [1/sr], projected solid angle [sr]; part of the peak?
#[pyfunction]
pub fn exit_cells<'py>(
    py: Python<'py>,
    bsdf: &PyBsdf,
    w_in: PyReadonlyArray2<'py, f64>,
    mode_name: &str,
    edge_points: usize,
) -> PyResult<(Outlines<'py>, Rows<'py>, Bound<'py, PyArray1<bool>>)> {
    let (w_in, mode) = (only(&w_in)?, mode(mode_name)?);
    let cells = py.detach(|| bsdf.0.exit_cells(w_in, mode, edge_points));
    let borders: Vec<Vec<[f64; 2]>> =
        cells.iter().map(|c| c.outline.iter().map(|p| p.to_array()).collect()).collect();
    let numbers: Vec<Vec3> =
        cells.iter().map(|c| Vec3::new(c.value, c.residual, c.projected_solid_angle)).collect();
    let is_peak = PyArray1::from_vec(py, cells.iter().map(|c| c.is_peak).collect());
    Ok((outlines(py, &borders), rows(py, &numbers), is_peak))
}

/// Outlines of the incident cells of a side with their theta, phi [deg], T and its interval [-].
#[pyfunction]
pub fn incident_cells<'py>(
    py: Python<'py>,
    bsdf: &PyBsdf,
    front: bool,
    edge_points: usize,
) -> PyResult<(Outlines<'py>, Bound<'py, PyDict>)> {
    let cells = py.detach(|| bsdf.0.incident_cells(front, edge_points));
    let borders: Vec<Vec<[f64; 2]>> =
        cells.iter().map(|c| c.outline.iter().map(|p| p.to_array()).collect()).collect();
    let about = PyDict::new(py);
    let column = |of: &dyn Fn(&sunpeak_bsdf::IncidentCell) -> f64| -> Numbers<'py> {
        numbers(py, cells.iter().map(of).collect())
    };
    about.set_item("theta_deg", column(&|c| c.incident.theta_deg))?;
    about.set_item("phi_deg", column(&|c| c.incident.phi_deg))?;
    about.set_item("through", column(&|c| luminance(c.peak.through)))?;
    about.set_item("low", column(&|c| c.peak.interval[0]))?;
    about.set_item("high", column(&|c| c.peak.interval[1]))?;
    Ok((outlines(py, &borders), about))
}

/// The directions (29, 3) that rule 2 looks at; none if nothing is transmitted.
#[pyfunction]
pub fn probe_directions<'py>(
    py: Python<'py>,
    bsdf: &PyBsdf,
    w_in: PyReadonlyArray2<'py, f64>,
) -> PyResult<Rows<'py>> {
    let w_in = only(&w_in)?;
    let smallest = bsdf
        .0
        .distribution(w_in, Mode::Transmission)
        .map(|o| o.distribution.smallest_projected_solid_angle());
    let found: Vec<Vec3> = smallest.map_or(Vec::new(), |s| reference::probe(w_in, s).collect());
    Ok(rows(py, &found))
}
