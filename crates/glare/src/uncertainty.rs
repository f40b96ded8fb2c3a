//! How far off the numbers may be: by sampling, and by what goes in.
//!
//! A scene is background, sources and common scale. Each of them is moved by its 95 % half-width to both sides, sources together with what
//! is around them; what that does to a rating is added up in squares, upwards and downwards apart.

use crate::blocks::SamplingError;
use crate::change::{Change, SourceChange};
use crate::detect::Head;
use crate::metrics::{Metrics, Seen};
use crate::options::{GlareOptions, Tolerances};
use crate::report::Source;
use std::f64::consts::PI;
use sunpeak_core::Vec3;

/// Standard deviations of a 95 % confidence interval.
pub(crate) const CONFIDENCE: f64 = 1.96;

/// 95 % intervals of ratings that have a value, by name.
pub type Intervals = Vec<(&'static str, [f64; 2])>;

/// A change of the scene in two directions: what it looks like at the ends of a 95 % interval.
type Move = [Seen; 2];

/// Interval of each rating that the picture's statistical error leaves.
pub(crate) fn sampling(seen: &Seen, error: Option<&SamplingError>, head: &Head) -> Option<Intervals> {
    let mut spread = Spread::around(seen, head.options);
    if let Some(error) = error {
        spread.add(both_ways(|step| with_background(seen, step * error.background_lux)));
        for change in &error.changes {
            spread.add(both_ways(|step| with_change(seen, head, change, step)));
        }
    }
    if head.options.relative_error > 0.0 {
        spread.add(both_ways(|step| scaled(seen, 1.0 + step * head.options.relative_error, |_| true)));
    }
    spread.intervals()
}

/// What so many standard deviations to both sides do.
fn both_ways(moved: impl Fn(f64) -> Seen) -> Move {
    [-CONFIDENCE, CONFIDENCE].map(moved)
}

/// Interval of each rating that the stated tolerances leave.
pub(crate) fn input(seen: &Seen, head: &Head, options: &GlareOptions) -> Option<Intervals> {
    let Tolerances { through, sky, position_deg } = options.tolerances;
    let mut spread = Spread::around(seen, options);
    if through > 0.0 {
        spread.add([-1.0, 1.0].map(|side| scaled(seen, 1.0 + side * through, |source| source.exact)));
    }
    if sky > 0.0 {
        spread.add([-1.0, 1.0].map(|side| scaled(seen, 1.0 + side * sky, |_| true)));
    }
    if position_deg > 0.0 {
        spread.add([-1.0, 1.0].map(|side| turned(seen, head, side * position_deg.to_radians())));
    }
    spread.intervals()
}

/// All ratings of a scene.
fn values(seen: &Seen, options: &GlareOptions) -> Vec<(&'static str, Option<f64>)> {
    // An illuminance that is stated does not move.
    let seen = &Seen { ev_lux: options.ev_lux.unwrap_or(seen.ev_lux), ..seen.clone() };
    let dgp =
        options.dgp_fit.terms(seen.ev_lux, seen.contrast_sum()).dgp() * options.low_light_factor(seen.ev_lux);
    let first = [("dgp", Some(dgp)), ("ev_lux", Some(seen.ev_lux))];
    first.into_iter().chain(Metrics::of(seen).values()).collect()
}

/// What moves have done to each rating.
struct Spread<'a> {
    options: &'a GlareOptions,
    middle: Vec<(&'static str, Option<f64>)>,
    /// Sums of squares, downwards and upwards.
    squares: Vec<[f64; 2]>,
    has_moved: bool,
}

impl<'a> Spread<'a> {
    fn around(seen: &Seen, options: &'a GlareOptions) -> Self {
        let middle = values(seen, options);
        Self { options, squares: vec![[0.0; 2]; middle.len()], middle, has_moved: false }
    }

    fn add(&mut self, ends: Move) {
        self.has_moved = true;
        for end in ends.map(|end| values(&end, self.options)) {
            for ((square, (_, middle)), (_, end)) in self.squares.iter_mut().zip(&self.middle).zip(end) {
                let difference = end.zip(*middle).map(|(end, middle)| end - middle);
                if let Some(difference) = difference.filter(|d| d.is_finite()) {
                    square[usize::from(difference > 0.0)] += difference * difference;
                }
            }
        }
    }

    /// `None` if nothing has moved.
    fn intervals(self) -> Option<Intervals> {
        let interval = |((name, value), [below, above]): ((_, Option<f64>), [f64; 2])| {
            value.map(|value| (name, [value - below.sqrt(), value + above.sqrt()]))
        };
        self.has_moved.then(|| self.middle.into_iter().zip(self.squares).filter_map(interval).collect())
    }
}

/// The background gives so much more light at the eye [lx].
fn with_background(seen: &Seen, more_lux: f64) -> Seen {
    let more = more_lux.max(-seen.indirect_lux());
    Seen {
        ev_lux: seen.ev_lux + more,
        mean_luminance_cd_m2: (seen.mean_luminance_cd_m2 + more / PI).max(0.0),
        surround_luminance_cd_m2: seen
            .surround_luminance_cd_m2
            .map(|luminance| (luminance + more / PI).max(0.0)),
        ..seen.clone()
    }
}

/// Sources and what is around them change by so many standard deviations.
fn with_change(seen: &Seen, head: &Head, change: &Change, step: f64) -> Seen {
    let (mut moved, step) = (seen.clone(), change.possible(step));
    for &(source, change) in &change.sources {
        change_source(&mut moved.sources[source], head, change, step);
    }
    let sum = |of: fn(&Source) -> f64| -> [f64; 2] {
        [seen, &moved].map(|seen| change.sources.iter().map(|&(source, _)| of(&seen.sources[source])).sum())
    };
    let [lux_before, lux] = sum(|source| source.illuminance_lux);
    let [sr_before, sr] = sum(|source| source.solid_angle_sr);
    let [flux_before, flux] = sum(|source| source.luminance_cd_m2 * source.solid_angle_sr);
    moved.ev_sources_lux += lux - lux_before;
    moved.ev_lux = (seen.ev_lux + step * change.illuminance_lux).max(0.0);
    moved.mean_luminance_cd_m2 = (seen.mean_luminance_cd_m2 + step * change.flux / (2.0 * PI)).max(0.0);
    let of_pixels = seen.sources.iter().filter(|source| !source.exact);
    let rest = 2.0 * PI - of_pixels.map(|source| source.solid_angle_sr).sum::<f64>();
    moved.surround_luminance_cd_m2 = seen.surround_luminance_cd_m2.map(|luminance| {
        let flux = luminance * rest + step * change.flux - (flux - flux_before);
        (flux / (rest - (sr - sr_before))).max(0.0)
    });
    moved
}

fn change_source(source: &mut Source, head: &Head, change: SourceChange, step: f64) {
    /// No source loses more than this share of its solid angle or of its light.
    const MOST: f64 = 0.9;
    let before = source.luminance_cd_m2 * source.solid_angle_sr;
    let left = |value: f64, change: f64| (value + step * change).max((1.0 - MOST) * value);
    let flux = left(before, change.flux);
    source.solid_angle_sr = left(source.solid_angle_sr, change.solid_angle_sr);
    source.luminance_cd_m2 = flux / source.solid_angle_sr;
    let aside = step * change.moment;
    source.illuminance_lux = (source.illuminance_lux * flux / before + aside.dot(head.field.sight)).max(0.0);
    move_centre(source, head, aside / before);
}

/// The centre of a source moves by a small vector.
fn move_centre(source: &mut Source, head: &Head, by: Vec3) {
    let direction = (source.direction + by).normalize_or(source.direction);
    *source = head.placed(Source { direction, ..*source });
}

/// Sources that are chosen are so many times as bright; the background too if all are.
fn scaled(seen: &Seen, scale: f64, chosen: fn(&Source) -> bool) -> Seen {
    let all = chosen(&Source::default());
    scaled_where(seen, scale.max(0.0), if all { scale.max(0.0) } else { 1.0 }, chosen)
}

fn scaled_where(seen: &Seen, scale: f64, background: f64, mut chosen: impl FnMut(&Source) -> bool) -> Seen {
    let mut moved = seen.clone();
    let (mut more_lux, mut more_flux) = (0.0, 0.0);
    for source in &mut moved.sources {
        if chosen(source) {
            more_lux += (scale - 1.0) * source.illuminance_lux;
            more_flux += (scale - 1.0) * source.luminance_cd_m2 * source.solid_angle_sr;
            source.luminance_cd_m2 *= scale;
            source.illuminance_lux *= scale;
        }
    }
    let of_sources: f64 = seen.sources.iter().map(|s| s.luminance_cd_m2 * s.solid_angle_sr).sum();
    let background_flux = (seen.mean_luminance_cd_m2 * 2.0 * PI - of_sources).max(0.0);
    moved.ev_sources_lux += more_lux;
    moved.ev_lux += more_lux + (background - 1.0) * seen.indirect_lux();
    moved.mean_luminance_cd_m2 += (more_flux + (background - 1.0) * background_flux) / (2.0 * PI);
    moved.surround_luminance_cd_m2 = seen.surround_luminance_cd_m2.map(|luminance| luminance * background);
    moved
}

/// All sources stand so much further from the line of sight [rad] (nearer, if negative).
fn turned(seen: &Seen, head: &Head, angle: f64) -> Seen {
    let mut moved = seen.clone();
    let sight = head.field.sight;
    for source in &mut moved.sources {
        let aside = source.direction - sight * source.direction.dot(sight);
        let aside = aside.try_normalize().unwrap_or_else(|| sight.any_orthonormal_vector());
        let turned = (source.angle_to_sight_rad + angle).clamp(0.0, PI / 2.0);
        let direction: Vec3 = sight * turned.cos() + aside * turned.sin();
        let illuminance = source.illuminance_lux * turned.cos() / source.angle_to_sight_rad.cos().max(1e-3);
        moved.ev_sources_lux += illuminance - source.illuminance_lux;
        moved.ev_lux += illuminance - source.illuminance_lux;
        *source = Source { direction, illuminance_lux: illuminance, ..*source };
        source.position_index = head.position_index(direction);
        source.angle_to_sight_rad = turned;
    }
    moved
}
