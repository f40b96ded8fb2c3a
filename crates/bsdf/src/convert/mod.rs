//! A product in another basis, turned, turned over, its sides exchanged, made reciprocal: by flux, never by samples of points.

mod motion;
mod planes;
mod reciprocity;
mod resample;

use crate::{
    bsdf::{Bsdf, Sides},
    distribution::Distribution,
    layout::Layout,
    synthetic::Basis,
    table::Table,
    work::Work,
    xml::Document,
};
use motion::Motion;
use resample::{Resampling, Tables};
use std::sync::Arc;
use sunpeak_core::{Error, Result};

/// What to do, in this order: sides, turn, basis, reciprocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conversion {
    /// The new basis; none: the old one (of a tree, its smallest cells everywhere if anything is moved).
    pub basis: Option<Basis>,
    /// Turn the product over about its up axis: the front comes to the back, left and right change places.
    pub flip: bool,
    /// Exchange what is called front and back, with all directions as they are: mends a file with wrong names.
    pub swap_sides: bool,
    /// Turn it about its normal [deg], counterclockwise seen from the front.
    pub rotate_deg: f64,
    /// Replace each value and its partner by their mean: f(in, out) of one side and f(out, in) of the other.
    pub reciprocal: bool,
    /// Put what the split takes for the peak where a delta lies in the new basis, instead of the old cells' flux.
    pub keep_peak: bool,
}

impl Conversion {
    /// What was done, for the file.
    fn in_words(&self) -> String {
        let mut done = Vec::new();
        if self.flip {
            done.push("turned over about its up axis".to_owned());
        }
        if self.swap_sides {
            done.push("names of front and back exchanged".to_owned());
        }
        if self.rotate_deg != 0.0 {
            done.push(format!("turned by {} degrees", self.rotate_deg));
        }
        if let Some(basis) = self.basis {
            done.push(format!("converted to {basis} by flux"));
        }
        if self.keep_peak {
            done.push("with its through peak as a delta".to_owned());
        }
        if self.reciprocal {
            done.push("averaged by reciprocity".to_owned());
        }
        if done.is_empty() { String::new() } else { format!("Sunpeak: {}.", done.join(", ")) }
    }
}

/// A side and mode by its name in the file.
type Named = (&'static str, Tables);

const NAMES: [&str; 4] = ["Transmission Front", "Transmission Back", "Reflection Front", "Reflection Back"];

impl Bsdf {
    /// The same product otherwise tabulated. Flux is kept: each new value is the mean of the old table over its pair of cells.
    ///
    /// # Errors
    /// Where the angle is not finite, or the tables cannot be made reciprocal.
    pub fn convert(&self, to: &Conversion) -> Result<Self> {
        self.convert_watched(to, &Work::default())
    }

    /// As [`Self::convert`], as work that is watched and kept.
    ///
    /// # Errors
    /// As there; when the work is stopped.
    pub fn convert_watched(&self, to: &Conversion, work: &Work) -> Result<Self> {
        if !to.rotate_deg.is_finite() {
            return Err(Error::value(format!(
                "rotation by {} degrees; expected a finite angle",
                to.rotate_deg
            )));
        }
        let motion = Motion { mirror_x: to.flip, turn: to.rotate_deg.rem_euclid(360.0).to_radians() };
        let old = self.own_distributions();
        let layouts: Vec<Option<Layout>> = old.iter().map(|(_, d)| new_layout(d, to, motion)).collect();
        let resamplings: Vec<Option<Resampling>> = old
            .iter()
            .zip(&layouts)
            .map(|((_, d), layout)| layout.as_ref().map(|l| Resampling::new(d, l, motion, to.keep_peak)))
            .collect();
        work.expect(resamplings.iter().flatten().map(Resampling::amount).sum());
        let mut named: Vec<Named> = Vec::new();
        for ((name, distribution), resampling) in old.iter().zip(&resamplings) {
            let tables = match resampling {
                Some(resampling) => resampling.tables(name, work)?,
                None => (distribution.luminous().clone(), distribution.color().cloned()),
            };
            named.push((if to.flip != to.swap_sides { other_side(name) } else { name }, tables));
        }
        if to.reciprocal {
            make_reciprocal(&mut named)?;
        }
        let structure = match (to.basis, named.first()) {
            (Some(basis), _) => basis.structure().into(),
            (None, Some((_, (Table::Tree(tree), _)))) => format!("TensorTree{}", tree.rank()),
            _ => self.structure.clone(),
        };
        let mut document = Document { structure, ..self.document() };
        let said = [document.comments.trim(), &to.in_words()].map(String::from);
        document.comments = said.into_iter().filter(|s| !s.is_empty()).collect::<Vec<_>>().join("\n");
        Ok(Self::from_sides(document, sides(named)))
    }
}

fn other_side(name: &str) -> &'static str {
    let other = match name {
        "Transmission Front" => 1,
        "Transmission Back" => 0,
        "Reflection Front" => 3,
        _ => 2,
    };
    NAMES[other]
}

