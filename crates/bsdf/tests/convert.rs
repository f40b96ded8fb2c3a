//! Conversions keep flux, and say the same of the product: against counted points, against symmetry, against themselves.
#![allow(clippy::unwrap_used)]

use glam::DVec2;
use std::{collections::BTreeMap, f64::consts::TAU};
use sunpeak_bsdf::{
    Bsdf, Conversion, Layout, Mode, PeakRule,
    synthetic::{Basis, Blind, Fabric, Goniophotometer, tabulate},
    table::{Columns, Table},
};
use sunpeak_core::{Vec3, luminance};

/// A blind is not the same at all azimuths, nor up and down; nor are noisy tables the same from both sides.
fn blind(basis: &str) -> Bsdf {
    let blind = Blind { width: 1.1, tilt_deg: 25.0, scattered: 0.2 };
    let seen = Goniophotometer { value_noise: 0.3, seed: 5, ..Default::default() };
    tabulate(&blind, basis.parse().unwrap(), &seen).unwrap()
}

fn fabric(basis: &str) -> Bsdf {
    Fabric::default().tabulate(basis.parse().unwrap()).unwrap()
}

fn into(basis: &str) -> Conversion {
    Conversion { basis: Some(basis.parse::<Basis>().unwrap()), ..Default::default() }
}

fn table(bsdf: &Bsdf, front: bool, mode: Mode) -> Table {
    let w_in = if front { Vec3::Z } else { -Vec3::Z };
    bsdf.distribution(w_in, mode).unwrap().distribution.luminous().clone()
}

/// All flux under uniform light [sr].
fn flux(table: &Table) -> f64 {
    let columns = table.columns();
    let of = |c: usize| -> f64 {
        let cells = table.cells(&columns, c);
        let sum: f64 =
            cells.iter().map(|o| f64::from(table.values()[o.index]) * o.projected_solid_angle).sum();
        sum * columns.projected_solid_angle(c)
    };
    (0..columns.len()).map(of).sum()
}

/// Directions off the borders of cells; many enough to meet most of them.
fn directions() -> Vec<Vec3> {
    let spiral = |k: usize| {
        let z = 1.0 - (k as f64 + 0.37) / 90.0;
        let phi = 2.399_963 * k as f64 + 0.1;
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * phi.cos(), r * phi.sin(), z)
    };
    (0..88).map(spiral).collect()
}

const WAYS: [(&str, &str); 9] = [
    ("klems", "t4-64"),
    ("t4-64", "klems-half"),
    ("klems", "klems-quarter"),
    ("t4-64", "t4-256"),
    ("t4-64", "t3-256"),
    ("klems", "t3-64"),
    ("t3-64", "klems"),
    ("t3-256", "t4-64"),
    ("t3-256", "t3-64"),
];

#[test]
fn flux_is_kept_between_all_kinds_of_bases() {
    for (from, to) in WAYS {
        let bsdf = if from.starts_with("t3") { fabric(from) } else { blind(from) };
        let converted = bsdf.convert(&into(to)).unwrap();
        for front in [true, false] {
            for mode in [Mode::Transmission, Mode::Reflection] {
                let (was, is) = (flux(&table(&bsdf, front, mode)), flux(&table(&converted, front, mode)));
                assert!((is / was - 1.0).abs() < 1e-6, "{from} {to} {mode:?}: {was} {is}");
            }
        }
    }
}

/// Uniform points of a square, `n` a side.
fn square(n: usize) -> impl Iterator<Item = [f64; 2]> + Clone {
    (0..n * n).map(move |k| [k / n, k % n].map(|i| (i as f64 + 0.5) / n as f64))
}

/// Points that fill a square evenly and keep off the borders that a grid would meet (Roberts's additive recurrence).
fn scattered(n: u32) -> impl Iterator<Item = [f64; 2]> {
    (0..n).map(|k| {
        [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step: f64| (0.5 + step * f64::from(k)).fract())
    })
}

