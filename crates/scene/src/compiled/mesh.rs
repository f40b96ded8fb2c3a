//! Meshes as Radiance's `obj2mesh` writes them: materials, and patches of up to 256 vertices with the triangles within a patch, and
//! those that join patches.
//!
//! A place is three integers of 32 bits across the cube of the mesh, local coordinates are two across their range (0: none), a
//! normal is packed into 29 bits (0: none).

use super::{objects::read_objects, reader::Reader};
use crate::raw::Primitive;
use std::path::Path;
use sunpeak_core::{Result, Vec3};

const FORMAT: &str = "Radiance_tmesh";
/// The number before the size of object numbers.
const MAGIC: i64 = 8 + 311;

/// What a patch's vertices have.
const HAS_PLACES: i64 = 1;
const HAS_NORMALS: i64 = 2;
const HAS_LOCAL: i64 = 4;

/// One 2^32th of a range.
const STEP: f64 = 1.0 / 4_294_967_296.0;

/// Components of a normal are integers of this many to 1 (2^13 - 1/2 to the root of 1/2).
const NORMAL_SCALE: f64 = 11_584.5;

/// The triangles of one material.
#[derive(Debug, Default)]
pub struct Part {
    /// The material's name; `None` for that of the primitive.
    pub material: Option<String>,
    /// Indices of the vertices, counter-clockwise at the front.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh in its own axes.
#[derive(Debug, Default)]
pub struct MeshFile {
    pub vertices: Vec<Vec3>,
    /// Of each vertex, zero where it has none; empty if none has.
    pub normals: Vec<Vec3>,
    /// Local coordinates of each vertex; empty if none has.
    pub local: Vec<[f64; 2]>,
    pub parts: Vec<Part>,
    /// The materials that the file holds.
    pub materials: Vec<Primitive>,
}

/// Corners of a triangle and the number of its material.
type Corners = ([u32; 3], usize);

/// Read a mesh file.
pub fn read(path: &Path) -> Result<MeshFile> {
    let mut reader = Reader::open(path, FORMAT, MAGIC, "a mesh")?;
    let origin = Vec3::new(reader.real_text()?, reader.real_text()?, reader.real_text()?);
    let size = reader.real_text()?;
    let limits = [[reader.real()?, reader.real()?], [reader.real()?, reader.real()?]];
    reader.skip_tree()?;
    let materials = read_objects(&mut reader)?;
    let most = reader.left();
    let patches = reader.count(4, most, "patches")?;
    let mut mesh = Patches { origin, size, limits, starts: Vec::new(), file: MeshFile::default() };
    let mut triangles = Vec::new();
    for _ in 0..patches {
        triangles.extend(mesh.patch(&mut reader)?);
    }
    mesh.finish(&reader, triangles, materials)
}

struct Patches {
    origin: Vec3,
    size: f64,
    /// Range of each local coordinate.
    limits: [[f64; 2]; 2],
    /// First vertex of each patch.
    starts: Vec<u32>,
    file: MeshFile,
}

/// A corner as a triangle names it, before all patches are read.
#[derive(Clone, Copy)]
enum Corner {
    /// In the triangle's own patch.
    Own(u32),
    /// Patch and vertex.
    Other(u32, u32),
}

impl Patches {
    fn patch(&mut self, reader: &mut Reader) -> Result<Vec<([Corner; 3], usize, usize)>> {
        let patch = self.starts.len();
        self.starts.push(self.file.vertices.len() as u32);
        let flags = reader.integer(1)?;
        if flags & HAS_PLACES == 0 || flags & !(HAS_PLACES | HAS_NORMALS | HAS_LOCAL) != 0 {
            return Err(reader.error("a damaged mesh: unknown kinds of vertices"));
        }
        let vertices = reader.count(2, 256, "vertices in a patch")?;
        self.vertices(reader, vertices, flags)?;
        let mut triangles = Vec::new();
        let own = reader.count(2, 512, "triangles in a patch")?;
        for _ in 0..own {
            let corners = [reader.byte()?, reader.byte()?, reader.byte()?];
            triangles.push((corners.map(|c| Corner::Own(c.into())), 0, patch));
        }
        let materials = reader.integer(2)?;
        if materials > 1 {
            for triangle in &mut triangles {
                triangle.1 = reader.count(2, i16::MAX as usize, "as the number of a material")?;
            }
        } else {
            let sole = reader.integer(2)?;
            triangles.iter_mut().for_each(|t| t.1 = usize::try_from(sole).unwrap_or(0));
        }
        for others in [1, 2] {
            let joiners = reader.count(2, 256, "joining triangles in a patch")?;
            for _ in 0..joiners {
                let mut corners = [Corner::Own(0); 3];
                for corner in &mut corners[..others] {
                    let id = reader.unsigned()?;
                    *corner = Corner::Other(id >> 8, id & 0xff);
                }
                for corner in &mut corners[others..] {
                    *corner = Corner::Own(reader.byte()?.into());
                }
                let material = reader.count(2, i16::MAX as usize, "as the number of a material")?;
                triangles.push((corners, material, patch));
            }
        }
        Ok(triangles)
    }

