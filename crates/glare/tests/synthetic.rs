//! Pictures whose glare is known in closed form.
#![allow(clippy::unwrap_used)] // a helper that fails fails the test

use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3, cone_solid_angle, gray};
use sunpeak_glare::{
    BelowSight, GlareClass, GlareOptions, GlareReport, TaskZone, Threshold, daylight_glare_probability,
    evaluate, position_index,
};
use sunpeak_scene::{ExactSource, Picture, View, ViewKind, disc_coverage};

const SUN_DEG: f64 = 0.533;

fn view(kind: ViewKind, angle_deg: f64) -> View {
    View {
        kind,
        position: Vec3::ZERO,
        direction: Vec3::Y,
        up: Vec3::Z,
        horizontal_deg: angle_deg,
        vertical_deg: angle_deg,
        fore: 0.0,
        aft: 0.0,
        shift: 0.0,
        lift: 0.0,
    }
}

/// A picture in which every pixel has the luminance [cd/m²] that its direction says.
fn picture(view: View, size: usize, luminance: impl Fn(Vec3) -> f64) -> Picture {
    let value = |index: usize| {
        let x = ((index % size) as f64 + 0.5) / size as f64;
        let y = 1.0 - ((index / size) as f64 + 0.5) / size as f64;
        let luminance = view.ray(x, y).map_or(0.0, |ray| luminance(ray.direction));
        [(luminance / 179.0) as f32; 3]
    };
    let pixels = (0..size * size).map(value).collect();
    Picture { pixels, view: Some(view), ..Picture::new(size, size) }
}

fn fisheye(size: usize, luminance: impl Fn(Vec3) -> f64) -> Picture {
    picture(view(ViewKind::AngularFisheye, 180.0), size, luminance)
}

fn towards(right_deg: f64, up_deg: f64) -> Vec3 {
    let (right, up) = (right_deg.to_radians(), up_deg.to_radians());
    Vec3::new(right.sin() * up.cos(), right.cos() * up.cos(), up.sin())
}

fn report(picture: &Picture) -> GlareReport {
    evaluate(picture, &GlareOptions::default()).unwrap()
}

/// Add a sun to the pixels as a renderer does, and to the list.
fn add_sun(picture: &mut Picture, direction: Vec3, radiance: Rgb, visible_fraction: f64) {
    let solid_angle_sr = cone_solid_angle(SUN_DEG);
    let view = picture.view.clone().unwrap();
    for (index, share) in disc_coverage(&view, picture.width, picture.height, direction, solid_angle_sr) {
        for (value, radiance) in picture.pixels[index].iter_mut().zip(radiance.to_array()) {
            *value += (radiance * visible_fraction * share) as f32;
        }
    }
    picture.exact_sources.push(ExactSource { direction, solid_angle_sr, radiance, visible_fraction });
}

/// Round to the eight-bit mantissa of a Radiance picture on disk.
fn quantise(picture: &mut Picture) {
    for pixel in &mut picture.pixels {
        let largest = pixel.iter().fold(0.0_f32, |a, &b| a.max(b));
        if largest > 0.0 {
            let step = 2.0_f32.powi(largest.log2().floor() as i32 + 1 - 8);
            *pixel = pixel.map(|value| ((value / step).floor() + 0.5) * step);
        }
    }
}

#[test]
fn uniform_luminance_gives_pi_times_itself() {
    for kind in [ViewKind::AngularFisheye, ViewKind::HemisphericalFisheye] {
        for luminance in [50.0, 900.0] {
            let found = report(&picture(view(kind, 180.0), 300, |_| luminance));
            assert!((found.ev_lux / (PI * luminance) - 1.0).abs() < 2e-3, "{kind:?} {}", found.ev_lux);
            assert!((found.mean_luminance_cd_m2 / luminance - 1.0).abs() < 1e-6);
            assert!(found.sources.is_empty());
            assert!((found.dgp - daylight_glare_probability(found.ev_lux, 0.0)).abs() < 1e-12);
        }
    }
}

#[test]
fn one_disc_by_hand() {
    let (centre, radius) = (towards(25.0, 15.0), 6.0_f64.to_radians());
    let found = report(&fisheye(800, |d| if d.angle_between(centre) < radius { 8000.0 } else { 200.0 }));
    let solid_angle = 2.0 * PI * (1.0 - radius.cos());
    let ev = 200.0 * PI + 7800.0 * PI * radius.sin().powi(2) * centre.y;
    let index = position_index(centre, Vec3::Y, Vec3::Z, BelowSight::default());
    let dgp = daylight_glare_probability(ev, 8000.0_f64.powi(2) * solid_angle / index.powi(2));

    let [source] = found.sources[..] else { panic!("{:?}", found.sources) };
    assert!((found.ev_lux / ev - 1.0).abs() < 2e-3, "{} {ev}", found.ev_lux);
    assert!((source.solid_angle_sr / solid_angle - 1.0).abs() < 5e-3);
    assert!((source.luminance_cd_m2 / 8000.0 - 1.0).abs() < 1e-6);
    assert!(source.direction.angle_between(centre).to_degrees() < 0.1);
    assert!((found.dgp - dgp).abs() < 5e-4, "{} {dgp}", found.dgp);
    assert_eq!(found.class, GlareClass::of(dgp));
    assert!((found.background_cd_m2 / 200.0 - 1.0).abs() < 0.02);
}

