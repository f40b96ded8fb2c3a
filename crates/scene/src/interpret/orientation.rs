//! Expressions of materials that are no functions: the vector by which one is turned, a proxy's thickness.

use super::{Interpreter, args::title};
use crate::{
    Orientation, Thickness,
    command::trailing_transform,
    raw::{Primitive, parse_real},
};
use sunpeak_core::{Transform, Vec3};

impl Interpreter<'_> {
    /// The vector of string arguments `at` to `at + 2`; the function file and the transform follow. `what` says what it is.
    pub(super) fn orientation(
        &mut self,
        primitive: &Primitive,
        at: usize,
        what: &str,
    ) -> Result<Orientation, String> {
        let needed = at + 4;
        if primitive.strings.len() < needed {
            return Err(format!(
                "wrong number of arguments of {}: expected at least {needed} string arguments, the last ones ux uy uz of the \
                 {what} and a function file or \".\", found {}",
                title(primitive),
                primitive.strings.len()
            ));
        }
        let transform = self.transform(primitive, needed)?;
        let numbers: Vec<f64> = primitive.strings[at..at + 3].iter().filter_map(|w| parse_real(w)).collect();
        if let [x, y, z] = numbers[..] {
            return Ok(Orientation::Fixed(transform.vector(Vec3::new(x, y, z))));
        }
        let field = self.field(primitive, at + 3, &[at, at + 1, at + 2], &[], Vec::new())?;
        Ok(match [0, 1, 2].map(|root| field.constant(root)) {
            [Some(x), Some(y), Some(z)] => Orientation::Fixed(transform.vector(Vec3::new(x, y, z))),
            _ => Orientation::Varying(field),
        })
    }

    /// A proxy's thickness: the first string argument, a number or an expression of the function file at string argument `file`.
    pub(super) fn thickness(
        &mut self,
        primitive: &Primitive,
        file: usize,
        scale: f64,
    ) -> Result<Thickness, String> {
        if let Some(number) = parse_real(&primitive.strings[0]) {
            return Ok(Thickness::Fixed(number * scale));
        }
        let field = self.field(primitive, file, &[0], &[], Vec::new())?;
        Ok(match field.constant(0) {
            Some(number) => Thickness::Fixed(number * scale),
            None => Thickness::Varying { field, scale },
        })
    }

    /// The transform of the string arguments from `at`.
    pub(super) fn transform(&self, primitive: &Primitive, at: usize) -> Result<Transform, String> {
        trailing_transform(&primitive.strings[at..])
            .map_err(|message| format!("{}: bad transform: {message}", title(primitive)))
    }
}
