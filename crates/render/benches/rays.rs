//! Rays per second: of pictures, and by the bare hierarchy on the very same rays, in furnished rooms.
//!
//! `cargo bench -p sunpeak-render`. Beside criterion's times it prints rays and samples per second on one thread, and the
//! ratio of the two: what shading, sampling and light transport cost on top of finding surfaces. The rooms are a class of our own and,
//! where the shared material is, the furnished office in it (`$SUNPEAK_SHARED/data/scenes/frads-room`).

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::path::{Path, PathBuf};
use std::{fmt::Write, hint::black_box, time::Instant};
use sunpeak_core::{Control, Vec3};
use sunpeak_render::{RenderOptions, World, render_picture, trace_irradiance};
use sunpeak_scene::{LoadOptions, Scene, Source, View};

/// Sun, sky and ground.
const OUTSIDE: &str = "void light sunshine 0 0 3 6e6 6e6 5.5e6\nsunshine source sun 0 0 4 .2 -.7 .6 .533\n\
     void glow skyglow 0 0 4 60 70 90 0\nskyglow source sky 0 0 4 0 0 1 180\n\
     void glow groundglow 0 0 4 8 7 6 0\ngroundglow source ground 0 0 4 0 0 -1 180\n";

/// A room and an eye in it.
struct Room {
    name: &'static str,
    world: World,
    view: View,
}

impl Room {
    fn new(name: &'static str, scene: &Scene, view: &str) -> Self {
        let world = World::compile(scene, &Default::default()).expect("the room compiles");
        Self { name, world, view: View::parse(view).expect("a view") }
    }

    fn picture(&self, samples: u32) {
        let picture =
            render_picture(&self.world, &self.view, 128, 128, &one_thread(samples), &Control::new());
        black_box(picture.expect("renders"));
    }
}

/// A furnished office of other people's, if it is there.
fn office() -> Option<Room> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let shared = std::env::var_os("SUNPEAK_SHARED").map_or(beside, PathBuf::from);
    let folder = shared.join("data/scenes/frads-room");
    let Ok(view) = std::fs::read_to_string(folder.join("Resources/view1.vf")) else {
        println!("skipped: no furnished office in {} (set SUNPEAK_SHARED)", folder.display());
        return None;
    };
    let parts = ["walls", "ceiling", "floor", "windowframe", "extwalls", "ground", "desks"];
    let mut sources = vec![Source::File(folder.join("Objects/materials.mat"))];
    sources.extend(parts.map(|part| Source::File(folder.join(format!("Objects/{part}.rad")))));
    sources.push(Source::File(folder.join("Resources/ec60.rad")));
    sources.push(Source::Text { text: OUTSIDE.into(), name: "outside.rad".into(), directory: ".".into() });
    let options = LoadOptions { search_path: vec![folder], ..Default::default() };
    let scene = Scene::load_sources(&sources, &options).expect("the office loads");
    Some(Room::new("office", &scene, view.trim_start_matches("rvu")))
}

/// A room of 5 by 6 by 3 metres with a glazed front, and a class of tables, chairs and balls: some 3000 triangles.
fn class() -> Room {
    let mut text = String::from(
        "void plastic wall 0 0 5 .7 .7 .65 0 0\nvoid plastic floor 0 0 5 .3 .25 .2 .02 .05\n\
         void plastic wood 0 0 5 .5 .35 .2 .04 .1\nvoid metal steel 0 0 5 .6 .6 .6 .8 .2\n\
         void glass pane 0 0 3 .92 .94 .92\nvoid light tube 0 0 3 60 60 55\n\
         floor polygon f 0 0 12 0 0 0 5 0 0 5 6 0 0 6 0\nwall polygon c 0 0 12 0 0 3 0 6 3 5 6 3 5 0 3\n\
         wall polygon l 0 0 12 0 0 0 0 6 0 0 6 3 0 0 3\nwall polygon r 0 0 12 5 0 0 5 0 3 5 6 3 5 6 0\n\
         wall polygon b 0 0 12 0 6 0 5 6 0 5 6 3 0 6 3\n\
         wall polygon front 0 0 30 0 0 0 0 0 3 5 0 3 5 0 0 0 0 0 .5 0 .9 4.5 0 .9 4.5 0 2.6 .5 0 2.6 .5 0 .9\n\
         pane polygon w 0 0 12 .5 0 .9 4.5 0 .9 4.5 0 2.6 .5 0 2.6\n\
         tube polygon lamp 0 0 12 2 2 2.98 2 4 2.98 2.2 4 2.98 2.2 2 2.98\n",
    );
    text.push_str(OUTSIDE);
    for i in 0..6 {
        for j in 0..5 {
            let (x, y) = (0.3 + 0.75 * f64::from(i), 0.8 + f64::from(j));
            place(&mut text, &format!("{i}_{j}"), x, y);
        }
    }
    let scene = Scene::parse(&text, "room.rad", &LoadOptions::default()).expect("the room parses");
    Room::new("class", &scene, "-vta -vp 2.5 5.5 1.2 -vd 0 -1 0 -vu 0 0 1 -vh 180 -vv 180")
}

