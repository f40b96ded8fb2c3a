//! What a goniophotometer has found: the tables, and how well each of their columns is known.

use super::column::{Column, Counts, Side};
use super::{GonioOptions, Job};
use std::sync::Arc;
use sunpeak_bsdf::counted::{Counted, average_sides, average_within};
use sunpeak_bsdf::table::Columns;
use sunpeak_bsdf::xml::Document;
use sunpeak_bsdf::{Bsdf, Distribution, Sides};
use sunpeak_core::{Result, Rgb, Vec3, luminance, rgb_to_xyz};

/// A generated BSDF.
#[derive(Debug)]
pub struct Generated {
    /// The tables with their exact split.
    pub bsdf: Bsdf,
    /// The sides that were traced.
    pub sides: Vec<GeneratedSide>,
    /// The sampled box.
    pub corners: [Vec3; 2],
    /// Rays that light came in by, of all columns.
    pub samples: u64,
    /// Rays and their parts that this run has traced.
    pub rays: u64,
    /// Largest share of a column's light that was given up.
    pub lost: f64,
}

/// One side, column by column.
#[derive(Clone, Debug)]
pub struct GeneratedSide {
    /// Where the light comes from.
    pub side: Side,
    /// In the order of the basis.
    pub columns: Vec<GeneratedColumn>,
    /// Root mean square standard error of the cells over their root mean square [-]: scattered transmission, reflection. Before cells
    /// are put together.
    pub cell_error: [f64; 2],
    /// If asked for, standard error [1/sr] of each of these cells, one column after the other: scattered transmission, reflection.
    pub cell_errors: Option<[Vec<f32>; 2]>,
}

/// Hemispherical values of a column [-], and their standard errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratedColumn {
    /// Straight through.
    pub through: f64,
    /// Its standard error.
    pub through_error: f64,
    /// All that is transmitted, straight and scattered.
    pub transmittance: f64,
    /// Its standard error.
    pub transmittance_error: f64,
    /// All that is reflected.
    pub reflectance: f64,
    /// Its standard error.
    pub reflectance_error: f64,
    /// Rays that came in.
    pub samples: u64,
}

/// Tables from columns, side after side.
pub(super) fn assemble(
    job: &Job,
    options: &GonioOptions,
    columns: Vec<Column>,
    rays: u64,
) -> Result<Generated> {
    let width = job.incident.len();
    let samples = columns.iter().map(|c| c.rays).sum();
    let lost = columns.iter().map(|c| c.lost).fold(0.0, f64::max);
    let mut sides: Vec<GeneratedSide> = job
        .sides
        .iter()
        .zip(columns.chunks(width))
        .map(|(&side, columns)| summary(job, side, columns))
        .collect();
    let mut left = columns.into_iter();
    let mut counted: Vec<[Counted; 2]> =
        job.sides.iter().map(|_| counted(job, left.by_ref().take(width))).collect();
    if options.reciprocity {
        counted.iter_mut().for_each(|[_, reflection]| average_within(reflection));
        if let [[front, _], [back, _]] = &mut counted[..] {
            average_sides(front, back);
        }
    }
    for (side, modes) in sides.iter_mut().zip(&counted) {
        side.cell_error = [&modes[0], &modes[1]].map(relative_error);
        side.cell_errors = options.cell_errors.then(|| [&modes[0], &modes[1]].map(|mode| mode.error.clone()));
    }
    let mut tables = Sides::default();
    for (side, [transmission, reflection]) in job.sides.iter().zip(counted) {
        let distribution = |counts: Counted| -> Option<Arc<Distribution>> {
            Some(Arc::new(counts.distribution(options.tolerance)))
        };
        match side {
            Side::Front => {
                tables.transmission_front = distribution(transmission);
                tables.reflection_front = distribution(reflection);
            }
            Side::Back => {
                tables.transmission_back = distribution(transmission);
                tables.reflection_back = distribution(reflection);
            }
        }
    }
    let document = Document { structure: options.basis.structure().into(), ..Document::default() };
    let bsdf = Bsdf::from_sides(document, tables);
    Ok(Generated { bsdf, sides, corners: job.cell.corners(), samples, rays, lost })
}

fn summary(job: &Job, side: Side, columns: &[Column]) -> GeneratedSide {
    let whole = |counts: &Counts| -> f64 {
        let channels = job.channels();
        let flux = |f: &[f32]| match *f {
            [r, g, b] => luminance(Rgb::new(r.into(), g.into(), b.into())),
            _ => f.iter().map(|&v| f64::from(v)).sum(),
        };
        counts.flux.chunks(channels).map(flux).sum()
    };
    let one = |c: &Column| {
        let through = luminance(c.through);
        GeneratedColumn {
            through,
            through_error: c.through_error,
            transmittance: through + whole(&c.transmission),
            transmittance_error: c.through_error.hypot(c.transmission.whole_error),
            reflectance: whole(&c.reflection),
            reflectance_error: c.reflection.whole_error,
            samples: c.rays,
        }
    };
    let columns = columns.iter().map(one).collect();
    GeneratedSide { side, columns, cell_error: [0.0; 2], cell_errors: None }
}

/// Fluxes become values: over the projected solid angle of each cell.
fn counted(job: &Job, columns: impl Iterator<Item = Column>) -> [Counted; 2] {
    let empty = || Counted {
        basis: job.basis,
        luminous: Vec::new(),
        color: job.effort.colored.then(Default::default),
        error: Vec::new(),
        rays: Vec::new(),
        whole_error: Vec::new(),
        through: Vec::new(),
        through_error: Vec::new(),
    };
    let mut modes = [empty(), empty()];
    for column in columns {
        modes[0].through.push(column.through);
        modes[0].through_error.push(column.through_error);
        for (mode, counts) in modes.iter_mut().zip([&column.transmission, &column.reflection]) {
            mode.rays.push(column.rays as f64);
            mode.whole_error.push(counts.whole_error);
            add(mode, counts, &job.exiting);
        }
    }
    modes
}

fn add(mode: &mut Counted, counts: &Counts, exiting: &Columns) {
    let channels = counts.flux.len() / exiting.len();
    for (cell, flux) in counts.flux.chunks(channels).enumerate() {
        let area = exiting.projected_solid_angle(cell);
        match (&mut mode.color, flux) {
            (Some([x, z]), &[r, g, b]) => {
                let rgb = Rgb::new(r.into(), g.into(), b.into()) / area;
                let xyz = rgb_to_xyz(rgb);
                mode.luminous.push(luminance(rgb) as f32);
                x.push(xyz.x as f32);
                z.push(xyz.z as f32);
            }
            _ => mode.luminous.push((f64::from(flux[0]) / area) as f32),
        }
        mode.error.push((f64::from(counts.error[cell]) / area) as f32);
    }
}

fn relative_error(mode: &Counted) -> f64 {
    let squares = |values: &[f32]| values.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>();
    let whole = squares(&mode.luminous);
    if whole > 0.0 { (squares(&mode.error) / whole).sqrt() } else { 0.0 }
}
