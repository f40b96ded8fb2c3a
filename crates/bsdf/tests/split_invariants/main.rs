//! Invariants of the split, column by column: on random tables of every kind, on fabrics of our own, and on all real files.
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod tables;

use common::{directions, fabrics, one_sided, random, shared_bsdfs};
use glam::DVec2;
use proptest::prelude::*;
use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};
use sunpeak_bsdf::{
    Bsdf, Distribution, Mode, PeakRule, Sides,
    basis::AngleBasis,
    synthetic::Fabric,
    table::{Cell, Columns, Matrix, Table},
    tree::Tree,
    xml::Document,
};
use sunpeak_core::{Rgb, Vec3, luminance};
use tables::{Content, Shape, content, known_basis, shape};

/// Agreement of sums [relative].
const EQUAL: f64 = 1e-6;

/// Cells that the straight direction meets while the incidence moves over a column: by looking at many points of it.
fn straight_cells(table: &Table, columns: &Columns, column: usize) -> Vec<usize> {
    let n = 48;
    let mut cells = Vec::new();
    for i in 0..n * n {
        let u = [i % n, i / n].map(|k| (k as f64 + 0.5) / n as f64);
        let p = columns.point(column, u);
        // In isotropic tables it runs along a border: the cells on both sides are met.
        let aside: &[f64] = if table.is_isotropic() { &[-1e-6, 1e-6] } else { &[0.0] };
        cells.extend(aside.iter().map(|&y| table.index(p, p + DVec2::new(0.0, y))));
    }
    cells.sort_unstable();
    cells.dedup();
    cells
}

fn residual(d: &Distribution, column: usize, cell: &Cell) -> Rgb {
    d.split().surround(column, cell.index).unwrap_or_else(|| d.at_index(cell.index))
}

/// In each channel residual plus peak is the table, the residual is not negative, and what goes through was in the cells that lie
/// straight ahead.
fn check_columns(name: &str, d: &Distribution) {
    let (table, columns, split) = (d.luminous(), d.columns(), d.split());
    for column in 0..columns.len() {
        let through = split.column(column).unwrap().through;
        let ahead = straight_cells(table, columns, column);
        let (mut whole, mut rest, mut straight) = (Rgb::ZERO, Rgb::ZERO, Rgb::ZERO);
        for cell in table.cells(columns, column) {
            let (value, left) = (d.at_index(cell.index), residual(d, column, &cell));
            assert!(left.cmpge(Rgb::ZERO).all(), "{name} {column}: {left}");
            assert!(left.cmple(value * (1.0 + EQUAL)).all(), "{name} {column}: {left} is left of {value}");
            whole += value * cell.projected_solid_angle;
            rest += left * cell.projected_solid_angle;
            if ahead.contains(&cell.index) {
                straight += value * cell.projected_solid_angle;
            } else {
                assert_eq!(left, value, "{name} {column}: lowered aside of the straight direction");
            }
        }
        let error = (rest + through - whole).abs();
        assert!(error.cmple(EQUAL * whole).all(), "{name} {column}: {rest} + {through} is not {whole}");
        assert!(through.cmpge(Rgb::ZERO).all(), "{name} {column}: {through}");
        assert!(
            through.cmple(straight * (1.0 + EQUAL)).all(),
            "{name} {column}: {through} goes through, {straight} is there"
        );
    }
}

/// Points of a column with their shares of it, over which the mean of the interpolant is exact: it is linear in each coordinate
/// between the middles and the borders of columns.
fn exact_points(columns: &Columns, column: usize) -> Vec<(DVec2, f64)> {
    let halves = [0.25, 0.75];
    let Columns::Patches(basis) = columns else {
        return halves.iter().flat_map(|&u| halves.map(|v| (columns.point(column, [u, v]), 0.25))).collect();
    };
    let ring = basis.rings().iter().rfind(|r| r.first() <= column).unwrap();
    let turns = |step: f64, count: usize| step / count as f64;
    let (begin, end) = {
        let step = (column - ring.first()) as f64;
        (turns(step - 0.5, ring.phi_count), turns(step + 0.5, ring.phi_count))
    };
    let middles = basis.rings().iter().flat_map(|r| {
        let count = r.phi_count as i64;
        (-count..=count).map(move |k| turns(k as f64, r.phi_count))
    });
    let mut bounds: Vec<f64> = middles.filter(|&t| begin < t && t < end).chain([begin, end]).collect();
    bounds.sort_by(f64::total_cmp);
    let pieces = bounds.windows(2).map(|b| (0.5 * (b[0] + b[1]), (b[1] - b[0]) / (end - begin)));
    let at = |turn: f64, u: f64| DVec2::from_angle(2.0 * PI * turn) * ring.sin2(u).sqrt();
    pieces.flat_map(|(turn, share)| halves.map(|u| (at(turn, u), 0.5 * share))).collect()
}

