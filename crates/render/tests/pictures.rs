//! Pictures: what pixels hold, and suns that are put in exactly.

mod common;

use common::*;
use std::f64::consts::PI;
use sunpeak_bsdf::PeakRule;
use sunpeak_bsdf::synthetic::{Basis, Fabric};
use sunpeak_core::{Control, Vec3, cone_solid_angle};
use sunpeak_render::{RenderOptions, World, WorldOptions, render_picture};
use sunpeak_scene::{Picture, View};

/// A fisheye that looks up.
fn fisheye() -> View {
    View::parse("-vta -vp 0 0 0 -vd 0 0 1 -vu 0 1 0 -vh 180 -vv 180").expect("a view")
}

fn picture(world: &World, view: &View, size: usize, options: &RenderOptions) -> Picture {
    render_picture(world, view, size, size, options, &Control::new()).expect("renders")
}

/// Irradiance at the eye from the pixels: sum of radiance, cosine to the view direction and solid angle.
fn eye_irradiance(picture: &Picture, view: &View) -> f64 {
    let forward = view.direction.normalize();
    let pixel = |i: usize| {
        let (column, row) = (i % picture.width, i / picture.width);
        let (x, y) =
            ((column as f64 + 0.5) / picture.width as f64, 1.0 - (row as f64 + 0.5) / picture.height as f64);
        let Some(ray) = view.ray(x, y) else { return 0.0 };
        let solid_angle = view.pixel_solid_angle(column, row, picture.width, picture.height);
        f64::from(picture.pixels[i][0]) * solid_angle * ray.direction.dot(forward).max(0.0)
    };
    (0..picture.pixels.len()).map(pixel).sum()
}

#[test]
fn a_fisheye_of_a_uniform_sky_sums_to_pi() {
    let world = world(UNIFORM_SKY);
    let picture = picture(&world, &fisheye(), 200, &samples(4));
    assert!((eye_irradiance(&picture, &fisheye()) / PI - 1.0).abs() < 2e-3);
    assert!(picture.exact_sources.is_empty());
    assert!(picture.header.iter().any(|line| line.starts_with("SOFTWARE= Sunpeak")));
}

#[test]
fn the_sun_is_exact_at_any_resolution_and_number_of_samples() {
    for glass in [false, true] {
        let mut text = sun(30.0);
        if glass {
            text += "void glass clear 0 0 3 0.96 0.96 0.96\nclear ring pane 0 0 8 0 0 1 0 0 1 0 100\n";
        }
        let through = if glass { glass_transmittance(30f64.to_radians()) } else { 1.0 };
        let world = world(&text);
        for size in [40, 150, 700] {
            let picture = picture(&world, &fisheye(), size, &samples(1));
            let [source] = picture.exact_sources[..] else {
                panic!("one source: {:?}", picture.exact_sources)
            };
            assert!((source.visible_fraction - 1.0).abs() < 1e-12);
            assert_close("radiance", source.radiance, 1e6 * through, 1e-3);
            assert!((source.solid_angle_sr / cone_solid_angle(0.533) - 1.0).abs() < 1e-12);
            let expected = sun_irradiance(30.0) * through;
            let found = eye_irradiance(&picture, &fisheye());
            assert!((found / expected - 1.0).abs() < 0.02, "{size}: {found} {expected}");
        }
    }
}

