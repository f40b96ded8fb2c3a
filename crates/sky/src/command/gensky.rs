//! `gensky`: CIE skies (Radiance manual page gensky(1)).

use super::HIGHEST_SUN_DEG;
use super::args::{Args, When, meridian_comment, site_defaults, when};
use super::format::{direction, scientific};
use crate::cie::{DEFAULT_TURBIDITY, GENSKY_SUN_DEG, GENSKY_SUN_ON_GROUND_SR, GENSKY_SUN_SR};
use crate::{CieSky, Clock, RadianceSite, solar_position_radiance, sun_direction};
use std::f64::consts::PI;
use std::fmt::Write as _;
use sunpeak_core::{Result, Vec3};

/// What `gensky` prints for these arguments (those after the program's name).
pub fn gensky(args: &[String]) -> Result<String> {
    if matches!(args, [only] if only == "-defaults") {
        return Ok(defaults());
    }
    let request = Request::parse(args)?;
    let sky = request.compute();
    Ok(sky.print(args, &request))
}

/// A brightness that an option may state.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Given {
    /// From the sun's altitude.
    No,
    /// Radiance [W sr⁻¹ m⁻²] (`-b`, `-r`).
    Radiance(f64),
    /// Horizontal irradiance [W/m²] (`-B`, `-R`).
    Irradiance(f64),
}

#[derive(Debug)]
struct Request {
    when: When,
    site: RadianceSite,
    kind: CieSky,
    with_sun: bool,
    zenith: Given,
    solar: Given,
    turbidity: f64,
    ground_reflectance: f64,
}

impl Request {
    fn parse(args: &[String]) -> Result<Self> {
        let mut args = Args::new("gensky", args);
        let mut zone_meridian = None;
        let when = when(&mut args, |args, text| {
            let (clock, meridian) = read_hour(args, text)?;
            zone_meridian = meridian;
            Ok(clock)
        })?;
        let mut request = Self {
            when,
            site: RadianceSite::default(),
            kind: CieSky::Clear,
            with_sun: true,
            zenith: Given::No,
            solar: Given::No,
            turbidity: DEFAULT_TURBIDITY,
            ground_reflectance: 0.2,
        };
        while let Some(option) = args.next() {
            request.option(option, &mut args)?;
        }
        // A zone named with the time wins over -m, wherever that stands.
        if let Some(meridian) = zone_meridian {
            request.site.meridian_west_deg = meridian;
        }
        Ok(request)
    }

    fn option(&mut self, option: &str, args: &mut Args) -> Result<()> {
        match option {
            "-s" | "+s" => (self.kind, self.with_sun) = (CieSky::Clear, option == "+s"),
            "-i" | "+i" => (self.kind, self.with_sun) = (CieSky::Intermediate, option == "+i"),
            "-c" | "+c" => self.kind = CieSky::Overcast,
            "-u" | "+u" => self.kind = CieSky::Uniform,
            "-y" => {
                let year = args.year(option)?;
                if let When::Time { date, .. } = &mut self.when {
                    date.year = year;
                }
            }
            "-r" => self.solar = Given::Radiance(args.number(option, "the sun's radiance [W/(sr m²)]")?),
            "-R" => {
                self.solar = Given::Irradiance(args.number(option, "direct horizontal irradiance [W/m²]")?)
            }
            "-b" => self.zenith = Given::Radiance(args.number(option, "the zenith's radiance [W/(sr m²)]")?),
            "-B" => {
                self.zenith = Given::Irradiance(args.number(option, "diffuse horizontal irradiance [W/m²]")?)
            }
            "-t" => self.turbidity = args.number(option, "the turbidity")?,
            "-g" => self.ground_reflectance = args.number(option, "the ground's reflectance")?,
            "-a" => self.site.latitude_deg = args.number(option, "the latitude [deg north]")?,
            "-o" => self.site.longitude_west_deg = args.number(option, "the longitude [deg west]")?,
            "-m" => self.site.meridian_west_deg = args.number(option, "the standard meridian [deg west]")?,
            _ => {
                return Err(args.error(format!(
                    "unknown option \"{option}\"; known are +s -s +i -i -c -u -y -g -b -B -r -R -t -a -o -m"
                )));
            }
        }
        Ok(())
    }

    fn compute(&self) -> GenSky {
        let mut comments = meridian_comment(&self.when, &self.site).unwrap_or_default();
        let (mut altitude, azimuth) = match self.when {
            When::Angles { altitude_deg, azimuth_west_of_south_deg } => {
                (altitude_deg.to_radians(), azimuth_west_of_south_deg.to_radians())
            }
            When::Time { date, clock } => {
                let position = solar_position_radiance(&self.site, &date, clock);
                let _ = write!(
                    comments,
                    "# Local solar time: {:.2}\n# Solar altitude and azimuth: {:.1} {:.1}\n",
                    position.solar_time_h,
                    position.altitude_rad.to_degrees(),
                    position.azimuth_west_of_south_rad.to_degrees()
                );
                (position.altitude_rad, position.azimuth_west_of_south_rad)
            }
        };
        if !self.kind.is_overcast() && altitude > HIGHEST_SUN_DEG.to_radians() {
            comments.push_str("# warning - sun too close to zenith, reducing altitude to 87 degrees\n");
            altitude = HIGHEST_SUN_DEG.to_radians();
        }
        let sun = sun_direction(altitude.to_degrees(), azimuth.to_degrees() + 180.0);
        let horizontal_over_zenith = self.kind.horizontal_over_zenith(altitude);
        let zenith = match self.zenith {
            Given::No => self.kind.zenith_radiance(altitude, self.turbidity),
            Given::Radiance(radiance) => radiance,
            Given::Irradiance(irradiance) => irradiance / (horizontal_over_zenith * PI),
        };
        let ambient = zenith * horizontal_over_zenith;
        let _ = writeln!(comments, "# Ground ambient level: {ambient:.1}");
        let solar = self.solar_radiance(sun.z);
        let direct = solar.map_or(0.0, |radiance| GENSKY_SUN_ON_GROUND_SR / PI * radiance * sun.z);
        GenSky {
            comments,
            sun,
            solar: solar.filter(|_| self.with_sun),
            zenith,
            ground: (ambient + direct) * self.ground_reflectance,
            normalization: self.kind.normalization(altitude),
        }
    }

