//! Peak extraction: the part of a table that goes straight through.
//!
//! [`Split`] is rule 3, done once in the data. [`reference`] holds rules 1 and 2, decided anew at every hit, for comparison.

mod colors;
mod fit;
mod instrument;
mod interpolate;
mod judge;
mod neighbourhood;
mod noise;
pub(crate) mod nonnegative;
pub mod reference;
mod shape;
mod split;
mod surround;

pub use instrument::{FWHM_RANGE_DEG, Instrument, find as find_instrument};
pub use shape::NARROWEST;
pub use split::{ColumnPeak, Part, Split};

/// Which part of a table goes straight through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PeakRule {
    /// None: the table as it is.
    Off,
    /// The revision that the paper cites (2020/21).
    Paper,
    /// Today's Radiance (2021-08 on).
    Radiance,
    /// Once, in the data: the default.
    #[default]
    Split,
}

impl std::str::FromStr for PeakRule {
    type Err = sunpeak_core::Error;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "off" => Ok(Self::Off),
            "paper" => Ok(Self::Paper),
            "radiance" => Ok(Self::Radiance),
            "split" => Ok(Self::Split),
            _ => Err(sunpeak_core::Error::value(format!(
                "peak rule '{name}'; expected split, radiance, paper or off"
            ))),
        }
    }
}
