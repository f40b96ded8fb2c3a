//! Light that arrives from emitters: by shadow rays, and by paths that meet them.

use super::{Integrator, Met, path::Path};
use crate::accel::Hit;
use crate::light::{LightSample, at_infinity, power_heuristic};
use crate::material::{Arrival, Emitter, Inside, Lobes, Smooth, SmoothValue, reflect};
use crate::shapes::Ray;
use crate::transmit::{Target, Transmitted};
use crate::world::{Facing, Object};
use glam::DQuat;
use sunpeak_core::{Rgb, Sampler, Vec3};
use sunpeak_scene::RayState;

/// Up to so many pairs of sun and mirror are all tried at every vertex; of more, one at random.
const ALL_REFLECTED_SUNS: usize = 4;

impl Integrator<'_> {
    /// Light from emitters that the smooth lobes scatter back along the path.
    pub(super) fn direct<L: Lobes>(
        &self,
        path: &Path,
        met: &Met<L>,
        receiver: &Receiver<L>,
        sampler: &mut Sampler,
    ) -> Rgb {
        let sky = self.world.distant.draw_sky(sampler);
        self.direct_from_suns(path, met, receiver, sampler)
            + self.direct_from_others(met, receiver, sky, sampler)
    }

    pub(super) fn receiver<'a, 'w, L: Lobes>(
        &self,
        path: &'a Path,
        met: &'a Met<'a, 'w, L>,
    ) -> Receiver<'a, 'w, L> {
        Receiver { met, is_last: self.is_last(path), inside: &path.inside }
    }

    /// The part from suns, and what a shade gives off in the light of a far field.
    pub(super) fn direct_from_suns<L: Lobes>(
        &self,
        path: &Path,
        met: &Met<L>,
        receiver: &Receiver<L>,
        sampler: &mut Sampler,
    ) -> Rgb {
        let mut sum = match (met.backlight(), met.others().map(|scattering| &scattering.smooth)) {
            (Some(backlight), Some(Smooth::Table(lobes))) => lobes.backlit(backlight),
            _ => Rgb::ZERO,
        };
        let one_sided = receiver.met.lobes.one_sided();
        for &sun in self.world.distant.suns() {
            // Random numbers are for suns that light: of a plane surface the same ones in all samples.
            if one_sided.is_some_and(|normal| self.world.distant.get(sun).cone.is_behind(normal)) {
                continue;
            }
            if let Some(sample) = self.world.distant.sample_sun(sun, sampler.next_2d()) {
                let found = self.received(receiver, &sample, &Target::sun(sun, &sample));
                if found != Rgb::ZERO {
                    sum += found * self.weight_against_ties(path, met, sun, &sample);
                }
            }
        }
        sum += self.suns_in_mirrors(receiver, sampler);
        if !self.world.prisms.is_empty() {
            sum += self.suns_through_prisms(receiver, sampler);
        }
        sum
    }

    /// The part from sky and ground, in the direction that was drawn, and from lamps, less what of it is known.
    pub(super) fn direct_from_others<L: Lobes>(
        &self,
        met: &Met<L>,
        receiver: &Receiver<L>,
        sky: Option<LightSample>,
        sampler: &mut Sampler,
    ) -> Rgb {
        let mut sum = Rgb::ZERO;
        if let Some(sample) = sky {
            sum += self.received(receiver, &sample, &Target::of(&sample));
        }
        if self.world.lamps.is_empty() {
            return sum;
        }
        // Both sides of what has thickness look for lamps, each from where its own light starts.
        for origin in met.origins() {
            let sample = self.world.lamps.sample(origin, sampler.next_1d(), sampler.next_2d());
            if let Some(sample) = sample.filter(|s| receiver.origin(s.direction) == origin) {
                sum += self.received(receiver, &sample, &Target::of(&sample));
            }
        }
        sum
    }

    /// May no diffuse bounce follow?
    pub(super) fn is_last(&self, path: &Path) -> bool {
        self.limits.max_bounces.is_some_and(|limit| path.bounces >= limit)
    }

    #[inline(always)]
    fn received<L: Lobes>(&self, receiver: &Receiver<L>, sample: &LightSample, target: &Target) -> Rgb {
        let value = receiver.smooth_value(sample);
        if value.total() == Rgb::ZERO || sample.light.is_none() {
            return Rgb::ZERO;
        }
        if !receiver.met.agrees_on(sample.direction) {
            return Rgb::ZERO;
        }
        let ray = Ray::new(receiver.origin(sample.direction), sample.direction);
        let transmitted = self.world.transmitted(&ray, target, receiver.inside);
        self.received_through(receiver, sample, &value, &transmitted)
    }

    /// The same where it is known what comes through.
    pub(super) fn received_through<L: Lobes>(
        &self,
        receiver: &Receiver<L>,
        sample: &LightSample,
        value: &SmoothValue,
        transmitted: &Transmitted,
    ) -> Rgb {
        let is_known = receiver.met.backlight().is_some() && sample.is_dome;
        if transmitted.is_blocked() && !is_known {
            return Rgb::ZERO;
        }
        let radiance = self.world.distant.radiance(sample);
        let known = self.known_dome_light(receiver, sample, radiance, value);
        if transmitted.is_blocked() || radiance == Rgb::ZERO {
            return -known;
        }
        let finds = !transmitted.only_by_shadow_rays
            && (!sample.is_direct || receiver.met.lobes.samples_find_sources());
        let other = if finds { receiver.met.smooth_share * receiver.pdf(sample.direction) } else { 0.0 };
        let weight = power_heuristic(sample.pdf, other);
        // Past the last bounce no sampled path finds what a diffuse lobe gets from a light source; from the sky it gets none.
        let diffuse_weight = match (receiver.is_last, sample.is_direct) {
            (false, _) => weight,
            (true, true) => 1.0,
            (true, false) => 0.0,
        };
        let scattered = value.diffuse * diffuse_weight + value.glossy * weight;
        scattered * radiance * transmitted.share * (receiver.cosine(sample.direction) / sample.pdf) - known
    }

    /// What the sample would bring in the far field, which the shade's radiance holds already.
    fn known_dome_light<L: Lobes>(
        &self,
        receiver: &Receiver<L>,
        sample: &LightSample,
        radiance: Rgb,
        value: &SmoothValue,
    ) -> Rgb {
        let Some(backlight) = receiver.met.backlight().filter(|_| sample.is_dome) else { return Rgb::ZERO };
        let field = backlight.field(self.world, sample.direction, radiance);
        if field == Rgb::ZERO {
            return field;
        }
        let weight = power_heuristic(sample.pdf, receiver.met.smooth_share * receiver.pdf(sample.direction));
        value.glossy * field * (weight * receiver.cosine(sample.direction) / sample.pdf)
    }

    /// Suns reflected by planar mirrors: Radiance's virtual sources. Sampled paths leave them out.
    fn suns_in_mirrors<L: Lobes>(&self, receiver: &Receiver<L>, sampler: &mut Sampler) -> Rgb {
        let (suns, mirrors) = (self.world.distant.suns(), &self.world.mirrors);
        let pairs = suns.len() * mirrors.len();
        let pair = |i: usize| (suns[i / mirrors.len()], mirrors[i % mirrors.len()]);
        if pairs <= ALL_REFLECTED_SUNS {
            return (0..pairs).map(|i| self.sun_in_mirror(receiver, pair(i), sampler.next_2d())).sum();
        }
        let chosen = ((sampler.next_1d() * pairs as f64) as usize).min(pairs - 1);
        self.sun_in_mirror(receiver, pair(chosen), sampler.next_2d()) * pairs as f64
    }

    fn sun_in_mirror<L: Lobes>(
        &self,
        receiver: &Receiver<L>,
        (sun, mirror): (usize, u32),
        u: [f64; 2],
    ) -> Rgb {
        let world = self.world;
        let Some(sample) = world.distant.sample_sun(sun, u) else { return Rgb::ZERO };
        let Facing::Flat(normal) = world.objects[mirror as usize].facing else { return Rgb::ZERO };
        if sample.direction.dot(normal) <= 0.0 {
            return Rgb::ZERO;
        }
        let direction = reflect(sample.direction, normal);
        let ray = Ray::new(receiver.origin(direction), direction);
        let Some(hit) = world.accel.crossing_of(&ray, mirror) else { return Rgb::ZERO };
        let value = receiver.smooth_value(&LightSample { direction: ray.direction, ..sample });
        if value.total() == Rgb::ZERO {
            return Rgb::ZERO;
        }
        let to_mirror = world.transmitted(&ray, &Target::point(hit, mirror), receiver.inside);
        if to_mirror.is_blocked() {
            return Rgb::ZERO;
        }
        let onwards = Ray::new(ray.at(hit), sample.direction);
        let to_sun = world.transmitted(&onwards, &Target::sun(sun, &sample), &world.inside_at(&onwards));
        let reflectance = world.mirror_reflectance(&Hit { t: hit, object: mirror }, &ray);
        let factor = receiver.cosine(ray.direction) / sample.pdf;
        value.total()
            * world.distant.radiance(&sample)
            * to_mirror.share
            * reflectance
            * to_sun.share
            * factor
    }

    /// Suns that prisms send in another direction: virtual sources too.
    fn suns_through_prisms<L: Lobes>(&self, receiver: &Receiver<L>, sampler: &mut Sampler) -> Rgb {
        let mut sum = Rgb::ZERO;
        for &sun in self.world.distant.suns() {
            for &(object, place) in &self.world.prisms {
                for way in 0..self.world.prism(object).map_or(0, |prism| prism.ways) {
                    sum += self.sun_through_prism(receiver, sun, (object, place), way, sampler.next_2d());
                }
            }
        }
        sum
    }

    fn sun_through_prism<L: Lobes>(
        &self,
        receiver: &Receiver<L>,
        sun: usize,
        (object, place): (u32, Vec3),
        way: usize,
        u: [f64; 2],
    ) -> Rgb {
        let world = self.world;
        let (Some(prism), Some(sample)) = (world.prism(object), world.distant.sample_sun(sun, u)) else {
            return Rgb::ZERO;
        };
        let Facing::Flat(normal) = world.objects[object as usize].facing else { return Rgb::ZERO };
        // Where the sun's light goes behind the prism: from there the sun is seen.
        let center = world.distant.get(sun).direction();
        let light = RayState::new(place, normal, -center, 0.0);
        let Some((_, leaving)) = prism.way(way, &light, Vec3::ZERO) else { return Rgb::ZERO };
        let direction = DQuat::from_rotation_arc(center, -leaving) * sample.direction;
        let ray = Ray::new(receiver.origin(direction), direction);
        let Some(hit) = world.accel.crossing_of(&ray, object) else { return Rgb::ZERO };
        let value = receiver.smooth_value(&LightSample { direction, ..sample });
        if value.total() == Rgb::ZERO || !receiver.met.agrees_on(direction) {
            return Rgb::ZERO;
        }
        let met = RayState::new(ray.at(hit), normal, direction, hit);
        let Some((share, onwards)) = prism.way(way, &met, center) else { return Rgb::ZERO };
        if world.distant.seen(onwards) != Some(sun) {
            return Rgb::ZERO;
        }
        let to_prism = world.transmitted(&ray, &Target::point(hit, object), receiver.inside);
        if to_prism.is_blocked() {
            return Rgb::ZERO;
        }
        let onwards = Ray::new(ray.at(hit), onwards);
        let to_sun = world.transmitted(&onwards, &Target::sun(sun, &sample), &world.inside_at(&onwards));
        let factor = share * receiver.cosine(direction) / sample.pdf;
        value.total() * world.distant.radiance(&sample) * to_prism.share * to_sun.share * factor
    }

    /// What a path that meets nothing finds at infinity.
    pub(super) fn light_from_infinity(&self, path: &Path) -> Rgb {
        if path.reach.is_finite() {
            return Rgb::ZERO;
        }
        let direction = path.ray.direction;
        let Some(index) = self.world.distant.seen(direction) else { return Rgb::ZERO };
        let source = self.world.distant.get(index);
        if source.is_small() && self.is_small_source_left_out(path, index) {
            return Rgb::ZERO;
        }
        let shadow_pdf = || self.world.distant.pdf(index, direction);
        source.emitter.radiance(&at_infinity(direction))
            * weight(path, &source.emitter, f64::INFINITY, shadow_pdf)
    }

    /// Suns are not left to chance: behind a mirror or a solid of glass that a scattered path met they are found by
    /// virtual sources or not at all; in a picture they are put in exactly.
    fn is_small_source_left_out(&self, path: &Path, index: usize) -> bool {
        match path.departure {
            Some(_) => path.is_bent,
            None => {
                let exact = self.exact_suns.filter(|_| !path.is_distorted);
                exact.is_some_and(|suns| suns.contain(index, path.first_direction))
            }
        }
    }

    /// What a path finds at an emitting surface.
    pub(super) fn light_from_lamp(
        &self,
        path: &Path,
        object: &Object,
        arrival: &Arrival,
        emitter: &Emitter,
    ) -> Rgb {
        if !arrival.at_front() {
            return Rgb::ZERO;
        }
        let direction = path.ray.direction;
        let radiance = emitter.radiance(&arrival.ray_state()) * arrival.tint;
        let Some(departure) = path.departure else { return radiance };
        let distance = departure.point.distance(arrival.point);
        let shadow_pdf = || {
            object.lamp.map_or(0.0, |lamp| {
                self.world.lamps.pdf(lamp as usize, departure.point, direction, distance, arrival.normal)
            })
        };
        radiance * (emitter.falloff(distance) * weight(path, emitter, distance, shadow_pdf))
    }
}

