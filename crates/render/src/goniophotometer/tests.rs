use super::*;
use crate::World;
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_bsdf::{Bsdf, Mode, PeakRule};
use sunpeak_core::luminance;
use sunpeak_scene::{LoadOptions, Scene};

/// A pane in the face z = 0 whose front looks into the room.
const PANE: &str = "m polygon p 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0";

/// Of each 100 lm: 30 reflected, 50 transmitted, of these 20 straight.
const TRANS: &str = "void trans m 0 0 7 .8 .8 .8 0 0 .625 .4";

fn world(text: &str) -> World {
    let scene = Scene::parse(text, "t.rad", &LoadOptions::default()).expect("a scene");
    World::compile(&scene, &Default::default()).expect("a world")
}

fn options(basis: &str, samples: u64) -> GonioOptions {
    GonioOptions {
        samples: Some(samples),
        edges: Edges::Periodic,
        error: 1.0,
        ..GonioOptions::new(basis.parse().expect("a basis"))
    }
}

fn made(world: &World, options: &GonioOptions) -> Generated {
    generate_bsdf(world, options, &Control::new()).expect("a BSDF")
}

fn direction(theta_deg: f64, phi_deg: f64) -> Vec3 {
    let (sin, cos) = theta_deg.to_radians().sin_cos();
    (DVec2::from_angle(phi_deg.to_radians()) * sin).extend(cos)
}

fn hemispherical(bsdf: &Bsdf, w_in: Vec3, mode: Mode) -> f64 {
    luminance(bsdf.hemispherical_smooth(w_in, mode, PeakRule::Off))
}

#[test]
fn a_pane_of_trans_is_what_its_material_says() {
    let world = world(&format!("{TRANS}\n{PANE}"));
    for basis in ["klems-quarter", "t3-64", "t4-64"] {
        let generated = made(&world, &options(basis, 1 << 12));
        for w_in in [direction(20.0, 40.0), -direction(50.0, 200.0)] {
            let through = luminance(generated.bsdf.through(w_in, PeakRule::Split));
            assert!((through - 0.2).abs() < 1e-6, "{basis} {through}");
            let transmitted = hemispherical(&generated.bsdf, w_in, Mode::Transmission);
            let reflected = hemispherical(&generated.bsdf, w_in, Mode::Reflection);
            assert!((transmitted - 0.5).abs() < 0.01 && (reflected - 0.3).abs() < 0.01, "{basis}");
            let rest = luminance(generated.bsdf.evaluate_smooth(w_in, -w_in, PeakRule::Split));
            assert!((rest - 0.3 / PI).abs() < 0.2 * 0.3 / PI, "{basis} {rest}");
        }
        for column in generated.sides.iter().flat_map(|s| &s.columns) {
            assert!(
                (column.transmittance - 0.5).abs() <= 5.0 * column.transmittance_error + 1e-6,
                "{column:?}"
            );
            assert!((column.reflectance - 0.3).abs() <= 5.0 * column.reflectance_error + 1e-6, "{column:?}");
        }
    }
}

/// Each value against the closed form: the errors are those that the table states, no smaller and not far larger.
#[test]
fn stated_errors_are_what_the_values_differ_by() {
    let world = world(&format!("{TRANS}\n{PANE}"));
    let options = GonioOptions { reciprocity: false, ..options("klems-quarter", 1 << 10) };
    let generated = made(&world, &options);
    let d = generated.bsdf.distribution(Vec3::Z, Mode::Reflection).expect("a reflection");
    let squares: Vec<f64> =
        d.distribution.luminous().values().iter().map(|&v| (f64::from(v) - 0.3 / PI).powi(2)).collect();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() / (0.3 / PI);
    let stated = generated.sides[1].cell_error[1];
    // Well-distributed points do better than the independent ones that the error is stated for.
    assert!(rms < 1.1 * stated && rms > 0.2 * stated, "{rms} {stated}");
    // However few rays are asked for, there are enough to tell an error.
    let least = made(&world, &GonioOptions { samples: Some(1), ..options });
    assert!(least.sides[0].columns.iter().all(|c| c.samples == 8));
}

