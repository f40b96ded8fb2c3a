//! Pictures in and out. That values equal those of Radiance's `pvalue` is tested from Python.

use super::*;
use crate::ViewKind;

fn with_pixels(size_line: &str, header: &str, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\n{header}\n{size_line}\n").into_bytes();
    pixels.iter().for_each(|pixel| bytes.extend_from_slice(pixel));
    bytes
}

fn decode(bytes: &[u8]) -> Picture {
    Picture::decode(bytes, "test.hdr").expect("a picture")
}

fn message(bytes: &[u8]) -> String {
    Picture::decode(bytes, "test.hdr").expect_err("an error").to_string()
}

/// A picture with flat areas, gradients and noise.
fn sample(width: usize, height: usize) -> Picture {
    let mut picture = Picture::new(width, height);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        let (x, y) = (i % width, i / width);
        let noise = ((i * 7919) % 1009) as f32 / 1009.0;
        *pixel = match y % 3 {
            0 => [0.5, 0.25, 1.0],
            1 => [x as f32, 0.0, 1e-3 * x as f32],
            _ => [noise, noise * 1e6, 1e-9],
        };
    }
    picture
}

#[test]
fn what_is_written_is_read() {
    for (width, height) in [(1, 1), (7, 3), (8, 2), (300, 20), (40_000, 3)] {
        let mut picture = sample(width, height);
        picture.header = vec!["SOFTWARE= Sunpeak".into(), "PIXASPECT=1.5".into()];
        picture.view = Some(View { kind: ViewKind::AngularFisheye, shift: 0.1, ..View::default() });
        picture.exact_sources = vec![ExactSource {
            direction: Vec3::new(0.1, -0.7, 0.3).normalize(),
            solid_angle_sr: 6.8e-5,
            radiance: Rgb::new(1.234_567_890_123e6, 2.0, 1.0 / 3.0),
            visible_fraction: 0.875,
        }];
        let back = decode(&picture.encode().expect("bytes"));
        assert_eq!((back.width, back.height, &back.header), (width, height, &picture.header));
        assert_eq!((&back.view, &back.exact_sources), (&picture.view, &picture.exact_sources));
        for (a, b) in picture.pixels.iter().zip(&back.pixels) {
            // Half a step of 1/128 of the largest channel.
            let tolerance = a.iter().fold(0.0, |m: f32, v| m.max(*v)) * 0.5 / 128.0;
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{a:?} {b:?}");
        }
        // A second time nothing changes.
        assert_eq!(decode(&back.encode().expect("bytes")).pixels, back.pixels);
    }
}

#[test]
fn values_that_a_pixel_cannot_hold_are_bounded() {
    let mut picture = Picture::new(3, 1);
    picture.pixels = vec![[f32::NAN, -1.0, 2.0], [f32::INFINITY, 0.0, 0.0], [1e-40, 0.0, 0.0]];
    let back = decode(&picture.encode().expect("bytes"));
    assert!(back.pixels[0][0] < 0.01 && back.pixels[0][1] < 0.01 && (back.pixels[0][2] - 2.0).abs() < 0.01);
    assert!(back.pixels[1][0] > 1e38 && back.pixels[1][0].is_finite());
    assert_eq!(back.pixels[2], [0.0; 3]);
}

/// Exponent 136 makes a mantissa m stand for m + 0.5.
fn gray(mantissa: u8) -> [u8; 4] {
    [mantissa, mantissa, mantissa, 136]
}

#[test]
fn all_orientations_come_out_upright() {
    // Upright, 2 wide and 3 high: 1 2 / 3 4 / 5 6.
    for (size, order) in [
        ("-Y 3 +X 2", [1, 2, 3, 4, 5, 6]),
        ("-Y 3 -X 2", [2, 1, 4, 3, 6, 5]),
        ("+Y 3 +X 2", [5, 6, 3, 4, 1, 2]),
        ("+Y 3 -X 2", [6, 5, 4, 3, 2, 1]),
        ("+X 2 -Y 3", [1, 3, 5, 2, 4, 6]),
        ("+X 2 +Y 3", [5, 3, 1, 6, 4, 2]),
        ("-X 2 -Y 3", [2, 4, 6, 1, 3, 5]),
        ("-X 2 +Y 3", [6, 4, 2, 5, 3, 1]),
    ] {
        let picture = decode(&with_pixels(size, "", &order.map(|n| gray(10 * n))));
        let values: Vec<f32> = picture.pixels.iter().map(|pixel| pixel[0]).collect();
        assert_eq!((picture.width, picture.height), (2, 3), "{size}");
        assert_eq!(values, [10.5, 20.5, 30.5, 40.5, 50.5, 60.5], "{size}");
    }
}

