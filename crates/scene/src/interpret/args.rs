//! Argument counts and values.

use crate::raw::Primitive;
use sunpeak_core::{Rgb, Vec3};

/// Type and name, for messages.
pub fn title(primitive: &Primitive) -> String {
    format!("{} \"{}\"", primitive.kind.name, primitive.name)
}

/// The message for what Radiance knows and we do not.
pub fn unsupported(primitive: &Primitive) -> String {
    format!("{}: Radiance's \"{}\" is not supported yet", title(primitive), primitive.kind.name)
}

/// Check how many string and real arguments there are; `form` says what they are.
pub fn check_counts(
    primitive: &Primitive,
    strings: &[usize],
    reals: &[usize],
    form: &str,
) -> Result<(), String> {
    let found = (primitive.strings.len(), primitive.reals.len());
    if strings.contains(&found.0) && reals.contains(&found.1) {
        return Ok(());
    }
    let numbers = |allowed: &[usize]| {
        let words: Vec<_> = allowed.iter().map(usize::to_string).collect();
        words.join(" or ")
    };
    Err(format!(
        "wrong number of arguments of {}: expected {} string and {} real arguments ({form}), found {} and {}",
        title(primitive),
        numbers(strings),
        numbers(reals),
        found.0,
        found.1
    ))
}

/// Three reals as a colour or vector.
pub fn triple(reals: &[f64], at: usize) -> Vec3 {
    Vec3::from_slice(&reals[at..at + 3])
}

/// Fractions and colours of materials cannot be negative.
pub fn check_not_negative(primitive: &Primitive, values: &[(&str, f64)]) -> Result<(), String> {
    match values.iter().find(|(_, value)| *value < 0.0) {
        Some((name, value)) => {
            Err(format!("{}: the {name} is {value}, expected 0 or more", title(primitive)))
        }
        None => Ok(()),
    }
}

/// A colour's channels with a name, for [`check_not_negative`].
pub fn smallest(color: Rgb) -> f64 {
    color.min_element()
}
