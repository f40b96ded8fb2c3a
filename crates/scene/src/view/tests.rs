//! Closed forms and round trips; agreement with Radiance's `vwrays` is tested from Python.

use super::*;
use std::f64::consts::PI;

fn view(options: &str) -> View {
    View::parse(options).expect(options)
}

fn total_solid_angle(options: &str, width: usize, height: usize) -> f64 {
    Camera::new(&view(options)).expect(options).solid_angles(width, height).iter().sum()
}

fn assert_close(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value - expected).abs() <= tolerance * expected.abs(), "{what}: {value}, expected {expected}");
}

#[test]
fn whole_views_have_the_solid_angle_of_their_shape() {
    // A square pyramid: 4 asin(sin(a/2) sin(b/2)).
    let pyramid = 4.0 * (30.0_f64.to_radians().sin() * 20.0_f64.to_radians().sin()).asin();
    let band = 2.0 * PI * 2.0 * 30.0_f64.to_radians().sin();
    for (options, expected) in [
        ("-vtv -vh 60 -vv 40", pyramid),
        ("-vth -vh 180 -vv 180", 2.0 * PI),
        ("-vta -vh 360 -vv 360", 4.0 * PI),
        ("-vtc -vh 360 -vv 60", band),
    ] {
        for (width, height) in [(1, 1), (2, 3), (7, 5), (97, 101)] {
            let total = total_solid_angle(options, width, height);
            assert_close(total, expected, 1e-12, &format!("{options} {width} x {height}"));
        }
    }
    assert_eq!(total_solid_angle("-vtl -vh 2 -vv 2", 4, 4), 0.0);
}

/// The solid angle of a small pixel is that of the parallelogram of its rays.
#[test]
fn pixels_have_the_solid_angle_between_their_rays() {
    for options in [
        "-vtv -vh 100 -vv 80 -vs .3 -vl -.2",
        "-vta -vh 180 -vv 180",
        "-vta -vh 360 -vv 200 -vs .1",
        "-vth -vh 180 -vv 180",
        "-vts -vh 200 -vv 150 -vl .4",
        "-vtc -vh 300 -vv 90 -vs .2 -vl .3",
    ] {
        let view = view(options);
        let n = 2000;
        for (column, row) in [(1000, 1000), (700, 1200), (1500, 900), (1300, 1390)] {
            let corner = |dx: usize, dy: usize| {
                let (x, y) = ((column + dx) as f64 / n as f64, 1.0 - (row + dy) as f64 / n as f64);
                view.ray(x, y).expect(options).direction
            };
            let area = 0.5 * (corner(1, 1) - corner(0, 0)).cross(corner(1, 0) - corner(0, 1)).length();
            assert_close(view.pixel_solid_angle(column, row, n, n), area, 1e-5, options);
        }
    }
}

/// Rim pixels of circles are cut: compare with counting.
#[test]
fn rim_pixels_count_as_far_as_the_view_reaches() {
    let view = view("-vth -vh 180 -vv 180");
    let (n, points) = (16, 2000);
    let density = |x: f64, y: f64| {
        let (u, v) = (2.0 * x - 1.0, 2.0 * y - 1.0);
        4.0 / (1.0 - u * u - v * v).sqrt()
    };
    for (column, row) in [(2, 2), (1, 3), (5, 0)] {
        let mut sum = 0.0;
        for (i, j) in (0..points).flat_map(|i| (0..points).map(move |j| (i, j))) {
            let place = |cell: usize, i: usize| (cell as f64 + (i as f64 + 0.5) / points as f64) / n as f64;
            let value = density(place(column, i), 1.0 - place(row, j));
            sum += if value.is_finite() { value } else { 0.0 };
        }
        let counted = sum / (points * points * n * n) as f64;
        assert_close(view.pixel_solid_angle(column, row, n, n), counted, 1e-3, "rim");
    }
}

