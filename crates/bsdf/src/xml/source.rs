//! The bytes of a file, with line and column of the place up to which they were read, and a limit for what has to be kept.

use memchr::{memchr, memchr_iter, memrchr};
use std::{
    io::{self, BufRead, Read},
    sync::Arc,
};
use sunpeak_core::{Error, Location, Result};

/// Longest piece of markup (a tag, a comment) and longest word: more than any file needs, and no burden for memory.
pub const LONGEST: usize = 1 << 24;

/// Text before the XML in which its beginning is looked for: some programs leave messages of their own.
const PREAMBLE: u64 = 1 << 20;

/// Reads on while it counts lines.
#[derive(Debug)]
pub struct Source<R> {
    inner: R,
    line: usize,
    column: usize,
    /// Bytes that may still be read as one piece.
    allowance: usize,
}

impl<R: BufRead> Source<R> {
    /// The place of the next byte.
    pub fn place(&self, file: &Arc<str>) -> Location {
        Location::new(file.clone(), self.line, self.column)
    }

    /// The place `offset` bytes on, in what [`BufRead::fill_buf`] gives.
    pub fn place_in(&mut self, file: &Arc<str>, offset: usize) -> Location {
        let (mut line, mut column) = (self.line, self.column);
        if let Ok(ahead) = self.inner.fill_buf() {
            advance(&mut line, &mut column, &ahead[..offset.min(ahead.len())]);
        }
        Location::new(file.clone(), line, column)
    }

    /// A new piece begins.
    pub fn renew(&mut self) {
        self.allowance = LONGEST;
    }
}

fn advance(line: &mut usize, column: &mut usize, bytes: &[u8]) {
    *line += memchr_iter(b'\n', bytes).count();
    *column = match memrchr(b'\n', bytes) {
        Some(last) => bytes.len() - last,
        None => *column + bytes.len(),
    };
}

impl<R: BufRead> Read for Source<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.fill_buf()?.read(buffer)?;
        self.consume(n);
        Ok(n)
    }
}

impl<R: BufRead> BufRead for Source<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.allowance == 0 {
            let message = format!("a tag, comment or word of more than {LONGEST} bytes");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        self.inner.fill_buf()
    }

    fn consume(&mut self, n: usize) {
        if let Ok(bytes) = self.inner.fill_buf() {
            advance(&mut self.line, &mut self.column, &bytes[..n.min(bytes.len())]);
        }
        self.allowance = self.allowance.saturating_sub(n);
        self.inner.consume(n);
    }
}

/// Where the XML begins: the source from there on, and how many bytes were skipped.
pub fn begin(file: &Arc<str>, mut reader: impl BufRead) -> Result<(Source<impl BufRead>, usize)> {
    let mut head = Vec::new();
    reader.by_ref().take(PREAMBLE).read_to_end(&mut head).map_err(|e| Error::io(&**file, e))?;
    let start = ["<?xml", "<WindowElement"].iter().filter_map(|s| find(&head, s.as_bytes())).min();
    let Some(start) = start else {
        return Err(Error::input(
            Location::new(file.clone(), 1, 1),
            "not a BSDF file: neither '<?xml' nor '<WindowElement' found; expected an LBNL BSDF XML file",
        ));
    };
    let (mut line, mut column) = (1, 1);
    advance(&mut line, &mut column, &head[..start]);
    let mut inner = io::Cursor::new(head).chain(reader);
    inner.consume(start);
    Ok((Source { inner, line, column, allowance: LONGEST }, start))
}

fn find(text: &[u8], word: &[u8]) -> Option<usize> {
    memchr_iter(word[0], text).find(|&at| text[at..].starts_with(word))
}

/// What is wrong with a piece of text, and where in it.
#[derive(Debug)]
pub struct Wrong {
    /// Offset in the piece.
    pub at: usize,
    /// What was found and what was expected.
    pub message: String,
}

impl<R: BufRead> Source<R> {
    /// Text up to the next markup, in pieces as they come. The next byte is then `<`, or there is none.
    pub fn text(
        &mut self,
        file: &Arc<str>,
        mut take: impl FnMut(&[u8]) -> std::result::Result<(), Wrong>,
    ) -> Result<()> {
        loop {
            self.renew();
            let ahead = match self.fill_buf() {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
                ahead => ahead.map_err(|e| Error::io(&**file, e))?,
            };
            let end = memchr(b'<', ahead);
            let count = end.unwrap_or(ahead.len());
            if count == 0 {
                return Ok(());
            }
            if let Err(Wrong { at, message }) = take(&ahead[..count]) {
                return Err(Error::input(self.place_in(file, at), message));
            }
            self.consume(count);
        }
    }
}
