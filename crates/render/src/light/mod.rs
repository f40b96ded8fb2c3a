//! Emitters as shadow rays see them: suns, the rest of the sky, lamps.

mod distant;
mod dome;
mod lamp;
mod lamps;

pub(crate) use distant::{Distant, DistantSources, at_infinity};
pub(crate) use lamp::{Lamp, LampShape};
pub(crate) use lamps::Lamps;

use sunpeak_core::{Rgb, Vec3};

/// A direction towards an emitter, drawn for a shadow ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSample {
    /// Unit vector.
    pub direction: Vec3,
    /// Distance to the emitter [m], infinity for distant ones.
    pub distance: f64,
    /// What it sends here if nothing is in between.
    pub light: Light,
    /// Density [1/sr].
    pub pdf: f64,
    /// Solid angle of the whole emitter from here [sr].
    pub solid_angle: f64,
    /// Is it a light source here (and not seen by indirect rays only)?
    pub is_direct: bool,
    /// Is it the sky, or another wide source at infinity?
    pub is_dome: bool,
    /// The object that emits, if it is in the room.
    pub object: Option<u32>,
    /// May an `illum` on the way take its place?
    pub is_hidden_by_illum: bool,
}

/// What an emitter sends, or where to ask for it: shadow rays that meet something need not know.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Light {
    /// Radiance.
    Known(Rgb),
    /// Of a source at infinity: its index.
    OfSource(usize),
}

impl Light {
    /// Is it known to be nothing?
    pub fn is_none(&self) -> bool {
        matches!(self, Self::Known(radiance) if *radiance == Rgb::ZERO)
    }
}

/// Weight of the strategy with density `this` when `other` could have found the same path (Veach 1997, power heuristic).
pub(crate) fn power_heuristic(this: f64, other: f64) -> f64 {
    let (a, b) = (this * this, other * other);
    if a.is_finite() && a + b > 0.0 { a / (a + b) } else { f64::from(u8::from(this > other)) }
}
