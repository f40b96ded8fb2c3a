//! What is known beforehand and where paths are guided changes no mean: random rooms against the plain path tracer.

use crate::testing::Random;
use crate::{RenderOptions, World, WorldOptions, trace_irradiance};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use sunpeak_bsdf::{
    Bsdf, PeakRule,
    synthetic::{Basis, Fabric},
};
use sunpeak_core::{Control, Vec3, luminance};
use sunpeak_scene::{LoadOptions, Scene};

const ROOMS: u64 = 20;
const RUNS: u64 = 16;

/// A closed box of 4 by 5 by 3 metres whose south side is a shade, a pane or both, under sun, sky and ground, sometimes with a
/// house before it.
fn room(random: &mut Random, folder: &Path) -> (String, Arc<Bsdf>, PeakRule) {
    let mut between = |low: f64, high: f64| low + (high - low) * random.next();
    let bases = [
        Basis::KlemsQuarter,
        Basis::KlemsFull,
        Basis::TensorTree3 { side: 16 },
        Basis::TensorTree4 { side: 8 },
    ];
    let basis = bases[between(0.0, 4.0) as usize];
    let fabric = Fabric { openness: between(0.01, 0.2), scattered: between(0.02, 0.3), ..Fabric::default() };
    let rule = if between(0.0, 1.0) < 0.5 { PeakRule::Split } else { PeakRule::Off };
    let sun = Vec3::new(between(-0.6, 0.6), -1.0, between(0.2, 1.0)).normalize();
    let (wall, sky, ground) = (between(0.2, 0.8), between(10.0, 60.0), between(2.0, 20.0));
    let kind = between(0.0, 4.0) as usize;
    let mut text = format!(
        "void plastic wall 0 0 5 {wall} {wall} {wall} 0 0\nvoid glass pane 0 0 3 .9 .92 .9\n\
         void {} cloth.xml 0 0 1 . 0 0\n\
         void light shine 0 0 3 1e6 1e6 1e6\nshine source sun 0 0 4 {} {} {} .533\n\
         void glow sky 0 0 4 {sky} {sky} {sky} 0\nsky source dome 0 0 4 0 0 1 180\n\
         void glow soil 0 0 4 {ground} {ground} {ground} 0\nsoil source ground 0 0 4 0 0 -1 180\n\
         wall polygon f 0 0 12 0 0 0 4 0 0 4 5 0 0 5 0\nwall polygon c 0 0 12 0 0 3 0 5 3 4 5 3 4 0 3\n\
         wall polygon l 0 0 12 0 0 0 0 5 0 0 5 3 0 0 3\nwall polygon r 0 0 12 4 0 0 4 0 3 4 5 3 4 5 0\n\
         wall polygon b 0 0 12 0 5 0 4 5 0 4 5 3 0 5 3\n",
        if rule == PeakRule::Off { "BSDF cloth 6 0" } else { "aBSDF cloth 5" },
        sun.x,
        sun.y,
        sun.z,
    );
    let mut side = |material: &str, y: f64| {
        text += &format!("{material} polygon {material} 0 0 12 4 {y} 0 0 {y} 0 0 {y} 3 4 {y} 3\n");
    };
    if kind != 3 {
        side("cloth", 0.0);
    }
    if kind != 0 {
        side("pane", -0.1);
    }
    if kind >= 1 {
        let (x, y, h) = (between(-6.0, 2.0), between(-9.0, -3.0), between(1.0, 6.0));
        text += &format!("!genbox wall house 5 2 {h} | xform -t {x} {} -1\n", y - 2.0);
    }
    std::fs::write(folder.join("cloth.xml"), "").expect("writes");
    (text, Arc::new(fabric.tabulate(basis).expect("tabulates")), rule)
}

/// Mean and standard error of the illuminance in units of radiance, by independent runs.
fn estimate(world: &World, sensors: &[(Vec3, Vec3)], samples: u32, seed: u64) -> Vec<(f64, f64)> {
    let one = |run| {
        let options = RenderOptions { samples: Some(samples), seed: seed + run, ..Default::default() };
        trace_irradiance(world, sensors, &options, &Control::new()).expect("traces").values
    };
    let runs: Vec<_> = (0..RUNS).map(one).collect();
    let of = |i: usize| {
        let values: Vec<f64> = runs.iter().map(|run| luminance(run[i])).collect();
        let mean = values.iter().sum::<f64>() / RUNS as f64;
        let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        (mean, (square / (RUNS * (RUNS - 1)) as f64).sqrt())
    };
    (0..sensors.len()).map(of).collect()
}

