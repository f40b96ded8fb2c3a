//! What names stand for: symbols in contexts.

use crate::builtin::{Builtin, CONSTANTS, VECTOR_FUNCTIONS};
use crate::code::Program;
use crate::link::Linker;
use crate::parse::{Definition, Expr, Parser, Place};
use std::collections::{HashMap, HashSet};
use sunpeak_core::{Error, Location, Result};

/// Index of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SymbolId(pub u32);

/// A name, qualified by its context.
#[derive(Clone, Debug)]
pub(crate) struct Symbol {
    /// As it is written.
    pub name: String,
    /// Where it was first met.
    pub location: Location,
    pub meaning: Meaning,
}

/// What a symbol stands for.
#[derive(Clone, Debug)]
pub(crate) enum Meaning {
    /// Nothing yet.
    Undefined,
    Defined(Definition),
    Builtin(Builtin),
    Host {
        id: u32,
        parameters: usize,
    },
    Channel(u32),
}

/// An expression that waits to be compiled, with arguments of its own or without.
#[derive(Clone, Debug)]
pub struct Expression {
    pub(crate) expr: Expr,
    pub(crate) location: Location,
}

/// Definitions of any number of files, on top of the library.
#[derive(Clone, Debug)]
pub struct Definitions {
    symbols: Vec<Symbol>,
    index: HashMap<String, SymbolId>,
    contexts: HashSet<String>,
}

impl Default for Definitions {
    fn default() -> Self {
        Self::new()
    }
}

impl Definitions {
    /// The library: the functions of `rcalc` and those that Radiance's renderers add, as far as they ask for nothing of a ray.
    pub fn new() -> Self {
        let mut all = Self { symbols: Vec::new(), index: HashMap::new(), contexts: HashSet::new() };
        for (name, builtin) in Builtin::table() {
            all.set(name, Meaning::Builtin(builtin));
        }
        for (name, value) in CONSTANTS {
            let body = Expr::Number(*value);
            all.set(name, Meaning::Defined(Definition { parameters: None, body }));
        }
        for index in 1..=10u32 {
            let argument = all.index["arg"];
            let body = Expr::Call(Box::new(Expr::Name(argument)), vec![Expr::Number(f64::from(index))]);
            all.set(&format!("A{index}"), Meaning::Defined(Definition { parameters: None, body }));
        }
        let count = Expr::Call(Box::new(Expr::Name(all.index["arg"])), vec![Expr::Number(0.0)]);
        all.set("AC", Meaning::Defined(Definition { parameters: None, body: count }));
        all.load(VECTOR_FUNCTIONS.as_bytes(), "the library", "").expect("the library is in the language");
        all
    }

    /// A global name for a channel.
    pub fn name_channel(&mut self, name: &str, channel: u32) {
        self.set(name, Meaning::Channel(channel));
    }

    /// A global function that [`Inputs::function`](crate::Inputs::function) answers.
    pub fn name_function(&mut self, name: &str, id: u32, parameters: usize) {
        self.set(name, Meaning::Host { id, parameters });
    }

    fn set(&mut self, name: &str, meaning: Meaning) {
        let id = self.symbol(name.to_string(), name, Location::default());
        self.symbols[id.0 as usize].meaning = meaning;
    }

    /// Take in the definitions of a file, in a context (`""` is the global one; see [`context_of`](Self::context_of)).
    ///
    /// # Errors
    /// What the text should have had, and where.
    pub fn load(&mut self, text: &[u8], file: &str, context: &str) -> Result<()> {
        self.contexts.insert(context.to_string());
        Parser::new(text, Place::File(file.into()), self, context)?.statements()
    }

    /// Was a file loaded into this context?
    pub fn has_context(&self, context: &str) -> bool {
        self.contexts.contains(context)
    }

