//! Sampling a matrix: blocks are runs of patches; of one patch in all but the largest matrices.

use super::{Choice, Target, most_blocks};
use crate::{basis::AngleBasis, table::Matrix};
use glam::DVec2;
use std::sync::Arc;
use sunpeak_core::{Rgb, luminance};

/// The patches of a matrix as rays meet them.
#[derive(Debug)]
pub struct Patches {
    target: Target,
    /// Where rays come from, and where they go.
    fixed: Arc<AngleBasis>,
    sampled: Arc<AngleBasis>,
    /// The ring of each patch where rays go.
    rings: Vec<u32>,
    /// Patches in a block.
    run: usize,
    /// -1 against the table, where patches are those of the opposite side: turned by half a circle.
    facing: f64,
}

impl Patches {
    /// Of a matrix.
    pub fn new(target: &Target, matrix: &Matrix) -> Self {
        let (incident, exiting) = (matrix.incident.clone(), matrix.exiting.clone());
        let reversed = target.oriented.reversed;
        let (fixed, sampled) = if reversed { (exiting, incident) } else { (incident, exiting) };
        let blocks = (most_blocks(matrix.values.len()) / fixed.len()).max(1);
        let run = sampled.len().div_ceil(blocks);
        let rings = sampled.rings().iter().enumerate();
        let rings = rings.flat_map(|(n, ring)| std::iter::repeat_n(n as u32, ring.phi_count)).collect();
        Self { target: target.clone(), fixed, sampled, rings, run, facing: if reversed { -1.0 } else { 1.0 } }
    }

    /// How many columns.
    pub fn columns(&self) -> usize {
        self.fixed.len()
    }

    /// The column of an incident point.
    pub fn column(&self, p_in: DVec2) -> usize {
        self.fixed.index(self.facing * p_in)
    }

    /// Blocks in a column.
    pub fn blocks(&self) -> usize {
        self.sampled.len().div_ceil(self.run)
    }

    fn value(&self, column: usize, patch: usize) -> Rgb {
        let (incident, index) = if self.target.oriented.reversed {
            (patch, patch * self.fixed.len() + column)
        } else {
            (column, column * self.sampled.len() + patch)
        };
        self.target.value(incident, index)
    }

    fn flux(&self, column: usize, patch: usize) -> Rgb {
        self.value(column, patch) * self.sampled.projected_solid_angle(patch)
    }

    /// The flux of each part of a column [-], with its block.
    pub fn for_each_flux(&self, column: usize, mut visit: impl FnMut(usize, Rgb)) {
        for patch in 0..self.sampled.len() {
            visit(patch / self.run, self.flux(column, patch));
        }
    }

    /// A point of a block, in proportion to the values, and its patch's value [1/sr]; `pick` gives a random number where one patch
    /// of several has to be chosen.
    #[inline]
    pub fn point(
        &self,
        column: usize,
        block: usize,
        pick: impl Fn() -> f64,
        u: [f64; 2],
    ) -> Option<(DVec2, Option<Rgb>)> {
        let first = block * self.run;
        let patch = if self.run == 1 {
            first
        } else {
            let mut choice = Choice::new(pick());
            for patch in first..(first + self.run).min(self.sampled.len()) {
                choice.offer(luminance(self.flux(column, patch)), patch);
            }
            choice.taken()?
        };
        let ring = &self.sampled.rings()[self.rings[patch] as usize];
        Some((self.facing * ring.point(patch, u), Some(self.value(column, patch))))
    }
}