/// Weight of an emitter that a path has met, against shadow rays to it from the last vertex.
fn weight(path: &Path, emitter: &Emitter, distance: f64, shadow_pdf: impl Fn() -> f64) -> f64 {
    let Some(departure) = path.departure else { return 1.0 };
    if !emitter.illuminates() {
        return 0.0;
    }
    let factor = if emitter.is_direct(distance) { departure.source_factor } else { 1.0 };
    if path.is_bent {
        return factor;
    }
    let shadow_pdf = shadow_pdf();
    if path.is_past_peak && shadow_pdf > 0.0 {
        return 0.0;
    }
    factor * power_heuristic(departure.pdf, shadow_pdf)
}

/// Where light is received.
pub(super) struct Receiver<'a, 'w, L> {
    pub met: &'a Met<'a, 'w, L>,
    /// May no diffuse bounce follow?
    pub is_last: bool,
    /// Mist and antimatter around.
    pub inside: &'a Inside,
}

impl<L: Lobes> Receiver<'_, '_, L> {
    pub fn smooth_value(&self, sample: &LightSample) -> SmoothValue {
        if sample.is_direct {
            self.met.lobes.toward_source(sample.direction, sample.solid_angle)
        } else {
            self.met.lobes.evaluate(sample.direction)
        }
    }

    /// Density [1/sr] with which paths go on in this direction, if they go on by the smooth lobes.
    pub fn pdf(&self, direction: Vec3) -> f64 {
        self.pdf_with(self.met.lobes.pdf(direction), direction)
    }

    /// The same where the lobes' own density is known.
    pub fn pdf_with(&self, own: f64, direction: Vec3) -> f64 {
        match self.met.guide {
            Some(guide) => guide.rates.own * own + guide.pdf(direction),
            None => own,
        }
    }

    pub fn cosine(&self, direction: Vec3) -> f64 {
        self.met.lobes.cosine(direction, self.met.arrival.normal)
    }

    /// Where light from this direction arrives.
    fn origin(&self, direction: Vec3) -> Vec3 {
        self.met.arrival.point + self.met.lobes.offset(direction)
    }
}
