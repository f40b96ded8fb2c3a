//! The vector by which anisotropic materials are turned: string arguments `ux uy uz function-file [transform]`.

use super::args::{constant, title};
use crate::{command::trailing_transform, raw::Primitive};
use sunpeak_core::{Transform, Vec3};

/// An orientation and what is done to it.
pub struct Orientation {
    /// World axes, not normalised.
    pub vector: Vec3,
    /// The transform of the string arguments, already applied.
    pub transform: Transform,
}

/// The orientation whose first component is string argument `at`; `what` says what it is.
pub fn orientation(primitive: &Primitive, at: usize, what: &str) -> Result<Orientation, String> {
    let needed = at + 4;
    if primitive.strings.len() < needed {
        return Err(format!(
            "wrong number of arguments of {}: expected at least {needed} string arguments, the last ones ux uy uz and a \
             function file or \".\", found {}",
            title(primitive),
            primitive.strings.len()
        ));
    }
    let word = &primitive.strings[at + 3];
    if word != "." {
        return Err(format!(
            "{}: the function file is \"{word}\": expected \".\", function files are not supported yet",
            title(primitive)
        ));
    }
    let transform = trailing_transform(&primitive.strings[needed..])
        .map_err(|message| format!("{}: bad transform: {message}", title(primitive)))?;
    let component = |i: usize| constant(primitive, at + i, &format!("{what}'s {}", ["x", "y", "z"][i]));
    let vector = transform.vector(Vec3::new(component(0)?, component(1)?, component(2)?));
    Ok(Orientation { vector, transform })
}
