//! Rule 3: the table as residual plus delta, once, column by column.

use super::{
    interpolate::ThroughMap,
    surround::{self, Estimate, Neighbourhood},
};
use crate::{
    distribution::{Distribution, to_rgb},
    table::{Cell, Columns},
};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use sunpeak_core::{Rgb, gray, luminance};

/// A peak must stand above its surround by this share of it: the model of the surround is off by up to so much where lobes
/// are not Gaussian.
pub const MIN_CONTRAST: f64 = 0.1;

/// … and by so many standard errors of the surround (one false peak in 16 000 columns of Gaussian noise).
pub const MIN_SIGNIFICANCE: f64 = 4.0;

/// The through peak of a distribution.
#[derive(Debug)]
pub struct Split {
    columns: Vec<ColumnPeak>,
    /// For each column its first overlay cell; one more at the end.
    first: Vec<u32>,
    overlay: Vec<Overlay>,
    map: ThroughMap,
}

/// What the split found in one column of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// A cell of the table that is lowered to its surround.
#[derive(Clone, Copy, Debug)]
struct Overlay {
    index: u32,
    surround: [f32; 3],
}

impl Split {
    /// Nothing split off.
    pub fn none() -> Self {
        Self { columns: Vec::new(), first: Vec::new(), overlay: Vec::new(), map: ThroughMap::none() }
    }

    /// Split a distribution of transmission.
    pub fn of(distribution: &Distribution) -> Self {
        let (table, columns) = (distribution.luminous(), distribution.columns());
        let neighbourhoods: Vec<_> =
            (0..columns.len()).into_par_iter().map(|c| Neighbourhood::of(table, columns, c)).collect();
        let channels: Vec<&[f32]> = match distribution.color() {
            None => vec![table.values()],
            Some([x, z]) => vec![table.values(), x, z],
        };
        let estimates = surround::estimate(table, &neighbourhoods, &channels);
        let mut split =
            Self { columns: Vec::new(), first: vec![0], overlay: Vec::new(), map: ThroughMap::none() };
        for (neighbourhood, (lobe_sigma, estimates)) in neighbourhoods.iter().zip(&estimates) {
            split.add_column(&neighbourhood.candidates, &channels, estimates, *lobe_sigma);
        }
        split.map = ThroughMap::new(columns, split.columns.iter().map(|c| c.through).collect());
        split
    }

    fn add_column(
        &mut self,
        cells: &[Cell],
        channels: &[&[f32]],
        estimates: &[Vec<Estimate>],
        lobe_sigma: f64,
    ) {
        let value = |channel: usize, cell: &Cell| f64::from(channels[channel][cell.index]);
        let excess = |channel: usize, surround: &dyn Fn(&Estimate) -> f64| -> f64 {
            cells
                .iter()
                .zip(&estimates[channel])
                .map(|(c, e)| (value(channel, c) - surround(e)).max(0.0) * c.projected_solid_angle)
                .sum()
        };
        let luminous = excess(0, &|e| e.value);
        let around: f64 =
            cells.iter().zip(&estimates[0]).map(|(c, e)| e.value.max(0.0) * c.projected_solid_angle).sum();
        let error: f64 =
            cells.iter().zip(&estimates[0]).map(|(c, e)| e.error * c.projected_solid_angle).sum();
        let limit = (MIN_CONTRAST * around).max(MIN_SIGNIFICANCE * error);
        let accepted = luminous > limit && luminous > 0.0;
        let mut through = Rgb::ZERO;
        if accepted {
            let rest =
                |channel: usize, cell: &Cell, e: &Estimate| e.value.clamp(0.0, value(channel, cell)) as f32;
            for (k, cell) in cells.iter().enumerate() {
                let surround: Vec<f32> =
                    (0..channels.len()).map(|ch| rest(ch, cell, &estimates[ch][k])).collect();
                let surround = in_channels(&surround);
                self.overlay
                    .push(Overlay { index: cell.index as u32, surround: surround.as_vec3().to_array() });
                // From the stored numbers, so that residual and peak make up the table exactly.
                let stored = DVec3::from(surround.as_vec3());
                let whole: Vec<f32> = channels.iter().map(|c| c[cell.index]).collect();
                through += (in_channels(&whole) - stored).max(Rgb::ZERO) * cell.projected_solid_angle;
            }
        }
        // Two standard errors: of the surround, and of the candidates' own values.
        let counted: f64 = cells
            .iter()
            .zip(&estimates[0])
            .map(|(c, e)| e.variance_ratio * value(0, c) * c.projected_solid_angle.powi(2))
            .sum();
        let noise = 2.0 * (error * error + counted).sqrt();
        self.columns.push(ColumnPeak {
            through,
            contrast: if around > 0.0 {
                luminous / around
            } else if luminous > 0.0 {
                f64::INFINITY
            } else {
                0.0
            },
            detection_limit: limit,
            interval: if accepted {
                [(excess(0, &|e| e.range[1]) - noise).max(0.0), excess(0, &|e| e.range[0]) + noise]
            } else {
                [0.0, limit.max(luminous)]
            },
            lobe_sigma,
        });
        self.first.push(self.overlay.len() as u32);
    }

