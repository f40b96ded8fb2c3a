//! Rule 3: the table as residual plus delta, once, column by column.

use super::{
    colors::Colors,
    instrument::{self, Instrument},
    interpolate::ThroughMap,
    judge::Judged,
    surround,
};
use crate::{
    distribution::{Distribution, to_rgb},
    table::Columns,
};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use sunpeak_core::{Rgb, gray, luminance};

/// The through peak of a distribution.
#[derive(Debug)]
pub struct Split {
    evidence: Vec<Evidence>,
    /// For each column its first lowered cell; one more at the end.
    first: Vec<u32>,
    /// The cells that are lowered, column by column in ascending order, and their surround [1/sr].
    lowered: Vec<u32>,
    surround: Colors,
    map: ThroughMap,
    instrument_fwhm_deg: Option<f64>,
}

/// What the split found in one column of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColumnPeak {
    /// Through transmittance [-], the mean over the column; zero where no peak was accepted.
    pub through: Rgb,
    /// Peak flux over the flux that the surround has in the same cells.
    pub contrast: f64,
    /// What a peak must exceed here to be accepted [-]: where `through` is zero, the upper bound of what is hidden.
    pub detection_limit: f64,
    /// Lowest and highest luminous transmittance that the data allow [-].
    pub interval: [f64; 2],
    /// Standard deviation of the smooth lobe under the peak, in projected coordinates.
    pub lobe_sigma: f64,
}

/// What [`ColumnPeak`] says beside its T, in 32 bits as the tables have their values; T itself is in the map.
#[derive(Clone, Copy, Debug)]
struct Evidence {
    contrast: f32,
    detection_limit: f32,
    interval: [f32; 2],
    lobe_sigma: f32,
}

impl From<ColumnPeak> for Evidence {
    fn from(peak: ColumnPeak) -> Self {
        // Absurd tables stay finite; only a contrast with nothing is not.
        let finite = |value: f64| value.min(f32::MAX.into()) as f32;
        Self {
            contrast: peak.contrast as f32,
            detection_limit: finite(peak.detection_limit),
            interval: peak.interval.map(finite),
            lobe_sigma: peak.lobe_sigma as f32,
        }
    }
}

/// A column's peak, and the cells that are lowered with their surround [1/sr].
pub type Part = (ColumnPeak, Vec<(usize, Rgb)>);

impl Split {
    /// Nothing split off.
    pub fn none() -> Self {
        Self::empty(None)
    }

    fn empty(instrument_fwhm_deg: Option<f64>) -> Self {
        Self {
            evidence: Vec::new(),
            first: vec![0],
            lowered: Vec::new(),
            surround: Colors::new(&[]),
            map: ThroughMap::none(),
            instrument_fwhm_deg,
        }
    }

    /// Split a distribution of transmission that an instrument may have blurred.
    pub fn of(distribution: &Distribution, instrument: Instrument) -> Self {
        let (table, columns) = (distribution.luminous(), distribution.columns());
        let channels: Vec<&[f32]> = match distribution.color() {
            None => vec![table.values()],
            Some([x, z]) => vec![table.values(), x, z],
        };
        let instrument_fwhm_deg = match instrument {
            Instrument::None => None,
            Instrument::FwhmDeg(fwhm) => Some(fwhm),
            Instrument::Find => instrument::find(table, columns),
        };
        let blur = instrument_fwhm_deg.map(instrument::blur);
        let surrounds = surround::estimate(table, columns, &channels, blur);
        let judged: Vec<Judged> =
            surrounds.par_iter().map(|surround| Judged::new(&channels, surround)).collect();
        let certain: Vec<bool> = judged.iter().map(Judged::is_certain).collect();
        let parts = judged.iter().enumerate().map(|(column, judged)| {
            let beside = || columns.neighbours(column).into_iter().any(|c| certain[c]);
            let accepted = certain[column] || judged.is_likely() && beside();
            judged.part(accepted, in_channels, &channels)
        });
        Self::from_parts(columns, parts.collect(), instrument_fwhm_deg)
    }

