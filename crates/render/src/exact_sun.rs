//! Suns in pictures, exactly.
//!
//! The sun's disc covers a few pixels or less than one, and a straight chain to it (through glass, through peaks, by flat
//! mirrors) has no width: pixel samples would find it by luck, and glare grows with its luminance squared. So these chains are
//! worked out once for each sun, over its whole disc, and left out of the pixels' paths.
//!
//! Every flat mirroring surface orientation shows the sun in one more direction. For each such direction all chains of straight
//! passes and flat mirrors are followed, both ways at every pane, so reflections between parallel panes count as well.

use crate::World;
use crate::light::at_infinity;
use crate::material::{Arrival, Inside, Material};
use crate::shapes::Ray;
use crate::world::{Facing, Seen};
use sunpeak_core::{Cone, Rgb, Sampler, Vec3, luminance};
use sunpeak_scene::{Camera, ExactSource, View, ViewKind, disc_coverage};

/// Points of the disc at which chains are followed.
const DISC_SAMPLES: u64 = 1024;

/// Points that decide whether a disc is seen at all.
const PROBE_SAMPLES: u64 = 64;

/// Chains end when they carry less than this.
const SMALLEST_SHARE: f64 = 1e-6;

/// Surfaces that a chain may meet.
const MAX_SURFACES: u32 = 64;

/// Orientations of mirroring surfaces that are looked into; more are left to the pixels' samples.
const MAX_ORIENTATIONS: usize = 1024;

/// With at most so many orientations, suns are looked for by two mirrors of different orientation as well.
const MAX_PAIRED_ORIENTATIONS: usize = 12;

/// Orientations, and directions of suns, closer than this are one.
const SAME_DIRECTION: f64 = 1e-9;

/// A disc in the picture.
#[derive(Clone, Copy, Debug)]
struct Disc {
    /// Index of the source.
    source: usize,
    /// Directions from the eye.
    cone: Cone,
}

/// The suns of one picture.
#[derive(Debug, Default)]
pub(crate) struct ExactSuns {
    discs: Vec<Disc>,
    sources: Vec<ExactSource>,
}

impl ExactSuns {
    /// None for a parallel view, which has no eye point.
    pub fn find(world: &World, view: &View, width: usize, height: usize, seed: u64) -> Self {
        let mut found = Self::default();
        let Some(camera) = Camera::new(view).filter(|_| view.kind != ViewKind::Parallel) else {
            return found;
        };
        for (i, disc) in candidates(world).into_iter().enumerate() {
            let chains = Chains { world, camera: &camera, disc: &disc, seed: seed.wrapping_add(i as u64) };
            let Some((radiance, visible_fraction)) = chains.seen() else { continue };
            let (direction, solid_angle_sr) = (disc.cone.axis(), disc.cone.solid_angle());
            if disc_coverage(view, width, height, direction, solid_angle_sr).is_empty() {
                continue;
            }
            found.sources.push(ExactSource { direction, solid_angle_sr, radiance, visible_fraction });
            found.discs.push(disc);
        }
        found
    }

    /// Is source `index`, seen in this direction from the eye by a straight or mirrored chain, one of these?
    pub fn contain(&self, index: usize, direction: Vec3) -> bool {
        self.discs.iter().any(|disc| disc.source == index && disc.cone.contains(direction))
    }

    /// For the picture's header and pixels.
    pub fn sources(&self) -> Vec<ExactSource> {
        self.sources.clone()
    }
}

/// Directions in which suns may be seen: straight, by one mirror, by two.
fn candidates(world: &World) -> Vec<Disc> {
    let orientations = orientations(world);
    let mut discs: Vec<Disc> = Vec::new();
    for &source in world.distant.suns() {
        let sun = world.distant.get(source);
        let mut add = |direction: Vec3| {
            let is_known =
                |d: &Disc| d.source == source && d.cone.axis().distance(direction) < SAME_DIRECTION;
            if !discs.iter().any(is_known) {
                discs.push(Disc { source, cone: Cone::new(direction, sun.cone.angle_deg()) });
            }
        };
        add(sun.direction());
        let mirror = crate::material::reflect;
        orientations.iter().for_each(|&n| add(mirror(sun.direction(), n)));
        if orientations.len() <= MAX_PAIRED_ORIENTATIONS {
            let pairs = orientations.iter().flat_map(|&a| orientations.iter().map(move |&b| (a, b)));
            pairs.for_each(|(a, b)| add(mirror(mirror(sun.direction(), a), b)));
        }
    }
    discs
}

/// Normals of flat surfaces that mirror, each once; a normal and its opposite mirror alike.
fn orientations(world: &World) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = Vec::new();
    for object in &world.objects {
        let Facing::Flat(normal) = object.facing else { continue };
        let is_new = || !found.iter().any(|n| n.dot(normal).abs() > 1.0 - SAME_DIRECTION);
        if found.len() < MAX_ORIENTATIONS && mirrors(world, object.material) && is_new() {
            found.push(normal);
        }
    }
    found
}

