//! Octrees as Radiance's `oconv` writes them.

use super::{objects::read_objects, reader::Reader};
use crate::raw::Primitive;
use std::path::Path;
use sunpeak_core::Result;

const FORMAT: &str = "Radiance_octree";
/// The number before the size of object numbers.
const MAGIC: i64 = 4 * 8 + 251;

/// What an octree was made of.
#[derive(Debug)]
pub enum Octree {
    /// The files that it names, in order; a name that begins with `!` is a command.
    Files(Vec<String>),
    /// The scene itself (`oconv -f`).
    Frozen(Vec<Primitive>),
}

/// Read an octree.
pub fn read_octree(path: &Path) -> Result<Octree> {
    let mut reader = Reader::open(path, FORMAT, MAGIC, "an octree")?;
    // The cube.
    for _ in 0..4 {
        reader.real_text()?;
    }
    let mut files = Vec::new();
    loop {
        let name = reader.string()?;
        if name.is_empty() {
            break;
        }
        files.push(name);
    }
    let _objects = reader.integer(reader.object_size)?;
    if !files.is_empty() {
        return Ok(Octree::Files(files));
    }
    reader.skip_tree()?;
    Ok(Octree::Frozen(read_objects(&mut reader)?))
}
