//! Products of our own making, known in closed form and tabulated by cell averages: what a table should give back is known.
//!
//! [`Fabric`] is the family of the design studies for peak extraction. Beside it stand what else one can see through
//! ([`Weave`], [`Perforated`], [`Mesh`], [`Pane`], [`Blind`]) and what one cannot ([`Panel`], [`Diffuser`]): a split must take the
//! straight part of the first and leave the others alone. [`RollerBlind`] is what a datasheet says. [`Goniophotometer`] adds what a measurement adds: an instrument's
//! blur, counted rays, noisy values.

mod basis;
mod blind;
mod fabric;
mod goniophotometer;
mod mesh;
mod pane;
mod panel;
mod perforated;
mod product;
mod roller_blind;
mod tabulate;
mod weave;

pub use basis::Basis;
pub use blind::Blind;
pub use fabric::{Fabric, Woven};
pub use goniophotometer::Goniophotometer;
pub use mesh::Mesh;
pub use pane::Pane;
pub use panel::{Diffuser, Panel};
pub use perforated::Perforated;
pub use product::{Lobe, Product};
pub use roller_blind::RollerBlind;
pub use tabulate::{tabulate, tabulate_exact, tabulate_watched};
pub use weave::Weave;
