//! Unified glare rating, and its extension for small sources.

use super::Seen;
use crate::Source;

/// Weight of the sum (CIE 117:1995, "Discomfort glare in interior lighting").
const SCALE: f64 = 0.25;

/// Projected area below which a source is small [m²] (CIE 147:2002, "Glare from small, large and complex sources").
const SMALL_AREA_M2: f64 = 0.005;

/// `UGR = 8 log10(0.25 / Lb sum L² omega / P²)` (CIE 117:1995). Below 10 nobody complains, 19 is the usual limit in offices.
///
/// `Lb` is the background's luminance, (Ev - Ev of the sources) / pi.
pub(crate) fn unified_glare_rating(seen: &Seen) -> f64 {
    rating(seen, seen.contrast_sum())
}

/// UGR with `200 I² / (r² P²)` in the place of `L² omega / P²` for sources with less than 0.005 m² of projected area (CIE 147:2002): they
/// count as if they had that area. `I = L A` is the luminous intensity, `r` the distance, `A = omega r²` the area.
///
/// `None` if the distance is not known: a picture alone does not tell a lamp from a window.
pub(crate) fn small_source_extension(seen: &Seen) -> Option<f64> {
    let distance = seen.source_distance_m?;
    let weight = |source: &Source| {
        let area = source.solid_angle_sr * distance.powi(2);
        source.weight() * if area < SMALL_AREA_M2 { area / SMALL_AREA_M2 } else { 1.0 }
    };
    Some(rating(seen, seen.sources.iter().map(weight).sum()))
}

fn rating(seen: &Seen, sum: f64) -> f64 {
    8.0 * (SCALE / seen.background_cd_m2() * sum).log10()
}

#[cfg(test)]
mod tests {
    use super::super::testing::blind;
    use super::*;

    /// 0.002 m² at 4 m: `I = 8000 · 0.002 = 16 cd`, `200 · 16² / 4² = 3200` and not `L² omega = 8000`.
    #[test]
    fn a_small_source_counts_as_if_it_had_five_thousandths_of_a_square_metre() {
        let mut seen = blind();
        seen.sources.truncate(1);
        seen.sources[0].luminance_cd_m2 = 8000.0;
        seen.sources[0].solid_angle_sr = 0.002 / 16.0;
        seen.sources[0].position_index = 1.0;
        assert_eq!(small_source_extension(&seen), None);
        seen.source_distance_m = Some(4.0);
        let expected = 8.0 * (0.25 / seen.background_cd_m2() * 3200.0).log10();
        let found = small_source_extension(&seen).expect("the distance is known");
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        seen.sources[0].solid_angle_sr = 0.006 / 16.0;
        assert_eq!(small_source_extension(&seen), Some(unified_glare_rating(&seen)));
    }
}
