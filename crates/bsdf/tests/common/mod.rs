//! What the integration tests share.
#![allow(dead_code, missing_docs, clippy::unwrap_used)]

use std::path::PathBuf;
use sunpeak_bsdf::{
    Bsdf,
    synthetic::{Basis, Fabric},
};
use sunpeak_core::Vec3;

/// Real BSDF files, where they are: `$SUNPEAK_SHARED` or `../shared` beside the project.
pub fn shared_files() -> Vec<PathBuf> {
    let root = std::env::var_os("SUNPEAK_SHARED")
        .map(PathBuf::from)
        .unwrap_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared"));
    let Ok(entries) = std::fs::read_dir(root.join("data/bsdf")) else {
        eprintln!("skipped: no real BSDF files at {}", root.display());
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    files.sort();
    files
}

/// The real files that are sound.
pub fn shared_bsdfs() -> Vec<(String, Bsdf)> {
    let files = shared_files().into_iter();
    files
        .filter_map(|f| Some((f.file_name()?.to_string_lossy().into_owned(), Bsdf::load(&f).ok()?)))
        .collect()
}

/// One fabric in small versions of every basis.
pub fn fabrics() -> Vec<(String, Bsdf)> {
    ["klems", "klems-half", "klems-quarter", "t3-256", "t3-1024", "t4-64", "t4-256"]
        .into_iter()
        .map(|name| {
            let basis: Basis = name.parse().unwrap();
            (name.to_owned(), Fabric::default().tabulate(basis).unwrap())
        })
        .collect()
}

/// Halton points: directions and samples without a generator.
pub fn halton(i: u32, base: u32) -> f64 {
    let (mut f, mut r, mut i) = (1.0, 0.0, i + 1);
    while i > 0 {
        f /= f64::from(base);
        r += f * f64::from(i % base);
        i /= base;
    }
    r
}

/// Directions over one hemisphere, uniform in projected solid angle, off the borders of cells; `front` or back.
pub fn directions(n: u32, front: bool) -> Vec<Vec3> {
    (0..n)
        .map(|i| {
            let v = sunpeak_core::warp::cosine_hemisphere(
                [halton(i, 2), halton(i, 3)].map(|u| (u + 0.0137) % 1.0),
            );
            if front { v } else { Vec3::new(v.x, v.y, -v.z) }
        })
        .collect()
}

/// The i-th number of a random sequence in [0, 1) (SplitMix64, Steele, Lea, Flood 2014).
pub fn random(i: u32) -> f64 {
    let mut z = (u64::from(i) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
