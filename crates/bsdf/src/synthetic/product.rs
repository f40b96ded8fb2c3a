//! What a product has to say of itself to be tabulated.

use crate::kernel::Spread;
use glam::DVec2;
use std::fmt::Debug;

/// A product in closed form, for light that meets one side. Points are those of [`crate::table`]: light that goes straight
/// through has `p_out = p_in`.
pub trait Product: Debug + Sync {
    /// What the file calls it.
    fn name(&self) -> String;

    /// Through transmittance [-]: the truth that a split is measured against.
    fn through(&self, p_in: DVec2) -> f64;

    /// The smooth BTDF [1/sr], wide against the cells of a table.
    fn smooth(&self, p_in: DVec2, p_out: DVec2) -> f64;

    /// A scattering lobe around the straight direction that may be narrower than a cell.
    fn lobe(&self, _p_in: DVec2) -> Option<Lobe> {
        None
    }

    /// CIE X and Z of what is scattered over its Y; none for gray. What goes straight through holes is gray.
    fn tint(&self) -> Option<[f64; 2]> {
        None
    }

    /// CIE X and Z of what is reflected over its Y; none for gray.
    fn reflected_tint(&self) -> Option<[f64; 2]> {
        None
    }

    /// Diffuse reflectance [-] of the side that the light meets, and of the other one.
    fn reflectance(&self) -> [f64; 2];

    /// The same for all azimuths of incidence.
    fn is_isotropic(&self) -> bool {
        true
    }
}

/// A lobe by its flux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// Transmittance [-].
    pub flux: f64,
    /// Its shape.
    pub spread: Spread,
}

/// Light that meets the other side of a product: by reciprocity.
#[derive(Debug)]
pub(super) struct OtherSide<'a>(pub &'a dyn Product);

impl Product for OtherSide<'_> {
    fn name(&self) -> String {
        self.0.name()
    }

    fn through(&self, p_in: DVec2) -> f64 {
        self.0.through(-p_in)
    }

    fn smooth(&self, p_in: DVec2, p_out: DVec2) -> f64 {
        self.0.smooth(-p_in, -p_out)
    }

    fn lobe(&self, p_in: DVec2) -> Option<Lobe> {
        self.0.lobe(-p_in)
    }

    fn tint(&self) -> Option<[f64; 2]> {
        self.0.tint()
    }

    fn reflectance(&self) -> [f64; 2] {
        let [front, back] = self.0.reflectance();
        [back, front]
    }
}
