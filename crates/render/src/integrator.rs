//! Unbiased path tracing with next-event estimation and multiple importance sampling.
//!
//! Straight passes are null events. They do not end a path segment: the last scattering vertex keeps its density, and a source
//! met behind any number of layers is weighed against the shadow ray that passed the same layers. Only on chains that are
//! straight or mirrored all the way from the camera does a source count in full.

mod direct;
mod patches;
mod path;

use crate::accel::Hit;
use crate::backlight::Backlight;
use crate::exact_sun::ExactSuns;
use crate::guide::GuideAt;
use crate::light::power_heuristic;
use crate::material::{Arrival, Flight, Lobes, Material, Scattering, Smooth, SmoothSample};
use crate::shapes::Ray;
use crate::world::{Facing, Seen};
use crate::{RenderOptions, World};
use direct::Receiver;
use patches::Tie;
use path::{Departure, Path};
use sunpeak_core::{Frame, Rgb, Sampler, Vec3, luminance};

/// Russian roulette begins when a path carries less than this, and brings the paths that survive back to it. Higher, and paths
/// that have come far are ended just before they meet the sky; lower, and they bounce on for nothing. (Time times variance in
/// docs/light-transport.md.)
const ROULETTE_BELOW: f64 = 0.02;

/// Share of scattered paths that meet a shade before a far field and look for what differs from that.
const CORRECTED: f64 = 0.3;

/// Past so many events the chance of survival is never above the ceiling, so that paths in lossless rooms end.
const ROULETTE_ALWAYS: u32 = 32;
const ROULETTE_CEILING: f64 = 0.95;

/// Limits of a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    pub max_bounces: Option<u32>,
    /// Radiance of all that lies past the last diffuse bounce.
    pub ambient: Rgb,
    pub max_depth: u32,
}

impl Limits {
    /// A path may be as long as it likes.
    pub const NONE: Self = Self { max_bounces: None, ambient: Rgb::ZERO, max_depth: u32::MAX };

    pub fn of(options: &RenderOptions) -> Self {
        Self { max_bounces: options.max_bounces, ambient: options.ambient, max_depth: options.max_depth }
    }
}

/// Estimates radiance along rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integrator<'w> {
    pub world: &'w World,
    pub limits: Limits,
    /// Suns that are put into the picture by other means, and are not to be seen by straight or mirrored chains.
    pub exact_suns: Option<&'w ExactSuns>,
}

impl<'w> Integrator<'w> {
    /// Radiance that arrives along the ray from surfaces before `reach` (and from infinity if that is infinite).
    pub fn radiance(&self, ray: Ray, reach: f64, sampler: &mut Sampler) -> Rgb {
        let inside = self.world.inside_at(&ray);
        let tie = self.tie(sampler);
        self.trace(Some(Path::from_camera(ray, reach, inside)), room_for_branches(), &tie, sampler)
    }

    /// Irradiance [W/m²] on the front of a surface element.
    pub fn irradiance(&self, point: Vec3, normal: Vec3, sampler: &mut Sampler) -> Rgb {
        let arrival = Arrival::new(point, normal, -normal);
        let smooth = Smooth::Sensor(Frame::from_normal(normal));
        let guide = guide_of(self.world, &smooth, point, true);
        let sensor = Met::of_lobes(&arrival, &smooth, guide.as_ref());
        let ray = Ray::new(point, -normal);
        let mut path = Path::from_camera(ray, f64::INFINITY, self.world.inside_at(&ray));
        let mut branches = room_for_branches();
        let tie = self.tie(sampler);
        let receiver = self.receiver(&path, &sensor);
        let direct = self.direct(&path, &sensor, &receiver, sampler)
            + self.light_of_patches(&sensor, &receiver, &tie, sampler);
        let goes_on = self.scatter(&mut path, &sensor, None, &mut branches, sampler);
        let past_last_bounce = path.ambient;
        let first = if goes_on { Some(path) } else { branches.pop() };
        direct + past_last_bounce + self.trace(first, branches, &tie, sampler)
    }

    /// Follow a path and all that branch off.
    fn trace(
        &self,
        first: Option<Path>,
        mut branches: Vec<Path>,
        tie: &Tie<'w>,
        sampler: &mut Sampler,
    ) -> Rgb {
        let (mut next, mut sum) = (first, Rgb::ZERO);
        while let Some(path) = &mut next {
            path.ambient = Rgb::ZERO;
            sum += self.follow(path, &mut branches, tie, sampler) + path.ambient;
            next = branches.pop();
        }
        sum
    }

