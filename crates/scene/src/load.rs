//! Scene files to a scene.

use crate::{
    LoadOptions, Scene,
    command::Expander,
    interpret::Interpreter,
    raw::{self, CommandLine, Item, Primitive},
};
use std::path::{Path, PathBuf};
use sunpeak_core::{Location, Result};

impl Scene {
    /// Read scene files, in order: a material serves the files after its own too. A name that begins with `!` is
    /// a command.
    pub fn load(files: &[PathBuf], options: &LoadOptions) -> Result<Self> {
        let mut expander = Expander::new(options);
        let mut interpreter = Interpreter::new(options);
        for file in files {
            read_into(&mut interpreter, load_file(&mut expander, file, options)?)?;
        }
        Ok(finish(interpreter, expander))
    }

    /// Read a scene from a text; error messages call it `name`.
    pub fn parse(text: &str, name: &str, options: &LoadOptions) -> Result<Self> {
        let cwd = options.base();
        let items = raw::parse(text.as_bytes(), name, &cwd)?;
        let mut expander = Expander::new(options);
        let mut interpreter = Interpreter::new(options);
        read_into(&mut interpreter, expander.expand(items, &cwd)?)?;
        Ok(finish(interpreter, expander))
    }
}

/// The primitives of scene files after all commands in them are done, before anything is made of them.
pub fn load_primitives(files: &[PathBuf], options: &LoadOptions) -> Result<Vec<Primitive>> {
    let mut expander = Expander::new(options);
    let mut primitives = Vec::new();
    for file in files {
        primitives.extend(load_file(&mut expander, file, options)?);
    }
    Ok(primitives)
}

fn load_file(expander: &mut Expander, file: &Path, options: &LoadOptions) -> Result<Vec<Primitive>> {
    let cwd = options.base();
    if let Some(text) = file.to_str().and_then(|name| name.strip_prefix('!')) {
        let location = Location::new("command line", 0, 0);
        let directory = cwd.as_path().into();
        let command = CommandLine { text: text.to_string(), location, directory };
        return expander.expand(vec![Item::Command(command)], &cwd);
    }
    expander.file(&cwd.join(file), &cwd)
}

fn read_into(interpreter: &mut Interpreter, primitives: Vec<Primitive>) -> Result<()> {
    primitives.into_iter().try_for_each(|primitive| interpreter.add(primitive))
}

fn finish(interpreter: Interpreter, expander: Expander) -> Scene {
    let mut scene = interpreter.finish();
    scene.warnings.splice(0..0, expander.warnings);
    scene
}
