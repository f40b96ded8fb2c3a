//! Scenes whose light is known in closed form.

mod common;

use common::*;
use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3};
use sunpeak_render::RenderOptions;

const UP: Vec3 = Vec3::Z;

fn white_box(reflectance: f64, extra: &str) -> String {
    format!(
        "void plastic white 0 0 5 {reflectance} {reflectance} {reflectance} 0 0\n!genbox white room 2 3 4 -i\n{extra}"
    )
}

#[test]
fn in_a_furnace_lossless_things_are_invisible() {
    // A shell that emits 1 at its inside. Whatever neither takes up nor gives light shows radiance 1 in every direction.
    // (The shell is a glow: polished surfaces treat light sources apart, as in Radiance.)
    let text = "void glow shine 0 0 4 1 1 1 0\nshine bubble shell 0 0 4 0 0 0 5\n\
                void trans sheet 0 0 7 1 1 1 0 0 0.4 0.3\nsheet sphere inner 0 0 4 0 0 0 2\n\
                void plastic polished 0 0 5 1 1 1 0.05 0\npolished sphere ball 0 0 4 0.7 0 0 0.5\n\
                void metal mirror 0 0 5 1 1 1 0.9 0\nmirror sphere ball 0 0 4 0 0.7 0 0.5\n\
                void glass clear 0 0 3 1 1 1\nclear sphere bulb 0 0 4 -0.7 0 0 0.5\n\
                void dielectric solid 0 0 5 1 1 1 1.5 0\nsolid sphere drop 0 0 4 0 -0.7 0 0.3\n\
                void trans rough 0 0 7 1 1 1 0 0.1 1 0.6\nrough ring pane 0 0 8 0 0 0.7 0 0 1 0 0.8\n";
    let world = world(text);
    for direction in
        [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::new(0.3, 0.2, -0.4), Vec3::new(0.1, 0.2, 1.0)]
    {
        let value = radiance(&world, Vec3::new(0.0, 0.0, 0.1), direction, &samples(2048));
        assert_close(&format!("furnace towards {direction}"), value, 1.0, 0.02);
    }
}

#[test]
fn in_a_furnace_a_lossless_sheet_is_invisible_however_it_lies() {
    // Paths are sent towards sheets that let light through; a sheet does not look for itself.
    let (center, across) = (Vec3::new(0.31, 0.17, 0.23), Vec3::new(0.6, 0.5, -0.4).normalize());
    let along = across.cross(Vec3::new(0.2, -0.3, 0.9)).normalize();
    let corners =
        [(-1.0, -0.7), (1.0, -0.7), (1.0, 0.7), (-1.0, 0.7)].map(|(x, y)| center + across * x + along * y);
    let corners: String = corners.iter().map(|c| format!(" {} {} {}", c.x, c.y, c.z)).collect();
    let text = format!(
        "void glow shine 0 0 4 1 1 1 0\nshine bubble shell 0 0 4 0 0 0 5\n\
         void trans sheet 0 0 7 1 1 1 0 0 0.4 0\nsheet polygon p 0 0 12{corners}\n"
    );
    let (world, normal) = (world(&text), across.cross(along));
    for (x, y, side) in [(0.1, 0.2, 1.0), (-0.7, 0.3, -1.0), (0.6, -0.5, 1.0)] {
        let eye = center + across * x + along * y + normal * side;
        let value = radiance(&world, eye, -normal * side, &samples(4096));
        assert_close("sheet in a furnace", value, 1.0, 0.005);
    }
}

#[test]
fn a_furnace_glows_with_its_emission_over_one_minus_its_reflectance() {
    // Walls that emit Le and reflect rho: here a black shell that emits, and just inside it a diffuse sheet of reflectance rho and
    // transmittance tau: the sheet's inside radiance is L = rho L + tau Le.
    let text = "void glow shine 0 0 4 1 1 1 0\nshine bubble shell 0 0 4 0 0 0 5\n\
                void trans sheet 0 0 7 0.9 0.9 0.9 0 0 0.25 0\nsheet sphere inner 0 0 4 0 0 0 4.999\n";
    let (rho, tau) = (0.9 * 0.75, 0.9 * 0.25);
    // Between shell and sheet the shell takes up all that comes back.
    let value = radiance(&world(text), Vec3::new(1.0, 2.0, 0.5), Vec3::new(0.3, 0.4, 0.5), &samples(8192));
    assert_close("furnace", value, tau / (1.0 - rho), 0.01);
}

