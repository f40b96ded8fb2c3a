//! What cannot be rendered is refused with its place in the file; what is nothing in Radiance is nothing here.

mod common;

use common::*;
use sunpeak_bsdf::{
    PeakRule,
    synthetic::{Basis, Fabric},
};
use sunpeak_core::{Control, Vec3};
use sunpeak_render::{World, WorldOptions, trace_radiance};
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
    for (text, line, words) in [
        (
            format!("void aBSDF cloth 5 {file} 0 0 1 . 0 0\ncloth ring r 0 0 8 0 0 1 0 0 1 0 1\n"),
            2,
            "up vector [0, 0, 1] runs along",
        ),
        ("void glass g 0 0 4 1 1 1 .9\ng sphere s 0 0 4 0 0 0 1\n".into(), 1, "index of refraction is 0.9"),
    ] {
        let message = refusal(&text);
        assert!(message.starts_with(&format!("room.rad:{line}")) && message.contains(words), "{message}");
    }
}

#[test]
fn an_endless_expression_is_a_message() {
    let text = "void brightfunc f 2 turbulence(Px,Py,Pz,1e-5)+g(Px) f.cal 0 0\n";
    assert!(
        Scene::parse(
            &format!("{text}f glow g 0 0 4 1 1 1 0\ng sphere s 0 0 4 0 0 0 1\n"),
            "room.rad",
            &Default::default()
        )
        .expect_err("no function file")
        .to_string()
        .contains("looked for f.cal")
    );
    let folder = std::env::temp_dir().join(format!("sunpeak-endless-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("f.cal"), "g(x) = g(x + 1) + 1; h(n) = if(n, h(n-1) + h(n-1), Px);")
        .expect("writes");
    for (expression, material) in [("g(Px)", "glow g 0 0 4 1 1 1 0"), ("h(100)", "plastic g 0 0 5 1 1 1 0 0")]
    {
        let text =
            format!("\nvoid brightfunc f 2 {expression} f.cal 0 0\nf {material}\ng sphere s 0 0 4 0 0 3 1\n");
        let options = sunpeak_scene::LoadOptions { cwd: Some(folder.clone()), ..Default::default() };
        let scene = Scene::parse(&text, "room.rad", &options).expect("a scene");
        let world = World::compile(&scene, &WorldOptions::default()).expect("a world");
        let rays = vec![(Vec3::ZERO, Vec3::Z); 100];
        let error = trace_radiance(&world, &rays, &samples(4), &Control::new()).expect_err("a fault");
        assert!(error.to_string().starts_with("room.rad:2:1: brightfunc \"f\": "), "{error}");
    }
    std::fs::remove_dir_all(folder).expect("a folder");
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
    assert_eq!(radiance(&self::world(""), Vec3::ZERO, Vec3::X, &samples(1)), Vec3::ZERO);
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
