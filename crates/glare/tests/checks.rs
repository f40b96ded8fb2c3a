//! Pictures with what users get wrong, and the warning that each must bring.
#![allow(clippy::unwrap_used)] // a helper that fails fails the test

use sunpeak_core::Vec3;
use sunpeak_glare::{GlareOptions, evaluate};
use sunpeak_scene::{Camera, Picture, View, ViewKind};

fn picture(kind: ViewKind, angle_deg: f64, size: usize, luminance: impl Fn(Vec3) -> f64) -> Picture {
    let view = View {
        kind,
        direction: Vec3::Y,
        up: Vec3::Z,
        horizontal_deg: angle_deg,
        vertical_deg: angle_deg,
        ..View::default()
    };
    let camera = Camera::new(&view).unwrap();
    let value = |index: usize| {
        let pixel = camera.pixel_ahead(index % size, index / size, size, size);
        [(pixel.map_or(0.0, |pixel| luminance(pixel.direction)) / 179.0) as f32; 3]
    };
    let pixels = (0..size * size).map(value).collect();
    Picture { pixels, view: Some(view), ..Picture::new(size, size) }
}

fn fisheye(size: usize, luminance: impl Fn(Vec3) -> f64) -> Picture {
    picture(ViewKind::AngularFisheye, 180.0, size, luminance)
}

fn off_sight_deg(direction: Vec3) -> f64 {
    direction.angle_between(Vec3::Y).to_degrees()
}

fn warnings(picture: &Picture) -> Vec<String> {
    evaluate(picture, &GlareOptions::default()).unwrap().warnings
}

fn assert_warned(picture: &Picture, expected: &str) {
    let found = warnings(picture);
    assert!(found.iter().any(|warning| warning.contains(expected)), "{expected}: {found:?}");
}

#[test]
fn a_sound_picture_brings_none() {
    for kind in [ViewKind::AngularFisheye, ViewKind::HemisphericalFisheye] {
        assert_eq!(warnings(&picture(kind, 180.0, 200, |_| 400.0)), [""; 0]);
    }
}

#[test]
fn views_that_are_no_fisheye_of_180_degrees() {
    assert_warned(&picture(ViewKind::Perspective, 90.0, 100, |_| 400.0), "not a fisheye");
    assert_warned(&picture(ViewKind::AngularFisheye, 150.0, 100, |_| 400.0), "lower bounds");
}

#[test]
fn exposures_lost_and_doubled() {
    let mut dark = fisheye(100, |_| 0.4);
    assert_warned(&dark, "no EXPOSURE line");
    dark.exposures = vec![0.5];
    assert_warned(&dark, "night scene");
    let mut doubled = fisheye(100, |_| 400.0);
    doubled.exposures = vec![0.25, 0.25];
    assert_warned(&doubled, "2 EXPOSURE lines");
    assert_warned(&fisheye(100, |_| 4e9), "brighter than the sun");
}

#[test]
fn a_sun_in_a_small_picture() {
    let sun = |d: Vec3| if off_sight_deg(d) < 1.0 { 1e8 } else { 400.0 };
    assert_warned(&fisheye(400, sun), "400 x 400 pixels with a sun");
    assert!(warnings(&fisheye(800, sun)).iter().all(|warning| !warning.contains("with a sun")));
}

#[test]
fn values_that_overflowed_or_were_clipped() {
    let mut picture = fisheye(100, |_| 400.0);
    picture.pixels[5050] = [1.69e38; 3];
    assert_warned(&picture, "overflowed");
    let mut photograph = fisheye(400, |d| if off_sight_deg(d) < 2.0 { 90_000.0 } else { 400.0 });
    photograph.header = vec!["hdrgen -o room.hdr".into()];
    assert_warned(&photograph, "clipped");
    photograph.header = vec!["rpict -vta room.oct".into()];
    assert!(warnings(&photograph).iter().all(|warning| !warning.contains("clipped")));
}

#[test]
fn black_borders_and_vignetting() {
    assert_warned(
        &fisheye(300, |d| if off_sight_deg(d) < 80.0 { 400.0 } else { 0.0 }),
        "black from 81 degrees",
    );
    let mut vignetted = fisheye(300, |d| 600.0 * off_sight_deg(d).to_radians().cos().powi(2) + 1.0);
    assert!(warnings(&vignetted).is_empty());
    vignetted.header = vec!["hdrgen -o room.hdr".into()];
    assert_warned(&vignetted, "vignetting");
}