    /// What was found before: for each column its peak, and the cells that are lowered, with their surround [1/sr].
    pub fn from_parts(division: &Columns, parts: Vec<(ColumnPeak, Vec<(usize, Rgb)>)>) -> Self {
        let mut split =
            Self { columns: Vec::new(), first: vec![0], overlay: Vec::new(), map: ThroughMap::none() };
        for (column, cells) in parts {
            split.overlay.extend(cells.into_iter().map(|(index, surround)| Overlay {
                index: index as u32,
                surround: surround.as_vec3().to_array(),
            }));
            split.first.push(split.overlay.len() as u32);
            split.columns.push(column);
        }
        split.map = ThroughMap::new(division, split.columns.iter().map(|c| c.through).collect());
        split
    }

    /// The cells of a column that are lowered to their surround [1/sr].
    pub fn overlay(&self, column: usize) -> impl Iterator<Item = (usize, Rgb)> {
        let bound = |c: usize| self.first.get(c).map_or(0, |&at| at as usize);
        let range = bound(column)..bound(column + 1).max(bound(column));
        self.overlay[range].iter().map(|c| (c.index as usize, DVec3::from(glam::Vec3::from(c.surround))))
    }

    /// What was found, column by column; empty for reflection.
    pub fn columns(&self) -> &[ColumnPeak] {
        &self.columns
    }

    /// The surround [1/sr] in place of a cell's value, where the cell is part of its column's peak.
    pub fn surround(&self, column: usize, index: usize) -> Option<Rgb> {
        let range = *self.first.get(column)? as usize..*self.first.get(column + 1)? as usize;
        let cell = self.overlay[range].iter().find(|c| c.index as usize == index)?;
        Some(DVec3::from(glam::Vec3::from(cell.surround)))
    }

    /// Through transmittance [-] at a point of incidence: the interpolant, scaled to each column's mean.
    pub fn through(&self, columns: &Columns, p_in: DVec2) -> Rgb {
        self.map.at(columns, p_in)
    }

    /// Lowest and highest luminous transmittance [-] that the data allow at a point of incidence: the column's interval, and the
    /// bend of the interpolant, which the data leave open within a column. Nominally 95 %.
    pub fn interval(&self, columns: &Columns, p_in: DVec2) -> [f64; 2] {
        let Some(column) = self.columns.get(columns.index(p_in)) else { return [0.0, 0.0] };
        let mean = luminance(column.through);
        if mean <= 0.0 {
            return column.interval;
        }
        let here = luminance(self.through(columns, p_in));
        let bend = self.map.bend(columns, p_in);
        [(here * column.interval[0] / mean - bend).max(0.0), here * column.interval[1] / mean + bend]
    }

    /// Does any column have a peak?
    pub fn has_peak(&self) -> bool {
        self.columns.iter().any(|c| luminance(c.through) > 0.0)
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
