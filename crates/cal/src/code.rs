//! What expressions are compiled to: one array of nodes, names resolved, constants worked out.

use crate::builtin::Builtin;

/// Index of a node.
pub(crate) type NodeId = u32;

/// A piece of [`Code::lists`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct List {
    pub start: u32,
    pub count: u32,
}

/// What is called.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Callee {
    Builtin(Builtin),
    /// A function of whoever evaluates.
    Host(u32),
    /// Index among [`Code::functions`].
    User(u32),
    /// The function that is given as an argument of the function that calls.
    Argument(u32),
}

/// An operation. The arguments of calls are nodes that are evaluated when they are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Node {
    Number(f64),
    Channel(u32),
    /// A variable: evaluated once for each set of inputs, its value kept in a slot.
    Variable {
        slot: u32,
        body: NodeId,
    },
    /// The argument of the function in whose body it stands.
    Argument(u32),
    /// The name of a function, as an argument.
    Function(Callee),
    Negate(NodeId),
    Sum(List),
    /// Each factor is multiplied with, or divided by where the list says so.
    Product(List),
    Power(NodeId, NodeId),
    Call(Callee, List),
}

/// An element of a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Item {
    pub node: NodeId,
    /// Is a sum's term subtracted, a product's factor divided by?
    pub is_inverse: bool,
}

/// A function of the files.
#[derive(Clone, Debug)]
pub(crate) struct Function {
    pub name: String,
    pub body: NodeId,
}

/// The nodes of a program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Code {
    pub nodes: Vec<Node>,
    pub lists: Vec<Item>,
    pub functions: Vec<Function>,
    pub slots: u32,
    /// `A1`, `A2`, …
    pub arguments: Vec<f64>,
}

impl Code {
    pub fn list(&self, list: List) -> &[Item] {
        &self.lists[list.start as usize..(list.start + list.count) as usize]
    }
}

/// Expressions, compiled. Immutable; many threads may evaluate it at once.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) code: Code,
    pub(crate) roots: Vec<NodeId>,
}

impl Program {
    /// The value of expression `root` if it is the same for all inputs and arguments.
    pub fn constant(&self, root: usize) -> Option<f64> {
        match self.code.nodes[self.roots[root] as usize] {
            Node::Number(value) => Some(value),
            _ => None,
        }
    }

    /// `A1`, `A2`, …
    pub fn arguments(&self) -> &[f64] {
        &self.code.arguments
    }

    /// Number of expressions.
    pub fn len(&self) -> usize {
        self.roots.len()
    }

    /// Are there no expressions?
    pub fn is_empty(&self) -> bool {
        self.roots.is_empty()
    }

    /// Does any expression look at a channel that `test` accepts?
    pub fn uses_channel(&self, test: impl Fn(u32) -> bool) -> bool {
        self.code.nodes.iter().any(|node| matches!(node, Node::Channel(channel) if test(*channel)))
    }
}