#[test]
fn old_runs_repeat_and_count_on() {
    // 10, then three times, then 256 times (with one more from the low byte), then 20.
    let pixels = [gray(10), [1, 1, 1, 1], [1, 1, 1, 1], gray(20)];
    let picture = decode(&with_pixels("-Y 1 +X 259", "", &pixels));
    assert_eq!(picture.pixels[257][0], 10.5);
    assert_eq!(picture.pixels[258][0], 20.5);
}

#[test]
fn exposures_multiply_and_are_undone() {
    let header = "EXPOSURE=2\nEXPOSURE= 4\nCOLORCORR= 1 2 .5\nPRIMARIES= x\n";
    let picture = decode(&with_pixels("-Y 1 +X 1", header, &[gray(100)]));
    assert_eq!(picture.pixels[0], [100.5 / 8.0, 100.5 / 16.0, 100.5 / 4.0]);
    assert_eq!(picture.header, ["PRIMARIES= x"]);
}

#[test]
fn xyz_is_in_candelas() {
    // X = Y = Z is white: 179 cd/m² is one watt.
    let picture = decode(&with_pixels("-Y 1 +X 1", "FORMAT=32-bit_rle_xyze\n", &[gray(178)]));
    let expected = 178.5 / 179.0;
    assert!(picture.pixels[0].iter().all(|value| (value - expected).abs() < 1e-5), "{:?}", picture.pixels);
    assert!((picture.luminance()[0] - 178.5).abs() < 1e-3);
}

#[test]
fn lines_that_would_break_a_header_are_not_written() {
    let mut picture = sample(8, 1);
    picture.header =
        ["a\n\nFORMAT=other\nb", "", "EXPOSURE=3", "#?x", "VIEW= -vtl"].map(String::from).to_vec();
    let back = decode(&picture.encode().expect("bytes"));
    assert_eq!((back.header, back.view), (vec!["a".into(), "b".into()], None));
}

#[test]
fn broken_files_say_where() {
    let whole = sample(300, 20).encode().expect("bytes");
    let cases: [(&[u8], &str); 8] = [
        (b"P6 3 3", "test.hdr: not a Radiance picture"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "test.hdr:2: the file ends in its header"),
        (b"#?RADIANCE\nFORMAT=Radiance_spectra\n\n", "test.hdr:2: the format Radiance_spectra"),
        (b"#?RADIANCE\nEXPOSURE=0\n\n", "test.hdr:2: expected a positive number"),
        (b"#?RADIANCE\nSUNPEAK_SOURCE= 1 0 0 nan\n\n", "expected dx dy dz solid_angle_sr"),
        (b"#?RADIANCE\n\n-Y 0 +X 3\n", "test.hdr:3: expected the picture's size"),
        (b"#?RADIANCE\n\n-Y 3 +X 99999999999\n", "row 1 of 3: the file ends too early"),
        (&whole[..whole.len() - 9], "row 20 of 20: the file ends too early"),
    ];
    for (bytes, expected) in cases {
        let message = message(bytes);
        assert!(message.contains(expected), "{message}");
    }
    let size = whole.windows(2).position(|pair| pair == b"-Y").expect("a size");
    let mut wrong = whole.clone();
    wrong[size..].iter_mut().find(|byte| **byte == b'3').into_iter().for_each(|byte| *byte = b'4');
    assert!(message(&wrong).contains("row 1 of 20: a row of 300 pixels, expected 400"));
}

#[test]
fn saving_leaves_nothing_half_written() {
    let folder = std::env::temp_dir().join(format!("sunpeak-picture-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("a.hdr");
    sample(20, 10).save(&path).expect("a file");
    assert_eq!(Picture::load(&path).expect("a picture").width, 20);
    assert!(Picture::new(0, 5).save(&folder.join("b.hdr")).is_err());
    assert!(sample(20, 10).save(&folder.join("none").join("c.hdr")).is_err());
    let names: Vec<_> =
        std::fs::read_dir(&folder).expect("a folder").flatten().map(|e| e.file_name()).collect();
    assert_eq!(names, ["a.hdr"]);
    std::fs::remove_dir_all(&folder).expect("removed");
}