#[test]
fn a_lamp_in_a_white_box_fills_it_as_an_integrating_sphere() {
    // A sphere of reflectance rho with a small lamp of flux F inside: the indirect irradiance is F/A rho/(1-rho) everywhere.
    let rho = 0.8;
    let text = format!(
        "void plastic white 0 0 5 {rho} {rho} {rho} 0 0\nwhite bubble room 0 0 4 0 0 0 2\n\
         void light shine 0 0 3 10 10 10\nshine sphere lamp 0 0 4 0 0 0 0.05\n"
    );
    let world = world(&text);
    let flux = 10.0 * PI * 4.0 * PI * 0.05f64.powi(2);
    let (wall, lamp) = (4.0 * PI * 4.0, 4.0 * PI * 0.05f64.powi(2));
    // The lamp itself is black and takes up what falls on it.
    let direct = flux / wall;
    let absorbed = lamp / wall;
    let expected = direct / (1.0 - rho * (1.0 - absorbed));
    let value = irradiance(&world, Vec3::new(0.0, 0.0, -1.999_999), UP, &samples(8192));
    assert_close("integrating sphere", value, expected, 0.01);
}

#[test]
fn a_wall_under_a_uniform_sky() {
    let text = format!(
        "{UNIFORM_SKY}void plastic grey 0 0 5 0.5 0.25 0.1 0 0\ngrey ring wall 0 0 8 0 0 0 0 0 1 0 100\n"
    );
    let value = radiance(&world(&text), Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z, &samples(1024));
    assert!((value - Rgb::new(0.5, 0.25, 0.1)).length() < 2e-3, "{value}");
    let value = irradiance(&world(&text), Vec3::new(0.0, 0.0, 1.0), UP, &samples(1024));
    assert_close("sky", value, PI, 1e-3);
}

#[test]
fn the_sun_through_any_number_of_panes() {
    for panes in 0..12 {
        for theta in [0.0, 25.0, 60.0, 80.0] {
            // A narrow sun: over 0.533 degrees the mean of T^12 is not T^12 of the centre.
            let mut text = sun(theta).replace("0.533", "0.0533") + "void glass clear 0 0 3 0.96 0.96 0.96\n";
            for i in 1..=panes {
                // Two triangles a pane, and the seam runs over the sensor.
                let z = 0.1 * f64::from(i);
                text += &format!("clear polygon p{i} 0 0 12 -9 -9 {z} 9 -9 {z} 9 9 {z} -9 9 {z}\n");
            }
            let value = irradiance(&world(&text), Vec3::ZERO, UP, &samples(256));
            let expected = 0.01 * sun_irradiance(theta) * glass_transmittance(theta.to_radians()).powi(panes);
            assert_close(&format!("{panes} panes at {theta}"), value, expected, 2e-3);
        }
    }
}

#[test]
fn sky_and_sun_through_panes_of_glass_and_trans() {
    // Wall behind clear panes. Light that the panes throw back and forth counts too: for parallel panes of (T, R) that is
    // T_12 = T1 T2 / (1 - R1 R2), so straight transmission is tested with panes that reflect nothing.
    let clear = "void trans clear 0 0 7 0.9 0.8 0.7 0 0 1 1\n";
    for layers in 1..=3i32 {
        let mut text = format!("{UNIFORM_SKY}{}{clear}void plastic wall 0 0 5 0.5 0.5 0.5 0 0\n", sun(30.0));
        text += "wall ring floor 0 0 8 0 0 0 0 0 1 0 100\n";
        for i in 1..=layers {
            text += &format!("clear ring layer{i} 0 0 8 0 0 {0} 0 0 1 0 1000\n", 0.01 * f64::from(i));
        }
        let world = world(&text);
        let passes = Rgb::new(0.9, 0.8, 0.7).powf(f64::from(layers));
        let expected = 0.5 / PI * (PI + sun_irradiance(30.0)) * passes;
        let value = radiance(&world, Vec3::new(0.0, 0.0, 0.005), Vec3::NEG_Z, &samples(2048));
        assert!(((value - expected) / expected).abs().max_element() < 5e-3, "{layers}: {value} {expected}");
        let sensor = irradiance(&world, Vec3::new(0.0, 0.0, 0.005), UP, &samples(2048));
        let expected = (PI + sun_irradiance(30.0)) * passes;
        assert!(((sensor - expected) / expected).abs().max_element() < 5e-3, "{layers}: {sensor} {expected}");
    }
}

#[test]
fn a_sky_through_one_pane() {
    let text = format!(
        "{UNIFORM_SKY}void glass clear 0 0 3 0.96 0.96 0.96\nclear ring pane 0 0 8 0 0 0.01 0 0 1 0 1000\n"
    );
    let value = irradiance(&world(&text), Vec3::ZERO, UP, &samples(4096));
    assert_close("sky through glass", value, PI * cosine_mean(glass_transmittance), 3e-3);
}

