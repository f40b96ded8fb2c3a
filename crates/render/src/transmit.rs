//! Shadow rays: what is left of the light on its way from an emitter, through any number of layers that let it pass straight.

use crate::World;
use crate::accel::Hit;
use crate::light::LightSample;
use crate::material::{Alternate, Arrival, Dielectric, EmitterKind, Inside, Material, Varying};
use crate::shapes::{COINCIDENT, Ray};
use crate::world::Seen;
use sunpeak_bsdf::PeakRule;
use sunpeak_core::{Rgb, Vec3};

/// Layers that are told apart on the fast way; more than that, refraction or coincident layers, and the ray is followed step by
/// step.
const FAST_LAYERS: usize = 8;

/// Steps after which a followed ray is given up.
pub(crate) const MAX_STEPS: usize = 1000;

/// Relative distance before the emitter at which a shadow ray ends.
const SHORT_OF_TARGET: f64 = 1e-9;

/// A crossing of the emitting object itself, relative distance before the sampled point, that is still that point.
const AT_TARGET: f64 = 1e-6;

/// Where a shadow ray goes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    distance: f64,
    object: Option<u32>,
    is_direct: bool,
    is_hidden_by_illum: bool,
    /// The source that a refracted ray must still point at.
    sun: Option<usize>,
}

impl Target {
    pub fn of(sample: &LightSample) -> Self {
        Self {
            distance: sample.distance,
            object: sample.object,
            is_direct: sample.is_direct,
            is_hidden_by_illum: sample.is_hidden_by_illum,
            sun: None,
        }
    }

    /// A sun: its light may come through solids of glass whose faces bend it back.
    pub fn sun(index: usize, sample: &LightSample) -> Self {
        Self { sun: Some(index), ..Self::of(sample) }
    }

    /// A point on the way to a light source, e.g. on a mirror.
    pub fn point(distance: f64, object: u32) -> Self {
        Self { distance, object: Some(object), is_direct: true, is_hidden_by_illum: false, sun: None }
    }
}

/// What arrives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transmitted {
    pub share: Rgb,
    /// Is this way left to shadow rays? (It was refracted, or passed a table's peak.)
    pub only_by_shadow_rays: bool,
}

impl Transmitted {
    const BLOCKED: Self = Self { share: Rgb::ZERO, only_by_shadow_rays: false };
    const CLEAR: Self = Self { share: Rgb::ONE, only_by_shadow_rays: false };

    pub fn is_blocked(&self) -> bool {
        self.share == Rgb::ZERO
    }

    fn times(self, share: Rgb, only_by_shadow_rays: bool) -> Self {
        Self {
            share: self.share * share,
            only_by_shadow_rays: self.only_by_shadow_rays || only_by_shadow_rays,
        }
    }
}

/// What one surface does to a shadow ray.
enum Pass<'w> {
    Straight(Rgb, bool),
    Refracted(&'w Dielectric),
}

impl World {
    /// Share of the light that comes through from the target to a place that is in these volumes.
    pub(crate) fn transmitted(&self, ray: &Ray, target: &Target, inside: &Inside) -> Transmitted {
        if self.has_volumes {
            return self.followed(*ray, target, *inside);
        }
        let (mut layers, mut result) = (None::<Layers>, Some(Transmitted::CLEAR));
        self.accel.each_crossing(ray, target.distance * (1.0 - SHORT_OF_TARGET), |hit| {
            if is_target(&hit, target) {
                return true;
            }
            // Mostly this is all.
            if self.object(&hit).is_wall {
                result = Some(Transmitted::BLOCKED);
                return false;
            }
            result = match (result, self.pass(&hit, ray, target)) {
                (_, Pass::Straight(share, _)) if share == Rgb::ZERO => Some(Transmitted::BLOCKED),
                (Some(so_far), Pass::Straight(share, only)) => {
                    match layers.get_or_insert_default().add(&hit) {
                        Layer::New => Some(so_far.times(share, only)),
                        Layer::Known => Some(so_far),
                        Layer::Coincident | Layer::TooMany => None,
                    }
                }
                _ => None,
            };
            result.is_some_and(|r| !r.is_blocked())
        });
        result.unwrap_or_else(|| self.followed(*ray, target, *inside))
    }

    /// The same, surface after surface, with refraction, mist and antimatter.
    fn followed(&self, mut ray: Ray, target: &Target, mut inside: Inside) -> Transmitted {
        let mut result = Transmitted::CLEAR;
        let end = target.distance * (1.0 - SHORT_OF_TARGET);
        let mut travelled = 0.0;
        let mut is_refracted = false;
        for _ in 0..MAX_STEPS {
            let rest = end - travelled;
            let is_on_the_way = |hit: &Hit| !is_target(&Hit { t: travelled + hit.t, ..*hit }, target);
            let hit = self.accel.closest(&ray, rest).filter(is_on_the_way);
            if let Some(air) = self.air(&inside) {
                result = result.times(air.transmittance(hit.map_or(rest, |hit| hit.t)), false);
            }
            let Some(hit) = hit else {
                let is_missed = is_refracted && self.distant.seen(ray.direction) != target.sun;
                return if is_missed { Transmitted::BLOCKED } else { result };
            };
            let point = ray.at(hit.t);
            travelled += hit.t;
            let mut arrival = self.arrival(&hit, &ray);
            if let Some(seen) = self.meet_volume(self.object(&hit), &mut arrival, &mut inside) {
                if !matches!(seen, Seen::Void) || result.is_blocked() {
                    return Transmitted::BLOCKED;
                }
                ray = Ray::past(point, ray.direction);
                continue;
            }
            match self.pass(&hit, &ray, target) {
                Pass::Straight(share, only) => {
                    result = result.times(share, only);
                    ray = Ray::past(point, ray.direction);
                }
                Pass::Refracted(solid) => {
                    let Some((direction, share)) = self.refracted(solid, &hit, &ray, target) else {
                        return Transmitted::BLOCKED;
                    };
                    result = result.times(share, true);
                    is_refracted = true;
                    ray = Ray::new(point, direction);
                }
            }
            if result.is_blocked() {
                return Transmitted::BLOCKED;
            }
        }
        Transmitted::BLOCKED
    }

