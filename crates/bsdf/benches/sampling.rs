//! Samples per second: ours against a plain cumulative search over all cells of a column.
//!
//! `cargo bench -p sunpeak-bsdf --bench sampling`. Both draw from what the split left of a transmission, for the same incidences and
//! the same random numbers, and return direction, weight and density. The plain search adds up the cells' fluxes until they pass
//! the random share of the column's whole. A second table has it with all sums stored, which takes eight bytes a value (ours: at
//! most a quarter byte): then it adds nothing up, and where columns have few cells there is little left to save.

#[path = "../tests/common/mod.rs"]
mod common;
mod compare;

use common::{directions, random};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use std::{hint::black_box, sync::Arc};
use sunpeak_bsdf::{
    Bsdf, Distribution, Mode, PeakRule, Sample, Sides,
    synthetic::Fabric,
    table::{Cell, Table, turned_back},
    tree::{Tree, TreeBuilder},
    xml::Document,
};
use sunpeak_core::{Vec3, luminance};

/// Samples a round.
const COUNT: usize = 20_000;

/// The simplest sampler of a table: the cells of a column are looked through from the first on.
struct PlainSearch<'a> {
    distribution: &'a Distribution,
    columns: Vec<Vec<Cell>>,
    /// Cumulative fluxes of each column's cells [-].
    sums: Vec<Vec<f64>>,
}

impl<'a> PlainSearch<'a> {
    fn new(distribution: &'a Distribution) -> Self {
        let (table, columns) = (distribution.luminous(), distribution.columns());
        let cells: Vec<_> = (0..columns.len()).map(|c| table.cells(columns, c)).collect();
        let mut plain = Self { distribution, columns: cells, sums: Vec::new() };
        plain.sums = (0..plain.columns.len()).map(|c| plain.running_sums(c).collect()).collect();
        plain
    }

    fn running_sums(&self, column: usize) -> impl Iterator<Item = f64> {
        self.columns[column].iter().scan(0.0, move |sum, cell| {
            *sum += self.distribution.residual_at(column, cell.index) * cell.projected_solid_angle;
            Some(*sum)
        })
    }

    fn sample(&self, w_in: Vec3, [pick, u, v]: [f64; 3], search: Search) -> Option<Sample> {
        let (table, p_in) = (self.distribution.luminous(), -w_in.truncate());
        let column = self.distribution.columns().index(p_in);
        let sums = &self.sums[column];
        let total = *sums.last()?;
        let found = match search {
            Search::Adding => self.running_sums(column).position(|sum| sum > pick * total),
            Search::Stored => sums.iter().position(|&sum| sum > pick * total),
        };
        let cell = &self.columns[column][found?];
        let p = table.point(cell, [u, v]);
        let p_out: DVec2 = if table.is_isotropic() { turned_back(p_in, p) } else { p };
        let height = (1.0 - p_out.length_squared()).max(0.0).sqrt();
        let split = self.distribution.split();
        let value =
            split.surround(column, cell.index).unwrap_or_else(|| self.distribution.at_index(cell.index));
        let density = luminance(value) / total;
        let w_out = p_out.extend(-height.copysign(w_in.z));
        Some(Sample { w_out, weight: value / density, pdf: density * height })
    }
}

/// Where the plain search has its sums from.
#[derive(Clone, Copy)]
enum Search {
    Adding,
    Stored,
}

/// A tree as files have it: cells that differ by less than 10 % from their mean are one.
fn merged(tree: &Tree) -> Tree {
    fn place(tree: &Tree, builder: &mut TreeBuilder, corner: [f64; 4], size: f64) -> Result<(), String> {
        let (mut sum, mut count, mut least, mut most) = (0.0, 0.0, f32::INFINITY, 0.0f32);
        tree.for_each_leaf_in(&corner.map(|c| (c, c + size)), |leaf| {
            let value = tree.values()[leaf.index];
            (sum, count) = (sum + value, count + 1.0);
            (least, most) = (least.min(value), most.max(value));
        });
        let mean = sum / count;
        builder.open()?;
        if most <= 1.1 * mean && least >= 0.9 * mean {
            builder.value(mean)?;
        } else {
            for child in 0..1usize << tree.rank() {
                let half = 0.5 * size;
                let at = std::array::from_fn(|d| corner[d] + if child >> d & 1 == 1 { half } else { 0.0 });
                place(tree, builder, at, half)?;
            }
        }
        builder.close()
    }
    let mut builder = TreeBuilder::new(tree.rank(), tree.values().len());
    place(tree, &mut builder, [0.0; 4], 1.0).expect("a tree");
    builder.finish().expect("a tree")
}

/// Transmission alone, from the side that the file calls front.
fn one_sided(transmission: Arc<Distribution>) -> Bsdf {
    let sides = Sides { transmission_front: Some(transmission), ..Sides::default() };
    Bsdf::from_sides(Document::default(), sides)
}

fn transmission(bsdf: &Bsdf) -> &Arc<Distribution> {
    &bsdf.distribution(-Vec3::Z, Mode::Transmission).expect("transmits").distribution
}

fn tables() -> Vec<(String, Bsdf)> {
    let mut tables = Vec::new();
    for (name, mixed) in
        [("klems", false), ("t3-4096", true), ("t3-16384", true), ("t4-256", false), ("t4-1024", true)]
    {
        let fabric = Fabric::default().tabulate(name.parse().expect("a basis")).expect("a fabric");
        let whole = transmission(&fabric).clone();
        if let (Table::Tree(tree), true) = (whole.luminous(), mixed) {
            let merged = Distribution::with_split(Table::Tree(merged(tree)), None);
            tables.push((format!("{name}, mixed"), one_sided(Arc::new(merged))));
        }
        tables.push((name.to_owned(), one_sided(whole)));
    }
    tables.sort_by_key(|(name, _)| name.contains("mixed"));
    tables
}

fn queries() -> Vec<(Vec3, [f64; 3])> {
    let number = |i: usize| random(i as u32);
    let all = directions(COUNT as u32, false).into_iter().enumerate();
    all.map(|(i, w)| (w, [number(3 * i), number(3 * i + 1), number(3 * i + 2)])).collect()
}

fn all_ours(bsdf: &Bsdf, queries: &[(Vec3, [f64; 3])]) {
    for &(w_in, u) in queries {
        black_box(bsdf.sample_smooth(black_box(w_in), u, PeakRule::Split));
    }
}

fn all_theirs(plain: &PlainSearch, queries: &[(Vec3, [f64; 3])], search: Search) {
    for &(w_in, u) in queries {
        black_box(plain.sample(black_box(w_in), u, search));
    }
}

fn bench(c: &mut Criterion) {
    let (tables, queries) = (tables(), queries());
    let mut group = c.benchmark_group("sampling");
    group.sample_size(10);
    group.throughput(Throughput::Elements(COUNT as u64));
    for (name, bsdf) in &tables {
        group.bench_function(name, |b| b.iter(|| all_ours(bsdf, &queries)));
    }
    group.finish();
    for (search, theirs) in [(Search::Adding, "a plain search"), (Search::Stored, "with all sums stored")] {
        compare::heading("sampling", "ns a sample", theirs);
        for (name, bsdf) in &tables {
            let plain = PlainSearch::new(transmission(bsdf));
            let theirs = || all_theirs(&plain, &queries, search);
            compare::row(name, COUNT, || all_ours(bsdf, &queries), theirs);
        }
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
