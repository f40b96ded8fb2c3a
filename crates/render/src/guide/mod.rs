//! Where light comes into a room behind a shade: directions that diffuse surfaces try beside their own.
//!
//! Light that a shade scatters can be found by no shadow ray from the room; a path has to meet the shade and go on from there.
//! Two things are known beforehand: where the shades are, and into which directions they scatter the sun, in a table without its
//! peak extracted a thousandfold within one cell. So directions are drawn in part towards the shades, evenly over the solid angle
//! that they have, in part against the directions in which a shade's table sends the light of a sun, and the rest from the surface's
//! own lobes. The density of the mixture is known, so nothing is biased (Veach 1997, section 9.2: one-sample model with the balance heuristic).

mod shades;
mod sun;

use crate::shapes::{Quad, Triangle};
use shades::ShadesAt;
pub(crate) use sun::ScatteredSun;
use sunpeak_core::Vec3;

/// Share of directions that go to the shades, and against the scattered suns. The rest, the surface's own, keeps every weight
/// below 1/(1 - these) of what it would be without a guide.
const TO_SHADES: f64 = 0.3;
const AGAINST_SUNS: f64 = 0.2;

/// With more triangles of shades than this, looking at each of them costs more than it brings. (Two that make a quadrilateral are looked at
/// as one.)
pub(crate) const MAX_TRIANGLES: usize = 32;

/// With more pairs of sun and shade than this, likewise.
const MAX_SCATTERED_SUNS: usize = 8;

/// Directions worth trying from any diffuse surface.
#[derive(Clone, Debug)]
pub(crate) struct Guide {
    shades: Vec<Quad>,
    suns: Vec<ScatteredSun>,
    /// One direction each way, and one in all.
    one_each: Rates,
    one_in_all: Rates,
}

/// How many directions of each kind are drawn at a vertex, on average.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rates {
    /// Of the surface's own lobes.
    pub own: f64,
    /// Towards the shades.
    pub shades: f64,
    /// Against the scattered suns.
    pub suns: f64,
}

/// The guide as a point sees it.
#[derive(Clone, Debug)]
pub(crate) struct GuideAt<'g> {
    guide: &'g Guide,
    shades: ShadesAt<'g>,
    /// How many directions are drawn there.
    pub rates: &'g Rates,
}

impl Guide {
    /// From the triangles of scattering, transmitting surfaces and the suns that they scatter; `None` if there is nothing to
    /// guide to.
    pub fn new(mut shades: Vec<Triangle>, mut suns: Vec<ScatteredSun>) -> Option<Self> {
        suns.truncate(MAX_SCATTERED_SUNS);
        if shades.len() > MAX_TRIANGLES {
            shades.clear();
        }
        let [some_shades, some_suns] =
            [shades.is_empty(), suns.is_empty()].map(|none| f64::from(u8::from(!none)));
        let one_each = Rates { own: 1.0, shades: some_shades, suns: some_suns };
        let (to_shades, against_suns) = (TO_SHADES * some_shades, AGAINST_SUNS * some_suns);
        let one_in_all = Rates { own: 1.0 - to_shades - against_suns, shades: to_shades, suns: against_suns };
        let is_some = !shades.is_empty() || !suns.is_empty();
        is_some.then(|| Self { shades: Quad::joined(&shades), suns, one_each, one_in_all })
    }

    /// As seen from a point, where one direction each way is drawn, or one in all.
    pub fn at(&self, point: Vec3, each_way: bool) -> GuideAt<'_> {
        let rates = if each_way { &self.one_each } else { &self.one_in_all };
        GuideAt { guide: self, shades: ShadesAt::new(&self.shades, point), rates }
    }
}

impl GuideAt<'_> {
    /// Draw a direction towards a shade.
    pub fn sample_shades(&self, u: [f64; 3]) -> Option<Vec3> {
        self.shades.sample(u)
    }

    /// Draw a direction against which a sun is scattered.
    pub fn sample_suns(&self, u: [f64; 3]) -> Option<Vec3> {
        let at = u[0] * self.guide.suns.len() as f64;
        self.guide.suns.get(at as usize)?.sample([at.fract(), u[1], u[2]])
    }

    /// Density [1/sr] of the guided directions.
    pub fn pdf(&self, direction: Vec3) -> f64 {
        let rates = self.rates;
        let towards = rates.shades * self.shades.pdf(direction);
        if self.guide.suns.is_empty() { towards } else { towards + rates.suns * self.suns_pdf(direction) }
    }

    /// Density [1/sr] of the directions against the suns: apart, since most rooms have none of these.
    #[inline(never)]
    fn suns_pdf(&self, direction: Vec3) -> f64 {
        let suns = &self.guide.suns;
        suns.iter().map(|sun| sun.pdf(direction)).sum::<f64>() / suns.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_shades_there_is_no_guide() {
        assert!(Guide::new(Vec::new(), Vec::new()).is_none());
    }
}
