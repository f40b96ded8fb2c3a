//! Transform options, as `xform` and the string arguments of primitives with a function file have them.

use crate::raw::{parse_integer, parse_real};
use sunpeak_core::{Transform, Vec3};

/// Does this word begin a transform?
pub fn is_transform_option(word: &str) -> bool {
    matches!(word, "-t" | "-s" | "-i" | "-rx" | "-ry" | "-rz" | "-mx" | "-my" | "-mz")
}

/// The transform that the leading options of `args` describe, and how many words they are.
///
/// Stops at the first word that is no transform option; an option with wrong values is an error.
pub fn parse_transform(args: &[String]) -> Result<(Transform, usize), String> {
    let mut total = Transform::IDENTITY;
    let mut step = Transform::IDENTITY;
    let mut repeat = 1;
    let mut i = 0;
    while i < args.len() && is_transform_option(&args[i]) {
        let option = args[i].as_str();
        let values = &args[i + 1..];
        i += 1 + match option {
            "-i" => {
                total = total.then(&power(&step, repeat));
                step = Transform::IDENTITY;
                repeat = integer(option, values)?;
                1
            }
            "-t" => {
                let t =
                    Vec3::new(real(option, values, 0)?, real(option, values, 1)?, real(option, values, 2)?);
                step = step.then(&Transform::translation(t));
                3
            }
            "-s" => {
                let factor = real(option, values, 0)?;
                if factor == 0.0 {
                    return Err("-s 0: the scale must not be zero".into());
                }
                step = step.then(&Transform::scaling(Vec3::splat(factor)));
                1
            }
            _ => {
                let (next, used) = about_axis(option, values)?;
                step = step.then(&next);
                used
            }
        };
    }
    Ok((total.then(&power(&step, repeat)), i))
}

/// The transform that a primitive's trailing string arguments describe; words before its first option are skipped,
/// as Radiance does.
pub fn trailing_transform(strings: &[String]) -> Result<Transform, String> {
    let Some(start) = strings.iter().position(|word| is_transform_option(word)) else {
        return Ok(Transform::IDENTITY);
    };
    let (transform, used) = parse_transform(&strings[start..])?;
    match strings.get(start + used) {
        Some(word) => Err(format!("expected a transform option, found \"{word}\"")),
        None => Ok(transform),
    }
}

/// `-r?` and `-m?`.
fn about_axis(option: &str, values: &[String]) -> Result<(Transform, usize), String> {
    let axis = match option.as_bytes()[2] {
        b'x' => Vec3::X,
        b'y' => Vec3::Y,
        _ => Vec3::Z,
    };
    if option.starts_with("-m") {
        return Ok((Transform::scaling(Vec3::ONE - 2.0 * axis), 0));
    }
    Ok((Transform::rotation(axis, real(option, values, 0)?), 1))
}

fn real(option: &str, values: &[String], index: usize) -> Result<f64, String> {
    let word = values.get(index).map(String::as_str);
    word.and_then(parse_real).ok_or_else(|| expected(option, "a number", word))
}

fn integer(option: &str, values: &[String]) -> Result<i64, String> {
    let word = values.first().map(String::as_str);
    word.and_then(parse_integer).ok_or_else(|| expected(option, "a whole number", word))
}

fn expected(option: &str, what: &str, found: Option<&str>) -> String {
    let found = found.map_or("the end".into(), |word| format!("\"{word}\""));
    format!("expected {what} after {option}, found {found}")
}

/// `step` done `times` times; never if `times` is negative.
fn power(step: &Transform, times: i64) -> Transform {
    let (mut result, mut square, mut times) = (Transform::IDENTITY, *step, times.max(0));
    while times > 0 {
        if times & 1 == 1 {
            result = result.then(&square);
        }
        square = square.then(&square);
        times >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transform(line: &str) -> Transform {
        let args: Vec<String> = line.split_whitespace().map(String::from).collect();
        let (transform, used) = parse_transform(&args).expect(line);
        assert_eq!(used, args.len());
        transform
    }

    #[test]
    fn options_work_in_the_order_they_stand() {
        let t = transform("-rz 90 -t 1 0 0 -s 2 -mx -i 3 -t 0 0 1 -i 1 -t 0 1 0");
        let expected = Vec3::new(-2.0, 3.0, 3.0);
        assert!((t.point(Vec3::X) - expected).length() < 1e-12, "{}", t.point(Vec3::X));
        assert!(t.is_mirror() && (t.scale() - 2.0).abs() < 1e-12);
        // A negative scale mirrors, as in Radiance.
        assert!(transform("-s -2").is_mirror());
    }

    #[test]
    fn wrong_values_are_named() {
        for (line, expected) in [
            ("-t 1 2", "expected a number after -t, found the end"),
            ("-rz x", "expected a number after -rz, found \"x\""),
            ("-i 1.5", "expected a whole number after -i, found \"1.5\""),
            ("-s 0", "must not be zero"),
        ] {
            let args: Vec<String> = line.split_whitespace().map(String::from).collect();
            let message = parse_transform(&args).expect_err(line);
            assert!(message.contains(expected), "{message}");
        }
    }
}
