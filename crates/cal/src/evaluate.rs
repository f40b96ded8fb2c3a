//! Evaluating compiled expressions.

use crate::builtin::{Builtin, Lazy, MAX_PLAIN};
use crate::code::{Callee, Code, List, Node, NodeId, Program};
use std::cell::{Cell, RefCell};
use std::fmt;

/// Nodes that one evaluation may visit: an expression that takes more goes round in circles, or should be a table.
pub const MAX_STEPS: u32 = 2_000_000;

/// Nodes within nodes; what a thread's stack of 2 MB holds with room to spare.
const MAX_DEPTH: u32 = 2500;

/// Arguments of a call whose values are kept.
const KEPT_ARGUMENTS: usize = 8;

/// Where channels and functions of whoever evaluates come from.
pub trait Inputs {
    /// The value of channel `number`.
    fn channel(&self, number: u32) -> f64;

    /// The value of a function that was named by [`Definitions::name_function`](crate::Definitions::name_function); `None` if there
    /// is none for these arguments.
    fn function(&self, id: u32, arguments: &[f64]) -> Option<f64>;
}

/// No channels (each is 0) and no functions.
#[derive(Clone, Copy, Debug)]
pub struct NoInputs;

impl Inputs for NoInputs {
    fn channel(&self, _: u32) -> f64 {
        0.0
    }

    fn function(&self, _: u32, _: &[f64]) -> Option<f64> {
        None
    }
}

/// Why there is no value.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// A function out of its domain, a division by zero, or a result that is no finite number.
    Math,
    /// The definitions are wrong.
    Fault(Fault),
}

/// What no set of inputs would make right, or only by luck.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A function that calls itself without end, or too many within each other.
    TooDeep,
    /// More than [`MAX_STEPS`].
    TooLong,
    /// A function is called with fewer arguments than it looks at.
    MissingArgument(String),
    /// What is called is no function.
    NotAFunction(String),
    /// `arg(n)` for an argument that is not given.
    MissingReal(usize),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooDeep => write!(f, "a function calls itself without end, or too many call each other"),
            Self::TooLong => write!(f, "an expression takes more than {MAX_STEPS} steps"),
            Self::MissingArgument(name) => write!(f, "{name}() is called with too few arguments"),
            Self::NotAFunction(name) => write!(f, "an argument of {name}() is called that is no function"),
            Self::MissingReal(n) => write!(f, "the real argument A{n} is asked for and not given"),
        }
    }
}

thread_local! {
    /// Values of variables, each with the number of the evaluation that it belongs to.
    static VALUES: RefCell<Vec<(u64, f64)>> = const { RefCell::new(Vec::new()) };
    static EVALUATIONS: Cell<u64> = const { Cell::new(0) };
}

impl Program {
    /// Begin to evaluate for one set of inputs: variables keep their values until the evaluation is dropped.
    pub fn start<'a, I: Inputs + ?Sized>(&'a self, inputs: &'a I) -> Started<'a, I> {
        Started { program: self, evaluation: Evaluation::new(&self.code, inputs) }
    }
}

/// A program with its inputs.
pub struct Started<'a, I: Inputs + ?Sized> {
    program: &'a Program,
    evaluation: Evaluation<'a, I>,
}

impl<I: Inputs + ?Sized> Started<'_, I> {
    /// The value of expression `root`, with the arguments of a call.
    pub fn value(&mut self, root: usize, arguments: &[f64]) -> Result<f64, Failure> {
        self.evaluation.node(self.program.roots[root], arguments)
    }
}

/// One evaluation.
pub(crate) struct Evaluation<'a, I: Inputs + ?Sized> {
    code: &'a Code,
    inputs: &'a I,
    values: Vec<(u64, f64)>,
    number: u64,
    has_failed: bool,
    fault: Option<Fault>,
    depth: u32,
    steps: u32,
}

/// A call whose body is being evaluated.
struct Frame<'f> {
    name: &'f str,
    /// The arguments as nodes, to be evaluated in the frame of the caller.
    list: Option<List>,
    caller: Option<&'f Frame<'f>>,
    kept: [Cell<f64>; KEPT_ARGUMENTS],
    is_kept: Cell<u32>,
}

impl<I: Inputs + ?Sized> Drop for Evaluation<'_, I> {
    fn drop(&mut self) {
        let values = std::mem::take(&mut self.values);
        VALUES.with(|kept| {
            if let Ok(mut kept) = kept.try_borrow_mut() {
                *kept = values;
            }
        });
    }
}

