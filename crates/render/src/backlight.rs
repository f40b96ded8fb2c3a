//! Shades before a far field: what they give off, known beforehand.
//!
//! Where a shade hangs in a window, most of what it scatters into the room comes from sky and ground straight through panes that
//! depend on direction alone. Of such a far field the shade's radiance is an integral over the table ([`Backlit`]), and paths need only
//! add what differs from it: a path estimates the true light less the far field's, with the same directions for both, so that
//! where nothing stands in the way the difference is zero. The far field is a control variate: whatever stands outside, nothing
//! is biased (Owen 2013, "Monte Carlo theory, methods and examples", section 8.9) but by the table's own quadrature.

use crate::World;
use crate::material::{Arrival, Material, MaterialId};
use crate::shapes::{Ray, Triangle};
use crate::world::{Facing, Object};
use std::collections::{BTreeMap, HashMap};
use sunpeak_bsdf::Backlit;
use sunpeak_core::{Frame, Rgb, Sampler, Vec3, luminance, warp};

/// Ways that are probed from each side of a shade.
const PROBES: u64 = 256;

/// A side is lit by the far field if so large a share of it comes through, by light. Of less, what differs from it is noisier than the
/// light itself.
const LEAST_SHARE: f64 = 0.6;

/// Panes that a probe passes.
const MAX_PANES: usize = 8;

/// Outside of a window at least this share of the far field's light comes through, straight and by the same panes. (Terrain hides the lower
/// half, whose share is large where the sun shines on the ground.)
const LEAST_SHARE_OUTSIDE: f64 = 0.2;

/// Inside of a window is where so much less of it comes.
const INSIDE_TO_OUTSIDE: f64 = 0.5;

/// Before a hole stands something if most rays meet it within so much of the hole's size (the edge of a square as large): what fills it, a
/// panel set back, the floor over an excavation.
const NEAR_A_HOLE: f64 = 0.2;

/// Rays that look for that start so far behind the hole, over its size, that they see what lies in its plane.
const BEHIND_A_HOLE: f64 = 1e-3;

/// The far field behind one side of a shade, and what the shade gives off on the other.
#[derive(Debug)]
pub(crate) struct Backlight {
    from: From,
    backlit: Backlit,
}

/// What makes backlights differ.
#[derive(Debug, PartialEq)]
struct From {
    shade: MaterialId,
    normal: Vec3,
    /// Is it for rays that meet the front? They see what comes from behind.
    at_front: bool,
    /// Panes between the shade and the field: material and normal.
    panes: Vec<Pane>,
}

type Pane = (MaterialId, Vec3);

/// Of each object: its backlights, as rays meet it at the front and at the back.
#[derive(Debug, Default)]
pub(crate) struct Backlights {
    found: Vec<Backlight>,
    of_objects: HashMap<u32, [Option<usize>; 2]>,
}

impl Backlights {
    /// Find them; `shades` are the flat pieces of surfaces with a table.
    pub fn find(world: &World, shades: &[(u32, Triangle)]) -> Self {
        let mut all = Self::default();
        if !world.distant.has_dome() || world.has_volumes {
            return all;
        }
        let mut pieces: BTreeMap<u32, Vec<Triangle>> = BTreeMap::new();
        for &(object, triangle) in shades {
            pieces.entry(object).or_default().push(triangle);
        }
        for (object, triangles) in pieces {
            let sides = [true, false].map(|at_front| all.find_side(world, object, &triangles, at_front));
            if sides != [None; 2] {
                all.of_objects.insert(object, sides);
            }
        }
        all
    }

    fn find_side(
        &mut self,
        world: &World,
        object: u32,
        triangles: &[Triangle],
        at_front: bool,
    ) -> Option<usize> {
        let Object { material: shade, facing: Facing::Flat(normal), .. } = world.objects[object as usize]
        else {
            return None;
        };
        let Material::Table(table) = world.material(shade) else { return None };
        if table.is_proxy() || table.is_reference_rule() {
            return None;
        }
        let (share, panes) = probe(world, object, triangles, if at_front { -normal } else { normal });
        if share < LEAST_SHARE {
            return None;
        }
        let from = From { shade, normal, at_front, panes };
        if let Some(index) = self.found.iter().position(|known| known.from == from) {
            return Some(index);
        }
        let backlit = table.backlit(normal, at_front, |direction| {
            let sky = world.distant.dome_radiance(direction);
            sky * from.passed(world, direction)
        })?;
        self.found.push(Backlight { from, backlit });
        Some(self.found.len() - 1)
    }

    /// That of an object as a ray meets it.
    pub fn of(&self, object: u32, at_front: bool) -> Option<&Backlight> {
        if self.found.is_empty() {
            return None;
        }
        let sides = self.of_objects.get(&object)?;
        sides[usize::from(!at_front)].map(|index| &self.found[index])
    }
}

impl Backlight {
    /// Radiance that the shade scatters towards `w_in` (frame of the BSDF).
    pub fn radiance(&self, w_in: Vec3) -> Rgb {
        self.backlit.radiance(w_in)
    }

