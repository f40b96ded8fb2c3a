//! Scattering models from formulas, and tables of them in any basis.
//!
//! A [`Model`] is a surface or sheet in closed form. Directions are unit vectors away from it; light comes from `to_light` and leaves
//! towards `exit`; the side with z > 0 is the one that a file calls front.

mod fresnel;
mod glossy;
mod microfacet;
mod sheet;
mod tabulate;

pub use glossy::{Lambert, Phong, Ward, bounded_ward_lobe};
pub use microfacet::{CookTorrance, Ggx};
pub use sheet::{Glass, Mirror};
pub use tabulate::tabulate;

use std::fmt::Debug;
use sunpeak_core::{Error, Result, Vec3};

/// A surface in closed form.
pub trait Model: Debug + Sync {
    /// What the file calls it.
    fn name(&self) -> String;

    /// BSDF [1/sr] without deltas.
    fn value(&self, to_light: Vec3, exit: Vec3) -> f64;

    /// Share of the light that goes straight on, and that is mirrored [-].
    fn deltas(&self, _to_light: Vec3) -> [f64; 2] {
        [0.0; 2]
    }

    /// Standard deviation of the slopes of its microfacets, or of a lobe [-]: how finely it has to be looked at around the mirrored
    /// and the straight direction; none for what is as wide as the hemisphere.
    fn width(&self) -> Option<f64> {
        None
    }

    /// The same at all azimuths of incidence.
    fn is_isotropic(&self) -> bool {
        true
    }

    /// Lets light through.
    fn transmits(&self) -> bool {
        false
    }

    /// Where its lobe is highest: the mirrored direction, or beyond the surface the straight one.
    fn axis(&self, to_light: Vec3, reflection: bool) -> Vec3 {
        if reflection { Vec3::new(-to_light.x, -to_light.y, to_light.z) } else { -to_light }
    }
}

/// A number that must lie within bounds, by its name.
fn within(model: &str, name: &str, value: f64, [low, high]: [f64; 2]) -> Result<()> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err(Error::value(format!("{model}: {name} is {value}; expected {low} to {high}")))
}

/// Shares that may not add up to more than all of the light.
fn together(model: &str, names: &str, sum: f64) -> Result<()> {
    if sum <= 1.0 + 1e-12 {
        return Ok(());
    }
    Err(Error::value(format!("{model}: {names} add up to {sum}; expected 1 or less, what comes in")))
}
