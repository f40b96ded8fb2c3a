//! Discomfort glare rating and visual comfort probability.

use super::Seen;
use crate::Source;
use crate::normal;

/// Exponent of the number of sources.
const NUMBER_EXPONENT: f64 = -0.0914;
const ADAPTATION_EXPONENT: f64 = 0.44;

/// `DGR = (sum 0.5 L Q / (P Fv^0.44))^(n^-0.0914)`, `Q = 20.4 omega + 1.52 omega^0.2 - 0.075`, `n` the number of sources (IES Lighting
/// Handbook; Guth 1963, "A method for the evaluation of discomfort glare", Illuminating Engineering 57).
///
/// `Fv` is the mean luminance of the field of view, sources included; here of the hemisphere in front.
pub(crate) fn discomfort_glare_rating(seen: &Seen) -> f64 {
    let adaptation = seen.mean_luminance_cd_m2.powf(ADAPTATION_EXPONENT);
    let term = |source: &Source| {
        // Below 3e-7 sr the fit would count a source as soothing.
        let size = (20.4 * source.solid_angle_sr + 1.52 * source.solid_angle_sr.powf(0.2) - 0.075).max(0.0);
        0.5 * source.luminance_cd_m2 * size / (source.position_index * adaptation)
    };
    if seen.sources.is_empty() {
        return 0.0;
    }
    let exponent = (seen.sources.len() as f64).powf(NUMBER_EXPONENT);
    seen.sources.iter().map(term).sum::<f64>().powf(exponent)
}

/// Share of people [%] who find the lighting comfortable: the normal distribution at `6.374 - 1.3227 ln DGR` (IES Lighting Handbook).
pub(crate) fn visual_comfort_probability(seen: &Seen) -> f64 {
    100.0 * normal::cumulative(6.374 - 1.3227 * discomfort_glare_rating(seen).ln())
}
