//! The one place where errors of the crates become Python exceptions.

use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};
use pyo3::prelude::*;
use sunpeak_core::Error;

create_exception!(
    sunpeak._core,
    InputError,
    PyValueError,
    "The input is wrong: the message says where (file:line:column), what was found and what was expected."
);

/// The Python exception for an error of the crates.
pub fn to_py(error: Error) -> PyErr {
    match error {
        Error::Input { .. } | Error::Value(_) => InputError::new_err(error.to_string()),
        Error::Io { path, source } => {
            let file = path.display().to_string();
            match source.raw_os_error() {
                // With (errno, text, file) Python itself picks FileNotFoundError, PermissionError …
                Some(errno) => PyOSError::new_err((errno, message_without_errno(&source), file)),
                None => PyOSError::new_err(format!("{file}: {source}")),
            }
        }
        Error::Interrupted => PyKeyboardInterrupt::new_err("interrupted"),
    }
}

/// Rust appends " (os error N)" to what the system said; Python writes the number itself.
fn message_without_errno(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or_default().to_owned()
}

/// `?` for results of the crates.
pub trait OrRaise<T> {
    /// The value, or the exception.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for sunpeak_core::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(to_py)
    }
}
