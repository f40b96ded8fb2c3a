//! Octrees as Radiance's `oconv` writes them, and ours.

use super::{objects::read_objects, parts, parts::OctreeFile, reader::Reader};
use crate::{Source, files::read};
use std::path::{Path, PathBuf};
use sunpeak_core::Result;

const FORMAT: &str = "Radiance_octree";
/// The number before the size of object numbers.
const MAGIC: i64 = 4 * 8 + 251;

/// Read an octree: what it was made of.
pub fn read_octree(path: &Path) -> Result<OctreeFile> {
    decode_octree(read(path)?, path)
}

/// The same of bytes; messages call them `path`.
pub fn decode_octree(bytes: Vec<u8>, path: &Path) -> Result<OctreeFile> {
    let mut reader = Reader::new(bytes, path);
    let header = reader.header()?;
    let format = header.iter().rev().find_map(|line| line.strip_prefix("FORMAT=")).map(str::trim);
    let is_history = |line: &String| !line.starts_with("FORMAT=") && !line.starts_with("#?");
    let history = header.iter().filter(|line| is_history(line)).cloned().collect();
    if format == Some(parts::FORMAT) {
        return OctreeFile::decode(history, reader.rest(), &path.to_string_lossy());
    }
    reader.expect_format(format, FORMAT, MAGIC, "an octree")?;
    of_radiance(&mut reader, history)
}

fn of_radiance(reader: &mut Reader, history: Vec<String>) -> Result<OctreeFile> {
    // The cube.
    for _ in 0..4 {
        reader.real_text()?;
    }
    let mut sources = Vec::new();
    loop {
        let name = reader.string()?;
        if name.is_empty() {
            break;
        }
        sources.push(Source::File(PathBuf::from(name)));
    }
    let _objects = reader.integer(reader.object_size)?;
    if sources.is_empty() {
        reader.skip_tree()?;
        let primitives = read_objects(reader)?;
        sources.push(Source::Text {
            name: reader.location().file.to_string(),
            text: primitives.iter().map(ToString::to_string).collect::<String>().into_bytes(),
            directory: reader.folder(),
        });
    }
    // Names are relative to where the renderer runs.
    Ok(OctreeFile { history, cwd: PathBuf::new(), surfaces: None, sources })
}