impl<'a, I: Inputs + ?Sized> Evaluation<'a, I> {
    pub(crate) fn new(code: &'a Code, inputs: &'a I) -> Self {
        let mut values = VALUES
            .with(|kept| kept.try_borrow_mut().map(|mut v| std::mem::take(&mut *v)).unwrap_or_default());
        if values.len() < code.slots as usize {
            values.resize(code.slots as usize, (0, 0.0));
        }
        let number = EVALUATIONS.get() + 1;
        EVALUATIONS.set(number);
        Self { code, inputs, values, number, has_failed: false, fault: None, depth: 0, steps: 0 }
    }

    pub(crate) fn node(&mut self, node: NodeId, arguments: &[f64]) -> Result<f64, Failure> {
        self.has_failed = false;
        self.steps = 0;
        let frame = Frame {
            name: "the expression",
            list: None,
            caller: None,
            kept: std::array::from_fn(|i| Cell::new(arguments.get(i).copied().unwrap_or(0.0))),
            is_kept: Cell::new((1 << arguments.len().min(KEPT_ARGUMENTS)) - 1),
        };
        let value = self.evaluate(node, &frame);
        if let Some(fault) = &self.fault {
            return Err(Failure::Fault(fault.clone()));
        }
        if self.has_failed || !value.is_finite() { Err(Failure::Math) } else { Ok(value) }
    }

    fn stop(&mut self, fault: Fault) -> f64 {
        self.fault.get_or_insert(fault);
        0.0
    }

    fn fail(&mut self) -> f64 {
        self.has_failed = true;
        0.0
    }

    fn evaluate(&mut self, node: NodeId, frame: &Frame) -> f64 {
        match self.code.nodes[node as usize] {
            Node::Number(value) => value,
            Node::Channel(channel) => self.inputs.channel(channel),
            Node::Argument(index) if frame.is_kept.get() >> index & 1 == 1 => {
                frame.kept[index as usize].get()
            }
            other => self.operation(other, frame),
        }
    }

    fn operation(&mut self, node: Node, frame: &Frame) -> f64 {
        if self.fault.is_some() {
            return 0.0;
        }
        self.steps += 1;
        if self.steps > MAX_STEPS {
            return self.stop(Fault::TooLong);
        }
        if self.depth >= MAX_DEPTH {
            return self.stop(Fault::TooDeep);
        }
        self.depth += 1;
        let value = match node {
            Node::Number(value) => value,
            Node::Channel(channel) => self.inputs.channel(channel),
            Node::Argument(index) => self.argument(index, frame),
            Node::Variable { slot, body } => self.variable(slot, body),
            Node::Function(_) => {
                self.stop(Fault::NotAFunction(format!("{} (a function for a number)", frame.name)))
            }
            Node::Negate(inner) => -self.evaluate(inner, frame),
            Node::Sum(list) => self.sum(list, frame),
            Node::Product(list) => self.product(list, frame),
            Node::Power(base, exponent) => {
                let power = self.evaluate(base, frame).powf(self.evaluate(exponent, frame));
                if power.is_finite() { power } else { self.fail() }
            }
            Node::Call(callee, list) => self.call(callee, list, frame),
        };
        self.depth -= 1;
        value
    }

    fn sum(&mut self, list: List, frame: &Frame) -> f64 {
        let code = self.code;
        code.list(list).iter().fold(0.0, |sum, term| {
            let value = self.evaluate(term.node, frame);
            if term.is_inverse { sum - value } else { sum + value }
        })
    }

    fn product(&mut self, list: List, frame: &Frame) -> f64 {
        let code = self.code;
        code.list(list).iter().fold(1.0, |product, factor| {
            let value = self.evaluate(factor.node, frame);
            match factor.is_inverse {
                true if value == 0.0 => self.fail(),
                true => product / value,
                false => product * value,
            }
        })
    }

    fn variable(&mut self, slot: u32, body: NodeId) -> f64 {
        let (number, value) = self.values[slot as usize];
        if number == self.number {
            return value;
        }
        let outside = Frame {
            name: "a variable",
            list: None,
            caller: None,
            kept: Default::default(),
            is_kept: Cell::new(0),
        };
        let value = self.evaluate(body, &outside);
        self.values[slot as usize] = (self.number, value);
        value
    }

