//! Programs that make surfaces: what they are written with in common.
//!
//! The order of the surfaces, of their vertices, and their names are those of Radiance's programs of the same names, so that scripts
//! that pick surfaces by name or number go on working.

mod functions;
mod genblinds;
mod genprism;
mod genrev;
mod gensurf;
mod genworm;

use crate::raw::{CommandLine, Primitive, PrimitiveType, parse_integer, parse_real};
use std::sync::Arc;

/// More surfaces than a program is asked for on purpose.
const MAX_SURFACES: usize = 4_000_000;

/// Makes the primitives of `name`; `None` if it is none of these programs. `read` gives the text of a file that is named.
pub(super) fn run(
    name: &str,
    args: &[String],
    command: &CommandLine,
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Option<Result<Vec<Primitive>, String>> {
    let made = match name {
        "genblinds" => genblinds::run(args, command),
        "genprism" => genprism::run(args, command, read),
        "genrev" => genrev::run(args, command, read),
        "gensurf" => gensurf::run(args, command, read),
        "genworm" => genworm::run(args, command, read),
        _ => return None,
    };
    Some(made.map_err(|message| format!("{name}: {message}")))
}

/// Gathers the surfaces of one material, named after one object.
struct Maker<'c> {
    command: &'c CommandLine,
    material: Arc<str>,
    name: String,
    made: Vec<Primitive>,
}

impl<'c> Maker<'c> {
    /// With material and name from the front of the arguments; what is left of them.
    fn new<'a>(
        command: &'c CommandLine,
        args: &'a [String],
        usage: &str,
    ) -> Result<(Self, &'a [String]), String> {
        let [material, name, rest @ ..] = args else { return Err(format!("expected {usage}")) };
        let maker =
            Self { command, material: material.as_str().into(), name: name.clone(), made: Vec::new() };
        Ok((maker, rest))
    }

    fn add(&mut self, kind: &'static str, suffix: &str, reals: Vec<f64>) -> Result<(), String> {
        let name = format!("{}.{suffix}", self.name);
        self.push(kind, name, Vec::new(), reals)
    }

    /// A modifier of the surfaces to come, with string arguments.
    fn add_modifier(
        &mut self,
        kind: &'static str,
        name: &str,
        strings: &[&str],
        reals: Vec<f64>,
    ) -> Result<(), String> {
        self.push(kind, name.into(), strings.iter().map(ToString::to_string).collect(), reals)
    }

    fn push(
        &mut self,
        kind: &'static str,
        name: String,
        strings: Vec<String>,
        reals: Vec<f64>,
    ) -> Result<(), String> {
        if self.made.len() >= MAX_SURFACES {
            return Err(format!("more than {MAX_SURFACES} surfaces: are the counts right?"));
        }
        if !reals.iter().all(|real| real.is_finite()) {
            return Err(format!("{} \"{}\" has a number that is not finite", kind, name));
        }
        let Some(kind) = PrimitiveType::find(kind) else { return Ok(()) };
        self.made.push(Primitive {
            modifier: self.material.clone(),
            kind,
            name,
            strings,
            reals,
            location: self.command.location.clone(),
            directory: self.command.directory.clone(),
        });
        Ok(())
    }
}

/// Refuse options that nothing knows.
fn no_flags(options: &functions::Options, usage: &str) -> Result<(), String> {
    match options.flags.first() {
        None => Ok(()),
        Some(&"-s") => Err(
            "smoothing (-s) is not done inside: leave it out, or put the output of the program into a file"
                .into(),
        ),
        Some(flag) => Err(format!("unknown option {flag}: expected {usage}")),
    }
}

fn real(word: Option<&String>, what: &str) -> Result<f64, String> {
    word.and_then(|word| parse_real(word))
        .ok_or_else(|| format!("expected {what}, a number, found {}", found(word)))
}

fn count(word: Option<&String>, what: &str) -> Result<usize, String> {
    let count = word.and_then(|word| parse_integer(word)).and_then(|n| usize::try_from(n).ok());
    count
        .filter(|&n| (1..=MAX_SURFACES).contains(&n))
        .ok_or_else(|| format!("expected {what}, a whole number from 1, found {}", found(word)))
}

fn found(word: Option<&String>) -> String {
    word.map_or("the end".into(), |word| format!("\"{word}\""))
}