#[test]
fn projection_is_the_inverse_of_rays() {
    for options in [
        "-vtv -vp 1 2 3 -vd 1 2 -.5 -vu .1 0 1 -vh 70 -vv 30 -vs .3 -vo 2",
        "-vta -vd 0 0 -3 -vu 0 1 0 -vh 250 -vv 180 -vl -.2",
        "-vth -vd 1 1 0 -vh 120 -vv 90 -vs .1",
        "-vts -vd -1 0 0 -vh 200 -vv 330",
        "-vtc -vd -1 0 0 -vh 270 -vv 60 -vs .4 -vl .1",
    ] {
        let view = view(options);
        for (x, y) in [(0.5, 0.5), (0.1, 0.9), (0.77, 0.31), (0.95, 0.05)] {
            let Some(ray) = view.ray(x, y) else { continue };
            let [px, py] = view.project(ray.direction * 3.0).expect(options);
            assert!((px - x).abs() < 1e-12 && (py - y).abs() < 1e-12, "{options}: {x} {y} -> {px} {py}");
        }
    }
    let parallel = view("-vtl -vp 1 2 3 -vd 1 0 0 -vh 4 -vv 2 -vs .25");
    let ray = parallel.ray(0.2, 0.7).expect("a ray");
    let [x, y] = parallel.project(ray.origin + 9.0 * ray.direction).expect("a place");
    assert!((x - 0.2).abs() < 1e-12 && (y - 0.7).abs() < 1e-12);
    // Behind a perspective, beyond a hemisphere, straight behind a planisphere.
    for kind in ["-vtv", "-vth", "-vts"] {
        assert_eq!(view(&format!("{kind} -vh 90 -vv 90")).project(-Vec3::Y), None, "{kind}");
    }
}

#[test]
fn clipping_planes_bound_rays() {
    let view = view("-vtv -vd 1 0 0 -vh 90 -vv 90 -vo 2 -va 5");
    let ray = view.ray(1.0, 0.5).expect("a ray");
    assert!((ray.origin.x - 2.0).abs() < 1e-12);
    let end = ray.origin + ray.max_distance * ray.direction;
    assert!((end.x - 5.0).abs() < 1e-12, "{end}");
}

#[test]
fn option_strings_round_trip_and_the_last_line_of_a_header_counts() {
    let text =
        "-vts -vp 1.5 -2e-7 3 -vd 0.25 1 0 -vu 0 0.1 1 -vh 60.125 -vv 33 -vo 0.5 -va 9 -vs 0.25 -vl -0.125";
    let parsed = view(text);
    assert_eq!(view(&parsed.to_string()), parsed);
    let mut read = View::default();
    assert!(apply_header_line(&mut read, "/usr/bin/rpict -x 800 -vf no.vf -vtl -vp 1 2 x -vh 3 room.oct"));
    assert!(apply_header_line(&mut read, "VIEW= -vta -vv 7"));
    assert!(!apply_header_line(&mut read, "\tVIEW= -vtc"));
    assert!(!apply_header_line(&mut read, "pfilt -x 2 -vtc"));
    let expected =
        View { kind: ViewKind::AngularFisheye, horizontal_deg: 3.0, vertical_deg: 7.0, ..View::default() };
    assert_eq!(read, expected);
}

#[test]
fn views_that_cannot_be_used_say_why() {
    for (options, expected) in [
        ("-vtv -vh 0", "the size -vh of a view -vtv is 0 degrees: expected more than 0, up to 180 degrees"),
        ("-vtv -vv 180", "the size -vv of a view -vtv is 180 degrees"),
        ("-vth -vh 181 -vv 180", "-vh of a view -vth is 181"),
        ("-vtl -vv -2", "-vv of a view -vtl is -2 m"),
        ("-vd 0 0 1", "the up vector -vu is parallel to the direction"),
        ("-vd 0 0 0", "the direction -vd is zero"),
        ("-vu 0 0 0", "the up vector -vu is zero"),
        ("-vo 3 -va 2", "expected 0 or more, and the aft plane behind the fore"),
        ("-vh nan", "expected a number after -vh, found \"nan\""),
        ("-vp 1 2", "expected a number after -vp, found the end"),
        ("-vtx", "unknown view type -vtx"),
        ("-q 3", "unknown view option \"-q\""),
    ] {
        let message = View::parse(options).expect_err(options).to_string();
        assert!(message.contains(expected), "{options}: {message}");
    }
}

#[test]
fn pictures_with_square_pixels_fit_into_the_size() {
    assert_eq!(view("-vta -vh 180 -vv 180").fit_size(800, 500), (500, 500));
    // tan 22.5 / tan 30 of the width.
    assert_eq!(view("-vtv -vh 60 -vv 45").fit_size(800, 800), (800, 574));
    assert_eq!(view("-vtl -vh 1 -vv 4000").fit_size(100, 100), (1, 100));
}