    /// Radiance of the far field in a direction in which the sky has radiance `sky`; zero on the near side.
    pub fn field(&self, world: &World, direction: Vec3, sky: Rgb) -> Rgb {
        let is_behind = (direction.dot(self.from.normal) < 0.0) == self.from.at_front;
        if is_behind && sky != Rgb::ZERO { sky * self.from.passed(world, direction) } else { Rgb::ZERO }
    }
}

impl From {
    /// Share that the panes let pass.
    fn passed(&self, world: &World, direction: Vec3) -> Rgb {
        let share = |&(id, normal): &Pane| {
            world.material(id).straight(&Arrival::new(Vec3::ZERO, normal, direction), false)
        };
        self.panes.iter().map(share).product()
    }
}

/// Is a flat piece of glass a window: the far field on one side, a room on the other, and no shade or other pane close to it there?
pub(crate) fn is_window(world: &World, object: u32, triangles: &[Triangle]) -> bool {
    let Some((inside, _)) = room_side(world, object, triangles) else { return false };
    !is_veiled(world, object, triangles, inside)
}

/// Is a hole of a wall an opening: the far field on one side, and on the other a room, with nothing between?
pub(crate) fn is_opening(world: &World, object: u32, hole: &[Triangle]) -> bool {
    let Some((inside, panes)) = room_side(world, object, hole) else { return false };
    let size = hole.iter().map(Triangle::area).sum::<f64>().sqrt();
    let is_covered = |i: &u64| {
        let (point, direction) = probing_ray(object, hole, inside, *i);
        let ray = Ray::new(point - inside * (BEHIND_A_HOLE * size), direction);
        world.accel.closest(&ray, NEAR_A_HOLE * size).is_some()
    };
    panes.is_empty()
        && (0..PROBES).filter(is_covered).count() < PROBES as usize / 2
        && !is_veiled(world, object, hole, inside)
}

/// To which side of a flat piece of glass, or of a hole, the room lies, if the far field is on the other; and the panes before that.
fn room_side(world: &World, object: u32, triangles: &[Triangle]) -> Option<(Vec3, Vec<Pane>)> {
    let Facing::Flat(normal) = world.objects[object as usize].facing else { return None };
    let [(front, before), (back, behind)] =
        [normal, -normal].map(|away| probe(world, object, triangles, away));
    let (inside, panes, outer, inner) =
        if front > back { (-normal, before, front, back) } else { (normal, behind, back, front) };
    (outer >= LEAST_SHARE_OUTSIDE && inner <= INSIDE_TO_OUTSIDE * outer).then_some((inside, panes))
}

/// Is there a shade or a pane close by on this side?
fn is_veiled(world: &World, object: u32, triangles: &[Triangle], inside: Vec3) -> bool {
    let first = |i| {
        let (point, direction) = probing_ray(object, triangles, inside, i);
        world.accel.closest(&Ray::new(point, direction), f64::INFINITY)
    };
    let is_met = |i: &u64| {
        let material = first(*i).map(|hit| world.material(world.object(&hit).material));
        matches!(material, Some(Material::Table(_) | Material::Glass(_)))
    };
    (0..PROBES).filter(is_met).count() >= PROBES as usize / 2
}

/// A ray from a point of a surface.
fn probing_ray(object: u32, triangles: &[Triangle], away: Vec3, i: u64) -> (Vec3, Vec3) {
    let mut sampler = Sampler::new(0, u64::from(object), i);
    let at = (sampler.next_1d() * triangles.len() as f64) as usize;
    let point = Triangle::sample(sampler.next_2d(), triangles[at.min(triangles.len() - 1)].0);
    (point, Frame::from_normal(away).to_world(warp::cosine_hemisphere(sampler.next_2d())))
}

/// The panes by which most of the far field's light comes to a surface, and what share of it.
fn probe(world: &World, object: u32, triangles: &[Triangle], away: Vec3) -> (f64, Vec<Pane>) {
    let mut whole = 0.0;
    let mut found: Vec<(f64, Vec<Pane>)> = Vec::new();
    for i in 0..PROBES {
        let (point, direction) = probing_ray(object, triangles, away, i);
        let light = luminance(world.distant.dome_radiance(direction));
        whole += light;
        let Some(panes) = panes_passed(world, point, direction) else { continue };
        match found.iter_mut().find(|(_, known)| *known == panes) {
            Some((sum, _)) => *sum += light,
            None => found.push((light, panes)),
        }
    }
    match found.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((light, panes)) if whole > 0.0 => (light / whole, panes),
        _ => (0.0, Vec::new()),
    }
}

/// The flat panes between a point and infinity; `None` if anything else is in the way.
fn panes_passed(world: &World, point: Vec3, direction: Vec3) -> Option<Vec<Pane>> {
    let mut ray = Ray::new(point, direction);
    let mut panes = Vec::new();
    loop {
        let Some(hit) = world.accel.closest(&ray, f64::INFINITY) else { return Some(panes) };
        let object = world.object(&hit);
        let Facing::Flat(normal) = object.facing else { return None };
        let is_pane = matches!(world.material(object.material), Material::Glass(_));
        if !is_pane || panes.len() == MAX_PANES {
            return None;
        }
        panes.push((object.material, normal));
        ray = Ray::past(ray.at(hit.t), direction);
    }
}
