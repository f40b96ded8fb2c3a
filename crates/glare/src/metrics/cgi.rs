//! CIE glare index.

use super::Seen;

/// `CGI = 8 log10(2 (1 + Ed/500) / (Ed + Ei) sum L² omega / P²)` (Einhorn 1979, "Discomfort glare: a formula to bridge
/// differences", Lighting Research & Technology 11(2)); `Ed`, `Ei`: vertical illuminance at the eye from the sources and
/// from the rest [lx].
pub(crate) fn cie_glare_index(seen: &Seen) -> f64 {
    let direct = 1.0 + seen.ev_sources_lux / 500.0;
    8.0 * (2.0 * direct / seen.ev_lux * seen.contrast_sum()).log10()
}
