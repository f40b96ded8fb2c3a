//! Scenes written as text, and short ways to ask about them.
#![allow(dead_code, reason = "each test file uses its own part")]

use sunpeak_core::{Control, Rgb, Vec3};
use sunpeak_render::{RenderOptions, World, WorldOptions, trace_irradiance, trace_radiance};
use sunpeak_scene::{LoadOptions, Scene};

/// Compile a scene that is written in the scene language.
pub fn world(text: &str) -> World {
    world_with(text, &WorldOptions::default())
}

pub fn world_with(text: &str, options: &WorldOptions) -> World {
    let scene = Scene::parse(text, "test.rad", &LoadOptions::default()).expect("the scene parses");
    World::compile(&scene, options).expect("the scene compiles")
}

pub fn samples(count: u32) -> RenderOptions {
    RenderOptions { samples: Some(count), seed: 1, ..Default::default() }
}

pub fn irradiance(world: &World, point: Vec3, normal: Vec3, options: &RenderOptions) -> Rgb {
    trace_irradiance(world, &[(point, normal)], options, &Control::new()).expect("traces").values[0]
}

pub fn radiance(world: &World, origin: Vec3, direction: Vec3, options: &RenderOptions) -> Rgb {
    trace_radiance(world, &[(origin, direction)], options, &Control::new()).expect("traces").values[0]
}

/// Relative difference of the first channel.
pub fn relative(value: Rgb, expected: f64) -> f64 {
    value.x / expected - 1.0
}

pub fn assert_close(what: &str, value: Rgb, expected: f64, tolerance: f64) {
    let difference = relative(value, expected);
    assert!(difference.abs() < tolerance, "{what}: {value}, expected {expected}: off by {difference:.2e}");
}

/// A sun of radiance 1e6 and 0.533 degrees, overhead but for an angle towards +x.
pub fn sun(theta_deg: f64) -> String {
    let theta = theta_deg.to_radians();
    format!(
        "void light sunshine 0 0 3 1e6 1e6 1e6\nsunshine source sun 0 0 4 {:.15} 0 {:.15} 0.533\n",
        theta.sin(),
        theta.cos()
    )
}

/// Irradiance of that sun on a surface that it strikes at this angle [W/m²].
pub fn sun_irradiance(theta_deg: f64) -> f64 {
    1e6 * sunpeak_core::cone_solid_angle(0.533) * theta_deg.to_radians().cos()
}

/// A sky of radiance 1 all over the upper hemisphere, and nothing below.
pub const UNIFORM_SKY: &str = "void glow skyglow 0 0 4 1 1 1 0\nskyglow source sky 0 0 4 0 0 1 180\n";

/// Transmittance of clear thin glass, all reflections summed, from Fresnel's equations in terms of the angles (index 1.52,
/// transmissivity 0.96).
pub fn glass_transmittance(theta: f64) -> f64 {
    let inside = (theta.sin() / 1.52).asin();
    let (sum, difference) = (theta + inside, theta - inside);
    let perpendicular =
        if theta == 0.0 { (0.52f64 / 2.52).powi(2) } else { (difference.sin() / sum.sin()).powi(2) };
    let parallel = if theta == 0.0 { perpendicular } else { (difference.tan() / sum.tan()).powi(2) };
    let d = 0.96f64.powf(1.0 / inside.cos());
    let through = |r: f64| (1.0 - r).powi(2) * d / (1.0 - (r * d).powi(2));
    0.5 * (through(perpendicular) + through(parallel))
}

/// Integral over the hemisphere of cos times a function of the angle, over pi.
pub fn cosine_mean(f: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    // Uniform in sin².
    (0..n).map(|i| f(((i as f64 + 0.5) / n as f64).sqrt().asin())).sum::<f64>() / n as f64
}
