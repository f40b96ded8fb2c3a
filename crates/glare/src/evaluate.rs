//! From a picture to a report.

use crate::BelowSight;
use crate::blocks::{Limits, sampling_error};
use crate::checks;
use crate::class::{ClassVerdict, GlareClass};
use crate::detect::{self, Head};
use crate::dgp::{LOWEST_VALID_EV_LUX, VALID_DGP, low_light_factor};
use crate::exact::{self, VisibleSource};
use crate::field::{Field, FieldPixel};
use crate::metrics::{Metrics, Seen};
use crate::options::GlareOptions;
use crate::report::{GlareReport, Source};
use crate::survey::{Survey, WHOLE_COVERAGE, survey};
use crate::uncertainty::{self, Intervals};
use crate::zones::Zones;
use sunpeak_core::Result;
use sunpeak_scene::Picture;

/// Find glare sources and compute DGP and its siblings.
///
/// Fails if the picture has no view, a view without an eye, or pixels that are not numbers of light.
pub fn evaluate(picture: &Picture, options: &GlareOptions) -> Result<GlareReport> {
    evaluate_with_pixels(picture, options).map(|(report, _)| report)
}

/// The same, and the pixels of each source (indices of the picture; none of exact ones), in the order of the report's.
pub fn evaluate_with_pixels(
    picture: &Picture,
    options: &GlareOptions,
) -> Result<(GlareReport, Vec<Vec<usize>>)> {
    options.check()?;
    let mut warnings = Vec::new();
    let mut field = Field::new(picture)?;
    let suns = exact::take_out(&mut field, &mut warnings);
    let zones = Zones::new(field.sight, options.task_zone());
    let survey = survey(&field, &zones)?;
    let search = Search::new(&field, &survey, &zones, &suns, options)?;
    let pixels: Vec<&[FieldPixel]> = search.found.iter().map(|(_, pixels)| &pixels[..]).collect();
    let seen = seen(search.sources(), &survey, &suns, options);

    let limits = Limits { threshold_cd_m2: search.threshold_cd_m2, peak_cd_m2: options.peak_cd_m2 };
    let error = sampling_error(&field, &limits, &search.found)?;
    let head = Head { field: &field, options };
    let sampling = uncertainty::sampling(&seen, error.as_ref(), &head);
    let input = uncertainty::input(&seen, &head, options);
    let terms = options.dgp_fit.terms(seen.ev_lux, seen.contrast_sum());
    let dgp = terms.dgp() * options.low_light_factor(seen.ev_lux);
    let [of_sampling, of_input] = [&sampling, &input].map(|intervals| dgp_interval(dgp, intervals.as_ref()));
    warnings.extend(checks::warnings(&field, &seen.sources, seen.ev_lux, options.ev_lux.is_some()));
    warn_about_validity(terms.dgp(), seen.ev_lux, survey.coverage, options, &mut warnings);

    let indices = pixels.iter().map(|pixels| pixels.iter().map(|pixel| pixel.index).collect()).collect();
    let report = GlareReport {
        dgp,
        dgp_interval: of_sampling,
        verdict: ClassVerdict::of(dgp, half_widths(dgp, [of_sampling, of_input])),
        sampling,
        input,
        dgp_low_light_corrected: terms.dgp() * low_light_factor(seen.ev_lux),
        dgp_terms: terms,
        dgp_in_range: is_in_range(terms.dgp(), seen.ev_lux),
        metrics: Metrics::of(&seen),
        class: GlareClass::of(dgp),
        ev_lux: seen.ev_lux,
        ev_sources_lux: seen.ev_sources_lux,
        threshold_cd_m2: search.threshold_cd_m2,
        rule: describe(&search.rule, options, !suns.is_empty()),
        mean_luminance_cd_m2: seen.mean_luminance_cd_m2,
        median_luminance_cd_m2: survey.median_luminance,
        zones: zones.luminances(&survey, &suns),
        max_luminance_cd_m2: suns.iter().map(|sun| sun.luminance_cd_m2).fold(survey.max_luminance, f64::max),
        background_cd_m2: seen.background_cd_m2(),
        sources: with_parts(seen.sources, terms.contrast),
        warnings,
    };
    Ok((report, indices))
}

/// What was looked for, and what was found.
struct Search {
    threshold_cd_m2: f64,
    /// The threshold in words.
    rule: String,
    /// Sources and their pixels, the worst first; exact ones have none.
    found: Vec<(Source, Vec<FieldPixel>)>,
}

