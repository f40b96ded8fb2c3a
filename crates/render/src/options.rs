//! What a caller may choose.

use std::{path::PathBuf, sync::Arc};
use sunpeak_bsdf::{Bsdf, PeakRule};
use sunpeak_core::Rgb;

/// How a scene is compiled.
#[derive(Clone, Debug, Default)]
pub struct WorldOptions {
    /// Which part of an `aBSDF`'s table goes straight through. (A plain `BSDF` has no peak extraction.)
    pub peak: PeakRule,
    /// Tables that are already loaded, by the file that the scene names; others are read.
    pub loaded: Vec<(PathBuf, Arc<Bsdf>)>,
    /// Names of surfaces or modifiers through which light comes in, beside shades, windows and holes in polygons, which are found: openings
    /// between walls, or one polygon instead of very many panes. Paths are sent to them; what the scene looks like does not change.
    pub portals: Vec<String>,
}

/// How a picture, a ray or a sensor is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// Paths for each ray or sensor, for a pixel in the mean (noisy blocks of pixels get more); powers of two converge best. With
    /// `time_s` the most that are traced; with neither, [`DEFAULT_SAMPLES`].
    pub samples: Option<u32>,
    /// Stop when the error is this small [-] with 95 % confidence: the root mean square over blocks of pixels about 3 degrees wide (over rays or
    /// sensors) of the error of their luminance, relative to the mean luminance of all. Exact suns have none. With `samples` or
    /// `time_s` whatever comes first.
    pub error: Option<f64>,
    /// Is `error` that of each ray or sensor relative to its own mean, so that a dark one counts as much as a bright one?
    pub error_of_each: bool,
    /// Time to spend [s]: passes go on until the next one would not fit. At least one path each.
    pub time_s: Option<f64>,
    /// The same seed and number of paths give the same result, on any number of threads.
    pub seed: u64,
    /// Radiance's `-ab`: diffuse bounces that a path may take; `Some(0)` is direct light only. `None` is no limit.
    /// Skies and far `glow`s are found by indirect rays, so they need one bounce; scattering by rough highlights and by BSDF
    /// tables is no bounce, as in Radiance.
    pub max_bounces: Option<u32>,
    /// Radiance's `-av`: radiance [W sr⁻¹ m⁻²] that stands for all diffuse light past `max_bounces`.
    pub ambient: Rgb,
    /// Surfaces of any kind that a path may meet; a safeguard, since paths end by Russian roulette.
    pub max_depth: u32,
    /// Threads to use; `None` is all cores.
    pub threads: Option<usize>,
    /// Put suns into pictures exactly (see the crate's front page) instead of leaving them to the pixels' samples.
    pub exact_suns: bool,
}

/// Paths for each pixel, ray or sensor unless the caller says.
pub const DEFAULT_SAMPLES: u32 = 64;

/// Surfaces of any kind that a path may meet unless the caller says.
pub const DEFAULT_MAX_DEPTH: u32 = 256;

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples: None,
            error: None,
            error_of_each: false,
            time_s: None,
            seed: 0,
            max_bounces: None,
            ambient: Rgb::ZERO,
            max_depth: DEFAULT_MAX_DEPTH,
            threads: None,
            exact_suns: true,
        }
    }
}
