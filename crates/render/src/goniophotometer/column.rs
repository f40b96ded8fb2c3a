//! One column of the tables: light that comes from one incident cell, counted where it leaves.

use super::cell::Cell;
use super::walk::{End, fork, straight, walk};
use crate::World;
use glam::DVec2;
use std::f64::consts::TAU;
use sunpeak_bsdf::table::Columns;
use sunpeak_core::{Control, Result, Rgb, Sampler, luminance};

/// Rays come in so many independent sets of well-distributed points, so that what they differ by tells the error.
const SETS: u64 = 8;

/// Walks that set out where a ray meets a surface: one from which they leave the product at once, which is cheap and all that they do
/// there, and others. More share the ray's first part and its point; their directions are distributed well together.
const BRANCHES: [u64; 2] = [8, 16];

/// Sets of straight rays alone, at most, over those of all rays: they are short, and what goes straight lands in one cell.
const MOST_STRAIGHT: usize = 4;

/// The error of what goes straight is to be so much smaller than that of the whole column.
const STRAIGHT_ERROR: f64 = 0.2;

/// Rays between two looks whether to stop.
const CHECK_EVERY: u64 = 64;

/// The sides that light can come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From below, along +z: what a file calls front, and genBSDF forward.
    Front,
    /// From above, along -z: backward.
    Back,
}

/// How many rays, and how exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Rays of a column at least.
    pub samples: u64,
    /// … and at most.
    pub most_samples: u64,
    /// Relative error of the column's flux over its cells at which it is good.
    pub error: f64,
    pub seed: u64,
    /// Three channels, or luminous values alone.
    pub colored: bool,
}

/// What came out of one column. Fluxes are shares of the light that came in.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub rays: u64,
    /// What goes straight, or is brought back to its direction by refraction.
    pub through: Rgb,
    pub through_error: f64,
    /// What was given up, luminous.
    pub lost: f64,
    pub transmission: Counts,
    pub reflection: Counts,
}

/// The scattered light of one mode.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    /// Of each exiting cell: luminous, or red, green, blue.
    pub flux: Vec<f32>,
    /// Of each exiting cell: standard error of the luminous flux.
    pub error: Vec<f32>,
    /// Standard error of the sum over the cells.
    pub whole_error: f64,
}

/// Everything that a column needs.
pub(super) struct Tracer<'a> {
    pub world: &'a World,
    pub cell: &'a Cell,
    pub incident: &'a Columns,
    pub exiting: &'a Columns,
    pub effort: Effort,
}

/// Sums while rays come in.
struct Sums {
    flux: Vec<f64>,
    square: Vec<f64>,
    /// Rays that have come to a cell.
    landed: u64,
    /// Luminous flux of each set of rays.
    sets: Vec<f64>,
    channels: usize,
}

impl Sums {
    fn new(cells: usize, channels: usize) -> Self {
        Self {
            flux: vec![0.0; cells * channels],
            square: vec![0.0; cells],
            landed: 0,
            sets: Vec::new(),
            channels,
        }
    }

    fn add(&mut self, cell: usize, carried: Rgb) {
        let flux = luminance(carried);
        if self.channels == 3 {
            for (sum, value) in self.flux[3 * cell..].iter_mut().zip(carried.to_array()) {
                *sum += value;
            }
        } else {
            self.flux[cell] += flux;
        }
        self.square[cell] += flux * flux;
        self.landed += 1;
        if let Some(set) = self.sets.last_mut() {
            *set += flux;
        }
    }

    fn counts(self, rays: u64, in_set: u64) -> Counts {
        let n = rays as f64;
        // A cell that no ray has met, or one, has an error, too: as if one ray more had come there.
        let one_more = self.square.iter().sum::<f64>() / self.landed.max(1) as f64;
        let error = |&square: &f64| ((square + one_more).sqrt() / n) as f32;
        Counts {
            flux: self.flux.iter().map(|f| (f / n) as f32).collect(),
            error: self.square.iter().map(error).collect(),
            whole_error: error_of_mean(&self.sets, in_set),
        }
    }
}

