//! Peaks that an instrument has widened.

use crate::{
    kernel::{HALF_WIDTH, Spread},
    table::{Columns, Table},
};

/// What an instrument made of a delta before the table was made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Instrument {
    /// Nothing: the table has it in the cells that the straight direction touches (computed tables, fine instruments).
    #[default]
    None,
    /// A lobe of this full width at half maximum [deg] around the straight direction, the same at all incidences.
    FwhmDeg(f64),
    /// Look for it: a lobe of constant angular width that follows the straight direction.
    Find,
}

/// The Gaussian of a full width at half maximum [deg].
pub fn blur(fwhm_deg: f64) -> Spread {
    Spread::Angle(fwhm_deg.to_radians() / HALF_WIDTH)
}

/// Full width at half maximum [deg] of the blur that a table shows, if it shows one.
pub fn find(_table: &Table, _columns: &Columns) -> Option<f64> {
    None
}