/// A table, a chair and a ball.
fn place(text: &mut String, name: &str, x: f64, y: f64) {
    let mut block = |part: &str, material: &str, [w, d, h]: [f64; 3], [dx, dy, z]: [f64; 3]| {
        let at = format!("{} {} {z}", x + dx, y + dy);
        writeln!(text, "!genbox {material} {part}{name} {w} {d} {h} | xform -t {at}").expect("writes");
    };
    block("top", "wood", [0.6, 0.5, 0.03], [0.0, 0.0, 0.7]);
    for (i, (dx, dy)) in [(0.0, 0.0), (0.56, 0.0), (0.0, 0.46), (0.56, 0.46)].into_iter().enumerate() {
        block(&format!("leg{i}"), "steel", [0.04, 0.04, 0.7], [dx, dy, 0.0]);
    }
    block("seat", "wood", [0.4, 0.4, 0.04], [0.1, 0.55, 0.42]);
    block("back", "wood", [0.4, 0.03, 0.4], [0.1, 0.92, 0.46]);
    writeln!(text, "steel sphere ball{name} 0 0 4 {} {} 0.8 0.07", x + 0.3, y + 0.25).expect("writes");
}

fn one_thread(samples: u32) -> RenderOptions {
    RenderOptions { samples: Some(samples), threads: Some(1), ..Default::default() }
}

fn bench(c: &mut Criterion) {
    let rooms: Vec<Room> = std::iter::once(class()).chain(office()).collect();
    for room in &rooms {
        let rays = room.world.recorded_rays(|| room.picture(1));
        let mut group = c.benchmark_group(room.name);
        group.sample_size(20);
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function("bare rays", |b| b.iter(|| black_box(room.world.trace_again(&rays))));
        group.bench_function("picture", |b| b.iter(|| room.picture(1)));
        group.finish();
    }
    let room = &rooms[0];
    let sensors: Vec<_> = (0..100).map(|i| (Vec3::new(0.05 * f64::from(i), 3.0, 0.75), Vec3::Z)).collect();
    let mut group = c.benchmark_group(room.name);
    group.throughput(Throughput::Elements(100 * 256));
    group.bench_function("sensor samples", |b| {
        b.iter(|| {
            trace_irradiance(&room.world, &sensors, &one_thread(256), &Control::new()).expect("traces")
        });
    });
    group.finish();
    report(&rooms);
}

/// Rays and samples per second, and their ratio; the two in turn, of seven rounds the median.
fn report(rooms: &[Room]) {
    let time = |f: &mut dyn FnMut()| {
        let start = Instant::now();
        f();
        start.elapsed().as_secs_f64()
    };
    println!("\npictures on one thread [M/s]; theirs: the bare hierarchy on the same rays");
    println!("{:<32} {:>10} {:>12} {:>8}", "name", "ours", "theirs", "ratio");
    for room in rooms {
        let rays = room.world.recorded_rays(|| room.picture(1));
        let mut rounds = [(); 7].map(|()| {
            let bare = time(&mut || {
                black_box(room.world.trace_again(&rays));
            });
            (time(&mut || room.picture(1)), bare)
        });
        rounds.sort_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)));
        let (picture, bare) = rounds[rounds.len() / 2];
        let millions = rays.len() as f64 / 1e6;
        let (ours, theirs, name) = (millions / picture, millions / bare, room.name);
        println!("{:<32} {ours:>10.3} {theirs:>12.3} {:>8.2}", format!("rays, {name}"), ours / theirs);
        let samples = 128.0 * 128.0 / 1e6 / picture;
        println!("{:<32} {samples:>10.3} {:>12} {:>8}", format!("samples, {name}"), "-", "-");
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
