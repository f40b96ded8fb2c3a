//! Radiance pictures out.

use super::{Picture, header, rgbe, scanline};
use std::{
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
};
use sunpeak_core::{Error, Result};

impl Picture {
    /// Write a Radiance picture (run-length RGBE, top row first), whole or not at all.
    pub fn save(&self, path: &Path) -> Result<()> {
        let bytes = self.encode()?;
        let temporary = temporary_beside(path);
        let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
        written.map_err(|source| {
            // What is half written is of no use; if it cannot be removed, there is nothing else to try.
            let _ = fs::remove_file(&temporary);
            Error::io(path, source)
        })
    }

    /// The bytes of its file.
    pub fn encode(&self) -> Result<Vec<u8>> {
        if self.width == 0 || self.height == 0 || self.pixels.len() != self.width * self.height {
            let (width, height, pixels) = (self.width, self.height, self.pixels.len());
            return Err(Error::value(format!(
                "a picture of {width} x {height} with {pixels} pixels cannot be written"
            )));
        }
        let mut bytes =
            header::text(&self.header, self.view.as_ref(), &self.exact_sources, self.block_errors.as_ref())
                .into_bytes();
        bytes.extend_from_slice(format!("-Y {} +X {}\n", self.height, self.width).as_bytes());
        for row in self.pixels.chunks_exact(self.width) {
            let row: Vec<[u8; 4]> = row.iter().map(|&pixel| rgbe::encode(pixel)).collect();
            scanline::write(&row, &mut bytes);
        }
        Ok(bytes)
    }
}

/// A name in the same folder, so that renaming does not copy; with the process in it, so that two do not meet.
fn temporary_beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}