    /// What was found before: for each column its peak, and the cells that are lowered, with their surround [1/sr].
    pub fn from_parts(division: &Columns, parts: Vec<Part>, instrument_fwhm_deg: Option<f64>) -> Self {
        let mut split = Self::empty(instrument_fwhm_deg);
        let through: Vec<Rgb> = parts.iter().map(|(column, _)| column.through).collect();
        let mut surround = Vec::new();
        for (column, mut cells) in parts {
            cells.sort_by_key(|c| c.0);
            split.lowered.extend(cells.iter().map(|c| c.0 as u32));
            surround.extend(cells.iter().map(|c| c.1));
            split.first.push(split.lowered.len() as u32);
            split.evidence.push(column.into());
        }
        split.surround = Colors::new(&surround);
        split.map = ThroughMap::new(division, &through);
        split.first.shrink_to_fit();
        split.lowered.shrink_to_fit();
        split.evidence.shrink_to_fit();
        split
    }

    /// Full width at half maximum [deg] of the instrument's blur that was taken for the peak; none for a delta.
    pub fn instrument_fwhm_deg(&self) -> Option<f64> {
        self.instrument_fwhm_deg
    }

    /// The cells of a column that are lowered to their surround [1/sr].
    pub fn overlay(&self, column: usize) -> impl Iterator<Item = (usize, Rgb)> {
        let bound = |c: usize| self.first.get(c).map_or(0, |&at| at as usize);
        let range = bound(column)..bound(column + 1).max(bound(column));
        range.map(|at| (self.lowered[at] as usize, self.surround.at(at)))
    }

    /// What was found in a column; none for reflection.
    pub fn column(&self, column: usize) -> Option<ColumnPeak> {
        let evidence = self.evidence.get(column)?;
        Some(ColumnPeak {
            through: self.map.value(column),
            contrast: evidence.contrast.into(),
            detection_limit: evidence.detection_limit.into(),
            interval: evidence.interval.map(f64::from),
            lobe_sigma: evidence.lobe_sigma.into(),
        })
    }

    /// What was found, column by column; empty for reflection.
    pub fn columns(&self) -> impl ExactSizeIterator<Item = ColumnPeak> + Clone {
        (0..self.evidence.len()).map(|c| self.column(c).unwrap_or_default())
    }

    /// The surround [1/sr] in place of a cell's value, where the cell is part of its column's peak.
    pub fn surround(&self, column: usize, index: usize) -> Option<Rgb> {
        let range = *self.first.get(column)? as usize..*self.first.get(column + 1)? as usize;
        let at = self.lowered[range.clone()].binary_search(&(index as u32)).ok()?;
        Some(self.surround.at(range.start + at))
    }

    /// Through transmittance [-] at a point of incidence: the interpolant, scaled to each column's mean.
    pub fn through(&self, columns: &Columns, p_in: DVec2) -> Rgb {
        self.map.at(columns, p_in)
    }

    /// Lowest and highest luminous transmittance [-] that the data allow at a point of incidence: the column's interval, and the
    /// bend of the interpolant, which the data leave open within a column; anything up to the values next door where the peak ends
    /// within the column. Nominally 95 %.
    pub fn interval(&self, columns: &Columns, p_in: DVec2) -> [f64; 2] {
        let Some(column) = self.column(columns.index(p_in)) else { return [0.0, 0.0] };
        let mean = luminance(column.through);
        if mean <= 0.0 {
            return column.interval;
        }
        let here = luminance(self.through(columns, p_in));
        let bend = self.map.bend(columns, p_in);
        let [low, high] = [here * column.interval[0] / mean - bend, here * column.interval[1] / mean + bend];
        match self.map.edge(columns, p_in) {
            Some(edge) => [0.0, high.max(edge)],
            None => [low.max(0.0), high],
        }
    }

    /// Does the peak end within the column of a point: is it a column across a cut-off, or one that reaches grazing incidence?
    pub fn is_edge(&self, columns: &Columns, p_in: DVec2) -> bool {
        self.map.edge(columns, p_in).is_some()
    }

    /// Memory that it takes beside its table [bytes].
    pub fn bytes(&self) -> usize {
        let lists = size_of_val(self.evidence.as_slice())
            + size_of_val(self.first.as_slice())
            + size_of_val(self.lowered.as_slice());
        lists + self.surround.bytes() + self.map.bytes()
    }

    /// Does any column have a peak?
    pub fn has_peak(&self) -> bool {
        !self.map.is_none()
    }
}

/// Y alone, or Y, X, Z, as Radiance's channels.
fn in_channels(values: &[f32]) -> Rgb {
    match *values {
        [y, x, z] => to_rgb(DVec3::new(f64::from(x), f64::from(y), f64::from(z))),
        [y, ..] => gray(f64::from(y)),
        [] => Rgb::ZERO,
    }
}
