//! A layer that scatters: its BSDF by the split, in the bands that its files have.

use crate::bsdf::{Bsdf, Mode};
use glam::DVec2;
use std::sync::Arc;
use sunpeak_core::{Vec3, luminance};

use super::spectrum::Band;

/// A shade, a blind, a diffusing pane.
#[derive(Clone, Debug)]
pub struct Shade {
    /// Visible values.
    pub visible: Arc<Bsdf>,
    /// Solar values, if they are known.
    pub solar: Option<Arc<Bsdf>>,
    /// The file's back towards the outside.
    pub flipped: bool,
}

/// A range of wavelengths over which a shade is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// 0.38 to 0.78 um: its visible values.
    Visible,
    /// What is left of the solar values.
    Invisible,
}

impl Shade {
    /// Residual [1/sr] for light from a side (0 outside, 1 inside) that leaves on a side.
    pub fn residual(&self, range: Range, from: usize, to: usize, p: DVec2, q: DVec2) -> f64 {
        let (from, to, p, q) = self.turned(from, to, p, q);
        self.in_range(range, |bsdf| {
            let mode = if from == to { Mode::Reflection } else { Mode::Transmission };
            bsdf.distribution(lit_from(from), mode).map_or(0.0, |o| luminance(o.value(p, q, true)))
        })
    }

    /// Through transmittance [-] for light from a side.
    pub fn through(&self, range: Range, from: usize, p: DVec2) -> f64 {
        let (from, _, p, _) = self.turned(from, from, p, p);
        self.in_range(range, |bsdf| {
            bsdf.distribution(lit_from(from), Mode::Transmission).map_or(0.0, |o| luminance(o.through(p)))
        })
    }

    /// The same for all azimuths?
    pub fn is_isotropic(&self) -> bool {
        [Mode::Transmission, Mode::Reflection].iter().all(|&mode| {
            [0, 1].iter().all(|&from| {
                let table = self.visible.distribution(lit_from(from), mode);
                table.is_none_or(|o| o.distribution.luminous().is_isotropic())
            })
        })
    }

    /// Turned about its up axis: sides change, and left and right.
    fn turned(&self, from: usize, to: usize, p: DVec2, q: DVec2) -> (usize, usize, DVec2, DVec2) {
        let mirrored = |p: DVec2| DVec2::new(-p.x, p.y);
        if self.flipped { (1 - from, 1 - to, mirrored(p), mirrored(q)) } else { (from, to, p, q) }
    }

    /// Solar values are those of both ranges, each by its share of the sun's energy.
    fn in_range(&self, range: Range, of: impl Fn(&Bsdf) -> f64) -> f64 {
        let visible = of(&self.visible);
        match (range, &self.solar) {
            (Range::Invisible, Some(solar)) => {
                let share = Band::Solar.visible_share();
                ((of(solar) - share * visible) / (1.0 - share)).max(0.0)
            }
            _ => visible,
        }
    }
}

/// A file's front is its outside; rays meet it at the back of the BSDF's frame.
fn lit_from(side: usize) -> Vec3 {
    if side == 0 { Vec3::NEG_Z } else { Vec3::Z }
}
