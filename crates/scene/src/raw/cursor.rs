//! Reads words from a text and knows where it is.

use std::borrow::Cow;
use std::sync::Arc;
use sunpeak_core::{Error, Location, Result};

/// A place in the text, cheap to keep; becomes a [`Location`] when something is to be said about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    line: usize,
    column: usize,
}

/// A word and where it begins.
#[derive(Debug)]
pub struct Word<'t> {
    /// Without its quotes; bytes that are not UTF-8 are replaced.
    pub text: Cow<'t, str>,
    /// Its first character (the quote, if it has one).
    pub mark: Mark,
}

/// A reading position.
#[derive(Debug)]
pub struct Cursor<'t> {
    text: &'t [u8],
    name: Arc<str>,
    offset: usize,
    line: usize,
    line_start: usize,
}

impl<'t> Cursor<'t> {
    /// At the beginning of a text; `name` is said in error messages.
    pub fn new(text: &'t [u8], name: Arc<str>) -> Self {
        // A byte-order mark is no part of the first word.
        let offset = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { text, name, offset, line: 1, line_start: offset }
    }

    /// Here.
    pub fn mark(&self) -> Mark {
        Mark { line: self.line, column: self.offset - self.line_start + 1 }
    }

    /// A mark as people read it.
    pub fn location(&self, mark: Mark) -> Location {
        Location::new(self.name.clone(), mark.line, mark.column)
    }

    /// An error at a mark.
    pub fn error(&self, mark: Mark, message: impl Into<String>) -> Error {
        Error::input(self.location(mark), message)
    }

    /// The byte ahead.
    pub fn peek(&self) -> Option<u8> {
        self.text.get(self.offset).copied()
    }

    fn advance(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.offset += 1;
        if byte == b'\n' {
            self.line += 1;
            self.line_start = self.offset;
        }
        Some(byte)
    }

    /// Skip white space.
    pub fn skip_space(&mut self) {
        while self.peek().is_some_and(is_space) {
            self.advance();
        }
    }

    /// Skip to the end of the line.
    pub fn skip_line(&mut self) {
        while self.advance().is_some_and(|byte| byte != b'\n') {}
    }

    /// Skip to the beginning of the next line that `is_wanted`, or to the end; the line here is one of them if it lies after `begin`.
    pub fn skip_to_line(&mut self, begin: Mark, is_wanted: impl Fn(&[u8]) -> bool) {
        if self.line > begin.line {
            self.offset = self.line_start;
        } else {
            self.skip_line();
        }
        while self.peek().is_some() {
            let rest = &self.text[self.offset..];
            let end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
            if is_wanted(&rest[..end]) {
                return;
            }
            self.skip_line();
        }
    }

    /// The next word; `None` at the end. Quotes, single or double, keep white space in a word.
    pub fn word(&mut self) -> Result<Option<Word<'t>>> {
        self.skip_space();
        let mark = self.mark();
        let start = self.offset;
        while self.peek().is_some_and(|byte| !is_space(byte) && !is_quote(byte)) {
            self.offset += 1;
        }
        if self.peek().is_some_and(is_quote) {
            return self.quoted_word(mark, start).map(Some);
        }
        if self.offset == start {
            return Ok(None);
        }
        let bytes = &self.text[start..self.offset];
        // Nearly always; the lossy reading, which is several times slower, for the rest.
        let text = std::str::from_utf8(bytes).map_or_else(|_| String::from_utf8_lossy(bytes), Cow::Borrowed);
        Ok(Some(Word { text, mark }))
    }

    /// The rest of a word that has a quote somewhere.
    fn quoted_word(&mut self, mark: Mark, start: usize) -> Result<Word<'t>> {
        let mut bytes = self.text[start..self.offset].to_vec();
        let mut quote = None;
        loop {
            let here = self.mark();
            let Some(byte) = self.peek() else { break };
            match quote {
                Some((open, _)) if byte == open => quote = None,
                None if is_quote(byte) => quote = Some((byte, here)),
                None if is_space(byte) => break,
                _ => bytes.push(byte),
            }
            self.advance();
        }
        if let Some((open, opened)) = quote {
            let message =
                format!("this quote is not closed: expected another {} before the end", open as char);
            return Err(self.error(opened, message));
        }
        Ok(Word { text: Cow::Owned(String::from_utf8_lossy(&bytes).into_owned()), mark })
    }

    /// The rest of the line, with the lines that it is continued on by a backslash at its end.
    pub fn continued_line(&mut self) -> String {
        let mut bytes = Vec::new();
        while let Some(byte) = self.advance() {
            match byte {
                b'\n' if bytes.last() != Some(&b'\\') => break,
                // A line may end in CR LF.
                b'\r' if self.peek() == Some(b'\n') => {}
                _ => bytes.push(byte),
            }
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

fn is_space(byte: u8) -> bool {
    // As C's isspace: with the vertical tab.
    byte.is_ascii_whitespace() || byte == 0x0b
}

fn is_quote(byte: u8) -> bool {
    byte == b'"' || byte == b'\''
}
