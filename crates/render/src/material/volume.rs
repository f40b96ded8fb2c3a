//! Volumes that surfaces bound and that are no solids: `mist`, air that scatters, and `antimatter`, where others do not exist.
//!
//! A path keeps a list of the volumes that it is in. Their boundaries are null events.
//!
//! Mist: extinction and albedo make the coefficients of absorption and scattering, constant within the volume; overlapping
//! mists add up. Free flights are drawn for one of the three channels, chosen by what the path carries, and weighed by the mean
//! density of all (one-sample model, Veach 1997, section 9.2): so the sum of what is carried does not grow. Directions follow the function of Henyey and Greenstein 1941, "Diffuse radiation in the galaxy".

use super::{Alternate, MaterialId};
use std::f64::consts::PI;
use sunpeak_core::{Frame, Rgb, Vec3, luminance, warp};

/// Volumes within each other; more are not noticed.
const MAX_NESTED: usize = 8;

/// Below this eccentricity the scattering is isotropic: the inverse of the distribution function divides by it.
const SMALLEST_ECCENTRICITY: f64 = 1e-3;

/// `mist`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mist {
    /// [1/m]
    pub extinction: Rgb,
    /// Share of the extinction that is scattering.
    pub albedo: Rgb,
    /// Mean cosine of the scattering angle.
    pub eccentricity: f64,
}

/// `antimatter`.
#[derive(Clone, Debug)]
pub(crate) struct Antimatter {
    /// Surfaces of these do not exist inside.
    pub clipped: Vec<MaterialId>,
    /// What the cut face of a clipped solid looks like; `None` leaves it open.
    pub face: Alternate,
}

/// A volume that a path is in.
#[derive(Clone, Copy, Debug)]
struct Entered {
    volume: MaterialId,
    /// Clipped surfaces that were entered since, less those that were left.
    depth: i32,
}

/// The volumes that a path is in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inside {
    entered: [Entered; MAX_NESTED],
    count: usize,
}

impl Default for Inside {
    fn default() -> Self {
        Self { entered: [Entered { volume: MaterialId(0), depth: 0 }; MAX_NESTED], count: 0 }
    }
}

impl Inside {
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The volumes, the one entered last at the end.
    pub fn volumes(&self) -> impl Iterator<Item = MaterialId> + '_ {
        self.entered[..self.count].iter().map(|e| e.volume)
    }

    pub fn enter(&mut self, volume: MaterialId) {
        if self.count < MAX_NESTED {
            self.entered[self.count] = Entered { volume, depth: 0 };
            self.count += 1;
        }
    }

    pub fn leave(&mut self, volume: MaterialId) {
        if let Some(at) = self.position(volume) {
            self.entered.copy_within(at + 1..self.count, at);
            self.count -= 1;
        }
    }

    /// Count a surface that `volume` clips.
    pub fn cross_clipped(&mut self, volume: MaterialId, at_front: bool) {
        if let Some(at) = self.position(volume) {
            self.entered[at].depth += if at_front { 1 } else { -1 };
        }
    }

    /// Is this point of `volume` in a solid that it clips?
    pub fn is_in_clipped(&self, volume: MaterialId) -> bool {
        self.position(volume).is_some_and(|at| self.entered[at].depth > 0)
    }

    fn position(&self, volume: MaterialId) -> Option<usize> {
        self.entered[..self.count].iter().rposition(|e| e.volume == volume)
    }
}

/// The air at a point: all mists there are together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Air {
    extinction: Rgb,
    scattering: Rgb,
    lobes: [(Rgb, f64); MAX_NESTED],
    count: usize,
}

/// How a path comes through a stretch of air.
pub(crate) enum Flight {
    /// To its end, and this is left.
    Through(Rgb),
    /// It was scattered at this distance; the weight holds all that was lost and the density.
    Scattered(f64, Rgb),
}

impl Air {
    /// `None` if no mist does anything.
    pub fn of<'m>(mists: impl Iterator<Item = &'m Mist>) -> Option<Self> {
        let mut air = Self {
            extinction: Rgb::ZERO,
            scattering: Rgb::ZERO,
            lobes: [(Rgb::ZERO, 0.0); MAX_NESTED],
            count: 0,
        };
        for mist in mists.filter(|m| m.extinction != Rgb::ZERO) {
            let scattering = mist.extinction * mist.albedo;
            air.extinction += mist.extinction;
            if scattering != Rgb::ZERO && air.count < MAX_NESTED {
                air.scattering += scattering;
                air.lobes[air.count] = (scattering, mist.eccentricity);
                air.count += 1;
            }
        }
        (air.extinction != Rgb::ZERO).then_some(air)
    }

    /// Beer's law; nothing is left after an infinite way.
    pub fn transmittance(&self, distance: f64) -> Rgb {
        self.extinction.map(|e| if e > 0.0 { (-e * distance).exp() } else { 1.0 })
    }

    /// Draw how far a path that carries this much comes on a way of this length.
    pub fn fly(&self, carried: Rgb, length: f64, choice: f64, u: f64) -> Flight {
        if self.scattering == Rgb::ZERO || carried.element_sum() <= 0.0 {
            return Flight::Through(self.transmittance(length));
        }
        let shares = carried / carried.element_sum();
        let channel = if choice < shares.x {
            0
        } else if choice < shares.x + shares.y {
            1
        } else {
            2
        };
        let rate = self.extinction[channel];
        let distance = if rate > 0.0 { -(1.0 - u).ln() / rate } else { f64::INFINITY };
        if distance < length {
            let left = self.transmittance(distance);
            let density = (shares * self.extinction * left).element_sum();
            return Flight::Scattered(distance, self.scattering * left / density);
        }
        let left = self.transmittance(length);
        let chance = (shares * left).element_sum();
        Flight::Through(if chance > 0.0 { left / chance } else { Rgb::ZERO })
    }

    /// Scattering of a ray of this direction.
    pub fn phase(&self, direction: Vec3) -> Phase {
        let share = |(s, g): (Rgb, f64)| (s / self.scattering.map(|s| s.max(f64::MIN_POSITIVE)), g);
        Phase { direction, lobes: self.lobes.map(share), count: self.count }
    }
}

