//! Scene files to a scene.

use crate::{
    LoadOptions, Scene,
    command::Expander,
    interpret::Interpreter,
    raw::{self, CommandLine, Item, Primitive},
};
use std::path::{Path, PathBuf};
use sunpeak_core::{Location, Result};

/// Where a part of a scene comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A scene file, or with `!` before it a command.
    File(PathBuf),
    /// A text that is at hand.
    Text {
        /// What messages call it.
        name: String,
        /// The scene text.
        text: Vec<u8>,
        /// The folder where files that it names are looked for.
        directory: PathBuf,
    },
}

impl Scene {
    /// Read scene files, in order: a material serves the files after its own too. A name that begins with `!` is
    /// a command.
    pub fn load(files: &[PathBuf], options: &LoadOptions) -> Result<Self> {
        let sources: Vec<_> = files.iter().cloned().map(Source::File).collect();
        Self::load_sources(&sources, options)
    }

    /// Read files and texts, in order.
    pub fn load_sources(sources: &[Source], options: &LoadOptions) -> Result<Self> {
        let mut expander = Expander::new(options);
        let mut interpreter = Interpreter::new(options);
        for source in sources {
            read_into(&mut interpreter, load_source(&mut expander, source, options)?)?;
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
pub fn load_primitives(sources: &[Source], options: &LoadOptions) -> Result<Vec<Primitive>> {
    let mut expander = Expander::new(options);
    let mut primitives = Vec::new();
    for source in sources {
        primitives.extend(load_source(&mut expander, source, options)?);
    }
    Ok(primitives)
}

pub(crate) fn load_source(
    expander: &mut Expander,
    source: &Source,
    options: &LoadOptions,
) -> Result<Vec<Primitive>> {
    match source {
        Source::File(file) => load_file(expander, file, options),
        Source::Text { name, text, directory } => {
            let items = expander.parse(text, name, directory)?;
            expander.expand(items, &options.base())
        }
    }
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
