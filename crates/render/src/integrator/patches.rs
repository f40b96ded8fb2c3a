//! Light of patches of sun: the vertices of a path are tied to a point where the sun comes in (see [`crate::sunlit`]).

use super::direct::Receiver;
use super::path::Path;
use super::{Integrator, Met};
use crate::accel::Hit;
use crate::guide::GuideAt;
use crate::light::{LightSample, power_heuristic};
use crate::material::{Arrival, Inside, Lobes};
use crate::shapes::Ray;
use crate::sunlit::{Drawn, SunPatches, SunRay};
use crate::transmit::Target;
use crate::world::Seen;
use std::cell::OnceCell;
use sunpeak_core::{Rgb, Sampler};

/// The point that all vertices of a path are tied to: followed when the first of them asks.
pub(super) struct Tie<'w> {
    drawn: Option<Drawn>,
    lit: OnceCell<Option<Lit<'w>>>,
}

/// A point where a ray of the sun ends, and the guide as seen from there.
struct Lit<'w> {
    ray: SunRay,
    guide: Option<GuideAt<'w>>,
}

impl<'w> Integrator<'w> {
    /// For a new path.
    pub(super) fn tie(&self, sampler: &mut Sampler) -> Tie<'w> {
        Tie { drawn: self.patches().map(|_| Drawn::new(sampler)), lit: OnceCell::new() }
    }

    /// Are paths that leave this point tied to patches of sun?
    pub(super) fn is_tied<L: Lobes>(&self, met: &Met<L>) -> bool {
        met.guide.is_some() && self.patches().is_some()
    }

    /// Limited paths are not tied.
    fn patches(&self) -> Option<&'w SunPatches> {
        self.world.sun_patches.as_ref().filter(|_| self.limits.max_bounces.is_none())
    }

    /// Sunlight that one more surface scatters to this one.
    pub(super) fn light_of_patches<L: Lobes>(
        &self,
        met: &Met<L>,
        receiver: &Receiver<L>,
        tie: &Tie<'w>,
        sampler: &mut Sampler,
    ) -> Rgb {
        let (Some(patches), Some(drawn), Some(_)) = (self.patches(), &tie.drawn, &met.guide) else {
            return Rgb::ZERO;
        };
        let follow = || {
            let ray = patches.follow(self.world, drawn)?;
            let guide = self.world.guide.as_ref().map(|guide| guide.at(ray.end, false));
            Some(Lit { ray, guide })
        };
        let Some(lit) = tie.lit.get_or_init(follow) else { return Rgb::ZERO };
        let origin = met.arrival.point;
        let way = lit.ray.end - origin;
        let distance = way.length();
        let direction = way / distance;
        if distance <= 0.0 || !met.agrees_on(direction) {
            return Rgb::ZERO;
        }
        let (value, own) = receiver.met.lobes.evaluate_with_pdf(direction);
        let value = value.total() * receiver.cosine(direction);
        if value == Rgb::ZERO {
            return Rgb::ZERO;
        }
        let (ray, hit) = (Ray::new(origin, direction), Hit { t: distance, object: lit.ray.object });
        let way = [0.0, met.arrival.travelled];
        let (found, pdf) = if let Some((normal, plain)) = self.world.plain(&hit) {
            let arrival = Arrival::new(ray.at(hit.t), normal, direction).after(way.map(|way| way + hit.t));
            let lobes = plain.at(&arrival);
            self.light_of_lit(lit, &ray, distance, &Met::of_lobes(&arrival, &lobes, lit.guide.as_ref()))
        } else {
            let mut arrival = self.world.arrival_after(way, &hit, &ray);
            let mut choose = || sampler.next_1d();
            // There are no volumes where there are patches.
            let mut inside = Inside::default();
            let seen = self.world.meet(hit.object, &mut arrival, false, &mut inside, &mut choose);
            let Seen::Surface(material) = seen else { return Rgb::ZERO };
            let scattering = material.scatter(&arrival, false);
            let guide = lit.guide.as_ref().filter(|_| scattering.smooth.can_be_guided());
            let other = Met::new(self.world, &hit, material, &arrival, &scattering, guide);
            self.light_of_lit(lit, &ray, distance, &other)
        };
        if found == Rgb::ZERO {
            return found;
        }
        let weight = power_heuristic(pdf, receiver.met.smooth_share * receiver.pdf_with(own, direction));
        value * found * (weight / pdf)
    }

    /// What the lit surface scatters back along a ray that meets it at a distance, if nothing stands between, and the density [1/sr] of
    /// meeting it there by a tie.
    fn light_of_lit<L: Lobes>(&self, lit: &Lit, ray: &Ray, distance: f64, other: &Met<L>) -> (Rgb, f64) {
        let (arrival, sample) = (other.arrival, &lit.ray.sample);
        let facing = arrival.flat_normal.dot(ray.direction).abs();
        let lit_cosine = arrival.flat_normal.dot(sample.direction).abs();
        let pdf = lit.ray.density * lit_cosine * distance * distance / facing;
        if pdf.is_nan() || pdf <= 0.0 || other.smooth_share <= 0.0 {
            return (Rgb::ZERO, pdf);
        }
        let inside = Inside::default();
        let sunlit = Receiver { met: other, is_last: false, inside: &inside };
        let towards_sun = sunlit.smooth_value(sample);
        if towards_sun.total() == Rgb::ZERO
            || !other.agrees_on(sample.direction)
            || !self.world.is_clear(ray, &Target::point(distance, lit.ray.object))
        {
            return (Rgb::ZERO, pdf);
        }
        (self.received_through(&sunlit, sample, &towards_sun, &lit.ray.transmitted), pdf)
    }

    /// Weight of a sun's light at a surface that a path has met, against ties to this point from where the path comes from.
    pub(super) fn weight_against_ties<L: Lobes>(
        &self,
        path: &Path,
        met: &Met<L>,
        sun: usize,
        sample: &LightSample,
    ) -> f64 {
        let (Some(patches), Some(departure)) = (self.patches(), path.departure) else { return 1.0 };
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
