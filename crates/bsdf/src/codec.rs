//! Numbers and texts as bytes, little-endian, with a check sum; what is read back is bounded by what is there.

use std::{
    fs::{self, File},
    io::{self, BufWriter, Read, Write},
    path::Path,
};
use sunpeak_core::{Error, Result};

/// Bytes that are turned at a time.
const CHUNK: usize = 1 << 16;

/// Length of a hash.
pub const HASH: usize = blake3::OUT_LEN;

/// Writes and sums up.
pub struct Encoder<W> {
    inner: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Encoder<W> {
    /// To a writer.
    pub fn new(inner: W) -> Self {
        Self { inner, hasher: blake3::Hasher::new() }
    }

    /// Bytes as they are.
    pub fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hasher.update(bytes);
        self.inner.write_all(bytes)
    }

    /// A number of things.
    pub fn count(&mut self, count: usize) -> io::Result<()> {
        self.bytes(&(count as u64).to_le_bytes())
    }

    /// A text with its length.
    pub fn text(&mut self, text: &str) -> io::Result<()> {
        self.count(text.len())?;
        self.bytes(text.as_bytes())
    }

    /// Numbers without their number.
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
        numbers.into_iter().try_for_each(|n| self.bytes(&n.to_le_bytes()))
    }

    /// Values with their number.
    pub fn values(&mut self, values: &[f32]) -> io::Result<()> {
        self.count(values.len())?;
        let mut chunk = Vec::with_capacity(CHUNK);
        for part in values.chunks(CHUNK / 4) {
            chunk.clear();
            chunk.extend(part.iter().flat_map(|v| v.to_le_bytes()));
            self.bytes(&chunk)?;
        }
        Ok(())
    }

    /// The sum of all so far.
    pub fn sum(&self) -> [u8; HASH] {
        *self.hasher.finalize().as_bytes()
    }

    /// The sum of all before ends the file.
    pub fn finish(mut self) -> io::Result<W> {
        let sum = self.hasher.finalize();
        self.inner.write_all(sum.as_bytes())?;
        Ok(self.inner)
    }
}

/// Reads what [`Encoder`] wrote.
pub struct Decoder<R> {
    inner: R,
    /// Bytes that may still come.
    left: u64,
    hasher: blake3::Hasher,
}

impl<R: Read> Decoder<R> {
    /// Of a file of so many bytes.
    pub fn new(inner: R, length: u64) -> Self {
        Self { inner, left: length.saturating_sub(HASH as u64), hasher: blake3::Hasher::new() }
    }

    fn fill(&mut self, bytes: &mut [u8]) -> io::Result<()> {
        self.left = self.left.checked_sub(bytes.len() as u64).ok_or_else(damaged)?;
        self.inner.read_exact(bytes)?;
        self.hasher.update(bytes);
        Ok(())
    }

    /// So many bytes.
    pub fn array<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.fill(&mut bytes)?;
        Ok(bytes)
    }

    /// A number of things of `size` bytes each, which there can be.
    pub fn count(&mut self, size: usize) -> io::Result<usize> {
        let count = u64::from_le_bytes(self.array()?);
        let fits = count.checked_mul(size as u64).is_some_and(|bytes| bytes <= self.left);
        if fits { Ok(count as usize) } else { Err(damaged()) }
    }

    /// A text.
    pub fn text(&mut self) -> io::Result<String> {
        let mut bytes = vec![0; self.count(1)?];
        self.fill(&mut bytes)?;
        String::from_utf8(bytes).map_err(|_| damaged())
    }

    /// So many numbers.
    pub fn numbers<const N: usize>(&mut self) -> io::Result<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = f64::from_le_bytes(self.array()?);
        }
        Ok(numbers)
    }

    /// Values with their number; finite and not negative, as in any table.
    pub fn values(&mut self) -> io::Result<Vec<f32>> {
        let count = self.count(4)?;
        let mut values = Vec::with_capacity(count);
        let mut chunk = vec![0; CHUNK];
        while values.len() < count {
            let bytes = &mut chunk[..CHUNK.min(4 * (count - values.len()))];
            self.fill(bytes)?;
            let number = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            values.extend(bytes.chunks_exact(4).map(number));
        }
        let sound = |v: &f32| *v >= 0.0 && v.is_finite();
        if values.iter().all(sound) { Ok(values) } else { Err(damaged()) }
    }

    /// Nothing is left but the sum, and it is right.
    pub fn finish(mut self) -> io::Result<()> {
        let mut sum = [0; HASH];
        self.inner.read_exact(&mut sum)?;
        let is_right = self.left == 0 && self.hasher.finalize() == sum;
        if is_right { Ok(()) } else { Err(damaged()) }
    }
}

/// Write a file whole or not at all: beside its place first, and then into it.
///
/// # Errors
/// Of the file system; nothing is left behind then.
pub fn replace_file(path: &Path, write: impl FnOnce(BufWriter<File>) -> io::Result<()>) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(format!(".{name}.{}", std::process::id()));
    let written = File::create(&temporary)
        .and_then(|file| write(BufWriter::new(file)))
        .and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    written.map_err(|e| Error::io(path, e))
}

/// The file is not what was written.
pub fn damaged() -> io::Error {
    io::Error::from(io::ErrorKind::InvalidData)
}
