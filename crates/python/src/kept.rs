//! Long computations by columns that go on after Ctrl-C.

use crate::error::OrRaise;
use crate::watch::run_watched;
use pyo3::prelude::*;
use std::{io, path::PathBuf};
use sunpeak_bsdf::{Kept, Work, codec::Encoder};
use sunpeak_core::Result;

/// Finished columns of one or several computations.
#[pyclass(frozen, name = "Kept", module = "sunpeak._core")]
pub struct PyKept(Kept);

#[pymethods]
impl PyKept {
    /// None, or those that an earlier run has saved.
    #[new]
    #[pyo3(signature = (path=None))]
    fn new(py: Python<'_>, path: Option<PathBuf>) -> PyResult<Self> {
        let kept = py.detach(|| path.map_or_else(|| Ok(Kept::new()), |path| Kept::load(&path)));
        Ok(Self(kept.or_raise()?))
    }

    /// Write them, whole or not at all; says whether there were any.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<bool> {
        if self.0.is_empty() {
            return Ok(false);
        }
        py.detach(|| self.0.save(&path)).or_raise()?;
        Ok(true)
    }
}

/// [`run_watched`] for a computation by columns, which are kept if asked; `input` sums up all that they depend on.
pub fn run_kept<T: Send>(
    py: Python<'_>,
    kept: Option<&PyKept>,
    progress: Option<&Py<PyAny>>,
    input: impl FnOnce(&mut Encoder<io::Sink>) -> io::Result<()> + Send,
    work: impl FnOnce(&Work) -> Result<T> + Send,
) -> PyResult<T> {
    let kept = kept.map(|kept| &kept.0);
    run_watched(py, progress, |control| match kept {
        Some(kept) => work(&Work::keeping(control, kept, input)?),
        None => work(&Work::new(control)),
    })
}
