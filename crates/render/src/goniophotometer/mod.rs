//! A virtual goniophotometer: the BSDF of a product from its geometry and materials.
//!
//! Light comes in through a face of a box, evenly over the face and, for each incident cell of the basis, evenly over the cell's
//! projected solid angle; walks follow it through the product, and are counted in the cell in which they leave. So a value is the
//! average over both cells: flux out over flux in, over the projected solid angle of the exiting cell. What goes straight through is
//! told apart: it is traced by rays of its own, and becomes the exact peak of the split.
//!
//! Walks are those of genBSDF (Ward, Radiance): rays, which by reciprocity tell what light does in either direction. x is to the
//! right, y up, z out of the front into the room, as in a BSDF's frame.

mod cell;
mod column;
mod generated;
mod state;
mod through;
mod walk;

pub use cell::Edges;
pub use column::Side;
pub use generated::{Generated, GeneratedColumn, GeneratedSide};
pub use through::straight_transmittance;

use crate::World;
use crate::accel::rays_of_this_thread;
use cell::Cell;
use column::{Column, Effort, Tracer};
use rayon::prelude::*;
use state::Finished;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use sunpeak_bsdf::synthetic::Basis;
use sunpeak_bsdf::table::Columns;
use sunpeak_core::{Control, Error, Result, Vec3};

/// Most cells a side of an anisotropic tree: 64^4 cells take 1.2 GB while they are counted.
const MOST_SIDE_T4: usize = 64;

/// Walks of a column unless the caller says: of a matrix, of a tree of rank 3 and 4.
pub const DEFAULT_COLUMN_SAMPLES: [u64; 3] = [1 << 15, 1 << 17, 1 << 13];

/// A column that is not good enough gets up to so many times the walks.
const MOST_OVER_LEAST: u64 = 16;

/// How a BSDF is generated.
#[derive(Clone, Debug)]
pub struct GonioOptions {
    /// The basis of the tables.
    pub basis: Basis,
    /// Smallest and largest corner of the sampled box; none: the box around the geometry.
    pub corners: Option<[Vec3; 2]>,
    /// What lies beside it.
    pub edges: Edges,
    /// The sides that light comes from.
    pub sides: Vec<Side>,
    /// Walks of each column at least; none: by the basis.
    pub samples: Option<u64>,
    /// A column goes on, up to 16 times `samples`, until the root sum of squares of its cells' standard errors is this share of
    /// what it scatters.
    pub error: f64,
    /// Cells of a tree come together where they differ by no more than this share of their mean, or by no more than their errors.
    pub tolerance: f64,
    /// Average values that Helmholtz's reciprocity makes equal.
    pub reciprocity: bool,
    /// Three channels.
    pub colored: bool,
    /// Keep the standard error of every cell.
    pub cell_errors: bool,
    /// The same seed gives the same table, on any number of threads.
    pub seed: u64,
    /// Threads to use; `None` is all cores.
    pub threads: Option<usize>,
    /// Where finished columns are kept if the work is stopped.
    pub state: Option<PathBuf>,
    /// Go on from there.
    pub resume: bool,
}

impl GonioOptions {
    /// Of a basis, both sides.
    pub fn new(basis: Basis) -> Self {
        Self {
            basis,
            corners: None,
            edges: Edges::Open,
            sides: vec![Side::Front, Side::Back],
            samples: None,
            error: 0.01,
            tolerance: 0.05,
            reciprocity: true,
            colored: false,
            cell_errors: false,
            seed: 0,
            threads: None,
            state: None,
            resume: false,
        }
    }

    fn effort(&self) -> Result<Effort> {
        let [matrix, t3, t4] = DEFAULT_COLUMN_SAMPLES;
        let usual = match self.basis {
            Basis::TensorTree3 { .. } => t3,
            Basis::TensorTree4 { .. } => t4,
            _ => matrix,
        };
        let samples = self.samples.unwrap_or(usual);
        let sound = (1..=1 << 32).contains(&samples);
        if !sound {
            return Err(Error::value(format!("samples is {samples}; expected 1 to 2^32")));
        }
        let share = |name: &str, value: f64| {
            let message = || Error::value(format!("{name} is {value}; expected a share from 0 to 1"));
            (0.0..=1.0).contains(&value).then_some(()).ok_or_else(message)
        };
        share("error", self.error)?;
        share("tolerance", self.tolerance)?;
        Ok(Effort {
            samples,
            most_samples: samples * MOST_OVER_LEAST,
            error: self.error,
            seed: self.seed,
            colored: self.colored,
        })
    }
}