/// Cells that weighted points fall into, with their shares.
fn weighed(into: &Columns, points: impl Iterator<Item = (DVec2, f64)>) -> BTreeMap<u32, f64> {
    let (mut counts, mut sum) = (BTreeMap::new(), 0.0);
    for (p, weight) in points {
        *counts.entry(into.index(p) as u32).or_insert(0.0) += weight;
        sum += weight;
    }
    counts.into_iter().map(|(cell, weight)| (cell, weight / sum)).collect()
}

/// Cells of a division that points of a cell of another fall into, with their shares.
fn counted(of: &Columns, cell: usize, into: &Columns) -> BTreeMap<u32, f64> {
    weighed(into, scattered(10_000).map(|u| (of.point(cell, u), 1.0)))
}

/// Means over pairs of new cells, counted at points of the old table.
#[test]
fn values_are_the_means_of_the_old_table_over_the_new_cells() {
    for (from, to) in WAYS.into_iter().filter(|(from, to)| !from.starts_with("t3") && !to.starts_with("t3")) {
        let bsdf = blind(from);
        let new = table(&bsdf.convert(&into(to)).unwrap(), true, Mode::Transmission);
        let old = table(&bsdf, true, Mode::Transmission);
        let (layout, before) = (Layout::of(&new), Layout::of(&old));
        let middle = |division: &Columns, cell: usize| division.point(cell, [0.5, 0.5]);
        let (mut off, mut sum) = (0.0, 0.0);
        for column in (0..layout.incident.len()).step_by(layout.incident.len() / 9) {
            let columns = counted(&layout.incident, column, &before.incident);
            for cell in (0..layout.exiting.len()).step_by(layout.exiting.len() / 9) {
                let mut mean = 0.0;
                for (o, b) in counted(&layout.exiting, cell, &before.exiting) {
                    for (&i, a) in &columns {
                        mean += a
                            * b
                            * old.value(
                                middle(&before.incident, i as usize),
                                middle(&before.exiting, o as usize),
                            );
                    }
                }
                let value = new.value(middle(&layout.incident, column), middle(&layout.exiting, cell));
                off += (value - mean).abs();
                sum += mean;
            }
        }
        assert!(off < 0.01 * sum, "{from} {to}: {off} of {sum}");
    }
}

/// The same where the exit turns with the incidence: pairs of points.
#[test]
fn between_isotropic_tables_and_others_the_exit_turns() {
    const N: usize = 36;
    let bsdf = fabric("t3-64");
    let (old, new) = (
        table(&bsdf, true, Mode::Transmission),
        table(&bsdf.convert(&into("klems-quarter")).unwrap(), true, Mode::Transmission),
    );
    let layout = Layout::of(&new);
    let (mut off, mut sum) = (0.0, 0.0);
    for (column, cell) in [(0, 0), (0, 3), (12, 12), (12, 13), (14, 2), (23, 24), (37, 30), (37, 37)] {
        let pairs = square(N).flat_map(|u| square(N).map(move |v| (u, v)));
        let at = |(u, v)| old.value(layout.incident.point(column, u), layout.exiting.point(cell, v));
        let mean = pairs.map(at).sum::<f64>() / N.pow(4) as f64;
        let middle = |division: &Columns, cell: usize| division.point(cell, [0.5, 0.5]);
        off += (new.value(middle(&layout.incident, column), middle(&layout.exiting, cell)) - mean).abs();
        sum += mean;
    }
    assert!(off < 0.01 * sum, "{off} of {sum}");
    let old = table(&blind("klems-quarter"), true, Mode::Transmission);
    let new = table(&blind("klems-quarter").convert(&into("t3-64")).unwrap(), true, Mode::Transmission);
    let (layout, before) = (Layout::of(&new), Layout::of(&old));
    let (mut off, mut sum) = (0.0, 0.0);
    let middle = |patch: u32| before.incident.point(patch as usize, [0.5, 0.5]);
    for (ring, cell) in [(3, 27), (2, 10), (1, 43), (1, 44), (0, 60)] {
        let mut mean = 0.0;
        // As many azimuths as have nothing in common with the basis; at each, incidence and exit go their own ways.
        for turn in (0..401).map(|d| DVec2::from_angle(TAU * f64::from(d) / 401.0)) {
            let radius = |k: u32| layout.incident.point(ring, [(f64::from(k) + 0.5) / 500.0, 0.5]).x;
            let incident = (0..500).map(|k| (turn * radius(k), radius(k)));
            let exiting = scattered(10_000).map(|u| (turn.rotate(layout.exiting.point(cell, u)), 1.0));
            let (a, b) = (weighed(&before.incident, incident), weighed(&before.exiting, exiting));
            for (i, share) in &a {
                mean +=
                    b.iter().map(|(o, other)| share * other * old.value(middle(*i), middle(*o))).sum::<f64>()
                        / 401.0;
            }
        }
        let at = layout.incident.point(ring, [0.5, 0.5]);
        off += (new.value(at, layout.exiting.point(cell, [0.5, 0.5])) - mean).abs();
        sum += mean;
    }
    assert!(off < 0.01 * sum, "{off} of {sum}");
}

