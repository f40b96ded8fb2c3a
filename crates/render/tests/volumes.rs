//! Mist, antimatter and interfaces, whose light is known in closed form.

mod common;

use common::*;
use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3};

/// A wall of radiance 1 that fills the view.
const WALL: &str = "void glow shine 0 0 4 1 1 1 0\nshine bubble shell 0 0 4 0 0 0 50\n";

/// A ray along x through a box of mist from x = 1 to 3.
fn through(mist: &str) -> Rgb {
    let text = format!("{WALL}void mist fog 0 0 {mist}\n!genbox fog box 2 20 20 | xform -t 1 -10 -10\n");
    radiance(&world(&text), Vec3::ZERO, Vec3::X, &samples(4096))
}

#[test]
fn absorbing_mist_obeys_beers_law() {
    let value = through("3 .1 .2 .5");
    let expected = (-2.0 * Rgb::new(0.1, 0.2, 0.5)).exp();
    assert!((value - expected).length() < 1e-9, "{value}");
    // From inside, half of the way, and whatever way the ray goes.
    let text = format!("{WALL}void mist fog 0 0 3 .1 .2 .5\nfog sphere ball 0 0 4 0 0 0 2\n");
    for direction in [Vec3::X, Vec3::new(0.3, 0.5, -0.7)] {
        let value = radiance(&world(&text), Vec3::ZERO, direction, &samples(16));
        assert!((value - expected).length() < 1e-9, "{value}");
    }
}

#[test]
fn overlapping_mists_add_up_and_are_left_one_by_one() {
    let text = format!(
        "{WALL}void mist one 0 0 3 .1 .1 .1\nvoid mist two 0 0 3 .3 .3 .3\n\
         !genbox one a 4 20 20 | xform -t 1 -10 -10\n!genbox two b 4 20 20 | xform -t 3 -10 -10\n"
    );
    let value = radiance(&world(&text), Vec3::ZERO, Vec3::X, &samples(16));
    assert!((value.x - (-(0.1f64 * 4.0 + 0.3 * 4.0)).exp()).abs() < 1e-9, "{value}");
}

#[test]
fn in_a_furnace_mist_without_absorption_is_invisible() {
    for g in ["0", ".8", "-.5"] {
        let value = through(&format!("7 .3 .8 2 1 1 1 {g}"));
        assert!((value - Rgb::ONE).abs().max_element() < 0.03, "{g}: {value}");
    }
}

#[test]
fn thin_mist_scatters_the_sun_once() {
    // A thin slab of extinction e, thickness d: radiance along the normal is E p(theta) albedo e d, here to the first order.
    let g = 0.6f64;
    let text = sun(30.0)
        + &format!(
            "void mist fog 0 0 7 1e-3 2e-3 3e-3 .5 .5 .5 {g}\n!genbox fog box 40 40 1 | xform -t -20 -20 1\n"
        );
    // Looking up past the sun at 30 degrees: light goes on downwards by an angle of 30 degrees.
    let value = radiance(&world(&text), Vec3::ZERO, Vec3::Z, &samples(1 << 16));
    let phase = (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * 30f64.to_radians().cos()).powf(1.5));
    let flux = sun_irradiance(30.0) / 30f64.to_radians().cos();
    let expected = flux * phase * 0.5 * Rgb::new(1e-3, 2e-3, 3e-3);
    assert!(((value - expected) / expected).abs().max_element() < 0.02, "{value} {expected}");
}

#[test]
fn mist_dims_the_sun_on_a_sensor() {
    let text = sun(60.0) + "void mist fog 0 0 3 .1 .2 .3\n!genbox fog box 400 400 2 | xform -t -200 -200 1\n";
    let value = irradiance(&world(&text), Vec3::ZERO, Vec3::Z, &samples(64));
    let expected = sun_irradiance(60.0) * (-4.0 * Rgb::new(0.1, 0.2, 0.3)).exp();
    assert!(((value - expected) / expected).abs().max_element() < 2e-3, "{value} {expected}");
}

