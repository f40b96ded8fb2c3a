//! From expressions with symbols to nodes: only what is asked for, each definition once, constants worked out.

use crate::builtin::{Builtin, Lazy};
use crate::code::{Callee, Code, Function, Item, List, Node, NodeId};
use crate::definitions::{Definitions, Expression, Meaning, SymbolId, symbol_error};
use crate::evaluate::{Evaluation, Failure, NoInputs};
use crate::parse::Expr;
use std::collections::HashMap;
use sunpeak_core::{Error, Location, Result};

/// Definitions in terms of definitions in terms of …
const MAX_DEPTH: usize = 400;

/// How far a symbol has come.
#[derive(Clone, Copy)]
enum Progress {
    Variable(NodeId),
    /// Its definition is being linked.
    OpenVariable,
    Function(u32),
}

/// Makes a program's code.
pub(crate) struct Linker<'d> {
    definitions: &'d Definitions,
    code: Code,
    done: HashMap<SymbolId, Progress>,
    /// Functions whose bodies are linked, and whether they look at nothing but their arguments.
    is_pure: Vec<Option<bool>>,
    depth: usize,
}

impl<'d> Linker<'d> {
    pub fn new(definitions: &'d Definitions, arguments: &[f64]) -> Self {
        let code = Code { arguments: arguments.to_vec(), ..Code::default() };
        Self { definitions, code, done: HashMap::new(), is_pure: Vec::new(), depth: 0 }
    }

    pub fn finish(self) -> Code {
        self.code
    }

    /// Link an expression.
    pub fn root(&mut self, expression: &Expression) -> Result<NodeId> {
        self.expression(&expression.expr, &expression.location)
    }

    fn expression(&mut self, expr: &Expr, location: &Location) -> Result<NodeId> {
        let node = match expr {
            Expr::Number(value) => Node::Number(*value),
            Expr::Channel(channel) => Node::Channel(*channel),
            Expr::Argument(index) => Node::Argument(*index),
            Expr::Name(symbol) => return self.variable(*symbol, location),
            Expr::Negate(inner) => Node::Negate(self.expression(inner, location)?),
            Expr::Sum(terms) => Node::Sum(self.list(terms, location)?),
            Expr::Product(factors) => Node::Product(self.list(factors, location)?),
            Expr::Power(base, exponent) => {
                Node::Power(self.expression(base, location)?, self.expression(exponent, location)?)
            }
            Expr::Call(callee, arguments) => return self.call(callee, arguments, location),
        };
        self.push_folded(node, location)
    }

    fn list(&mut self, parts: &[(bool, Expr)], location: &Location) -> Result<List> {
        let mut items = Vec::with_capacity(parts.len());
        for (is_inverse, expr) in parts {
            items.push(Item { node: self.expression(expr, location)?, is_inverse: *is_inverse });
        }
        Ok(self.push_list(items))
    }

    fn push_list(&mut self, items: Vec<Item>) -> List {
        let list = List { start: self.code.lists.len() as u32, count: items.len() as u32 };
        self.code.lists.extend(items);
        list
    }

    fn push(&mut self, node: Node) -> NodeId {
        self.code.nodes.push(node);
        self.code.nodes.len() as u32 - 1
    }

    /// Work the node out if it does not depend on anything. What fails is left to fail when it is asked for.
    fn push_folded(&mut self, node: Node, location: &Location) -> Result<NodeId> {
        let id = self.push(node);
        if self.is_constant(&node) {
            let value = Evaluation::new(&self.code, &NoInputs).node(id, &[]);
            match value {
                Ok(value) => self.code.nodes[id as usize] = Node::Number(value),
                Err(Failure::Math) => {}
                Err(Failure::Fault(fault)) => return Err(Error::input(location.clone(), fault.to_string())),
            }
        }
        Ok(id)
    }

    fn is_number(&self, id: NodeId) -> bool {
        matches!(self.code.nodes[id as usize], Node::Number(_))
    }

    fn are_numbers(&self, list: List) -> bool {
        self.code.list(list).iter().all(|item| self.is_number(item.node))
    }

    fn is_constant(&self, node: &Node) -> bool {
        match *node {
            Node::Negate(inner) => self.is_number(inner),
            Node::Sum(list) | Node::Product(list) => self.are_numbers(list),
            Node::Power(a, b) => self.is_number(a) && self.is_number(b),
            Node::Call(Callee::Builtin(_), list) => self.are_numbers(list),
            Node::Call(Callee::User(function), list) => {
                self.is_pure[function as usize] == Some(true) && self.are_numbers(list)
            }
            _ => false,
        }
    }

    /// The value of a name, or the function that it names where it stands as an argument.
    fn variable(&mut self, id: SymbolId, location: &Location) -> Result<NodeId> {
        let definitions = self.definitions;
        let symbol = definitions.symbol_of(id);
        let body = match &symbol.meaning {
            Meaning::Undefined => {
                return Err(undefined(&symbol.name, "variable", &symbol.location, location));
            }
            Meaning::Channel(channel) => return Ok(self.push(Node::Channel(*channel))),
            Meaning::Builtin(_) | Meaning::Host { .. } => {
                let callee = self.callee(id, location)?;
                return Ok(self.push(Node::Function(callee)));
            }
            Meaning::Defined(definition) if definition.parameters.is_some() => {
                let callee = self.callee(id, location)?;
                return Ok(self.push(Node::Function(callee)));
            }
            Meaning::Defined(definition) => &definition.body,
        };
        match self.done.get(&id) {
            Some(Progress::Variable(node)) => return Ok(*node),
            Some(Progress::OpenVariable) => {
                return Err(symbol_error(symbol, format!("\"{}\" is defined by itself", symbol.name)));
            }
            _ => {}
        }
        self.done.insert(id, Progress::OpenVariable);
        let body = self.deeper(&symbol.location, |linker| linker.expression(body, &symbol.location))?;
        let node = match self.code.nodes[body as usize] {
            Node::Number(_) | Node::Channel(_) | Node::Variable { .. } => body,
            _ => {
                self.code.slots += 1;
                let slot = self.code.slots - 1;
                self.push(Node::Variable { slot, body })
            }
        };
        self.done.insert(id, Progress::Variable(node));
        Ok(node)
    }