#[test]
fn peaks_are_apart_from_what_is_around_them() {
    let centre = towards(-20.0, 10.0);
    let glow = |d: Vec3| match d.angle_between(centre).to_degrees() {
        a if a < 1.0 => 80_000.0,
        a if a < 8.0 => 6000.0,
        _ => 100.0,
    };
    let found = report(&fisheye(600, glow));
    let luminances: Vec<_> = found.sources.iter().map(|s| s.luminance_cd_m2.round()).collect();
    assert_eq!(luminances, [80_000.0, 6000.0]);
    let whole =
        evaluate(&fisheye(600, glow), &GlareOptions { peak_cd_m2: None, ..GlareOptions::default() }).unwrap();
    assert_eq!(whole.sources.len(), 1);
    assert!(whole.dgp < found.dgp);
}

#[test]
fn thresholds_by_mean_and_by_task() {
    let lamp = towards(0.0, 30.0);
    let scene = fisheye(400, |d| if d.angle_between(lamp) < 0.1 { 1500.0 } else { 100.0 });
    assert!(report(&scene).sources.is_empty());
    let zone = TaskZone { direction: towards(0.0, -10.0), opening_angle_rad: 0.5 };
    for (threshold, expected) in
        [(Threshold::TimesTask(5.0, zone), 500.0), (Threshold::TimesMean(5.0), 535.0)]
    {
        let options = GlareOptions { threshold, ..GlareOptions::default() };
        let found = evaluate(&scene, &options).unwrap();
        assert!((found.threshold_cd_m2 / expected - 1.0).abs() < 0.01, "{}", found.threshold_cd_m2);
        assert_eq!(found.sources.len(), 1, "{}", found.rule);
    }
}

#[test]
fn a_sun_counts_the_same_however_the_pixels_lie() {
    let direction = towards(31.0, 22.0);
    let radiance = gray(6e4);
    let luminance = 179.0 * 6e4;
    let solid_angle = cone_solid_angle(SUN_DEG);
    let ev = 300.0 * PI + luminance * solid_angle * direction.y;
    let index = position_index(direction, Vec3::Y, Vec3::Z, BelowSight::default());
    let dgp = daylight_glare_probability(ev, luminance.powi(2) * solid_angle / index.powi(2));
    for size in [150, 400, 801] {
        for on_disk in [false, true] {
            let mut scene = fisheye(size, |_| 300.0);
            add_sun(&mut scene, direction, radiance, 1.0);
            if on_disk {
                quantise(&mut scene);
            }
            let found = report(&scene);
            let [source] = found.sources[..] else { panic!("{:?}", found.sources) };
            assert!(source.exact && (source.luminance_cd_m2 / luminance - 1.0).abs() < 1e-9);
            assert!((found.ev_lux / ev - 1.0).abs() < 1e-3, "{size} {on_disk}: {} {ev}", found.ev_lux);
            assert!((found.dgp - dgp).abs() < 1e-3, "{size} {on_disk}: {} {dgp}", found.dgp);
            assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        }
    }
}

#[test]
fn suns_may_overlap_be_half_hidden_and_stand_at_the_edge() {
    let mut scene = fisheye(500, |_| 300.0);
    add_sun(&mut scene, towards(10.0, 20.0), gray(4e5), 0.5);
    add_sun(&mut scene, towards(10.2, 20.1), Rgb::new(3e5, 2e5, 1e5), 1.0);
    add_sun(&mut scene, towards(-40.0, 12.0), Rgb::new(1e6, 1e3, 1e3), 1.0);
    add_sun(&mut scene, Vec3::X, gray(4e5), 1.0);
    quantise(&mut scene);
    let found = report(&scene);
    assert_eq!(found.sources.iter().filter(|s| s.exact).count(), 4);
    assert_eq!(found.sources.len(), 4, "{:?}", found.sources);
    let solid_angle = cone_solid_angle(SUN_DEG);
    let at_edge = found.sources.iter().find(|s| s.direction.distance(Vec3::X) < 1e-6).unwrap();
    assert!((at_edge.solid_angle_sr / solid_angle - 0.5).abs() < 0.1, "{at_edge:?}");
    let half = found.sources.iter().find(|s| s.direction.distance(towards(10.0, 20.0)) < 1e-6).unwrap();
    assert!((half.solid_angle_sr / solid_angle - 0.5).abs() < 1e-9);
    let colored = 179.0 * (0.265 * 3e5 + 0.670 * 2e5 + 0.065 * 1e5);
    let red = 179.0 * (0.265 * 1e6 + 0.735 * 1e3);
    let overlapping = 0.5 * 179.0 * 4e5 * towards(10.0, 20.0).y + colored * towards(10.2, 20.1).y;
    let suns = solid_angle * (overlapping + red * towards(-40.0, 12.0).y);
    let ev = 300.0 * PI + suns + at_edge.illuminance_lux;
    assert!((found.ev_lux / ev - 1.0).abs() < 1e-3, "{} {ev}", found.ev_lux);
}

