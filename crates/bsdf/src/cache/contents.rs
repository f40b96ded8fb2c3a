//! What a cache file holds: a document's words, its tables, and their splits.

use crate::codec::{Decoder, Encoder, damaged};
use crate::{
    basis::AngleBasis,
    bsdf::{Bsdf, Sides},
    distribution::Distribution,
    peak::{ColumnPeak, Part, Split},
    table::{Matrix, Table},
    tree::Tree,
    xml::Document,
};
use std::{
    io::{self, Read, Write},
    sync::Arc,
};
use sunpeak_core::Rgb;

/// What a file comes to: words, and tables that are split.
pub struct Contents {
    pub document: Document,
    pub sides: Sides,
}

impl Contents {
    pub fn write(&self, out: &mut Encoder<impl Write>) -> io::Result<()> {
        let document = &self.document;
        for word in [&document.name, &document.manufacturer, &document.structure] {
            out.text(word)?;
        }
        out.text(&document.comments)?;
        out.bytes(&document.thickness_m.unwrap_or(f64::NAN).to_le_bytes())?;
        for words in [&document.warnings, &document.bands] {
            out.count(words.len())?;
            words.iter().try_for_each(|w| out.text(w))?;
        }
        let sides = &self.sides;
        for side in [
            &sides.transmission_front,
            &sides.transmission_back,
            &sides.reflection_front,
            &sides.reflection_back,
        ] {
            out.count(usize::from(side.is_some()))?;
            side.iter().try_for_each(|d| write_distribution(out, d))?;
        }
        Ok(())
    }

    pub fn read(from: &mut Decoder<impl Read>) -> io::Result<Self> {
        let mut document = Document {
            name: from.text()?,
            manufacturer: from.text()?,
            structure: from.text()?,
            comments: from.text()?,
            thickness_m: Some(f64::from_le_bytes(from.array()?)).filter(|t| t.is_finite()),
            ..Document::default()
        };
        for words in [&mut document.warnings, &mut document.bands] {
            for _ in 0..from.count(8)? {
                words.push(from.text()?);
            }
        }
        let mut side = || match from.count(1)? {
            0 => Ok(None),
            _ => read_distribution(from).map(|d| Some(Arc::new(d))),
        };
        let sides = Sides {
            transmission_front: side()?,
            transmission_back: side()?,
            reflection_front: side()?,
            reflection_back: side()?,
        };
        Ok(Self { document, sides })
    }
}

impl Bsdf {
    /// Sum up all that makes it what it is: tables, and what their splits take.
    ///
    /// # Errors
    /// Of the encoder's writer.
    pub fn sum_up(&self, out: &mut Encoder<impl Write>) -> io::Result<()> {
        for (name, distribution) in self.own_distributions() {
            out.text(name)?;
            write_distribution(out, distribution)?;
        }
        Ok(())
    }
}

fn write_distribution(out: &mut Encoder<impl Write>, d: &Distribution) -> io::Result<()> {
    match d.luminous() {
        Table::Matrix(m) => {
            out.count(2)?;
            write_basis(out, &m.incident)?;
            write_basis(out, &m.exiting)?;
        }
        Table::Tree(t) => {
            out.count(t.rank())?;
            let nodes = t.packed_nodes();
            out.count(nodes.len())?;
            for node in nodes {
                out.bytes(&node.to_le_bytes())?;
            }
        }
    }
    out.values(d.luminous().values())?;
    out.count(usize::from(d.color().is_some()))?;
    d.color().into_iter().flatten().try_for_each(|values| out.values(values))?;
    write_split(out, d.split())
}

fn read_distribution(from: &mut Decoder<impl Read>) -> io::Result<Distribution> {
    let luminous = match from.count(1)? {
        2 => {
            let (incident, exiting) = (read_basis(from)?, read_basis(from)?);
            let values = from.values()?;
            if incident.len().checked_mul(exiting.len()) != Some(values.len()) {
                return Err(damaged());
            }
            Table::Matrix(Matrix { incident, exiting, values })
        }
        rank => {
            let nodes = (0..from.count(8)?).map(|_| from.array().map(u64::from_le_bytes));
            let nodes = nodes.collect::<io::Result<Vec<_>>>()?;
            Table::Tree(Tree::from_packed(rank, &nodes, from.values()?).ok_or_else(damaged)?)
        }
    };
    let count = luminous.values().len();
    let color = match from.count(1)? {
        0 => None,
        _ => Some([from.values()?, from.values()?]),
    };
    if color.iter().flatten().any(|values| values.len() != count) {
        return Err(damaged());
    }
    let parts = read_split(from, count)?;
    if !parts.is_empty() && parts.len() != luminous.columns().len() {
        return Err(damaged());
    }
    Ok(Distribution::with_known_split(luminous, color, |columns| {
        if parts.is_empty() { Split::none() } else { Split::from_parts(columns, parts, None) }
    }))
}

fn write_basis(out: &mut Encoder<impl Write>, basis: &AngleBasis) -> io::Result<()> {
    out.text(basis.name())?;
    out.count(basis.rings().len())?;
    for ring in basis.rings() {
        out.numbers([ring.upper_theta_deg])?;
        out.count(ring.phi_count)?;
    }
    Ok(())
}

fn read_basis(from: &mut Decoder<impl Read>) -> io::Result<Arc<AngleBasis>> {
    let name = from.text()?;
    let mut rings = Vec::new();
    for _ in 0..from.count(16)? {
        let [upper] = from.numbers()?;
        // Each patch has values.
        rings.push((upper, from.count(4)?));
    }
    AngleBasis::new(&name, &rings).map(Arc::new).map_err(|_| damaged())
}

fn write_split(out: &mut Encoder<impl Write>, split: &Split) -> io::Result<()> {
    out.count(split.columns().len())?;
    for (column, peak) in split.columns().enumerate() {
        let ColumnPeak { through, contrast, detection_limit, interval: [low, high], lobe_sigma } = peak;
        out.numbers(through.to_array())?;
        out.numbers([contrast, detection_limit, low, high, lobe_sigma])?;
        out.count(split.overlay(column).count())?;
        for (index, surround) in split.overlay(column) {
            out.count(index)?;
            out.numbers(surround.to_array())?;
        }
    }
    Ok(())
}

fn read_split(from: &mut Decoder<impl Read>, values: usize) -> io::Result<Vec<Part>> {
    let sound = |rgb: Rgb| rgb.is_finite() && rgb.cmpge(Rgb::ZERO).all();
    let mut parts = Vec::new();
    for _ in 0..from.count(64)? {
        let through = Rgb::from(from.numbers::<3>()?);
        let [contrast, detection_limit, low, high, lobe_sigma] = from.numbers()?;
        let peak = ColumnPeak { through, contrast, detection_limit, interval: [low, high], lobe_sigma };
        let mut cells = Vec::new();
        for _ in 0..from.count(32)? {
            let index = u64::from_le_bytes(from.array()?);
            let surround = Rgb::from(from.numbers::<3>()?);
            if index >= values as u64 || !sound(surround) {
                return Err(damaged());
            }
            cells.push((index as usize, surround));
        }
        if !sound(through) {
            return Err(damaged());
        }
        parts.push((peak, cells));
    }
    Ok(parts)
}
