//! From a file to a [`Bsdf`]: its blocks get their sides, colour and split.

use crate::{
    bsdf::{Bsdf, Sides},
    cache::{Cache, Contents, Slot},
    distribution::Distribution,
    peak::Instrument,
    table::Table,
    xml::{self, Band, Block, Document},
};
use std::{fs::File, io::BufReader, path::Path, sync::Arc};
use sunpeak_core::{Error, Location, Result};

/// Bytes that are read at a time.
const BUFFER: usize = 1 << 18;

impl Bsdf {
    /// Read an LBNL XML file and split it, or read a split that [`Self::save_split`] wrote (its folder or its JSON file). Large files
    /// come from the user's [`Cache`] the second time.
    pub fn load(path: &Path) -> Result<Self> {
        Self::load_with(path, Cache::of_user().as_ref())
    }

    /// As [`Self::load`], with a cache of one's own or none.
    pub fn load_with(path: &Path, cache: Option<&Cache>) -> Result<Self> {
        if Self::is_split(path) {
            return Self::load_split(path);
        }
        let slot = cache.and_then(|cache| cache.slot(path));
        let contents = match slot.as_ref().and_then(Slot::get) {
            Some(contents) => contents,
            None => {
                let contents = split(&path.to_string_lossy(), read(path, Band::Visible)?, Instrument::None)?;
                slot.iter().for_each(|slot| slot.put(&contents));
                contents
            }
        };
        Ok(Self::from_sides(contents.document, contents.sides))
    }

    /// The tables of the solar band of an LBNL XML file, in the place of the luminous ones.
    pub fn load_solar(path: &Path) -> Result<Self> {
        let contents = split(&path.to_string_lossy(), read(path, Band::Solar)?, Instrument::None)?;
        Ok(Self::from_sides(contents.document, contents.sides))
    }

    /// As [`Self::load`], of a file whose peak an instrument has widened. It is not kept in the cache.
    pub fn load_measured(path: &Path, instrument: Instrument) -> Result<Self> {
        instrument.check()?;
        if instrument == Instrument::None {
            return Self::load(path);
        }
        let name = path.to_string_lossy();
        if Self::is_split(path) {
            let message = "it is split already, and has the instrument's width in it; expected the XML file";
            return Err(Error::input(Location::new(&*name, 0, 0), message));
        }
        let contents = split(&name, read(path, Band::Visible)?, instrument)?;
        Ok(Self::from_sides(contents.document, contents.sides))
    }

    /// Read the text of an LBNL XML file and split it; `file` names it in messages.
    pub fn parse(file: &str, text: &[u8]) -> Result<Self> {
        let contents = split(file, xml::parse(file, text)?, Instrument::None)?;
        Ok(Self::from_sides(contents.document, contents.sides))
    }
}

fn read(path: &Path, band: Band) -> Result<Document> {
    let file = File::open(path).map_err(|e| Error::io(path, e))?;
    xml::read_band(&path.to_string_lossy(), BufReader::with_capacity(BUFFER, file), band)
}

fn split(file: &str, mut document: Document, instrument: Instrument) -> Result<Contents> {
    let blocks = std::mem::take(&mut document.blocks);
    let sides = sides_of(file, blocks, &|direction, table, color| {
        let transmission = direction.starts_with("Transmission");
        Ok(if transmission {
            Distribution::with_split_of(table, color, instrument)
        } else {
            Distribution::new(table, color)
        })
    })?;
    Ok(Contents { document, sides })
}

/// Makes a distribution of a direction's luminous table and its CIE X and Z.
pub(crate) type Make<'a> = &'a dyn Fn(&str, Table, Option<[Vec<f32>; 2]>) -> Result<Distribution>;

/// Give the blocks of a file their sides. A block that comes again replaces the one before, as in Radiance's library.
pub(crate) fn sides_of(file: &str, mut blocks: Vec<Block>, make: Make) -> Result<Sides> {
    let mut distribution = |direction: &str| -> Result<Option<Arc<Distribution>>> {
        let mut take = |band: &str| {
            let is =
                |b: &Block| b.band.eq_ignore_ascii_case(band) && b.direction.eq_ignore_ascii_case(direction);
            blocks.iter().rposition(is).map(|at| blocks.swap_remove(at).table)
        };
        let Some(luminous) = take("Visible") else { return Ok(None) };
        let color = match ([take("CIE-X"), take("CIE-Z")], [take("CIE-u"), take("CIE-v")]) {
            ([Some(x), Some(z)], _) => {
                if !(x.has_cells_of(&luminous) && z.has_cells_of(&luminous)) {
                    let message = format!("{direction}: CIE-X and CIE-Z are not on the basis of Visible");
                    return Err(Error::input(Location::new(file, 0, 0), message));
                }
                Some([x.into_values(), z.into_values()])
            }
            (_, [Some(u), Some(v)]) => chromaticity(&luminous, &u, &v),
            _ => None,
        };
        Ok(Some(Arc::new(make(direction, luminous, color)?)))
    };
    let sides = Sides {
        transmission_front: distribution("Transmission Front")?,
        transmission_back: distribution("Transmission Back")?,
        reflection_front: distribution("Reflection Front")?,
        reflection_back: distribution("Reflection Back")?,
    };
    let none = sides.transmission_front.is_none()
        && sides.transmission_back.is_none()
        && sides.reflection_front.is_none()
        && sides.reflection_back.is_none();
    if none {
        let message = "no Transmission or Reflection in the Visible band (WavelengthDataDirection names 'Transmission Front' …)";
        return Err(Error::input(Location::new(file, 0, 0), message));
    }
    Ok(sides)
}

/// CIE X and Z from Y and the trees of u' and v' (CIE 15: x = 9u'/(6u' - 16v' + 12), y = 4v'/(same)).
fn chromaticity(luminous: &Table, u: &Table, v: &Table) -> Option<[Vec<f32>; 2]> {
    let (Table::Tree(y), Table::Tree(u), Table::Tree(v)) = (luminous, u, v) else { return None };
    let from = |ratio: fn(f64, f64) -> f64| {
        let mapped = y.map_leaves(|leaf, value| {
            let middle = leaf.corner.map(|c| c + 0.5 * leaf.size);
            let (u, v) = (f64::from(u.value(middle)), f64::from(v.value(middle)));
            if v > 0.0 { (f64::from(value) * ratio(u, v).max(0.0)) as f32 } else { value }
        });
        mapped.into_values()
    };
    Some([from(|u, v| 9.0 * u / (4.0 * v)), from(|u, v| (12.0 - 3.0 * u - 20.0 * v) / (4.0 * v))])
}
