//! Scans of goniophotometers from files: what each format says, in one kind of [`Scan`].

mod astm;
mod csv;
mod pabopto;

use super::{Reading, Scan};
use std::{collections::BTreeMap, path::Path, sync::Arc};
use sunpeak_core::{Error, Location, Result, Vec3};

/// Exits closer to the surface's own plane than this are left out: there a DSF does not tell a BSDF [cosine].
const LEAST_COSINE: f64 = 1e-3;

/// What a value in a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    /// BSDF [1/sr].
    Bsdf,
    /// BSDF times the cosine of the exit [1/sr].
    Dsf,
}

/// The format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    PabOpto,
    Astm,
    Csv,
}

/// Read the scans of a file, whatever format it is in.
pub fn read(path: &Path) -> Result<Vec<Scan>> {
    let bytes = std::fs::read(path).map_err(|e| Error::io(path, e))?;
    let file: Arc<str> = path.display().to_string().into();
    let text = std::str::from_utf8(&bytes).map_err(|e| {
        let place = Location::of_offset(file.clone(), &bytes, e.valid_up_to());
        Error::input(place, "bytes that are no text; expected a scan as text (pab-opto, ASTM columns or CSV)")
    })?;
    parse(file, text)
}

/// The scans of a text.
pub fn parse(file: Arc<str>, text: &str) -> Result<Vec<Scan>> {
    let text = Text { file, text };
    match text.format()? {
        Format::PabOpto => pabopto::scans(&text),
        Format::Astm => astm::scans(&text),
        Format::Csv => csv::scans(&text),
    }
}

/// A text with its name.
struct Text<'a> {
    file: Arc<str>,
    text: &'a str,
}

impl<'a> Text<'a> {
    /// Lines that are not blank, with their numbers.
    fn lines(&self) -> impl Iterator<Item = (usize, &'a str)> {
        self.text
            .lines()
            .enumerate()
            .map(|(n, line)| (n + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty())
    }

    fn error(&self, line: usize, message: impl Into<String>) -> Error {
        Error::input(Location::new(self.file.clone(), line, 0), message)
    }

    fn format(&self) -> Result<Format> {
        if self.lines().any(|(_, line)| astm::is_names(line)) {
            return Ok(Format::Astm);
        }
        let mut bare = self.lines().filter(|(_, line)| !line.starts_with('#'));
        match bare.next() {
            None => Err(self.error(0, "no readings; expected lines of angles and a value")),
            Some((_, line)) if line.starts_with(|c: char| c.is_ascii_alphabetic()) => Ok(Format::Csv),
            Some(_) => Ok(Format::PabOpto),
        }
    }

    /// All numbers of a line, between commas or blanks.
    fn numbers(&self, line: usize, text: &str) -> Result<Vec<f64>> {
        let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
        words.map(|word| self.number(line, word)).collect()
    }

    fn number(&self, line: usize, word: &str) -> Result<f64> {
        let value: f64 =
            word.parse().map_err(|_| self.error(line, format!("'{word}'; expected a number")))?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(line, format!("{word}; expected a finite number")))
        }
    }

    /// An angle from the front normal [deg].
    fn polar(&self, line: usize, name: &str, theta_deg: f64) -> Result<f64> {
        if (0.0..=180.0).contains(&theta_deg) {
            return Ok(theta_deg);
        }
        Err(self
            .error(line, format!("{name} is {theta_deg}; expected 0 to 180 degrees from the front normal")))
    }

    /// An incidence, which may not graze.
    fn incidence(&self, line: usize, theta_deg: f64, phi_deg: f64) -> Result<Vec3> {
        let theta_deg = self.polar(line, "angle of incidence", theta_deg)?;
        if (theta_deg - 90.0).abs() < 0.5 {
            let message =
                format!("angle of incidence is {theta_deg}; expected half a degree or more off the surface");
            return Err(self.error(line, message));
        }
        Ok(direction(theta_deg, phi_deg))
    }

    /// A reading; none where it lies in the surface's own plane.
    fn reading(
        &self,
        line: usize,
        [theta_deg, phi_deg]: [f64; 2],
        value: f64,
        quantity: Quantity,
    ) -> Result<Option<Reading>> {
        let exit = direction(self.polar(line, "angle of exit", theta_deg)?, phi_deg);
        let cosine = exit.z.abs();
        if cosine < LEAST_COSINE {
            return Ok(None);
        }
        let value = if quantity == Quantity::Dsf { value / cosine } else { value };
        Ok(Some(Reading { exit, value }))
    }
}

/// The quantity of a column by its name.
fn quantity(name: &str) -> Option<Quantity> {
    match name.to_ascii_lowercase().as_str() {
        "bsdf" | "brdf" | "btdf" => Some(Quantity::Bsdf),
        "dsf" => Some(Quantity::Dsf),
        _ => None,
    }
}

/// A unit vector by its angle from the front normal and its azimuth from x [deg].
fn direction(theta_deg: f64, phi_deg: f64) -> Vec3 {
    let ((sine, cosine), azimuth) = (theta_deg.to_radians().sin_cos(), phi_deg.to_radians());
    Vec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine)
}

/// Readings of a list by their incidence, in the order of first appearance.
#[derive(Default)]
struct Collected {
    known: BTreeMap<[i64; 3], usize>,
    scans: Vec<Scan>,
}

impl Collected {
    fn add(&mut self, text: &Text, line: usize, incidence: Vec3, reading: Option<Reading>) {
        // Written angles are good to six digits or so.
        let key = incidence.to_array().map(|v| (v * 1e6).round() as i64);
        let at = *self.known.entry(key).or_insert_with(|| {
            self.scans.push(Scan::new(text.file.clone(), line, incidence));
            self.scans.len() - 1
        });
        self.scans[at].readings.extend(reading);
    }
}