    /// The sun's radiance; `None` if there is none. It lights the ground also where the sun itself is left out (`-s`).
    fn solar_radiance(&self, sin_altitude: f64) -> Option<f64> {
        if self.kind.is_overcast() || sin_altitude <= 0.0 {
            return None;
        }
        match self.solar {
            Given::No => Some(self.kind.sun_radiance(sin_altitude)),
            Given::Radiance(radiance) => (radiance > 0.0).then_some(radiance),
            Given::Irradiance(irradiance) => {
                (irradiance > 0.0).then_some(irradiance / (GENSKY_SUN_SR * sin_altitude))
            }
        }
    }
}

/// What is to be printed.
#[derive(Debug)]
struct GenSky {
    comments: String,
    sun: Vec3,
    solar: Option<f64>,
    zenith: f64,
    ground: f64,
    normalization: f64,
}

impl GenSky {
    fn print(&self, args: &[String], request: &Request) -> String {
        let mut text = format!("# gensky {}\n{}", args.join(" "), self.comments);
        if let Some(radiance) = self.solar {
            let (radiance, sun) = (scientific(radiance), direction(self.sun));
            let _ = write!(
                text,
                "\nvoid light solar\n0\n0\n3 {radiance} {radiance} {radiance}\n\
                 \nsolar source sun\n0\n0\n4 {sun} {GENSKY_SUN_DEG}\n"
            );
        }
        text.push_str("\nvoid brightfunc skyfunc\n2 skybr skybright.cal\n0\n");
        let (zenith, ground) = (scientific(self.zenith), scientific(self.ground));
        let kind = request.kind.number();
        let _ = if request.kind.is_overcast() {
            writeln!(text, "3 {kind} {zenith} {ground}")
        } else {
            let normalization = scientific(self.normalization);
            writeln!(text, "7 {kind} {zenith} {ground} {normalization} {}", direction(self.sun))
        };
        text
    }
}

fn defaults() -> String {
    format!(
        "+s\t\t\t\t# Sunny sky with sun\n-g {:.6}\t\t\t# Ground plane reflectance\n\
         -t {:.6}\t\t\t# Atmospheric turbidity\n{}",
        0.2,
        DEFAULT_TURBIDITY,
        site_defaults()
    )
}

/// Time zones by name: their standard meridian [deg west]. Of a name that stands twice the first counts, as in `gensky`.
const TIME_ZONES: [(&str, f64); 28] = [
    ("YST", 135.0),
    ("YDT", 120.0),
    ("PST", 120.0),
    ("PDT", 105.0),
    ("MST", 105.0),
    ("MDT", 90.0),
    ("CST", 90.0),
    ("CDT", 75.0),
    ("EST", 75.0),
    ("EDT", 60.0),
    ("AST", 60.0),
    ("ADT", 45.0),
    ("NST", 52.5),
    ("NDT", 37.5),
    ("GMT", 0.0),
    ("BST", -15.0),
    ("CET", -15.0),
    ("CEST", -30.0),
    ("EET", -30.0),
    ("EEST", -45.0),
    ("GST", -60.0),
    ("GDT", -75.0),
    ("IST", -82.5),
    ("IDT", -97.5),
    ("JST", -135.0),
    ("JDT", -150.0),
    ("NZST", -180.0),
    ("NZDT", -195.0),
];

/// `[+]hour[:minute][zone]`: the clock, and the meridian [deg west] of a zone.
fn read_hour(args: &Args, text: &str) -> Result<(Clock, Option<f64>)> {
    let wrong = || {
        args.error(format!("hour: expected 14.5, 14:30, 14:30EST or +14:30 (solar time), found \"{text}\""))
    };
    let (solar, rest) = match text.strip_prefix('+') {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let split = rest.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(rest.len());
    let (time, zone) = rest.split_at(split);
    if !time.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return Err(wrong());
    }
    let hour = match time.split_once(':') {
        Some((hours, minutes)) => whole(hours).ok_or_else(wrong)? + whole(minutes).ok_or_else(wrong)? / 60.0,
        None => time.parse::<f64>().map_err(|_| wrong())?,
    };
    match (solar, zone) {
        (true, "") => Ok((Clock::Solar(hour), None)),
        (false, "") => Ok((Clock::Standard(hour), None)),
        (true, _) => Err(wrong()),
        (false, name) => Ok((Clock::Standard(hour), Some(zone_meridian(args, name)?))),
    }
}

fn whole(digits: &str) -> Option<f64> {
    digits.parse::<u16>().ok().map(f64::from)
}

fn zone_meridian(args: &Args, name: &str) -> Result<f64> {
    let found = TIME_ZONES.iter().find(|(zone, _)| zone.eq_ignore_ascii_case(name));
    found.map(|&(_, meridian)| meridian).ok_or_else(|| {
        let known: Vec<_> = TIME_ZONES.iter().map(|(zone, _)| *zone).collect();
        args.error(format!("hour: unknown time zone \"{name}\"; known are {}", known.join(" ")))
    })
}
