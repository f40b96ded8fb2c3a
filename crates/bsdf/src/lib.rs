//! BSDF tables: read them, evaluate, sample, and extract their through peak.
//!
//! Directions are unit vectors in the BSDF's frame that point away from the surface; z is the front normal, y up, x = y cross
//! z. `w_in` is the side of the ray that is being traced (minus the ray's direction), `w_out` the other one: the order of
//! arguments of the Radiance library, whose meaning of sides this crate has.
//!
//! ```no_run
//! use sunpeak_bsdf::{Bsdf, PeakRule};
//! use sunpeak_core::Vec3;
//! let shade = Bsdf::load("shade.xml".as_ref())?;
//! let through = shade.through(Vec3::Z, PeakRule::Split);
//! # Ok::<(), sunpeak_core::Error>(())
//! ```

mod backlit;
pub mod basis;
mod bsdf;
mod cache;
pub mod codec;
mod convert;
pub mod counted;
mod distribution;
mod exact_peak;
mod incident;
mod kernel;
mod layout;
mod load;
pub mod measured;
pub mod model;
pub mod outline;
pub mod overlap;
pub mod peak;
mod picture_cells;
mod proposal;
pub mod report;
mod split_files;
pub mod synthetic;
pub mod system;
pub mod table;
pub mod tree;
mod work;
pub mod xml;
mod xml_write;

pub use backlit::Backlit;
pub use bsdf::{Bsdf, Mode, Sample, Sides};
pub use cache::Cache;
pub use convert::Conversion;
pub use distribution::Distribution;
pub use incident::Incident;
pub use kernel::Spread;
pub use layout::Layout;
pub use peak::{ColumnPeak, Instrument, PeakRule, Split};
pub use picture_cells::{ExitCell, IncidentCell};
pub use proposal::Oriented;
pub use split_files::SplitFiles;
pub use work::{Kept, Work};
pub use xml_write::{Geometry, Label};
