//! One distribution in the cells of another basis: each new cell gets the flux of the old ones by the area that they share.
//!
//! The value of a new pair of cells is the mean of the old table over it. Between tables of the same kind it falls into a sum over
//! incident cells and one over exiting cells, both by exact areas. Between an isotropic table and one that is not the exit turns
//! with the azimuth of incidence: there the azimuths are cut into slices; areas are exact in each, the turn is that of its middle.

use super::{
    motion::{Motion, mirrored, turned},
    planes::Planes,
};
use crate::{
    distribution::Distribution,
    layout::Layout,
    overlap::{Region, between_azimuths},
    table::{Columns, Table},
    work::Work,
};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_4;
use sunpeak_core::Result;

/// Slices that are worked on together.
const BLOCK: usize = 32;

/// Slices for each cell around the rim of a square, and least slices for patches.
const SLICES_A_CELL: usize = 2;
const LEAST_SLICES: usize = 240;

/// More slices than this tell nothing new.
const MOST_SLICES: usize = 2880;

/// Off the border of two rows, along which the straight direction runs in isotropic trees.
const BESIDE: f64 = 1e-9;

/// A distribution in another layout.
pub struct Resampling<'a> {
    pub from: Planes<'a>,
    pub to: &'a Layout,
    pub motion: Motion,
    /// The split's peak goes into the cells in which a delta lies.
    pub keep_peak: bool,
}

/// A luminous table, and CIE X and Z in its cells.
pub type Tables = (Table, Option<[Vec<f32>; 2]>);

/// Azimuths of incidence [turns of 45 degrees] that are treated alike; none if all are.
type Slice = Option<[f64; 2]>;

/// For each new exiting cell the old ones by their share of its area.
struct Exits {
    first: Vec<usize>,
    shares: Vec<(u32, f64)>,
}

impl<'a> Resampling<'a> {
    pub fn new(distribution: &'a Distribution, to: &'a Layout, motion: Motion, keep_peak: bool) -> Self {
        let keep_peak = keep_peak && distribution.split().has_peak();
        Self { from: Planes::new(distribution, keep_peak), to, motion, keep_peak }
    }

    /// Columns or steps of the work that `tables` is.
    pub fn amount(&self) -> usize {
        match self.slices().len() {
            1 => self.to.incident.len(),
            slices => slices.div_ceil(BLOCK),
        }
    }

    /// The tables, as the part of the work with this name.
    pub fn tables(&self, name: &str, work: &Work) -> Result<Tables> {
        let (width, planes) = (self.to.exiting.len(), self.from.count());
        let slices = self.slices();
        let mut columns = match &slices[..] {
            [all] => {
                let exits = [self.exits(*all)];
                work.columns(name, self.to.incident.len(), |column| self.over(column, &slices, &exits))?
            }
            _ => {
                let flat = self.sliced(name, &slices, work)?;
                flat.chunks(planes * width).map(<[f32]>::to_vec).collect()
            }
        };
        if self.keep_peak {
            columns.par_iter_mut().enumerate().for_each(|(column, out)| self.add_peak(column, out));
        }
        let plane = |p: usize| self.to.table(|i, o| columns[i][p * width + o]);
        let color = (planes == 3).then(|| [plane(1).into_values(), plane(2).into_values()]);
        Ok((plane(0), color))
    }

    /// Values of all columns, one block of slices after the other.
    fn sliced(&self, name: &str, slices: &[Slice], work: &Work) -> Result<Vec<f32>> {
        let length = self.from.count() * self.to.exiting.len();
        let nothing = vec![0f32; self.to.incident.len() * length];
        let blocks: Vec<&[Slice]> = slices.chunks(BLOCK).collect();
        work.steps(name, blocks.len(), nothing, |number, values| {
            let block = blocks[number];
            let exits: Vec<Exits> = block.par_iter().map(|slice| self.exits(*slice)).collect();
            values.par_chunks_mut(length).enumerate().try_for_each(|(column, out)| {
                work.check()?;
                out.iter_mut().zip(self.over(column, block, &exits)).for_each(|(value, more)| *value += more);
                Ok(())
            })
        })
    }

    /// What some slices give to a column.
    fn over(&self, column: usize, slices: &[Slice], exits: &[Exits]) -> Vec<f32> {
        let region = self.to.incident.region(column);
        let whole = self.to.incident.projected_solid_angle(column);
        // Sums of many small shares need more digits than the values that come of them.
        let mut sums = vec![0.0; self.from.count() * self.to.exiting.len()];
        for (slice, exits) in slices.iter().zip(exits) {
            self.add(&region, whole, *slice, exits, &mut sums);
        }
        sums.into_iter().map(|sum| sum as f32).collect()
    }

