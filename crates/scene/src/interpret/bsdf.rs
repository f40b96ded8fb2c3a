//! `BSDF` and `aBSDF`.

use super::args::{check_counts, constant, title, triple};
use super::orientation::orientation;
use crate::{BsdfMaterial, LoadOptions, raw::Primitive};
use std::path::Path;
use sunpeak_core::Rgb;

/// The material; its XML file is found, not read.
pub fn material(primitive: &Primitive, options: &LoadOptions, cwd: &Path) -> Result<BsdfMaterial, String> {
    let extract_peak = primitive.kind.name == "aBSDF";
    // String arguments: [thickness] file ux uy uz function-file [transform].
    let file_at = usize::from(!extract_peak);
    let needed = file_at + 5;
    if primitive.strings.len() < needed {
        let form = if extract_peak { "file ux uy uz ." } else { "thickness file ux uy uz ." };
        return Err(format!(
            "wrong number of arguments of {}: expected at least {needed} string arguments ({form}), found {}",
            title(primitive),
            primitive.strings.len()
        ));
    }
    check_counts(
        primitive,
        &[primitive.strings.len()],
        &[0, 3, 6, 9],
        "front, back and transmitted diffuse colour",
    )?;
    let up = orientation(primitive, file_at + 1, "up vector")?;
    let transform = up.transform;
    let up = up.vector.try_normalize();
    let up = up.ok_or_else(|| format!("{}: the up vector is zero", title(primitive)))?;
    let thickness = if extract_peak { 0.0 } else { constant(primitive, 0, "thickness")? * transform.scale() };
    let name = &primitive.strings[file_at];
    let file = options.find(name, cwd, &primitive.directory, &primitive.location);
    let diffuse =
        |at: usize| if primitive.reals.len() >= at + 3 { triple(&primitive.reals, at) } else { Rgb::ZERO };
    Ok(BsdfMaterial {
        extract_peak,
        thickness,
        file: file.map_err(|error| missing(primitive, &error))?,
        up,
        mirrored: transform.is_mirror(),
        front_diffuse: diffuse(0),
        back_diffuse: diffuse(3),
        diffuse_transmission: diffuse(6),
    })
}

/// The location is said once, where the message ends up.
fn missing(primitive: &Primitive, error: &sunpeak_core::Error) -> String {
    match error {
        sunpeak_core::Error::Input { message, .. } => format!("{}: {message}", title(primitive)),
        other => other.to_string(),
    }
}