#[test]
fn finer_and_back_is_the_same_table() {
    for (coarse, fine) in [("t4-64", "t4-256"), ("t3-64", "t3-1024")] {
        let bsdf = if coarse.starts_with("t3") { fabric(coarse) } else { blind(coarse) };
        let back = bsdf.convert(&into(fine)).unwrap().convert(&into(coarse)).unwrap();
        let (was, is) = (table(&bsdf, true, Mode::Transmission), table(&back, true, Mode::Transmission));
        for (a, b) in was.values().iter().zip(is.values()) {
            assert!((a - b).abs() <= 1e-5 * a.abs(), "{coarse}: {a} {b}");
        }
    }
}

/// What was asked of the product before is asked after it was moved.
fn same_when_moved(bsdf: &Bsdf, to: &Conversion, was: impl Fn(Vec3) -> Vec3, name: &str) {
    let moved = bsdf.convert(to).unwrap();
    for w_in in directions().into_iter().flat_map(|w| [w, -w]) {
        for w_out in directions().into_iter().flat_map(|w| [w, -w]).step_by(5) {
            let (a, b) =
                (luminance(moved.evaluate(w_in, w_out)), luminance(bsdf.evaluate(was(w_in), was(w_out))));
            assert!((a - b).abs() < 1e-5 * b.max(1e-3), "{name} {w_in} {w_out}: {a} {b}");
        }
    }
}

#[test]
fn turned_over_turned_and_renamed_products_answer_from_where_they_are_now() {
    let flip = Conversion { flip: true, ..Default::default() };
    let swap = Conversion { swap_sides: true, ..Default::default() };
    let quarter = Conversion { rotate_deg: 90.0, ..Default::default() };
    let turned = |w: Vec3| Vec3::new(w.y, -w.x, w.z); // by -90 degrees: where it was
    for basis in ["klems", "klems-quarter", "t4-64"] {
        let bsdf = blind(basis);
        same_when_moved(&bsdf, &flip, |w| Vec3::new(-w.x, w.y, -w.z), "flip");
        same_when_moved(&bsdf, &swap, |w| Vec3::new(w.x, w.y, -w.z), "swap");
        same_when_moved(&bsdf, &quarter, turned, "quarter turn");
    }
    let isotropic = fabric("t3-256");
    same_when_moved(&isotropic, &flip, |w| Vec3::new(-w.x, w.y, -w.z), "flip of t3");
    same_when_moved(&isotropic, &Conversion { rotate_deg: 33.0, ..Default::default() }, |w| w, "turn of t3");
}