    fn slices(&self) -> Vec<Slice> {
        let (from, to) = (&self.from.layout, self.to);
        if from.is_isotropic() == to.is_isotropic() {
            return vec![None];
        }
        let turned = if from.is_isotropic() { &to.incident } else { &from.incident };
        let count = match turned {
            Columns::Square { side } | Columns::Radial { side } => 4 * side * SLICES_A_CELL,
            // So many that the borders of all patches are borders of slices.
            Columns::Patches(basis) => basis.rings().iter().fold(LEAST_SLICES, |n, ring| {
                let edges = 2 * ring.phi_count;
                let common = n / greatest_common_divisor(n, edges) * edges;
                if common <= MOST_SLICES { common } else { n }
            }),
        };
        let width = 8.0 / count as f64;
        (0..count).map(|k| Some([k as f64 * width, (k + 1) as f64 * width])).collect()
    }

    /// Where the new exiting cells lie in the old table.
    fn exits(&self, slice: Slice) -> Exits {
        let isotropic = self.from.layout.is_isotropic();
        let middle = slice.map_or(0.0, |[low, high]| 0.5 * (low + high) * FRAC_PI_4);
        let place = |cell: usize| {
            let region = self.to.exiting.region(cell);
            match (isotropic, self.to.is_isotropic()) {
                (true, _) => {
                    let there = turned(region, -middle);
                    if self.motion.mirror_x { mirrored(&there, false) } else { there }
                }
                (false, true) => self.motion.undo_region(turned(region, middle)),
                (false, false) => self.motion.undo_region(region),
            }
        };
        let mut exits = Exits { first: vec![0], shares: Vec::new() };
        for cell in 0..self.to.exiting.len() {
            let whole = self.to.exiting.projected_solid_angle(cell);
            let shares = self.from.layout.exiting.shares(&place(cell));
            exits.shares.extend(shares.into_iter().map(|(at, shared)| (at, shared / whole)));
            exits.first.push(exits.shares.len());
        }
        exits
    }

    /// The old columns under a part of a new one.
    fn columns(&self, region: &Region, slice: Slice) -> Vec<(u32, f64)> {
        let sliced = slice.map(|edges| between_azimuths(region, edges));
        let there = sliced.as_ref().unwrap_or(region);
        if there.is_empty() {
            return Vec::new();
        }
        if self.from.layout.is_isotropic() {
            return self.from.layout.incident.shares(there);
        }
        self.from.layout.incident.shares(&self.motion.undo_region(there.clone()))
    }

    fn add(&self, region: &Region, whole: f64, slice: Slice, exits: &Exits, sums: &mut [f64]) {
        let columns = self.columns(region, slice);
        if columns.is_empty() {
            return;
        }
        let mut mixed = vec![vec![0.0; self.from.layout.exiting.len()]; self.from.count()];
        for (column, shared) in columns {
            self.from.add_column(column as usize, shared / whole, &mut mixed);
        }
        let width = self.to.exiting.len();
        for (plane, values) in mixed.iter().enumerate() {
            for cell in 0..width {
                let shares = &exits.shares[exits.first[cell]..exits.first[cell + 1]];
                let sum: f64 = shares.iter().map(|&(at, share)| share * values[at as usize]).sum();
                sums[plane * width + cell] += sum;
            }
        }
    }

    /// The peak's mean over a column, where it lands.
    fn add_peak(&self, column: usize, out: &mut [f32]) {
        let width = self.to.exiting.len();
        let points = self.peak_points(column);
        let sum: f64 = points.iter().map(|p| p.1).sum();
        let sides: &[f64] = if self.to.is_isotropic() { &[-BESIDE, BESIDE] } else { &[0.0] };
        let distribution = self.from.distribution;
        for (p, weight) in points {
            let through = distribution.split().through(distribution.columns(), self.motion.undo(p));
            let numbers = self.from.numbers(through);
            for &side in sides {
                let lands = if self.to.is_isotropic() { DVec2::new(p.length(), side) } else { p };
                let cell = self.to.exiting.index(lands);
                let share = weight / sum / sides.len() as f64 / self.to.exiting.projected_solid_angle(cell);
                for (plane, number) in numbers.into_iter().enumerate().take(self.from.count()) {
                    out[plane * width + cell] += (number * share) as f32;
                }
            }
        }
    }

    /// Points of a column with their weights: so many that the interpolated peak is as good as integrated.
    fn peak_points(&self, column: usize) -> Vec<(DVec2, f64)> {
        let middles = |n: usize| (0..n).map(move |i| (i as f64 + 0.5) / n as f64);
        match &self.to.incident {
            Columns::Radial { .. } => {
                let azimuths = if self.from.layout.is_isotropic() { 1 } else { 96 };
                let ring = |u: f64| self.to.incident.point(column, [u, 0.5]).x;
                let around = |r: f64| {
                    middles(azimuths).map(move |v| (r * DVec2::from_angle(std::f64::consts::TAU * v), r))
                };
                middles(32).flat_map(|u| around(ring(u))).collect()
            }
            division => {
                let n = if matches!(division, Columns::Patches(_)) { 24 } else { 8 };
                let point = |u: f64, v: f64| (division.point(column, [u, v]), 1.0);
                middles(n).flat_map(|u| middles(n).map(move |v| point(u, v)).collect::<Vec<_>>()).collect()
            }
        }
    }
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
