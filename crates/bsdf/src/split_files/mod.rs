//! The split as files: the residual as LBNL XML in the table's own basis, the peak as JSON and CSV, and an energy ledger.
//!
//! `peak.json` with `residual.xml` beside it is the whole `Bsdf` again: same table, same residual, same `T`. The CSV files
//! are for people and spreadsheets.

mod format;
mod read;
mod tables;
mod write;

use crate::bsdf::Bsdf;
use std::path::{Path, PathBuf};
use sunpeak_core::{Error, Result};

/// The residual in a folder of a split.
pub const RESIDUAL_FILE: &str = "residual.xml";

/// The peak, complete.
pub const PEAK_FILE: &str = "peak.json";

/// The peak, one line a column.
pub const PEAK_TABLE_FILE: &str = "peak.csv";

/// Where the flux of each column went.
pub const LEDGER_FILE: &str = "ledger.csv";

/// The texts of a split.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitFiles {
    /// LBNL XML.
    pub residual_xml: String,
    /// Read back by [`Bsdf::load_split`].
    pub peak_json: String,
    /// One line a column: angles, bounds, transmittance, evidence.
    pub peak_csv: String,
    /// One line a column: table, residual, through, error.
    pub ledger_csv: String,
}

impl SplitFiles {
    /// Names and texts; the peak comes last, since it vouches for the residual.
    fn each(&self) -> [(&'static str, &str); 4] {
        [
            (RESIDUAL_FILE, &self.residual_xml),
            (LEDGER_FILE, &self.ledger_csv),
            (PEAK_TABLE_FILE, &self.peak_csv),
            (PEAK_FILE, &self.peak_json),
        ]
    }

    /// Write them to a folder, which is made if it is not there: all of them whole, or none.
    pub fn save(&self, folder: &Path) -> Result<Vec<PathBuf>> {
        if folder.is_dir() {
            self.replace_in(folder)?;
        } else {
            let made = beside(folder, "new")?;
            std::fs::create_dir(&made).map_err(|e| Error::io(folder, e))?;
            let written = self.write_to(&made, "").and_then(|_| rename(&made, folder));
            if written.is_err() {
                let _ = std::fs::remove_dir_all(&made);
            }
            written?;
        }
        Ok(self.each().map(|(name, _)| folder.join(name)).to_vec())
    }

    /// Into a folder that has other files: first all under passing names, then each in its place.
    fn replace_in(&self, folder: &Path) -> Result<()> {
        let prefix = format!(".{}-", std::process::id());
        let passing = |name: &str| folder.join(format!("{prefix}{name}"));
        let done = self.write_to(folder, &prefix).and_then(|()| {
            self.each().iter().try_for_each(|(name, _)| rename(&passing(name), &folder.join(name)))
        });
        for (name, _) in self.each() {
            let _ = std::fs::remove_file(passing(name));
        }
        done
    }

    fn write_to(&self, folder: &Path, prefix: &str) -> Result<()> {
        self.each().iter().try_for_each(|(name, text)| {
            let path = folder.join(format!("{prefix}{name}"));
            std::fs::write(&path, text).map_err(|e| Error::io(folder.join(name), e))
        })
    }
}

fn rename(from: &Path, to: &Path) -> Result<()> {
    std::fs::rename(from, to).map_err(|e| Error::io(to, e))
}

/// A hidden name beside a path.
fn beside(path: &Path, what: &str) -> Result<PathBuf> {
    let name = path.file_name().ok_or_else(|| {
        Error::value(format!("{}: expected the name of a folder that can be written to", path.display()))
    })?;
    let hidden = format!(".{}.{}-{what}", name.to_string_lossy(), std::process::id());
    Ok(path.with_file_name(hidden))
}

impl Bsdf {
    /// Write the split to a folder; gives the files' names.
    pub fn save_split(&self, folder: &Path) -> Result<Vec<PathBuf>> {
        self.split_files()?.save(folder)
    }

    /// Is this path a split that was written, by its name: a folder, or a JSON file?
    pub(crate) fn is_split(path: &Path) -> bool {
        path.is_dir() || path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"))
    }
}
