//! Emitters: `light`, `illum`, `glow` and `spotlight`. They emit from their front only.
//!
//! How they count, as in Radiance:
//! - `light`, `illum` and `spotlight` are light sources: sampled by shadow rays, counted with any number of bounces;
//! - a `glow` is one within its `max_radius`; farther away (and at any distance for 0) it lights by indirect rays only, so
//!   its light counts as one bounce more. A negative radius: seen, but never lighting anything;
//! - an `illum` is a light source to rays that have been scattered, and its alternate material to all others.
//!
//! Every emitter that lights may be sampled here; the difference between the two kinds shows only where the number of
//! bounces is limited, and with the peak rules that follow Radiance.

use super::{Alternate, Step, tint_of};
use sunpeak_core::{Rgb, Vec3};
use sunpeak_scene::RayState;

/// A self-luminous material.
#[derive(Clone, Debug)]
pub(crate) struct Emitter {
    /// Radiance before patterns [W sr⁻¹ m⁻²].
    pub radiance: Rgb,
    /// Patterns, and mixtures of them, that multiply it.
    pub patterns: Vec<Step>,
    /// What kind it is.
    pub kind: EmitterKind,
}

/// Radiance's four emitters.
#[derive(Clone, Debug)]
pub(crate) enum EmitterKind {
    Light,
    Illum {
        alternate: Alternate,
    },
    Glow {
        max_radius: f64,
    },
    Spotlight {
        /// Unit axis of the cone.
        axis: Vec3,
        /// Cosine of half the opening angle.
        edge_cosine: f64,
        /// Distance of the focus behind the surface [m].
        focal_length: f64,
    },
}

impl Emitter {
    /// Radiance towards where the ray comes from. Patterns make nothing shine less than not at all.
    pub fn radiance(&self, ray: &RayState) -> Rgb {
        match self.kind {
            EmitterKind::Spotlight { axis, edge_cosine, .. } if axis.dot(-ray.direction) < edge_cosine => {
                Rgb::ZERO
            }
            _ if self.patterns.is_empty() => self.radiance,
            _ => (self.radiance * tint_of(&self.patterns, ray)).max(Rgb::ZERO),
        }
    }

    /// Factor on what it lights at a distance: a spotlight's light falls off as from its focus behind the surface.
    pub fn falloff(&self, distance: f64) -> f64 {
        match self.kind {
            EmitterKind::Spotlight { focal_length, .. } => (distance / (distance + focal_length)).powi(2),
            _ => 1.0,
        }
    }

    /// Does it light anything at all?
    pub fn illuminates(&self) -> bool {
        let is_lit = self.radiance.max_element() > 0.0;
        is_lit && !matches!(self.kind, EmitterKind::Glow { max_radius } if max_radius < 0.0)
    }

    /// Is it a light source (and not only seen by indirect rays) at this distance?
    pub fn is_direct(&self, distance: f64) -> bool {
        match self.kind {
            EmitterKind::Glow { max_radius } => distance <= max_radius,
            _ => true,
        }
    }

    /// Does an `illum` in front of it take its place (manual: glow sources never light things through an illum)?
    pub fn is_hidden_by_illum(&self) -> bool {
        matches!(self.kind, EmitterKind::Illum { .. } | EmitterKind::Glow { .. })
    }
}
