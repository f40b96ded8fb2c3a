//! A fingerprint of the sources: what one version of them made of a file is not good for another.

use std::{
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    io,
    path::Path,
};

fn main() -> io::Result<()> {
    let mut hasher = DefaultHasher::new();
    // `core` is not there where this crate is built alone; its version then stands in Cargo.lock.
    for folder in ["src", "../core/src"].map(Path::new) {
        println!("cargo::rerun-if-changed={}", folder.display());
        if folder.is_dir() {
            add(folder, &mut hasher)?;
        }
    }
    println!("cargo::rustc-env=SUNPEAK_BSDF_SOURCES={:016x}", hasher.finish());
    Ok(())
}

fn add(folder: &Path, hasher: &mut DefaultHasher) -> io::Result<()> {
    let mut entries: Vec<_> =
        fs::read_dir(folder)?.map(|e| e.map(|e| e.path())).collect::<io::Result<_>>()?;
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            add(&entry, hasher)?;
        } else {
            entry.hash(hasher);
            fs::read(&entry)?.hash(hasher);
        }
    }
    Ok(())
}