#[test]
fn a_mirror_sends_light_on_in_the_plane_it_came_in() {
    let world = world(&format!("void metal m 0 0 5 .9 .9 .9 1 0\n{PANE}"));
    let generated = made(&world, &options("klems-quarter", 256));
    let came = direction(30.0, 70.0);
    let mirrored = Vec3::new(-came.x, -came.y, came.z);
    let value = luminance(generated.bsdf.evaluate(came, mirrored));
    let area = PI * (45f64.to_radians().sin().powi(2) - 27f64.to_radians().sin().powi(2)) / 12.0;
    assert!((value * area - 0.9).abs() < 0.02, "{}", value * area);
    assert_eq!(generated.sides[1].columns[0].through, 0.0);
}

/// A plane-parallel slab refracts light back into its direction: by Fresnel's equations with all inner reflections,
/// T = (1 - R) / (1 + R) at normal incidence, R = 0.04 for 1.5.
#[test]
fn what_a_slab_brings_back_to_its_direction_goes_straight() {
    let below = "m polygon q 0 0 12 0 0 -.1 0 1 -.1 1 1 -.1 1 0 -.1";
    let world = world(&format!("void dielectric m 0 0 5 1 1 1 1.5 0\n{PANE}\n{below}"));
    let generated = made(&world, &options("klems-quarter", 1 << 12));
    let r: f64 = 0.04;
    let column = generated.sides[0].columns[0];
    // The first patch reaches to 9 degrees, over which the reflectance hardly changes.
    assert!((column.through - (1.0 - r) / (1.0 + r)).abs() < 4.0 * column.through_error + 1e-3, "{column:?}");
    assert!((column.transmittance + column.reflectance - 1.0).abs() < 0.01);
}

/// Slats of which one spacing repeats, and the same slats many times over.
#[test]
fn a_periodic_box_is_the_middle_of_a_large_product() {
    let slats = |n: u32| {
        format!(
            "void plastic m 0 0 5 .5 .5 .5 0 0\n!genblinds m b .05 8 {h} {n} 30 | xform -rz -90 -rx -90 -t -4 -{half} -.0433012702",
            h = 0.05 * f64::from(n),
            half = 0.025 * f64::from(n)
        )
    };
    let corners = Some([Vec3::new(0.0, -0.025, -0.043_301_270_2), Vec3::new(0.05, 0.025, 0.0)]);
    let periodic = GonioOptions { corners, ..options("klems-quarter", 1 << 11) };
    let open = GonioOptions { edges: Edges::Open, seed: 7, ..periodic.clone() };
    let (cell, large) = (made(&world(&slats(5)), &periodic), made(&world(&slats(81)), &open));
    for (a, b) in cell.sides.iter().zip(&large.sides) {
        // The last ring passes the ends of any product.
        for (a, b) in a.columns.iter().zip(&b.columns).take(33) {
            let near = |x: f64, y: f64, e: f64| (x - y).abs() < 5.0 * e + 2e-3;
            let [t, r] = [
                a.transmittance_error.hypot(b.transmittance_error),
                a.reflectance_error.hypot(b.reflectance_error),
            ];
            assert!(near(a.transmittance, b.transmittance, t), "{a:?} {b:?}");
            assert!(near(a.reflectance, b.reflectance, r), "{a:?} {b:?}");
        }
    }
}

