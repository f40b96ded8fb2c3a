//! NumPy arrays to vectors and back.

use crate::error::InputError;
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray2, ndarray::Array2};
use pyo3::prelude::*;
use sunpeak_core::{Rgb, Vec3};

/// How far from 1 the length of a direction may be before it is refused: more than rounding, less than a mistake.
const UNIT_TOLERANCE: f64 = 1e-3;

/// (n,)
pub type Numbers<'py> = Bound<'py, PyArray1<f64>>;
/// (n, 3)
pub type Rows<'py> = Bound<'py, PyArray2<f64>>;
/// (h, w, 3)
pub type Image<'py> = Bound<'py, PyArray3<f64>>;

/// Rows (n, 3) as vectors.
pub fn vectors(array: &PyReadonlyArray2<'_, f64>, name: &str) -> PyResult<Vec<Vec3>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        return Err(InputError::new_err(format!(
            "{name}: expected the shape (n, 3), found {:?}",
            view.shape()
        )));
    }
    Ok(view.rows().into_iter().map(|row| Vec3::new(row[0], row[1], row[2])).collect())
}

/// Rows (n, 3) as unit vectors; what is not a direction is refused with its row.
pub fn directions(array: &PyReadonlyArray2<'_, f64>, name: &str) -> PyResult<Vec<Vec3>> {
    let mut all = vectors(array, name)?;
    for (row, vector) in all.iter_mut().enumerate() {
        let length = vector.length();
        if length.is_nan() || (length - 1.0).abs() > UNIT_TOLERANCE {
            let [x, y, z] = vector.to_array();
            let message = format!("{name}: row {row} is ({x}, {y}, {z}); expected a unit vector");
            return Err(InputError::new_err(message));
        }
        *vector /= length;
    }
    Ok(all)
}

/// Vectors or colours as rows (n, 3).
pub fn rows<'py>(py: Python<'py>, values: &[Vec3]) -> Rows<'py> {
    let array = Array2::from_shape_fn((values.len(), 3), |(row, column)| values[row][column]);
    PyArray2::from_owned_array(py, array)
}

/// Numbers (n,).
pub fn numbers<'py>(py: Python<'py>, values: Vec<f64>) -> Numbers<'py> {
    PyArray1::from_vec(py, values)
}

/// Colours as they are (n, 3), or their luminous mean (n,).
pub fn colours<'py>(py: Python<'py>, values: &[Rgb], colour: bool) -> Bound<'py, PyAny> {
    if colour {
        rows(py, values).into_any()
    } else {
        numbers(py, values.iter().map(|&value| sunpeak_core::luminance(value)).collect()).into_any()
    }
}