/// The cells that a table is brought into; none: it stays as it is.
fn new_layout(distribution: &Distribution, to: &Conversion, motion: Motion) -> Option<Layout> {
    let old = distribution.luminous();
    let is_moved = !(motion.is_none() || old.is_isotropic() && !motion.mirror_x);
    let stays = to.basis.is_none() && !is_moved && !to.reciprocal && !to.keep_peak;
    (!stays).then(|| to.basis.map_or_else(|| Layout::of(old), Basis::layout))
}

/// Transmission of both sides with each other, reflection of each with itself. One transmission alone is reciprocal by being used
/// for both.
fn make_reciprocal(named: &mut [Named]) -> Result<()> {
    let place = |name: &str| named.iter().position(|n| n.0 == name);
    let mut pairs: Vec<[usize; 2]> =
        NAMES[2..].iter().filter_map(|name| place(name)).map(|n| [n, n]).collect();
    if let (Some(front), Some(back)) = (place(NAMES[0]), place(NAMES[1])) {
        pairs.push([front, back]);
    }
    for [one, other] in pairs {
        let (mean_one, mean_other) =
            (mean(&named[one].1, &named[other].1)?, mean(&named[other].1, &named[one].1)?);
        named[one].1 = mean_one;
        named[other].1 = mean_other;
    }
    Ok(())
}

fn mean((own, own_color): &Tables, (other, other_color): &Tables) -> Result<Tables> {
    let layout = Layout::of(own);
    if layout != Layout::of(other) {
        let message =
            "reciprocity: front and back are not in the same cells; expected a conversion into one basis";
        return Err(Error::value(message));
    }
    let with = |plane: Option<&Vec<f32>>, table: &Table| match plane {
        Some(values) => table.with_values(values.clone()).unwrap_or_else(|| table.clone()),
        None => table.clone(),
    };
    let plane = |own: Table, other: Table| -> Result<Table> {
        let partner = reciprocity::partner(&other, &layout)?;
        let width = layout.exiting.len();
        Ok(layout.table(|i, o| 0.5 * (reciprocity::at(&own, &layout, i, o) + partner[i * width + o])))
    };
    let luminous = plane(own.clone(), other.clone())?;
    if own_color.is_none() && other_color.is_none() {
        return Ok((luminous, None));
    }
    // A side without colour is gray: X and Z as its Y.
    let band = |k: usize| -> Result<Vec<f32>> {
        let of = |color: &Option<[Vec<f32>; 2]>, table: &Table| with(color.as_ref().map(|c| &c[k]), table);
        Ok(plane(of(own_color, own), of(other_color, other))?.into_values())
    };
    Ok((luminous, Some([band(0)?, band(1)?])))
}

fn sides(named: Vec<Named>) -> Sides {
    let mut sides = Sides::default();
    for (name, (table, color)) in named {
        let transmission = name.starts_with("Transmission");
        let distribution = Arc::new(if transmission {
            Distribution::with_split(table, color)
        } else {
            Distribution::new(table, color)
        });
        let place = match name {
            "Transmission Front" => &mut sides.transmission_front,
            "Transmission Back" => &mut sides.transmission_back,
            "Reflection Front" => &mut sides.reflection_front,
            _ => &mut sides.reflection_back,
        };
        *place = Some(distribution);
    }
    sides
}
