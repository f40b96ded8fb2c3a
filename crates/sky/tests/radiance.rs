//! Against what Radiance's own programs gave for the same input (`tests/data`).
#![allow(clippy::unwrap_used)] // a wrong data file should fail the test

use sunpeak_core::Vec3;
use sunpeak_sky::command::{gendaylit, gensky};
use sunpeak_sky::{CieSky, SkyDistribution};

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

fn run(command: &str) -> sunpeak_core::Result<String> {
    let words = words(command);
    match words[0].as_str() {
        "gensky" => gensky(&words[1..]),
        _ => gendaylit(&words[1..]),
    }
}

/// Lines without comments, one space between words, and no sign before a zero.
fn primitives(text: &str) -> Vec<String> {
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    lines.map(|line| words(line).join(" ").replace("-0.000000", "0.000000")).collect()
}

#[test]
fn commands_print_the_programs_primitives_digit_by_digit() {
    let recorded = include_str!("data/radiance_commands.txt");
    let blocks: Vec<_> = recorded.split("\n$ ").skip(1).collect();
    assert_eq!(blocks.len(), 30);
    for block in blocks {
        let (command, expected) = block.split_once('\n').unwrap();
        assert_eq!(primitives(&run(command).unwrap()), primitives(expected), "{command}");
    }
}

#[test]
fn brightness_agrees_with_rtrace() {
    let recorded = include_str!("data/radiance_brightness.txt");
    let mut compared = 0;
    for block in recorded.split("\n\n").skip(1) {
        let mut lines = block.lines();
        let sky = distribution(lines.next().unwrap());
        for line in lines {
            let [x, y, z, expected] = numbers(line)[..] else { panic!("{line}") };
            let found = sky.brightness(Vec3::new(x, y, z).normalize());
            assert!((found / expected - 1.0).abs() < 2e-6, "{line}: {found}");
            compared += 1;
        }
    }
    assert_eq!(compared, 90);
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|word| word.parse().unwrap()).collect()
}

fn distribution(line: &str) -> SkyDistribution {
    let (kind, rest) = line.split_once(' ').unwrap();
    let n = numbers(rest);
    if kind == "perez" {
        return SkyDistribution::Perez {
            normalization: n[0],
            ground: n[1],
            coefficients: [n[2], n[3], n[4], n[5], n[6]],
            sun: Vec3::new(n[7], n[8], n[9]),
        };
    }
    let kinds = [CieSky::Clear, CieSky::Overcast, CieSky::Uniform, CieSky::Intermediate];
    let (normalization, sun) = if n.len() > 3 { (n[3], Vec3::new(n[4], n[5], n[6])) } else { (1.0, Vec3::Z) };
    SkyDistribution::Cie { kind: kinds[n[0] as usize - 1], zenith: n[1], ground: n[2], normalization, sun }
}

#[test]
fn wrong_arguments_are_named() {
    for (command, expected) in [
        ("gensky", "month day hour"),
        ("gensky 13 1 12", "month"),
        ("gensky 6 21", "hour"),
        ("gensky 6 21 12XYZ", "unknown time zone \"XYZ\""),
        ("gensky 6 21 +12EST", "hour"),
        ("gensky 6 21 12 -a", "-a"),
        ("gensky 6 21 12 -g rough", "-g"),
        ("gensky 6 21 12 -z", "\"-z\""),
        ("gensky -ang 40", "-ang"),
        ("gendaylit 6 21 14:30 -W 1 1", "decimal hours"),
        ("gendaylit 6 21 25", "hour"),
        ("gendaylit 6 21 12 -W 800", "-W"),
        ("gendaylit 6 21 12 -W 800 NaN", "-W"),
        ("gendaylit 6 21 12 -O 3", "-O"),
        ("gendaylit 6 21 12 -i -5", "-i"),
        ("gendaylit 6 21 12 -l 1 2 3", "-l"),
        ("gendaylit 6 21 12 extra", "\"extra\""),
    ] {
        let message = run(command).unwrap_err().to_string();
        assert!(message.contains(expected), "{command}: {message}");
        assert!(message.starts_with(words(command)[0].as_str()), "{message}");
    }
}

#[test]
fn defaults_name_every_option_of_the_place() {
    for command in ["gensky -defaults", "gendaylit -defaults"] {
        let text = run(command).unwrap();
        for line in ["-a 37.815214", "-o 122.040010", "-m 120.000000", "-g 0.200000"] {
            assert!(text.contains(line), "{command}: {text}");
        }
    }
}

proptest::proptest! {
    #[test]
    fn any_weather_gives_a_sky_of_finite_numbers(
        altitude in -90.0..90.0f64,
        azimuth in -360.0..360.0f64,
        direct in -10.0..2000.0f64,
        diffuse in -10.0..1500.0f64,
        input in 0usize..4,
        output in 0u8..3,
    ) {
        let option = ["-W", "-G", "-L", "-P"][input];
        let command = format!("gendaylit -ang {altitude} {azimuth} {option} {direct} {diffuse} -O {output}");
        let text = run(&command).unwrap();
        let last = text.lines().last().unwrap();
        proptest::prop_assert!(numbers(last).iter().all(|value| value.is_finite()), "{}: {}", command, last);
    }

    #[test]
    fn no_argument_makes_it_panic(command in "(gensky|gendaylit) [-+0-9a-zA-Z:. ]{0,40}") {
        drop(run(&command));
    }
}
