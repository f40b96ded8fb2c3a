//! What rays meet first: distances, places, normals, for depth pictures and for sensors on surfaces.

use crate::accel::Hit;
use crate::shapes::Ray;
use crate::world::{Facing, Seen};
use crate::{World, material::Arrival, material::EmitterKind, material::Material};
use rayon::prelude::*;
use sunpeak_core::{Error, Result, Rgb, Vec3};

/// The surface that a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstSurface {
    /// From the ray's origin [m], infinity for a `source`.
    pub distance: f64,
    /// Where it is met; of a `source` nowhere (NaN), and its normals face the ray.
    pub point: Vec3,
    /// Unit normal of the surface's front, as a mesh smooths it.
    pub normal: Vec3,
    /// The same without smoothing.
    pub flat_normal: Vec3,
    /// The normal as textures and smoothing bend it, on the ray's side where the material scatters on both sides alike.
    pub bent_normal: Vec3,
    /// Local coordinates of a mesh; zero of other surfaces.
    pub local: [f64; 2],
    /// Index in [`Scene::surfaces`](sunpeak_scene::Scene::surfaces).
    pub surface: usize,
}

/// What the surface that a ray meets first mirrors and lets through straight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstDeltas {
    /// Where it is met.
    pub point: Vec3,
    /// Share that is mirrored.
    pub mirrored: Rgb,
    /// Unit direction in which.
    pub mirrored_direction: Vec3,
    /// Share that goes straight on.
    pub straight: Rgb,
    /// Is it a plane pane, mirror or face of a solid, which shows things at their distance?
    pub is_plane_glass: bool,
}

/// The first surface along each ray, given by origin and direction (of any length), or the `source` that it sees; `None` where there is
/// none. An `illum` without anything to see instead is passed, as by a view ray.
///
/// # Errors
/// A ray that is not finite or has no direction.
pub fn first_surfaces(world: &World, rays: &[(Vec3, Vec3)]) -> Result<Vec<Option<FirstSurface>>> {
    each(rays, |ray| first_surface(world, ray))
}

/// What the first surface along each ray mirrors and lets through, as [`first_surfaces`] meets it; `None` where there is none, or one that
/// shines. Of a mixture of materials the larger share counts.
///
/// # Errors
/// A ray that is not finite or has no direction.
pub fn first_deltas(world: &World, rays: &[(Vec3, Vec3)]) -> Result<Vec<Option<FirstDeltas>>> {
    each(rays, |ray| deltas(world, ray))
}

fn each<T: Send>(rays: &[(Vec3, Vec3)], find: impl Fn(Ray) -> Option<T> + Sync) -> Result<Vec<Option<T>>> {
    let found = |(i, &(origin, towards)): (usize, &(Vec3, Vec3))| match towards.try_normalize() {
        Some(direction) if origin.is_finite() => Ok(find(Ray::new(origin, direction))),
        _ => Err(Error::value(format!(
            "ray {i} at {origin} has direction {towards}: not a place and a direction"
        ))),
    };
    rays.par_iter().enumerate().map(found).collect()
}

/// The hit, and the last part of the ray.
fn first_hit(world: &World, ray: Ray) -> Option<(Hit, Ray)> {
    let mut segment = ray;
    loop {
        let hit = world.accel.closest(&segment, f64::INFINITY)?;
        let is_invisible = matches!(world.material(world.object(&hit).material), Material::Emitter(emitter)
            if matches!(emitter.kind, EmitterKind::Illum { alternate: None }));
        if !is_invisible {
            return Some((hit, segment));
        }
        segment = Ray::past(segment.at(hit.t), ray.direction);
    }
}

fn first_surface(world: &World, ray: Ray) -> Option<FirstSurface> {
    let Some((hit, segment)) = first_hit(world, ray) else { return first_source(world, ray.direction) };
    let (seen, arrival) = seen(world, &hit, &segment);
    Some(FirstSurface {
        distance: arrival.point.distance(ray.origin),
        point: arrival.point,
        normal: world.arrival(&hit, &segment).normal,
        flat_normal: arrival.flat_normal,
        bent_normal: bent_normal(&seen, &arrival),
        local: arrival.local,
        surface: world.surfaces[hit.object as usize] as usize,
    })
}