#[test]
fn a_run_that_was_stopped_goes_on_to_the_same_table() {
    let text = format!("{TRANS}\n{PANE}");
    let world = world(&text);
    let folder = std::env::temp_dir().join(format!("sunpeak-gonio-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let state = folder.join("columns");
    let plain = options("klems-quarter", 512);
    let whole = made(&world, &plain);
    let kept = GonioOptions { state: Some(state.clone()), threads: Some(1), ..plain.clone() };
    let control = Control::new();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while control.progress().0 < 5 {
                std::thread::yield_now();
            }
            control.stop();
        });
        let slow = GonioOptions { ..kept.clone() };
        match generate_bsdf(&world, &slow, &control) {
            Err(Error::Interrupted) => assert!(state.exists()),
            // Too fast to be stopped: nothing is kept.
            other => assert!(other.is_ok() && !state.exists()),
        }
    });
    if state.exists() {
        let other = GonioOptions { seed: 1, resume: true, ..kept.clone() };
        let message = generate_bsdf(&world, &other, &Control::new()).expect_err("other options").to_string();
        assert!(message.contains("other options"), "{message}");
        let resumed = made(&world, &GonioOptions { resume: true, threads: Some(2), ..kept.clone() });
        assert_eq!(resumed.bsdf.to_xml(), whole.bsdf.to_xml());
        assert!(!state.exists());
    }
    std::fs::write(&state, b"spgonio1 and nothing of sense").expect("a file");
    let message = generate_bsdf(&world, &GonioOptions { resume: true, ..kept }, &Control::new())
        .expect_err("a damaged file")
        .to_string();
    assert!(message.contains("damaged"), "{message}");
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn what_does_not_fit_is_refused() {
    let pane = world(&format!("{TRANS}\n{PANE}"));
    let said = |world: &World, options: &GonioOptions| match generate_bsdf(world, options, &Control::new()) {
        Err(error) => error.to_string(),
        Ok(_) => "fine".into(),
    };
    let plain = options("klems-quarter", 16);
    let flat = GonioOptions { corners: Some([Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0)]), ..plain.clone() };
    assert!(said(&pane, &flat).contains("width and a height"));
    let low = GonioOptions { corners: Some([Vec3::splat(-2.0), Vec3::new(1.0, 1.0, -1.0)]), ..plain.clone() };
    assert!(said(&pane, &low).contains("between the box's faces"));
    assert!(said(&world("void light sky 0 0 3 1 1 1"), &plain).contains("no surfaces"));
    assert!(said(&pane, &options("t4-16384", 16)).contains("64 cells a side"));
    assert!(said(&pane, &GonioOptions { tolerance: f64::NAN, ..plain.clone() }).contains("tolerance"));
    assert!(said(&pane, &GonioOptions { samples: Some(0), ..plain }).contains("samples"));
}

#[test]
fn mist_in_the_box_scatters_and_loses_nothing_else() {
    // Albedo 1: all light leaves; what goes straight is exp(-extinction * way).
    let text = "void mist m 0 0 7 1 1 1 1 1 1 0\nm sphere s 0 0 4 0 0 0 .5";
    let world = world(text);
    let corners = Some([Vec3::splat(-0.5), Vec3::splat(0.5)]);
    let generated =
        made(&world, &GonioOptions { corners, edges: Edges::Open, ..options("klems-quarter", 1 << 12) });
    let column = generated.sides[0].columns[0];
    assert!((column.transmittance + column.reflectance - 1.0).abs() < 0.01, "{column:?}");
    assert!(column.through > 0.4 && column.through < 0.75, "{column:?}");
}

#[test]
fn the_straight_part_alone_is_the_same_as_in_the_table() {
    let world = world(&format!("{TRANS}\n{PANE}"));
    let towards = [Vec3::new(0.1, 0.2, 1.0), Vec3::new(0.3, -0.2, -1.0)];
    let found = straight_transmittance(&world, None, Edges::Periodic, &towards, 64, 0).expect("numbers");
    assert!(found.iter().all(|(t, e)| (luminance(*t) - 0.2).abs() < 1e-9 && luminance(*e) < 1e-9));
    assert!(straight_transmittance(&world, None, Edges::Periodic, &[Vec3::X], 64, 0).is_err());
}