#[test]
fn a_pane_before_a_source_shows_it_in_full_to_the_eye() {
    let text = sun(0.0) + "void glass clear 0 0 3 0.96 0.96 0.96\nclear ring pane 0 0 8 0 0 1 0 0 1 0 10\n";
    let value = radiance(&world(&text), Vec3::ZERO, UP, &samples(1 << 14));
    assert_close("sun", value, 1e6 * glass_transmittance(0.0), 5e-3);
}

#[test]
fn rough_transmission_keeps_its_energy() {
    // A sheet that transmits all it does not reflect, under a sky on both sides: it must be invisible.
    let text = "void light shine 0 0 3 1 1 1\nshine bubble shell 0 0 4 0 0 0 50\n\
                void trans sheet 0 0 7 1 1 1 0 0.2 1 0.5\nsheet ring pane 0 0 8 0 0 0 0 0 1 0 10\n";
    let value = radiance(&world(text), Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.3, 0.0, -1.0), &samples(4096));
    assert_close("sheet", value, 1.0, 0.01);
}

#[test]
fn bounces_are_limited_as_asked() {
    // Inside a sphere of reflectance rho that a lamp lights with E0: after n bounces E0 (1 + rho + … + rho^n).
    let rho = 0.5f64;
    let text = format!(
        "void plastic white 0 0 5 {rho} {rho} {rho} 0 0\nwhite bubble room 0 0 4 0 0 0 2\n\
         void light shine 0 0 3 10 10 10\nshine sphere lamp 0 0 4 0 0 0 0.01\n"
    );
    let world = world(&text);
    let direct = 10.0 * PI * 0.01f64.powi(2) / 4.0;
    for bounces in 0..4u32 {
        let options = RenderOptions { max_bounces: Some(bounces), ..samples(4096) };
        let value = irradiance(&world, Vec3::new(0.0, 0.0, -1.999_999), UP, &options);
        let expected = direct * (0..=bounces as i32).map(|n| rho.powi(n)).sum::<f64>();
        assert_close(&format!("{bounces} bounces"), value, expected, 0.01);
    }
}

#[test]
fn a_sky_needs_one_bounce_and_a_light_none() {
    let sky = |kind: &str| format!("{kind}\nshine source sky 0 0 4 0 0 1 180\n");
    let at = |kind: &str, bounces| {
        let options = RenderOptions { max_bounces: Some(bounces), ..samples(256) };
        irradiance(&world(&sky(kind)), Vec3::ZERO, UP, &options).x / PI
    };
    assert!(at("void glow shine 0 0 4 1 1 1 0", 0) == 0.0);
    assert!((at("void glow shine 0 0 4 1 1 1 0", 1) - 1.0).abs() < 1e-3);
    assert!((at("void light shine 0 0 3 1 1 1", 0) - 1.0).abs() < 1e-3);
    assert!(at("void glow shine 0 0 4 1 1 1 -1", 5) == 0.0);
}

#[test]
fn a_mirror_throws_the_sun_back() {
    // The sun stands 60 degrees from the zenith towards +x; a mirror stands upright and throws it onto a sensor whose own view of
    // it a screen hides.
    let text = sun(60.0)
        + "void mirror glass 0 0 3 0.9 0.8 0.7\nglass polygon m 0 0 12 -1 -5 0 -1 5 0 -1 5 5 -1 -5 5\n\
           void plastic black 0 0 5 0 0 0 0 0\nblack polygon screen 0 0 12 0.1 -1 0 0.1 1 0 0.1 1 0.1 0.1 -1 0.1\n";
    let value = irradiance(&world(&text), Vec3::new(0.05, 0.0, 0.0), UP, &samples(256));
    let expected = sun_irradiance(60.0) * Rgb::new(0.9, 0.8, 0.7);
    assert!(((value - expected) / expected).abs().max_element() < 2e-3, "{value} {expected}");
}

#[test]
fn a_slab_of_glass_lets_the_sun_through() {
    // A solid slab: Fresnel twice and absorption over 0.1 m; light that bounces inside is left out, as in Radiance.
    let text = sun(40.0)
        + "void dielectric solid 0 0 5 0.5 0.5 0.5 1.5 0\n!genbox solid slab 40 40 0.1 | xform -t -20 -20 1\n";
    let value = irradiance(&world(&text), Vec3::ZERO, UP, &samples(256));
    let theta = 40f64.to_radians();
    let inside = (theta.sin() / 1.5).asin();
    let r = 0.5
        * (((theta - inside).sin() / (theta + inside).sin()).powi(2)
            + ((theta - inside).tan() / (theta + inside).tan()).powi(2));
    let expected = sun_irradiance(40.0) * (1.0 - r).powi(2) * 0.5f64.powf(0.1 / inside.cos());
    assert_close("slab", value, expected, 2e-3);
}