fn first_source(world: &World, direction: Vec3) -> Option<FirstSurface> {
    let source = world.distant.get(world.distant.seen(direction)?);
    Some(FirstSurface {
        distance: f64::INFINITY,
        point: Vec3::NAN,
        normal: -direction,
        flat_normal: -direction,
        bent_normal: -direction,
        local: [0.0; 2],
        surface: source.surface as usize,
    })
}

/// As a view ray sees it; of a mixture of materials the larger share.
fn seen<'w>(world: &'w World, hit: &Hit, ray: &Ray) -> (Seen<'w>, Arrival) {
    let mut inside = world.inside_at(ray);
    let mut arrival = world.arrival(hit, ray);
    (world.meet(hit.object, &mut arrival, true, &mut inside, &mut || 0.5), arrival)
}

/// Radiance turns the normal to the ray where a surface scatters; solids of glass keep it, mirrors and what shines have a front only.
fn bent_normal(seen: &Seen<'_>, arrival: &Arrival) -> Vec3 {
    match seen {
        Seen::Surface(Material::Dielectric(_)) => arrival.normal,
        Seen::Surface(Material::Mirror(_)) | Seen::Emitter(_) if arrival.at_front() => arrival.normal,
        Seen::Surface(Material::Mirror(_)) | Seen::Emitter(_) | Seen::Void => arrival.flat_normal,
        Seen::Surface(_) => arrival.facing_normal(),
    }
}

fn deltas(world: &World, ray: Ray) -> Option<FirstDeltas> {
    let (hit, segment) = first_hit(world, ray)?;
    let (seen, arrival) = seen(world, &hit, &segment);
    let Seen::Surface(material) = seen else { return None };
    let is_plane = matches!(world.object(&hit).facing, Facing::Flat(_)) && arrival.bend == Vec3::ZERO;
    let is_glass = matches!(material, Material::Glass(_) | Material::Mirror(_) | Material::Dielectric(_));
    let scattering = material.scatter(&arrival, true);
    Some(FirstDeltas {
        point: arrival.point,
        mirrored: scattering.mirrored,
        mirrored_direction: arrival.mirrored(),
        straight: scattering.straight,
        is_plane_glass: is_plane && is_glass,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_scene::{LoadOptions, Scene};

    #[test]
    fn a_ray_meets_the_nearest_surface_with_its_front_normal() {
        let text = "void plastic white 0 0 5 .5 .5 .5 0 0\nvoid illum seen 0 0 3 1 1 1\n\
                    white polygon floor 0 0 12 0 0 0 4 0 0 4 4 0 0 4 0\nwhite sphere ball 0 0 4 2 2 5 1\n\
                    seen polygon veil 0 0 12 0 0 2 4 0 2 4 4 2 0 4 2";
        let scene = Scene::parse(text, "t.rad", &LoadOptions::default()).expect("a scene");
        let world = World::compile(&scene, &Default::default()).expect("a world");
        let at = Vec3::new(2.0, 2.0, 3.0);
        let rays = [(at, -2.0 * Vec3::Z), (at, Vec3::Z), (at, Vec3::X)];
        let found = first_surfaces(&world, &rays).expect("rays");
        let floor = found[0].expect("the floor");
        assert_eq!((floor.distance, floor.normal, floor.surface), (3.0, Vec3::Z, 0));
        let ball = found[1].expect("the ball");
        assert!((ball.distance - 1.0).abs() < 1e-12 && ball.normal.distance(-Vec3::Z) < 1e-12);
        assert_eq!((ball.surface, found[2]), (1, None));
        let scene = Scene::parse(
            &format!("{text}\nseen source sky 0 0 4 0 0 1 180"),
            "t.rad",
            &LoadOptions::default(),
        );
        let world = World::compile(&scene.expect("a scene"), &Default::default()).expect("a world");
        let sky = first_surfaces(&world, &[(at, Vec3::X)]).expect("rays")[0].expect("the sky");
        assert_eq!((sky.distance, sky.surface), (f64::INFINITY, 3));
        assert!(first_surfaces(&world, &[(at, Vec3::ZERO)]).is_err());
    }
}
