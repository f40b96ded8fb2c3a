//! The expression language of Radiance's `.cal` files: definitions are read, expressions compiled once, and evaluated many times.
//!
//! It knows nothing of scenes or rays. Whoever evaluates gives the numbered channels (`$1`, or names for them such as `Dx`), the
//! arguments `A1`, `A2`, …, and may add functions of its own.
//!
//! ```
//! use sunpeak_cal::{Definitions, NoInputs, Started};
//! let mut definitions = Definitions::new();
//! definitions.load(b"half = .5; f(x) : half * x^2;", "f.cal", "f")?;
//! let expression = definitions.expression("f(A1) + max(1, 2)", &Default::default(), "f")?;
//! let program = definitions.compile(&[expression], &[3.0])?;
//! assert_eq!(program.start(&NoInputs).value(0, &[]), Ok(6.5));
//! # Ok::<(), sunpeak_core::Error>(())
//! ```
//!
//! # The language
//! `name = expression;` and `name(a, b) = expression;`, or `:` in place of `=` for what never changes; comments in `{ }`, which nest.
//! Operators, from the loosest: `+ -`, `* /`, `^` (from the right), a sign (which binds closer than `^`: `-2^2` is 4). Arguments are
//! evaluated when they are asked for, at most once; a function may be an argument by its name. A condition is true when it is
//! above 0.
//!
//! Names live in contexts. A file's definitions have the file's name as context; a name is looked up there first and then among those
//! that are global. `` `name `` is looked up in the file's context alone, `` name` `` only globally. What a name means is settled
//! where it is read: the definition that exists then, or else one of this file to come.
//!
//! # What goes wrong
//! A function out of its domain, a result that is no finite number, a division by zero: the value is 0 and the expression that asked
//! for it has failed ([`Failure::Math`]), unless a library function that is called later succeeds. So it is in Radiance, which then
//! leaves out the pattern. (A result too small for a number is 0 and no failure here.) Names that nothing defines, and definitions
//! that go round in a circle, are errors when a program is compiled. A recursion without end, or an evaluation that takes
//! [`MAX_STEPS`], is a [`Fault`].
//!
//! # Where it differs from Radiance
//! `:` and `=` differ in nothing but that both may not be changed by the program that evaluates: constants are worked out where
//! they can be, and a `:` whose value does vary varies. A constant that is defined again has its last value everywhere.

mod builtin;
mod code;
mod definitions;
mod evaluate;
mod link;
mod noise;
mod parse;
mod special;

pub use code::Program;
pub use definitions::{Definitions, Expression};
pub use evaluate::{Failure, Fault, Inputs, MAX_STEPS, NoInputs, Started};
