//! Commands in scene files, done inside: `xform`, `genbox` and other generators, `gensky`, `gendaylit`, `cat`, and pipes of them.

mod genbox;
mod genbox_round;
mod generate;
mod outside;
mod run;
mod shell;
mod sky;
mod transform_args;
mod xform;
mod xform_apply;
mod xform_run;

use crate::{
    LoadOptions,
    files::{folder_of, read},
    raw::{self, CommandLine, Item, Primitive},
};
use run::Run;
use std::path::{Path, PathBuf};
use sunpeak_core::{Error, Result};

pub use transform_args::trailing_transform;
pub use xform::Invocation;

/// Commands whose output holds commands, and so on: deeper than this they make themselves.
const MAX_DEPTH: usize = 64;
/// More than any scene has; a few more would not fit into memory.
const MAX_PRIMITIVES: usize = 20_000_000;

/// Turns items into primitives by doing their commands.
pub struct Expander<'o> {
    options: &'o LoadOptions,
    /// What is odd but no error.
    pub warnings: Vec<String>,
    /// Files that are being read, to find one that includes itself.
    open: Vec<PathBuf>,
    depth: usize,
    copies: usize,
    /// Where mistakes are gathered, if they do not end the reading.
    mistakes: Option<Vec<Error>>,
}

impl<'o> Expander<'o> {
    /// With nothing read yet.
    pub fn new(options: &'o LoadOptions) -> Self {
        Self { options, warnings: Vec::new(), open: Vec::new(), depth: 0, copies: 0, mistakes: None }
    }

    /// One that goes on after mistakes, and gathers them.
    pub fn gathering(options: &'o LoadOptions) -> Self {
        Self { mistakes: Some(Vec::new()), ..Self::new(options) }
    }

    /// The mistakes so far, if they are gathered.
    pub fn take_mistakes(&mut self) -> Vec<Error> {
        self.mistakes.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Keep a mistake, or end with it.
    fn tolerate(&mut self, mistake: Error) -> Result<()> {
        match &mut self.mistakes {
            Some(mistakes) => {
                mistakes.push(mistake);
                Ok(())
            }
            None => Err(mistake),
        }
    }

    /// The items of a scene text.
    pub fn parse(&mut self, text: &[u8], name: &str, directory: &Path) -> Result<Vec<Item>> {
        let Some(mistakes) = &mut self.mistakes else { return raw::parse(text, name, directory) };
        let (items, found) = raw::parse_all(text, name, directory);
        mistakes.extend(found);
        Ok(items)
    }

    /// The primitives of a file, commands in it done in the folder `cwd`.
    pub fn file(&mut self, path: &Path, cwd: &Path) -> Result<Vec<Primitive>> {
        let items = self.read_items(path)?;
        self.while_open(path, |expander| expander.expand(items, cwd))
    }

    /// Do the commands among the items, in the folder `cwd`.
    pub fn expand(&mut self, items: Vec<Item>, cwd: &Path) -> Result<Vec<Primitive>> {
        let mut primitives = Vec::with_capacity(items.len());
        for item in items {
            match item {
                Item::Primitive(primitive) => primitives.push(primitive),
                Item::Command(command) => match self.command(&command, cwd) {
                    Ok(made) => primitives.extend(made),
                    Err(mistake) => self.tolerate(mistake)?,
                },
            }
        }
        Ok(primitives)
    }

    fn command(&mut self, command: &CommandLine, cwd: &Path) -> Result<Vec<Primitive>> {
        if self.depth >= MAX_DEPTH {
            let message =
                format!("commands within commands, more than {MAX_DEPTH} deep: do they make themselves?");
            return Err(Error::input(command.location.clone(), message));
        }
        self.depth += 1;
        let items = Run { command, cwd, expander: self }.pipeline();
        let primitives = items.and_then(|items| self.expand(items, cwd));
        self.depth -= 1;
        primitives
    }

    fn read_items(&mut self, path: &Path) -> Result<Vec<Item>> {
        let items = self.parse(&read(path)?, &path.to_string_lossy(), &folder_of(path))?;
        if items.is_empty() {
            self.warnings.push(format!("{}: an empty file", path.display()));
        }
        Ok(items)
    }

    fn while_open<T>(&mut self, path: &Path, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        self.open.push(path);
        let result = work(self);
        self.open.pop();
        result
    }

    fn is_open(&self, path: &Path) -> bool {
        path.canonicalize().is_ok_and(|path| self.open.contains(&path))
    }

    /// Count primitives that are made by copying.
    fn count_copies(&mut self, copies: usize, command: &CommandLine) -> Result<()> {
        self.copies += copies;
        if self.copies <= MAX_PRIMITIVES {
            return Ok(());
        }
        let message = format!("more than {MAX_PRIMITIVES} copied primitives: are the counts after -a right?");
        Err(Error::input(command.location.clone(), message))
    }
}