    /// Follow a path to its end; where the camera sees straight through a surface that does something else too, the straight chain
    /// is put among the `branches`.
    fn follow(&self, path: &mut Path, branches: &mut Vec<Path>, tie: &Tie<'w>, sampler: &mut Sampler) -> Rgb {
        let mut sum = Rgb::ZERO;
        while path.events <= self.limits.max_depth {
            let hit = self.world.accel.closest(&path.ray, path.reach);
            if let Some(air) = self.world.air(&path.inside) {
                let length = hit.map_or(path.reach, |hit| hit.t);
                match air.fly(path.throughput, length, sampler.next_1d(), sampler.next_1d()) {
                    Flight::Through(share) => path.throughput *= share,
                    Flight::Scattered(distance, share) => {
                        path.throughput *= share;
                        let direction = path.ray.direction;
                        let arrival = Arrival::new(path.ray.at(distance), -direction, direction);
                        let smooth = Smooth::Phase(air.phase(direction));
                        let met = Met::of_lobes(&arrival, &smooth, None);
                        path.travel(distance);
                        let receiver = self.receiver(path, &met);
                        sum += path.throughput * self.direct(path, &met, &receiver, sampler);
                        if !self.scatter(path, &met, None, branches, sampler) || !survives(path, sampler) {
                            return sum;
                        }
                        continue;
                    }
                }
            }
            let Some(hit) = hit else {
                return sum + path.throughput * self.light_from_infinity(path);
            };
            if let Some((normal, plain)) = self.world.plain(&hit) {
                path.travel(hit.t);
                let arrival = Arrival::new(path.ray.at(hit.t), normal, path.ray.direction).after(path.way());
                let lobes = plain.at(&arrival);
                let seen_from_here;
                let mut met = Met { object: Some(hit.object), ..Met::of_lobes(&arrival, &lobes, None) };
                if let Some(guide) = &self.world.guide {
                    seen_from_here = guide.at(arrival.point, path.is_view());
                    met.guide = Some(&seen_from_here);
                }
                let (found, goes_on) = self.vertex(path, &met, branches, tie, sampler);
                sum += found;
                if !goes_on {
                    return sum;
                }
                continue;
            }
            let object = self.world.object(&hit);
            let view = path.is_view();
            let mut arrival = self.world.arrival_after(path.way(), &hit, &path.ray);
            let mut choose = || sampler.next_1d();
            let seen = self.world.meet(hit.object, &mut arrival, view, &mut path.inside, &mut choose);
            path.travel(hit.t);
            match seen {
                Seen::Void => path.go_straight(arrival.point, Rgb::ONE),
                Seen::Emitter(emitter) => {
                    return sum + path.throughput * self.light_from_lamp(path, object, &arrival, emitter);
                }
                Seen::Surface(material) => {
                    path.absorb(material, &arrival, hit.t);
                    let scattering = material.scatter(&arrival, view);
                    let guide = guide_of(self.world, &scattering.smooth, arrival.point, view);
                    let mut met = Met::new(self.world, &hit, material, &arrival, &scattering, guide.as_ref());
                    if let Some(chain) = met.split_straight(path) {
                        branches.push(chain);
                    }
                    let (found, goes_on) = self.vertex(path, &met, branches, tie, sampler);
                    sum += found;
                    if !goes_on {
                        return sum;
                    }
                }
            }
        }
        sum
    }

    /// The light that a surface scatters back along the path from emitters, and whether the path goes on from there.
    fn vertex<L: Lobes>(
        &self,
        path: &mut Path,
        met: &Met<L>,
        branches: &mut Vec<Path>,
        tie: &Tie<'w>,
        sampler: &mut Sampler,
    ) -> (Rgb, bool) {
        let mut sum = Rgb::ZERO;
        let mut onwards = None;
        if met.smooth_share > 0.0 {
            let receiver = Receiver { met, is_last: self.is_last(path), inside: &path.inside };
            // Most of the shade's light is known; the rest, seldom looked for, counts the more.
            let is_known = met.backlight().is_some() && !path.is_view();
            let looks_for_rest = !is_known || sampler.next_1d() < CORRECTED;
            // Directions are drawn before the first ray is followed: the processor finds them side by side.
            let sky = if looks_for_rest { self.world.distant.draw_sky(sampler) } else { None };
            let guide = met.guide.filter(|_| met.others().is_none());
            onwards = guide.map(|guide| Onwards::draw(met, guide, path.is_view(), sampler));
            sum += path.throughput * self.direct_from_suns(path, met, &receiver, sampler);
            if !looks_for_rest {
                return (sum, false);
            }
            if is_known {
                path.throughput /= CORRECTED;
            }
            sum += path.throughput * self.direct_from_others(met, &receiver, sky, sampler);
            sum += path.throughput * self.light_of_patches(met, &receiver, tie, sampler);
        }
        if !self.go_on(path, met, onwards, branches, sampler) || !survives(path, sampler) {
            return (sum, false);
        }
        // Only with a path that goes on: it finds in the mean what is taken off here.
        if path.is_known {
            sum -= path.take_known();
        }
        (sum, true)
    }