/// A room as it is, and without anything known beforehand.
fn worlds(text: &str, bsdf: Arc<Bsdf>, peak: PeakRule, folder: &Path) -> [World; 2] {
    let load = LoadOptions { cwd: Some(folder.to_path_buf()), ..LoadOptions::default() };
    let scene = Scene::parse(text, "room.rad", &load).expect("a room");
    let options = WorldOptions { peak, loaded: vec![(folder.join("cloth.xml"), bsdf)], ..Default::default() };
    let compile = || World::compile(&scene, &options).expect("compiles");
    let mut plain = compile();
    (plain.guide, plain.backlights, plain.sun_patches) = (None, Default::default(), None);
    [compile(), plain]
}

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("sunpeak-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn a_wall_in_the_plane_of_a_shade_is_not_lit_by_it() {
    let folder = folder("flush");
    let mut random = Random(3);
    for _ in 0..4 {
        let (text, bsdf, peak) = room(&mut random, &folder);
        // The room's front becomes a wall with the shade flush in it.
        let front = text.find("cloth polygon").or_else(|| text.find("pane polygon")).expect("a front");
        let y = -0.3_f64;
        let text = text[..front].to_owned()
            + &format!(
                "cloth polygon cloth 0 0 12 3 {y} 1 1 {y} 1 1 {y} 2.5 3 {y} 2.5\n\
                 wall polygon front 0 0 30 4 {y} 0 0 {y} 0 0 {y} 3 4 {y} 3 4 {y} 0 \
                 3 {y} 1 3 {y} 2.5 1 {y} 2.5 1 {y} 1 3 {y} 1\n"
            );
        let [world, plain] = worlds(&text, bsdf, peak, &folder);
        // In the plane, and as far from it as rounding puts points that rays meet.
        let sensors =
            [y, y.next_up(), y.next_down()].map(|y| (Vec3::new(0.5 + random.next() / 3.0, y, 1.7), Vec3::Y));
        let ours = estimate(&world, &sensors, 128, 1 << 20);
        let theirs = estimate(&plain, &sensors, 1024, 1 << 30);
        for (sensor, (a, b)) in ours.into_iter().zip(theirs).enumerate() {
            let error = a.1.hypot(b.1).hypot(0.002 * b.0);
            assert!((a.0 - b.0).abs() < 4.0 * error, "sensor {sensor}: {a:?}, plain {b:?}\n{text}");
        }
    }
}

/// A deep room behind a pane with a wing of another, two suns, a glossy floor, a box in the sun, and one that shades the pane.
const SUNNY: &str = "void plastic wall 0 0 5 .6 .5 .4 0 0\nvoid plastic floor 0 0 5 .3 .3 .3 .1 .15\n\
    void glass pane 0 0 3 .9 .92 .9\nvoid light shine 0 0 3 1e6 9e5 8e5\n\
    shine source sun 0 0 4 .3 -1 .6 .533\nshine source second 0 0 4 -.5 -1 .4 2\n\
    void glow sky 0 0 4 20 25 30 0\nsky source dome 0 0 4 0 0 1 180\n\
    floor polygon f 0 0 12 0 0 0 4 0 0 4 12 0 0 12 0\nwall polygon c 0 0 12 0 0 3 0 12 3 4 12 3 4 0 3\n\
    wall polygon l 0 0 12 0 0 0 0 12 0 0 12 3 0 0 3\nwall polygon r 0 0 12 4 0 0 4 0 3 4 12 3 4 12 0\n\
    wall polygon b 0 0 12 0 12 0 4 12 0 4 12 3 0 12 3\n\
    !genbox wall table 1 .8 .7 | xform -t 1 1 .01\n!genbox wall fin .1 1 3 | xform -t 2 -1.2 0\n\
    pane polygon front 0 0 12 4 0 0 0 0 0 0 0 3 4 0 3\npane polygon wing 0 0 12 3 .5 0 4 .5 0 4 .5 2 3 .5 2\n";

