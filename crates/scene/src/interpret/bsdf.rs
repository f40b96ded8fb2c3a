//! `BSDF` and `aBSDF`.

use super::Interpreter;
use super::args::{check_counts, title, triple};
use crate::{BsdfMaterial, Orientation, Thickness, raw::Primitive};
use sunpeak_core::Rgb;

/// The material; its XML file is found, not read.
pub fn material(interpreter: &mut Interpreter, primitive: &Primitive) -> Result<BsdfMaterial, String> {
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
    let transform = interpreter.transform(primitive, needed)?;
    let up = match interpreter.orientation(primitive, file_at + 1, "up vector")? {
        Orientation::Fixed(up) => {
            let up = up.try_normalize();
            Orientation::Fixed(up.ok_or_else(|| format!("{}: the up vector is zero", title(primitive)))?)
        }
        varying @ Orientation::Varying(_) => varying,
    };
    let thickness = if extract_peak {
        Thickness::Fixed(0.0)
    } else {
        interpreter.thickness(primitive, needed - 1, transform.scale())?
    };
    let name = &primitive.strings[file_at];
    let file = interpreter.options.find(name, &interpreter.cwd, &primitive.directory, &primitive.location);
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
