//! What the integration tests share.
#![allow(dead_code, missing_docs, clippy::unwrap_used)]

use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_bsdf::{
    Bsdf, Distribution, Sides,
    basis::AngleBasis,
    synthetic::{Basis, Fabric},
    table::{Matrix, Table},
    tree::{Tree, TreeBuilder},
    xml::Document,
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

/// A tree with cells of different sizes: fine along the straight direction, finest in half of the incident square; the cells on the
/// straight direction hold a peak.
pub fn mixed_tree(rank: usize) -> Tree {
    fn place(builder: &mut TreeBuilder, rank: usize, corner: [f64; 4], size: f64) {
        let gap = |a: usize, b: usize| ((corner[a] - corner[b]).abs() - size).max(0.0);
        let (away, straight) = if rank == 3 {
            // The straight direction runs along (1 - x, 1/2).
            let (y, z) = (1.0 - corner[0] - size, 0.5);
            let from = |d: usize, at: f64| (corner[d] - at).max(at - corner[d] - size).max(0.0);
            (from(1, y).max(from(2, z)), corner[1] == y && from(2, z) < 1e-9)
        } else {
            (gap(0, 2).max(gap(1, 3)), corner[0] == corner[2] && corner[1] == corner[3])
        };
        let smallest = if corner[0] < 0.25 { 1.0 / 32.0 } else { 1.0 / 8.0 };
        builder.open().unwrap();
        if size <= smallest || (size <= 0.25 && away > 0.2) {
            let peak = if straight { 0.03 / (size * size) } else { 0.0 };
            builder.value((0.02 + 0.1 * (-8.0 * away).exp() + 0.01 * corner[1] + peak) as f32).unwrap();
        } else {
            for child in 0..1usize << rank {
                let upper = |d: usize| if child >> d & 1 == 1 { size / 2.0 } else { 0.0 };
                place(builder, rank, std::array::from_fn(|d| corner[d] + upper(d)), size / 2.0);
            }
        }
        builder.close().unwrap();
    }
    let mut builder = TreeBuilder::new(rank, 1 << 20);
    place(&mut builder, rank, [0.0; 4], 1.0);
    builder.finish().unwrap()
}

/// A basis of one's own with many patches.
pub fn fine_basis() -> Arc<AngleBasis> {
    let rings: Vec<(f64, usize)> =
        (0..18).map(|i| (5.0 * f64::from(i + 1), if i == 0 { 1 } else { 36 })).collect();
    Arc::new(AngleBasis::new("fine", &rings).unwrap())
}

/// A coarse basis of one's own, with odd numbers of patches.
pub fn coarse_basis() -> Arc<AngleBasis> {
    Arc::new(AngleBasis::new("coarse", &[(12.0, 1), (31.0, 5), (62.0, 9), (90.0, 7)]).unwrap())
}

fn matrix(incident: Arc<AngleBasis>, exiting: Arc<AngleBasis>) -> Table {
    const THROUGH: f64 = 0.03;
    let (n, side) = (exiting.len(), 24);
    let mut values: Vec<f32> =
        (0..incident.len() * n).map(|i| 0.02 + 0.01 * random(i as u32) as f32).collect();
    for column in 0..incident.len() {
        for i in 0..side * side {
            let u = [i % side, i / side].map(|k| (k as f64 + 0.5) / side as f64);
            let straight = exiting.index(incident.point(column, u));
            let share = THROUGH / (side * side) as f64 / exiting.projected_solid_angle(straight);
            values[column * n + straight] += share as f32;
        }
    }
    Table::Matrix(Matrix { incident, exiting, values })
}

/// Tables on bases of one's own, in the largest of which sampling has to search within blocks, and trees of mixed cells: name,
/// structure, table.
pub fn uncommon_tables() -> [(&'static str, &'static str, Table); 5] {
    [
        ("fine matrix", "Columns", matrix(fine_basis(), fine_basis())),
        ("coarse matrix", "Columns", matrix(coarse_basis(), coarse_basis())),
        ("coarse by fine matrix", "Columns", matrix(coarse_basis(), fine_basis())),
        ("mixed t3", "TensorTree3", Table::Tree(mixed_tree(3))),
        ("mixed t4", "TensorTree4", Table::Tree(mixed_tree(4))),
    ]
}

/// With one transmission only, so that it serves both sides.
pub fn one_sided() -> Vec<(String, Bsdf)> {
    uncommon_tables()
        .into_iter()
        .map(|(name, structure, table)| {
            let document = Document { structure: structure.into(), ..Document::default() };
            let transmission_front = Some(Arc::new(Distribution::with_split(table, None)));
            (name.to_owned(), Bsdf::from_sides(document, Sides { transmission_front, ..Sides::default() }))
        })
        .collect()
}