#[test]
fn ties_to_patches_of_sun_change_no_mean_and_bring_less_noise() {
    let folder = folder("sunny");
    let bsdf = Fabric::default().tabulate(Basis::KlemsQuarter).expect("tabulates");
    let [world, mut untied] = worlds(SUNNY, Arc::new(bsdf), PeakRule::Split, &folder);
    assert!(world.sun_patches.is_some());
    untied.guide = world.guide.clone();
    let sensors = [
        (Vec3::new(2.0, 10.0, 0.8), Vec3::Z),
        (Vec3::new(0.01, 6.0, 1.5), Vec3::X),
        (Vec3::new(2.0, 2.0, 2.99), -Vec3::Z),
        (Vec3::new(1.5, 1.4, 0.72), Vec3::Z),
    ];
    let ours = estimate(&world, &sensors, 512, 1 << 20);
    let theirs = estimate(&untied, &sensors, 4096, 1 << 30);
    let mut gain = 0.0;
    for (sensor, (a, b)) in ours.into_iter().zip(theirs).enumerate() {
        assert!((a.0 - b.0).abs() < 3.5 * a.1.hypot(b.1), "sensor {sensor}: {a:?}, without ties {b:?}");
        gain += (b.1 / a.1).powi(2) * 8.0 / 4.0;
    }
    assert!(gain > 1.4, "variance {gain:.1} times less");
}

#[test]
fn ties_are_left_out_where_little_sun_comes_in() {
    let folder = folder("shaded");
    let world = |text: &str| {
        let bsdf = Fabric { openness: 0.03, ..Fabric::default() }.tabulate(Basis::KlemsQuarter);
        let [world, _] = worlds(text, Arc::new(bsdf.expect("tabulates")), PeakRule::Split, &folder);
        world.sun_patches.is_some()
    };
    std::fs::write(folder.join("cloth.xml"), "").expect("writes");
    assert!(world(SUNNY));
    assert!(!world(&SUNNY.replace(" -1 .", " 1 .")), "suns behind the room");
    let cloth = "void aBSDF cloth 5 cloth.xml 0 0 1 . 0 0\n";
    assert!(!world(&(cloth.to_owned() + &SUNNY.replace("pane polygon", "cloth polygon"))), "fabric");
    let slats = "!genbox wall slat 4 .08 .002 | xform -rx 30 -t 0 .02 .02 -a 60 -t 0 0 .05";
    assert!(!world(&format!("{SUNNY}{slats}\n")), "slats");
}

#[test]
fn twenty_random_rooms_agree_with_plain_paths() {
    let folder = folder("rooms");
    let sensors = [
        (Vec3::new(2.0, 1.5, 0.01), Vec3::Z),
        (Vec3::new(0.01, 3.0, 1.5), Vec3::X),
        (Vec3::new(2.0, 4.0, 1.0), -Vec3::Y),
    ];
    let mut random = Random(11);
    let (mut sum, mut worst, mut gain) = (0.0, 0.0_f64, 0.0);
    for number in 0..ROOMS {
        let (text, bsdf, peak) = room(&mut random, &folder);
        let [world, plain] = worlds(&text, bsdf, peak, &folder);
        let ours = estimate(&world, &sensors, 128, 1 << 20);
        let theirs = estimate(&plain, &sensors, 1024, 1 << 30);
        for (sensor, (a, b)) in ours.into_iter().zip(theirs).enumerate() {
            // A fifth of a percent beside chance: the tables of far fields are quadratures.
            let error = a.1.hypot(b.1).hypot(0.002 * b.0);
            let deviation = (a.0 - b.0) / error;
            assert!(deviation.abs() < 4.0, "room {number}, sensor {sensor}: {a:?}, plain {b:?}\n{text}");
            worst = worst.max(deviation.abs());
            sum += deviation;
            gain += (b.1 / a.1).powi(2) * 8.0;
        }
    }
    let count = (ROOMS * 3) as f64;
    println!(
        "mean deviation {:.2}, worst {worst:.2} errors; variance a path {:.1} times less",
        sum / count,
        gain / count
    );
    // The sensors of a room share their random numbers: as good as one number a room, whose mean has an error of 1/sqrt(20).
    assert!((sum / count).abs() < 3.0 / (ROOMS as f64).sqrt(), "all lean to one side: {}", sum / count);
}
