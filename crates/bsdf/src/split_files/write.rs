//! A split to its texts.

use super::{
    RESIDUAL_FILE, SplitFiles,
    format::{CellFile, ColumnFile, Division, FORMAT, Ledger, PeakFile, SideFile, VERSION},
    tables::{channels_at, channels_of, residual},
};
use crate::{
    bsdf::Bsdf,
    distribution::Distribution,
    incident::Incident,
    table::{Cell, Columns, Table},
    xml_write::{Component, Leaves},
};
use rayon::prelude::*;
use std::{fmt::Write, io::BufRead};
use sunpeak_core::{Error, Result, luminance};

/// What the numbers of `peak.json` mean.
const NOTES: [&str; 6] = [
    "theta_deg and phi_deg: the traced ray at the middle of the column; theta from the front normal, above 90 from behind; phi from x, \
     the azimuth towards which the ray runs (0 where the column has all azimuths)",
    "through: mean through transmittance of the column [-]; 0 where no peak was accepted; through_rgb in Radiance's primaries",
    "interval: lowest and highest transmittance that the data allow [-]; where there is no peak, 0 and what could be hidden",
    "contrast: flux of the peak over the flux that the surround has in the same cells [-]; null: nothing is scattered there",
    "ledger: hemispherical transmittances of the column [-]; error = table - residual - through",
    "cells: exiting cells that the residual has lowered; excess [1/sr] is the table less the residual in CIE channels",
];

impl Bsdf {
    /// The split as texts.
    pub fn split_files(&self) -> Result<SplitFiles> {
        let own = self.own_distributions();
        let tables = own.iter().map(|(_, d)| residual(d)).collect::<Result<Vec<_>>>()?;
        let components: Vec<Component> = own
            .iter()
            .zip(&tables)
            .map(|((direction, _), (table, color))| Component {
                band: "Visible",
                direction,
                luminous: table,
                color: color.as_ref(),
            })
            .collect();
        let residual_xml = self.xml_of(&components, Leaves::Kept);
        let sides: Vec<SideFile> = own
            .iter()
            .filter(|(direction, _)| direction.starts_with("Transmission"))
            .map(|(direction, d)| side(direction, d))
            .collect();
        let (peak_csv, ledger_csv) = (peak_csv(&sides), ledger_csv(&sides));
        let file = PeakFile {
            format: FORMAT.into(),
            version: VERSION,
            name: self.name.clone(),
            manufacturer: self.manufacturer.clone(),
            notes: NOTES.map(String::from).to_vec(),
            residual: RESIDUAL_FILE.into(),
            residual_fnv1a: checksum(residual_xml.as_bytes()).ok(),
            sides,
        };
        let peak_json = serde_json::to_string_pretty(&file)
            .map_err(|e| Error::value(format!("the split of '{}' cannot be written: {e}", self.name)))?;
        Ok(SplitFiles { residual_xml, peak_json: peak_json + "\n", peak_csv, ledger_csv })
    }
}

/// FNV-1a with 64 bits (Fowler, Noll, Vo 1991) of all that a reader gives: tells files apart, no protection against malice.
pub fn checksum(mut reader: impl BufRead) -> std::io::Result<String> {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    loop {
        let chunk = reader.fill_buf()?;
        if chunk.is_empty() {
            return Ok(format!("{hash:016x}"));
        }
        hash = chunk.iter().fold(hash, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3));
        let read = chunk.len();
        reader.consume(read);
    }
}

/// Does light of this direction of the file meet rays at the frame's front?
fn is_front(direction: &str) -> bool {
    direction.ends_with("Back")
}

fn side(direction: &str, d: &Distribution) -> SideFile {
    let front = is_front(direction);
    let columns = (0..d.columns().len())
        .into_par_iter()
        .map(|column| column_file(d, &Incident::of(d, column, front, false)))
        .collect();
    SideFile {
        direction: direction.into(),
        met_by_rays_at: if front { "front" } else { "back" }.into(),
        basis: d.luminous().basis_name(),
        instrument_fwhm_deg: d.split().instrument_fwhm_deg(),
        division: division(d.columns()),
        channels: if d.color().is_some() { &["Y", "X", "Z"][..] } else { &["Y"] }
            .iter()
            .map(|s| (*s).into())
            .collect(),
        columns,
    }
}

/// The incident division as the file has it.
pub fn division(columns: &Columns) -> Division {
    match columns {
        Columns::Patches(basis) => Division::Patches { count: basis.len() },
        Columns::Square { side } => Division::Square { side: *side },
        Columns::Radial { side } => Division::Radial { side: *side },
    }
}

