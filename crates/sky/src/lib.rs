//! Sun position and disc, Perez and CIE skies, ground. It does not know rooms.

mod distribution;

pub use distribution::{CieSky, SkyDistribution};