    fn vertices(&mut self, reader: &mut Reader, count: usize, flags: i64) -> Result<()> {
        for _ in 0..count {
            let mut place = [0.0; 3];
            for coordinate in &mut place {
                *coordinate = (f64::from(reader.unsigned()?) + 0.5) * STEP * self.size;
            }
            self.file.vertices.push(self.origin + Vec3::from_array(place));
        }
        let all = self.file.vertices.len();
        if flags & HAS_NORMALS != 0 {
            self.file.normals.resize(all - count, Vec3::ZERO);
            for _ in 0..count {
                self.file.normals.push(normal(reader.unsigned()?));
            }
        }
        if flags & HAS_LOCAL != 0 {
            self.file.local.resize(all - count, [0.0; 2]);
            for _ in 0..count {
                let codes = [reader.unsigned()?, reader.unsigned()?];
                let range = |i: usize| {
                    let [low, high] = self.limits[i];
                    low + (high - low) * (f64::from(codes[i]) + 0.5) * STEP
                };
                self.file.local.push(if codes[0] == 0 { [0.0; 2] } else { [range(0), range(1)] });
            }
        }
        Ok(())
    }

    fn finish(
        mut self,
        reader: &Reader,
        triangles: Vec<([Corner; 3], usize, usize)>,
        materials: Vec<Primitive>,
    ) -> Result<MeshFile> {
        let vertices = self.file.vertices.len();
        if !self.file.normals.is_empty() {
            self.file.normals.resize(vertices, Vec3::ZERO);
        }
        if !self.file.local.is_empty() {
            self.file.local.resize(vertices, [0.0; 2]);
        }
        for (corners, material, patch) in triangles {
            let (triangle, material): Corners = (self.resolve(reader, corners, patch)?, material);
            let name = materials.get(material).map(|m| m.name.clone());
            let parts = &mut self.file.parts;
            match parts.iter_mut().find(|part| part.material == name) {
                Some(part) => part.triangles.push(triangle),
                None => parts.push(Part { material: name, triangles: vec![triangle] }),
            }
        }
        self.file.materials = materials;
        Ok(self.file)
    }

    fn resolve(&self, reader: &Reader, corners: [Corner; 3], own: usize) -> Result<[u32; 3]> {
        let mut resolved = [0; 3];
        for (corner, resolved) in corners.into_iter().zip(&mut resolved) {
            let (patch, vertex) = match corner {
                Corner::Own(vertex) => (own, vertex),
                Corner::Other(patch, vertex) => (patch as usize, vertex),
            };
            let end = self.starts.get(patch + 1).copied().unwrap_or(self.file.vertices.len() as u32);
            let index = self.starts.get(patch).map(|start| start + vertex).filter(|&index| index < end);
            *resolved = index.ok_or_else(|| {
                reader.error(format!("a damaged mesh: a triangle names vertex {vertex} of patch {patch}"))
            })?;
        }
        Ok(resolved)
    }
}

/// Signs of x, y and z in bits 0 to 2; bit 3: |x| is not over |y|, bit 4: |z| is not over the larger of them; then in 13 bits each
/// the smaller of x and y, and the smaller of the larger one and z.
fn normal(code: u32) -> Vec3 {
    if code == 0 {
        return Vec3::ZERO;
    }
    let part = |shift: u32| f64::from(code >> shift & 0x1fff) / NORMAL_SCALE;
    let (first, second) = (part(5), part(18));
    let third = (1.0 - first * first - second * second).max(0.0).sqrt();
    let (x_first, z_second) = (code & 8 != 0, code & 16 != 0);
    let (larger, z) = if z_second { (third, second) } else { (second, third) };
    let (x, y) = if x_first { (first, larger) } else { (larger, first) };
    let sign = |bit: u32| if code & bit != 0 { -1.0 } else { 1.0 };
    Vec3::new(x * sign(1), y * sign(2), z * sign(4))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Packs as the format's description above says.
    fn pack(n: Vec3) -> u32 {
        let c = n.abs() * NORMAL_SCALE + 0.5;
        let [x, y, z] = [c.x as u32, c.y as u32, c.z as u32];
        let signs = u32::from(n.x < 0.0) | u32::from(n.y < 0.0) << 1 | u32::from(n.z < 0.0) << 2;
        let (first, larger, x_first) = if x <= y { (x, y, 8) } else { (y, x, 0) };
        let (second, z_second) = if z <= larger { (z, 16) } else { (larger, 0) };
        signs | x_first | z_second | first << 5 | second << 18
    }

    #[test]
    fn normals_are_unpacked() {
        for i in 0..200 {
            let n = Vec3::new((i as f64).sin(), (1.7 * i as f64).cos(), (0.3 * i as f64).sin()).normalize();
            assert!((normal(pack(n)) - n).length() < 3e-4, "{n} {}", normal(pack(n)));
        }
        assert_eq!(normal(0), Vec3::ZERO);
    }
}