#[test]
fn a_changed_or_foreign_sun_is_noted() {
    let mut scene = fisheye(200, |_| 300.0);
    add_sun(&mut scene, towards(10.0, 20.0), gray(4e5), 1.0);
    scene.exact_sources[0].radiance = gray(9e5);
    assert!(report(&scene).warnings.iter().any(|w| w.contains("do not hold")));
    scene.exact_sources[0].radiance = Rgb::splat(f64::NAN);
    assert!(report(&scene).dgp.is_finite());
    scene.exact_sources[0].radiance = gray(4e5);
    scene.exact_sources[0].direction = -Vec3::Y;
    assert!(report(&scene).warnings.iter().any(|w| w.contains("outside the picture")));
}

/// A picture that was filtered since: the sun's light stands in other shares in its pixels, and in pixels beside them.
#[test]
fn a_blurred_sun_counts_once() {
    let size = 400;
    let mut scene = fisheye(size, |_| 300.0);
    add_sun(&mut scene, towards(31.0, 22.0), gray(6e4), 1.0);
    let sharp = report(&scene);
    let original = scene.pixels.clone();
    for i in size + 1..size * (size - 1) - 1 {
        let around =
            [i - size - 1, i - size, i - size + 1, i - 1, i, i + 1, i + size - 1, i + size, i + size + 1];
        scene.pixels[i] = [around.map(|j| original[j][0]).iter().sum::<f32>() / 9.0; 3];
    }
    let blurred = report(&scene);
    assert!(blurred.warnings.iter().any(|w| w.contains("do not hold")));
    assert_eq!(blurred.sources.len(), 1, "{:?}", blurred.sources);
    assert!((blurred.ev_lux / sharp.ev_lux - 1.0).abs() < 2e-3, "{} {}", blurred.ev_lux, sharp.ev_lux);
    assert!((blurred.dgp - sharp.dgp).abs() < 1e-3);
}

#[test]
fn narrow_views_and_dim_scenes_are_warned_of() {
    let narrow = picture(view(ViewKind::Perspective, 60.0), 100, |_| 1000.0);
    let found = report(&narrow);
    assert!(found.warnings.iter().any(|w| w.contains("lower bounds")), "{:?}", found.warnings);
    let stated =
        evaluate(&narrow, &GlareOptions { ev_lux: Some(3000.0), ..GlareOptions::default() }).unwrap();
    assert_eq!(stated.ev_lux, 3000.0);
    assert!(stated.warnings.is_empty(), "{:?}", stated.warnings);

    let dim = fisheye(100, |_| 30.0);
    let found = report(&dim);
    assert!(found.warnings.iter().any(|w| w.contains("380")));
    assert!(found.dgp_low_light_corrected < 0.3 * found.dgp);
    let corrected = evaluate(&dim, &GlareOptions { low_light: true, ..GlareOptions::default() }).unwrap();
    assert_eq!(corrected.dgp, found.dgp_low_light_corrected);
}

#[test]
fn the_interval_holds_what_the_error_would_do() {
    let scene = fisheye(200, |d| if d.angle_between(Vec3::Y) < 0.2 { 9000.0 } else { 800.0 });
    assert_eq!(report(&scene).dgp_interval, [report(&scene).dgp; 2]);
    let found = evaluate(&scene, &GlareOptions { relative_error: 0.02, ..GlareOptions::default() }).unwrap();
    let [low, high] = found.dgp_interval;
    let brighter =
        report(&fisheye(200, |d| 1.0392 * if d.angle_between(Vec3::Y) < 0.2 { 9000.0 } else { 800.0 }));
    assert!(low < found.dgp && found.dgp < high);
    assert!((high - brighter.dgp).abs() < 1e-6, "{high} {}", brighter.dgp);
}

#[test]
fn pictures_that_cannot_be_judged_are_refused_by_name() {
    let good = fisheye(50, |_| 100.0);
    let refused = |picture: &Picture, expected: &str| {
        let message = evaluate(picture, &GlareOptions::default()).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    for bad in [f32::NAN, f32::INFINITY, -5.0] {
        let mut picture = good.clone();
        picture.pixels[50 * 20 + 30] = [bad; 3];
        refused(&picture, "column 30, row 20");
    }
    refused(&Picture { view: None, ..good.clone() }, "VIEW=");
    refused(&Picture { view: Some(view(ViewKind::Parallel, 10.0)), ..good.clone() }, "-vtl");
    refused(&Picture { pixels: Vec::new(), ..good.clone() }, "50 x 50");
    let options = GlareOptions { search_angle_rad: f64::NAN, ..GlareOptions::default() };
    assert!(evaluate(&good, &options).unwrap_err().to_string().contains("search angle"));
}
