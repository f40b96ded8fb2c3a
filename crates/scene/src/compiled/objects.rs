//! A scene in binary: a list of the names of types, then the primitives, each with the number of its type and of its modifier.

use super::reader::Reader;
use crate::raw::{Class, Primitive, PrimitiveType};
use std::{path::Path, sync::Arc};
use sunpeak_core::{Location, Result};

/// A modifier that is none.
const NO_MODIFIER: i64 = -1;
/// More types than Radiance will ever have.
const MAX_TYPES: usize = 128;

/// Primitives as if they stood in a scene file. What the file has no type for is kept from use by an unknown name.
pub fn read_objects(reader: &mut Reader) -> Result<Vec<Primitive>> {
    let types = read_types(reader)?;
    let (location, directory): (Location, Arc<Path>) = (reader.location(), reader.folder().into());
    let mut primitives: Vec<Primitive> = Vec::new();
    loop {
        let number = reader.integer(1)?;
        if number == -1 {
            return Ok(primitives);
        }
        let Some(kind) = usize::try_from(number).ok().and_then(|n| types.get(n)) else {
            return Err(reader.error(format!("a damaged file: a primitive of type number {number}")));
        };
        let kind = kind.as_ref().map_err(|name| {
            reader.error(format!("unknown primitive \"{name}\": expected a type such as polygon or plastic"))
        })?;
        let above = reader.integer(reader.object_size)?;
        let modifier: Arc<str> = match usize::try_from(above).ok().and_then(|n| primitives.get(n)) {
            Some(modifier) => modifier.name.as_str().into(),
            None if above == NO_MODIFIER => "void".into(),
            None => return Err(reader.error(format!("a damaged file: modifier number {above}"))),
        };
        let name = reader.string()?;
        let count = reader.integer(2)?;
        let strings = (0..count).map(|_| reader.string()).collect::<Result<Vec<_>>>()?;
        let count = reader.integer(2)?;
        let reals = (0..count).map(|_| reader.real()).collect::<Result<Vec<_>>>()?;
        // An alias without a name is its modifier, under another name.
        let (modifier, strings) = match kind.class {
            Class::Alias if strings.is_empty() => ("inherit".into(), vec![modifier.to_string()]),
            _ => (modifier, strings),
        };
        let (location, directory) = (location.clone(), directory.clone());
        primitives.push(Primitive { modifier, kind, name, strings, reals, location, directory });
    }
}

/// The types in the order of their numbers; `Err` holds the name of one that we do not know.
fn read_types(reader: &mut Reader) -> Result<Vec<std::result::Result<&'static PrimitiveType, String>>> {
    let mut types = Vec::new();
    loop {
        let name = reader.string()?;
        if name.is_empty() {
            return Ok(types);
        }
        if types.len() >= MAX_TYPES {
            return Err(reader.error("a damaged file: too many types of primitives"));
        }
        types.push(PrimitiveType::find(&name).ok_or(name));
    }
}
