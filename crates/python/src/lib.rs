//! Python bindings of Sunpeak: conversions, error mapping and the release of the interpreter's lock; no algorithms.

mod error;

use pyo3::prelude::*;

/// The compiled core of `sunpeak`.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::error::InputError;

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
