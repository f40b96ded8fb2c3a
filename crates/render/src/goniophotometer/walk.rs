//! One ray's way through a product: where it leaves, and what it carries.

use super::cell::{Cell, Next};
use crate::World;
use crate::material::{Arrival, Flight, Inside, Lobes, Material, Scattering, Smooth};
use crate::shapes::Ray;
use crate::world::Seen;
use sunpeak_core::{Rgb, Sampler, Vec3, luminance};

/// Russian roulette begins when a walk carries less than this, and brings those that survive back to it.
const ROULETTE_BELOW: f64 = 0.05;

/// Past so many surfaces the chance of survival is never above the ceiling, so that walks between lossless surfaces end.
const ROULETTE_ALWAYS: u32 = 64;
const ROULETTE_CEILING: f64 = 0.95;

/// Surfaces that a walk may meet: a safeguard against panes without end.
const MOST_EVENTS: u32 = 100_000;

/// How far apart directions may be that are the same but for rounding.
const SAME_DIRECTION: f64 = 1e-9;

/// How a walk ends.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// All of it is absorbed.
    Absorbed,
    /// It has left by nothing but null events: straight rays know that way better.
    Straight,
    /// It has left in the direction in which it came by refraction and mirrors alone.
    Undeflected(Rgb),
    /// It has left.
    Out(Vec3, Rgb),
    /// It was given up with what it carried.
    Lost(Rgb),
}

/// A ray that runs straight through everything that lets it: what is left of it. Mixtures are chosen at random.
pub(super) fn straight(world: &World, cell: &Cell, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
    let mut carried = Rgb::ONE;
    let mut inside = world.inside_at(&ray);
    let mut passed = 0.0;
    for _ in 0..MOST_EVENTS {
        let before = passed;
        let next = cell.next(world, &mut ray, &mut passed);
        if let Some(air) = world.air(&inside) {
            let end = if let Next::Hit(hit) = next { hit.t } else { 0.0 };
            carried *= air.transmittance(passed - before + end);
        }
        let hit = match next {
            Next::Hit(hit) => hit,
            Next::Out => return carried,
            Next::Lost => return Rgb::ZERO,
        };
        let mut choose = || sampler.next_1d();
        let mut arrival = world.arrival_after([passed; 2], &hit, &ray);
        let seen = world.meet(hit.object, &mut arrival, true, &mut inside, &mut choose);
        passed += hit.t;
        match seen {
            Seen::Void => ray = Ray::past(arrival.point, ray.direction),
            Seen::Emitter(_) => return Rgb::ZERO,
            Seen::Surface(material) => {
                carried *= material.scatter(&arrival, true).straight;
                if carried == Rgb::ZERO {
                    return Rgb::ZERO;
                }
                ray = Ray::past(onwards(material, &arrival), ray.direction);
            }
        }
    }
    Rgb::ZERO
}

/// The way of one ray, drawn at random.
pub(super) fn walk(world: &World, cell: &Cell, ray: Ray, sampler: &mut Sampler) -> End {
    Walker::new(world, cell, ray).run(sampler)
}