/// One run: what is traced, and how.
struct Job<'a> {
    world: &'a World,
    cell: Cell,
    incident: Columns,
    exiting: Columns,
    effort: Effort,
    basis: Basis,
    edges: Edges,
    sides: &'a [Side],
}

impl Job<'_> {
    fn columns(&self) -> usize {
        self.sides.len() * self.incident.len()
    }

    fn channels(&self) -> usize {
        if self.effort.colored { 3 } else { 1 }
    }

    fn place(&self, number: usize) -> (Side, usize) {
        (self.sides[number / self.incident.len()], number % self.incident.len())
    }

    /// All that the columns depend on beside the scene.
    fn choices(&self) -> String {
        format!("{:?} {:?} {:?} {:?} {:?}", self.basis, self.cell, self.edges, self.sides, self.effort)
    }
}

/// Generate a BSDF. The world's `aBSDF` materials go straight by the rule that it was compiled with; its lights are black.
///
/// # Errors
/// Where the box, the geometry or the options do not fit, with what to do; [`Error::Interrupted`] when stopped, after the finished
/// columns were saved to `options.state`.
pub fn generate_bsdf(world: &World, options: &GonioOptions, control: &Control) -> Result<Generated> {
    if matches!(options.basis, Basis::TensorTree4 { side } if side > MOST_SIDE_T4) {
        return Err(Error::value(format!(
            "an anisotropic tensor tree of more than {MOST_SIDE_T4} cells a side; this is the most, t4-4096"
        )));
    }
    if options.sides.is_empty() {
        return Err(Error::value("no side to trace; expected the front, the back or both"));
    }
    let [incident, exiting] = options.basis.divisions();
    let (cell, effort) = (Cell::new(world, options.corners, options.edges)?, options.effort()?);
    let job = Job {
        world,
        cell,
        incident,
        exiting,
        effort,
        basis: options.basis,
        edges: options.edges,
        sides: &options.sides,
    };
    let before = match (&options.state, options.resume) {
        (Some(path), true) => state::load(path, &job)?,
        _ => vec![None; job.columns()],
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.unwrap_or(0))
        .build()
        .map_err(|e| Error::value(format!("cannot start {:?} threads: {e}", options.threads)))?;
    let rays = AtomicU64::new(0);
    let (finished, outcome) = pool.install(|| trace(&job, before, &rays, control));
    if let Err(error) = outcome {
        if let (Error::Interrupted, Some(path)) = (&error, &options.state) {
            state::save(path, &job, &finished)?;
        }
        return Err(error);
    }
    world.check_expressions()?;
    let columns: Vec<Column> = finished.into_iter().flatten().collect();
    let generated = pool.install(|| generated::assemble(&job, options, columns, rays.into_inner()))?;
    if let Some(path) = &options.state {
        let _ = std::fs::remove_file(path);
    }
    Ok(generated)
}

/// Trace the columns that are not finished.
fn trace(job: &Job, before: Finished, rays: &AtomicU64, control: &Control) -> (Finished, Result<()>) {
    control.set_total(job.columns() as u64);
    control.advance(before.iter().flatten().count() as u64);
    let open: Vec<usize> = (0..before.len()).filter(|&i| before[i].is_none()).collect();
    let finished = Mutex::new(before);
    let tracer = Tracer {
        world: job.world,
        cell: &job.cell,
        incident: &job.incident,
        exiting: &job.exiting,
        effort: job.effort,
    };
    let outcome = open.into_par_iter().with_max_len(1).try_for_each(|number| {
        let (side, column) = job.place(number);
        let so_far = rays_of_this_thread();
        let traced = tracer.column(side, column, control);
        rays.fetch_add(rays_of_this_thread() - so_far, Ordering::Relaxed);
        let traced = traced?;
        finished.lock().unwrap_or_else(|e| e.into_inner())[number] = Some(traced);
        control.advance(1);
        Ok(())
    });
    (finished.into_inner().unwrap_or_else(|e| e.into_inner()), outcome)
}

#[cfg(test)]
mod tests;
