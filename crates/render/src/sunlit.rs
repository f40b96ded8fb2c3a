//! Where the sun comes in: its patches on floors and walls, as lights for the rest of the room.
//!
//! A patch of sun is small and bright, and a path from elsewhere in the room finds it by luck. But where it lies is known: from a point of
//! a window or shade on along the sun's rays. So paths are tied to points of the patches, which are drawn evenly across the sun's
//! rays, besides finding them; both are weighed by their densities (Veach 1997, section 10: a light subpath of one bounce).

use crate::World;
use crate::accel::Hit;
use crate::guide::MAX_TRIANGLES;
use crate::integrator::{Integrator, Limits};
use crate::light::LightSample;
use crate::material::{Inside, Material};
use crate::shapes::{COINCIDENT, Ray, Triangle};
use crate::transmit::{MAX_STEPS, Target, Transmitted};
use crate::world::Seen;
use std::f64::consts::PI;
use sunpeak_core::{Frame, Sampler, Vec3, luminance, warp::cosine_hemisphere};

/// Rays that tell what the sun brings, and as many that look for the rest of the light.
const PROBES: u64 = 128;

/// Ties are worth their time where what surfaces in the room scatter of the sun is so large a part of all the light that comes in.
const LEAST_SHARE: f64 = 0.2;

/// Surfaces nearer to a portal than this, in edges of a square of its size, are no part of the room: reveals and slats, which paths meet
/// anyway where they look for the window.
const NEAR: f64 = 0.2;

/// So far before a portal [m] the rest of the light is looked for.
const BEFORE: f64 = 1e-3;

/// Random numbers of a ray of the sun.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    /// Portal and place in it.
    pub ray: [f64; 3],
    /// Which sun.
    pub sun: f64,
    /// Place on the sun's disc.
    pub disc: [f64; 2],
}

impl Drawn {
    pub fn new(sampler: &mut Sampler) -> Self {
        Self { ray: sampler.next_3d(), sun: sampler.next_1d(), disc: sampler.next_2d() }
    }
}

/// A ray of the sun through a portal, up to where it ends.
pub(crate) struct SunRay {
    pub sample: LightSample,
    /// Index of the portal, and the point where the ray passes it.
    portal: usize,
    start: Vec3,
    pub end: Vec3,
    /// What it ends on.
    pub object: u32,
    /// What is left of the light there.
    pub transmitted: Transmitted,
    /// Rays of the sun that end there, across their direction [1/m²].
    pub density: f64,
}

/// Streams of random numbers.
const SUN_PROBES: u64 = 1;
const REST_PROBES: u64 = 2;

/// With more suns than this a point of a patch is of little use.
const MAX_SUNS: usize = 4;

/// Windows and shades as suns see them.
#[derive(Debug)]
pub(crate) struct SunPatches {
    portals: Vec<Triangle>,
    /// Of each sun: its index, and the shares of rays that go through each portal.
    suns: Vec<(usize, Vec<f64>)>,
}

impl SunPatches {
    /// Behind windows and shades; `None` where no sun comes in, where there are too many, and where rays may be bent or set off on
    /// their way, so that a point does not tell which portals they have passed.
    pub fn new(world: &World, portals: &[Triangle]) -> Option<Self> {
        let turns = |material: &Material| match material {
            Material::Dielectric(_) | Material::Prism(_) => true,
            Material::Table(table) => table.is_proxy(),
            _ => false,
        };
        if portals.len() > MAX_TRIANGLES || world.has_volumes || world.materials.iter().any(turns) {
            return None;
        }
        let direction_of = |&sun: &usize| (sun, world.distant.get(sun).direction());
        let suns: Vec<_> = world.distant.suns().iter().map(direction_of).collect();
        let of_sun = |&(sun, direction): &(usize, Vec3)| {
            let areas: Vec<f64> = portals.iter().map(|portal| area_across(portal, direction)).collect();
            let whole: f64 = areas.iter().sum();
            (whole > 0.0).then(|| (sun, areas.iter().map(|area| area / whole).collect()))
        };
        let suns: Vec<_> = suns.iter().filter_map(of_sun).collect();
        (1..=MAX_SUNS).contains(&suns.len()).then(|| Self { portals: portals.to_vec(), suns })
    }

    /// Follow a ray of a sun from a portal inwards; `None` if it does not come there, ends nowhere, or is bent.
    pub fn follow(&self, world: &World, drawn: &Drawn) -> Option<SunRay> {
        let chosen = (drawn.sun * self.suns.len() as f64) as usize;
        let (sun, shares) = &self.suns[chosen.min(self.suns.len() - 1)];
        let sample = world.distant.sample_sun(*sun, drawn.disc)?;
        let [choice, u, v] = drawn.ray;
        let portal = pick(shares, choice)?;
        let start = Triangle::sample([u, v], self.portals[portal].0);
        let target = Target::sun(*sun, &sample);
        let (end, object) = end_of(world, start, &target, -sample.direction)?;
        let transmitted = world.transmitted(&Ray::new(end, sample.direction), &target, &Inside::default());
        let density = self.density(*sun, end, sample.direction);
        (!transmitted.is_blocked()).then_some(SunRay {
            sample,
            portal,
            start,
            end,
            object,
            transmitted,
            density,
        })
    }

