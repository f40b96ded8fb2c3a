//! BSDFs from goniophotometer scans: read, completed by symmetry, told apart into what goes straight and what is scattered, interpolated
//! between incidences, and tabulated in any basis.
//!
//! Scattered light between incidences follows Ward, Kurt and Bonneel, "Reducing Anisotropic BSDF Measurement to Common Practice"
//! (Workshop on Material Appearance Modeling 2014): Gaussian lobes for each incidence ([`lobes`]), the cheapest transport between
//! neighbours ([`transport`]), lobes on their way in between ([`blend`]). What an instrument has made of a sharp beam is found by its
//! width ([`specular`]): what goes straight is kept as an exact peak, what is mirrored lies in its cells.

mod background;
mod blend;
mod deposit;
mod energy;
mod field;
mod gathered;
mod lobes;
mod mesh;
mod monotone;
mod read;
mod report;
mod scan;
mod specular;
mod symmetry;
mod table;
mod transport;

pub use energy::{Energy, Scaled};
pub use field::Coverage;
pub use read::{parse, read};
pub use report::{IncidenceReport, KindReport};
pub use scan::{Kind, Reading, Scan};
pub use specular::{Straight, beam_fwhm_deg};
pub use symmetry::Symmetry;

use crate::{
    bsdf::{Bsdf, Sides},
    codec::Encoder,
    peak::Instrument,
    synthetic::Basis,
    work::Work,
    xml::Document,
};
use glam::DVec2;
use mesh::{Mesh, Node};
use rayon::prelude::*;
use scan::{Incidence, incidences};
use std::{io, sync::Arc};
use sunpeak_core::{Error, Result};
use table::Columnwise;

/// How a measurement becomes a BSDF.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The basis of the tables.
    pub basis: Basis,
    /// `find`, `isotropic`, `quadrilateral`, `bilateral` or `anisotropic`.
    pub symmetry: String,
    /// Full width at half maximum [deg] of what the instrument makes of a sharp beam; none: nothing is told apart.
    pub instrument_fwhm_deg: Option<f64>,
    /// What to do with more light than comes in.
    pub energy: Energy,
}

/// A BSDF with what is known of how it came about.
#[derive(Debug)]
pub struct Measured {
    /// The tables; what went straight is kept exactly beside them.
    pub bsdf: Bsdf,
    /// By side and mode.
    pub kinds: Vec<KindReport>,
    /// Sides on which more left than came in.
    pub scaled: Vec<Scaled>,
}

/// One side and mode on its way.
struct Part {
    kind: Kind,
    mesh: Mesh,
    report: KindReport,
}

/// Write down all that a table depends on.
///
/// # Errors
/// Of what it is written to.
pub fn sum_up(scans: &[Scan], options: &Options, to: &mut Encoder<impl io::Write>) -> io::Result<()> {
    to.text(&format!("{options:?}"))?;
    for scan in scans {
        to.text(&scan.name)?;
        to.numbers(scan.to_light.to_array())?;
        to.count(scan.readings.len())?;
        to.numbers(scan.readings.iter().flat_map(|r| [r.exit.x, r.exit.y, r.exit.z, r.value]))?;
    }
    Ok(())
}

