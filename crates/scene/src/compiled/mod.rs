//! Files that Radiance's compilers write: octrees (`oconv`) and meshes (`obj2mesh`); and Wavefront files, of which meshes are made.
//!
//! Our own `oconv` writes octrees too, without a tree ([`OctreeFile`]). Of Radiance's octrees only what it was made of is read: the names of its files, or the scene itself if it is frozen (`oconv -f`). Its
//! tree is skipped, we build our own hierarchy.

mod mesh;
mod objects;
mod octree;
mod parts;
mod reader;
mod wavefront;

pub use mesh::{MeshFile, Part};
pub use octree::{decode_octree, read_octree};
pub use parts::OctreeFile;

use std::path::Path;
use sunpeak_core::Result;

/// Read a mesh: `.obj` as a Wavefront file, anything else as written by `obj2mesh`.
pub fn read_mesh(path: &Path) -> Result<MeshFile> {
    let is_wavefront = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    if is_wavefront { wavefront::read(path) } else { mesh::read(path) }
}
