//! The scene language as written: words, primitives and commands, before anything is made of them.

mod cursor;
mod number;
mod parse;
mod print;
mod types;

use std::{path::Path, sync::Arc};
use sunpeak_core::Location;

pub use number::{parse_integer, parse_real};
pub use parse::{parse, parse_all};
pub use types::{Class, PrimitiveType};

/// One primitive, with its arguments as they stand in the file.
#[derive(Clone, Debug)]
pub struct Primitive {
    /// The name of its modifier.
    pub modifier: Arc<str>,
    /// Its type.
    pub kind: &'static PrimitiveType,
    /// Its own name.
    pub name: String,
    /// String arguments; for an alias the name that it refers to.
    pub strings: Vec<String>,
    /// Real arguments, all finite. (No primitive has integer arguments.)
    pub reals: Vec<f64>,
    /// Where its first word stands.
    pub location: Location,
    /// The folder of the file that it stands in, where files that it names are looked for.
    pub directory: Arc<Path>,
}

/// A `!command` line.
#[derive(Clone, Debug)]
pub struct CommandLine {
    /// What follows the `!`, escaped line ends included.
    pub text: String,
    /// Where the `!` stands.
    pub location: Location,
    /// The folder of the file that it stands in.
    pub directory: Arc<Path>,
}

/// What a scene file is made of.
#[derive(Clone, Debug)]
pub enum Item {
    /// A surface, a material, …
    Primitive(Primitive),
    /// Something to run, whose output is read in its place.
    Command(CommandLine),
}
