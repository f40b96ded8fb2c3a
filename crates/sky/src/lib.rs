//! Sun position and disc, Perez and CIE skies, ground. It does not know rooms.
//!
//! [`Sky::perez`] and [`Sky::cie`] make skies from numbers; [`command`] prints what Radiance's `gensky` and `gendaylit`
//! print; [`SkyDistribution`] is what both end in: brightness over direction.
//!
//! ```
//! use sunpeak_sky::{PerezWeather, Sky, sun_direction};
//! let weather = PerezWeather {
//!     sun_direction: sun_direction(35.0, 170.0),
//!     direct_normal_w_m2: 700.0,
//!     diffuse_horizontal_w_m2: 90.0,
//!     day_of_year: 80,
//!     ..PerezWeather::default()
//! };
//! let sky = Sky::perez(&weather)?;
//! assert!(sky.to_radiance_text().contains("perezlum.cal"));
//! # Ok::<(), sunpeak_core::Error>(())
//! ```

mod cie;
pub mod command;
mod distribution;
mod perez;
mod perez_tables;
mod position;
mod sky;

pub use cie::CieWeather;
pub use distribution::{CieSky, SkyDistribution};
pub use perez::{PerezIlluminance, PerezWeather};
pub use position::{Clock, Date, RadianceSite, SolarPosition, solar_position_radiance, sun_direction};
pub use sky::{Sky, Sun};
