//! Through transmittance a second: the split's look-up against rule 2, which looks at 29 directions at every hit.
//!
//! `cargo bench -p sunpeak-bsdf --bench through`. Rule 2 as a whole, and as little of it as there can be: its 29 directions and
//! their cells, without sorting them into peak and surround.

#[path = "../tests/common/mod.rs"]
mod common;
mod compare;

use common::directions;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use sunpeak_bsdf::{Bsdf, Mode, PeakRule, peak::reference, synthetic::Fabric};
use sunpeak_core::Vec3;

/// Incidences a round.
const COUNT: usize = 10_000;

fn fabric(name: &str) -> Bsdf {
    Fabric::default().tabulate(name.parse().expect("a basis")).expect("a fabric")
}

fn all(bsdf: &Bsdf, incidences: &[Vec3], rule: PeakRule) {
    for &w_in in incidences {
        black_box(bsdf.through(black_box(w_in), rule));
    }
}

/// The cells that rule 2 looks at.
fn look_ups(bsdf: &Bsdf, incidences: &[Vec3]) {
    for &w_in in incidences {
        let Some(o) = bsdf.distribution(black_box(w_in), Mode::Transmission) else { continue };
        let (d, p_in) = (&o.distribution, -w_in.truncate());
        for w in reference::probe(w_in, d.smallest_projected_solid_angle()) {
            let (a, b) = o.points(p_in, w.truncate());
            black_box(d.luminous().value(a, b));
        }
    }
}

fn bench(c: &mut Criterion) {
    let tables: Vec<(&str, Bsdf)> =
        ["klems", "t3-4096", "t3-16384", "t4-256", "t4-1024"].map(|name| (name, fabric(name))).into();
    let incidences = directions(COUNT as u32, true);
    let mut group = c.benchmark_group("through");
    group.sample_size(10);
    group.throughput(Throughput::Elements(COUNT as u64));
    for (name, bsdf) in &tables {
        group.bench_function(*name, |b| b.iter(|| all(bsdf, &incidences, PeakRule::Split)));
    }
    group.finish();
    let ours = |bsdf| all(bsdf, &incidences, PeakRule::Split);
    compare::heading("through transmittance", "ns an incidence", "rule 2");
    for (name, bsdf) in &tables {
        compare::row(name, COUNT, || ours(bsdf), || all(bsdf, &incidences, PeakRule::Radiance));
    }
    compare::heading("through transmittance", "ns an incidence", "the 29 look-ups of rule 2 alone");
    for (name, bsdf) in &tables {
        compare::row(name, COUNT, || ours(bsdf), || look_ups(bsdf, &incidences));
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
