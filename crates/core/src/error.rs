//! One error type for all crates: what was wrong, where, and what was expected.

use std::{fmt, path::PathBuf, sync::Arc};

/// The result of everything that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Where in the input something stands. Lines and columns count from 1; 0 means unknown.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Location {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
}

impl Location {
    /// A place in a file.
    pub fn new(file: impl Into<Arc<str>>, line: usize, column: usize) -> Self {
        Self { file: file.into(), line, column }
    }

    /// The line and column of a byte offset in a text.
    pub fn of_offset(file: impl Into<Arc<str>>, text: &[u8], offset: usize) -> Self {
        let before = &text[..offset.min(text.len())];
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        let column = 1 + before.iter().rev().take_while(|&&b| b != b'\n').count();
        Self::new(file, line, column)
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
            if self.column > 0 {
                write!(f, ":{}", self.column)?;
            }
        }
        Ok(())
    }
}

/// Why a call failed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The input is wrong: where, what was found and what was expected.
    #[error("{location}: {message}")]
    Input {
        /// Where it stands.
        location: Location,
        /// What was found and what was expected.
        message: String,
    },
    /// A value that the caller gave is out of its domain.
    #[error("{0}")]
    Value(String),
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The user stopped the computation.
    #[error("interrupted")]
    Interrupted,
}

impl Error {
    /// An input error at a place.
    pub fn input(location: Location, message: impl Into<String>) -> Self {
        Self::Input { location, message: message.into() }
    }

    /// A value out of its domain.
    pub fn value(message: impl Into<String>) -> Self {
        Self::Value(message.into())
    }

    /// A file that could not be read or written.
    pub fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Self::Io { path: path.into(), source }
    }
}