    fn deeper<T>(&mut self, location: &Location, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        if self.depth >= MAX_DEPTH {
            let message = format!("more than {MAX_DEPTH} definitions in terms of each other");
            return Err(Error::input(location.clone(), message));
        }
        self.depth += 1;
        let result = work(self);
        self.depth -= 1;
        result
    }

    fn call(&mut self, callee: &Expr, arguments: &[Expr], location: &Location) -> Result<NodeId> {
        let (callee, name) = match callee {
            Expr::Argument(index) => (Callee::Argument(*index), String::new()),
            Expr::Name(symbol) => {
                (self.callee(*symbol, location)?, self.definitions.symbol_of(*symbol).name.clone())
            }
            _ => return Err(Error::input(location.clone(), "expected the name of a function before '('")),
        };
        let needed = match callee {
            Callee::Builtin(builtin) => builtin.parameters(),
            _ => 0,
        };
        if arguments.len() < needed {
            let message = format!("{name}() is called with {} arguments: expected {needed}", arguments.len());
            return Err(Error::input(location.clone(), message));
        }
        if callee == Callee::Builtin(Builtin::Lazy(Lazy::If)) {
            // A condition that is known: the other branch may ask for what is not there.
            let condition = self.expression(&arguments[0], location)?;
            if let Node::Number(value) = self.code.nodes[condition as usize] {
                return self.expression(&arguments[if value > 0.0 { 1 } else { 2 }], location);
            }
        }
        let mut items = Vec::with_capacity(arguments.len());
        for argument in arguments {
            items.push(Item { node: self.expression(argument, location)?, is_inverse: false });
        }
        self.check_arg(callee, &items, location)?;
        let list = self.push_list(items);
        self.push_folded(Node::Call(callee, list), location)
    }

    /// `arg(n)` with a known n that is not given.
    fn check_arg(&self, callee: Callee, items: &[Item], location: &Location) -> Result<()> {
        let Callee::Builtin(Builtin::Lazy(Lazy::Arg)) = callee else { return Ok(()) };
        let Node::Number(n) = self.code.nodes[items[0].node as usize] else { return Ok(()) };
        let given = self.code.arguments.len();
        if n + 0.5 >= (given + 1) as f64 {
            let n = (n + 0.5).floor();
            let message = format!("the real argument A{n} is asked for, but only {given} are given");
            return Err(Error::input(location.clone(), message));
        }
        Ok(())
    }

    fn callee(&mut self, id: SymbolId, location: &Location) -> Result<Callee> {
        let definitions = self.definitions;
        let symbol = definitions.symbol_of(id);
        let definition = match &symbol.meaning {
            Meaning::Builtin(builtin) => return Ok(Callee::Builtin(*builtin)),
            Meaning::Host { id, .. } => return Ok(Callee::Host(*id)),
            Meaning::Defined(definition) if definition.parameters.is_some() => definition,
            _ => return Err(undefined(&symbol.name, "function", &symbol.location, location)),
        };
        if let Some(Progress::Function(function)) = self.done.get(&id) {
            return Ok(Callee::User(*function));
        }
        let function = self.code.functions.len() as u32;
        self.code.functions.push(Function { name: symbol.name.clone(), body: 0 });
        self.is_pure.push(None);
        self.done.insert(id, Progress::Function(function));
        let first = self.code.nodes.len();
        let body =
            self.deeper(&symbol.location, |linker| linker.expression(&definition.body, &symbol.location))?;
        self.code.functions[function as usize].body = body;
        self.is_pure[function as usize] = Some(self.code.nodes[first..].iter().all(|n| self.is_pure_node(n)));
        Ok(Callee::User(function))
    }

    /// Does it ask for nothing but arguments? (Known variables before this function's own nodes count as asking.)
    fn is_pure_node(&self, node: &Node) -> bool {
        match *node {
            Node::Channel(_) | Node::Variable { .. } => false,
            Node::Call(callee, list) => self.is_pure_callee(callee) && self.are_own(list),
            Node::Function(callee) => self.is_pure_callee(callee),
            Node::Sum(list) | Node::Product(list) => self.are_own(list),
            Node::Power(a, b) => self.is_own(a) && self.is_own(b),
            Node::Negate(a) => self.is_own(a),
            Node::Number(_) | Node::Argument(_) => true,
        }
    }

    fn is_own(&self, id: NodeId) -> bool {
        !matches!(self.code.nodes[id as usize], Node::Channel(_) | Node::Variable { .. })
    }

    fn are_own(&self, list: List) -> bool {
        self.code.list(list).iter().all(|item| self.is_own(item.node))
    }

    /// A function that is still open calls itself: it is as pure as the rest of it.
    fn is_pure_callee(&self, callee: Callee) -> bool {
        match callee {
            Callee::Builtin(_) | Callee::Argument(_) => true,
            Callee::Host(_) => false,
            Callee::User(function) => self.is_pure[function as usize].unwrap_or(false),
        }
    }
}

/// A name that nothing defines: where it is used, or, for a name in a file, where it stands there.
fn undefined(name: &str, what: &str, met: &Location, user: &Location) -> Error {
    let location = if met.line > 0 { met } else { user };
    Error::input(location.clone(), format!("the {what} \"{name}\" is not defined"))
}
