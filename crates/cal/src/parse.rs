//! From characters to expressions (reference manual of `calc`, "Functions of Calc"; grammar of `rcalc`).

use crate::definitions::{Definitions, SymbolId};
use std::{cell::Cell, sync::Arc};
use sunpeak_core::{Error, Location, Result};

/// Parentheses, arguments and exponents within each other.
const MAX_NESTING: usize = 200;

/// An expression as written, names resolved.
#[derive(Clone, Debug)]
pub(crate) enum Expr {
    Number(f64),
    Channel(u32),
    Name(SymbolId),
    /// Parameter of the function that is being defined, from 0.
    Argument(u32),
    Negate(Box<Expr>),
    /// Terms, `true` if subtracted.
    Sum(Vec<(bool, Expr)>),
    /// Factors, `true` if divided by.
    Product(Vec<(bool, Expr)>),
    Power(Box<Expr>, Box<Expr>),
    /// What is called is a name or an argument.
    Call(Box<Expr>, Vec<Expr>),
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    /// Number of parameters of a function, `None` for a variable.
    pub parameters: Option<usize>,
    pub body: Expr,
}

/// Reads statements and expressions.
pub(crate) struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    place: Place<'a>,
    definitions: &'a mut Definitions,
    context: &'a str,
    parameters: Vec<String>,
    depth: usize,
    /// An offset whose line is known, that line, and where it begins: places are asked for in the order of the text.
    counted: Cell<(usize, usize, usize)>,
}

/// Where a text stands, for messages.
#[derive(Clone)]
pub(crate) enum Place<'a> {
    /// A file of this name.
    File(Arc<str>),
    /// An argument of something at this place.
    Argument(&'a Location),
}

fn is_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'`')
}

impl<'a> Parser<'a> {
    pub fn new(
        text: &'a [u8],
        place: Place<'a>,
        definitions: &'a mut Definitions,
        context: &'a str,
    ) -> Result<Self> {
        let mut parser = Self {
            text,
            at: 0,
            place,
            definitions,
            context,
            parameters: Vec::new(),
            depth: 0,
            counted: Cell::new((0, 1, 0)),
        };
        parser.skip()?;
        Ok(parser)
    }

    /// All definitions of a file.
    pub fn statements(&mut self) -> Result<()> {
        while let Some(next) = self.peek() {
            if next != b';' {
                self.statement()?;
            }
            match self.peek() {
                None => break,
                Some(b';') => self.advance()?,
                Some(_) => return Err(self.expected("';' after the definition")),
            }
        }
        Ok(())
    }

    /// One expression and nothing else.
    pub fn whole_expression(&mut self) -> Result<Expr> {
        let expression = self.sum()?;
        match self.peek() {
            None => Ok(expression),
            Some(_) => Err(self.expected("an operator or the end of the expression")),
        }
    }

    fn statement(&mut self) -> Result<()> {
        if !self.peek().is_some_and(|c| c.is_ascii_alphabetic() || c == b'`') {
            return Err(self.expected("the name of a variable or function to define"));
        }
        let location = self.location(self.at);
        let name = self.name()?;
        let is_function = self.peek() == Some(b'(');
        if is_function {
            self.parameter_names()?;
        }
        if !matches!(self.peek(), Some(b'=' | b':')) {
            return Err(self.expected("'=' or ':' and an expression"));
        }
        self.advance()?;
        let body = self.sum()?;
        let parameters = is_function.then_some(self.parameters.len());
        self.parameters.clear();
        self.definitions.define(&name, self.context, Definition { parameters, body }, location);
        Ok(())
    }

    fn parameter_names(&mut self) -> Result<()> {
        loop {
            self.advance()?;
            if !self.peek().is_some_and(|c| c.is_ascii_alphabetic()) {
                return Err(self.expected("the name of a parameter"));
            }
            let name = self.name()?;
            if name.contains('`') {
                return Err(self.expected("a parameter without a context mark"));
            }
            self.parameters.push(name);
            match self.peek() {
                Some(b',') => {}
                Some(b')') => return self.advance(),
                _ => return Err(self.expected("',' or ')' after a parameter")),
            }
        }
    }

