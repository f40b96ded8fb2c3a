//! The expression language.

use crate::error::{InputError, OrRaise};
use numpy::{PyArray2, PyReadonlyArray2, ndarray::Array2};
use pyo3::prelude::*;
use sunpeak_cal::{Definitions, Failure, Inputs, Program};
use sunpeak_core::Location;

/// A row of channels, `$1` first.
struct Row<'a>(&'a [f64]);

impl Inputs for Row<'_> {
    fn channel(&self, number: u32) -> f64 {
        (number as usize).checked_sub(1).and_then(|i| self.0.get(i)).copied().unwrap_or(0.0)
    }

    fn function(&self, _: u32, _: &[f64]) -> Option<f64> {
        None
    }
}

/// Values (n, m) of m expressions for n rows of channels; not a number where an expression fails.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    definitions: &str,
    expressions: Vec<String>,
    channels: PyReadonlyArray2<'_, f64>,
    arguments: Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let program = compile(definitions, &expressions, &arguments).or_raise()?;
    let channels = channels.as_array();
    let mut values = Array2::zeros((channels.nrows(), expressions.len()));
    for (row, mut out) in channels.rows().into_iter().zip(values.rows_mut()) {
        let row = row.to_vec();
        let inputs = Row(&row);
        let mut started = program.start(&inputs);
        for (i, value) in out.iter_mut().enumerate() {
            *value = match started.value(i, &[]) {
                Ok(value) => value,
                Err(Failure::Math) => f64::NAN,
                Err(Failure::Fault(fault)) => {
                    return Err(InputError::new_err(format!("\"{}\": {fault}", expressions[i])));
                }
            };
        }
    }
    Ok(PyArray2::from_owned_array(py, values))
}

fn compile(text: &str, expressions: &[String], arguments: &[f64]) -> sunpeak_core::Result<Program> {
    let mut definitions = Definitions::new();
    definitions.load(text.as_bytes(), "definitions", "")?;
    let mut parsed = Vec::with_capacity(expressions.len());
    for (i, expression) in expressions.iter().enumerate() {
        parsed.push(definitions.expression(expression, &Location::new("expressions", i + 1, 0), "")?);
    }
    definitions.compile(&parsed, arguments)
}
