//! Files that were read before, as they came out: tables and splits, in a folder of the user's.
//!
//! A large file is read and split once. What came out is kept under the hash of its content and of this crate's sources, so that
//! neither a changed file nor a changed program meets something old. A cache file is written whole or not at all; one that is
//! damaged, cut or of another make is passed over and written anew. All that it says is checked: lengths, indices, values, and
//! a sum over everything. The folder can be deleted at any time; the files used longest ago go when it grows large.
//!
//! The folder is `$SUNPEAK_CACHE`; else `sunpeak` in `$XDG_CACHE_HOME`, `%LOCALAPPDATA%` or `~/.cache`. `SUNPEAK_CACHE=off`
//! turns the cache off.
//!
//! BLAKE3 (its authors' crate) makes the hashes: a file of another's making cannot pose as one that was read before, and 200 MB
//! take 0.1 s. The bytes are written by hand ([`codec`]): the few kinds of things need checks of their own when they are read,
//! and no other crate's format then decides when old files become unreadable.

mod contents;

pub(crate) use contents::Contents;

use crate::codec::{Decoder, Encoder, HASH, damaged};
use std::{
    ffi::OsString,
    fs::{self, File},
    io::{self, BufReader, BufWriter, Read, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicU64, Ordering},
    time::SystemTime,
};

/// Files from this size on are kept [bytes]: a matrix of 145 patches a side has two to three times of it, and
/// is split in a third of a second.
const LEAST_FILE: u64 = 1 << 17;

/// What the folder may hold [bytes].
const LARGEST_FOLDER: u64 = 4 << 30;

/// The first bytes of a cache file, with the version of its format.
const MAGIC: [u8; 8] = *b"spbsdf01";

/// Bytes that are read or written at a time.
const BUFFER: usize = 1 << 18;

/// A folder of files that were read before.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
    least_file: u64,
    largest_folder: u64,
}

/// The place of one file in a cache, as long as the file stays the same.
pub(crate) struct Slot {
    key: [u8; HASH],
    path: PathBuf,
    file: PathBuf,
    state: State,
    largest_folder: u64,
}

/// Size and time of change of a file.
type State = (u64, Option<SystemTime>);

impl Cache {
    /// The user's, unless it is turned off.
    pub fn of_user() -> Option<Self> {
        let set = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty());
        let home = || set("HOME").map(|home| PathBuf::from(home).join(".cache").into_os_string());
        match set("SUNPEAK_CACHE") {
            Some(own) if own == *"off" => None,
            Some(own) => Some(Self::at(own)),
            None => {
                let caches: OsString = set("XDG_CACHE_HOME").or_else(|| set("LOCALAPPDATA")).or_else(home)?;
                Some(Self::at(PathBuf::from(caches).join("sunpeak")))
            }
        }
    }

    /// In a folder, which is made when there is something to keep.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), least_file: LEAST_FILE, largest_folder: LARGEST_FOLDER }
    }

    /// Keep files from so many bytes on, and so many bytes in all.
    pub fn with_limits(self, least_file: u64, largest_folder: u64) -> Self {
        Self { least_file, largest_folder, ..self }
    }

    /// Where a file belongs; none if it is not worth it, or cannot be read twice.
    pub(crate) fn slot(&self, file: &Path) -> Option<Slot> {
        let state = state(file)?;
        if state.0 < self.least_file {
            return None;
        }
        let key = key(file).ok()?;
        let name: String = key.iter().map(|byte| format!("{byte:02x}")).collect();
        Some(Slot {
            key,
            path: self.folder.join("bsdf").join(name),
            file: file.to_owned(),
            state,
            largest_folder: self.largest_folder,
        })
    }
}

fn state(file: &Path) -> Option<State> {
    let about = fs::metadata(file).ok().filter(fs::Metadata::is_file)?;
    Some((about.len(), about.modified().ok()))
}

/// Hash of a file's content and of what reads it.
fn key(file: &Path) -> io::Result<[u8; HASH]> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&MAGIC).update(env!("SUNPEAK_BSDF_SOURCES").as_bytes());
    let mut file = File::open(file)?;
    let mut buffer = vec![0; BUFFER];
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok(*hasher.finalize().as_bytes()),
            Ok(count) => hasher.update(&buffer[..count]),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
            Err(e) => return Err(e),
        };
    }
}

impl Slot {
    /// What is kept there, if it is sound.
    pub fn get(&self) -> Option<Contents> {
        let contents = self.read().ok()?;
        // Used now: others go first. Where that cannot be noted, it goes when it goes.
        let _ = File::open(&self.path).and_then(|f| f.set_modified(SystemTime::now()));
        Some(contents)
    }

    fn read(&self) -> io::Result<Contents> {
        let file = File::open(&self.path)?;
        let length = file.metadata()?.len();
        let mut from = Decoder::new(BufReader::with_capacity(BUFFER, file), length);
        if from.array()? != MAGIC || from.array()? != self.key {
            return Err(damaged());
        }
        let contents = Contents::read(&mut from)?;
        from.finish()?;
        Ok(contents)
    }

    /// Keep something there. A cache that cannot be written to is none: nobody has to hear of it.
    pub fn put(&self, contents: &Contents) {
        if state(&self.file) == Some(self.state) && self.write(contents).is_ok() {
            self.make_room();
        }
    }

    /// Under a passing name first, so that nobody meets half a file.
    fn write(&self, contents: &Contents) -> io::Result<()> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let passing = self.path.with_extension(format!("{}-{number}", std::process::id()));
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder)?;
        }
        let written = self.write_to(&passing, contents).and_then(|()| fs::rename(&passing, &self.path));
        if written.is_err() {
            let _ = fs::remove_file(&passing);
        }
        written
    }

    fn write_to(&self, path: &Path, contents: &Contents) -> io::Result<()> {
        let mut out = Encoder::new(BufWriter::with_capacity(BUFFER, File::create(path)?));
        out.bytes(&MAGIC)?;
        out.bytes(&self.key)?;
        contents.write(&mut out)?;
        out.finish()?.flush()
    }

    /// Delete what was used longest ago until the folder is small enough.
    fn make_room(&self) {
        let Some(entries) = self.path.parent().and_then(|folder| fs::read_dir(folder).ok()) else { return };
        let mut files: Vec<(SystemTime, u64, PathBuf)> = entries
            .flatten()
            .filter_map(|entry| {
                let about = entry.metadata().ok().filter(fs::Metadata::is_file)?;
                Some((about.modified().ok()?, about.len(), entry.path()))
            })
            .collect();
        files.sort();
        let mut total: u64 = files.iter().map(|f| f.1).sum();
        for (_, size, path) in files {
            if total <= self.largest_folder {
                return;
            }
            if path != self.path && fs::remove_file(&path).is_ok() {
                total -= size;
            }
        }
    }
}
