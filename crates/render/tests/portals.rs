//! Openings that the caller names: paths find the sky through them, and the numbers stay what they are.

mod common;

use common::*;
use sunpeak_core::{Control, Vec3, luminance};
use sunpeak_render::{World, WorldOptions, trace_irradiance};
use sunpeak_scene::{LoadOptions, Scene};

/// A room of 4 by 5 by 3 metres whose south wall has a hole of 2 by 1 metres, under an even sky.
const WALLS: &str = "void plastic wall 0 0 5 .5 .5 .5 0 0\nvoid glow bright 0 0 4 100 100 100 0\n\
     bright source sky 0 0 4 0 0 1 180\nbright source ground 0 0 4 0 0 -1 180\n\
     wall polygon f 0 0 12 0 0 0 4 0 0 4 5 0 0 5 0\nwall polygon c 0 0 12 0 0 3 0 5 3 4 5 3 4 0 3\n\
     wall polygon l 0 0 12 0 0 0 0 5 0 0 5 3 0 0 3\nwall polygon r 0 0 12 4 0 0 4 0 3 4 5 3 4 5 0\n\
     wall polygon b 0 0 12 0 5 0 4 5 0 4 5 3 0 5 3\n";
const FRONT: &str = "wall polygon front 0 0 30 0 0 0 0 0 3 4 0 3 4 0 0 0 0 0 1 0 1 3 0 1 3 0 2 1 0 2 1 0 1\n";
/// Around the same opening, without a hole.
const FRONT_IN_PIECES: &str = "wall polygon below 0 0 12 0 0 0 0 0 1 4 0 1 4 0 0\n\
     wall polygon above 0 0 12 0 0 2 0 0 3 4 0 3 4 0 2\nwall polygon left 0 0 12 0 0 1 0 0 2 1 0 2 1 0 1\n\
     wall polygon right 0 0 12 3 0 1 3 0 2 4 0 2 4 0 1\n";
const OPENING: &str = "polygon opening 0 0 12 1 0 1 1 0 2 3 0 2 3 0 1\n";

fn compiled(text: &str, portals: &[&str]) -> Result<World, String> {
    let scene = Scene::parse(text, "room.rad", &LoadOptions::default()).expect("the scene parses");
    let portals = portals.iter().map(|name| name.to_string()).collect();
    World::compile(&scene, &WorldOptions { portals, ..Default::default() }).map_err(|error| error.to_string())
}

/// Mean and standard error at a table deep in the room.
fn sensor(world: &World, paths: u32) -> (f64, f64) {
    let sensor = [(Vec3::new(2.0, 4.0, 0.8), Vec3::Z)];
    let traced = trace_irradiance(world, &sensor, &samples(paths), &Control::new()).expect("traces");
    (luminance(traced.values[0]), traced.standard_errors.expect("errors")[0])
}

#[test]
fn a_named_opening_is_found_sooner_and_is_no_brighter() {
    let text = format!("{WALLS}{FRONT_IN_PIECES}void {OPENING}");
    let (blind, blind_error) = sensor(&compiled(&text, &[]).expect("compiles"), 1 << 14);
    let (named, named_error) = sensor(&compiled(&text, &["opening"]).expect("compiles"), 1 << 14);
    assert!((blind - named).abs() < 3.5 * blind_error.hypot(named_error), "{blind} {named}");
    // Measured: a sixth to a quarter.
    assert!(named_error < 0.5 * blind_error, "{blind_error} {named_error}");
}

#[test]
fn a_hole_in_a_wall_is_found() {
    let paths = 1 << 14;
    let named = sensor(
        &compiled(&format!("{WALLS}{FRONT_IN_PIECES}void {OPENING}"), &["opening"]).expect("compiles"),
        paths,
    );
    let found = sensor(&compiled(&format!("{WALLS}{FRONT}"), &[]).expect("compiles"), paths);
    assert!((found.0 - named.0).abs() < 3.5 * found.1.hypot(named.1), "{found:?} {named:?}");
    assert!(found.1 < 1.3 * named.1, "{found:?} {named:?}");
}

