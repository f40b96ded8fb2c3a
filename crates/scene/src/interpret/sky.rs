//! The skies of gensky and gendaylit, done without their function files.

use super::args::{title, triple};
use crate::{command::trailing_transform, raw::Primitive};
use sunpeak_core::{Transform, Vec3};
use sunpeak_sky::{CieSky, SkyDistribution};

/// How far an axis may turn by rounding.
const AXIS_TOLERANCE: f64 = 1e-9;

/// The sky of a `brightfunc`, if it is one: string arguments function, file [transform]. One whose zenith is tilted is left to
/// its function file.
pub fn sky(primitive: &Primitive) -> Result<Option<SkyDistribution>, String> {
    let [function, file, rest @ ..] = primitive.strings.as_slice() else { return Ok(None) };
    let file = file.rsplit('/').next().unwrap_or(file);
    let sky = match (function.as_str(), file.strip_suffix(".cal").unwrap_or(file)) {
        ("skybr", "skybright") => cie(primitive)?,
        ("skybright", "perezlum") => perez(primitive)?,
        _ => return Ok(None),
    };
    let transform =
        trailing_transform(rest).map_err(|m| format!("{}: bad transform: {m}", title(primitive)))?;
    Ok(turned(sky, &transform))
}

fn cie(primitive: &Primitive) -> Result<SkyDistribution, String> {
    let reals = at_least(primitive, 3)?;
    // The function file selects by A1 rounded.
    let kind = match (reals[0] + 0.5).floor() as i64 {
        1 => CieSky::Clear,
        2 => CieSky::Overcast,
        3 => CieSky::Uniform,
        4 => CieSky::Intermediate,
        _ => return Err(format!("{}: A1 is {}, expected 1, 2, 3 or 4", title(primitive), reals[0])),
    };
    let (zenith, ground) = (reals[1], reals[2]);
    // Overcast and uniform skies do not look at the rest, and gensky does not write it.
    let (normalization, sun) = match kind {
        CieSky::Overcast | CieSky::Uniform if reals.len() < 7 => (1.0, Vec3::Z),
        _ => at_least(primitive, 7).map(|reals| (reals[3], triple(reals, 4)))?,
    };
    Ok(SkyDistribution::Cie { kind, zenith, ground, normalization, sun })
}

fn perez(primitive: &Primitive) -> Result<SkyDistribution, String> {
    let reals = at_least(primitive, 10)?;
    let coefficients = [reals[2], reals[3], reals[4], reals[5], reals[6]];
    Ok(SkyDistribution::Perez {
        normalization: reals[0],
        ground: reals[1],
        coefficients,
        sun: triple(reals, 7),
    })
}

fn at_least(primitive: &Primitive, count: usize) -> Result<&[f64], String> {
    if primitive.reals.len() >= count {
        return Ok(&primitive.reals);
    }
    let found = primitive.reals.len();
    Err(format!(
        "wrong number of arguments of {}: expected {count} real arguments, found {found}",
        title(primitive)
    ))
}

/// The sky after a transform that leaves the zenith where it is; `None` for others. A sky is at infinity: moving
/// and scaling do not change it.
fn turned(mut sky: SkyDistribution, transform: &Transform) -> Option<SkyDistribution> {
    let turn = |v: Vec3| transform.vector(v) / transform.scale();
    if (turn(Vec3::Z) - Vec3::Z).length() > AXIS_TOLERANCE {
        return None;
    }
    match &mut sky {
        SkyDistribution::Cie { sun, .. } | SkyDistribution::Perez { sun, .. } => *sun = turn(*sun),
    }
    Some(sky)
}
