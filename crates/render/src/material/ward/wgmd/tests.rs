use super::*;
use crate::material::Lobes;
use crate::testing::{chi_square_of_sampler, hemispherical_sum};
use std::f64::consts::PI;
use sunpeak_core::Sampler;
use sunpeak_scene::{LoadOptions, Material, ModifierKind, Scene};

/// Reflection and transmission as arguments; the rest is diffuse.
fn material(specular: &str) -> WgmdMaterial {
    let text = format!("void WGMDfunc m 13 {specular} void 1 .3 .2 . 0 9 .2 .1 .1 .1 .2 .3 .1 .2 .1");
    let scene = Scene::parse(&text, "t.rad", &LoadOptions::default()).expect("a scene");
    let ModifierKind::Material(Material::Wgmd(said)) = &scene.modifiers[0].kind else { panic!("WGMDfunc") };
    let modifiers = Modifiers {
        own: Vec::new(),
        reflection: Some(Vec::new()),
        transmission: None,
        diffuse_transmission: Some(Vec::new()),
    };
    WgmdMaterial::new(said, modifiers)
}

fn materials() -> Vec<WgmdMaterial> {
    ["void .2 .2 .3 void .3 .3 .15", "void .3 .1 .1 void .2 0 0", "void .3 0 0 void .2 .2*1 .1+.1*Px*Px"]
        .map(material)
        .into()
}

fn arrivals() -> impl Iterator<Item = Arrival> {
    let angles = [0.0_f64, 0.6, 1.2, 1.5, 2.2];
    angles.into_iter().map(|theta| {
        let direction = Vec3::new(theta.sin() * 0.6, theta.sin() * 0.8, -theta.cos());
        Arrival::new(Vec3::new(0.3, 0.0, 0.0), Vec3::Z, direction)
    })
}

fn lobes(material: &WgmdMaterial, arrival: &Arrival) -> WgmdLobes {
    match material.scatter(arrival).smooth {
        Smooth::Wgmd(lobes) => *lobes,
        other => panic!("{other:?}"),
    }
}

#[test]
fn samples_follow_the_density_and_weights_times_density_are_the_value() {
    for (i, material) in materials().iter().enumerate() {
        for arrival in arrivals() {
            let lobes = lobes(material, &arrival);
            let name = format!("{i} from {}", arrival.direction);
            chi_square_of_sampler(&name, |choice, u| lobes.sample_direction(choice, u), |d| lobes.pdf(d));
            let expected = hemispherical_sum(|d| lobes.evaluate(d).total());
            let count = 1 << 13;
            let mut mean = Rgb::ZERO;
            for sample in 0..count {
                let mut s = Sampler::new(3, 1, sample);
                if let Some(sample) = lobes.sample(s.next_1d(), s.next_2d()) {
                    mean += sample.weight.total() / count as f64;
                }
            }
            assert!((mean - expected).length() < 1e-2, "{name}: {mean} {expected}");
        }
    }
}

#[test]
fn nothing_gives_out_more_than_it_gets() {
    for (i, material) in materials().iter().enumerate() {
        for arrival in arrivals() {
            let s = material.scatter(&arrival);
            let sum = s.straight + s.mirrored + hemispherical_sum(|d| s.smooth.evaluate(d).total());
            assert!(sum.max_element() < 1.02, "{i} from {}: {sum}", arrival.direction);
        }
    }
}

#[test]
fn front_and_back_are_their_own_diffuse_colours_and_fresnel_takes_from_all() {
    let material = material("void .3 0 0 void .2 0 0");
    for (direction, diffuse) in [(-Vec3::Z, Rgb::new(0.2, 0.1, 0.1)), (Vec3::Z, Rgb::new(0.1, 0.2, 0.3))] {
        let arrival = Arrival::new(Vec3::ZERO, Vec3::Z, direction);
        let s = material.scatter(&arrival);
        assert!((s.smooth.evaluate(-direction).diffuse * PI - diffuse).length() < 1e-6);
        assert!((s.smooth.evaluate(direction).diffuse * PI - Rgb::new(0.1, 0.2, 0.1)).length() < 1e-6);
        assert!((s.straight.x - 0.2).abs() < 1e-6 && (s.mirrored.x - 0.3).abs() < 1e-6);
        assert!((material.straight(&arrival) - s.straight).length() < 1e-12);
    }
    // At grazing incidence Radiance's approximation is nearly all mirror.
    let grazing = Arrival::new(Vec3::ZERO, Vec3::Z, Vec3::new(1.0, 0.0, -1e-3).normalize());
    let s = material.scatter(&grazing);
    assert!(s.mirrored.x > 0.99 && s.straight.x < 0.01);
}

#[test]
fn a_texture_bends_one_component_alone() {
    let text = "void texfunc t 4 .2 0 0 . 0 0\nvoid WGMDfunc m 13 t .3 0 0 void 0 0 0 void 1 0 0 . 0 9 .2 .2 .2 0 0 0 0 0 0";
    let scene = Scene::parse(text, "t.rad", &LoadOptions::default()).expect("a scene");
    let ModifierKind::Texture(field) = &scene.modifiers[0].kind else { panic!("a texture") };
    let mut material = material("void .3 0 0 void 0 0 0");
    material.modifiers.reflection = Some(vec![Step::Texture(field.clone())]);
    let arrival = Arrival::new(Vec3::ZERO, Vec3::Z, -Vec3::Z);
    let s = material.scatter(&arrival);
    let (mirrored, _) = s.refracted[0].expect("its own direction");
    // The normal (0.2, 0, 1) turns the ray by twice its angle.
    let angle = 2.0 * 0.2_f64.atan();
    assert!((mirrored - Vec3::new(angle.sin(), 0.0, angle.cos())).length() < 1e-12);
    assert_eq!(s.mirrored, Rgb::ZERO);
    assert!((s.smooth.evaluate(Vec3::new(0.6, 0.0, 0.8)).diffuse.x * PI - 0.2).abs() < 2e-3);
}