/// Scattering at a point of the air.
#[derive(Clone, Debug)]
pub(crate) struct Phase {
    /// Of the ray that arrives.
    direction: Vec3,
    /// Share and eccentricity.
    lobes: [(Rgb, f64); MAX_NESTED],
    count: usize,
}

impl Phase {
    fn lobes(&self) -> &[(Rgb, f64)] {
        &self.lobes[..self.count]
    }

    /// [1/sr]
    pub fn evaluate(&self, direction: Vec3) -> Rgb {
        let cosine = self.direction.dot(direction);
        self.lobes().iter().map(|&(share, g)| share * henyey_greenstein(g, cosine)).sum()
    }

    pub fn pdf(&self, direction: Vec3) -> f64 {
        let cosine = self.direction.dot(direction);
        let weigh = |&(share, g): &(Rgb, f64)| luminance(share) * henyey_greenstein(g, cosine);
        self.lobes().iter().map(weigh).sum::<f64>() / self.whole()
    }

    fn whole(&self) -> f64 {
        self.lobes().iter().map(|(share, _)| luminance(*share)).sum()
    }

    pub fn sample(&self, choice: f64, u: [f64; 2]) -> super::SmoothSample {
        let mut rest = choice * self.whole();
        let chosen = self.lobes().iter().find(|(share, _)| {
            rest -= luminance(*share);
            rest < 0.0
        });
        let g = chosen.or(self.lobes().last()).map_or(0.0, |lobe| lobe.1);
        let direction = sample_henyey_greenstein(g, self.direction, u);
        let pdf = self.pdf(direction);
        let diffuse = self.evaluate(direction) / pdf;
        let weight = super::SmoothValue { diffuse, glossy: Rgb::ZERO };
        super::SmoothSample { direction, weight, pdf, source_factor: 1.0 }
    }
}

/// Density [1/sr] of the angle between the ray's direction and where it goes on.
fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5))
}

fn sample_henyey_greenstein(g: f64, direction: Vec3, [u, v]: [f64; 2]) -> Vec3 {
    let cosine = if g.abs() < SMALLEST_ECCENTRICITY {
        1.0 - 2.0 * u
    } else {
        let s = (1.0 - g * g) / (1.0 + g - 2.0 * g * u);
        ((1.0 + g * g - s * s) / (2.0 * g)).clamp(-1.0, 1.0)
    };
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let [x, y] = warp::circle(v);
    Frame::from_normal(direction).to_world(Vec3::new(sine * x, sine * y, cosine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{chi_square_of_sampler, sphere_sum};
    use sunpeak_core::gray;

    fn mist(extinction: Rgb, albedo: f64, eccentricity: f64) -> Mist {
        Mist { extinction, albedo: gray(albedo), eccentricity }
    }

    #[test]
    fn directions_follow_the_phase_function() {
        let mists =
            [mist(gray(0.3), 0.9, 0.7), mist(Rgb::new(0.1, 0.2, 0.9), 0.5, -0.3), mist(gray(0.1), 1.0, 0.0)];
        for range in [0..1, 1..2, 2..3, 0..3] {
            let air = Air::of(mists[range.clone()].iter()).expect("scatters");
            let phase = air.phase(Vec3::new(0.6, 0.0, 0.8));
            let name = format!("mists {range:?}");
            chi_square_of_sampler(&name, |c, u| Some(phase.sample(c, u).direction), |d| phase.pdf(d));
            let sum = sphere_sum(|d| phase.evaluate(d));
            assert!((sum - Rgb::ONE).length() < 1e-3, "{name}: {sum}");
        }
    }

    #[test]
    fn flights_keep_their_light() {
        // Of a ray through 2 m of air exp(-2 e) is left, and the rest is scattered or absorbed: albedo (1 - exp(-2 e)).
        let extinction = Rgb::new(0.1, 0.5, 2.0);
        let air = Air::of([mist(extinction, 0.8, 0.0)].iter()).expect("scatters");
        let (n, carried) = (400, Rgb::new(1.0, 3.0, 0.5));
        let (mut through, mut scattered) = (Rgb::ZERO, Rgb::ZERO);
        for i in 0..3 * n {
            for j in 0..n {
                let at = |k: usize, n: usize| (k as f64 + 0.5) / n as f64;
                match air.fly(carried, 2.0, at(i, 3 * n), at(j, n)) {
                    Flight::Through(share) => through += share,
                    Flight::Scattered(_, share) => scattered += share,
                }
            }
        }
        let count = (3 * n * n) as f64;
        let left = (-2.0 * extinction).exp();
        assert!((through / count - left).abs().max_element() < 5e-3, "{through}");
        assert!((scattered / count - 0.8 * (1.0 - left)).abs().max_element() < 5e-3, "{scattered}");
    }

    #[test]
    fn volumes_are_left_in_any_order() {
        let mut inside = Inside::default();
        let [a, b] = [MaterialId(1), MaterialId(2)];
        inside.enter(a);
        inside.enter(b);
        inside.cross_clipped(b, true);
        assert!(inside.is_in_clipped(b) && !inside.is_in_clipped(a));
        inside.leave(a);
        assert!(inside.is_in_clipped(b) && inside.volumes().eq([b]));
        inside.leave(a);
        inside.leave(b);
        assert!(inside.is_empty());
    }
}
