//! Panes and shades behind each other as one BSDF.
//!
//! Light that keeps its direction (through panes and holes, mirrored by panes) keeps its point on the disk of projected
//! directions: there a layer is four numbers ([`Optics`]), and what goes straight through the whole system is known at every
//! point. What a shade scatters is the matrix algebra of Klems 1994 on the patches of a basis ([`Operators`]). In trees, light that is
//! scattered once is taken in the tree's own cells, and the rest, which is smooth, on a coarser grid.

mod cells;
mod glass;
mod operator;
mod optics;
mod shade;
mod solve;
mod spectrum;

pub use glass::{Curve, Pane, slab};
pub use operator::{Operator, Operators};
pub use optics::Optics;
pub use shade::{Range, Shade};
pub use solve::Panes;
pub use spectrum::Band;

use crate::codec::Encoder;
use glam::DVec2;
use std::io;
use sunpeak_core::{Error, Result};

/// One layer.
#[derive(Clone, Debug)]
pub enum Layer {
    /// Glass: it keeps all directions.
    Pane(Pane),
    /// What scatters.
    Shade(Shade),
}

/// Layers from outside to inside, with gaps of any width between them: light does not see the gap.
#[derive(Clone, Debug)]
pub struct System {
    /// What it is called.
    pub name: String,
    panes: Vec<Vec<Pane>>,
    shades: Vec<Shade>,
}

impl System {
    /// From outside to inside.
    pub fn new(name: String, layers: Vec<Layer>) -> Result<Self> {
        if layers.is_empty() {
            return Err(Error::value("system: no layers; expected at least one pane or shade"));
        }
        let mut system = Self { name, panes: vec![Vec::new()], shades: Vec::new() };
        for (n, layer) in layers.into_iter().enumerate() {
            match layer {
                Layer::Pane(pane) => {
                    pane.check().map_err(|e| Error::value(format!("layer {}: {e}", n + 1)))?;
                    if let Some(last) = system.panes.last_mut() {
                        last.push(pane);
                    }
                }
                Layer::Shade(shade) => {
                    system.shades.push(shade);
                    system.panes.push(Vec::new());
                }
            }
        }
        Ok(system)
    }

    /// Shades whose solar values nobody told.
    pub fn lacks_solar(&self) -> bool {
        self.shades.iter().any(|shade| shade.solar.is_none())
    }

    /// Sum up all layers.
    ///
    /// # Errors
    /// Of the encoder's writer.
    pub fn sum_up(&self, out: &mut Encoder<impl io::Write>) -> io::Result<()> {
        out.text(&format!("{:?}", self.panes))?;
        for shade in &self.shades {
            out.count(usize::from(shade.flipped))?;
            for bsdf in [Some(&shade.visible), shade.solar.as_ref()].into_iter().flatten() {
                bsdf.sum_up(out)?;
            }
        }
        Ok(())
    }

    fn check(&self, band: Band) -> Result<()> {
        if band == Band::Solar && self.lacks_solar() {
            return Err(Error::value(format!(
                "{}: a shade has no solar values; expected a file with a Solar band, or to ask for the visible alone",
                self.name
            )));
        }
        Ok(())
    }

    /// What keeps its direction at a point of the disk: straight through, and mirrored.
    pub fn straight(&self, band: Band, p: DVec2) -> Result<Optics> {
        self.check(band)?;
        Ok(self.straight_at(band, p))
    }

    fn straight_at(&self, band: Band, p: DVec2) -> Optics {
        let cosine = (1.0 - p.length_squared()).max(0.0).sqrt();
        self.straight_with(band, cosine, &|k, range, from| self.shades[k].through(range, from, p))
    }

    /// The same with other through transmittances of the shades, by shade, range and side.
    fn straight_with(&self, band: Band, cosine: f64, through: &dyn Fn(usize, Range, usize) -> f64) -> Optics {
        let of_range = |range: Range| -> Vec<Optics> {
            let holes = |k| Optics { t: [0, 1].map(|from| through(k, range, from)), r: [0.0; 2] };
            (0..self.shades.len()).map(holes).collect()
        };
        let shades = [of_range(Range::Visible), of_range(Range::Invisible)];
        Optics::mean(band.weights().iter().map(|&[um, weight]| {
            let shades = &shades[usize::from(range_of(um) == Range::Invisible)];
            let outermost = self.stack(0, um, cosine);
            let layers = shades.iter().enumerate();
            let whole = layers
                .fold(outermost, |all, (k, holes)| all.then(*holes).then(self.stack(k + 1, um, cosine)));
            (weight, whole)
        }))
    }

    /// The panes between two shades.
    fn stack(&self, k: usize, um: f64, cosine: f64) -> Optics {
        self.panes[k].iter().fold(Optics::CLEAR, |all, pane| all.then(pane.optics(um, cosine)))
    }
}

fn range_of(um: f64) -> Range {
    if spectrum::is_visible(um) { Range::Visible } else { Range::Invisible }
}
