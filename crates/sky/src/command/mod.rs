//! `gensky` and `gendaylit`: what Radiance's programs print for the same arguments.
//!
//! Primitives and their numbers agree to the printed digits; comments may differ, and what the programs say on standard
//! error stands in comments here. Arguments are those after the program's name. Where a program silently reads a wrong
//! argument as 0, these functions return an error that names the option.

mod args;
mod daylit_args;
mod daylit_place;
mod daylit_radiation;
mod format;
mod gendaylit;
mod gensky;

pub use gendaylit::gendaylit;
pub use gensky::gensky;

/// The sun of both programs is never put nearer to the zenith than this altitude [deg].
const HIGHEST_SUN_DEG: f64 = 87.0;