    /// Choose one of the ways on; `false` if the path ends here.
    fn go_on<L: Lobes>(
        &self,
        path: &mut Path,
        met: &Met<L>,
        onwards: Option<Onwards>,
        branches: &mut Vec<Path>,
        sampler: &mut Sampler,
    ) -> bool {
        let Some(scattering) = met.others() else {
            return self.scatter(path, met, onwards, branches, sampler);
        };
        let [straight, mirrored, refracted, smooth] = met.shares;
        let whole = straight + mirrored + refracted + smooth;
        if whole <= 0.0 {
            return false;
        }
        if whole == smooth {
            // No choice, no random number.
            return self.scatter(path, met, onwards, branches, sampler);
        }
        let choice = sampler.next_1d() * whole;
        if choice < straight {
            met.go_straight(path, scattering, whole / straight);
        } else if choice < straight + mirrored {
            path.mirror(met.arrival, scattering.mirrored * (whole / mirrored), met.is_flat);
        } else if choice < straight + mirrored + refracted {
            let [first, second] = scattering.refracted;
            let of_first = first.map_or(0.0, |(_, share)| luminance(share));
            let is_first = choice - straight - mirrored < of_first;
            let Some((direction, share)) = (if is_first { first } else { second }) else { return false };
            path.refract(met.arrival, direction, share * (whole / luminance(share)), met.material);
        } else {
            return self.scatter(path, met, onwards, branches, sampler);
        }
        true
    }

    /// Go on by the smooth lobes, and where the guide points: the first time each way, the others as `branches`, later one way of all.
    /// Directions are drawn now if they have not been before.
    fn scatter<L: Lobes>(
        &self,
        path: &mut Path,
        met: &Met<L>,
        onwards: Option<Onwards>,
        branches: &mut Vec<Path>,
        sampler: &mut Sampler,
    ) -> bool {
        let Some(guide) = met.guide else {
            return met.lobes.draw(sampler).is_some_and(|sample| self.leave(path, met, &sample, sampler));
        };
        let go = |path: &mut Path, direction: Option<Vec3>, sampler: &mut Sampler| {
            let sample = direction.and_then(|direction| mixed(met, guide, direction));
            sample.is_some_and(|sample| self.leave(path, met, &sample, sampler))
        };
        let mut branch = |path: &mut Path, direction: Option<Vec3>, sampler: &mut Sampler| {
            branches.push(path.branch());
            branches.pop_if(|other| {
                let goes_on = go(other, direction, sampler) && survives(other, sampler);
                path.ambient += other.ambient;
                !goes_on
            });
        };
        match onwards.unwrap_or_else(|| Onwards::draw(met, guide, path.is_view(), sampler)) {
            Onwards::One(direction) => go(path, direction, sampler),
            Onwards::EachWay { own, shades, suns } => {
                for direction in [shades, suns].into_iter().flatten() {
                    branch(path, Some(direction), sampler);
                }
                go(path, own, sampler)
            }
        }
    }

    /// Leave a vertex in a drawn direction; `false` if that leads nowhere.
    #[inline(always)]
    fn leave<L: Lobes>(
        &self,
        path: &mut Path,
        met: &Met<L>,
        sample: &SmoothSample,
        sampler: &mut Sampler,
    ) -> bool {
        if !met.agrees_on(sample.direction) {
            return false;
        }
        let share = met.smooth_share;
        let mut weight = sample.weight.total();
        let mut glossy = sample.weight.glossy;
        if weight == Rgb::ZERO {
            return false;
        }
        if let Some(limit) = self.limits.max_bounces {
            // Which lobe was it? Drawn in proportion, so that each lobe keeps its mean.
            let diffuse = luminance(sample.weight.diffuse) / luminance(weight);
            let is_diffuse = sampler.next_1d() < diffuse;
            if is_diffuse && path.bounces >= limit {
                path.ambient +=
                    path.throughput * sample.weight.diffuse / (diffuse * share) * self.limits.ambient;
                return false;
            }
            (weight, glossy) = if is_diffuse {
                (sample.weight.diffuse / diffuse, Rgb::ZERO)
            } else {
                (glossy / (1.0 - diffuse), glossy / (1.0 - diffuse))
            };
            path.bounces += u32::from(is_diffuse);
        }
        let point = met.arrival.point + met.lobes.offset(sample.direction);
        let departure = Departure {
            point,
            pdf: sample.pdf * share,
            source_factor: sample.source_factor,
            is_tied: self.is_tied(met),
        };
        let mut known = Rgb::ZERO;
        if let Some(backlight) = met.backlight() {
            known = self.known_light(backlight, sample, share) * glossy
                / weight.max(Rgb::splat(f64::MIN_POSITIVE));
        }
        path.depart(departure, sample.direction, weight / share);
        path.known = known;
        path.is_known = known != Rgb::ZERO;
        true
    }