    /// The context of a file's definitions: its name without `.cal`, `.` for none.
    pub fn context_of(file: &str) -> String {
        if file == "." {
            return String::new();
        }
        let has_suffix = file.len() > 4 && file.is_char_boundary(file.len() - 4);
        let stem = match has_suffix {
            true if file[file.len() - 4..].eq_ignore_ascii_case(".cal") => &file[..file.len() - 4],
            _ => file,
        };
        let allowed = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '_' | '.') { c } else { '_' };
        stem.chars().map(allowed).collect()
    }

    /// Read an expression that stands at `location`, names looked up in `context`.
    ///
    /// # Errors
    /// What the text should have had.
    pub fn expression(&mut self, text: &str, location: &Location, context: &str) -> Result<Expression> {
        let place = Place::Argument(location);
        let expr = Parser::new(text.as_bytes(), place, self, context)?.whole_expression()?;
        Ok(Expression { expr, location: location.clone() })
    }

    /// A call of the function `name` with `count` arguments, which are given when it is evaluated.
    pub fn call(&mut self, name: &str, count: usize, location: &Location, context: &str) -> Expression {
        let symbol = self.refer(name, context, location.clone());
        let arguments = (0..count as u32).map(Expr::Argument).collect();
        Expression { expr: Expr::Call(Box::new(Expr::Name(symbol)), arguments), location: location.clone() }
    }

    /// How many arguments a function has, at least; `None` if there is no such function.
    pub fn parameters(&self, name: &str, context: &str) -> Option<usize> {
        let symbol = self.find(name, context)?;
        match &self.symbol_of(symbol).meaning {
            Meaning::Defined(definition) => definition.parameters,
            Meaning::Builtin(builtin) => Some(builtin.parameters()),
            Meaning::Host { parameters, .. } => Some(*parameters),
            Meaning::Undefined | Meaning::Channel(_) => None,
        }
    }

    /// Is there a variable of this name?
    pub fn has_variable(&self, name: &str, context: &str) -> bool {
        self.find(name, context).is_some_and(|symbol| match &self.symbol_of(symbol).meaning {
            Meaning::Defined(definition) => definition.parameters.is_none(),
            Meaning::Channel(_) => true,
            _ => false,
        })
    }

    /// Compile expressions, which then share the values of variables. `arguments` are `A1`, `A2`, …
    ///
    /// # Errors
    /// Names that nothing defines, definitions in a circle, arguments that are not given: where, and what was expected.
    pub fn compile(&self, expressions: &[Expression], arguments: &[f64]) -> Result<Program> {
        let mut linker = Linker::new(self, arguments);
        let roots = expressions.iter().map(|e| linker.root(e)).collect::<Result<Vec<_>>>()?;
        Ok(Program { code: linker.finish(), roots })
    }

    pub(crate) fn symbol_of(&self, id: SymbolId) -> &Symbol {
        &self.symbols[id.0 as usize]
    }

    /// The symbol that a name means here; a new one of this context if there is none.
    pub(crate) fn refer(&mut self, name: &str, context: &str, location: Location) -> SymbolId {
        match self.find(name, context) {
            Some(symbol) => symbol,
            None => self.symbol(qualified(name, context), name, location),
        }
    }

    pub(crate) fn define(&mut self, name: &str, context: &str, definition: Definition, location: Location) {
        let id = self.symbol(qualified(name, context), name, location.clone());
        let symbol = &mut self.symbols[id.0 as usize];
        symbol.meaning = Meaning::Defined(definition);
        symbol.location = location;
    }

    fn find(&self, name: &str, context: &str) -> Option<SymbolId> {
        let local = self.index.get(&qualified(name, context)).copied();
        if local.is_some() || name.starts_with('`') {
            return local;
        }
        self.index.get(name.trim_end_matches('`')).copied()
    }

    fn symbol(&mut self, qualified: String, name: &str, location: Location) -> SymbolId {
        let next = SymbolId(self.symbols.len() as u32);
        let id = *self.index.entry(qualified).or_insert(next);
        if id == next {
            self.symbols.push(Symbol { name: name.to_string(), location, meaning: Meaning::Undefined });
        }
        id
    }
}

/// A name with its context; a mark at the end makes it global.
fn qualified(name: &str, context: &str) -> String {
    let name = name.strip_prefix('`').unwrap_or(name);
    match name.strip_suffix('`') {
        Some(global) => global.to_string(),
        None if context.is_empty() => name.to_string(),
        None => format!("{name}`{context}"),
    }
}

/// A message about a symbol that cannot be used as it stands.
pub(crate) fn symbol_error(symbol: &Symbol, message: impl Into<String>) -> Error {
    Error::input(symbol.location.clone(), message)
}