/// The mean of T over each column is the column's; where nothing was found, nothing goes through.
fn check_means(name: &str, d: &Distribution) {
    let (columns, split) = (d.columns(), d.split());
    for (column, peak) in split.columns().enumerate() {
        let points = exact_points(columns, column);
        let values = points.iter().map(|&(p, share)| share * split.through(columns, p));
        let mean: Rgb = values.sum();
        let error = (mean - peak.through).abs();
        assert!(error.cmple(EQUAL * peak.through).all(), "{name} {column}: {mean} for {}", peak.through);
    }
}

fn check(name: &str, d: &Distribution) {
    check_columns(name, d);
    check_means(name, d);
}

/// Hemispherical values as rays see them, on the side that the table serves against its direction too.
fn check_sides(name: &str, bsdf: &Bsdf) {
    for w_in in directions(40, true).into_iter().chain(directions(40, false)) {
        let Some(o) = bsdf.distribution(w_in, Mode::Transmission) else { continue };
        let d = &o.distribution;
        let (a, _) = o.points(-w_in.truncate(), -w_in.truncate());
        if o.reversed && !is_diagonal(d.luminous()) {
            continue; // a column of the other side is no column of the table
        }
        let peak = d.split().column(d.columns().index(a)).unwrap().through;
        let [whole, rest] = [PeakRule::Off, PeakRule::Split]
            .map(|rule| bsdf.hemispherical_smooth(w_in, Mode::Transmission, rule));
        assert!(
            (rest + peak - whole).abs().cmple(EQUAL * whole).all(),
            "{name} {w_in}: {rest} + {peak}, {whole}"
        );
    }
}

/// Is the straight direction in one cell, the same in both directions?
fn is_diagonal(table: &Table) -> bool {
    match table {
        Table::Matrix(m) => m.incident == m.exiting && m.incident.rings()[0].phi_count == 1,
        Table::Tree(t) => t.rank() == 4 && t.values().len() as f64 == t.smallest().powi(-4).round(),
    }
}

fn one_table(d: Arc<Distribution>, front: bool) -> Bsdf {
    let sides = if front {
        Sides { transmission_front: Some(d), ..Sides::default() }
    } else {
        Sides { transmission_back: Some(d), ..Sides::default() }
    };
    Bsdf::from_sides(Document::default(), sides)
}

#[test]
fn fabrics_and_real_files() {
    for (name, bsdf) in fabrics().into_iter().chain(one_sided()).chain(shared_bsdfs()) {
        for w_in in [Vec3::Z, -Vec3::Z] {
            if let Some(o) = bsdf.distribution(w_in, Mode::Transmission) {
                check(&name, &o.distribution);
            }
        }
        check_sides(&name, &bsdf);
    }
}

