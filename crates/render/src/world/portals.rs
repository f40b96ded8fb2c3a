//! Where light comes into a room: shades and windows, which are found, and what the caller names.

use super::World;
use crate::backlight::{is_opening, is_window};
use crate::guide::MAX_TRIANGLES;
use crate::shapes::{Polygon, Triangle};
use sunpeak_core::{Error, Result};
use sunpeak_scene::{ModifierId, Scene, Shape, Surface};

/// Of more pieces of glass than this windows are not looked for.
const MAX_PANES: usize = 64;

/// Of more holes in walls than this none is taken for an opening.
const MAX_HOLES: usize = 64;

/// What the caller has named.
pub(super) struct NamedPortals<'s> {
    names: Vec<Named<'s>>,
    pieces: Vec<Triangle>,
}

struct Named<'s> {
    name: &'s str,
    /// How many surfaces are meant, and how many pieces they have.
    surfaces: usize,
    pieces: usize,
}

impl<'s> NamedPortals<'s> {
    pub fn new(names: &'s [String]) -> Self {
        let names = names.iter().map(|name| Named { name, surfaces: 0, pieces: 0 }).collect();
        Self { names, pieces: Vec::new() }
    }

    /// Take in a surface that is meant, visible or not.
    pub fn add(&mut self, scene: &Scene, surface: &Surface) {
        let is_meant = |named: &&mut Named| {
            named.name == surface.name
                || modifiers(scene, surface).any(|id| scene.modifiers[id.0].name == named.name)
        };
        let mut meaning = self.names.iter_mut().filter(is_meant).peekable();
        if meaning.peek().is_none() {
            return;
        }
        let pieces = pieces(&surface.shape);
        for named in meaning {
            named.surfaces += 1;
            named.pieces += pieces.len();
        }
        self.pieces.extend(pieces);
    }

    /// With shades and windows that were found, and with openings if there is room for them. If even the former are too many to be looked
    /// at, what is named alone.
    ///
    /// # Errors
    /// A name that names nothing, nothing flat, or too much.
    pub fn with(
        self,
        found: impl Iterator<Item = Triangle>,
        openings: Vec<Triangle>,
    ) -> Result<Vec<Triangle>> {
        for Named { name, surfaces, pieces } in &self.names {
            if *surfaces == 0 {
                return Err(Error::value(format!("portal '{name}': no surface or modifier has this name")));
            }
            if *pieces == 0 {
                return Err(Error::value(format!(
                    "portal '{name}': it is no polygon or mesh that can be cut into triangles"
                )));
            }
        }
        if self.pieces.len() > MAX_TRIANGLES {
            return Err(Error::value(format!(
                "the portals have {} triangles, and paths can be sent to {MAX_TRIANGLES}: name a polygon that spans the opening (of \
                 modifier void it is invisible)",
                self.pieces.len()
            )));
        }
        let (mut all, named) = (self.pieces.clone(), self.pieces);
        let is_new = |piece: &Triangle| !named.iter().any(|known| known.0 == piece.0);
        all.extend(found.filter(is_new));
        if !named.is_empty() && all.len() > MAX_TRIANGLES {
            return Ok(named);
        }
        let openings: Vec<Triangle> = openings.into_iter().filter(is_new).collect();
        if all.len() + openings.len() <= MAX_TRIANGLES {
            all.extend(openings);
        }
        Ok(all)
    }
}

/// The modifier of a surface, its modifier, and so on.
fn modifiers<'s>(scene: &'s Scene, surface: &Surface) -> impl Iterator<Item = ModifierId> + 's {
    std::iter::successors(surface.modifier, |id| scene.modifiers[id.0].parent).take(scene.modifiers.len())
}

fn pieces(shape: &Shape) -> Vec<Triangle> {
    match shape {
        Shape::Polygon(vertices) if vertices.iter().all(|v| v.is_finite()) => {
            let polygon = Polygon::new(vertices.clone());
            polygon.and_then(|polygon| polygon.triangulate()).unwrap_or_default()
        }
        Shape::Mesh(mesh) => mesh
            .triangles
            .iter()
            .map(|corners| Triangle(corners.map(|i| mesh.vertices[i as usize])))
            .filter(|triangle| triangle.area() > 0.0)
            .collect(),
        _ => Vec::new(),
    }
}

/// Pieces of those panes that sky and ground come through into a room.
pub(super) fn windows(world: &World, panes: &[(u32, Triangle)]) -> Vec<Triangle> {
    if panes.len() > MAX_PANES || !may_have_portals(world) {
        return Vec::new();
    }
    let objects = panes.chunk_by(|a, b| a.0 == b.0);
    let pieces = objects.filter_map(|pieces| {
        let triangles: Vec<Triangle> = pieces.iter().map(|&(_, triangle)| triangle).collect();
        is_window(world, pieces[0].0, &triangles).then_some(triangles)
    });
    pieces.flatten().collect()
}

/// Pieces of those holes in walls that sky and ground come through into a room.
pub(super) fn openings(world: &World, holes: &[(u32, Vec<Triangle>)]) -> Vec<Triangle> {
    if holes.len() > MAX_HOLES || !may_have_portals(world) {
        return Vec::new();
    }
    let open = holes.iter().filter(|(object, hole)| is_opening(world, *object, hole));
    open.flat_map(|(_, hole)| hole.iter().copied()).collect()
}

fn may_have_portals(world: &World) -> bool {
    world.distant.has_dome() && !world.has_volumes
}