    /// Density of the rays through a point, across their direction, which goes to this sun [1/m²]: all portals that they have come
    /// through.
    pub fn density(&self, sun: usize, point: Vec3, direction: Vec3) -> f64 {
        let Some(shares) = self.shares(sun) else { return 0.0 };
        let ray = Ray::new(point, direction);
        let of_portal = |(portal, share): (&Triangle, &f64)| {
            let t = portal.crossing(&ray);
            let area = area_across(portal, direction);
            if t > COINCIDENT && t.is_finite() && area > 0.0 { share / area } else { 0.0 }
        };
        self.portals.iter().zip(shares).map(of_portal).sum::<f64>() / self.suns.len() as f64
    }

    /// Does what surfaces in the room scatter of the sun count beside all other light that comes in?
    pub fn count(&self, world: &World) -> bool {
        let mut scattered = 0.0;
        for i in 0..PROBES {
            let mut sampler = Sampler::new(0, SUN_PROBES, i);
            scattered += self.scattered(world, &Drawn::new(&mut sampler), &mut sampler);
        }
        if scattered <= 0.0 {
            return false;
        }
        let integrator = Integrator { world, limits: Limits::NONE, exact_suns: None };
        let rest: f64 =
            (0..PROBES).map(|i| self.rest(&integrator, &mut Sampler::new(0, REST_PROBES, i))).sum();
        scattered > LEAST_SHARE * (scattered + rest)
    }

    /// Flux [W] that a ray of the sun brings to a surface in the room and that is scattered there.
    fn scattered(&self, world: &World, drawn: &Drawn, sampler: &mut Sampler) -> f64 {
        let Some(ray) = self.follow(world, drawn) else { return 0.0 };
        if ray.start.distance(ray.end) < NEAR * self.portals[ray.portal].area_vector().length().sqrt() {
            return 0.0;
        }
        let inwards = Ray::new(ray.start, -ray.sample.direction);
        let hit = Hit { t: ray.start.distance(ray.end), object: ray.object };
        let mut choose = || sampler.next_1d();
        let mut arrival = world.arrival(&hit, &inwards);
        let seen = world.meet(ray.object, &mut arrival, false, &mut Inside::default(), &mut choose);
        let Seen::Surface(material) = seen else { return 0.0 };
        let albedo = material.scatter(&arrival, false).smooth.albedo();
        let radiance = luminance(world.distant.radiance(&ray.sample) * ray.transmitted.share);
        if ray.density > 0.0 { albedo * radiance / (ray.sample.pdf * ray.density) } else { 0.0 }
    }

    /// Flux [W] that comes in otherwise, by a ray that looks out of a portal: towards the side of the first sun.
    fn rest(&self, integrator: &Integrator, sampler: &mut Sampler) -> f64 {
        let world = integrator.world;
        let areas: Vec<f64> = self.portals.iter().map(|portal| portal.area_vector().length()).collect();
        let whole: f64 = areas.iter().sum();
        let [choice, u, v] = sampler.next_3d();
        let Some(portal) = pick(&areas, choice * whole) else { return 0.0 };
        let triangle = &self.portals[portal];
        let normal = triangle.area_vector().normalize();
        let to_sun = world.distant.get(self.suns[0].0).direction();
        let outwards = if normal.dot(to_sun) > 0.0 { normal } else { -normal };
        let direction = Frame::from_normal(outwards).to_world(cosine_hemisphere(sampler.next_2d()));
        let is_sun = world.distant.seen(direction).is_some_and(|seen| world.distant.suns().contains(&seen));
        if is_sun {
            return 0.0;
        }
        let ray = Ray::new(Triangle::sample([u, v], triangle.0) - BEFORE * outwards, direction);
        PI * whole * luminance(integrator.radiance(ray, f64::INFINITY, sampler))
    }

    fn shares(&self, sun: usize) -> Option<&Vec<f64>> {
        self.suns.iter().find(|(index, _)| *index == sun).map(|(_, shares)| shares)
    }
}

/// Where a ray of the sun that sets out from a point ends, and on what: it passes what lets anything pass to the target.
fn end_of(world: &World, start: Vec3, target: &Target, inwards: Vec3) -> Option<(Vec3, u32)> {
    let mut end = start;
    for _ in 0..MAX_STEPS {
        let ray = Ray::past(end, inwards);
        let hit = world.accel.closest(&ray, f64::INFINITY)?;
        end = ray.at(hit.t);
        if !world.lets_pass(hit.object, end, target, -inwards)? {
            return Some((end, hit.object));
        }
    }
    None
}

/// The index of the weight that a number between zero and their sum falls into.
fn pick(weights: &[f64], mut at: f64) -> Option<usize> {
    weights.iter().position(|weight| {
        at -= weight;
        at < 0.0
    })
}

/// Area across a direction [m²].
fn area_across(portal: &Triangle, direction: Vec3) -> f64 {
    portal.area_vector().dot(direction).abs()
}