impl Search {
    fn new(
        field: &Field,
        survey: &Survey,
        zones: &Zones,
        suns: &[VisibleSource],
        options: &GlareOptions,
    ) -> Result<Self> {
        let mean = survey.whole.luminance().unwrap_or(0.0);
        let (threshold_cd_m2, rule) = detect::threshold(options, mean, &zones.luminances(survey, &[]))?;
        let mut found = detect::sources(field, threshold_cd_m2, options)?;
        let exact = glaring_suns(&Head { field, options }, suns, threshold_cd_m2);
        found.extend(exact.into_iter().map(|sun| (sun, Vec::new())));
        found.sort_by(|(a, _), (b, _)| b.weight().total_cmp(&a.weight()));
        Ok(Self { threshold_cd_m2, rule, found })
    }

    fn sources(&self) -> Vec<Source> {
        self.found.iter().map(|(source, _)| *source).collect()
    }
}

/// Exact sources above the threshold, as glare sources.
fn glaring_suns(head: &Head, suns: &[VisibleSource], threshold: f64) -> Vec<Source> {
    let source = |sun: &VisibleSource| Source {
        direction: sun.direction,
        solid_angle_sr: sun.solid_angle_sr,
        luminance_cd_m2: sun.luminance_cd_m2,
        illuminance_lux: sun.illuminance_lux,
        exact: true,
        pixels: sun.pixels,
        ..Source::default()
    };
    let glares = |sun: &&VisibleSource| sun.luminance_cd_m2 > threshold;
    suns.iter().filter(glares).map(|sun| head.placed(source(sun))).collect()
}

/// What the equations need.
fn seen(sources: Vec<Source>, survey: &Survey, suns: &[VisibleSource], options: &GlareOptions) -> Seen {
    let of_suns: f64 = suns.iter().map(|sun| sun.illuminance_lux).sum();
    let flux_of_suns: f64 = suns.iter().map(|sun| sun.luminance_cd_m2 * sun.solid_angle_sr).sum();
    let flux: f64 = sources.iter().map(|s| s.luminance_cd_m2 * s.solid_angle_sr).sum();
    let of_sources: f64 = sources.iter().filter(|s| !s.exact).map(|s| s.solid_angle_sr).sum();
    let whole = survey.whole.solid_angle_sr;
    let all_flux = survey.whole.flux + flux_of_suns;
    let rest = whole - of_sources;
    Seen {
        ev_lux: options.ev_lux.unwrap_or(survey.illuminance_lux + of_suns),
        ev_sources_lux: sources.iter().map(|source| source.illuminance_lux).sum(),
        mean_luminance_cd_m2: all_flux / whole,
        surround_luminance_cd_m2: (rest > 1e-9 * whole).then(|| (all_flux - flux).max(0.0) / rest),
        source_distance_m: options.source_distance_m,
        sources,
    }
}

/// Give each source its share of the contrast term.
fn with_parts(sources: Vec<Source>, contrast: f64) -> Vec<Source> {
    let sum: f64 = sources.iter().map(Source::weight).sum();
    sources
        .into_iter()
        .map(|source| Source { dgp_part: contrast * source.weight() / sum, ..source })
        .collect()
}

/// Interval of DGP, within 0 and 1; DGP twice if there is none.
fn dgp_interval(dgp: f64, intervals: Option<&Intervals>) -> [f64; 2] {
    let found = intervals.and_then(|all| all.iter().find(|(name, _)| *name == "dgp"));
    found.map_or([dgp; 2], |(_, ends)| ends.map(|end| end.clamp(0.0, 1.0)))
}

/// Half-widths downwards and upwards of independent intervals together.
fn half_widths(middle: f64, intervals: [[f64; 2]; 2]) -> [f64; 2] {
    let half = |end: usize| intervals.iter().map(|ends| (ends[end] - middle).powi(2)).sum::<f64>().sqrt();
    [half(0), half(1)]
}

fn describe(rule: &str, options: &GlareOptions, has_suns: bool) -> String {
    let mut text = format!("{rule}, one source within {} rad", options.search_angle_rad / 2.0);
    if let Some(peak) = options.peak_cd_m2 {
        text += &format!(", pixels above {peak} cd/m² split off");
    }
    if has_suns {
        text += ", suns by the picture's exact sources";
    }
    text += match options.below_sight {
        BelowSight::Evalglare3 => ", position index below the line of sight as evalglare 3",
        BelowSight::IwataOsterhaus => ", position index below the line of sight as at the side",
        BelowSight::IwataTokura => ", position index below the line of sight by Iwata and Tokura",
    };
    if let Some(least) = options.least_solid_angle_sr {
        text += &format!(", none smaller than {least} sr");
    }
    text
}

fn is_in_range(dgp: f64, ev_lux: f64) -> bool {
    let [low, high] = VALID_DGP;
    ev_lux >= LOWEST_VALID_EV_LUX && (low..=high).contains(&dgp)
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
