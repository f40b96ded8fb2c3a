//! Daylight glare probability.
//!
//! Wienold and Christoffersen 2006, "Evaluation methods and development of a new glare prediction model for daylight
//! environments with the use of CCD cameras", Energy and Buildings 38, equation 5:
//! `DGP = 5.87e-5 Ev + 9.18e-2 log10(1 + sum L² omega / (Ev^1.87 P²)) + 0.16`.
//!
//! evalglare 3.06 gives 0.0010 less for a picture of one luminance, and 0.0008 to 0.0010 less otherwise, with the same Ev and
//! sources; the publication is followed here.

/// Weight of the vertical illuminance [1/lx].
const ILLUMINANCE_WEIGHT: f64 = 5.87e-5;
/// Weight of the contrast term.
const CONTRAST_WEIGHT: f64 = 9.18e-2;
/// Value without light.
const OFFSET: f64 = 0.16;
/// Exponent of the vertical illuminance in the contrast term.
const ADAPTATION_EXPONENT: f64 = 1.87;

/// The model was fitted for at least this vertical illuminance [lx] (Wienold and Christoffersen 2006)…
pub(crate) const LOWEST_VALID_EV_LUX: f64 = 380.0;
/// … and for values in this range.
pub(crate) const VALID_DGP: [f64; 2] = [0.2, 0.8];

/// DGP [-], not above 1, from the vertical illuminance at the eye [lx] and the sum of `L² omega / P²` over the sources
/// [cd² sr m⁻⁴].
pub fn daylight_glare_probability(ev_lux: f64, sum_of_sources: f64) -> f64 {
    let adaptation = ev_lux.max(0.0).powf(ADAPTATION_EXPONENT);
    let contrast = if adaptation > 0.0 { sum_of_sources / adaptation } else { 0.0 };
    let dgp = ILLUMINANCE_WEIGHT * ev_lux + CONTRAST_WEIGHT * (1.0 + contrast).log10() + OFFSET;
    dgp.clamp(0.0, 1.0)
}

/// Factor on DGP for dim scenes (Wienold 2012, "New features of evalglare", 11th Radiance Workshop; evalglare `-C l+`):
/// 1/2 at 167 lx, 0.9997 at 500 lx.
pub fn low_light_factor(ev_lux: f64) -> f64 {
    1.0 / (1.0 + (4.0 - 0.024 * ev_lux).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_sources_only_the_illuminance_counts() {
        assert!((daylight_glare_probability(0.0, 0.0) - 0.16).abs() < 1e-12);
        assert!((daylight_glare_probability(2000.0, 0.0) - 0.2774).abs() < 1e-12);
        assert_eq!(daylight_glare_probability(1e6, 0.0), 1.0);
    }

    #[test]
    fn one_source_by_hand() {
        // Ev 1000 lx, 10 000 cd/m² over 0.1 sr at P = 2: 2.5e6 / 1000^1.87 = 6.1367, log10(7.1367) = 0.85350.
        let dgp = daylight_glare_probability(1000.0, 1e8 * 0.1 / 4.0);
        assert!((dgp - (0.0587 + 0.0918 * 0.853_50 + 0.16)).abs() < 1e-5, "{dgp}");
    }

    /// evalglare 3.06 with and without `-C l+` at 37.439408, 163.5979 and 476.970383 lx.
    #[test]
    fn low_light_factor_agrees_with_evalglare() {
        for (ev, with, without) in [
            (37.439408, 0.009882, 0.229567),
            (163.5979, 0.086064, 0.178707),
            (476.970383, 0.188413, 0.188523),
        ] {
            assert!((low_light_factor(ev) - with / without).abs() < 1e-5);
        }
    }
}