#[test]
fn what_is_found_anyway_may_be_named() {
    let text = format!("{WALLS}{FRONT}void glass pane 0 0 3 .96 .96 .96\npane {OPENING}");
    let found = sensor(&compiled(&text, &[]).expect("compiles"), 256);
    for names in
        [&["opening"][..], &["pane"], &["opening", "opening"], &["opening", "pane"], &["pane", "opening"]]
    {
        assert_eq!(sensor(&compiled(&text, names).expect("compiles"), 256), found, "{names:?}");
    }
}

#[test]
fn a_window_is_found_over_terrain_that_hides_half_of_the_field() {
    let terrain = "wall polygon terrain 0 0 12 -20 -20 -.1 20 -20 -.1 20 20 -.1 -20 20 -.1\n";
    let opening = format!("void {OPENING}");
    for front in
        [format!("{FRONT}{opening}"), format!("{FRONT}void glass pane 0 0 3 .96 .96 .96\npane {OPENING}")]
    {
        let text = format!("{WALLS}{terrain}{front}");
        let [found, named] =
            [&[][..], &["opening"]].map(|names| sensor(&compiled(&text, names).expect("compiles"), 1 << 12));
        assert!((found.0 - named.0).abs() < 3.5 * found.1.hypot(named.1), "{found:?} {named:?}");
        assert!(found.1 < 1.3 * named.1, "{found:?} {named:?}");
    }
}

/// The terrain below the floor, cut out under the house; a wall far away with a panel in its hole, or set back. And the same without a hole.
#[test]
fn holes_that_lead_into_no_room_are_left_alone() {
    let room = format!("{WALLS}{FRONT}void glass pane 0 0 3 .96 .96 .96\npane {OPENING}");
    let terrain = ("-20 -20 -.2 20 -20 -.2 20 20 -.2 -20 20 -.2", "0 0 -.2 0 5 -.2 4 5 -.2 4 0 -.2", "");
    let panel = |y: f64| format!("wall polygon panel 0 0 12 -2 {y} 1 -2 {y} 3 2 {y} 3 2 {y} 1\n");
    let wall = ("-9 -12 -1 -9 -12 9 9 -12 9 9 -12 -1", "-2 -12 1 2 -12 1 2 -12 3 -2 -12 3");
    let cases = [terrain, (wall.0, wall.1, &panel(-12.0)), (wall.0, wall.1, &panel(-11.9))];
    for (outline, hole, more) in cases {
        let error = |vertices: &[&str]| {
            let numbers = vertices.join(" ");
            let count = numbers.split_whitespace().count();
            let text = format!("{room}wall polygon outside 0 0 {count} {numbers}\n{more}");
            let (value, error) = sensor(&compiled(&text, &[]).expect("compiles"), 1 << 12);
            error / value
        };
        let first = |corners: &'static str| corners.split_whitespace().take(3).collect::<Vec<_>>().join(" ");
        let (with_hole, whole) = (error(&[outline, &first(outline), hole, &first(hole)]), error(&[outline]));
        assert!(with_hole < 1.3 * whole, "{outline} {more}: {with_hole} {whole}");
    }
}

#[test]
fn refusals_say_what_to_name() {
    let many = "wall polygon piece 0 0 9 0 0 0 1 0 0 0 1 0\n".repeat(33);
    for (text, name, words) in [
        (WALLS.to_string(), "window", "no surface or modifier has this name"),
        (WALLS.to_string(), "sky", "no polygon or mesh"),
        (format!("{WALLS}{many}"), "piece", "33 triangles"),
    ] {
        let message = compiled(&text, &[name]).map(|_| ()).expect_err("is refused");
        assert!(message.contains(words), "{message}");
    }
}