fn column_file(d: &Distribution, at: &Incident) -> ColumnFile {
    let cells = d.luminous().cells(d.columns(), at.column);
    let peak = d.split().column(at.column).unwrap_or_default();
    let lowered: Vec<_> = d.split().overlay(at.column).collect();
    ColumnFile {
        column: at.column,
        theta_deg: at.theta_deg,
        phi_deg: at.phi_deg,
        theta_bounds_deg: at.theta_bounds_deg,
        phi_bounds_deg: at.phi_bounds_deg,
        projected_solid_angle_sr: at.projected_solid_angle,
        through: luminance(peak.through),
        through_rgb: peak.through.to_array(),
        interval: peak.interval,
        contrast: peak.contrast.is_finite().then_some(peak.contrast),
        detection_limit: peak.detection_limit,
        lobe_sigma: peak.lobe_sigma,
        ledger: ledger(d, at.column, &cells),
        cells: lowered
            .iter()
            .filter_map(|&(index, surround)| {
                let cell = cells.iter().find(|c| c.index == index)?;
                let colored = d.color().is_some();
                let whole = channels_at((d.luminous(), d.color()), index);
                let rest = channels_of(surround, colored);
                let excess = whole.iter().zip(rest).map(|(&w, r)| f64::from(w) - f64::from(r));
                let excess = excess.take(if colored { 3 } else { 1 }).collect();
                Some(cell_file(d.luminous(), cell, excess))
            })
            .collect(),
    }
}

fn cell_file(table: &Table, cell: &Cell, excess: Vec<f64>) -> CellFile {
    match (table, cell.square()) {
        (Table::Matrix(m), _) => CellFile { patch: Some(cell.index % m.exiting.len()), square: None, excess },
        (Table::Tree(_), square) => {
            let place = square.map(|s| [s.corner[0], s.corner[1], s.size].map(f64::from));
            CellFile { patch: None, square: place, excess }
        }
    }
}

/// Where the flux of a column went.
fn ledger(d: &Distribution, column: usize, cells: &[Cell]) -> Ledger {
    let (mut table, mut residual) = (0.0, 0.0);
    for cell in cells {
        let area = cell.projected_solid_angle;
        let value = d.at_index(cell.index);
        table += luminance(value) * area;
        residual += luminance(d.split().surround(column, cell.index).unwrap_or(value)) * area;
    }
    let through = d.split().column(column).map_or(0.0, |peak| luminance(peak.through));
    Ledger { table, residual, through, error: table - residual - through }
}

fn peak_csv(sides: &[SideFile]) -> String {
    let mut out = String::from(
        "rays_at,direction,column,theta_deg,phi_deg,theta_min_deg,theta_max_deg,phi_min_deg,phi_max_deg,\
         projected_solid_angle_sr,through,through_red,through_green,through_blue,low,high,contrast,detection_limit,lobe_sigma\n",
    );
    for (side, c) in rows(sides) {
        let [t0, t1] = c.theta_bounds_deg;
        let [p0, p1] = c.phi_bounds_deg;
        let ([r, g, b], [low, high]) = (c.through_rgb, c.interval);
        let contrast = c.contrast.map_or("inf".into(), |v| v.to_string());
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{},{},{},{},{},{t0},{t1},{p0},{p1},{},{},{r},{g},{b},{low},{high},{contrast},{},{}",
            side.met_by_rays_at,
            side.direction,
            c.column,
            c.theta_deg,
            c.phi_deg,
            c.projected_solid_angle_sr,
            c.through,
            c.detection_limit,
            c.lobe_sigma
        );
    }
    out
}

fn ledger_csv(sides: &[SideFile]) -> String {
    let mut out = String::from(
        "rays_at,direction,column,theta_deg,phi_deg,table,residual,through,error,relative_error\n",
    );
    for (side, c) in rows(sides) {
        let l = c.ledger;
        let relative = if l.table > 0.0 { l.error / l.table } else { 0.0 };
        let _ = writeln!(
            out,
            "{},{},{},{},{},{},{},{},{:e},{relative:e}",
            side.met_by_rays_at,
            side.direction,
            c.column,
            c.theta_deg,
            c.phi_deg,
            l.table,
            l.residual,
            l.through,
            l.error
        );
    }
    out
}

fn rows(sides: &[SideFile]) -> impl Iterator<Item = (&SideFile, &ColumnFile)> {
    sides.iter().flat_map(|s| s.columns.iter().map(move |c| (s, c)))
}