/// Does the material, or what it shows to view rays instead, mirror?
fn mirrors(world: &World, id: crate::material::MaterialId) -> bool {
    use crate::material::EmitterKind::Illum;
    match world.material(id) {
        Material::Glass(_) | Material::Dielectric(_) => true,
        Material::Mirror(m) => m.alternate.flatten().is_none_or(|a| mirrors(world, a)),
        Material::Emitter(e) => matches!(e.kind, Illum { alternate: Some(a) } if mirrors(world, a)),
        Material::Ward(m) => m.is_polished(),
        Material::Wgmd(m) => m.is_polished(),
        Material::Varying(v) => v.materials().into_iter().any(|id| mirrors(world, id)),
        _ => false,
    }
}

/// The chains from the eye to one disc.
struct Chains<'a> {
    world: &'a World,
    camera: &'a Camera,
    disc: &'a Disc,
    seed: u64,
}

impl Chains<'_> {
    /// Mean radiance of what is seen of the disc, and the share of the disc that is seen; `None` if nothing is.
    fn seen(&self) -> Option<(Rgb, f64)> {
        let (_, probed) = self.sum(PROBE_SAMPLES);
        if probed == 0 {
            return None;
        }
        let (sum, count) = self.sum(DISC_SAMPLES);
        (count > 0).then(|| (sum / count as f64, count as f64 / DISC_SAMPLES as f64))
    }

    /// Sum over `samples` points of the disc, and the number of points that are seen.
    fn sum(&self, samples: u64) -> (Rgb, u64) {
        let mut sum = Rgb::ZERO;
        let mut count = 0;
        for i in 0..samples {
            let u = Sampler::new(self.seed, u64::MAX, i).next_2d();
            let direction = self.disc.cone.sample(u);
            let radiance = self.radiance(direction);
            if radiance != Rgb::ZERO {
                sum += radiance;
                count += 1;
            }
        }
        (sum, count)
    }

    fn radiance(&self, direction: Vec3) -> Rgb {
        let Some([x, y]) = self.camera.project(direction) else { return Rgb::ZERO };
        let Some(ray) = self.camera.ray(x, y) else { return Rgb::ZERO };
        let (reach, ray) = (ray.max_distance, Ray::new(ray.origin, direction));
        let inside = self.world.inside_at(&ray);
        self.followed(Chain { ray, reach, share: Rgb::ONE, surfaces: 0, inside })
    }

    /// Radiance of the sun at the ends of all chains that go on from here.
    fn followed(&self, chain: Chain) -> Rgb {
        let mut open = vec![chain];
        let mut sum = Rgb::ZERO;
        while let Some(mut chain) = open.pop() {
            let hit = self.world.accel.closest(&chain.ray, chain.reach);
            if let Some(air) = self.world.air(&chain.inside) {
                chain.share *= air.transmittance(hit.map_or(chain.reach, |hit| hit.t));
            }
            let Some(hit) = hit else {
                let is_sun = chain.reach.is_infinite()
                    && self.world.distant.seen(chain.ray.direction) == Some(self.disc.source);
                if is_sun {
                    let emitter = &self.world.distant.get(self.disc.source).emitter;
                    sum += chain.share * emitter.radiance(&at_infinity(chain.ray.direction));
                }
                continue;
            };
            let object = self.world.object(&hit);
            // Mixtures: the points of the disc are seen by many chains.
            let place = chain.ray.at(hit.t);
            let mut choose = || scattered(place);
            let inside = &mut chain.inside;
            let mut arrival = self.world.arrival(&hit, &chain.ray);
            let seen = self.world.meet(hit.object, &mut arrival, true, inside, &mut choose);
            match seen {
                Seen::Void => open.extend(chain.straight(&arrival, hit.t, Rgb::ONE)),
                Seen::Emitter(_) => {}
                Seen::Surface(material) => {
                    let scattering = material.scatter(&arrival, true);
                    open.extend(chain.straight(&arrival, hit.t, scattering.straight));
                    if matches!(object.facing, Facing::Flat(_)) {
                        open.extend(chain.mirrored(&arrival, scattering.mirrored));
                    }
                }
            }
        }
        sum
    }
}

/// A number in [0, 1) that looks random, of a place.
fn scattered(point: Vec3) -> f64 {
    (point.dot(Vec3::new(12.9898, 78.233, 37.719)) * 43_758.545_3).rem_euclid(1.0)
}

/// A chain that is being followed.
#[derive(Clone, Copy)]
struct Chain {
    ray: Ray,
    reach: f64,
    share: Rgb,
    surfaces: u32,
    inside: Inside,
}

impl Chain {
    fn straight(&self, arrival: &Arrival, distance: f64, share: Rgb) -> Option<Self> {
        let ray = Ray::past(arrival.point, self.ray.direction);
        self.onwards(ray, self.reach - distance, share)
    }

    fn mirrored(&self, arrival: &Arrival, share: Rgb) -> Option<Self> {
        let ray = Ray::new(arrival.point, arrival.mirrored());
        self.onwards(ray, f64::INFINITY, share)
    }

    fn onwards(&self, ray: Ray, reach: f64, share: Rgb) -> Option<Self> {
        let next = Self { ray, reach, share: self.share * share, surfaces: self.surfaces + 1, ..*self };
        (luminance(next.share) > SMALLEST_SHARE && next.surfaces < MAX_SURFACES).then_some(next)
    }
}
