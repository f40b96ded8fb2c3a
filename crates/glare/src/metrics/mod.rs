//! Glare metrics other than DGP, each by its published equation, one a file.
//!
//! All of them look at the same sources, so that they can be compared. `L` is a source's luminance [cd/m²], `omega` its solid
//! angle [sr], `P` its position index, `Lb` the luminance of the background [cd/m²]. Where there is no source, ratings
//! that are logarithms of a sum over sources have no value.

pub(crate) mod cgi;
pub(crate) mod dgi;
pub(crate) mod pgsv;
pub(crate) mod simplified;
pub(crate) mod ugp;
pub(crate) mod ugr;
pub(crate) mod vcp;
pub(crate) mod veil;

use crate::Source;

/// What the equations need to know of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    pub sources: Vec<Source>,
    /// Vertical illuminance at the eye [lx], all of it and the sources' part.
    pub ev_lux: f64,
    pub ev_sources_lux: f64,
    /// Mean luminance of the field of view, sources included.
    pub mean_luminance_cd_m2: f64,
    /// Mean luminance of what is no source; `None` if sources fill the view.
    pub surround_luminance_cd_m2: Option<f64>,
    /// How far away sources are taken to be [m].
    pub source_distance_m: Option<f64>,
}

impl Seen {
    /// Illuminance that does not come from the sources [lx].
    pub fn indirect_lux(&self) -> f64 {
        (self.ev_lux - self.ev_sources_lux).max(0.0)
    }

    /// Luminance of a uniform background that gives that illuminance [cd/m²].
    pub fn background_cd_m2(&self) -> f64 {
        self.indirect_lux() / std::f64::consts::PI
    }

    /// Sum of `L² omega / P²` [cd² sr m⁻⁴].
    pub fn contrast_sum(&self) -> f64 {
        self.sources.iter().map(Source::weight).sum()
    }
}

/// Glare ratings other than DGP. `None`: the equation has no value, mostly as there is no source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metrics {
    /// Simplified DGP, from the vertical illuminance alone [-].
    pub dgps: f64,
    /// Daylight glare index [-].
    pub dgi: Option<f64>,
    /// Daylight glare index with the adaptation luminance in its denominator [-].
    pub dgi_modified: Option<f64>,
    /// Unified glare rating [-].
    pub ugr: Option<f64>,
    /// Unified glare rating with the extension for small sources [-]; needs their distance.
    pub ugr_small_source: Option<f64>,
    /// Unified glare probability of 2014 [-].
    pub ugp: Option<f64>,
    /// Unified glare probability of 2017 [-].
    pub ugp_2017: Option<f64>,
    /// CIE glare index [-].
    pub cgi: Option<f64>,
    /// Visual comfort probability [%].
    pub vcp: Option<f64>,
    /// Discomfort glare rating [-].
    pub dgr: Option<f64>,
    /// Predicted glare sensation vote by contrast [-].
    pub pgsv: Option<f64>,
    /// Predicted glare sensation vote by saturation [-].
    pub pgsv_saturation: f64,
    /// Equivalent veiling luminance [cd/m²].
    pub veiling_luminance_cd_m2: f64,
}

impl Metrics {
    pub(crate) fn of(seen: &Seen) -> Self {
        Self {
            dgps: simplified::dgps(seen.ev_lux),
            dgi: finite(dgi::daylight_glare_index(seen)),
            dgi_modified: finite(dgi::modified_daylight_glare_index(seen)),
            ugr: finite(ugr::unified_glare_rating(seen)),
            ugr_small_source: ugr::small_source_extension(seen).and_then(finite),
            ugp: finite(ugp::unified_glare_probability_2014(seen)),
            ugp_2017: finite(ugp::unified_glare_probability_2017(seen)).filter(|_| !seen.sources.is_empty()),
            cgi: finite(cgi::cie_glare_index(seen)),
            vcp: finite(vcp::visual_comfort_probability(seen)),
            dgr: finite(vcp::discomfort_glare_rating(seen)),
            pgsv: pgsv::contrast_vote(seen).and_then(finite),
            pgsv_saturation: pgsv::saturation_vote(seen),
            veiling_luminance_cd_m2: veil::veiling_luminance(seen),
        }
    }

    /// Names and values, in the order of the fields.
    pub fn values(&self) -> [(&'static str, Option<f64>); 13] {
        [
            ("dgps", Some(self.dgps)),
            ("dgi", self.dgi),
            ("dgi_modified", self.dgi_modified),
            ("ugr", self.ugr),
            ("ugr_small_source", self.ugr_small_source),
            ("ugp", self.ugp),
            ("ugp_2017", self.ugp_2017),
            ("cgi", self.cgi),
            ("vcp", self.vcp),
            ("dgr", self.dgr),
            ("pgsv", self.pgsv),
            ("pgsv_saturation", Some(self.pgsv_saturation)),
            ("veiling_luminance_cd_m2", Some(self.veiling_luminance_cd_m2)),
        ]
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
pub(crate) mod testing {
    use super::*;
    use sunpeak_core::Vec3;

    /// The big source of the field's test picture (786 x 786 pixels, a room with a blind), with the numbers that evalglare 3.06 prints.
    pub fn blind() -> Seen {
        let source =
            |direction, solid_angle_sr, luminance_cd_m2, position_index, illuminance_lux, angle: f64| {
                Source {
                    direction,
                    solid_angle_sr,
                    luminance_cd_m2,
                    position_index,
                    illuminance_lux,
                    angle_to_sight_rad: angle.to_radians(),
                    dgp_part: 0.0,
                    exact: false,
                    pixels: 1,
                }
            };
        Seen {
            sources: vec![
                source(Vec3::Y, 1.8150347884, 3901.193202, 2.545465, 4392.949493, 40.367518),
                source(Vec3::Y, 0.0000354835, 2034.238854, 5.989152, 0.016078, 77.290051),
                source(Vec3::Y, 0.0000751695, 2041.712983, 4.669596, 0.051636, 70.573095),
            ],
            ev_lux: 6124.936725,
            ev_sources_lux: 4393.017207,
            mean_luminance_cd_m2: 1729.700668,
            surround_luminance_cd_m2: Some(551.0),
            source_distance_m: None,
        }
    }

    #[test]
    fn agree_with_evalglare_on_its_own_sources() {
        let found = Metrics::of(&blind());
        let near = |value: Option<f64>, expected: f64| {
            let value = value.expect("there are sources");
            assert!((value / expected - 1.0).abs() < 1e-5, "{value} {expected}");
        };
        near(found.dgi, 20.198586);
        near(found.dgi_modified, 19.859907);
        near(found.ugr, 26.290476);
        near(found.ugp, 0.854441);
        near(found.ugp_2017, 0.627696);
        near(found.cgi, 33.074261);
        near(found.dgr, 570.981323);
        near(found.vcp, 2.160634);
        near(Some(found.veiling_luminance_cd_m2), 26.958406);
    }

    #[test]
    fn without_sources_ratings_have_no_value() {
        let found = Metrics::of(&Seen { sources: Vec::new(), ev_sources_lux: 0.0, ..blind() });
        assert_eq!(
            (found.dgi, found.ugr, found.ugp, found.ugp_2017, found.cgi),
            (None, None, None, None, None)
        );
        assert_eq!((found.vcp, found.dgr, found.pgsv), (Some(100.0), Some(0.0), None));
        assert_eq!(found.veiling_luminance_cd_m2, 0.0);
    }
}
