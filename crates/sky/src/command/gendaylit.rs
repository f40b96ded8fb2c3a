//! `gendaylit`: Perez skies (Radiance manual page gendaylit(1)).

use super::args::{meridian_comment, site_defaults};
use super::daylit_args::{Output, Request};
use super::daylit_place::Place;
use super::daylit_radiation::{OrDark, Reason, radiation};
use super::format::{direction, fixed, scientific};
use crate::CieSky;
use crate::perez::Condition;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use sunpeak_core::{LUMINOUS_EFFICACY, Result, SUN_ANGLE_DEG, cone_solid_angle};

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
