//! `instance` and `mesh`: surfaces out of octree and mesh files. Each use makes surfaces of its own in world axes.

use super::{Interpreter, Named, Reference, args::title};
use crate::compiled::{MeshFile, Part, read_mesh, read_octree};
use crate::{
    LoadOptions, Mesh, ModifierId, Shape, Source, Surface,
    command::{Expander, Invocation, trailing_transform},
    files::folder_of,
    load::load_source,
    raw::{Class, Primitive},
};
use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    sync::Arc,
};
use sunpeak_core::{Error, Result, Transform, Vec3};

/// Instances in instances: deeper than this an octree holds itself.
const MAX_NESTED: usize = 16;
/// Primitives and triangles that instances and meshes make; a few more would not fit into memory.
const MAX_PIECES: usize = 20_000_000;

/// What the interpreter keeps of compound surfaces.
#[derive(Default)]
pub struct Compounds {
    octrees: HashMap<PathBuf, Arc<Vec<Primitive>>>,
    meshes: HashMap<PathBuf, Arc<MeshFile>>,
    nested: usize,
    pieces: usize,
    /// The modifier that an instance puts in the place of its octree's own.
    pub modifier: Option<ModifierId>,
}

impl Interpreter<'_> {
    pub(super) fn compound(&mut self, primitive: &Primitive) -> Result<()> {
        let (file, invocation) = arguments(primitive)?;
        let modifier = match self.parent(primitive, &primitive.modifier)? {
            Reference::Void => self.compounds.modifier,
            Reference::Named(Named::Modifier(id)) => Some(self.compounds.modifier.unwrap_or(id)),
            Reference::Named(Named::Problem(problem)) => return Err(self.raise(problem, primitive)),
        };
        if let Some(id) = modifier {
            self.check_chain(id, primitive)?;
        }
        match primitive.kind.name {
            "instance" => self.instance(primitive, file, &invocation, modifier),
            _ => self.mesh(primitive, file, &invocation, modifier),
        }
    }

    /// The file that an instance or a mesh names, found.
    pub(super) fn compound_file(&mut self, primitive: &Primitive) -> Result<PathBuf> {
        let (file, _) = arguments(primitive)?;
        match primitive.kind.name {
            "instance" => self.options.find(file, &self.cwd, &primitive.directory, &primitive.location),
            _ => self.mesh_path(primitive, file),
        }
    }

    fn instance(
        &mut self,
        primitive: &Primitive,
        file: &str,
        invocation: &Invocation,
        modifier: Option<ModifierId>,
    ) -> Result<()> {
        if self.compounds.nested >= MAX_NESTED {
            let message =
                format!("instances within instances, more than {MAX_NESTED} deep: does one hold itself?");
            return Err(at(primitive, message));
        }
        let path = self.options.find(file, &self.cwd, &primitive.directory, &primitive.location)?;
        let content = self.octree(&path, primitive)?;
        self.count(primitive, content.len())?;
        let (names, outer) = (std::mem::take(&mut self.names), self.compounds.modifier);
        self.compounds.modifier = modifier;
        self.compounds.nested += 1;
        let result = content.iter().try_for_each(|inner| {
            if inner.kind.name == "source" {
                self.warn(inner, &format!("in the octree of {}: left out", title(primitive)));
                return Ok(());
            }
            self.add(invocation.apply(inner.clone()))
        });
        self.compounds.nested -= 1;
        self.compounds.modifier = outer;
        self.names = names;
        result
    }

    /// The primitives of an octree, commands in its files done.
    fn octree(&mut self, path: &Path, user: &Primitive) -> Result<Arc<Vec<Primitive>>> {
        if let Some(known) = self.compounds.octrees.get(path) {
            return Ok(known.clone());
        }
        let file = read_octree(path)?;
        let options = match file.surfaces {
            // Ours says where it was made; Radiance's is read where the program runs, or else where the octree lies.
            Some(_) => file.options(self.options),
            None => {
                let mut options = self.options.clone();
                options.search_path.insert(0, folder_of(path));
                options
            }
        };
        let mut expander = Expander::new(&options);
        let mut primitives = Vec::new();
        for source in &file.sources {
            primitives.extend(load_source(&mut expander, &found(source, &options, user)?, &options)?);
        }
        self.scene.warnings.extend(expander.warnings);
        let primitives = Arc::new(primitives);
        self.compounds.octrees.insert(path.to_path_buf(), primitives.clone());
        Ok(primitives)
    }

    fn mesh(
        &mut self,
        primitive: &Primitive,
        file: &str,
        invocation: &Invocation,
        modifier: Option<ModifierId>,
    ) -> Result<()> {
        let path = self.mesh_path(primitive, file)?;
        let mesh = match self.compounds.meshes.get(&path) {
            Some(known) => known.clone(),
            None => {
                let mesh = Arc::new(read_mesh(&path)?);
                self.compounds.meshes.insert(path, mesh.clone());
                mesh
            }
        };
        self.count(primitive, mesh.parts.iter().map(|part| part.triangles.len()).sum())?;
        let placed = placed(&mesh, &invocation.transform);
        for part in &mesh.parts {
            let modifier = match modifier {
                Some(id) => id,
                None => self.part_modifier(primitive, &mesh, part, invocation)?,
            };
            let triangles = triangles(part, &placed.vertices, invocation.transform.is_mirror());
            if triangles.is_empty() {
                continue;
            }
            self.scene.surfaces.push(Surface {
                name: primitive.name.clone(),
                modifier: Some(modifier),
                shape: Shape::Mesh(Mesh { triangles, ..placed.clone() }),
                location: primitive.location.clone(),
            });
        }
        Ok(())
    }

    /// Without the compiled mesh, the Wavefront file of the same name serves.
    fn mesh_path(&mut self, primitive: &Primitive, file: &str) -> Result<PathBuf> {
        let find = |name: &str| self.options.find(name, &self.cwd, &primitive.directory, &primitive.location);
        let missing = match find(file) {
            Ok(path) => return Ok(path),
            Err(missing) => missing,
        };
        let wavefront = Path::new(file).with_extension("obj");
        let path = wavefront.to_str().and_then(|name| find(name).ok()).ok_or(missing)?;
        self.warn(primitive, &format!("has no file \"{file}\"; read {} instead", path.display()));
        Ok(path)
    }

    /// Without a modifier of its own a mesh has the materials that its file holds, or, from a Wavefront file, names.
    fn part_modifier(
        &mut self,
        primitive: &Primitive,
        mesh: &MeshFile,
        part: &Part,
        invocation: &Invocation,
    ) -> Result<ModifierId> {
        let Some(name) = &part.material else {
            let message = format!("{}: the mesh names no material: give it a modifier", title(primitive));
            return Err(at(primitive, message));
        };
        let outer = (!mesh.materials.is_empty()).then(|| std::mem::take(&mut self.names));
        let result = (mesh.materials.iter())
            .filter(|material| !matches!(material.kind.class, Class::Surface | Class::Volume))
            .try_for_each(|material| self.add(invocation.apply(material.clone())))
            .and_then(|()| self.parent(primitive, name));
        if let Some(outer) = outer {
            self.names = outer;
        }
        match result? {
            Reference::Named(Named::Modifier(id)) => self.check_chain(id, primitive).map(|()| id),
            Reference::Named(Named::Problem(problem)) => Err(self.raise(problem, primitive)),
            Reference::Void => {
                Err(at(primitive, format!("{}: a part of the mesh is void", title(primitive))))
            }
        }
    }

    fn count(&mut self, primitive: &Primitive, pieces: usize) -> Result<()> {
        self.compounds.pieces += pieces;
        if self.compounds.pieces <= MAX_PIECES {
            return Ok(());
        }
        let message = format!(
            "{}: instances and meshes make more than {MAX_PIECES} surfaces: is the scene copied too often?",
            title(primitive)
        );
        Err(at(primitive, message))
    }
}

