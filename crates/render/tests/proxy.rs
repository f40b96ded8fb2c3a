//! A `BSDF` with thickness stands for geometry that is there too: who sees which.

mod common;

use common::*;
use std::{f64::consts::PI, path::PathBuf, sync::Arc};
use sunpeak_bsdf::{
    Bsdf, PeakRule,
    synthetic::{Basis, Diffuser, Fabric, Goniophotometer, tabulate},
};
use sunpeak_core::{Rgb, Vec3};
use sunpeak_render::{RenderOptions, World, WorldOptions};
use sunpeak_scene::{LoadOptions, Scene};

/// A world in which `cloth.xml` is this table. (A file of that name has to be there; it is not read.)
fn world_with(bsdf: Bsdf, peak: PeakRule, text: &str) -> World {
    let folder = std::env::temp_dir().join(format!("sunpeak-proxy-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file: PathBuf = folder.join("cloth.xml");
    std::fs::write(&file, "").expect("writes");
    let options = LoadOptions { cwd: Some(folder), ..LoadOptions::default() };
    let scene = Scene::parse(text, "room.rad", &options).expect("a scene");
    let loaded = vec![(file, Arc::new(bsdf))];
    World::compile(&scene, &WorldOptions { peak, loaded, ..Default::default() }).expect("compiles")
}

/// A black sheet at 1.5 m between two proxies 1 m apart, all wide; they face down, so that the sheet is behind the lower one.
const SHEET: &str = "void plastic black 0 0 5 0 0 0 0 0\nblack ring sheet 0 0 8 0 0 1.5 0 0 -1 0 1000\n";
const PROXIES: &str = "void BSDF lower 6 1.01 cloth.xml 0 1 0 . 0 0\nlower ring a 0 0 8 0 0 1 0 0 -1 0 1000\n\
                       void BSDF upper 6 -1.01 cloth.xml 0 1 0 . 0 0\nupper ring b 0 0 8 0 0 2 0 0 -1 0 1000\n";

fn diffuser() -> Bsdf {
    let seen_by = Goniophotometer { rays: None, value_noise: 0.0, fwhm_deg: 0.0, seed: 1 };
    tabulate(&Diffuser { transmittance: 0.3 }, Basis::KlemsFull, &seen_by).expect("tabulates")
}

fn fabric() -> Bsdf {
    let fabric = Fabric { openness: 0.1, scattered: 0.2, reflectance: 0.3, ..Fabric::default() };
    fabric.tabulate(Basis::KlemsFull).expect("tabulates")
}

#[test]
fn view_rays_see_the_geometry_and_scattered_ones_the_table() {
    let world = world_with(diffuser(), PeakRule::Split, &format!("{UNIFORM_SKY}{SHEET}{PROXIES}"));
    assert_eq!(radiance(&world, Vec3::ZERO, Vec3::Z, &samples(16)), Rgb::ZERO);
    // From between the two, below the sheet, out through the lower one, which is not there from its back.
    let lit = format!(
        "{UNIFORM_SKY}{SHEET}{PROXIES}void glow shine 0 0 4 3 3 3 0\nshine ring floor 0 0 8 0 0 0 0 0 1 0 1000\n"
    );
    let world_below = world_with(diffuser(), PeakRule::Split, &lit);
    assert_eq!(radiance(&world_below, Vec3::new(0.0, 0.0, 1.4), Vec3::NEG_Z, &samples(16)), Rgb::splat(3.0));
    // A sensor gets what the table lets through of the sky: the sheet is no obstacle.
    let value = irradiance(&world, Vec3::ZERO, Vec3::Z, &samples(1 << 13));
    assert_close("diffuser", value, 0.3 * PI, 0.02);
}

#[test]
fn thickness_may_vary() {
    // On one half of the lower proxy light starts beyond the sheet, on the other before it, in its shadow.
    let varying = PROXIES.replace("lower 6 1.01 ", "lower 6 if(Px,1.01,.2) ");
    let world = world_with(diffuser(), PeakRule::Split, &format!("{UNIFORM_SKY}{SHEET}{varying}"));
    let value = irradiance(&world, Vec3::ZERO, Vec3::Z, &samples(1 << 13));
    assert_close("half", value, 0.15 * PI, 0.03);
    // Where there is none the table is seen.
    let varying = PROXIES.replace("lower 6 1.01 ", "lower 6 if(Px,1.01,0) ");
    let world = world_with(diffuser(), PeakRule::Split, &format!("{UNIFORM_SKY}{varying}"));
    let seen = |x| radiance(&world, Vec3::new(x, 0.0, 0.0), Vec3::Z, &samples(1 << 12));
    assert_eq!(seen(0.5), Rgb::ONE);
    assert_close("table", seen(-0.5), 0.3, 0.02);
}

#[test]
fn shadow_rays_see_the_geometry_and_nothing_counts_twice() {
    let sun = sun(20.0);
    let with = |peak, between: &str| {
        let world = world_with(fabric(), peak, &format!("{sun}{between}{PROXIES}"));
        irradiance(&world, Vec3::ZERO, Vec3::Z, &samples(1 << 14)).x / sun_irradiance(20.0)
    };
    // Closed: what the table scatters, and not what it lets through straight. Open: all of the sun as well.
    let (closed, open) = (with(PeakRule::Split, SHEET), with(PeakRule::Split, ""));
    assert!((closed / 0.2 - 1.0).abs() < 0.05, "{closed}");
    assert!((open - closed - 1.0).abs() < 0.02, "{open} {closed}");
    // The rules of the reference leave the straight part in the table.
    let whole = with(PeakRule::Off, SHEET);
    assert!(whole > closed + 0.05, "{whole}");
}

#[test]
fn the_sky_lights_the_geometry_once() {
    // A grey sheet between the proxies, which both let pass: from above it gets all of the sky, and shows its reflectance.
    let sheet = SHEET.replace("0 0 0 0 0\n", ".5 .5 .5 0 0\n").replace("0 0 -1 0 1000", "0 0 1 0 1000");
    let world = world_with(diffuser(), PeakRule::Split, &format!("{UNIFORM_SKY}{sheet}{PROXIES}"));
    let value = radiance(&world, Vec3::new(0.0, 0.0, 5.0), Vec3::new(0.2, 0.1, -1.0), &samples(1 << 12));
    assert_close("sheet", value, 0.5, 0.01);
}

#[test]
fn lamps_are_found_through_a_proxy() {
    // A small lamp above the upper proxy lights the diffuser: half of what a Lambertian sheet of transmittance 0.3 passes.
    let text = format!(
        "{SHEET}{PROXIES}void light shine 0 0 3 100 100 100\nshine ring lamp 0 0 8 0 0 4 0 0 -1 0 .1\n"
    );
    let world = world_with(diffuser(), PeakRule::Split, &text);
    let options = RenderOptions { max_bounces: None, ..samples(1 << 14) };
    let value = irradiance(&world, Vec3::ZERO, Vec3::Z, &options).x;
    // The sheet of light starts at the proxies' far side, 2.01 m from the lower one; point by point Lambert's law twice:
    // E = int B(r) / pi cos^4 / h^2 dA with B = tau L A_l cos^4(r / H) / H^2, H = 4 - 1 + 1.01 - 2.02 (lamp to the far side).
    let (lamp, far, near) = (100.0 * PI * 0.01, 4.0 - 1.0 - 1.01, 1.0);
    let n = 200_000;
    let sum: f64 = (0..n)
        .map(|i| {
            let r = 40.0 * (i as f64 + 0.5) / n as f64;
            let above = far * far / (far * far + r * r).powi(2);
            let below = near * near / (near * near + r * r).powi(2);
            0.3 * lamp * above / PI * below * 2.0 * PI * r * 40.0 / n as f64
        })
        .sum();
    assert!((value / sum - 1.0).abs() < 0.03, "{value} {sum}");
}
