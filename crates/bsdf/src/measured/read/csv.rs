//! A plain table: a line of names, then numbers with commas between, in degrees.

use super::{Collected, Quantity, Text, direction, quantity};
use crate::measured::Scan;
use sunpeak_core::{Error, Result};

/// Names of the angles; a fifth column is `bsdf` or `dsf`.
const ANGLES: [&str; 4] = ["theta_in", "phi_in", "theta_out", "phi_out"];

/// Where the columns stand.
struct Names {
    angles: [usize; 4],
    value: usize,
    quantity: Quantity,
    count: usize,
}

impl Names {
    fn of(text: &Text, line: usize, said: &str) -> Result<Self> {
        let names: Vec<String> = said.split(',').map(|name| name.trim().to_ascii_lowercase()).collect();
        let wrong = |what: String| -> Error {
            let expected = "expected theta_in,phi_in,theta_out,phi_out and bsdf or dsf, in any order";
            text.error(line, format!("{what}; {expected}"))
        };
        let mut angles = [0; 4];
        for (place, name) in angles.iter_mut().zip(ANGLES) {
            *place =
                names.iter().position(|n| n == name).ok_or_else(|| wrong(format!("no column '{name}'")))?;
        }
        let values: Vec<(usize, Quantity)> =
            names.iter().enumerate().filter_map(|(at, name)| Some((at, quantity(name)?))).collect();
        let &[(value, quantity)] = &values[..] else {
            return Err(wrong(format!("{} columns of values", values.len())));
        };
        if names.len() != 5 {
            return Err(wrong(format!("{} columns", names.len())));
        }
        Ok(Self { angles, value, quantity, count: names.len() })
    }
}

/// The scans of a table, one for each incidence.
pub fn scans(text: &Text) -> Result<Vec<Scan>> {
    let mut rows = text.lines().filter(|(_, line)| !line.starts_with('#'));
    let Some((line, said)) = rows.next() else { return Ok(Vec::new()) };
    let names = Names::of(text, line, said)?;
    let mut collected = Collected::default();
    for (line, row) in rows {
        let numbers = text.numbers(line, row)?;
        if numbers.len() != names.count {
            let message =
                format!("{} numbers; expected {}, as the first line names", numbers.len(), names.count);
            return Err(text.error(line, message));
        }
        let [theta_in, phi_in, theta_out, phi_out] = names.angles.map(|at| numbers[at]);
        text.incidence(line, theta_in, phi_in)?;
        let reading = text.reading(line, [theta_out, phi_out], numbers[names.value], names.quantity)?;
        collected.add(text, line, direction(theta_in, phi_in), reading);
    }
    Ok(collected.scans)
}