    fn sum(&mut self) -> Result<Expr> {
        self.depth += 1;
        if self.depth > MAX_NESTING {
            return Err(self.error(format!("an expression nested more than {MAX_NESTING} deep")));
        }
        let mut terms = vec![(false, self.product()?)];
        while let Some(sign @ (b'+' | b'-')) = self.peek() {
            self.advance()?;
            terms.push((sign == b'-', self.product()?));
        }
        self.depth -= 1;
        Ok(single_or(terms, Expr::Sum))
    }

    fn product(&mut self) -> Result<Expr> {
        let mut factors = vec![(false, self.power()?)];
        while let Some(sign @ (b'*' | b'/')) = self.peek() {
            self.advance()?;
            factors.push((sign == b'/', self.power()?));
        }
        Ok(single_or(factors, Expr::Product))
    }

    /// From the right: `a ^ b ^ c` is `a ^ (b ^ c)`.
    fn power(&mut self) -> Result<Expr> {
        let mut chain = vec![self.signed()?];
        while self.peek() == Some(b'^') {
            self.advance()?;
            chain.push(self.signed()?);
            if chain.len() > MAX_NESTING {
                return Err(self.error(format!("more than {MAX_NESTING} powers of powers")));
            }
        }
        let power = |exponent, base| Expr::Power(Box::new(base), Box::new(exponent));
        chain.into_iter().rev().reduce(power).ok_or_else(|| self.expected("an expression"))
    }

    fn signed(&mut self) -> Result<Expr> {
        match self.peek() {
            Some(b'-') => {
                self.advance()?;
                Ok(match self.operand()? {
                    Expr::Number(value) => Expr::Number(-value),
                    Expr::Negate(inner) => *inner,
                    other => Expr::Negate(Box::new(other)),
                })
            }
            Some(b'+') => {
                self.advance()?;
                self.operand()
            }
            _ => self.operand(),
        }
    }

    fn operand(&mut self) -> Result<Expr> {
        match self.peek() {
            Some(b'(') => {
                self.advance()?;
                let inner = self.sum()?;
                if self.peek() != Some(b')') {
                    return Err(self.expected("')'"));
                }
                self.advance()?;
                Ok(inner)
            }
            Some(b'$') => {
                self.advance()?;
                let start = self.at;
                let digits = self.take(|c| c.is_ascii_digit());
                let channel = digits.parse().ok();
                let channel = channel.ok_or_else(|| self.expected_at(start, "the number of a channel"))?;
                self.skip()?;
                Ok(Expr::Channel(channel))
            }
            Some(c) if c.is_ascii_alphabetic() || c == b'`' => self.named(),
            Some(c) if c.is_ascii_digit() || c == b'.' => self.number(),
            _ => Err(self.expected("a number, a name or '('")),
        }
    }

    fn named(&mut self) -> Result<Expr> {
        let location = self.location(self.at);
        let name = self.name()?;
        let named = match self.parameters.iter().position(|parameter| *parameter == name) {
            Some(index) => Expr::Argument(index as u32),
            None => Expr::Name(self.definitions.refer(&name, self.context, location)),
        };
        if self.peek() != Some(b'(') {
            return Ok(named);
        }
        let mut arguments = Vec::new();
        loop {
            self.advance()?;
            arguments.push(self.sum()?);
            match self.peek() {
                Some(b',') => {}
                Some(b')') => break,
                _ => return Err(self.expected("',' or ')' after an argument")),
            }
        }
        self.advance()?;
        Ok(Expr::Call(Box::new(named), arguments))
    }

