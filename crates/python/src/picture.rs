//! `Picture`: linear radiance with its view, header and exact sources.

use crate::error::{InputError, OrRaise};
use crate::scene::PyView;
use numpy::{PyArray2, PyArray3, PyReadonlyArray2, PyReadonlyArray3, ndarray};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_core::Vec3;
use sunpeak_scene::{ExactSource, Picture};

/// Linear radiance [W sr⁻¹ m⁻²] in three channels.
#[pyclass(frozen, name = "Picture", module = "sunpeak._core")]
pub struct PyPicture(pub Arc<Picture>);

#[pymethods]
impl PyPicture {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let picture = py.detach(|| Picture::load(&path)).or_raise()?;
        Ok(Self(Arc::new(picture)))
    }

    /// From pixels (h, w, 3); `sources` has a row for each exact source, as in the header.
    #[staticmethod]
    fn from_pixels(
        pixels: PyReadonlyArray3<'_, f32>,
        view: Option<&PyView>,
        header: Vec<String>,
        sources: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let pixels = pixels.as_array();
        let [height, width, 3] = *pixels.shape() else {
            let message = format!("pixels: expected the shape (h, w, 3), found {:?}", pixels.shape());
            return Err(InputError::new_err(message));
        };
        let picture = Picture {
            width,
            height,
            pixels: pixels.lanes(ndarray::Axis(2)).into_iter().map(|p| [p[0], p[1], p[2]]).collect(),
            view: view.map(|view| view.0.clone()),
            header,
            exact_sources: exact_sources(&sources)?,
            ..Picture::new(0, 0)
        };
        Ok(Self(Arc::new(picture)))
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.0.save(&path)).or_raise()
    }

    /// The bytes of its file, with other header lines.
    fn encode<'py>(&self, py: Python<'py>, header: Vec<String>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| Picture { header, ..(*self.0).clone() }.encode()).or_raise()?;
        Ok(PyBytes::new(py, &bytes))
    }

    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.0.height, self.0.width)
    }

    fn pixels<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<f32>> {
        let (picture, width) = (&self.0, self.0.width);
        let array = ndarray::Array3::from_shape_fn((picture.height, width, 3), |(row, column, channel)| {
            picture.pixels[row * width + column][channel]
        });
        PyArray3::from_owned_array(py, array)
    }

    fn luminance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let values = ndarray::Array2::from_shape_vec(self.shape(), self.0.luminance())
            .map_err(|error| InputError::new_err(error.to_string()))?;
        Ok(PyArray2::from_owned_array(py, values))
    }

    #[getter]
    fn view(&self) -> Option<PyView> {
        self.0.view.clone().map(PyView)
    }

    #[getter]
    fn header(&self) -> Vec<String> {
        self.0.header.clone()
    }

    /// Standard errors of blocks [cd/m²] (rows, columns), and a block's edge [pixels].
    fn block_errors<'py>(&self, py: Python<'py>) -> PyResult<Option<(Bound<'py, PyArray2<f64>>, usize)>> {
        let Some(errors) = &self.0.block_errors else { return Ok(None) };
        let shape = (errors.luminance_cd_m2.len() / errors.columns.max(1), errors.columns);
        let values = ndarray::Array2::from_shape_vec(shape, errors.luminance_cd_m2.clone())
            .map_err(|error| InputError::new_err(error.to_string()))?;
        Ok(Some((PyArray2::from_owned_array(py, values), errors.edge)))
    }

    /// A row for each source: direction, solid angle, radiance, visible fraction (n, 8).
    fn sources<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let sources = &self.0.exact_sources;
        let array = ndarray::Array2::from_shape_fn((sources.len(), 8), |(row, column)| {
            let source = &sources[row];
            match column {
                0..3 => source.direction[column],
                3 => source.solid_angle_sr,
                4..7 => source.radiance[column - 4],
                _ => source.visible_fraction,
            }
        });
        PyArray2::from_owned_array(py, array)
    }
}

fn exact_sources(rows: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<ExactSource>> {
    let rows = rows.as_array();
    if rows.ncols() != 8 {
        return Err(InputError::new_err("sources: expected rows of eight numbers, as in SUNPEAK_SOURCE="));
    }
    let source = |row: ndarray::ArrayView1<'_, f64>| ExactSource {
        direction: Vec3::new(row[0], row[1], row[2]),
        solid_angle_sr: row[3],
        radiance: Vec3::new(row[4], row[5], row[6]),
        visible_fraction: row[7],
    };
    Ok(rows.rows().into_iter().map(source).collect())
}
