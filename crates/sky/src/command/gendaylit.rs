//! `gendaylit`: Perez skies (Radiance manual page gendaylit(1)).

use super::HIGHEST_SUN_DEG;
use super::args::When;
use super::args::{meridian_comment, site_defaults};
use super::daylit_args::{Input, Output, Request};
use super::format::{direction, fixed, scientific};
use crate::perez::{self, Condition, SOLAR_CONSTANT_LUX, SOLAR_CONSTANT_W_M2};
use crate::position::{declination_and_solar_time, ies_declination, position_at};
use crate::{CieSky, RadianceSite, sun_direction};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write as _;
use sunpeak_core::{LUMINOUS_EFFICACY, Result, SUN_ANGLE_DEG, Vec3, cone_solid_angle};

/// What `gendaylit` prints for these arguments (those after the program's name).
pub fn gendaylit(args: &[String]) -> Result<String> {
    if matches!(args, [only] if only == "-defaults") {
        return Ok(defaults());
    }
    let request = Request::parse(args)?;
    let mut comments = meridian_comment(&request.when, &request.site).unwrap_or_default();
    let place = Place::find(&request, &mut comments);
    let body = match place.dark.map_or_else(|| Daylight::compute(&request, &place, &mut comments), Err) {
        Ok(daylight) => daylight.print(&request, &place),
        Err(reason) => dark_sky(&place, reason),
    };
    Ok(format!("# gendaylit {}\n{comments}{body}", args.join(" ")))
}

/// Why the program prints a sky without light.
type Reason = &'static str;

/// A result, or why there is no light.
type OrDark<T> = std::result::Result<T, Reason>;

/// Where the sun stands.
struct Place {
    altitude_rad: f64,
    azimuth_west_of_south_rad: f64,
    solar_time_h: f64,
    /// 0 where the angles are given, as in the program.
    day_of_year: f64,
    dark: Option<Reason>,
}

impl Place {
    fn find(request: &Request, comments: &mut String) -> Self {
        let mut place = match request.when {
            When::Angles { altitude_deg, azimuth_west_of_south_deg } => Self {
                altitude_rad: altitude_deg.to_radians(),
                azimuth_west_of_south_rad: azimuth_west_of_south_deg.to_radians(),
                solar_time_h: 0.0,
                day_of_year: 0.0,
                dark: None,
            },
            When::Time { date, clock } => {
                let (declination, solar_time) = declination_and_solar_time(&request.site, &date, clock);
                let day_of_year = f64::from(date.day_of_year());
                let daytime = Daytime::new(&request.site, day_of_year, request.interval_min);
                let (solar_time_h, dark) = daytime.correct(solar_time, comments);
                let position = position_at(&request.site, declination, solar_time_h);
                Self {
                    altitude_rad: position.altitude_rad,
                    azimuth_west_of_south_rad: position.azimuth_west_of_south_rad,
                    solar_time_h,
                    day_of_year,
                    dark,
                }
            }
        };
        let highest = HIGHEST_SUN_DEG.to_radians();
        if place.dark.is_none() && !request.cloudy && place.altitude_rad > highest {
            comments.push_str("# warning - sun too close to zenith, reducing altitude to 87 degrees\n");
            place.altitude_rad = highest;
        }
        place
    }

    fn sun(&self) -> Vec3 {
        sun_direction(self.altitude_rad.to_degrees(), self.azimuth_west_of_south_rad.to_degrees() + 180.0)
    }

    fn comment(&self) -> String {
        format!(
            "# Local solar time: {:.2}\n# Solar altitude and azimuth: {:.1} {:.1}\n",
            self.solar_time_h,
            self.altitude_rad.to_degrees(),
            self.azimuth_west_of_south_rad.to_degrees()
        )
    }
}

/// Sunrise and sunset in solar time [h]; NaN, and never reached, in polar day and night.
struct Daytime {
    sunrise: f64,
    sunset: f64,
    half_interval: f64,
}

