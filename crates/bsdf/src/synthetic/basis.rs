//! The bases that products are tabulated in, by name.

use crate::{basis::AngleBasis, layout::Layout, table::Columns};
use std::sync::Arc;
use sunpeak_core::{Error, Result};

/// The basis to tabulate in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// LBNL/Klems Full (145 patches).
    KlemsFull,
    /// LBNL/Klems Half (77 patches).
    KlemsHalf,
    /// LBNL/Klems Quarter (41 patches).
    KlemsQuarter,
    /// Isotropic tensor tree of `side * side` exiting cells: "1024" is a side of 32.
    TensorTree3 {
        /// Cells a side, a power of two.
        side: usize,
    },
    /// Anisotropic tensor tree of `side * side` exiting cells.
    TensorTree4 {
        /// Cells a side, a power of two.
        side: usize,
    },
}

impl std::str::FromStr for Basis {
    type Err = Error;

    /// `klems`, `klems-half`, `klems-quarter`, `t3-N`, `t4-N` with N = 4^k exiting cells.
    fn from_str(name: &str) -> Result<Self> {
        let wrong = || {
            Error::value(format!(
                "basis '{name}'; expected klems, klems-half, klems-quarter, t3-N or t4-N (N = 64, 256, 1024, 4096 or 16384)"
            ))
        };
        match name {
            "klems" | "klems-full" => return Ok(Self::KlemsFull),
            "klems-half" => return Ok(Self::KlemsHalf),
            "klems-quarter" => return Ok(Self::KlemsQuarter),
            _ => {}
        }
        let (rank, cells) = name.split_once('-').ok_or_else(wrong)?;
        let side = match cells {
            "64" => 8,
            "256" => 16,
            "1024" => 32,
            "4096" => 64,
            "16384" => 128,
            _ => return Err(wrong()),
        };
        match rank {
            "t3" => Ok(Self::TensorTree3 { side }),
            "t4" => Ok(Self::TensorTree4 { side }),
            _ => Err(wrong()),
        }
    }
}

impl std::fmt::Display for Basis {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::KlemsFull => f.write_str("klems"),
            Self::KlemsHalf => f.write_str("klems-half"),
            Self::KlemsQuarter => f.write_str("klems-quarter"),
            Self::TensorTree3 { side } => write!(f, "t3-{}", side * side),
            Self::TensorTree4 { side } => write!(f, "t4-{}", side * side),
        }
    }
}

impl Basis {
    /// `IncidentDataStructure` of a file in this basis.
    pub fn structure(self) -> &'static str {
        match self {
            Self::TensorTree3 { .. } => "TensorTree3",
            Self::TensorTree4 { .. } => "TensorTree4",
            _ => "Columns",
        }
    }

    /// Incidences differ by their angle from the normal alone.
    pub fn is_isotropic(self) -> bool {
        matches!(self, Self::TensorTree3 { .. })
    }

    /// The patches of a matrix basis.
    pub fn patches(self) -> Option<Arc<AngleBasis>> {
        let name = match self {
            Self::KlemsFull => "LBNL/Klems Full",
            Self::KlemsHalf => "LBNL/Klems Half",
            Self::KlemsQuarter => "LBNL/Klems Quarter",
            Self::TensorTree3 { .. } | Self::TensorTree4 { .. } => return None,
        };
        AngleBasis::known(name).map(Arc::new)
    }

    /// The incident division and the exiting one.
    pub fn divisions(self) -> [Columns; 2] {
        match (self, self.patches()) {
            (_, Some(basis)) => [Columns::Patches(basis.clone()), Columns::Patches(basis)],
            (Self::TensorTree3 { side }, _) => [Columns::Radial { side }, Columns::Square { side }],
            (Self::TensorTree4 { side }, _) => [Columns::Square { side }, Columns::Square { side }],
            _ => unreachable!("every other basis is a known matrix basis"),
        }
    }

    /// Both of them.
    pub fn layout(self) -> Layout {
        let [incident, exiting] = self.divisions();
        Layout { incident, exiting }
    }
}
