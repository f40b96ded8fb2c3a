//! One round source before a uniform background: every rating is known from its published equation alone.
#![allow(clippy::unwrap_used)] // a helper that fails fails the test

use std::f64::consts::PI;
use sunpeak_core::{Vec3, cone_solid_angle, gray};
use sunpeak_glare::{BelowSight, GlareOptions, GlareReport, SourceCentre, evaluate, position_index};
use sunpeak_scene::{Camera, ExactSource, Picture, View, ViewKind, disc_coverage};

const KINDS: [ViewKind; 3] =
    [ViewKind::AngularFisheye, ViewKind::HemisphericalFisheye, ViewKind::PlanisphericFisheye];
const BACKGROUND: f64 = 200.0;
/// How far off a rating may be, relative to its value.
const TOLERANCE: f64 = 1e-3;

fn view(kind: ViewKind) -> View {
    View {
        kind,
        direction: Vec3::Y,
        up: Vec3::Z,
        horizontal_deg: 180.0,
        vertical_deg: 180.0,
        ..View::default()
    }
}

fn picture(kind: ViewKind, size: usize, luminance: impl Fn(Vec3) -> f64) -> Picture {
    let view = view(kind);
    let camera = Camera::new(&view).unwrap();
    let value = |index: usize| {
        let pixel = camera.pixel_ahead(index % size, index / size, size, size);
        [(pixel.map_or(0.0, |pixel| luminance(pixel.direction)) / 179.0) as f32; 3]
    };
    let pixels = (0..size * size).map(value).collect();
    Picture { pixels, view: Some(view), ..Picture::new(size, size) }
}

fn towards(right_deg: f64, up_deg: f64) -> Vec3 {
    let (right, up) = (right_deg.to_radians(), up_deg.to_radians());
    Vec3::new(right.sin() * up.cos(), right.cos() * up.cos(), up.sin())
}

/// Of a cone that lies all in front.
struct Disc {
    direction: Vec3,
    radius_rad: f64,
    luminance: f64,
}

/// The published equations, written out for one source.
fn ratings(disc: &Disc) -> Vec<(&'static str, f64)> {
    let l = disc.luminance;
    let omega = 2.0 * PI * (1.0 - disc.radius_rad.cos());
    let projected = PI * disc.radius_rad.sin().powi(2) * disc.direction.y;
    let direct = l * projected;
    let ev = direct + BACKGROUND * (PI - projected);
    let lb = (ev - direct) / PI;
    let mean = BACKGROUND + (l - BACKGROUND) * omega / (2.0 * PI);
    let p = position_index(disc.direction, Vec3::Y, Vec3::Z, BelowSight::default());
    let theta = disc.direction.y.acos().to_degrees().max(1.0);
    let contrast = l * l * omega / (p * p);
    let q = 20.4 * omega + 1.52 * omega.powf(0.2) - 0.075;
    let daylight = |adaptation: f64| {
        let seen = (omega / (p * p)).powf(0.8);
        10.0 * (0.478 * l.powf(1.6) * seen / (adaptation + 0.07 * omega.sqrt() * l)).log10()
    };
    vec![
        ("dgp", 5.87e-5 * ev + 9.18e-2 * (1.0 + contrast / ev.powf(1.87)).log10() + 0.16),
        ("ev", ev),
        ("mean", mean),
        ("median", BACKGROUND),
        ("max", l),
        ("dgps", 6.22e-5 * ev + 0.184),
        ("dgi", daylight(lb)),
        ("dgi_modified", daylight((ev / PI).powf(0.85))),
        ("ugr", 8.0 * (0.25 / lb * contrast).log10()),
        ("ugp", 0.26 * (0.25 / lb * contrast).log10()),
        ("ugp_2017", (1.0 + 2.0 / 7.0 * (contrast / lb).powf(-0.2)).powi(-10)),
        ("cgi", 8.0 * (2.0 * (1.0 + direct / 500.0) / ev * contrast).log10()),
        ("dgr", 0.5 * l * q / (p * mean.powf(0.44))),
        (
            "pgsv",
            3.2 * l.log10() - 0.64 * omega.log10() - (0.61 - 0.79 * omega.log10()) * BACKGROUND.log10() - 8.2,
        ),
        ("pgsv_saturation", 3.3 - 3.87 / (1.0 + (ev / PI / 1250.0).powf(1.7))),
        ("veiling_luminance_cd_m2", 10.0 * direct / (theta * theta)),
    ]
}

