//! Single rays and irradiance sensors, as `rtrace` and `rtrace -I`.

use crate::integrator::{Integrator, Limits};
use crate::passes::{Draw, Means, estimate};
use crate::shapes::Ray;
use crate::{RenderOptions, World};
use sunpeak_core::{Control, Error, Result, Rgb, Vec3};

/// Radiance along rays, or irradiance at sensors.
#[derive(Clone, Debug)]
pub struct Traced {
    /// Of each.
    pub values: Vec<Rgb>,
    /// Standard error of each one's luminous mean of channels; `None` after too few paths to tell.
    pub standard_errors: Option<Vec<f64>>,
}

impl Traced {
    /// Differences from a far field can leave a dark mean of few samples below zero.
    fn of(means: Means) -> Self {
        let values = means.values.into_iter().map(|value| value.max(Rgb::ZERO)).collect();
        Self { values, standard_errors: means.group_errors }
    }
}

/// Radiance [W sr⁻¹ m⁻²] along rays, each given by origin and direction (of any length).
///
/// # Errors
/// A ray that is not finite or has no direction, options out of their domain, or an interruption by `control`.
pub fn trace_radiance(
    world: &World,
    rays: &[(Vec3, Vec3)],
    options: &RenderOptions,
    control: &Control,
) -> Result<Traced> {
    let rays = checked(rays, "ray", "direction")?;
    let integrator = Integrator { world, limits: Limits::of(options), exact_suns: None };
    let sample = |item: usize, draw: Draw| {
        let (origin, direction) = rays[item];
        let mut sampler = draw.alone(options.seed, item as u64);
        integrator.radiance(Ray::new(origin, direction), f64::INFINITY, &mut sampler)
    };
    let means = estimate(rays.len(), options, control, sample)?;
    world.check_expressions()?;
    Ok(Traced::of(means))
}

/// Irradiance [W m⁻²] at sensors, each given by a point and a normal (of any length).
///
/// # Errors
/// A sensor that is not finite or has no normal, options out of their domain, or an interruption by `control`.
pub fn trace_irradiance(
    world: &World,
    sensors: &[(Vec3, Vec3)],
    options: &RenderOptions,
    control: &Control,
) -> Result<Traced> {
    let sensors = checked(sensors, "sensor", "normal")?;
    let integrator = Integrator { world, limits: Limits::of(options), exact_suns: None };
    let sample = |item: usize, draw: Draw| {
        let (point, normal) = sensors[item];
        integrator.irradiance(point, normal, &mut draw.alone(options.seed, item as u64))
    };
    let means = estimate(sensors.len(), options, control, sample)?;
    world.check_expressions()?;
    Ok(Traced::of(means))
}

/// Finite points and unit vectors.
fn checked(pairs: &[(Vec3, Vec3)], what: &str, vector: &str) -> Result<Vec<(Vec3, Vec3)>> {
    let check = |(i, &(point, along)): (usize, &(Vec3, Vec3))| match along.try_normalize() {
        Some(unit) if point.is_finite() && along.is_finite() => Ok((point, unit)),
        _ => Err(Error::value(format!(
            "{what} {i} at {point} has {vector} {along}: not a place and a {vector}"
        ))),
    };
    pairs.iter().enumerate().map(check).collect()
}