/// A random table whose directions can be exchanged, and the same product's other side: what comes from `-w_out` and goes to `-w_in`.
/// Values go by numbers of incident and exiting cells, the same division on both sides.
fn reciprocal_pair(content: &Content, basis: Option<Arc<AngleBasis>>) -> [Table; 2] {
    let side = 8;
    let columns = match &basis {
        Some(basis) => Columns::Patches(basis.clone()),
        None => Columns::Square { side },
    };
    let n = columns.len();
    let middle = |cell: usize| columns.point(cell, [0.5, 0.5]);
    let opposite: Vec<usize> = (0..n).map(|cell| columns.index(-middle(cell))).collect();
    let area = |cell: usize| basis.as_ref().map_or(PI / n as f64, |b| b.projected_solid_angle(cell));
    let value = |i: usize, o: usize| {
        let noise = 1.0 + content.noise * (random(content.seed ^ (i.min(o) * n + i.max(o)) as u32) - 0.5);
        let lobe = (-0.5 * (middle(i) - middle(o)).length_squared() / content.sigma.powi(2)).exp();
        let through = if i == o { content.through / area(i) } else { 0.0 };
        ((content.base + content.lobe * lobe) * noise + through) as f32
    };
    let table = |at: &dyn Fn(usize) -> usize| match &basis {
        Some(basis) => {
            let values = (0..n * n).map(|k| value(at(k / n), at(k % n))).collect();
            Table::Matrix(Matrix { incident: basis.clone(), exiting: basis.clone(), values })
        }
        None => Table::Tree(Tree::regular(4, 3, |c| value(at(c[0] * side + c[1]), at(c[2] * side + c[3])))),
    };
    [table(&|cell| cell), table(&|cell| opposite[cell])]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn random_tables(shape in shape(), content in content(), front in any::<bool>()) {
        let d = Arc::new(content.distribution(&shape));
        check("random", &d);
        check_sides("random", &one_table(d, front));
    }

    #[test]
    fn flat_tables_let_nothing_through(shape in shape(), base in 0.0..0.3f64) {
        let d = Content::flat(base).distribution(&shape);
        check("flat", &d);
        prop_assert!(!d.split().has_peak());
    }

    #[test]
    fn all_of_clear_glass_goes_through_and_nothing_is_left(shape in clear_shape(), through in 0.001..1.0f64) {
        let d = Content::clear(through).distribution(&shape);
        check("clear", &d);
        for (column, peak) in d.split().columns().enumerate() {
            prop_assert!((luminance(peak.through) - through).abs() <= EQUAL * through, "{column}: {peak:?}");
            for cell in d.luminous().cells(d.columns(), column) {
                prop_assert_eq!(residual(&d, column, &cell), Rgb::ZERO);
            }
        }
        for i in 0..100 {
            let p = DVec2::from_angle(TAU * random(2 * i)) * random(2 * i + 1).sqrt();
            let got = luminance(d.split().through(d.columns(), p));
            prop_assert!((got - through).abs() <= EQUAL * through, "{p}: {got}");
        }
    }

    #[test]
    fn both_sides_of_a_symmetric_table_let_the_same_through(basis in proptest::option::of(known_basis()), content in content()) {
        let [front, back] = reciprocal_pair(&content, basis);
        let side = |table| Some(Arc::new(Distribution::with_split(table, None)));
        let sides = Sides { transmission_back: side(front), transmission_front: side(back), ..Sides::default() };
        let bsdf = Bsdf::from_sides(Document::default(), sides);
        for w in directions(200, true) {
            let [there, back] = [w, -w].map(|w| luminance(bsdf.through(w, PeakRule::Split)));
            prop_assert!((there - back).abs() <= EQUAL * there, "{w}: {there} {back}");
        }
    }
}

/// Shapes in which a delta has cells of its own, and others beside it.
fn clear_shape() -> impl Strategy<Value = Shape> {
    shape().prop_filter("one basis, more than one cell", |shape| match shape {
        Shape::Matrix(a, b) => a == b,
        Shape::Regular { .. } | Shape::Mixed { .. } => Content::flat(0.1).table(shape).values().len() > 1,
    })
}

#[test]
fn nothing_is_taken_from_fabrics_without_holes() {
    for name in ["klems", "klems-quarter", "t3-256", "t3-1024", "t4-256"] {
        for lobe_share in [0.0, 0.4, 1.0] {
            let fabric = Fabric { openness: 0.0, lobe_share, ..Fabric::default() };
            let bsdf = fabric.tabulate(name.parse().unwrap()).unwrap();
            let o = bsdf.distribution(Vec3::Z, Mode::Transmission).unwrap();
            assert!(!o.distribution.split().has_peak(), "{name} {lobe_share}");
        }
    }
}

#[test]
fn all_of_real_clear_glass_goes_through() {
    for (name, bsdf) in shared_bsdfs().into_iter().filter(|(name, _)| name.starts_with("clear-glass")) {
        for w_in in directions(50, true) {
            let o = bsdf.distribution(w_in, Mode::Transmission).unwrap();
            let (a, _) = o.points(-w_in.truncate(), -w_in.truncate());
            let column = o.distribution.split().column(o.distribution.columns().index(a)).unwrap();
            // One of the files was sampled with rays, of which some strayed to other cells: they are no part of the peak.
            let straight =
                luminance(o.distribution.value(a, a)) * o.distribution.luminous().projected_solid_angle(a, a);
            let whole = luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Off));
            // A narrow lobe that explains them is up to 3.4 times as high in the middle (NARROWEST).
            let (got, strayed) = (luminance(column.through), whole - straight);
            assert!(
                straight - got <= (3.4 * strayed).max(1e-4) && strayed < 0.01,
                "{name} {w_in}: {got} of {straight} of {whole}"
            );
        }
    }
}

#[test]
fn both_sides_of_a_fabric_let_the_same_through() {
    for (name, bsdf) in fabrics() {
        for w_in in directions(50, true) {
            let front = luminance(bsdf.through(w_in, PeakRule::Split));
            let back = luminance(bsdf.through(-w_in, PeakRule::Split));
            assert!((front - back).abs() <= 1e-5 * front, "{name}: {front} {back}");
        }
    }
}
