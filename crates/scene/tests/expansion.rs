//! Commands done inside make what Radiance's programs print: our own scene against the recorded output of `xform -e`.

use std::path::{Path, PathBuf};
use sunpeak_scene::{LoadOptions, Source, load_primitives, raw::Primitive};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

fn in_folder(folder: &str, file: &str) -> Vec<Primitive> {
    let options = LoadOptions { cwd: Some(data().join(folder)), ..LoadOptions::default() };
    load_primitives(&[Source::File(PathBuf::from(file))], &options).expect("a scene")
}

/// Radiance prints 12 digits of geometry, and 6 of what scales with a power.
fn digits(kind: &str) -> f64 {
    if matches!(kind, "dielectric" | "interface" | "mist") { 1e-5 } else { 2e-11 }
}

#[test]
fn expansion_equals_that_of_radiance() {
    let (ours, theirs) = (in_folder("stress", "all.rad"), in_folder("", "stress-expanded.txt"));
    assert_eq!(ours.len(), theirs.len());
    for (ours, theirs) in ours.iter().zip(&theirs) {
        let words = |p: &Primitive| (p.modifier.clone(), p.kind.name, p.name.clone(), p.strings.clone());
        assert_eq!(words(ours), words(theirs));
        assert_eq!(ours.reals.len(), theirs.reals.len(), "{}", ours.name);
        let size = theirs.reals.iter().fold(1.0, |size: f64, real| size.max(real.abs()));
        for (a, b) in ours.reals.iter().zip(&theirs.reals) {
            assert!((a - b).abs() <= digits(ours.kind.name) * size, "{}: {a}, expected {b}", ours.name);
        }
    }
}

#[test]
fn rounded_boxes_are_closed() {
    // The faces of a closed surface add up to no vector, and enclose the volume of a rounded box up to its facets.
    let text = "!genbox m b 2 3 4 -r .5 -n 64";
    let options = LoadOptions::default();
    let faces = load_primitives(&[Source::File(PathBuf::from(text))], &options).expect("a box");
    let (mut area, mut volume) = (glam::DVec3::ZERO, 0.0);
    for face in &faces {
        let points: Vec<_> = face.reals.chunks(3).map(glam::DVec3::from_slice).collect();
        for i in 2..points.len() {
            area += 0.5 * (points[i - 1] - points[0]).cross(points[i] - points[0]);
            volume += points[0].dot(points[i - 1].cross(points[i])) / 6.0;
        }
    }
    let (r, pi) = (0.5, std::f64::consts::PI);
    let inner = [2.0 - 2.0 * r, 3.0 - 2.0 * r, 4.0 - 2.0 * r];
    let [a, b, c] = inner;
    let expected =
        a * b * c + 2.0 * r * (a * b + b * c + c * a) + pi * r * r * (a + b + c) + 4.0 / 3.0 * pi * r * r * r;
    assert!(area.length() < 1e-12, "{area}");
    assert!((volume / expected - 1.0).abs() < 1e-3, "{volume} {expected}");
}
