//! Functions of a ray that meets a surface: what patterns, textures, mixtures and function materials are made of.
//!
//! A [`Field`] holds compiled expressions, the frame in which they see the ray, and the data that they look up. Reference manual,
//! "Function files" and "Data files"; the variables of a ray are those that the head of Radiance's `rayinit.cal` lists.

mod data;
mod library;
mod ray;
mod spectrum;

pub use data::DataArray;
pub(crate) use library::{FieldPlan, FunctionFiles, Places};
pub use ray::RayState;
pub use spectrum::Spectrum;

use ray::Seen;
use std::sync::{Arc, OnceLock};
use sunpeak_cal::{Failure, Fault, Program};
use sunpeak_core::{Error, Location, Transform, Vec3};

/// Data files have at most this many dimensions here (Radiance: 5).
pub(crate) const MAX_DIMENSIONS: usize = 8;

/// One for each channel.
const MAX_ARRAYS: usize = 3;

/// Expressions over rays, and data.
#[derive(Debug)]
pub struct Field {
    pub(crate) program: Program,
    /// Data that is looked up before the functions are called; empty if the expressions are all.
    pub(crate) arrays: Vec<Arc<DataArray>>,
    /// How many of the first expressions are coordinates of the data.
    pub(crate) coordinates: usize,
    /// Does the function of value i take all values, or value i alone?
    pub(crate) takes_all: Vec<bool>,
    pub(crate) frame: FieldFrame,
    /// Type and name of the primitive, and where it stands.
    pub(crate) title: String,
    pub(crate) location: Location,
    pub(crate) fault: OnceLock<Fault>,
}

/// The frame of a function file: where a primitive's transform puts it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FieldFrame {
    to_local: Transform,
    to_world: Transform,
    /// Of `to_local`.
    scale: f64,
}

impl FieldFrame {
    pub fn new(to_world: Transform) -> Self {
        let to_local = to_world.inverse();
        Self { to_local, to_world, scale: to_local.scale() }
    }
}

impl Field {
    /// The first N values; `None` where the mathematics fails.
    pub fn values<const N: usize>(&self, ray: &RayState) -> Option<[f64; N]> {
        if self.fault.get().is_some() {
            return None;
        }
        let mut values = [0.0; N];
        let seen = Seen { ray, frame: &self.frame, arguments: self.program.arguments() };
        let mut started = self.program.start(&seen);
        let mut value = |root: usize, arguments: &[f64]| self.settle(started.value(root, arguments));
        if self.arrays.is_empty() {
            for (root, out) in values.iter_mut().enumerate() {
                *out = value(root, &[])?;
            }
            return Some(values);
        }
        let mut point = [0.0; MAX_DIMENSIONS];
        for (root, out) in point.iter_mut().enumerate().take(self.coordinates) {
            *out = value(root, &[])?;
        }
        let mut found = [0.0; MAX_ARRAYS];
        for (array, out) in self.arrays.iter().zip(&mut found) {
            *out = array.interpolate(&point[..self.coordinates]);
        }
        for (i, out) in values.iter_mut().enumerate() {
            let given = if self.takes_all[i] { &found[..self.arrays.len()] } else { &found[i..=i] };
            *out = value(self.coordinates + i, given)?;
        }
        Some(values)
    }

    /// The function's value for each wavelength [nm] (see [`Pattern::Spectral`](crate::Pattern::Spectral)); `None` where the mathematics
    /// fails.
    pub fn spectrum(&self, ray: &RayState, wavelengths_nm: &[f64]) -> Option<Vec<f64>> {
        let seen = Seen { ray, frame: &self.frame, arguments: self.program.arguments() };
        let mut started = self.program.start(&seen);
        let mut value = |root: usize, arguments: &[f64]| self.settle(started.value(root, arguments));
        let mut point = [0.0; MAX_DIMENSIONS];
        for (root, out) in point.iter_mut().enumerate().take(self.coordinates) {
            *out = value(root, &[])?;
        }
        let Some(array) = self.arrays.first() else {
            return wavelengths_nm.iter().map(|&nm| value(0, &[nm])).collect();
        };
        let mut sample = |nm: f64| {
            point[self.coordinates] = nm;
            value(self.coordinates, &[array.interpolate(&point[..=self.coordinates]), nm])
        };
        wavelengths_nm.iter().map(|&nm| sample(nm)).collect()
    }

    /// The value of expression `root` with these arguments; `None` where the mathematics fails.
    pub fn call(&self, ray: &RayState, root: usize, arguments: &[f64]) -> Option<f64> {
        let seen = Seen { ray, frame: &self.frame, arguments: self.program.arguments() };
        self.settle(self.program.start(&seen).value(root, arguments))
    }

    /// The value of expression `root` if it is the same for all rays.
    pub fn constant(&self, root: usize) -> Option<f64> {
        self.program.constant(root)
    }

    /// A direction in the field's own frame.
    pub fn local_direction(&self, direction: Vec3) -> Vec3 {
        self.frame.to_local.vector(direction) / self.frame.scale
    }

    /// A vector of the field's frame in world axes, its length kept.
    pub fn world_direction(&self, direction: Vec3) -> Vec3 {
        self.frame.to_world.vector(direction) * self.frame.scale
    }

    /// The data that the field looks up.
    pub fn arrays(&self) -> &[Arc<DataArray>] {
        &self.arrays
    }

    /// What is wrong with the definitions, if an evaluation has found that out.
    pub fn fault(&self) -> Option<Error> {
        let fault = self.fault.get()?;
        Some(Error::input(self.location.clone(), format!("{}: {fault}", self.title)))
    }

    fn settle(&self, value: Result<f64, Failure>) -> Option<f64> {
        match value {
            Ok(value) => Some(value),
            Err(Failure::Math) => None,
            Err(Failure::Fault(fault)) => {
                self.fault.get_or_init(|| fault);
                None
            }
        }
    }
}
