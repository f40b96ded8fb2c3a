//! From a picture to a report.

use crate::class::GlareClass;
use crate::detect::{self, Head};
use crate::dgp::{LOWEST_VALID_EV_LUX, VALID_DGP, daylight_glare_probability, low_light_factor};
use crate::exact::{self, VisibleSource};
use crate::field::Field;
use crate::options::GlareOptions;
use crate::report::{GlareReport, Source};
use std::f64::consts::PI;
use sunpeak_core::Result;
use sunpeak_scene::Picture;

/// Share of the hemisphere that a picture must cover for its own Ev to count as whole.
const WHOLE_COVERAGE: f64 = 0.99;

/// Standard deviations of a 95 % confidence interval.
const CONFIDENCE: f64 = 1.96;

/// Find glare sources and compute DGP.
///
/// Fails if the picture has no view, a view without an eye, or pixels that are not numbers of light.
pub fn evaluate(picture: &Picture, options: &GlareOptions) -> Result<GlareReport> {
    options.check()?;
    let mut warnings = Vec::new();
    let mut field = Field::new(picture)?;
    let coverage = field.coverage();
    let suns = exact::take_out(&mut field, picture, &mut warnings);

    let (threshold_cd_m2, rule) = detect::threshold(&field, options)?;
    let mut sources = detect::sources(&field, threshold_cd_m2, options);
    sources.extend(glaring_suns(&field, &suns, threshold_cd_m2, options));
    sources.sort_by(|a, b| b.weight().total_cmp(&a.weight()));

    let of_suns: f64 = suns.iter().map(|sun| sun.illuminance_lux).sum();
    let ev_lux = options.ev_lux.unwrap_or_else(|| field.illuminance_lux() + of_suns);
    let sum: f64 = sources.iter().map(Source::weight).sum();
    let plain = daylight_glare_probability(ev_lux, sum);
    let factor = low_light_factor(ev_lux);
    let chosen_factor = if options.low_light { factor } else { 1.0 };
    let dgp = plain * chosen_factor;
    warn_about_validity(plain, ev_lux, coverage, options, &mut warnings);

    let ev_sources_lux = sources.iter().map(|source| source.illuminance_lux).sum();
    Ok(GlareReport {
        dgp,
        dgp_interval: interval(ev_lux, sum, options.relative_error).map(|bound| bound * chosen_factor),
        dgp_low_light_corrected: plain * factor,
        class: GlareClass::of(dgp),
        ev_lux,
        ev_sources_lux,
        threshold_cd_m2,
        rule: describe(&rule, options, !suns.is_empty()),
        mean_luminance_cd_m2: mean_luminance(&field, &suns),
        max_luminance_cd_m2: suns.iter().map(|sun| sun.luminance_cd_m2).fold(field.max_luminance(), f64::max),
        background_cd_m2: ((ev_lux - ev_sources_lux) / PI).max(0.0),
        sources,
        warnings,
    })
}

/// Exact sources above the threshold, as glare sources.
fn glaring_suns(
    field: &Field,
    suns: &[VisibleSource],
    threshold: f64,
    options: &GlareOptions,
) -> Vec<Source> {
    let head = Head { sight: field.sight, up: field.view.up, options };
    suns.iter()
        .filter(|sun| sun.luminance_cd_m2 > threshold)
        .map(|sun| Source {
            direction: sun.direction,
            solid_angle_sr: sun.solid_angle_sr,
            luminance_cd_m2: sun.luminance_cd_m2,
            position_index: head.position_index(sun.direction),
            illuminance_lux: sun.illuminance_lux,
            exact: true,
            pixels: sun.pixels,
        })
        .collect()
}

fn mean_luminance(field: &Field, suns: &[VisibleSource]) -> f64 {
    let solid_angle: f64 = field.pixels.iter().map(|pixel| pixel.solid_angle_sr).sum();
    let of_suns: f64 = suns.iter().map(|sun| sun.luminance_cd_m2 * sun.solid_angle_sr).sum();
    field.mean_luminance(|_| true).unwrap_or(0.0) + of_suns / solid_angle
}

/// 95 % confidence interval for an error that Ev and the sources share.
fn interval(ev_lux: f64, sum_of_sources: f64, relative_error: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|side| {
        let scale = (1.0 + side * CONFIDENCE * relative_error).max(0.0);
        daylight_glare_probability(ev_lux * scale, sum_of_sources * scale * scale)
    })
}

fn describe(rule: &str, options: &GlareOptions, has_suns: bool) -> String {
    let mut text = format!("{rule}, one source within {} rad", options.search_angle_rad / 2.0);
    if let Some(peak) = options.peak_cd_m2 {
        text += &format!(", peaks above {peak} cd/m² apart");
    }
    if has_suns {
        text += ", suns by the picture's exact sources";
    }
    text
}

fn warn_about_validity(
    dgp: f64,
    ev_lux: f64,
    coverage: f64,
    options: &GlareOptions,
    warnings: &mut Vec<String>,
) {
    if coverage < WHOLE_COVERAGE && options.ev_lux.is_none() {
        warnings.push(format!(
            "the picture covers {:.0} % of the hemisphere that makes Ev: Ev and DGP are lower bounds; use a fisheye of 180 degrees, or state Ev",
            100.0 * coverage
        ));
    }
    if ev_lux < LOWEST_VALID_EV_LUX {
        warnings.push(format!(
            "Ev of {ev_lux:.0} lx is below {LOWEST_VALID_EV_LUX} lx, where DGP was not fitted; see the low-light corrected value"
        ));
    }
    let [low, high] = VALID_DGP;
    if !(low..=high).contains(&dgp) {
        warnings.push(format!("DGP of {dgp:.3} is outside {low} to {high}, where it was fitted"));
    }
}
