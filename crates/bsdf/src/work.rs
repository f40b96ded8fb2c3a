//! Long computations by columns: counted, stopped between two of them, and kept to go on with later.

use crate::codec::{Decoder, Encoder, HASH, damaged, replace_file};
use rayon::prelude::*;
use std::{
    collections::BTreeMap,
    fmt::Debug,
    fs::File,
    io::{self, BufReader, Read, Write},
    path::Path,
    sync::{Mutex, MutexGuard, PoisonError},
};
use sunpeak_core::{Control, Error, Location, Result};

/// The first bytes of a file of kept columns, with the version of its format.
const MAGIC: [u8; 8] = *b"spwork01";

/// What a column is known by: the computation with all that it depends on, its part, its number.
type Key = ([u8; HASH], String, usize);

/// Columns that are finished, of one computation or of several after each other.
#[derive(Debug, Default)]
pub struct Kept {
    columns: Mutex<BTreeMap<Key, Vec<f32>>>,
    /// Nothing of what was read has been used yet.
    is_unproven: Mutex<bool>,
}

impl Kept {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Read what an earlier run has finished.
    ///
    /// # Errors
    /// Where there is no such file, or something else in it.
    pub fn load(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|e| Error::io(path, e))?;
        let length = file.metadata().map_err(|e| Error::io(path, e))?.len();
        let mut from = Decoder::new(BufReader::new(file), length);
        let columns = read(&mut from).and_then(|columns| from.finish().map(|()| columns)).map_err(|_| {
            let place = Location::new(&*path.to_string_lossy(), 0, 0);
            Error::input(place, "it is damaged, or holds no finished columns; start again without --resume")
        })?;
        Ok(Self { columns: Mutex::new(columns), is_unproven: Mutex::new(true) })
    }

    /// Write what is finished, whole or not at all.
    ///
    /// # Errors
    /// Of the file system.
    pub fn save(&self, path: &Path) -> Result<()> {
        replace_file(path, |file| write(file, &lock(&self.columns)))
    }

    /// Have any columns been finished?
    pub fn is_empty(&self) -> bool {
        lock(&self.columns).is_empty()
    }

    /// The first computation of a run that goes on has to be the one that was stopped, or one before it.
    fn prove(&self, print: &[u8; HASH]) -> Result<()> {
        let mut is_unproven = lock(&self.is_unproven);
        if *is_unproven && !lock(&self.columns).keys().any(|key| key.0 == *print) {
            return Err(Error::value(
                "the finished columns were made from another input, or with other options; expected the same as before, or a run \
                 without --resume",
            ));
        }
        *is_unproven = false;
        Ok(())
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn write(file: impl Write, columns: &BTreeMap<Key, Vec<f32>>) -> io::Result<()> {
    let mut out = Encoder::new(file);
    out.bytes(&MAGIC)?;
    out.count(columns.len())?;
    for ((print, part, number), values) in columns {
        out.bytes(print)?;
        out.text(part)?;
        out.count(*number)?;
        out.values(values)?;
    }
    out.finish()?.flush()
}

fn read(from: &mut Decoder<impl Read>) -> io::Result<BTreeMap<Key, Vec<f32>>> {
    if from.array()? != MAGIC {
        return Err(damaged());
    }
    let count = from.count(HASH)?;
    let one = |_| {
        let (print, part) = (from.array()?, from.text()?);
        let number = u64::from_le_bytes(from.array()?);
        Ok(((print, part, usize::try_from(number).map_err(|_| damaged())?), from.values()?))
    };
    (0..count).map(one).collect()
}

/// One long computation: who watches it, and where its columns are kept. By default nobody does, and they are not.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work<'a> {
    control: Option<&'a Control>,
    kept: Option<&'a Kept>,
    print: [u8; HASH],
}

impl<'a> Work<'a> {
    /// Watched alone.
    pub fn new(control: &'a Control) -> Self {
        Self { control: Some(control), ..Self::default() }
    }

    /// With columns that are kept; `input` writes down all that they depend on.
    ///
    /// # Errors
    /// Where columns were read that are of something else.
    pub fn keeping(
        control: &'a Control,
        kept: &'a Kept,
        input: impl FnOnce(&mut Encoder<io::Sink>) -> io::Result<()>,
    ) -> Result<Self> {
        let mut sum = Encoder::new(io::sink());
        let print = sum
            .text(env!("CARGO_PKG_VERSION"))
            .and_then(|()| input(&mut sum))
            .map(|()| sum.sum())
            .map_err(|e| Error::value(format!("cannot sum up the input: {e}")))?;
        kept.prove(&print)?;
        Ok(Self { control: Some(control), kept: Some(kept), print })
    }

    /// So many columns are to come, of all parts.
    pub fn expect(&self, columns: usize) {
        if let Some(control) = self.control {
            control.set_total(columns as u64);
        }
    }

    /// The values of all columns of a part, those of an earlier run as they were.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when stopped; what is finished is kept.
    pub fn columns(
        &self,
        part: impl Debug,
        count: usize,
        column: impl Fn(usize) -> Vec<f32> + Sync,
    ) -> Result<Vec<Vec<f32>>> {
        let part = format!("{part:?}");
        let one = |number: usize| {
            self.check()?;
            let values = self.known(&part, number).unwrap_or_else(|| column(number));
            self.keep(&part, number, &values);
            self.advance(1);
            Ok(values)
        };
        (0..count).into_par_iter().with_max_len(1).map(one).collect()
    }

    /// The last of several steps that each go on from what the one before has made, `first` for the first one. Each counts as a column.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when stopped; what the last finished step has made is kept.
    pub fn steps(
        &self,
        part: impl Debug,
        count: usize,
        first: Vec<f32>,
        mut step: impl FnMut(usize, &mut [f32]) -> Result<()>,
    ) -> Result<Vec<f32>> {
        let part = format!("{part:?}");
        let last = (0..count).rev().find_map(|n| self.known(&part, n).map(|values| (n, values)));
        let (done, mut values) = match last {
            Some((n, values)) if values.len() == first.len() => (n + 1, values),
            _ => (0, first),
        };
        self.advance(done);
        for number in done..count {
            self.check()?;
            step(number, &mut values)?;
            self.keep(&part, number, &values);
            if number > 0 {
                self.forget(&part, number - 1);
            }
            self.advance(1);
        }
        Ok(values)
    }

    /// Stop if somebody has asked to.
    ///
    /// # Errors
    /// [`Error::Interrupted`] then.
    pub fn check(&self) -> Result<()> {
        self.control.map_or(Ok(()), Control::check)
    }

    /// Count columns that are finished and not kept.
    pub fn advance(&self, columns: usize) {
        if let Some(control) = self.control {
            control.advance(columns as u64);
        }
    }

    fn key(&self, part: &str, number: usize) -> Key {
        (self.print, part.to_owned(), number)
    }

    fn known(&self, part: &str, number: usize) -> Option<Vec<f32>> {
        self.kept.and_then(|kept| lock(&kept.columns).get(&self.key(part, number)).cloned())
    }

    fn keep(&self, part: &str, number: usize, values: &[f32]) {
        if let Some(kept) = self.kept {
            lock(&kept.columns).insert(self.key(part, number), values.to_vec());
        }
    }

    fn forget(&self, part: &str, number: usize) {
        if let Some(kept) = self.kept {
            lock(&kept.columns).remove(&self.key(part, number));
        }
    }
}
