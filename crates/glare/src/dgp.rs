//! Daylight glare probability.
//!
//! Wienold and Christoffersen 2006, "Evaluation methods and development of a new glare prediction model for daylight
//! environments with the use of CCD cameras", Energy and Buildings 38, equation 5:
//! `DGP = 5.87e-5 Ev + 9.18e-2 log10(1 + sum L² omega / (Ev^1.87 P²)) + 0.16`.
//!
//! Without sources evalglare 3.06 gives 0.0010 less, and its contrast term is 0.2 % larger: its constants are 0.159 and 9.2e-2.

/// Whose coefficients DGP has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DgpFit {
    /// Those of the publication.
    #[default]
    Published,
    /// Those that evalglare 3.06 shows.
    Evalglare3,
}

/// The terms whose sum is DGP.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DgpTerms {
    /// Without light.
    pub offset: f64,
    /// Of the vertical illuminance.
    pub illuminance: f64,
    /// Of the contrast of the sources.
    pub contrast: f64,
}

/// Weight of the vertical illuminance [1/lx].
const ILLUMINANCE_WEIGHT: f64 = 5.87e-5;
/// Exponent of the vertical illuminance in the contrast term.
const ADAPTATION_EXPONENT: f64 = 1.87;

/// The model was fitted for at least this vertical illuminance [lx] (Wienold and Christoffersen 2006)…
pub(crate) const LOWEST_VALID_EV_LUX: f64 = 380.0;
/// … and for values in this range.
pub(crate) const VALID_DGP: [f64; 2] = [0.2, 0.8];

impl DgpFit {
    /// Weight of the contrast term, and value without light.
    fn coefficients(self) -> (f64, f64) {
        match self {
            Self::Published => (9.18e-2, 0.16),
            Self::Evalglare3 => (9.2e-2, 0.159),
        }
    }

    /// The terms of DGP, from the vertical illuminance at the eye [lx] and the sum of `L² omega / P²` over the sources [cd² sr m⁻⁴].
    pub fn terms(self, ev_lux: f64, sum_of_sources: f64) -> DgpTerms {
        let (weight, offset) = self.coefficients();
        let adaptation = ev_lux.max(0.0).powf(ADAPTATION_EXPONENT);
        let contrast = if adaptation > 0.0 { sum_of_sources / adaptation } else { 0.0 };
        DgpTerms {
            offset,
            illuminance: ILLUMINANCE_WEIGHT * ev_lux,
            contrast: weight * (1.0 + contrast).log10(),
        }
    }
}

impl DgpTerms {
    /// DGP [-], not above 1.
    pub fn dgp(&self) -> f64 {
        (self.offset + self.illuminance + self.contrast).clamp(0.0, 1.0)
    }
}

/// DGP [-], not above 1, from the vertical illuminance at the eye [lx] and the sum of `L² omega / P²` over the sources
/// [cd² sr m⁻⁴], with the published coefficients.
pub fn daylight_glare_probability(ev_lux: f64, sum_of_sources: f64) -> f64 {
    DgpFit::Published.terms(ev_lux, sum_of_sources).dgp()
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

    /// evalglare 3.06 on one disc before a uniform background: Ev [lx], sum over the sources, DGP.
    #[test]
    fn evalglares_own_fit() {
        for (ev, sum, dgp) in [
            (630.442118, 0.0, 0.196007),
            (861.77256, 1026135.1225542912, 0.268113),
            (834.25335, 110046423.03156629, 0.445321),
        ] {
            let found = DgpFit::Evalglare3.terms(ev, sum).dgp();
            assert!((found - dgp).abs() < 3e-6, "{found} {dgp}");
        }
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