/// A thick white wall from x = 1 to 2, and a box of antimatter from y = -1 to 1 and z = -1 to 1 through it.
fn cut_wall(antimatter: &str, from: Vec3, towards: Vec3) -> Rgb {
    let text = format!(
        "void glow shine 0 0 4 1 1 1 0\nshine source sky 0 0 4 1 0 0 180\n\
         void plastic white 0 0 5 .5 .5 .5 0 0\nvoid plastic black 0 0 5 0 0 0 0 0\n\
         !genbox white wall 1 20 20 | xform -t 1 -10 -10\n\
         void antimatter eraser {antimatter} 0 0\n!genbox eraser hole 1.2 2 2 | xform -t .9 -1 -1\n"
    );
    radiance(&world(&text), from, towards, &samples(4096))
}

#[test]
fn antimatter_makes_a_hole_with_faces() {
    let hole = |antimatter: &str| cut_wall(antimatter, Vec3::ZERO, Vec3::X);
    assert_eq!(hole("1 white"), Rgb::ONE);
    assert_eq!(hole("2 void white"), Rgb::ONE);
    assert_eq!(hole("1 black"), Rgb::ZERO);
    // Beside the hole the wall is there.
    assert_eq!(cut_wall("1 white", Vec3::new(0.0, 3.0, 0.0), Vec3::X), Rgb::ZERO);
    // Obliquely the ray comes into the wall and meets the side of the hole, which the sky lights from the other end.
    let from = Vec3::new(0.0, -1.2, 0.0);
    let side = cut_wall("1 white", from, Vec3::new(1.0, 1.3, 0.0));
    assert!(side.x > 0.05 && side.x < 0.5, "{side}");
    // Without a face one sees the wall's back from within the wall, which gets less light.
    let inside = cut_wall("2 void white", from, Vec3::new(1.0, 1.3, 0.0));
    assert!(inside.x > 0.0 && inside.x < 0.5 * side.x, "{inside}");
}

#[test]
fn light_falls_through_a_hole_of_antimatter() {
    // A round hole in a thin black screen under a uniform sky: pi sin² of its angle.
    let text = format!(
        "{UNIFORM_SKY}void plastic black 0 0 5 0 0 0 0 0\n!genbox black screen 200 200 .01 | xform -t -100 -100 1\n\
         void antimatter eraser 2 void black 0 0\neraser cylinder side 0 0 7 0 0 .9 0 0 1.1 1\n\
         eraser ring top 0 0 8 0 0 1.1 0 0 1 0 1\neraser ring bottom 0 0 8 0 0 .9 0 0 -1 0 1\n"
    );
    let value = irradiance(&world(&text), Vec3::ZERO, Vec3::Z, &samples(1 << 14));
    assert_close("hole", value, PI / (1.0 + 1.005f64.powi(2)), 0.01);
}

#[test]
fn a_drop_of_glass_in_water_is_seen_through_two_interfaces() {
    // Straight through the middle of a sphere (index 1.6) in a cube of water (1.33), both absorbing.
    let text = format!(
        "{WALL}void dielectric water 0 0 5 .9 .9 .9 1.33 0\n!genbox water cube 1 1 1 | xform -t -.5 -.5 -.5\n\
         void interface drop 0 0 8 .5 .5 .5 1.6 .9 .9 .9 1.33\ndrop sphere ball 0 0 4 0 0 0 .25\n"
    );
    // In a furnace only absorption shows. Of the paths that are reflected inside some go round: bounds, and the transmitted part.
    let value = radiance(&world(&text), Vec3::new(-3.0, 0.0, 0.0), Vec3::X, &samples(1 << 15)).x;
    let fresnel = |n: f64| ((n - 1.0) / (n + 1.0)).powi(2);
    let (r1, r2) = (fresnel(1.33), fresnel(1.6 / 1.33));
    // On the axis everything stays on the axis: a stack of four faces, summed by the matrix of fluxes.
    let layers = [(r1, 0.9f64.powf(0.25)), (r2, 0.5f64.powf(0.5)), (r2, 0.9f64.powf(0.25)), (r1, 1.0)];
    // Adding: reflectance and transmittance from behind forwards (reflected light sees the wall too).
    let (mut r, mut t) = (0.0, 1.0);
    for (face, inside) in layers.into_iter().rev() {
        let (rb, tb) = (r * inside * inside, t * inside);
        let whole = 1.0 / (1.0 - face * rb);
        (r, t) = (face + (1.0 - face).powi(2) * rb * whole, (1.0 - face) * tb * whole);
    }
    assert_close("drop", Rgb::splat(value), r + t, 0.01);
}