fn found(report: &GlareReport, name: &str) -> f64 {
    let metrics = report.metrics.values();
    match name {
        "dgp" => report.dgp,
        "ev" => report.ev_lux,
        "mean" => report.mean_luminance_cd_m2,
        "median" => report.median_luminance_cd_m2,
        "max" => report.max_luminance_cd_m2,
        _ => metrics.iter().find(|(known, _)| *known == name).and_then(|(_, value)| *value).unwrap(),
    }
}

fn compare(disc: &Disc, scene: &Picture, centre: SourceCentre, case: &str) {
    let report = evaluate(scene, &GlareOptions { centre, ..GlareOptions::default() }).unwrap();
    assert_eq!(report.sources.len(), 1, "{case}: {:?}", report.sources);
    for (name, expected) in ratings(disc) {
        let value = found(&report, name);
        // Votes may be 0.
        let scale = if name.starts_with("pgsv") { expected.abs().max(1.0) } else { expected };
        assert!(
            (value - expected).abs() < TOLERANCE * scale,
            "{case}: {name} is {value}, expected {expected}"
        );
    }
    let parts: f64 = report.sources.iter().map(|source| source.dgp_part).sum();
    let terms = report.dgp_terms;
    assert!((terms.contrast - parts).abs() < 1e-12);
    assert!((terms.offset + terms.illuminance + terms.contrast - report.dgp).abs() < 1e-12);
}

/// A sun whose disc the picture knows: anywhere, however few pixels.
#[test]
fn an_exact_sun_anywhere() {
    let radius_rad = 0.2665_f64.to_radians();
    let solid_angle_sr = cone_solid_angle(0.533);
    for kind in KINDS {
        for size in [150, 400, 800] {
            for (right, up) in
                [(0.0, 0.0), (25.0, 15.0), (-50.0, -30.0), (75.0, 5.0), (10.0, 50.0), (-5.0, -70.0)]
            {
                let disc = Disc { direction: towards(right, up), radius_rad, luminance: 3e6 };
                let mut scene = picture(kind, size, |_| BACKGROUND);
                let radiance = gray(disc.luminance / 179.0);
                let view = scene.view.clone().unwrap();
                for (index, share) in disc_coverage(&view, size, size, disc.direction, solid_angle_sr) {
                    scene.pixels[index] = scene.pixels[index].map(|v| v + (radiance.x * share) as f32);
                }
                scene.exact_sources.push(ExactSource {
                    direction: disc.direction,
                    solid_angle_sr,
                    radiance,
                    visible_fraction: 1.0,
                });
                compare(&disc, &scene, SourceCentre::default(), &format!("{kind:?} {size} {right} {up}"));
            }
        }
    }
}

/// A disc of pixels, of enough of them that its ragged edge counts for less than the tolerance. Its middle is the mean
/// direction of its light; the default, which is evalglare's, is off by some hundredths of a degree.
#[test]
fn a_disc_of_pixels_anywhere() {
    let radius_rad = 14.0_f64.to_radians();
    for kind in KINDS {
        for (size, right, up) in [(1200, 12.0, 15.0), (1600, -45.0, -30.0), (2000, 50.0, 10.0)] {
            let disc = Disc { direction: towards(right, up), radius_rad, luminance: 9000.0 };
            let inside = radius_rad.cos();
            let scene =
                picture(
                    kind,
                    size,
                    |d| {
                        if d.dot(disc.direction) > inside { disc.luminance } else { BACKGROUND }
                    },
                );
            compare(&disc, &scene, SourceCentre::Sphere, &format!("{kind:?} {size} {right} {up}"));
        }
    }
}
