//! Light of patches of sun: the vertices of a path are tied to a point where the sun comes in (see [`crate::sunlit`]).

use super::path::{Departure, Path};
use super::{Integrator, Met};
use crate::accel::Hit;
use crate::guide::GuideAt;
use crate::light::{LightSample, power_heuristic};
use crate::shapes::Ray;
use crate::sunlit::{Drawn, SunPatches};
use crate::transmit::{Target, Transmitted};
use crate::world::Seen;
use std::cell::OnceCell;
use sunpeak_core::{Rgb, Sampler, Vec3};

/// The point that all vertices of a path are tied to: followed when the first of them asks.
pub(super) struct Tie<'w> {
    drawn: Option<Drawn>,
    lit: OnceCell<Option<Lit<'w>>>,
}

/// A point where a ray of the sun ends.
struct Lit<'w> {
    point: Vec3,
    object: u32,
    /// Rays of the sun that end here, across their direction [1/m²].
    density: f64,
    sample: LightSample,
    transmitted: Transmitted,
    guide: Option<GuideAt<'w>>,
}

impl<'w> Integrator<'w> {
    /// For a new path.
    pub(super) fn tie(&self, sampler: &mut Sampler) -> Tie<'w> {
        let patches = self.world.sun_patches.as_ref().filter(|_| self.limits.max_bounces.is_none());
        let drawn = patches.map(|_| Drawn::new(sampler));
        Tie { drawn, lit: OnceCell::new() }
    }

    /// Are paths that leave this point tied to patches of sun?
    pub(super) fn is_tied(&self, met: &Met) -> bool {
        self.world.sun_patches.is_some() && self.limits.max_bounces.is_none() && met.guide.is_some()
    }

    /// Sunlight that one more surface scatters to this one.
    pub(super) fn light_of_patches(
        &self,
        path: &Path,
        met: &Met,
        tie: &Tie<'w>,
        sampler: &mut Sampler,
    ) -> Rgb {
        let (true, Some(patches), Some(drawn)) = (self.is_tied(met), &self.world.sun_patches, &tie.drawn)
        else {
            return Rgb::ZERO;
        };
        let Some(lit) = tie.lit.get_or_init(|| self.follow_sun(patches, drawn)) else { return Rgb::ZERO };
        let receiver = self.receiver(path, met);
        let origin = met.arrival.point;
        let way = lit.point - origin;
        let distance = way.length();
        let direction = way / distance;
        if distance <= 0.0 || !met.arrival.agrees_on(direction) {
            return Rgb::ZERO;
        }
        let value = receiver.smooth.evaluate(direction).total() * receiver.cosine(direction);
        if value == Rgb::ZERO {
            return Rgb::ZERO;
        }
        let (ray, hit) = (Ray::new(origin, direction), Hit { t: distance, object: lit.object });
        let mut onward = *path;
        let departure = Departure { point: origin, pdf: 0.0, source_factor: 1.0, is_tied: true };
        onward.depart(departure, direction, Rgb::ONE);
        let mut choose = || sampler.next_1d();
        let (seen, arrival) =
            self.world.meet(&hit, &ray, false, &mut onward.inside, [0.0, path.way()[1]], &mut choose);
        let Seen::Surface(material) = seen else { return Rgb::ZERO };
        let facing = arrival.flat_normal.dot(direction).abs();
        let lit_cosine = arrival.flat_normal.dot(lit.sample.direction).abs();
        let pdf = lit.density * lit_cosine * distance * distance / facing;
        let other = Met::guided_by(self.world, &hit, material, arrival, false, |_| lit.guide.clone());
        if pdf.is_nan() || pdf <= 0.0 || other.smooth_share() <= 0.0 {
            return Rgb::ZERO;
        }
        let sunlit = self.receiver(&onward, &other);
        let towards_sun = sunlit.smooth_value(&lit.sample);
        if towards_sun.total() == Rgb::ZERO
            || !other.arrival.agrees_on(lit.sample.direction)
            || !self.world.is_clear(&ray, &Target::point(distance, lit.object))
        {
            return Rgb::ZERO;
        }
        let found = self.received_through(&sunlit, &lit.sample, &towards_sun, &lit.transmitted);
        let weight = power_heuristic(pdf, receiver.share * receiver.pdf(direction));
        value * found * (weight / pdf)
    }

    /// Follow a ray of a sun inwards.
    fn follow_sun(&self, patches: &SunPatches, drawn: &Drawn) -> Option<Lit<'w>> {
        let ray = patches.follow(self.world, drawn)?;
        let sun = Ray::new(ray.end, ray.sample.direction);
        let transmitted =
            self.world.transmitted(&sun, &Target::sun(ray.sun, &ray.sample), self.world.inside_at(&sun));
        if transmitted.is_blocked() {
            return None;
        }
        Some(Lit {
            point: ray.end,
            object: ray.object,
            density: patches.density(ray.sun, ray.end, ray.sample.direction),
            sample: ray.sample,
            transmitted,
            guide: self.world.guide.as_ref().map(|guide| guide.at(ray.end)),
        })
    }

    /// Weight of a sun's light at a surface that a path has met, against ties to this point from where the path comes from.
    pub(super) fn weight_against_ties(
        &self,
        path: &Path,
        met: &Met,
        sun: usize,
        sample: &LightSample,
    ) -> f64 {
        let (Some(patches), Some(departure)) = (&self.world.sun_patches, path.departure) else { return 1.0 };
        let Some(object) = met.object.filter(|_| departure.is_tied && path.is_clear) else { return 1.0 };
        let point = met.arrival.point;
        let density = patches.density(sun, point, sample.direction);
        if density <= 0.0
            || self.world.lets_pass(object, point, &Target::sun(sun, sample), sample.direction) != Some(false)
        {
            return 1.0;
        }
        let lit_cosine = met.arrival.flat_normal.dot(sample.direction).abs();
        let facing = met.arrival.flat_normal.dot(path.ray.direction).abs();
        let pdf = density * lit_cosine * departure.point.distance_squared(point) / facing;
        power_heuristic(departure.pdf, pdf)
    }
}