/// File and placement of an instance or a mesh.
fn arguments(primitive: &Primitive) -> Result<(&str, Invocation)> {
    let Some(file) = primitive.strings.first().filter(|_| primitive.reals.is_empty()) else {
        let message = format!(
            "wrong number of arguments of {}: expected a file, a transform if it is to be moved, and no real arguments",
            title(primitive)
        );
        return Err(at(primitive, message));
    };
    let transform = trailing_transform(&primitive.strings[1..])
        .map_err(|message| at(primitive, format!("{}: bad transform: {message}", title(primitive))))?;
    let invocation = Invocation {
        transform,
        transform_args: primitive.strings[1..].to_vec(),
        prefix: Some(primitive.name.clone()),
        ..Invocation::default()
    };
    Ok((file, invocation))
}

fn at(primitive: &Primitive, message: String) -> Error {
    Error::input(primitive.location.clone(), message)
}

/// A file of an octree, found; its name may be relative.
fn found(source: &Source, options: &LoadOptions, user: &Primitive) -> Result<Source> {
    match source {
        Source::File(path) if !path.to_string_lossy().starts_with('!') => {
            let name = path.to_string_lossy();
            let path = options.find(&name, &options.base(), &user.directory, &user.location)?;
            // What is found without a folder is in the current one.
            Ok(Source::File(std::path::absolute(&path).unwrap_or(path)))
        }
        other => Ok(other.clone()),
    }
}

/// The vertices in world axes; no triangles yet.
fn placed(mesh: &MeshFile, transform: &Transform) -> Mesh {
    let turn = |n: &Vec3| transform.vector(*n).normalize_or_zero();
    Mesh {
        vertices: mesh.vertices.iter().map(|v| transform.point(*v)).collect(),
        normals: mesh.normals.iter().map(turn).collect(),
        local: mesh.local.clone().into(),
        triangles: Vec::new(),
    }
}

/// Those that have an area. Mirrored ones are turned round, so that their front stays the front.
fn triangles(part: &Part, vertices: &[Vec3], is_mirrored: bool) -> Vec<[u32; 3]> {
    let has_area = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|i| vertices[i as usize]);
        (b - a).cross(c - a).length_squared() > 0.0
    };
    let turn = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
    part.triangles.iter().filter(has_area).copied().map(turn).collect()
}
