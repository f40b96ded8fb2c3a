//! Glare metrics from pictures: position index, source detection, DGP and its siblings. How the picture was made is
//! not known here.
//!
//! [`evaluate`] looks at a [`sunpeak_scene::Picture`] in five steps:
//! `field` (luminance, solid angle and direction of each pixel), `exact` and `behind` (suns that the picture knows exactly
//! leave their pixels), `detect` (pixels that glare), `cluster` (which of them are one source), `dgp` (the equations).
//!
//! All of it is written from publications; the comments name them. Where they leave a choice, it is an option in
//! [`GlareOptions`] with evalglare's value as its default.

mod behind;
mod blocks;
mod change;
mod checks;
mod class;
mod cluster;
mod detect;
mod dgp;
mod evaluate;
mod exact;
mod field;
pub(crate) mod metrics;
mod noise;
mod normal;
mod options;
mod position_index;
mod report;
mod survey;
mod uncertainty;
mod zones;

pub use class::{ClassVerdict, GlareClass};
pub use dgp::{DgpFit, DgpTerms, daylight_glare_probability, low_light_factor};
pub use evaluate::{evaluate, evaluate_with_pixels};
pub use metrics::Metrics;
pub use options::{GlareOptions, SourceCentre, TaskZone, Threshold, Tolerances};
pub use position_index::{BelowSight, position_index};
pub use report::{GlareReport, Source, ZoneLuminances};
pub use uncertainty::Intervals;