    /// What the path will find of the far field, and what the shade's radiance holds already.
    fn known_light(&self, backlight: &Backlight, sample: &SmoothSample, share: f64) -> Rgb {
        let sky = self.world.distant.dome_radiance(sample.direction);
        let field = backlight.field(self.world, sample.direction, sky);
        if field == Rgb::ZERO {
            return field;
        }
        field * power_heuristic(sample.pdf * share, self.world.distant.dome_pdf(sample.direction))
    }
}

/// Directions in which a path goes on by the smooth lobes of a vertex.
enum Onwards {
    /// One of all that the lobes and the guide draw.
    One(Option<Vec3>),
    /// The first time: one of the lobes, one to a shade, and one against a scattered sun.
    EachWay { own: Option<Vec3>, shades: Option<Vec3>, suns: Option<Vec3> },
}

impl Onwards {
    fn draw<L: Lobes>(met: &Met<L>, guide: &GuideAt, each_way: bool, sampler: &mut Sampler) -> Self {
        let (rates, smooth) = (guide.rates, met.lobes);
        if each_way {
            let shades = if rates.shades > 0.0 { guide.sample_shades(sampler.next_3d()) } else { None };
            let suns = if rates.suns > 0.0 { guide.sample_suns(sampler.next_3d()) } else { None };
            let [u, v, choice] = sampler.next_3d();
            return Self::EachWay { own: smooth.sample_direction(choice, [u, v], sampler), shades, suns };
        }
        let [u, v, choice] = sampler.next_3d();
        Self::One(if choice < rates.own {
            smooth.sample_direction(choice / rates.own, [u, v], sampler)
        } else if choice < rates.own + rates.shades {
            guide.sample_shades([(choice - rates.own) / rates.shades, u, v])
        } else {
            guide.sample_suns([(choice - rates.own - rates.shades) / rates.suns, u, v])
        })
    }
}

/// For what mostly branches off: a path to a shade, and one against a scattered sun.
fn room_for_branches() -> Vec<Path> {
    Vec::with_capacity(2)
}

/// A direction that the lobes or the guide have drawn, weighed by the density of all that could have drawn it (Veach 1997,
/// section 9.2: balance heuristic).
fn mixed<L: Lobes>(met: &Met<L>, guide: &GuideAt, direction: Vec3) -> Option<SmoothSample> {
    let smooth = met.lobes;
    let (value, own) = smooth.evaluate_with_pdf(direction);
    let pdf = guide.rates.own * own + guide.pdf(direction);
    let cosine = direction.dot(met.arrival.normal).abs();
    let source_factor = smooth.source_factor(direction);
    let weight = value.scaled(cosine / pdf);
    (pdf > 0.0).then_some(SmoothSample { direction, weight, pdf, source_factor })
}

/// A surface that a path has met.
struct Met<'a, 'w, L> {
    arrival: &'a Arrival,
    /// The smooth lobes.
    lobes: &'a L,
    /// What else the surface does; `None` where it has lobes and nothing else.
    scattering: Option<&'a Scattering<'w>>,
    /// `None` for a sensor and for air, and where the lobes are plain.
    material: Option<&'w Material>,
    is_flat: bool,
    /// Luminous weights of the ways on: straight, mirrored, refracted, smooth.
    shares: [f64; 4],
    /// Chance that a path goes on by the smooth lobes.
    smooth_share: f64,
    /// The far field behind it.
    backlight: Option<&'w Backlight>,
    /// What it is a point of, where a path has met it; `None` for a sensor and for air.
    object: Option<u32>,
    /// Where light comes from, if that helps its lobes.
    guide: Option<&'a GuideAt<'w>>,
}