/// Tabulate scans. Whatever sides and modes they have become tables; progress counts columns.
pub fn tabulate(scans: &[Scan], options: &Options, work: &Work) -> Result<Measured> {
    if let Some(fwhm_deg) = options.instrument_fwhm_deg {
        Instrument::FwhmDeg(fwhm_deg).check()?;
    }
    let mut parts = Vec::new();
    for kind in Kind::ALL {
        let measured = incidences(scans, kind)?;
        if !measured.is_empty() {
            parts.push(part(kind, &measured, options, work)?);
        }
    }
    if parts.is_empty() {
        return Err(Error::value("no scans with readings; expected at least one incidence"));
    }
    let [incident, _] = options.basis.divisions();
    work.expect(parts.len() * incident.len());
    let told_apart = options.instrument_fwhm_deg.is_some();
    let tables = parts.iter().map(|part| {
        Ok((part.kind, Columnwise::new(part.kind, &part.mesh, options.basis, told_apart, work)?))
    });
    let mut tables = tables.collect::<Result<Vec<_>>>()?;
    let scaled = energy::check(&mut tables, options.basis, options.energy)?;
    let mut sides = Sides::default();
    for (kind, table) in &tables {
        // The file's front is where the frame has its back.
        let place = match (kind.front, kind.reflection) {
            (true, false) => &mut sides.transmission_back,
            (false, false) => &mut sides.transmission_front,
            (true, true) => &mut sides.reflection_back,
            (false, true) => &mut sides.reflection_front,
        };
        *place = Some(Arc::new(table.distribution(kind.reflection)));
    }
    let document = Document {
        name: scans.iter().map(|scan| &scan.name).find(|name| !name.is_empty()).cloned().unwrap_or_default(),
        structure: options.basis.structure().into(),
        ..Document::default()
    };
    let kinds = parts.into_iter().map(|part| part.report).collect();
    Ok(Measured { bsdf: Bsdf::from_sides(document, sides), kinds, scaled })
}

/// From readings to a mesh of incidences.
fn part(kind: Kind, measured: &[Incidence], options: &Options, work: &Work) -> Result<Part> {
    let named = |error: Error| Error::value(format!("{}: {error}", kind.name()));
    let symmetry = Symmetry::named(&options.symmetry, measured).map_err(named)?;
    if options.basis.is_isotropic() && symmetry != Symmetry::Isotropic {
        return Err(named(Error::value(format!(
            "{}, which a t3 basis cannot hold; expected a matrix or a t4 basis, or symmetry isotropic",
            symmetry.name()
        ))));
    }
    let all = symmetry.completed(measured);
    let fitted: Vec<(Node, IncidenceReport)> = all
        .into_par_iter()
        .map(|incidence| {
            work.check()?;
            node(incidence, options.instrument_fwhm_deg).map_err(named)
        })
        .collect::<Result<_>>()?;
    let (mut nodes, reports): (Vec<Node>, Vec<IncidenceReport>) = fitted.into_iter().unzip();
    fill_through(&mut nodes, &reports);
    let report = KindReport::new(kind, symmetry, measured, reports);
    let mesh = if symmetry == Symmetry::Isotropic {
        Mesh::line(nodes)
    } else {
        Mesh::plane(nodes).map_err(named)?
    };
    Ok(Part { kind, mesh, report })
}

/// One incidence: what goes straight or is mirrored, and what is scattered as lobes.
fn node(mut incidence: Incidence, fwhm_deg: Option<f64>) -> Result<(Node, IncidenceReport)> {
    let straight = fwhm_deg.map(|fwhm| specular::separate(&mut incidence, fwhm));
    let (field, coverage) = field::field(&incidence)?;
    let scattered = lobes::fit(&field);
    let through = straight.map_or(0.0, Straight::through);
    let report = IncidenceReport::new(&incidence, straight, scattered.flux(), coverage);
    Ok((Node { p: incidence.p, scattered, through }, report))
}

/// Where the straight direction was not read, T is that of the nearest incidences, weighted by the inverse square of their distance.
fn fill_through(nodes: &mut [Node], reports: &[IncidenceReport]) {
    const NEAREST: usize = 3;
    let is_known = |report: &IncidenceReport| !matches!(report.straight, Some(Straight::TooFew(_)));
    let known: Vec<(DVec2, f64)> =
        nodes.iter().zip(reports).filter(|(_, r)| is_known(r)).map(|(n, _)| (n.p, n.through)).collect();
    for (node, _) in nodes.iter_mut().zip(reports).filter(|(_, r)| !is_known(r)) {
        let mut near: Vec<(f64, f64)> = known.iter().map(|(p, t)| (p.distance_squared(node.p), *t)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = &near[..near.len().min(NEAREST)];
        let weights: f64 = near.iter().map(|(d, _)| 1.0 / d).sum();
        node.through = near.iter().map(|(d, t)| t / d).sum::<f64>() / weights.max(f64::MIN_POSITIVE);
    }
}
