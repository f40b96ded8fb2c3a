//! What cannot be rendered is refused with its place in the file; what is nothing in Radiance is nothing here.

mod common;

use common::*;
use sunpeak_bsdf::{
    PeakRule,
    synthetic::{Basis, Fabric},
};
use sunpeak_core::Vec3;
use sunpeak_render::{World, WorldOptions};
use sunpeak_scene::{LoadOptions, Scene};

fn refusal(text: &str) -> String {
    let scene = Scene::parse(text, "room.rad", &LoadOptions::default()).expect("the scene parses");
    World::compile(&scene, &WorldOptions::default()).expect_err("is refused").to_string()
}

#[test]
fn refusals_name_place_and_remedy() {
    let fabric = Fabric::default().tabulate(Basis::KlemsQuarter).expect("tabulates");
    let file = std::env::temp_dir().join(format!("sunpeak-compile-{}.xml", std::process::id()));
    std::fs::write(&file, fabric.to_xml()).expect("writes");
    let file = file.display();
    let sky = "void brightfunc sky 2 skybr skybright.cal 0 7 1 10 3 .2 0 0 1\n";
    for (text, line, words) in [
        (
            format!("void aBSDF cloth 5 {file} 0 0 1 . 0 0\ncloth ring r 0 0 8 0 0 1 0 0 1 0 1\n"),
            2,
            "up vector [0, 0, 1] runs along",
        ),
        (format!("{sky}sky plastic p 0 0 5 1 1 1 0 0\np sphere s 0 0 4 0 0 0 1\n"), 2, "sky pattern"),
        ("void glass g 0 0 4 1 1 1 .9\ng sphere s 0 0 4 0 0 0 1\n".into(), 1, "index of refraction is 0.9"),
    ] {
        let message = refusal(&text);
        assert!(message.starts_with(&format!("room.rad:{line}")) && message.contains(words), "{message}");
    }
}

#[test]
fn too_many_surfaces_at_one_place_are_refused() {
    let one = "p polygon s 0 0 9 0 0 0 1 0 0 0 1 0\n".repeat(500);
    assert!(refusal(&format!("void plastic p 0 0 5 1 1 1 0 0\n{one}")).contains("same place"));
}

#[test]
fn what_is_nothing_is_nothing() {
    // A surface of void, one without area, a source that does not shine, and an empty scene.
    let text = "void sphere s 0 0 4 0 0 3 1\nvoid plastic p 0 0 5 1 1 1 0 0\n\
                p polygon line 0 0 9 0 0 0 1 1 1 2 2 2\np source dark 0 0 4 0 0 1 180\n";
    let world = world(text);
    assert_eq!(world.surface_count(), 0);
    assert_eq!(radiance(&world, Vec3::ZERO, Vec3::Z, &samples(1)), Vec3::ZERO);
    assert_eq!(self::world("").surface_count(), 0);
    assert_eq!(self::world("").distance(Vec3::ZERO, Vec3::X), None);
    assert_eq!(world.peak_rule(), PeakRule::Split);
}

#[test]
fn rays_that_are_none_are_refused() {
    let world = world(UNIFORM_SKY);
    for (point, along) in [(Vec3::NAN, Vec3::Z), (Vec3::ZERO, Vec3::ZERO), (Vec3::ZERO, Vec3::INFINITY)] {
        let control = sunpeak_core::Control::new();
        assert!(sunpeak_render::trace_radiance(&world, &[(point, along)], &samples(1), &control).is_err());
    }
}

#[test]
fn a_table_that_is_given_is_not_read() {
    let fabric = Fabric::default().tabulate(Basis::KlemsQuarter).expect("tabulates");
    let file = std::env::temp_dir().join(format!("sunpeak-given-{}.xml", std::process::id()));
    std::fs::write(&file, "not a table").expect("writes");
    let text =
        format!("void aBSDF cloth 5 {} 0 1 0 . 0 0\ncloth ring r 0 0 8 0 0 1 0 0 1 0 1\n", file.display());
    let scene = Scene::parse(&text, "room.rad", &LoadOptions::default()).expect("the scene parses");
    assert!(World::compile(&scene, &WorldOptions::default()).is_err());
    let options = WorldOptions { loaded: vec![(file, fabric.into())], ..Default::default() };
    assert_eq!(World::compile(&scene, &options).expect("compiles").surface_count(), 1);
}
