//! Where files that a scene names are looked for.

use std::path::{Path, PathBuf};
use sunpeak_core::{Error, Location, Result};

/// How a scene is read.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Folders searched after the current one and the scene file's own, in order (Radiance's `RAYPATH`).
    pub search_path: Vec<PathBuf>,
    /// May commands that are not done inside Sunpeak run in a shell?
    pub allow_commands: bool,
    /// What relative names are relative to, first of all; `None` is the process's current folder.
    pub cwd: Option<PathBuf>,
}

impl LoadOptions {
    /// No commands; the search path of the environment variable `RAYPATH`.
    pub fn from_environment() -> Self {
        let path = std::env::var_os("RAYPATH").unwrap_or_default();
        let search_path = std::env::split_paths(&path).filter(|p| !p.as_os_str().is_empty()).collect();
        Self { search_path, ..Self::default() }
    }

    /// The folder that relative names are relative to.
    pub(crate) fn base(&self) -> PathBuf {
        self.cwd.clone().unwrap_or_default()
    }

    /// Find `name`, which stands at `location` in a file of `directory`, from the current folder `cwd`.
    ///
    /// The order is Radiance's (current folder, then the search path) with the scene file's own folder between, so
    /// that a scene can be read from anywhere.
    pub(crate) fn find(
        &self,
        name: &str,
        cwd: &Path,
        directory: &Path,
        location: &Location,
    ) -> Result<PathBuf> {
        let mut tried: Vec<PathBuf> = Vec::new();
        let folders = [cwd, directory].into_iter().chain(self.search_path.iter().map(PathBuf::as_path));
        for folder in folders {
            let candidate = plain(folder.join(name));
            if tried.contains(&candidate) {
                continue;
            }
            if candidate.is_file() {
                return Ok(candidate);
            }
            tried.push(candidate);
        }
        let list: Vec<_> = tried.iter().map(|p| p.display().to_string()).collect();
        Err(Error::input(
            location.clone(),
            format!("cannot find the file \"{name}\"; looked for {}", list.join(", ")),
        ))
    }
}

/// Read a whole file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::io(path, source))
}

/// The folder of a file, `.` for the current one.
pub(crate) fn folder_of(path: &Path) -> PathBuf {
    path.parent().map(Path::to_path_buf).unwrap_or_default()
}

/// A path without `./`, so that the same place is said, and tried, once.
fn plain(path: PathBuf) -> PathBuf {
    use std::path::Component;
    path.components().filter(|c| !matches!(c, Component::CurDir)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_lists_where_it_looked() {
        let options = LoadOptions { search_path: vec!["lib".into()], ..LoadOptions::default() };
        let at = Location::new("room.rad", 3, 1);
        let error =
            options.find("./no.xml", Path::new(""), Path::new("rooms"), &at).expect_err("no such file");
        let expected =
            "room.rad:3:1: cannot find the file \"./no.xml\"; looked for no.xml, rooms/no.xml, lib/no.xml";
        assert_eq!(error.to_string(), expected);
    }
}
