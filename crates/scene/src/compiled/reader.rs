//! Radiance's portable binary numbers: integers with the highest byte first, reals of a mantissa of four bytes and an exponent
//! of one, strings that end in a zero.

use crate::files::{folder_of, read};
use std::path::{Path, PathBuf};
use sunpeak_core::{Error, Location, Result};

/// Nodes of an octree within each other. Radiance's own resolution ends far above.
const MAX_TREE_DEPTH: usize = 256;

/// Kinds of nodes of an octree.
const EMPTY: u8 = 0;
const FULL: u8 = 1;
const TREE: u8 = 2;

/// A binary file behind its text header.
pub struct Reader {
    path: PathBuf,
    bytes: Vec<u8>,
    at: usize,
    /// Bytes of an object's number.
    pub object_size: usize,
}

impl Reader {
    /// The bytes of a file.
    pub fn new(bytes: Vec<u8>, path: &Path) -> Self {
        Self { path: path.to_path_buf(), bytes, at: 0, object_size: 0 }
    }

    /// Read a file of this `format`, whose magic number is `magic` plus the size of object numbers; `what` says what it is.
    pub fn open(path: &Path, format: &str, magic: i64, what: &str) -> Result<Self> {
        let mut reader = Self::new(read(path)?, path);
        let header = reader.header()?;
        let found = header.iter().rev().find_map(|line| line.strip_prefix("FORMAT=")).map(str::trim);
        reader.expect_format(found, format, magic, what)?;
        Ok(reader)
    }

    /// The header's format is the one that is wanted, and the magic number follows.
    pub fn expect_format(&mut self, found: Option<&str>, format: &str, magic: i64, what: &str) -> Result<()> {
        if found != Some(format) {
            let found = found.map_or("none".into(), |found| format!("FORMAT={found}"));
            let expected = format!("expected {what} with a line FORMAT={format} in its header");
            return Err(self.error(format!("{expected}, found {found}")));
        }
        let size = self.integer(2)? - magic;
        if !(1..=8).contains(&size) {
            return Err(self.error(format!("not {what} of a version that is known")));
        }
        self.object_size = size as usize;
        Ok(())
    }

    /// Text lines up to an empty one.
    pub fn header(&mut self) -> Result<Vec<String>> {
        let mut lines = Vec::new();
        loop {
            let rest = &self.bytes[self.at..];
            let Some(length) = rest.iter().position(|&b| b == b'\n') else {
                return Err(self.error("expected lines of text and an empty one, found no header"));
            };
            let line = String::from_utf8_lossy(&rest[..length]).trim().to_string();
            self.at += length + 1;
            if line.is_empty() {
                return Ok(lines);
            }
            lines.push(line);
        }
    }

    /// All that is left.
    pub fn rest(&self) -> &[u8] {
        &self.bytes[self.at..]
    }

    /// Where the file lies.
    pub fn folder(&self) -> PathBuf {
        folder_of(&self.path)
    }

    /// What messages call the file.
    pub fn location(&self) -> Location {
        Location::new(self.path.to_string_lossy().as_ref(), 0, 0)
    }

    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::input(self.location(), message)
    }

    fn take(&mut self, count: usize) -> Result<&[u8]> {
        let end = self.at.saturating_add(count);
        if end > self.bytes.len() {
            return Err(self.error(format!("the file ends in the middle, after {} bytes", self.bytes.len())));
        }
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    /// Bytes that are left, to believe no count that is larger.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    pub fn byte(&mut self) -> Result<u8> {
        Ok(self.take(1)?[0])
    }

    /// A signed integer.
    pub fn integer(&mut self, size: usize) -> Result<i64> {
        let bytes = self.take(size)?;
        let sign = if bytes[0] & 0x80 != 0 { -1 } else { 0 };
        Ok(bytes.iter().fold(sign, |value: i64, &byte| (value << 8) | i64::from(byte)))
    }

    /// The same, as the 32 bits that it is made of.
    pub fn unsigned(&mut self) -> Result<u32> {
        Ok(self.integer(4)? as u32)
    }

    /// A count from 0 to `most`; `what` is counted.
    pub fn count(&mut self, size: usize, most: usize, what: &str) -> Result<usize> {
        let count = self.integer(size)?;
        usize::try_from(count)
            .ok()
            .filter(|&count| count <= most)
            .ok_or_else(|| self.error(format!("a damaged file: {count} {what}")))
    }

    /// A real: (mantissa + 1/2) / (2^31 - 1) times 2 to the exponent.
    pub fn real(&mut self) -> Result<f64> {
        let mantissa = self.integer(4)?;
        let exponent = self.integer(1)?;
        if mantissa == 0 {
            return Ok(0.0);
        }
        let half = if mantissa < 0 { -0.5 } else { 0.5 };
        Ok((mantissa as f64 + half) / f64::from(i32::MAX) * f64::exp2(exponent as f64))
    }

    /// A string.
    pub fn string(&mut self) -> Result<String> {
        let rest = &self.bytes[self.at..];
        let Some(length) = rest.iter().position(|&b| b == 0) else {
            return Err(self.error("the file ends in the middle of a string"));
        };
        let text = String::from_utf8_lossy(&rest[..length]).into_owned();
        self.at += length + 1;
        Ok(text)
    }

    /// A real that is written as text.
    pub fn real_text(&mut self) -> Result<f64> {
        let text = self.string()?;
        let value = text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        value.ok_or_else(|| self.error(format!("expected a number, found \"{text}\"")))
    }

    /// Pass over the octree: a byte for the kind of each node, parents first; full ones count their objects.
    pub fn skip_tree(&mut self) -> Result<()> {
        let mut open = vec![1usize];
        while let Some(last) = open.last_mut() {
            if *last == 0 {
                open.pop();
                continue;
            }
            *last -= 1;
            match self.byte()? {
                EMPTY => {}
                FULL => {
                    let most = self.left() / self.object_size;
                    let objects = self.count(self.object_size, most, "objects in a node")?;
                    self.take(objects * self.object_size)?;
                }
                TREE if open.len() <= MAX_TREE_DEPTH => open.push(8),
                _ => return Err(self.error("a damaged octree")),
            }
        }
        Ok(())
    }
}