/// Standard error of a mean from independent sets of `in_set` samples each.
fn error_of_mean(sums: &[f64], in_set: u64) -> f64 {
    let n = sums.len() as f64;
    if n < 2.0 {
        return 0.0;
    }
    let mean = sums.iter().sum::<f64>() / n;
    let variance = sums.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (variance / n).sqrt() / in_set as f64
}

/// Where the branches of one ray have arrived: what comes to one cell counts as one.
#[derive(Default)]
struct Arrived(Vec<(bool, usize, Rgb)>);

impl Arrived {
    fn add(&mut self, is_through: bool, cell: usize, carried: Rgb) {
        match self.0.iter_mut().find(|(mode, at, _)| (*mode, *at) == (is_through, cell)) {
            Some((_, _, sum)) => *sum += carried,
            None => self.0.push((is_through, cell, carried)),
        }
    }
}

/// A column that is being traced.
struct Progress {
    transmission: Sums,
    reflection: Sums,
    /// By null events alone, and luminous of each set.
    straight: Rgb,
    straight_sets: Vec<f64>,
    /// Refracted, and back in its direction; and luminous of each set.
    undeflected: Rgb,
    undeflected_sets: Vec<f64>,
    lost: f64,
    rays: u64,
}

impl Tracer<'_> {
    /// Trace one column; the same whatever is traced beside it.
    pub fn column(&self, side: Side, column: usize, control: &Control) -> Result<Column> {
        let sums = || Sums::new(self.exiting.len(), if self.effort.colored { 3 } else { 1 });
        let mut so_far = Progress {
            transmission: sums(),
            reflection: sums(),
            straight: Rgb::ZERO,
            straight_sets: Vec::new(),
            undeflected: Rgb::ZERO,
            undeflected_sets: Vec::new(),
            lost: 0.0,
            rays: 0,
        };
        let in_set = self.effort.samples.div_ceil(SETS);
        while so_far.straight_sets.len() < SETS as usize
            || so_far.rays < self.effort.most_samples && !self.is_good(&so_far)
        {
            self.set_of_rays(side, column, in_set, &mut so_far, control)?;
        }
        let most = so_far.straight_sets.len() * (1 + MOST_STRAIGHT);
        while !self.is_through_good(&so_far, in_set) && so_far.straight_sets.len() < most {
            self.set_of_straight_rays(side, column, in_set, &mut so_far, control)?;
        }
        let n = (in_set * so_far.straight_sets.len() as u64) as f64;
        let [straight, undeflected] = [&so_far.straight_sets, &so_far.undeflected_sets];
        Ok(Column {
            rays: so_far.rays,
            through: so_far.straight / n + so_far.undeflected / so_far.rays as f64,
            through_error: error_of_mean(straight, in_set).hypot(error_of_mean(undeflected, in_set)),
            lost: so_far.lost / so_far.rays as f64,
            transmission: so_far.transmission.counts(so_far.rays, in_set),
            reflection: so_far.reflection.counts(so_far.rays, in_set),
        })
    }

    fn set_of_rays(
        &self,
        side: Side,
        column: usize,
        in_set: u64,
        so_far: &mut Progress,
        control: &Control,
    ) -> Result<()> {
        let [first, second] = streams(side, column, so_far.straight_sets.len());
        so_far.transmission.sets.push(0.0);
        so_far.reflection.sets.push(0.0);
        let (mut straight_on, mut undeflected) = (Rgb::ZERO, Rgb::ZERO);
        let (mut arrived, mut drawn) = (Arrived::default(), 0_u64);
        for index in 0..in_set {
            if index % CHECK_EVERY == 0 {
                control.check()?;
            }
            let mut sampler = Sampler::new(self.effort.seed, first, index);
            let came = self.incidence(side, column, &mut sampler);
            let ray = self.cell.entering(came.direction, sampler.next_2d());
            let mut count = |end: End| match end {
                End::Absorbed | End::Straight => {}
                End::Undeflected(carried) => undeflected += carried,
                End::Lost(carried) => so_far.lost += luminance(carried),
                End::Out(direction, carried) => {
                    let p_out = came.turn.rotate(direction.truncate());
                    let is_through = (direction.z > 0.0) == (came.direction.z > 0.0);
                    arrived.add(is_through, self.exiting.index(p_out), carried);
                }
            };
            if self.world.has_volumes {
                let mut own = Sampler::new(self.effort.seed, second, index);
                count(walk(self.world, self.cell, ray, &mut own));
                straight_on += straight(self.world, self.cell, ray, &mut sampler);
            } else {
                // One point after the other, whichever rays meet something: so directions stay well distributed.
                let branch = |number: u64| {
                    if number == 0 {
                        drawn = drawn.next_multiple_of(BRANCHES[0]);
                    }
                    drawn += 1;
                    Sampler::new(self.effort.seed, second, drawn - 1)
                };
                straight_on += fork(self.world, self.cell, ray, &mut sampler, BRANCHES, branch, count);
            }
            for (is_through, cell, carried) in arrived.0.drain(..) {
                let sums = if is_through { &mut so_far.transmission } else { &mut so_far.reflection };
                sums.add(cell, carried);
            }
        }
        so_far.rays += in_set;
        so_far.straight += straight_on;
        so_far.straight_sets.push(luminance(straight_on));
        so_far.undeflected += undeflected;
        so_far.undeflected_sets.push(luminance(undeflected));
        Ok(())
    }

    fn set_of_straight_rays(
        &self,
        side: Side,
        column: usize,
        in_set: u64,
        so_far: &mut Progress,
        control: &Control,
    ) -> Result<()> {
        let [first, _] = streams(side, column, so_far.straight_sets.len());
        let mut sum = Rgb::ZERO;
        for index in 0..in_set {
            if index % CHECK_EVERY == 0 {
                control.check()?;
            }
            let mut sampler = Sampler::new(self.effort.seed, first, index);
            let came = self.incidence(side, column, &mut sampler);
            let ray = self.cell.entering(came.direction, sampler.next_2d());
            sum += straight(self.world, self.cell, ray, &mut sampler);
        }
        so_far.straight += sum;
        so_far.straight_sets.push(luminance(sum));
        Ok(())
    }

    /// Is the root sum of squares of all cells' errors small against what comes out?
    fn is_good(&self, so_far: &Progress) -> bool {
        let both = [&so_far.transmission, &so_far.reflection];
        let squares: f64 = both.iter().flat_map(|s| &s.square).sum();
        let flux: f64 = both.iter().flat_map(|s| &s.sets).sum();
        squares.sqrt() <= self.effort.error * flux
    }

    fn is_through_good(&self, so_far: &Progress, in_set: u64) -> bool {
        let n = (in_set * so_far.straight_sets.len() as u64) as f64;
        let goal = STRAIGHT_ERROR * self.effort.error * luminance(so_far.straight) / n;
        error_of_mean(&so_far.straight_sets, in_set) <= goal
    }

    fn incidence(&self, side: Side, column: usize, sampler: &mut Sampler) -> Incidence {
        let u = sampler.next_2d();
        let mut p_in = self.incident.point(column, u);
        let mut turn = DVec2::X;
        if let Columns::Radial { .. } = self.incident {
            // The mean over all azimuths, each seen from where it came.
            let azimuth = DVec2::from_angle(TAU * u[1]);
            (p_in, turn) = (azimuth.rotate(p_in), DVec2::new(azimuth.x, -azimuth.y));
        }
        let height = (1.0 - p_in.length_squared()).max(0.0).sqrt();
        let z = if side == Side::Front { height } else { -height };
        Incidence { direction: p_in.extend(z), turn }
    }
}

/// A direction that light comes in, and the turn that brings it to the table's frame.
struct Incidence {
    direction: sunpeak_core::Vec3,
    turn: DVec2,
}

/// Each side, column and set has its own sequences of points: for rays, and for what sets out from them.
fn streams(side: Side, column: usize, set: usize) -> [u64; 2] {
    let side = u64::from(side == Side::Back);
    let first = (((column as u64) << 1 | side) << 24) + 2 * set as u64;
    [first, first + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_mean_is_that_of_its_sets() {
        // Means 1, 2, 3 of two samples each: variance 1, over three sets.
        let error = error_of_mean(&[2.0, 4.0, 6.0], 2);
        assert!((error - (1.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }
}
