//! Rays per second: the bare hierarchy, and whole paths in a small room with a glazed window, sun, sky and a lamp.
//!
//! `cargo bench -p sunpeak-render`. Beside criterion's times it prints rays and samples per second on one thread, and the
//! ratio of the two: what shading, sampling and light transport cost on top of finding surfaces.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::{fmt::Write, hint::black_box, time::Instant};
use sunpeak_core::{Control, Sampler, Vec3, warp};
use sunpeak_render::{RenderOptions, World, render_picture, trace_irradiance};
use sunpeak_scene::{LoadOptions, Scene, View};

/// A room of 5 by 6 by 3 metres with a glazed front, and a class of tables, chairs and balls: some 3000 triangles.
fn room() -> World {
    let mut text = String::from(
        "void plastic wall 0 0 5 .7 .7 .65 0 0\nvoid plastic floor 0 0 5 .3 .25 .2 .02 .05\n\
         void plastic wood 0 0 5 .5 .35 .2 .04 .1\nvoid metal steel 0 0 5 .6 .6 .6 .8 .2\n\
         void glass pane 0 0 3 .92 .94 .92\nvoid light tube 0 0 3 60 60 55\n\
         void light sunshine 0 0 3 6e6 6e6 5.5e6\nsunshine source sun 0 0 4 .2 -.7 .6 .533\n\
         void glow skyglow 0 0 4 60 70 90 0\nskyglow source sky 0 0 4 0 0 1 180\n\
         void glow groundglow 0 0 4 8 7 6 0\ngroundglow source ground 0 0 4 0 0 -1 180\n\
         floor polygon f 0 0 12 0 0 0 5 0 0 5 6 0 0 6 0\nwall polygon c 0 0 12 0 0 3 0 6 3 5 6 3 5 0 3\n\
         wall polygon l 0 0 12 0 0 0 0 6 0 0 6 3 0 0 3\nwall polygon r 0 0 12 5 0 0 5 0 3 5 6 3 5 6 0\n\
         wall polygon b 0 0 12 0 6 0 5 6 0 5 6 3 0 6 3\n\
         wall polygon front 0 0 30 0 0 0 0 0 3 5 0 3 5 0 0 0 0 0 .5 0 .9 4.5 0 .9 4.5 0 2.6 .5 0 2.6 .5 0 .9\n\
         pane polygon w 0 0 12 .5 0 .9 4.5 0 .9 4.5 0 2.6 .5 0 2.6\n\
         tube polygon lamp 0 0 12 2 2 2.98 2 4 2.98 2.2 4 2.98 2.2 2 2.98\n",
    );
    for i in 0..6 {
        for j in 0..5 {
            let (x, y) = (0.3 + 0.75 * f64::from(i), 0.8 + f64::from(j));
            place(&mut text, &format!("{i}_{j}"), x, y);
        }
    }
    let scene = Scene::parse(&text, "room.rad", &LoadOptions::default()).expect("the room parses");
    World::compile(&scene, &Default::default()).expect("the room compiles")
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

/// Rays from random points of the room in random directions.
fn incoherent_rays(count: u64) -> Vec<(Vec3, Vec3)> {
    let one = |i| {
        let mut s = Sampler::new(3, i, 0);
        let origin = Vec3::new(5.0 * s.next_1d(), 6.0 * s.next_1d(), 3.0 * s.next_1d());
        (origin, warp::uniform_sphere(s.next_2d()))
    };
    (0..count).map(one).collect()
}

fn one_thread(samples: u32) -> RenderOptions {
    RenderOptions { samples: Some(samples), threads: Some(1), ..Default::default() }
}

fn view() -> View {
    View::parse("-vta -vp 2.5 5.5 1.2 -vd 0 -1 0 -vu 0 0 1 -vh 180 -vv 180").expect("a view")
}

fn bench(c: &mut Criterion) {
    let world = room();
    let rays = incoherent_rays(100_000);
    let mut group = c.benchmark_group("room");
    group.sample_size(20);
    group.throughput(Throughput::Elements(rays.len() as u64));
    group.bench_function("bare rays", |b| b.iter(|| trace_all(&world, &rays)));
    group.throughput(Throughput::Elements(128 * 128 * 4));
    group.bench_function("picture samples", |b| b.iter(|| picture(&world)));
    let sensors: Vec<_> = (0..100).map(|i| (Vec3::new(0.05 * f64::from(i), 3.0, 0.75), Vec3::Z)).collect();
    group.throughput(Throughput::Elements(100 * 256));
    group.bench_function("sensor samples", |b| {
        b.iter(|| trace_irradiance(&world, &sensors, &one_thread(256), &Control::new()).expect("traces"));
    });
    group.finish();
    report(&world, &rays);
}

fn trace_all(world: &World, rays: &[(Vec3, Vec3)]) -> f64 {
    rays.iter().filter_map(|&(o, d)| world.distance(o, black_box(d))).sum()
}

fn picture(world: &World) {
    let picture = render_picture(world, &view(), 128, 128, &one_thread(4), &Control::new());
    black_box(picture.expect("renders"));
}

/// Rays and samples per second, and their ratio.
fn report(world: &World, rays: &[(Vec3, Vec3)]) {
    let time = |f: &mut dyn FnMut()| {
        let start = Instant::now();
        (0..10).for_each(|_| f());
        start.elapsed().as_secs_f64() / 10.0
    };
    let bare = rays.len() as f64
        / time(&mut || {
            black_box(trace_all(world, rays));
        });
    let before = world.rays_traced();
    let seconds = time(&mut || picture(world));
    let traced = (world.rays_traced() - before) as f64 / 10.0 / seconds;
    let samples = f64::from(128 * 128 * 4) / seconds;
    println!(
        "\nroom of {} surfaces, one thread [M/s]; theirs: rays of the bare hierarchy",
        world.surface_count()
    );
    println!("{:<32} {:>10} {:>12} {:>8}", "name", "ours", "theirs", "ratio");
    for (name, rate) in [("rays of a picture", traced), ("samples of a picture", samples)] {
        println!("{name:<32} {:>10.3} {:>12.3} {:>8.2}", rate / 1e6, bare / 1e6, rate / bare);
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
