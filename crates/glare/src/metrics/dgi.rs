//! Daylight glare index.

use super::Seen;

/// Of the whole sum (Hopkinson 1972, "Glare from daylighting in buildings", Applied Ergonomics 3(4), 206-215).
const SCALE: f64 = 0.478;
/// Weight of a source's own luminance in the adaptation.
const OWN_WEIGHT: f64 = 0.07;
const LUMINANCE_EXPONENT: f64 = 1.6;
const SOLID_ANGLE_EXPONENT: f64 = 0.8;
/// Exponent of the adaptation luminance in the modified index.
const ADAPTATION_EXPONENT: f64 = 0.85;

/// `DGI = 10 log10(0.478 sum L^1.6 Omega^0.8 / (Lb + 0.07 omega^0.5 L))`, `Omega = omega / P²` (Hopkinson 1972; the form of Chauvel,
/// Collins, Dogniaux and Longmore 1982, "Glare from windows", Lighting Research & Technology 14(1)). 16 is just perceptible,
/// 24 just uncomfortable.
///
/// `Lb` is the background's luminance, (Ev - Ev of the sources) / pi.
pub(crate) fn daylight_glare_index(seen: &Seen) -> f64 {
    index(seen, seen.background_cd_m2())
}

/// `DGI` with the adaptation luminance to the power of 0.85 in the place of `Lb` (Fisekis, Davies, Kolokotroni and Langford
/// 2003, "Prediction of discomfort glare from windows", Lighting Research & Technology 35(4)). The adaptation luminance is
/// Ev / pi, as in evalglare 3.06.
pub(crate) fn modified_daylight_glare_index(seen: &Seen) -> f64 {
    index(seen, (seen.ev_lux / std::f64::consts::PI).powf(ADAPTATION_EXPONENT))
}

fn index(seen: &Seen, adaptation: f64) -> f64 {
    let term = |source: &crate::Source| {
        let (luminance, solid_angle) = (source.luminance_cd_m2, source.solid_angle_sr);
        let seen_solid_angle = solid_angle / source.position_index.powi(2);
        luminance.powf(LUMINANCE_EXPONENT) * seen_solid_angle.powf(SOLID_ANGLE_EXPONENT)
            / (adaptation + OWN_WEIGHT * solid_angle.sqrt() * luminance)
    };
    10.0 * (SCALE * seen.sources.iter().map(term).sum::<f64>()).log10()
}