    /// Only a sun is far enough away for a bent ray to reach it; its light is weakened inside the solid.
    fn refracted(&self, solid: &Dielectric, hit: &Hit, ray: &Ray, target: &Target) -> Option<(Vec3, Rgb)> {
        target.sun?;
        let arrival = self.arrival(hit, ray);
        let (direction, share) = solid.refract(&arrival)?;
        let before = solid.extinction_before(&arrival).map_or(Rgb::ONE, |e| (-e * hit.t).exp());
        Some((direction, before * share))
    }

    /// Is nothing at all before the target?
    pub(crate) fn is_clear(&self, ray: &Ray, target: &Target) -> bool {
        let mut is_clear = true;
        self.accel.each_crossing(ray, target.distance * (1.0 - SHORT_OF_TARGET), |hit| {
            is_clear &= is_target(&hit, target);
            is_clear
        });
        is_clear
    }

    /// Does an object let anything pass straight to the target, at a point? `None` if it bends it.
    pub(crate) fn lets_pass(
        &self,
        object: u32,
        point: Vec3,
        target: &Target,
        direction: Vec3,
    ) -> Option<bool> {
        match self.pass(&Hit { t: 0.0, object }, &Ray::new(point, direction), target) {
            Pass::Straight(share, _) => Some(share != Rgb::ZERO),
            Pass::Refracted(_) => None,
        }
    }

    fn pass(&self, hit: &Hit, ray: &Ray, target: &Target) -> Pass<'_> {
        if self.object(hit).is_wall {
            return Pass::Straight(Rgb::ZERO, false);
        }
        let arrival = self.arrival(hit, ray);
        self.pass_material(self.material(self.object(hit).material), &arrival, target)
    }

    fn pass_material<'w>(&'w self, material: &'w Material, arrival: &Arrival, target: &Target) -> Pass<'w> {
        match material {
            Material::Emitter(emitter) => match emitter.kind {
                EmitterKind::Illum { alternate } if !(target.is_hidden_by_illum && arrival.at_front()) => {
                    self.pass_alternate(alternate, arrival, target)
                }
                _ => Pass::Straight(Rgb::ZERO, false),
            },
            Material::Mirror(mirror) => match mirror.alternate {
                Some(alternate) => self.pass_alternate(alternate, arrival, target),
                None => Pass::Straight(Rgb::ZERO, false),
            },
            Material::Dielectric(solid) => Pass::Refracted(solid),
            Material::Varying(varying) => self.pass_varying(varying, arrival, target),
            // Sampled paths pass it as well where they come from the geometry's side.
            Material::Table(table) if table.thickness(arrival) != 0.0 => {
                let finds = table.rule != PeakRule::Split || table.is_passed(arrival, false);
                Pass::Straight(Rgb::ONE, !finds)
            }
            Material::Table(table) => Pass::Straight(table.straight(arrival, target.is_direct), true),
            material => Pass::Straight(material.straight(arrival, target.is_direct), false),
        }
    }

    /// The mean of what a mixture's materials let through straight.
    fn pass_varying(&self, varying: &Varying, arrival: &Arrival, target: &Target) -> Pass<'_> {
        let (mut sum, mut only_by_shadow_rays) = (Rgb::ZERO, false);
        varying.each(&arrival.ray_state(), &mut |share, id, modulation| {
            let pass = match id {
                None => Pass::Straight(Rgb::ONE, false),
                Some(id) => self.pass_material(self.material(id), &arrival.modulated(modulation), target),
            };
            if let Pass::Straight(passed, only) = pass {
                sum += passed * share;
                only_by_shadow_rays |= only;
            }
        });
        Pass::Straight(sum, only_by_shadow_rays)
    }

    fn pass_alternate(&self, alternate: Alternate, arrival: &Arrival, target: &Target) -> Pass<'_> {
        match alternate.map(|id| self.material(id)) {
            None => Pass::Straight(Rgb::ONE, false),
            // An alternate that shines stands in nobody's name: it is a light like any other and blocks.
            Some(Material::Emitter(_) | Material::Mirror(_)) => Pass::Straight(Rgb::ZERO, false),
            Some(material) => self.pass_material(material, arrival, target),
        }
    }
}

fn is_target(hit: &Hit, target: &Target) -> bool {
    target.object == Some(hit.object) && hit.t > target.distance * (1.0 - AT_TARGET)
}

/// The layers that a ray has passed, so that a crossing on the seam of two triangles counts once.
#[derive(Default)]
struct Layers {
    passed: [(u32, f64); FAST_LAYERS],
    count: usize,
}

enum Layer {
    New,
    /// The same surface again.
    Known,
    /// Another surface at the same place: only one of them counts.
    Coincident,
    TooMany,
}

impl Layers {
    fn add(&mut self, hit: &Hit) -> Layer {
        let is_here = |&&(_, t): &&(u32, f64)| (t - hit.t).abs() <= COINCIDENT;
        if let Some((object, _)) = self.passed[..self.count].iter().find(is_here) {
            return if *object == hit.object { Layer::Known } else { Layer::Coincident };
        }
        if self.count == FAST_LAYERS {
            return Layer::TooMany;
        }
        self.passed[self.count] = (hit.object, hit.t);
        self.count += 1;
        Layer::New
    }
}