#[test]
fn turns_by_any_angle_keep_the_flux_and_undo_each_other_in_the_mean() {
    let bsdf = blind("klems");
    let turn = |rotate_deg: f64| Conversion { rotate_deg, ..Default::default() };
    let there = bsdf.convert(&turn(23.0)).unwrap();
    let (was, is) = (table(&bsdf, true, Mode::Transmission), table(&there, true, Mode::Transmission));
    assert!((flux(&is) / flux(&was) - 1.0).abs() < 1e-6);
    // The straight flux of a turned blind at the azimuth that is turned with it.
    let half = bsdf.convert(&turn(180.0)).unwrap();
    let w = Vec3::new(0.0, 0.5, 0.75f64.sqrt());
    let other = Vec3::new(0.0, -0.5, 0.75f64.sqrt());
    let of = |b: &Bsdf, w: Vec3| luminance(b.through(w, PeakRule::Split));
    assert!((of(&half, w) - of(&bsdf, other)).abs() < 1e-6 && (of(&half, w) - of(&bsdf, w)).abs() > 0.05);
    assert!(bsdf.convert(&turn(f64::NAN)).is_err());
}

#[test]
fn reciprocal_tables_are_the_same_both_ways_and_keep_the_mean() {
    let average = Conversion { reciprocal: true, ..Default::default() };
    for basis in ["klems", "t4-64"] {
        let bsdf = blind(basis);
        let mended = bsdf.convert(&average).unwrap();
        let mut changed = false;
        for w_in in directions().into_iter().flat_map(|w| [w, -w]) {
            for w_out in directions().into_iter().flat_map(|w| [w, -w]).step_by(3) {
                let [there, back] =
                    [(w_in, w_out), (w_out, w_in)].map(|(a, b)| luminance(mended.evaluate(a, b)));
                assert!(
                    (there - back).abs() < 1e-6 * there.max(1.0),
                    "{basis} {w_in} {w_out}: {there} {back}"
                );
                let [was, other] =
                    [(w_in, w_out), (w_out, w_in)].map(|(a, b)| luminance(bsdf.evaluate(a, b)));
                assert!((there - 0.5 * (was + other)).abs() < 1e-6 * there.max(1.0), "{basis}");
                changed |= (was - other).abs() > 1e-3;
            }
        }
        assert!(changed, "{basis} was reciprocal before");
    }
    // Isotropic trees: the cells are not each other's partners, means over them are. What is reciprocal stays nearly as it is.
    let bsdf = fabric("t3-1024");
    let mended = bsdf.convert(&average).unwrap();
    let (was, is) = (table(&bsdf, true, Mode::Transmission), table(&mended, true, Mode::Transmission));
    assert!((flux(&is) / flux(&was) - 1.0).abs() < 1e-3, "{} {}", flux(&was), flux(&is));
    for theta in [5.0f64, 30.0, 50.0] {
        let w = Vec3::new(theta.to_radians().sin(), 0.0, theta.to_radians().cos());
        let [a, b] =
            [&bsdf, &mended].map(|b| luminance(b.hemispherical_smooth(w, Mode::Transmission, PeakRule::Off)));
        assert!((a - b).abs() < 0.02 * a, "{theta}: {a} {b}");
    }
}

#[test]
fn a_kept_peak_is_a_delta_in_the_new_basis() {
    let fabric_formula = Fabric::default();
    let coarse = fabric("t3-1024");
    let keep = |basis: &str| Conversion { keep_peak: true, ..into(basis) };
    for (basis, most) in [("t3-4096", 0.01), ("klems", 0.02), ("t4-1024", 0.02)] {
        let fine = coarse.convert(&keep(basis)).unwrap();
        let (was, is) = (table(&coarse, true, Mode::Transmission), table(&fine, true, Mode::Transmission));
        assert!((flux(&is) / flux(&was) - 1.0).abs() < 2e-4, "{basis}: {} {}", flux(&was), flux(&is));
        for theta in [3.0f64, 20.0, 40.0] {
            let w = Vec3::new(theta.to_radians().sin(), 0.02, theta.to_radians().cos()).normalize();
            let truth = fabric_formula.through(w.z.acos());
            let found = luminance(fine.through(w, PeakRule::Split));
            assert!((found / truth - 1.0).abs() < most, "{basis} {theta}: {found} {truth}");
        }
    }
}