#[test]
fn emitters_light_from_their_front_only_and_spotlights_in_their_cone() {
    let text = "void light shine 0 0 3 1 1 1\nshine ring lamp 0 0 8 0 0 1 0 0 -1 0 0.1\n";
    let lit = irradiance(&world(text), Vec3::ZERO, UP, &samples(1024));
    assert_close("front", lit, PI * 0.01 / 1.01, 3e-3);
    assert!(irradiance(&world(text), Vec3::new(0.0, 0.0, 2.0), Vec3::NEG_Z, &samples(64)) == Rgb::ZERO);
    let text = "void spotlight shine 0 0 7 1 1 1 20 0 0 -1\nshine ring lamp 0 0 8 0 0 1 0 0 -1 0 0.01\n";
    let lit = irradiance(&world(text), Vec3::ZERO, UP, &samples(1024));
    // As from a focus 1 m behind the lamp: a quarter.
    assert_close("spot", lit, PI * 0.01f64.powi(2) / 4.0, 3e-3);
    assert!(irradiance(&world(text), Vec3::new(0.3, 0.0, 0.0), UP, &samples(64)) == Rgb::ZERO);
}

#[test]
fn an_illum_lights_and_shows_its_alternate() {
    let behind = "void glow behind 0 0 4 7 7 7 0\nbehind ring far 0 0 8 0 0 2 0 0 -1 0 1\n";
    let illum = "void glass pane 0 0 3 0.96 0.96 0.96\nvoid illum bright 1 pane 0 3 1 1 1\n\
                 bright ring window 0 0 8 0 0 1 0 0 -1 0 0.1\n";
    let seen = radiance(&world(&format!("{behind}{illum}")), Vec3::ZERO, UP, &samples(1 << 14));
    assert_close("through the illum", seen, 7.0 * glass_transmittance(0.0), 0.01);
    let lit = irradiance(&world(illum), Vec3::ZERO, UP, &samples(1024));
    assert_close("from the illum", lit, PI * 0.01 / 1.01, 3e-3);
}

#[test]
fn threads_change_nothing() {
    let text = white_box(
        0.7,
        "void light shine 0 0 3 9 9 9\nshine polygon lamp 0 0 12 0.5 0.5 3.9 0.5 1.5 3.9 1.5 1.5 3.9 1.5 0.5 3.9\n",
    );
    let world = world(&text);
    let sensors: Vec<_> = (0..200).map(|i| (Vec3::new(0.005 * f64::from(i) + 0.2, 1.0, 0.5), UP)).collect();
    let run = |threads| {
        let options = RenderOptions { threads: Some(threads), ..samples(16) };
        sunpeak_render::trace_irradiance(&world, &sensors, &options, &sunpeak_core::Control::new())
            .expect("traces")
            .values
    };
    assert_eq!(run(1), run(4));
}

#[test]
fn of_two_panes_at_the_same_place_one_counts() {
    let panes = "void glass one 0 0 3 0.96 0.96 0.96\nvoid glass two 0 0 3 0.96 0.96 0.96\n\
                 one ring a 0 0 8 0 0 1 0 0 1 0 9\ntwo polygon b 0 0 12 -9 -9 1 9 -9 1 9 9 1 -9 9 1\n";
    let world = world(&(sun(0.0).replace("0.533", "0.0533") + UNIFORM_SKY + panes));
    let no_sky = RenderOptions { max_bounces: Some(0), ..samples(64) };
    let value = irradiance(&world, Vec3::ZERO, UP, &no_sky);
    assert_close("sun", value, 0.01 * sun_irradiance(0.0) * glass_transmittance(0.0), 1e-4);
    let seen = radiance(&world, Vec3::ZERO, Vec3::new(0.0, 0.1, 1.0), &samples(1 << 14));
    assert_close("sky", seen, glass_transmittance(0.1f64.atan()), 5e-3);
}

#[test]
fn ambient_light_stands_for_what_lies_past_the_last_bounce() {
    // Between walls of reflectance rho every diffuse bounce dims what stands for the rest by rho.
    let rho = 0.6_f64;
    let dark = world(&white_box(rho, ""));
    let inside = Vec3::new(1.0, 1.0, 1.0);
    for bounces in 0..3 {
        let ambient = Rgb::new(2.0, 1.0, 0.5);
        let options = RenderOptions { max_bounces: Some(bounces), ambient, ..samples(16) };
        let expected = 2.0 * rho.powi(bounces as i32);
        let seen = radiance(&dark, inside, Vec3::new(0.3, 0.4, 0.5), &options);
        assert_close("radiance", seen, expected * rho, 1e-9);
        assert!((seen.z - seen.x / 4.0).abs() < 1e-12, "{seen}");
        assert_close("irradiance", irradiance(&dark, inside, UP, &options), expected * PI, 1e-9);
    }
}
