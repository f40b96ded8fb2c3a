//! What `gendaylit` makes of its input option: irradiances, illuminances, and the sky's condition.

use super::daylit_args::{Input, Output, Request};
use super::daylit_place::Place;
use crate::perez::{self, Condition, SOLAR_CONSTANT_LUX, SOLAR_CONSTANT_W_M2};
use std::f64::consts::FRAC_PI_2;

/// Why the program prints a sky without light.
pub(super) type Reason = &'static str;

/// A result, or why there is no light.
pub(super) type OrDark<T> = std::result::Result<T, Reason>;

/// Radiation of sun and sky.
#[derive(Clone, Copy)]
pub(super) struct Radiation {
    /// On a surface that faces the sun.
    pub direct_normal: f64,
    /// From the sky on a horizontal surface.
    pub diffuse_horizontal: f64,
}

impl Radiation {
    /// Negative values are taken as zero; nothing at all by day, or more than the sun sends, is an error sky.
    fn check(&mut self, sun_is_up: bool, solar_constant: f64) -> OrDark<()> {
        // Not `max`: NaN stays.
        for value in [&mut self.direct_normal, &mut self.diffuse_horizontal] {
            if *value < 0.0 {
                *value = 0.0;
            }
        }
        if sun_is_up && self.direct_normal + self.diffuse_horizontal == 0.0 {
            return Err("no radiation although the sun is up");
        }
        if self.direct_normal > solar_constant {
            return Err("direct radiation exceeds the solar constant");
        }
        Ok(())
    }
}

/// From the input option to the sky's condition, irradiances [W/m²] and illuminances [lx].
pub(super) fn radiation(
    request: &Request,
    place: &Place,
    comments: &mut String,
) -> OrDark<(Condition, Radiation, Radiation)> {
    let sun_is_up = place.altitude_rad > 0.0;
    let true_zenith = FRAC_PI_2 - place.altitude_rad;
    let mut condition = Condition {
        clearness: 0.0,
        brightness: 0.0,
        sun_zenith_rad: true_zenith.min(FRAC_PI_2),
        precipitable_water_cm: perez::precipitable_water_cm(request.dew_point_c),
    };
    if let Input::NormalLux { direct_normal, diffuse_horizontal } = request.input {
        let mut light = Radiation { direct_normal, diffuse_horizontal };
        light.check(sun_is_up, SOLAR_CONSTANT_LUX)?;
        let energy = irradiance_of(light, &mut condition, true_zenith, place.day_of_year)?;
        return Ok((condition, energy, light));
    }
    let energy = irradiance(request, place, &mut condition, comments)?;
    check_number(&condition)?;
    if request.output == Output::Solar {
        return Ok((condition, energy, energy));
    }
    let mut light = Radiation {
        diffuse_horizontal: energy.diffuse_horizontal * condition.diffuse_efficacy(),
        direct_normal: energy.direct_normal * condition.direct_efficacy(),
    };
    light.check(sun_is_up, SOLAR_CONSTANT_LUX)?;
    Ok((condition, energy, light))
}

/// Irradiances [W/m²] from any input but illuminances; sets the condition's clearness and brightness.
fn irradiance(
    request: &Request,
    place: &Place,
    condition: &mut Condition,
    comments: &mut String,
) -> OrDark<Radiation> {
    let sun_is_up = place.altitude_rad > 0.0;
    let (zenith, day) = (condition.sun_zenith_rad, place.day_of_year);
    let sin_altitude = place.altitude_rad.sin();
    let given = |direct_normal, diffuse_horizontal| Radiation { direct_normal, diffuse_horizontal };
    let mut energy = match request.input {
        Input::Perez { clearness, brightness } => {
            (condition.clearness, condition.brightness) = (clearness, brightness);
            condition.limit();
            let diffuse = perez::diffuse_horizontal_of(condition.brightness, zenith, day);
            given(perez::direct_normal_of(condition.clearness, diffuse, zenith), diffuse)
        }
        Input::Normal { direct_normal, diffuse_horizontal }
        | Input::NormalLux { direct_normal, diffuse_horizontal } => given(direct_normal, diffuse_horizontal),
        Input::Horizontal { .. } | Input::Global { .. } if !sun_is_up => {
            comments.push_str("# warning - sun below the horizon, irradiances taken as zero\n");
            given(0.0, 0.0)
        }
        Input::Horizontal { direct_horizontal, diffuse_horizontal } => {
            given(direct_horizontal / sin_altitude, diffuse_horizontal)
        }
        Input::Global { horizontal } => {
            let diffuse = erbs_diffuse(horizontal, sin_altitude, day, comments);
            given((diffuse.global - diffuse.diffuse) / sin_altitude, diffuse.diffuse)
        }
    };
    energy.check(sun_is_up, SOLAR_CONSTANT_W_M2)?;
    if !matches!(request.input, Input::Perez { .. }) {
        set_condition(condition, energy, zenith, day);
    }
    Ok(energy)
}

fn set_condition(condition: &mut Condition, energy: Radiation, zenith: f64, day: f64) {
    condition.brightness = perez::brightness(energy.diffuse_horizontal, condition.sun_zenith_rad, day);
    condition.clearness = perez::clearness(energy.direct_normal, energy.diffuse_horizontal, zenith);
    condition.limit();
}

/// 0/0: without any radiation there is no clearness.
fn check_number(condition: &Condition) -> OrDark<()> {
    if condition.clearness.is_nan() { Err("no radiation") } else { Ok(()) }
}

/// Irradiances that belong to illuminances: efficacy and condition depend on each other; nine rounds, as the program.
fn irradiance_of(
    light: Radiation,
    condition: &mut Condition,
    true_zenith: f64,
    day: f64,
) -> OrDark<Radiation> {
    let share = SOLAR_CONSTANT_W_M2 / SOLAR_CONSTANT_LUX;
    let mut energy = Radiation {
        direct_normal: light.direct_normal * share,
        diffuse_horizontal: light.diffuse_horizontal * share,
    };
    set_condition(condition, energy, true_zenith, day);
    for _ in 0..9 {
        check_number(condition)?;
        energy.diffuse_horizontal = light.diffuse_horizontal / condition.diffuse_efficacy();
        let efficacy = condition.direct_efficacy();
        energy.direct_normal = if efficacy < 0.1 { 0.0 } else { light.direct_normal / efficacy };
        set_condition(condition, energy, condition.sun_zenith_rad, day);
    }
    check_number(condition)?;
    Ok(energy)
}

struct Erbs {
    global: f64,
    diffuse: f64,
}

/// Diffuse share of the global irradiance (Erbs, Klein and Duffie 1982, Solar Energy 28(4)).
fn erbs_diffuse(horizontal: f64, sin_altitude: f64, day: f64, comments: &mut String) -> Erbs {
    let extraterrestrial = SOLAR_CONSTANT_W_M2 * perez::eccentricity(day) * sin_altitude;
    let global = if horizontal > extraterrestrial { extraterrestrial * 0.999 } else { horizontal };
    let kt = global / extraterrestrial;
    let share = if kt <= 0.22 {
        1.0 - 0.09 * kt
    } else if kt <= 0.8 {
        0.9511 - 0.1604 * kt + 4.388 * kt.powi(2) - 16.638 * kt.powi(3) + 12.336 * kt.powi(4)
    } else {
        0.165
    };
    comments.push_str("# WARNING: the -E option is only recommended for a rough estimation!\n");
    Erbs { global, diffuse: global * share }
}