impl Daytime {
    fn new(site: &RadianceSite, day_of_year: f64, interval_min: f64) -> Self {
        // Single precision as in the program: the switch at sunrise then falls on the same side.
        let cosine = -(site.latitude_deg.to_radians().tan() * ies_declination(day_of_year).tan()) as f32;
        let half_day_h = f64::from(cosine).acos() * 12.0 / PI;
        Self {
            sunrise: 12.0 - half_day_h,
            sunset: 12.0 + half_day_h,
            half_interval: f64::from(interval_min as f32 / 120.0),
        }
    }

    /// With `-i` the part of the interval that lies in the day stands for it; otherwise the hour as it is.
    fn correct(&self, mut time: f64, comments: &mut String) -> (f64, Option<Reason>) {
        let half = self.half_interval;
        let given = time;
        if half > 0.0 && (self.sunrise - time).abs() <= half {
            time = (time + half + self.sunrise) / 2.0;
        }
        if half > 0.0 && (self.sunset - time).abs() < half {
            time = (time - half + self.sunset) / 2.0;
        }
        if time != given {
            comments.push_str("# Solar position corrected for the time interval\n");
        }
        let night = time < self.sunrise - half || time > self.sunset + half;
        (time, night.then_some("sun below the horizon"))
    }
}

/// Radiation of sun and sky.
#[derive(Clone, Copy)]
struct Radiation {
    direct_normal: f64,
    diffuse_horizontal: f64,
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

/// What is to be printed.
struct Daylight {
    condition: Condition,
    coefficients: [f64; 5],
    normalization: f64,
    ground: f64,
    solar: f64,
}

impl Daylight {
    fn compute(request: &Request, place: &Place, comments: &mut String) -> OrDark<Self> {
        let (condition, energy, light) = radiation(request, place, comments)?;
        // In the output's unit: luminous radiation over 179, radiation of the whole spectrum, or lumens.
        let (out, unit) = match request.output {
            Output::Visible => (light, LUMINOUS_EFFICACY),
            Output::Solar => (energy, 1.0),
            Output::Lumen => (light, 1.0),
        };
        let coefficients = condition.coefficients();
        let normalization = out.diffuse_horizontal / patch_integral(&condition, &coefficients) / unit;
        let solar = out.direct_normal / cone_solid_angle(SUN_ANGLE_DEG) / unit;

        let zenith = normalization * relative_luminance(&condition, &coefficients, 1.0, 1.0, 0.0);
        let mut ground = zenith * ground_factor(condition.clearness, place.altitude_rad);
        if request.with_sun && condition.clearness > 1.0 {
            ground += SUN_ON_GROUND_SR / PI * solar * place.altitude_rad.sin();
        }
        if coefficients[1] > 0.0 {
            return Err("positive Perez parameter b");
        }
        Ok(Self {
            condition,
            coefficients,
            normalization,
            ground: ground * request.ground_reflectance,
            solar,
        })
    }

