//! `xform` as a stage of a command line: what its passes read and write.

use super::{
    run::Run,
    xform::{self, Invocation},
};
use crate::{files::folder_of, raw::Item};
use std::{collections::HashMap, sync::Arc};
use sunpeak_core::Result;

type Items = Arc<Vec<Item>>;

/// What the passes of one `xform` read, kept for the next pass.
struct Sources {
    input: Option<Items>,
    /// Was the input's every command done?
    input_expanded: bool,
    files: HashMap<(String, bool), Items>,
}

impl Run<'_, '_> {
    pub fn xform(&mut self, args: &[String], input: Option<Vec<Item>>) -> Result<Vec<Item>> {
        let passes = xform::plan(args, &mut |name| self.text_of(name));
        let passes = passes.map_err(|message| self.error(format!("xform: {message}")))?;
        let mut sources =
            Sources { input: input.map(Arc::new), input_expanded: false, files: HashMap::new() };
        let mut output = Vec::new();
        for pass in &passes {
            for items in self.sources_of(pass, &mut sources)? {
                self.expander.count_copies(items.len(), self.command)?;
                output.extend(items.iter().map(|item| pass.apply_to_item(item)));
            }
        }
        Ok(output)
    }

    /// The files of a pass, or the output of the command before.
    fn sources_of(&mut self, pass: &Invocation, sources: &mut Sources) -> Result<Vec<Items>> {
        if pass.files.is_empty() {
            return self.piped(pass.keep_commands, sources).map(|items| vec![items]);
        }
        pass.files.iter().map(|name| self.source_file(name, pass.keep_commands, sources)).collect()
    }

    fn piped(&mut self, keep_commands: bool, sources: &mut Sources) -> Result<Items> {
        let input = sources.input.clone();
        let input = input.ok_or_else(|| {
            self.error("xform: no file is given, and no command stands before it in a pipe")
        })?;
        if keep_commands || sources.input_expanded {
            return Ok(input);
        }
        let primitives = self.expander.expand(input.to_vec(), self.cwd)?;
        let expanded = Arc::new(primitives.into_iter().map(Item::Primitive).collect::<Vec<_>>());
        sources.input = Some(expanded.clone());
        sources.input_expanded = true;
        Ok(expanded)
    }

    fn source_file(&mut self, name: &str, keep_commands: bool, sources: &mut Sources) -> Result<Items> {
        let key = (name.to_string(), keep_commands);
        if let Some(items) = sources.files.get(&key) {
            return Ok(items.clone());
        }
        let path = self.find(name)?;
        let mut items = self.expander.read_items(&path)?;
        if !keep_commands {
            if self.expander.is_open(&path) {
                return Err(
                    self.error(format!("the file \"{name}\" includes itself, directly or through others"))
                );
            }
            // Commands in a file run in its folder, so that hierarchies of objects hold together.
            let folder = folder_of(&path);
            let primitives = self.expander.while_open(&path, |expander| expander.expand(items, &folder))?;
            items = primitives.into_iter().map(Item::Primitive).collect();
        }
        let items = Arc::new(items);
        sources.files.insert(key, items.clone());
        Ok(items)
    }
}
