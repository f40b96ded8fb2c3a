//! Octrees as our own `oconv` writes them: a header as Radiance's, then the parts of a scene, a line each with tabs between its words.
//!
//! ```text
//! Sunpeak octree<TAB>1
//! cwd<TAB>/where/oconv/ran
//! surfaces<TAB>12
//! file<TAB>/where/room.rad
//! file<TAB>!genbox …
//! text<TAB>bytes<TAB>/where/names/are/looked/for<TAB>name
//! … so many bytes of scene text, and a line end
//! ```
//! There is no tree in it: the renderer builds its own hierarchy. Radiance's programs refuse it by its format.

use crate::{LoadOptions, Source};
use std::{
    fmt::Write,
    path::{Path, PathBuf},
};
use sunpeak_core::{Error, Location, Result};

/// After `FORMAT=` in the header.
pub const FORMAT: &str = "Sunpeak_octree";
const MAGIC: &str = "#?RADIANCE";
const FIRST_LINE: &str = "Sunpeak octree\t1";

/// A scene in one file: the names of its files, or texts with all commands done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OctreeFile {
    /// Header lines that say how it was made.
    pub history: Vec<String>,
    /// The folder that names are relative to.
    pub cwd: PathBuf,
    /// How many surfaces there were when it was written, if that is known.
    pub surfaces: Option<usize>,
    /// Files and texts, in order.
    pub sources: Vec<Source>,
}

impl OctreeFile {
    /// The bytes of the file.
    ///
    /// # Errors
    /// A name that has a tab, a line end, or characters that are no text.
    pub fn encode(&self) -> Result<Vec<u8>> {
        let mut head = format!("{MAGIC}\n");
        for line in &self.history {
            head.push_str(line.lines().next().unwrap_or_default());
            head.push('\n');
        }
        // Writing to a string does not fail.
        let _ = write!(head, "FORMAT={FORMAT}\n\n{FIRST_LINE}\ncwd\t{}\n", word(&self.cwd)?);
        if let Some(surfaces) = self.surfaces {
            let _ = writeln!(head, "surfaces\t{surfaces}");
        }
        let mut bytes = head.into_bytes();
        for source in &self.sources {
            match source {
                Source::File(path) => bytes.extend(format!("file\t{}\n", word(path)?).bytes()),
                Source::Text { name, text, directory } => {
                    let (directory, name) = (word(directory)?, word(Path::new(name))?);
                    bytes.extend(format!("text\t{}\t{directory}\t{name}\n", text.len()).bytes());
                    bytes.extend_from_slice(text);
                    bytes.push(b'\n');
                }
            }
        }
        Ok(bytes)
    }

    /// Read what stands after the header whose lines are `history`; `file` is what messages call it.
    pub(super) fn decode(history: Vec<String>, body: &[u8], file: &str) -> Result<Self> {
        let damaged = |what: &str| {
            Error::input(Location::new(file, 0, 0), format!("a damaged octree ({what}): run oconv again"))
        };
        let mut lines = Lines { rest: body };
        match lines.next() {
            Some(FIRST_LINE) => {}
            Some(other) if other.starts_with("Sunpeak octree\t") => {
                return Err(damaged("of another version of Sunpeak"));
            }
            _ => return Err(damaged("its first line")),
        }
        let mut read = Self { history, cwd: PathBuf::new(), surfaces: None, sources: Vec::new() };
        while let Some(line) = lines.next() {
            match line.split('\t').collect::<Vec<_>>()[..] {
                ["cwd", path] => read.cwd = path.into(),
                ["surfaces", count] => {
                    read.surfaces = Some(count.parse().map_err(|_| damaged("the number of surfaces"))?);
                }
                ["file", path] => read.sources.push(Source::File(path.into())),
                ["text", length, directory, name] => {
                    let text = length.parse().ok().and_then(|length| lines.take(length));
                    let text = text.ok_or_else(|| damaged("it ends too early"))?;
                    let (name, directory) = (name.to_string(), directory.into());
                    read.sources.push(Source::Text { name, text: text.to_vec(), directory });
                }
                _ => return Err(damaged("a line that is none of its own")),
            }
        }
        if lines.rest.is_empty() { Ok(read) } else { Err(damaged("its last line")) }
    }

    /// How its sources are to be read.
    pub(crate) fn options(&self, options: &LoadOptions) -> LoadOptions {
        LoadOptions { cwd: Some(self.cwd.clone()), ..options.clone() }
    }
}

fn word(path: &Path) -> Result<&str> {
    let text = path.to_str().filter(|text| !text.contains(['\t', '\n']));
    text.ok_or_else(|| {
        Error::value(format!(
            "the name \"{}\" cannot stand in an octree: it has a tab or a line end",
            path.display()
        ))
    })
}

/// Lines of text among bytes.
struct Lines<'b> {
    rest: &'b [u8],
}

impl<'b> Lines<'b> {
    /// `None` at the end, and where there is no line of text.
    fn next(&mut self) -> Option<&'b str> {
        let end = self.rest.iter().position(|&byte| byte == b'\n')?;
        let line = std::str::from_utf8(&self.rest[..end]).ok()?;
        self.rest = &self.rest[end + 1..];
        Some(line)
    }

    /// So many bytes and a line end.
    fn take(&mut self, length: usize) -> Option<&'b [u8]> {
        if self.rest.get(length) != Some(&b'\n') {
            return None;
        }
        let (taken, rest) = self.rest.split_at(length);
        self.rest = &rest[1..];
        Some(taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compiled::decode_octree;

    #[test]
    fn what_is_written_reads_back_the_same_and_damage_is_said() {
        let file = OctreeFile {
            history: vec!["oconv -f room.rad".into()],
            cwd: "/some/where".into(),
            surfaces: Some(3),
            sources: vec![
                Source::File("!genbox a b 1 1 1".into()),
                Source::Text {
                    name: "frozen".into(),
                    text: b"a\n\tb\n".to_vec(),
                    directory: "/else where".into(),
                },
                Source::File("/some/where/room.rad".into()),
            ],
        };
        let bytes = file.encode().expect("names without tabs");
        assert_eq!(decode_octree(bytes.clone(), Path::new("a.oct")).expect("an octree"), file);
        for length in 0..bytes.len() {
            let Ok(read) = decode_octree(bytes[..length].to_vec(), Path::new("a.oct")) else { continue };
            assert!(file.sources.starts_with(&read.sources), "{length}: {read:?}");
        }
        let odd = OctreeFile { cwd: "a\tb".into(), ..file };
        assert!(odd.encode().is_err());
    }
}
