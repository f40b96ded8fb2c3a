//! One side and mode of a BSDF: a luminous table, colour beside it, and the peak that was split off.

use crate::{
    peak::{Instrument, Split},
    table::{Columns, Table},
};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use sunpeak_core::{Rgb, gray, xyz_to_rgb};

/// A table with colour and, for transmission, its split.
#[derive(Debug)]
pub struct Distribution {
    luminous: Table,
    /// CIE X and Z on the same cells.
    color: Option<[Vec<f32>; 2]>,
    columns: Columns,
    split: Split,
    smallest_projected_solid_angle: f64,
    diffuse: f64,
}

impl Distribution {
    /// Without a peak (reflection).
    pub fn new(luminous: Table, color: Option<[Vec<f32>; 2]>) -> Self {
        let columns = luminous.columns();
        let smallest_projected_solid_angle = luminous.smallest_projected_solid_angle();
        let diffuse = diffuse(&luminous);
        Self { luminous, color, columns, split: Split::none(), smallest_projected_solid_angle, diffuse }
    }

    /// With its through peak split off (transmission).
    pub fn with_split(luminous: Table, color: Option<[Vec<f32>; 2]>) -> Self {
        Self::with_split_of(luminous, color, Instrument::None)
    }

    /// With its through peak split off, which an instrument has widened.
    pub fn with_split_of(luminous: Table, color: Option<[Vec<f32>; 2]>, instrument: Instrument) -> Self {
        let mut distribution = Self::new(luminous, color);
        distribution.split = Split::of(&distribution, instrument);
        distribution
    }

    /// With a split that was found before; `split` gets the incident division.
    pub fn with_known_split(
        luminous: Table,
        color: Option<[Vec<f32>; 2]>,
        split: impl FnOnce(&Columns) -> Split,
    ) -> Self {
        let mut distribution = Self::new(luminous, color);
        distribution.split = split(&distribution.columns);
        distribution
    }

    /// Luminous values.
    pub fn luminous(&self) -> &Table {
        &self.luminous
    }

    /// Values of CIE X and Z, in the cells of the luminous table.
    pub fn color(&self) -> Option<&[Vec<f32>; 2]> {
        self.color.as_ref()
    }

    /// The incident division.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// The split.
    pub fn split(&self) -> &Split {
        &self.split
    }

    /// Smallest projected solid angle in the table [sr].
    pub fn smallest_projected_solid_angle(&self) -> f64 {
        self.smallest_projected_solid_angle
    }

    /// The part of the luminous values that Radiance's library takes for diffuse [1/sr]: the table's least value, if it makes
    /// up at least 1 % in all, and in a tree less than 150 %.
    pub fn diffuse(&self) -> f64 {
        self.diffuse
    }

    /// The value as it is in the file [1/sr].
    pub fn value(&self, p_in: DVec2, p_out: DVec2) -> Rgb {
        self.at_index(self.luminous.index(p_in, p_out))
    }

    /// The value of a cell as it is in the file [1/sr].
    pub fn at_index(&self, index: usize) -> Rgb {
        let y = f64::from(self.luminous.values()[index]);
        match &self.color {
            None => gray(y),
            Some([x, z]) => to_rgb(DVec3::new(f64::from(x[index]), y, f64::from(z[index]))),
        }
    }

    /// The value less the split peak [1/sr].
    pub fn residual(&self, p_in: DVec2, p_out: DVec2) -> Rgb {
        let index = self.luminous.index(p_in, p_out);
        self.split.surround(self.columns.index(p_in), index).unwrap_or_else(|| self.at_index(index))
    }

    /// Luminous residual of a cell of a column [1/sr].
    pub fn residual_at(&self, column: usize, index: usize) -> f64 {
        match self.split.surround(column, index) {
            Some(rgb) => sunpeak_core::luminance(rgb),
            None => f64::from(self.luminous.values()[index]),
        }
    }
}

fn diffuse(table: &Table) -> f64 {
    let least = match table {
        Table::Tree(t) if t.rank() == 3 => {
            let mut least = f32::INFINITY;
            t.for_each_leaf(|leaf| {
                // The half of an isotropic tree past the middle is not used.
                if leaf.corner[0] < 0.5 {
                    least = least.min(t.values()[leaf.index]);
                }
            });
            least
        }
        _ => table.values().iter().copied().fold(f32::INFINITY, f32::min),
    };
    let whole = PI * f64::from(least);
    let counts = whole > 0.01 && (whole < 1.5 || matches!(table, Table::Matrix(_)));
    if counts { f64::from(least) } else { 0.0 }
}

/// CIE XYZ to Radiance's channels; what lies outside their gamut is brought to its edge.
pub fn to_rgb(xyz: DVec3) -> Rgb {
    xyz_to_rgb(xyz).max(Rgb::ZERO)
}
