//! Files of pab-opto's goniophotometers: one incidence a file, a header of lines with `#`, and a line of angles and value for each
//! reading. What the header means is as in Radiance's manual of `pabopto2bsdf`.

use super::{Quantity, Text, direction, quantity};
use crate::measured::Scan;
use sunpeak_core::Result;

/// Azimuth of "up" in a BSDF's frame, and where a file does not say [deg].
const UP_DEG: f64 = 90.0;
const UP_UNSAID_DEG: f64 = 0.0;

/// What the header has said.
struct Header {
    name: String,
    theta_deg: Option<f64>,
    phi_deg: Option<f64>,
    up_deg: f64,
    quantity: Option<Quantity>,
    /// Values a reading: one, or CIE X, Y and Z.
    values: usize,
    /// Line of the incidence.
    line: usize,
}

impl Header {
    fn take(&mut self, text: &Text, line: usize, said: &str) -> Result<()> {
        let (key, rest) = said.split_once(char::is_whitespace).unwrap_or((said, ""));
        let rest = rest.trim();
        match key {
            "sample_name" => self.name = rest.trim_matches('"').to_owned(),
            "format:" => self.quantity = Some(format(text, line, rest)?),
            "colorimetry:" => self.values = colorimetry(text, line, rest)?,
            "upphi" => self.up_deg = one(text, line, key, rest)?,
            "intheta" => (self.theta_deg, self.line) = (Some(one(text, line, key, rest)?), line),
            "inphi" => self.phi_deg = Some(one(text, line, key, rest)?),
            "incident_angle" | "incidence_angle" => {
                let [theta, phi] = text.numbers(line, rest)?[..] else {
                    let message = format!("#{key} {rest}; expected two angles, theta and phi, in degrees");
                    return Err(text.error(line, message));
                };
                (self.theta_deg, self.phi_deg, self.line) = (Some(theta), Some(phi), line);
            }
            _ => {}
        }
        Ok(())
    }
}

fn one(text: &Text, line: usize, key: &str, rest: &str) -> Result<f64> {
    match text.numbers(line, rest)?[..] {
        [value] => Ok(value),
        _ => Err(text.error(line, format!("#{key} {rest}; expected one angle in degrees"))),
    }
}

fn format(text: &Text, line: usize, rest: &str) -> Result<Quantity> {
    let mut words = rest.split_whitespace();
    let known = match (words.next(), words.next(), words.next(), words.next()) {
        (Some("theta"), Some("phi"), Some(name), None) => quantity(name),
        _ => None,
    };
    let message = || format!("#format: {rest}; expected 'theta phi DSF' or 'theta phi BSDF' (BRDF, BTDF)");
    known.ok_or_else(|| text.error(line, message()))
}

fn colorimetry(text: &Text, line: usize, rest: &str) -> Result<usize> {
    match rest.to_ascii_uppercase().as_str() {
        "CIE-Y" => Ok(1),
        "CIE-XYZ" => Ok(3),
        _ => Err(text.error(line, format!("#colorimetry: {rest}; expected CIE-Y or CIE-XYZ"))),
    }
}

/// The one scan of a file.
pub fn scans(text: &Text) -> Result<Vec<Scan>> {
    let mut header = Header {
        name: String::new(),
        theta_deg: None,
        phi_deg: None,
        up_deg: UP_UNSAID_DEG,
        quantity: None,
        values: 1,
        line: 0,
    };
    let mut rows = Vec::new();
    for (line, said) in text.lines() {
        match said.strip_prefix('#') {
            None => rows.push((line, said)),
            Some(said) if rows.is_empty() => header.take(text, line, said.trim_start())?,
            // Remarks between readings.
            Some(_) => {}
        }
    }
    let quantity = header
        .quantity
        .ok_or_else(|| text.error(0, "no '#format:'; expected '#format: theta phi DSF' or BSDF"))?;
    let (Some(theta), Some(phi)) = (header.theta_deg, header.phi_deg) else {
        let message = "no incidence; expected '#incident_angle THETA PHI', or '#intheta' and '#inphi'";
        return Err(text.error(0, message));
    };
    let turn = UP_DEG - header.up_deg;
    text.incidence(header.line, theta, phi)?;
    let mut scan = Scan::new(text.file.clone(), header.line, direction(theta, phi + turn));
    scan.name = header.name;
    for (line, row) in rows {
        let numbers = text.numbers(line, row)?;
        if numbers.len() != 2 + header.values {
            let message = format!(
                "{} numbers; expected {}: theta, phi and the value",
                numbers.len(),
                2 + header.values
            );
            return Err(text.error(line, message));
        }
        // Of X, Y and Z the second is luminous.
        let value = numbers[2 + header.values / 2];
        scan.readings.extend(text.reading(line, [numbers[0], numbers[1] + turn], value, quantity)?);
    }
    Ok(vec![scan])
}