impl<'a, 'w> Met<'a, 'w, Smooth<'w>> {
    fn new(
        world: &'w World,
        hit: &Hit,
        material: &'w Material,
        arrival: &'a Arrival,
        scattering: &'a Scattering<'w>,
        guide: Option<&'a GuideAt<'w>>,
    ) -> Self {
        let refracted = scattering.refracted.iter().flatten().map(|(_, share)| luminance(*share)).sum();
        let [straight, mirrored] = [scattering.straight, scattering.mirrored].map(luminance);
        let shares = [straight, mirrored, refracted, scattering.smooth.albedo()];
        let backlight = match scattering.smooth {
            Smooth::Table(_) => world.backlights.of(hit.object, arrival.at_front()),
            _ => None,
        };
        Self {
            scattering: Some(scattering),
            material: Some(material),
            is_flat: matches!(world.object(hit).facing, Facing::Flat(_)),
            shares,
            smooth_share: share_of_last(&shares),
            backlight,
            object: Some(hit.object),
            ..Self::of_lobes(arrival, &scattering.smooth, guide)
        }
    }
}

impl<'a, 'w, L: Lobes> Met<'a, 'w, L> {
    /// A point that has smooth lobes and nothing else: of air, of a sensor, or of a plain surface.
    fn of_lobes(arrival: &'a Arrival, lobes: &'a L, guide: Option<&'a GuideAt<'w>>) -> Self {
        Self {
            arrival,
            lobes,
            scattering: None,
            material: None,
            is_flat: true,
            shares: [0.0, 0.0, 0.0, 1.0],
            smooth_share: 1.0,
            backlight: None,
            object: None,
            guide,
        }
    }

    /// What else than its lobes it has.
    fn others(&self) -> Option<&'a Scattering<'w>> {
        if L::ARE_PLAIN { None } else { self.scattering }
    }

    fn backlight(&self) -> Option<&'w Backlight> {
        if L::ARE_PLAIN { None } else { self.backlight }
    }

    /// Is a direction on the same side of the surface as it lies and as its normal is bent?
    fn agrees_on(&self, direction: Vec3) -> bool {
        L::ARE_PLAIN || self.arrival.agrees_on(direction)
    }

    /// The straight chain of a path that something else happens to as well, where it is not left to chance: from the camera, and
    /// from a shade to the far field that is known behind it.
    fn split_straight(&mut self, path: &Path) -> Option<Path> {
        let scattering = self.scattering?;
        let [straight, rest @ ..] = &mut self.shares;
        if !(path.is_view() || path.is_known) || *straight <= 0.0 || *rest == [0.0; 3] {
            return None;
        }
        *straight = 0.0;
        self.smooth_share = share_of_last(&self.shares);
        let mut chain = *path;
        self.go_straight(&mut chain, scattering, 1.0);
        Some(chain)
    }

    fn go_straight(&self, path: &mut Path, scattering: &Scattering, weight: f64) {
        path.go_straight(self.straight_origin(), scattering.straight * weight);
        path.is_past_peak |= matches!(self.material, Some(Material::Table(_)));
    }

    /// Where light that is scattered starts: at the surface, and beyond what a table with thickness stands for.
    fn origins(&self) -> impl Iterator<Item = Vec3> {
        let far = match self.material {
            Some(Material::Table(table)) if table.thickness(self.arrival) != 0.0 => {
                Some(self.straight_origin())
            }
            _ => None,
        };
        std::iter::once(self.arrival.point).chain(far)
    }

    /// Where a ray that goes straight on starts: beyond the geometry that a table with thickness stands for.
    fn straight_origin(&self) -> Vec3 {
        match self.material {
            Some(Material::Table(table)) => self.arrival.point + table.offset(self.arrival),
            _ => self.arrival.point,
        }
    }
}

/// The last weight's part of all.
fn share_of_last(weights: &[f64; 4]) -> f64 {
    let [others @ .., last] = weights;
    if *others == [0.0; 3] && *last > 0.0 {
        return 1.0;
    }
    if *last > 0.0 { last / weights.iter().sum::<f64>() } else { 0.0 }
}

/// The guide, where it helps these lobes.
fn guide_of<'w>(world: &'w World, smooth: &Smooth, point: Vec3, each_way: bool) -> Option<GuideAt<'w>> {
    world.guide.as_ref().filter(|_| smooth.can_be_guided()).map(|guide| guide.at(point, each_way))
}

/// Russian roulette.
fn survives(path: &mut Path, sampler: &mut Sampler) -> bool {
    let mut chance = path.throughput.max_element() / ROULETTE_BELOW;
    if path.events > ROULETTE_ALWAYS {
        chance = chance.min(ROULETTE_CEILING);
    }
    if chance >= 1.0 {
        return true;
    }
    if chance <= 0.0 || sampler.next_1d() >= chance {
        return false;
    }
    path.throughput /= chance;
    true
}

#[cfg(test)]
mod tests;
