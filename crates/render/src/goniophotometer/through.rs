//! What goes straight through a product in one direction, as a number of its own.

use super::cell::{Cell, Edges};
use super::walk::straight;
use crate::World;
use rayon::prelude::*;
use sunpeak_core::{Error, Result, Rgb, Sampler, Vec3};

/// Independent sets of points, from which the error is told.
const SETS: u64 = 8;

/// Through transmittance [-] of the sampled box for rays in these directions (of any length), and its standard error in each channel, by
/// `samples` rays each. Wide enough a box or periodic edges make it that of the product.
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
    let in_set = samples.div_ceil(SETS).max(1);
    let one = |(i, towards): (usize, &Vec3)| {
        let direction = towards.try_normalize().filter(|d| d.z != 0.0).ok_or_else(|| {
            Error::value(format!("direction {i} is {towards}; expected one that leads through the faces"))
        })?;
        let set = |set: u64| -> Rgb {
            let ray = |index| {
                let mut sampler = Sampler::new(seed, ((i as u64) << 8) + set, index);
                let ray = cell.entering(direction, sampler.next_2d());
                straight(world, &cell, ray, &mut sampler)
            };
            (0..in_set).map(ray).sum::<Rgb>() / in_set as f64
        };
        let sets: Vec<Rgb> = (0..SETS).map(set).collect();
        let n = SETS as f64;
        let mean = sets.iter().sum::<Rgb>() / n;
        let variance = sets.iter().map(|s| (s - mean) * (s - mean)).sum::<Rgb>() / (n - 1.0);
        Ok((mean, (variance / n).map(f64::sqrt)))
    };
    directions.par_iter().enumerate().map(one).collect()
}