/// One ray, not drawn but split: what goes straight on is followed to its end and returned, and from each surface that it meets
/// walks set out with the rest, each with its part, where it is scattered: as many as `branches` says of a surface that walks leave
/// the product from at once, and of others. `branch` gives the points of the
/// walks, numbered from 0 at each surface. Not for scenes with mist, which has no surface.
pub(super) fn fork(
    world: &World,
    cell: &Cell,
    ray: Ray,
    sampler: &mut Sampler,
    branches: [u64; 2],
    mut branch: impl FnMut(u64) -> Sampler,
    mut arrived: impl FnMut(End),
) -> Rgb {
    let mut stem = Walker::new(world, cell, ray);
    while stem.events < MOST_EVENTS {
        let mut passed = 0.0;
        let hit = match stem.cell.next(world, &mut stem.ray, &mut passed) {
            Next::Hit(hit) => hit,
            Next::Out => return stem.carried,
            Next::Lost => {
                arrived(End::Lost(stem.carried));
                return Rgb::ZERO;
            }
        };
        let length = passed + hit.t;
        let way = [stem.distance + passed, stem.travelled + passed];
        let mut choose = || sampler.next_1d();
        let mut arrival = world.arrival_after(way, &hit, &stem.ray);
        let seen = world.meet(hit.object, &mut arrival, true, &mut stem.inside, &mut choose);
        stem.travel(length);
        match seen {
            Seen::Void => stem.ray = Ray::past(arrival.point, stem.ray.direction),
            Seen::Emitter(_) => return Rgb::ZERO,
            Seen::Surface(material) => {
                stem.absorb(material, &arrival, length);
                let scattering = material.scatter(&arrival, true);
                let back = Ray::new(arrival.point, -stem.ray.direction);
                let most = branches[usize::from(!stem.cell.has_left(&back))];
                // Where nothing is scattered, all branches would take the same ways.
                let branches = if scattering.smooth.albedo() > 0.0 { most } else { 1 };
                let share = 1.0 / branches as f64;
                for number in 0..branches {
                    let mut own = branch(number);
                    let mut walker = Walker { carried: stem.carried * share, share, ..stem };
                    if walker.go_on(material, &scattering, &arrival, false, &mut own)
                        && walker.survives(&mut own)
                    {
                        arrived(walker.run(&mut own));
                    }
                }
                let straight = scattering.straight;
                if straight == Rgb::ZERO {
                    return Rgb::ZERO;
                }
                stem.carried *= straight;
                stem.ray = Ray::past(onwards(material, &arrival), stem.ray.direction);
            }
        }
    }
    arrived(End::Lost(stem.carried));
    Rgb::ZERO
}

/// Where a ray goes on that passes a surface: beyond what a table with thickness stands for.
fn onwards(material: &Material, arrival: &Arrival) -> Vec3 {
    match material {
        Material::Table(table) => arrival.point + table.offset(arrival),
        _ => arrival.point,
    }
}

/// What has happened to a ray so far, the most that it was.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Way {
    Straight,
    Specular,
    Scattered,
}

#[derive(Clone, Copy)]
struct Walker<'w> {
    world: &'w World,
    cell: &'w Cell,
    /// The direction at the start.
    came: Vec3,
    ray: Ray,
    carried: Rgb,
    /// What it set out with, one of several branches: against it roulette weighs.
    share: f64,
    events: u32,
    /// Way since the last scattering, and in all.
    distance: f64,
    travelled: f64,
    /// Of the solid that it is in [1/m].
    extinction: Rgb,
    inside: Inside,
    way: Way,
}

impl<'w> Walker<'w> {
    fn new(world: &'w World, cell: &'w Cell, ray: Ray) -> Self {
        Self {
            world,
            cell,
            came: ray.direction,
            ray,
            carried: Rgb::ONE,
            share: 1.0,
            events: 0,
            distance: 0.0,
            travelled: 0.0,
            extinction: Rgb::ZERO,
            inside: world.inside_at(&ray),
            way: Way::Straight,
        }
    }

    fn run(mut self, sampler: &mut Sampler) -> End {
        while self.events < MOST_EVENTS {
            let mut passed = 0.0;
            let next = self.cell.next(self.world, &mut self.ray, &mut passed);
            let length = if let Next::Hit(hit) = next { passed + hit.t } else { passed };
            if let Some(air) = self.world.air(&self.inside) {
                match air.fly(self.carried, length, sampler.next_1d(), sampler.next_1d()) {
                    Flight::Through(share) => self.carried *= share,
                    Flight::Scattered(distance, share) => {
                        self.carried *= share;
                        // The ray may have crossed sides since: back from where it is now.
                        let point = self.cell.wrapped(self.ray.at(distance - passed));
                        let phase = Smooth::Phase(air.phase(self.ray.direction));
                        let Some(sample) = phase.draw(sampler) else { return End::Absorbed };
                        self.travel(distance);
                        self.leave_for(point, sample.direction, sample.weight.total(), Way::Scattered);
                        if !self.survives(sampler) {
                            return End::Absorbed;
                        }
                        continue;
                    }
                }
            }
            let hit = match next {
                Next::Hit(hit) => hit,
                Next::Out => return self.end(),
                Next::Lost => return End::Lost(self.carried),
            };
            let way = [self.distance + passed, self.travelled + passed];
            let view = self.way < Way::Scattered;
            let mut choose = || sampler.next_1d();
            let mut arrival = self.world.arrival_after(way, &hit, &self.ray);
            let seen = self.world.meet(hit.object, &mut arrival, view, &mut self.inside, &mut choose);
            self.travel(length);
            match seen {
                Seen::Void => self.ray = Ray::past(arrival.point, self.ray.direction),
                Seen::Emitter(_) => return End::Absorbed,
                Seen::Surface(material) => {
                    self.absorb(material, &arrival, length);
                    let scattering = material.scatter(&arrival, self.way < Way::Scattered);
                    if !self.go_on(material, &scattering, &arrival, true, sampler) || !self.survives(sampler)
                    {
                        return End::Absorbed;
                    }
                }
            }
        }
        End::Lost(self.carried)
    }