    fn print(&self, request: &Request, place: &Place) -> String {
        let Condition { clearness, brightness, precipitable_water_cm, .. } = self.condition;
        let sun = direction(place.sun());
        let mut text = place.comment();
        let _ = writeln!(
            text,
            "# epsilon, delta, atmospheric precipitable water content : {clearness:.4} {brightness:.4} {precipitable_water_cm:.4} "
        );
        if request.with_sun {
            let radiance = if clearness > 1.0 { scientific(self.solar) } else { "0.0".to_owned() };
            let _ = write!(
                text,
                "\nvoid light solar\n0\n0\n3 {radiance} {radiance} {radiance}\n\
                 \nsolar source sun\n0\n0\n4 {sun} {}\n",
                fixed(SUN_ANGLE_DEG)
            );
        }
        let coefficients = self.coefficients.map(fixed).join(" ");
        let common =
            format!("{} {} {coefficients} {sun}", scientific(self.normalization), scientific(self.ground));
        // The colour model knows overcast and clear skies only (Diakité-Kortlever and Knoop 2022).
        let has_color = !(clearness > 1.065 && clearness < 4.5);
        match &request.color {
            Some(locus) if has_color => {
                let locus = locus.map(|value| fixed(f64::from(value as f32))).join(" ");
                let _ = write!(
                    text,
                    "\nvoid colorfunc skyfunc\n4 skybright_r skybright_g skybright_b perezlum_c.cal\n0\n\
                     22 {common} {} {locus}\n",
                    fixed(clearness)
                );
            }
            color => {
                if color.is_some() {
                    text.push_str(
                        "# warning - no colour model for intermediate skies, no colour in the output\n",
                    );
                }
                let _ = write!(text, "\nvoid brightfunc skyfunc\n2 skybright perezlum.cal\n0\n10 {common}\n");
            }
        }
        text
    }
}

/// Solid angle [sr] by which `gendaylit` lets its sun light the ground (0.533 degrees).
const SUN_ON_GROUND_SR: f64 = 6.8e-5;

/// Mean horizontal radiance over zenith radiance, by the CIE sky that is nearest in clearness.
fn ground_factor(clearness: f64, altitude_rad: f64) -> f64 {
    let nearest = match clearness {
        1.0 => CieSky::Overcast,
        c if c < 6.0 => CieSky::Intermediate,
        _ => CieSky::Clear,
    };
    nearest.horizontal_over_zenith(altitude_rad)
}

/// From the input option to the sky's condition, irradiances [W/m²] and illuminances [lx].
fn radiation(
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
    if request.output == Output::Solar {
        check_number(&condition)?;
        return Ok((condition, energy, energy));
    }
    check_number(&condition)?;
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

/// Relative luminance towards zenith angle ζ and azimuth φ from the sun.
fn relative_luminance(
    condition: &Condition,
    [a, b, c, d, e]: &[f64; 5],
    cos_zeta: f64,
    cos_phi: f64,
    sin_zeta: f64,
) -> f64 {
    let (sin_z, cos_z) = condition.sun_zenith_rad.sin_cos();
    let cos_gamma = cos_z * cos_zeta + sin_z * sin_zeta * cos_phi;
    let gamma = cos_gamma.clamp(-1.0, 1.0).acos();
    (1.0 + a * (b / cos_zeta).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}

/// Horizontal integral of the relative luminance over the 145 patches of Tregenza 1987, each of the same weight.
fn patch_integral(condition: &Condition, coefficients: &[f64; 5]) -> f64 {
    const ROWS: [(f64, u32); 8] =
        [(84.0, 30), (72.0, 30), (60.0, 24), (48.0, 24), (36.0, 18), (24.0, 12), (12.0, 6), (0.0, 1)];
    let mut sum = 0.0;
    for (zeta_deg, count) in ROWS {
        let (sin_zeta, cos_zeta) = zeta_deg.to_radians().sin_cos();
        for i in 0..count {
            let phi = TAU * f64::from(i) / f64::from(count);
            sum += cos_zeta * relative_luminance(condition, coefficients, cos_zeta, phi.cos(), sin_zeta);
        }
    }
    sum * TAU / 145.0
}

/// A sky that gives no light, where the program finds none.
fn dark_sky(place: &Place, reason: Reason) -> String {
    format!(
        "{}# warning - {reason}: a sky without light\n\nvoid brightfunc skyfunc\n2 skybright perezlum.cal\n0\n\
         10 0.00 0.00  0.000 0.000 0.000 0.000 0.000  {}\n",
        place.comment(),
        direction(place.sun())
    )
}

fn defaults() -> String {
    format!(
        "-g {:.6}\t\t\t# Ground plane reflectance\n-t {:.6}\t\t\t# Atmospheric betaturbidity\n{}",
        0.2,
        0.1,
        site_defaults()
    )
}
