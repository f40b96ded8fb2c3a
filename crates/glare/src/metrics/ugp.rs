//! Unified glare probability.

use super::Seen;

/// `UGP = 0.26 log10(0.25 / Lb sum L² omega / P²)`: a rating for deep offices (Hirning, Isoardi and Cowling 2014, "Discomfort
/// glare in open plan green buildings", Energy and Buildings 70).
pub(crate) fn unified_glare_probability_2014(seen: &Seen) -> f64 {
    0.26 * (0.25 / seen.background_cd_m2() * seen.contrast_sum()).log10()
}

/// `UGP = (1 + 2/7 S^(-1/5))^(-10)`, `S = sum L² omega / (P² Lb)`: the same rating as a probability from 0 to 1 (Hirning, Isoardi
/// and Garcia-Hansen 2017, "Prediction of discomfort glare from windows under tropical skies", Building and Environment 113).
pub(crate) fn unified_glare_probability_2017(seen: &Seen) -> f64 {
    let contrast = seen.contrast_sum() / seen.background_cd_m2();
    (1.0 + 2.0 / 7.0 * contrast.powf(-0.2)).powi(-10)
}
