//! Columns in the manner of ASTM E1392 and E2387: lines of a keyword and its value, a line `VARS` that names the columns, and the
//! readings with commas between. Angles are in radians, as in the files of Cornell's Light Measurement Laboratory, unless a line
//! `ANGLE_UNITS degrees` stands before.

use super::{Collected, Quantity, Text, direction, quantity};
use crate::measured::Scan;
use sunpeak_core::{Error, Result};

const NAMES: &str = "VARS";

/// Names of the angles, in this order.
const ANGLES: [&str; 4] = ["theta_i", "phi_i", "theta_s", "phi_s"];

/// Radiance's weights for luminance from R, G and B.
const LUMINANCE: [f64; 3] = [0.265, 0.670, 0.065];

/// Is this the line that names the columns?
pub fn is_names(line: &str) -> bool {
    keyword(line).0 == NAMES
}

fn keyword(line: &str) -> (&str, &str) {
    let (key, rest) = line.split_once(|c: char| c.is_whitespace() || c == '=').unwrap_or((line, ""));
    (key, rest.trim_start_matches(|c: char| c.is_whitespace() || c == '=').trim_end())
}

/// What stands before the readings.
struct Header {
    name: String,
    /// Degrees in a unit of the angles.
    unit_deg: f64,
    /// Number of readings, where the file says it, and the line in which it does.
    count: Option<(usize, usize)>,
    /// `BRDF`, `BTDF`, `BSDF`, if said.
    kind: Option<String>,
    /// What each value counts for the luminous one.
    weights: Vec<f64>,
    quantity: Quantity,
}

impl Header {
    fn take(&mut self, text: &Text, line: usize, said: &str) -> Result<()> {
        let (key, rest) = keyword(said);
        match key {
            "NUM_POINTS" => {
                let count = rest.parse().map_err(|_| {
                    text.error(line, format!("NUM_POINTS {rest}; expected the number of readings"))
                })?;
                self.count = Some((count, line));
            }
            "ANGLE_UNITS" => self.unit_deg = unit_deg(text, line, rest)?,
            "TYPE" => self.kind = Some(rest.to_ascii_uppercase()),
            "SAMPLE" | "SAMPLE_NAME" => self.name = rest.trim_matches('"').to_owned(),
            NAMES => self.columns(text, line, rest)?,
            _ => {}
        }
        Ok(())
    }

    fn columns(&mut self, text: &Text, line: usize, rest: &str) -> Result<()> {
        let names: Vec<&str> = rest.split(',').map(str::trim).collect();
        let wrong = |what: &str| -> Error {
            let expected = "theta_i,phi_i,theta_s,phi_s and one value, or X,Y,Z, or R,G,B";
            text.error(line, format!("VARS {rest}: {what}; expected {expected}"))
        };
        if names.len() < 5 || names[..4] != ANGLES {
            return Err(wrong("other columns"));
        }
        let upper: Vec<String> = names[4..].iter().map(|name| name.to_ascii_uppercase()).collect();
        self.weights = match upper.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            ["X", "Y", "Z"] => vec![0.0, 1.0, 0.0],
            ["R", "G", "B"] => LUMINANCE.to_vec(),
            [_] => vec![1.0],
            _ => return Err(wrong("several values")),
        };
        if let [one] = &upper[..] {
            self.quantity = quantity(one).unwrap_or(Quantity::Bsdf);
            if ["BRDF", "BTDF"].contains(&one.as_str()) {
                self.kind.get_or_insert_with(|| one.clone());
            }
        }
        Ok(())
    }

    /// The exit's angle from the front normal: that of a BTDF may be given from the normal of the side on which light leaves.
    fn exit_deg(&self, text: &Text, line: usize, incident_deg: f64, exit_deg: f64) -> Result<f64> {
        let same_side = (incident_deg < 90.0) == (exit_deg < 90.0);
        match self.kind.as_deref() {
            Some("BTDF") if same_side => Ok(180.0 - exit_deg),
            Some("BRDF") if !same_side => {
                let message =
                    format!("theta_s is {exit_deg} degrees; expected the side of the light in a BRDF");
                Err(text.error(line, message))
            }
            _ => Ok(exit_deg),
        }
    }
}

fn unit_deg(text: &Text, line: usize, rest: &str) -> Result<f64> {
    match rest.to_ascii_lowercase().as_str() {
        "degrees" | "deg" => Ok(1.0),
        "radians" | "rad" => Ok(1.0_f64.to_degrees()),
        _ => Err(text.error(line, format!("ANGLE_UNITS {rest}; expected degrees or radians"))),
    }
}

/// The scans of a file, one for each incidence.
pub fn scans(text: &Text) -> Result<Vec<Scan>> {
    let mut header = Header {
        name: String::new(),
        unit_deg: 1.0_f64.to_degrees(),
        count: None,
        kind: None,
        weights: Vec::new(),
        quantity: Quantity::Bsdf,
    };
    let mut lines = text.lines().filter(|(_, line)| !line.starts_with('#'));
    for (line, said) in lines.by_ref() {
        header.take(text, line, said)?;
        if is_names(said) {
            break;
        }
    }
    let (mut collected, mut count) = (Collected::default(), 0);
    for (line, row) in lines {
        let numbers = text.numbers(line, row)?;
        if numbers.len() != 4 + header.weights.len() {
            let expected = 4 + header.weights.len();
            return Err(
                text.error(line, format!("{} numbers; expected {expected}, as VARS names", numbers.len()))
            );
        }
        let [theta_i, phi_i, theta_s, phi_s] = [0, 1, 2, 3].map(|at: usize| numbers[at] * header.unit_deg);
        text.incidence(line, theta_i, phi_i)?;
        let theta_s = header.exit_deg(text, line, theta_i, theta_s)?;
        let value = header.weights.iter().zip(&numbers[4..]).map(|(w, v)| w * v).sum();
        let reading = text.reading(line, [theta_s, phi_s], value, header.quantity)?;
        collected.add(text, line, direction(theta_i, phi_i), reading);
        count += 1;
    }
    if let Some((said, line)) = header.count.filter(|c| c.0 != count) {
        return Err(text.error(line, format!("NUM_POINTS {said}, and {count} readings; expected as many")));
    }
    let mut scans = collected.scans;
    scans.iter_mut().for_each(|scan| scan.name.clone_from(&header.name));
    Ok(scans)
}
