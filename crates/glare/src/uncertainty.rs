//! How far off the numbers may be: by sampling, and by what goes in.
//!
//! A scene is background, sources and common scale. Each of them is moved by its 95 % half-width to both sides; what that does to a
//! rating is added up in squares, upwards and downwards apart.

use crate::blocks::{Edge, SamplingError};
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
pub(crate) fn sampling(
    seen: &Seen,
    error: Option<&SamplingError>,
    options: &GlareOptions,
) -> Option<Intervals> {
    let mut moves = Vec::new();
    if let Some(error) = error {
        moves.push([-1.0, 1.0].map(|side| with_background(seen, side * CONFIDENCE * error.background_lux)));
        for (i, &flux) in error.source_flux.iter().enumerate().filter(|(_, flux)| **flux > 0.0) {
            moves.push([-1.0, 1.0].map(|side| with_source(seen, i, side * CONFIDENCE * flux)));
        }
        for edge in &error.edges {
            moves
                .push([-1.0, 1.0].map(|side| with_edge(seen, edge, side * CONFIDENCE * edge.solid_angle_sr)));
        }
    }
    if options.relative_error > 0.0 {
        let step = CONFIDENCE * options.relative_error;
        moves.push([-1.0, 1.0].map(|side| scaled(seen, 1.0 + side * step, |_| true)));
    }
    (!moves.is_empty()).then(|| spread(seen, &moves, options))
}

/// Interval of each rating that the stated tolerances leave.
pub(crate) fn input(seen: &Seen, head: &Head, options: &GlareOptions) -> Option<Intervals> {
    let Tolerances { through, sky, position_deg } = options.tolerances;
    let mut moves = Vec::new();
    if through > 0.0 {
        moves.push([-1.0, 1.0].map(|side| scaled(seen, 1.0 + side * through, |source| source.exact)));
    }
    if sky > 0.0 {
        moves.push([-1.0, 1.0].map(|side| scaled(seen, 1.0 + side * sky, |_| true)));
    }
    if position_deg > 0.0 {
        moves.push([-1.0, 1.0].map(|side| turned(seen, head, side * position_deg.to_radians())));
    }
    (!moves.is_empty()).then(|| spread(seen, &moves, options))
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

fn spread(seen: &Seen, moves: &[Move], options: &GlareOptions) -> Intervals {
    let middle = values(seen, options);
    let mut squares = vec![[0.0; 2]; middle.len()];
    for ends in moves {
        let [one, other] = ends.each_ref().map(|end| values(end, options));
        for (i, square) in squares.iter_mut().enumerate() {
            let differences = [one[i].1, other[i].1].map(|end| Some(end? - middle[i].1?));
            for difference in differences.into_iter().flatten().filter(|d| d.is_finite()) {
                let side = usize::from(difference > 0.0);
                square[side] += difference * difference;
            }
        }
    }
    let interval = |(&(name, value), [below, above]): (&(&'static str, Option<f64>), [f64; 2])| {
        value.map(|value| (name, [value - below.sqrt(), value + above.sqrt()]))
    };
    middle.iter().zip(squares).filter_map(interval).collect()
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

/// A source has so much more luminance times solid angle.
fn with_source(seen: &Seen, source: usize, more_flux: f64) -> Seen {
    let flux = seen.sources[source].luminance_cd_m2 * seen.sources[source].solid_angle_sr;
    let scale = (1.0 + more_flux / flux).max(0.0);
    let mut place = 0;
    scaled_where(seen, scale, 1.0, |_| {
        place += 1;
        place == source + 1
    })
}

/// A source has so much more solid angle of pixels at its threshold, taken from the background or from the source around it.
fn with_edge(seen: &Seen, edge: &Edge, more_sr: f64) -> Seen {
    /// No source loses more than this share of its solid angle.
    const MOST: f64 = 0.9;
    let mut moved = seen.clone();
    let least = -MOST * seen.sources[edge.source].solid_angle_sr;
    let most = edge.otherwise.map_or(f64::INFINITY, |other| MOST * seen.sources[other].solid_angle_sr);
    let more = more_sr.max(least).min(most);
    let gained = with_pixels(&mut moved.sources[edge.source], more, edge.threshold_cd_m2);
    let lost =
        edge.otherwise.map(|other| with_pixels(&mut moved.sources[other], -more, edge.threshold_cd_m2));
    moved.ev_sources_lux += gained + lost.unwrap_or(0.0);
    moved
}

/// Give a source so much more solid angle of a luminance; how much more illuminance that is [lx].
fn with_pixels(source: &mut Source, more_sr: f64, luminance_cd_m2: f64) -> f64 {
    let flux = (source.luminance_cd_m2 * source.solid_angle_sr + more_sr * luminance_cd_m2).max(0.0);
    let illuminance = more_sr * luminance_cd_m2 * source.angle_to_sight_rad.cos();
    source.solid_angle_sr += more_sr;
    source.luminance_cd_m2 = flux / source.solid_angle_sr;
    source.illuminance_lux += illuminance;
    illuminance
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