    /// The value of an argument, evaluated where the call stands.
    fn argument(&mut self, index: u32, frame: &Frame) -> f64 {
        let node = match self.argument_node(index, frame) {
            Some(node) => node,
            None => return self.stop(Fault::MissingArgument(frame.name.to_string())),
        };
        // A frame with a list has a caller.
        let Some(caller) = frame.caller else { return 0.0 };
        let value = self.evaluate(node, caller);
        if (index as usize) < KEPT_ARGUMENTS {
            frame.kept[index as usize].set(value);
            frame.is_kept.set(frame.is_kept.get() | 1 << index);
        }
        value
    }

    fn argument_node(&self, index: u32, frame: &Frame) -> Option<NodeId> {
        frame.list.and_then(|list| self.code.list(list).get(index as usize)).map(|item| item.node)
    }

    fn call(&mut self, callee: Callee, list: List, frame: &Frame) -> f64 {
        match callee {
            Callee::Builtin(builtin) => self.builtin(builtin, list, frame),
            Callee::User(function) => self.user(function, list, frame),
            Callee::Host(id) => self.host(id, list, frame),
            Callee::Argument(index) => match self.function_argument(index, frame) {
                Some(callee) => self.call(callee, list, frame),
                None => self.stop(Fault::NotAFunction(frame.name.to_string())),
            },
        }
    }

    #[inline(never)]
    fn user(&mut self, function: u32, list: List, caller: &Frame) -> f64 {
        let code = self.code;
        let function = &code.functions[function as usize];
        let frame = Frame {
            name: &function.name,
            list: Some(list),
            caller: Some(caller),
            kept: Default::default(),
            is_kept: Cell::new(0),
        };
        self.evaluate(function.body, &frame)
    }

    /// The function that an argument names, perhaps by way of arguments of callers.
    fn function_argument(&self, index: u32, frame: &Frame) -> Option<Callee> {
        match self.code.nodes[self.argument_node(index, frame)? as usize] {
            Node::Function(callee) => Some(callee),
            Node::Argument(outer) => self.function_argument(outer, frame.caller?),
            _ => None,
        }
    }

    #[inline(never)]
    fn builtin(&mut self, builtin: Builtin, list: List, frame: &Frame) -> f64 {
        self.has_failed = false;
        let value = match builtin {
            Builtin::Plain(function, count) => {
                let mut arguments = [0.0; MAX_PLAIN];
                for (i, argument) in arguments.iter_mut().enumerate().take(usize::from(count)) {
                    let node = self.code.list(list)[i].node;
                    *argument = self.evaluate(node, frame);
                }
                function(&arguments)
            }
            Builtin::Lazy(lazy) => self.lazy(lazy, list, frame),
        };
        if self.has_failed || !value.is_finite() { self.fail() } else { value }
    }

    fn lazy(&mut self, lazy: Lazy, list: List, frame: &Frame) -> f64 {
        let code = self.code;
        let items = code.list(list);
        let first = self.evaluate(items[0].node, frame);
        match lazy {
            Lazy::If => self.evaluate(items[if first > 0.0 { 1 } else { 2 }].node, frame),
            Lazy::And if first > 0.0 => self.evaluate(items[1].node, frame),
            Lazy::Or if first <= 0.0 => self.evaluate(items[1].node, frame),
            Lazy::And | Lazy::Or => first,
            Lazy::Select => {
                // The nearest whole number; 0 asks how many there are.
                let n = (first + 0.5) as usize;
                match items.get(n) {
                    _ if first < -0.5 => f64::NAN,
                    _ if n == 0 => (items.len() - 1) as f64,
                    Some(item) => self.evaluate(item.node, frame),
                    None => f64::NAN,
                }
            }
            Lazy::Min => {
                items[1..].iter().rev().fold(first, |least, i| self.evaluate(i.node, frame).min(least))
            }
            Lazy::Max => {
                items[1..].iter().rev().fold(first, |most, i| self.evaluate(i.node, frame).max(most))
            }
            Lazy::Arg => {
                let n = (first + 0.5).max(0.0) as usize;
                match n.checked_sub(1).map(|i| code.arguments.get(i)) {
                    None => code.arguments.len() as f64,
                    Some(Some(&value)) => value,
                    Some(None) => self.stop(Fault::MissingReal(n)),
                }
            }
        }
    }

    #[inline(never)]
    fn host(&mut self, id: u32, list: List, frame: &Frame) -> f64 {
        let code = self.code;
        self.has_failed = false;
        let arguments: Vec<f64> = code.list(list).iter().map(|i| self.evaluate(i.node, frame)).collect();
        match self.inputs.function(id, &arguments) {
            Some(value) if value.is_finite() && !self.has_failed => value,
            _ => self.fail(),
        }
    }
}