#[test]
fn without_exact_suns_the_pixels_find_the_same_light() {
    // A sun of four degrees: paths of a pixel meet one of half a degree too seldom to say much.
    let text = sun(30.0).replace("0.533", "4")
        + "void glass clear 0 0 3 0.96 0.96 0.96\nclear ring pane 0 0 8 0 0 1 0 0 1 0 100\n";
    let options = RenderOptions { exact_suns: false, ..samples(256) };
    let picture = picture(&world(&text), &fisheye(), 100, &options);
    let irradiance = 1e6 * PI * 2f64.to_radians().sin().powi(2) * 30f64.to_radians().cos();
    let expected = irradiance * glass_transmittance(30f64.to_radians());
    let found = eye_irradiance(&picture, &fisheye());
    assert!(picture.exact_sources.is_empty() && (found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

#[test]
fn a_half_hidden_sun_is_half_seen() {
    let text = sun(0.0)
        + "void plastic black 0 0 5 0 0 0 0 0\nblack polygon edge 0 0 12 0 -9 5 9 -9 5 9 9 5 0 9 5\n";
    let picture = picture(&world(&text), &fisheye(), 100, &samples(1));
    assert!((picture.exact_sources[0].visible_fraction - 0.5).abs() < 0.01);
    assert_close("radiance", picture.exact_sources[0].radiance, 1e6, 1e-9);
    let hidden = sun(0.0) + "void plastic black 0 0 5 0 0 0 0 0\nblack ring cap 0 0 8 0 0 5 0 0 -1 0 1\n";
    assert!(self::picture(&world(&hidden), &fisheye(), 50, &samples(1)).exact_sources.is_empty());
}

#[test]
fn suns_in_flat_mirrors_and_panes_are_seen_there() {
    // A polished floor below the eye and the sun above; the eye looks at both.
    let view = View::parse("-vta -vp 0 0 1 -vd 1 0 0 -vu 0 0 1 -vh 180 -vv 180").expect("a view");
    for (material, reflectance) in [
        ("void metal floor 0 0 5 0.8 0.8 0.8 1 0\n", None),
        ("void mirror floor 0 0 3 0.7 0.7 0.7\n", Some(0.7)),
        ("void glass floor 0 0 3 0 0 0\n", None),
    ] {
        let text = sun(50.0) + material + "floor polygon f 0 0 12 -50 -50 0 50 -50 0 50 50 0 -50 50 0\n";
        let world = world(&text);
        let picture = picture(&world, &view, 64, &samples(1));
        assert_eq!(picture.exact_sources.len(), 2, "{material}");
        let reflected = picture.exact_sources.iter().find(|s| s.direction.z < 0.0).expect("below");
        let up = picture.exact_sources.iter().find(|s| s.direction.z > 0.0).expect("above");
        assert!((reflected.direction + up.direction - 2.0 * up.direction.x * Vec3::X).length() < 1e-9);
        if let Some(reflectance) = reflectance {
            assert_close("mirrored", reflected.radiance, 1e6 * reflectance, 1e-9);
        }
        // The same ray, traced by itself, sees the same.
        let ray = radiance(&world, view.position, reflected.direction, &samples(1 << 14));
        assert_close(material, ray, reflected.radiance.x, 0.03);
    }
}

#[test]
fn reflections_between_two_panes_are_part_of_the_sun() {
    let text = sun(20.0)
        + "void glass clear 0 0 3 1 1 1\nclear ring a 0 0 8 0 0 1 0 0 1 0 100\nclear ring b 0 0 8 0 0 1.1 0 0 1 0 100\n";
    let world = world(&text);
    let picture = picture(&world, &fisheye(), 64, &samples(1));
    // Two panes of (T, R = 1 - T): T² / (1 - R²).
    let inside = (20f64.to_radians().sin() / 1.52).asin();
    let (sum, difference) = (20f64.to_radians() + inside, 20f64.to_radians() - inside);
    let faces = [(difference.sin() / sum.sin()).powi(2), (difference.tan() / sum.tan()).powi(2)];
    let t = 0.5 * faces.iter().map(|r| (1.0 - r) / (1.0 + r)).sum::<f64>();
    assert_close(
        "double pane",
        picture.exact_sources[0].radiance,
        1e6 * t * t / (1.0 - (1.0 - t).powi(2)),
        1e-3,
    );
}

#[test]
fn the_sun_through_a_peak_is_exact_and_without_peak_a_blob() {
    let fabric = Fabric { lobe_share: 0.0, reflectance: 0.0, ..Fabric::default() };
    let file = std::env::temp_dir().join(format!("sunpeak-picture-{}.xml", std::process::id()));
    let bsdf = fabric.tabulate(Basis::TensorTree3 { side: 64 }).expect("tabulates");
    std::fs::write(&file, bsdf.to_xml()).expect("writes");
    let text = sun(30.0)
        + &format!(
            "void aBSDF cloth 5 {} 0 1 0 . 0 0\ncloth ring layer 0 0 8 0 0 1 0 0 1 0 1000\n",
            file.display()
        );
    let near = View::parse("-vtv -vp 0 0 0 -vd .5 0 .8660254 -vu 0 1 0 -vh 3 -vv 3").expect("a view");
    let by = |peak| {
        let world = world_with(&text, &WorldOptions { peak, ..Default::default() });
        let brightest =
            picture(&world, &near, 30, &samples(1)).pixels.iter().map(|p| p[0]).fold(0.0, f32::max);
        (
            picture(&world, &fisheye(), 120, &samples(16)),
            f64::from(brightest) / (1e6 * fabric.through(30f64.to_radians())),
        )
    };
    let [(split, with), (off, without), (radiance, _)] =
        [PeakRule::Split, PeakRule::Off, PeakRule::Radiance].map(by);
    assert!((with - 1.0).abs() < 0.02 && without < 0.15, "{with} {without}");
    let expected = 1e6 * fabric.through(30f64.to_radians());
    assert_close("through the peak", split.exact_sources[0].radiance, expected, 5e-3);
    assert_close("by the rule of Radiance", radiance.exact_sources[0].radiance, expected, 0.03);
    assert!(off.exact_sources.is_empty());
    // The same light reaches the eye.
    let whole = sun_irradiance(30.0) * (fabric.scattered + fabric.through(30f64.to_radians()));
    for (picture, tolerance) in [(&split, 0.01), (&off, 0.02), (&radiance, 0.03)] {
        let found = eye_irradiance(picture, &fisheye());
        assert!((found / whole - 1.0).abs() < tolerance, "{found} {whole}");
    }
}

#[test]
fn pictures_do_not_depend_on_threads_but_on_seeds() {
    let world = world(
        &(sun(30.0) + UNIFORM_SKY + "void plastic p 0 0 5 0.5 0.5 0.5 0.03 0.1\np sphere s 0 0 4 0 1 3 1\n"),
    );
    let render = |threads, seed| {
        let options = RenderOptions { threads: Some(threads), seed, ..samples(4) };
        picture(&world, &fisheye(), 40, &options).pixels
    };
    assert_eq!(render(1, 7), render(3, 7));
    assert_ne!(render(1, 7), render(1, 8));
}

#[test]
fn senseless_views_are_refused_and_a_stop_is_heard() {
    let world = world(UNIFORM_SKY);
    let options = RenderOptions::default();
    assert!(render_picture(&world, &fisheye(), 0, 10, &options, &Control::new()).is_err());
    let flat = View { up: Vec3::Z, direction: Vec3::Z, ..fisheye() };
    assert!(render_picture(&world, &flat, 10, 10, &options, &Control::new()).is_err());
    let control = Control::new();
    control.stop();
    let stopped = render_picture(&world, &fisheye(), 10, 10, &options, &control);
    assert!(matches!(stopped, Err(sunpeak_core::Error::Interrupted)));
}
