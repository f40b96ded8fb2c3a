//! Veiling luminance: light that is scattered in the eye.

use super::Seen;
use crate::Source;

/// Sources nearer to the line of sight than this count as if they stood there [deg]: the equation holds from 1 to 30 degrees.
const LEAST_ANGLE_DEG: f64 = 1.0;

/// `Lv = 10 sum E / theta²` [cd/m²], `E` the vertical illuminance of a source at the eye [lx], `theta` its angle from the
/// line of sight [deg] (Stiles and Holladay; CIE 146:2002, "CIE equations for disability glare", for a young eye).
pub(crate) fn veiling_luminance(seen: &Seen) -> f64 {
    let term = |source: &Source| {
        let theta = source.angle_to_sight_rad.to_degrees().max(LEAST_ANGLE_DEG);
        10.0 * source.illuminance_lux / (theta * theta)
    };
    seen.sources.iter().map(term).sum()
}