    fn end(&self) -> End {
        let direction = self.ray.direction;
        match self.way {
            Way::Straight => End::Straight,
            Way::Specular if direction.distance(self.came) < SAME_DIRECTION => End::Undeflected(self.carried),
            _ => End::Out(direction, self.carried),
        }
    }

    fn travel(&mut self, length: f64) {
        self.events += 1;
        self.distance += length;
        self.travelled += length;
        if self.extinction != Rgb::ZERO {
            self.carried *= (-self.extinction * length).exp();
        }
    }

    fn leave_for(&mut self, point: Vec3, direction: Vec3, weight: Rgb, way: Way) {
        self.ray = Ray::new(point, direction);
        self.carried *= weight;
        self.distance = 0.0;
        if self.way < way {
            self.way = way;
        }
    }

    /// Weaken the way to the face of a solid that the walk did not enter by a face: the box began inside.
    fn absorb(&mut self, material: &Material, arrival: &Arrival, length: f64) {
        if let Material::Dielectric(solid) = material
            && let Some(extinction) = solid.extinction_before(arrival)
            && self.extinction == Rgb::ZERO
        {
            self.carried *= (-extinction * length).exp();
        }
    }

    /// Choose one of the ways on, in proportion to their luminous shares; `false` if the walk ends here. `may_pass`: straight on is
    /// one of them.
    fn go_on(
        &mut self,
        material: &Material,
        scattering: &Scattering,
        arrival: &Arrival,
        may_pass: bool,
        sampler: &mut Sampler,
    ) -> bool {
        let [straight, mirrored] = [scattering.straight, scattering.mirrored].map(luminance);
        let straight = if may_pass { straight } else { 0.0 };
        let [first, second] = scattering.refracted.map(|way| way.map_or(0.0, |(_, share)| luminance(share)));
        let smooth = scattering.smooth.albedo();
        let whole = straight + mirrored + first + second + smooth;
        if whole <= 0.0 {
            return false;
        }
        let choice = sampler.next_1d() * whole;
        if choice < straight {
            self.ray = Ray::past(onwards(material, arrival), self.ray.direction);
            self.carried *= scattering.straight * (whole / straight);
        } else if choice < straight + mirrored {
            let weight = scattering.mirrored * (whole / mirrored);
            self.leave_for(arrival.point, arrival.mirrored(), weight, Way::Specular);
        } else if choice < straight + mirrored + first + second {
            let is_first = choice - straight - mirrored < first;
            let Some((direction, share)) = scattering.refracted[usize::from(!is_first)] else { return false };
            self.leave_for(arrival.point, direction, share * (whole / luminance(share)), Way::Specular);
            self.extinction = match material {
                Material::Dielectric(solid) => solid.extinction_behind(arrival),
                _ => Rgb::ZERO,
            };
        } else {
            let Some(sample) = scattering.smooth.draw(sampler) else { return false };
            let weight = sample.weight.total() * (whole / smooth);
            if weight == Rgb::ZERO || !arrival.agrees_on(sample.direction) {
                return false;
            }
            let point = arrival.point + scattering.smooth.offset(sample.direction);
            self.leave_for(point, sample.direction, weight, Way::Scattered);
        }
        true
    }

    /// Russian roulette.
    fn survives(&mut self, sampler: &mut Sampler) -> bool {
        let mut chance = self.carried.max_element() / (self.share * ROULETTE_BELOW);
        if self.events > ROULETTE_ALWAYS {
            chance = chance.min(ROULETTE_CEILING);
        }
        if chance >= 1.0 {
            return true;
        }
        if chance <= 0.0 || sampler.next_1d() >= chance {
            return false;
        }
        self.carried /= chance;
        true
    }
}
