//! One command line: its pipe, stage by stage.

use super::{Expander, genbox, generate, outside, shell, sky};
use crate::{
    files::read,
    raw::{self, CommandLine, Item},
};
use std::path::{Path, PathBuf};
use sunpeak_core::{Error, Result};

/// Programs that are done inside.
const KNOWN: [&str; 10] = [
    "xform",
    "genbox",
    "genprism",
    "genblinds",
    "genrev",
    "gensurf",
    "genworm",
    "gensky",
    "gendaylit",
    "cat",
];

/// One command line being done.
pub(super) struct Run<'r, 'o> {
    pub command: &'r CommandLine,
    pub cwd: &'r Path,
    pub expander: &'r mut Expander<'o>,
}

impl Run<'_, '_> {
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::input(self.command.location.clone(), message)
    }

    pub fn pipeline(&mut self) -> Result<Vec<Item>> {
        let allowed = self.expander.options.allow_commands;
        let stages = match shell::split(&self.command.text) {
            Ok(stages) => stages,
            Err(_) if allowed => return self.outside(),
            Err(message) => {
                let text = self.command.text.trim();
                let hint = "commands run inside Sunpeak, not in a shell, unless commands are allowed";
                return Err(self.error(format!("cannot run \"!{text}\": {message} ({hint})")));
            }
        };
        if let Some(unknown) = stages.iter().find(|stage| !KNOWN.contains(&program(stage))) {
            return if allowed { self.outside() } else { Err(self.refusal(program(unknown))) };
        }
        let mut items = None;
        for stage in &stages {
            items = Some(self.stage(stage, items)?);
        }
        Ok(items.unwrap_or_default())
    }

    fn refusal(&self, name: &str) -> Error {
        let known = KNOWN.join(", ");
        self.error(format!(
            "the command \"{name}\" is not run: Sunpeak does {known} itself; others run only if commands are allowed \
             (--allow-commands), or put the output of this one into a file"
        ))
    }

    fn outside(&mut self) -> Result<Vec<Item>> {
        let output = outside::run(&self.command.text, self.cwd).map_err(|message| self.error(message))?;
        let complaint = output.complaint.lines().map(|line| format!("{}: {line}", self.command.location));
        self.expander.warnings.extend(complaint);
        self.parse_output(&output.text)
    }

    fn stage(&mut self, stage: &[String], input: Option<Vec<Item>>) -> Result<Vec<Item>> {
        let args = &stage[1..];
        match program(stage) {
            "xform" => self.xform(args, input),
            "genbox" => {
                let CommandLine { location, directory, .. } = self.command;
                let made = genbox::run(args, location, directory).map_err(|message| self.error(message))?;
                Ok(made.into_iter().map(Item::Primitive).collect())
            }
            "cat" => self.cat(args, input),
            name @ ("gensky" | "gendaylit") => {
                let text = sky::run(name, args).map_err(|error| self.error(error.to_string()))?;
                self.parse_output(text.as_bytes())
            }
            name => self.generate(name, args),
        }
    }

    fn generate(&mut self, name: &str, args: &[String]) -> Result<Vec<Item>> {
        let made = generate::run(name, args, self.command, &mut |file| self.text_of(file));
        let made = made.unwrap_or_else(|| Err(format!("{name}: not done inside")));
        let primitives = made.map_err(|message| self.error(message))?;
        Ok(primitives.into_iter().map(Item::Primitive).collect())
    }

    /// The text of a file that an argument names.
    pub fn text_of(&self, name: &str) -> std::result::Result<String, String> {
        let bytes = self.find(name).and_then(|path| read(&path)).map_err(|error| error.to_string())?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Nobody sees the output of a command, so what is in it stands where the command stands.
    fn parse_output(&self, text: &[u8]) -> Result<Vec<Item>> {
        let CommandLine { location, directory, text: line } = self.command;
        let name = format!("output of \"!{}\"", line.trim());
        let mut items =
            raw::parse(text, &name, directory).map_err(|error| self.error(format!("in the {error}")))?;
        for item in &mut items {
            match item {
                Item::Primitive(primitive) => primitive.location = location.clone(),
                Item::Command(command) => command.location = location.clone(),
            }
        }
        Ok(items)
    }

    fn cat(&mut self, files: &[String], input: Option<Vec<Item>>) -> Result<Vec<Item>> {
        if files.is_empty() {
            return input.ok_or_else(|| self.error("cat: expected a file"));
        }
        let mut items = Vec::new();
        for name in files {
            let path = self.find(name)?;
            items.extend(self.expander.read_items(&path)?);
        }
        Ok(items)
    }

    pub fn find(&self, name: &str) -> Result<PathBuf> {
        let CommandLine { location, directory, .. } = self.command;
        self.expander.options.find(name, self.cwd, directory, location)
    }
}

/// The name of a program without its folder.
fn program(stage: &[String]) -> &str {
    stage.first().map_or("", |word| word.rsplit('/').next().unwrap_or(word))
}