    fn number(&mut self) -> Result<Expr> {
        let start = self.at;
        let digit = |c: u8| c.is_ascii_digit();
        self.take(digit);
        if self.byte() == Some(b'.') {
            self.at += 1;
            self.take(digit);
        }
        if matches!(self.byte(), Some(b'e' | b'E')) {
            self.at += 1;
            if matches!(self.byte(), Some(b'+' | b'-')) {
                self.at += 1;
            }
            if self.take(digit).is_empty() {
                return Err(self.expected("the digits of an exponent"));
            }
        }
        let word = String::from_utf8_lossy(&self.text[start..self.at]);
        let value = word.parse::<f64>().ok().filter(|value| value.is_finite());
        let value = value.ok_or_else(|| self.expected_at(start, "a finite number"))?;
        self.skip()?;
        Ok(Expr::Number(value))
    }

    fn name(&mut self) -> Result<String> {
        let name = self.take(is_name);
        self.skip()?;
        Ok(name)
    }

    fn take(&mut self, is_part: impl Fn(u8) -> bool) -> String {
        let start = self.at;
        while self.byte().is_some_and(&is_part) {
            self.at += 1;
        }
        String::from_utf8_lossy(&self.text[start..self.at]).into_owned()
    }

    fn byte(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    /// The next character that counts.
    fn peek(&self) -> Option<u8> {
        self.byte()
    }

    /// Past the next character and what does not count after it.
    fn advance(&mut self) -> Result<()> {
        self.at += 1;
        self.skip()
    }

    /// Past white space and comments.
    fn skip(&mut self) -> Result<()> {
        while let Some(c) = self.byte() {
            match c {
                b'{' => self.skip_comment()?,
                c if c.is_ascii_whitespace() || c == 0x0b => self.at += 1,
                _ => break,
            }
        }
        Ok(())
    }

    fn skip_comment(&mut self) -> Result<()> {
        let start = self.at;
        let mut open = 0usize;
        while let Some(c) = self.byte() {
            self.at += 1;
            match c {
                b'{' => open += 1,
                b'}' => open -= 1,
                _ => {}
            }
            if open == 0 {
                return Ok(());
            }
        }
        let location = self.location(start);
        Err(Error::input(location, "this comment is not closed: expected '}'"))
    }

    fn location(&self, at: usize) -> Location {
        match &self.place {
            Place::File(file) => {
                let (line, start) = self.line_of(at);
                Location::new(file.clone(), line, at - start + 1)
            }
            Place::Argument(location) => (*location).clone(),
        }
    }

    /// The line in which an offset stands, from 1, and where the line begins.
    fn line_of(&self, at: usize) -> (usize, usize) {
        let (from, line, start) = self.counted.get();
        let (from, mut line, mut start) = if at < from { (0, 1, 0) } else { (from, line, start) };
        for (i, _) in
            self.text[from..at.min(self.text.len())].iter().enumerate().filter(|(_, c)| **c == b'\n')
        {
            (line, start) = (line + 1, from + i + 1);
        }
        self.counted.set((at, line, start));
        (line, start)
    }

    fn expected(&self, what: &str) -> Error {
        self.expected_at(self.at, what)
    }

    fn expected_at(&self, at: usize, what: &str) -> Error {
        let found = match self.text.get(at) {
            None => "the end".to_string(),
            Some(_) => {
                let rest = String::from_utf8_lossy(&self.text[at..self.text.len().min(at + 40)]);
                let word: String = rest.chars().take_while(|c| !c.is_whitespace()).take(20).collect();
                format!("\"{word}\"")
            }
        };
        self.error_at(at, format!("expected {what}, found {found}"))
    }

    fn error(&self, message: String) -> Error {
        self.error_at(self.at, message)
    }

    fn error_at(&self, at: usize, message: String) -> Error {
        let message = match self.place {
            Place::File(_) => message,
            Place::Argument(_) => {
                format!("in the expression \"{}\": {message}", String::from_utf8_lossy(self.text))
            }
        };
        Error::input(self.location(at), message)
    }
}

fn single_or(mut parts: Vec<(bool, Expr)>, several: fn(Vec<(bool, Expr)>) -> Expr) -> Expr {
    match parts.pop() {
        Some((false, only)) if parts.is_empty() => only,
        Some(last) => {
            parts.push(last);
            several(parts)
        }
        None => Expr::Number(0.0),
    }
}
