//! A BSDF from geometry: the virtual goniophotometer.

use crate::arrays::{Rows, numbers, rows, vectors};
use crate::bsdf::PyBsdf;
use crate::error::{InputError, OrRaise};
use crate::render::PyWorld;
use crate::scene::PyScene;
use crate::watch::run_watched;
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_bsdf::{Bsdf, Geometry, Label};
use sunpeak_core::Vec3;
use sunpeak_render::{
    Edges, GeneratedColumn, GeneratedSide, GonioOptions, Side, generate_bsdf as generate,
    straight_transmittance as straight,
};

/// A generated BSDF with its errors.
#[pyclass(frozen, name = "Generated", module = "sunpeak._core")]
pub struct PyGenerated {
    bsdf: Arc<Bsdf>,
    sides: Vec<GeneratedSide>,
    corners: [Vec3; 2],
    samples: u64,
    rays: u64,
    lost: f64,
}

#[pymethods]
impl PyGenerated {
    /// The tables with their exact split.
    fn bsdf(&self) -> PyBsdf {
        PyBsdf(self.bsdf.clone())
    }

    /// The text of an LBNL XML file; with a scene's geometry in it, moved to where such files have their origin.
    #[pyo3(signature = (comment, geometry=None))]
    fn xml(&self, py: Python<'_>, comment: String, geometry: Option<&PyScene>) -> PyResult<String> {
        let [low, high] = self.corners;
        let size = high - low;
        let offset = -Vec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), high.z);
        let geometry = geometry
            .map(|scene| scene.0.to_mgf(offset).map(|mgf| Geometry { mgf, size_m: [size.x, size.y] }))
            .transpose()
            .or_raise()?;
        let label =
            Label { comments: Some(comment), thickness_m: Some(size.z), geometry, ..Label::default() };
        py.detach(|| self.bsdf.to_xml_as(&label, None)).or_raise()
    }

    /// Smallest and largest corner of the sampled box (2, 3).
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> Rows<'py> {
        rows(py, &self.corners)
    }

    /// Walks, rays, and the largest share of a column that was given up.
    #[getter]
    fn totals(&self) -> (u64, u64, f64) {
        (self.samples, self.rays, self.lost)
    }

    /// Of each side, if asked for: the standard error of every cell [1/sr], column after column, transmission and reflection.
    fn cell_errors<'py>(&self, py: Python<'py>) -> Vec<Option<CellErrors<'py>>> {
        let arrays = |side: &GeneratedSide| {
            let errors = side.cell_errors.as_ref()?;
            Some([&errors[0], &errors[1]].map(|mode| PyArray1::from_slice(py, mode)))
        };
        self.sides.iter().map(arrays).collect()
    }

    /// Of each side: its name, the errors of its cells, and columns of numbers.
    fn sides<'py>(&self, py: Python<'py>) -> PyResult<Vec<SideTable<'py>>> {
        self.sides
            .iter()
            .map(|side| Ok((side_name(side.side), side.cell_error, columns(py, side)?)))
            .collect()
    }
}

/// Errors of all cells [1/sr] of transmission and reflection.
type CellErrors<'py> = [Bound<'py, PyArray1<f32>>; 2];

/// Name, errors of the cells, columns of numbers.
type SideTable<'py> = (&'static str, [f64; 2], Bound<'py, PyDict>);

/// What is known of a column, by name.
type Field = (&'static str, fn(&GeneratedColumn) -> f64);

fn columns<'py>(py: Python<'py>, side: &GeneratedSide) -> PyResult<Bound<'py, PyDict>> {
    let fields: [Field; 7] = [
        ("through", |c| c.through),
        ("through_error", |c| c.through_error),
        ("transmittance", |c| c.transmittance),
        ("transmittance_error", |c| c.transmittance_error),
        ("reflectance", |c| c.reflectance),
        ("reflectance_error", |c| c.reflectance_error),
        ("samples", |c| c.samples as f64),
    ];
    let table = PyDict::new(py);
    for (name, field) in fields {
        table.set_item(name, numbers(py, side.columns.iter().map(field).collect()))?;
    }
    Ok(table)
}

fn side_name(side: Side) -> &'static str {
    match side {
        Side::Front => "front",
        Side::Back => "back",
    }
}

/// A box from (2, 3) corners.
type Corners = Option<[[f64; 3]; 2]>;

fn corners(corners: Corners) -> Option<[Vec3; 2]> {
    corners.map(|c| c.map(Vec3::from_array))
}

fn edges(periodic: bool) -> Edges {
    if periodic { Edges::Periodic } else { Edges::Open }
}

/// Generate a BSDF; `progress` is called with the columns that are done and all.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn generate_bsdf(
    py: Python<'_>,
    world: &PyWorld,
    name: String,
    manufacturer: String,
    basis: &str,
    box_corners: Corners,
    periodic: bool,
    sides: Vec<String>,
    samples: Option<u64>,
    error: f64,
    tolerance: f64,
    reciprocity: bool,
    colour: bool,
    cell_errors: bool,
    seed: u64,
    threads: Option<usize>,
    state: Option<PathBuf>,
    resume: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyGenerated> {
    let side = |name: &String| match name.as_str() {
        "front" => Ok(Side::Front),
        "back" => Ok(Side::Back),
        _ => Err(InputError::new_err(format!("side: {name:?}; expected front or back"))),
    };
    let options = GonioOptions {
        corners: corners(box_corners),
        edges: edges(periodic),
        sides: sides.iter().map(side).collect::<PyResult<_>>()?,
        samples,
        error,
        tolerance,
        reciprocity,
        colored: colour,
        cell_errors,
        seed,
        threads,
        state,
        resume,
        ..GonioOptions::new(basis.parse().or_raise()?)
    };
    let mut made = run_watched(py, progress.as_ref(), |control| generate(&world.0, &options, control))?;
    (made.bsdf.name, made.bsdf.manufacturer) = (name, manufacturer);
    Ok(PyGenerated {
        bsdf: Arc::new(made.bsdf),
        sides: made.sides,
        corners: made.corners,
        samples: made.samples,
        rays: made.rays,
        lost: made.lost,
    })
}

/// Through transmittance (n, 3) and its standard error (n, 3) of rays in directions (n, 3).
#[pyfunction]
pub fn straight_transmittance<'py>(
    py: Python<'py>,
    world: &PyWorld,
    directions: PyReadonlyArray2<'py, f64>,
    box_corners: Corners,
    periodic: bool,
    samples: u64,
    seed: u64,
) -> PyResult<(Rows<'py>, Rows<'py>)> {
    let towards = vectors(&directions, "directions")?;
    let found = py
        .detach(|| straight(&world.0, corners(box_corners), edges(periodic), &towards, samples, seed))
        .or_raise()?;
    let (means, errors): (Vec<Vec3>, Vec<Vec3>) = found.into_iter().unzip();
    Ok((rows(py, &means), rows(py, &errors)))
}
