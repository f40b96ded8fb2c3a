//! What goes straight through a product in one direction, as a number of its own.
//!
//! It is mostly all or nothing: a ray meets something or it does not, and only the fields of the face over which an edge lies are in
//! doubt. So a first look, whose rays tell nothing but that, says where; the rays that count are then dense there.

use super::cell::{Cell, Edges};
use super::walk::straight;
use crate::World;
use rayon::prelude::*;
use sunpeak_core::{Error, Result, Rgb, Sampler, Vec3, luminance};

/// Rays of a direction for each field of the face: two of the first look, two at least that count, and as many again for edges.
const RAYS_A_FIELD: f64 = 8.0;

/// Fields a side at most.
const MOST_SIDE: u64 = 1024;

/// Independent rays of which each field has so many, so that what they differ by tells the error.
const PAIR: u64 = 2;

/// Through transmittance [-] of the sampled box for rays in these directions (of any length), and its standard error in each channel, by
/// about `samples` rays each. Wide enough a box or periodic edges make it that of the product.
///
/// # Errors
/// A direction along the faces, or none; a box that does not fit the geometry.
pub fn straight_transmittance(
    world: &World,
    corners: Option<[Vec3; 2]>,
    edges: Edges,
    directions: &[Vec3],
    samples: u64,
    seed: u64,
) -> Result<Vec<(Rgb, Rgb)>> {
    let cell = Cell::new(world, corners, edges)?;
    let side = ((samples as f64 / RAYS_A_FIELD).sqrt() as u64).clamp(1, MOST_SIDE);
    let one = |(i, towards): (usize, &Vec3)| {
        let direction = towards.try_normalize().filter(|d| d.z != 0.0).ok_or_else(|| {
            Error::value(format!("direction {i} is {towards}; expected one that leads through the faces"))
        })?;
        let face = Face { world, cell: &cell, direction, side, seed, stream: (i as u64) << 32 };
        Ok(face.transmittance(samples))
    };
    directions.par_iter().enumerate().map(one).collect()
}

/// The face that rays of one direction come in by, in `side` by `side` fields.
struct Face<'a> {
    world: &'a World,
    cell: &'a Cell,
    direction: Vec3,
    side: u64,
    seed: u64,
    /// The first of its sequences of points.
    stream: u64,
}

impl Face<'_> {
    /// Mean over the face and its standard error.
    fn transmittance(&self, samples: u64) -> (Rgb, Rgb) {
        let fields = self.side * self.side;
        let doubtful = self.doubtful();
        let edges = doubtful.iter().filter(|&&d| d).count() as u64;
        let spare = samples.saturating_sub(2 * PAIR * fields) / (PAIR * edges.max(1));
        let parts_a_side = ((spare + 1) as f64).sqrt() as u64;
        let (mut sum, mut variance) = (Rgb::ZERO, Rgb::ZERO);
        for field in 0..fields {
            let parts = if doubtful[field as usize] { parts_a_side.max(1) } else { 1 };
            let share = 1.0 / (fields * parts * parts) as f64;
            for part in 0..parts * parts {
                let [a, b] = [0, 1].map(|k| self.carried(1, field, parts, part, k));
                sum += 0.5 * share * (a + b);
                variance += (0.5 * share * (a - b)) * (0.5 * share * (a - b));
            }
        }
        (sum, variance.map(f64::sqrt))
    }

    /// Fields over which something changes, and those beside them.
    fn doubtful(&self) -> Vec<bool> {
        let side = self.side as usize;
        let looks: Vec<[f64; 2]> = (0..self.side * self.side)
            .map(|field| [0, 1].map(|k| luminance(self.carried(0, field, 1, 0, k))))
            .collect();
        let around = |at: usize| [(at + side - 1) % side, at, (at + 1) % side];
        let is_doubtful = |field: usize| {
            let first = looks[field][0];
            let beside =
                around(field / side).into_iter().flat_map(|row| around(field % side).map(|c| row * side + c));
            beside.flat_map(|other| looks[other]).any(|look| look != first)
        };
        (0..looks.len()).map(is_doubtful).collect()
    }

    /// What a ray carries through that comes in anywhere in a part of a field.
    fn carried(&self, look: u64, field: u64, parts: u64, part: u64, number: u64) -> Rgb {
        let stream = self.stream + (look << 31) + field;
        let mut sampler = Sampler::new(self.seed, stream, PAIR * part + number);
        let [u, v] = sampler.next_2d();
        let place = |field: u64, part: u64, u: f64| {
            (field as f64 + (part as f64 + u) / parts as f64) / self.side as f64
        };
        let at = [place(field / self.side, part / parts, u), place(field % self.side, part % parts, v)];
        let ray = self.cell.entering(self.direction, at);
        straight(self.world, self.cell, ray, &mut sampler)
    }
}
