//! Arguments of the two programs: what they have in common.

use crate::{Clock, Date, RadianceSite};
use sunpeak_core::{Error, Result};

/// Walks through the arguments and says in its errors which program and option it was about.
pub(super) struct Args<'a> {
    program: &'static str,
    args: std::slice::Iter<'a, String>,
}

impl<'a> Args<'a> {
    pub fn new(program: &'static str, args: &'a [String]) -> Self {
        Self { program, args: args.iter() }
    }

    pub fn next(&mut self) -> Option<&'a str> {
        self.args.next().map(String::as_str)
    }

    /// The next argument, which is a number that belongs to `option`.
    pub fn number(&mut self, option: &str, what: &str) -> Result<f64> {
        let text = self.text(option, what)?;
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.error(format!("{option}: expected {what}, found \"{text}\""))),
        }
    }

    /// The next argument, which belongs to `option`.
    pub fn text(&mut self, option: &str, what: &str) -> Result<&'a str> {
        self.next()
            .ok_or_else(|| self.error(format!("{option}: expected {what}, found the end of the command")))
    }

    pub fn error(&self, message: impl AsRef<str>) -> Error {
        Error::value(format!("{}: {}", self.program, message.as_ref()))
    }

    /// `-y year`; 0 is no year, as in the programs.
    pub fn year(&mut self, option: &str) -> Result<Option<i32>> {
        let year = self.number(option, "a year")?;
        if year.fract() != 0.0 || !(0.0..=9999.0).contains(&year) {
            return Err(self.error(format!("{option}: expected a year such as 2024, found {year}")));
        }
        Ok((year != 0.0).then_some(year as i32))
    }

    fn whole_number(&mut self, what: &str, most: u32) -> Result<u32> {
        let text = self.text(what, &format!("a whole number from 1 to {most}"))?;
        match text.parse::<f64>() {
            Ok(value) if value.fract() == 0.0 && value >= 1.0 && value <= f64::from(most) => Ok(value as u32),
            _ => Err(self.error(format!(
                "{what}: expected a whole number from 1 to {most} (or -ang), found \"{text}\""
            ))),
        }
    }
}

/// How the sun's place is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum When {
    /// `-ang altitude azimuth` [deg], azimuth from south, positive to the west.
    Angles { altitude_deg: f64, azimuth_west_of_south_deg: f64 },
    /// `month day hour`
    Time { date: Date, clock: Clock },
}

/// Read the first three arguments. `read_hour` reads the third of `month day hour`.
pub(super) fn when<'a>(
    args: &mut Args<'a>,
    read_hour: impl FnOnce(&Args<'a>, &str) -> Result<Clock>,
) -> Result<When> {
    let mut ahead = args.args.clone();
    match ahead.next().map(String::as_str) {
        None => Err(args.error("expected month day hour, or -ang altitude azimuth; found no arguments")),
        Some("-ang") => {
            args.next();
            let altitude_deg = args.number("-ang", "the sun's altitude [deg]")?;
            let azimuth = args.number("-ang", "the sun's azimuth [deg from south, west positive]")?;
            Ok(When::Angles { altitude_deg, azimuth_west_of_south_deg: azimuth })
        }
        Some(_) => {
            let month = args.whole_number("month", 12)?;
            let day = args.whole_number("day", 31)?;
            let hour = args.text("hour", "the hour of the day")?;
            Ok(When::Time { date: Date { year: None, month, day }, clock: read_hour(args, hour)? })
        }
    }
}

/// The warning of both programs, as a comment, if zone and longitude are more than three hours apart.
pub(super) fn meridian_comment(when: &When, site: &RadianceSite) -> Option<String> {
    let standard = matches!(when, When::Time { clock: Clock::Standard(_), .. });
    let apart_deg = site.longitude_west_deg - site.meridian_west_deg;
    (standard && apart_deg.abs() > 45.0)
        .then(|| format!("# warning - {:.1} hours btwn. standard meridian and longitude\n", apart_deg / 15.0))
}

/// The lines of `-defaults` that are the same in both programs.
pub(super) fn site_defaults() -> String {
    let site = RadianceSite::default();
    format!(
        "-a {:.6}\t\t\t# Site latitude (degrees)\n-o {:.6}\t\t\t# Site longitude (degrees)\n\
         -m {:.6}\t\t\t# Standard meridian (degrees)\n",
        site.latitude_deg, site.longitude_west_deg, site.meridian_west_deg
    )
}
