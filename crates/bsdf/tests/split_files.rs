//! The split as files: written, read back, and the same; the residual stands on its own; what is broken is refused.
#![allow(clippy::unwrap_used)]

mod common;

use common::{directions, fabrics, random, shared_bsdfs};
use proptest::prelude::*;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};
use sunpeak_bsdf::{
    Bsdf, Distribution, Mode, PeakRule, Sides,
    basis::AngleBasis,
    synthetic::Fabric,
    table::{Matrix, Table},
    tree::TreeBuilder,
    xml::Document,
};
use sunpeak_core::{Rgb, Vec3, luminance};

/// A folder that is gone when the test is over.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sunpeak-split-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn round_trip(name: &str, bsdf: &Bsdf) -> Bsdf {
    let folder = Folder::new(name);
    bsdf.save_split(&folder.0).unwrap();
    Bsdf::load(&folder.0).unwrap()
}

fn of_transmission(structure: &str, distribution: Distribution) -> Bsdf {
    let document = Document { name: "made".into(), structure: structure.into(), ..Document::default() };
    let sides = Sides { transmission_front: Some(Arc::new(distribution)), ..Sides::default() };
    Bsdf::from_sides(document, sides)
}

fn close(a: Rgb, b: Rgb, relative: f64) -> bool {
    (a - b).abs().max_element() <= relative * a.abs().max_element().max(b.abs().max_element())
}

/// Every value of every column, in the table and in the residual; `tolerance` 0 where nothing may be lost.
fn check_same(name: &str, a: &Bsdf, b: &Bsdf, tolerance: f64) {
    assert_eq!((&a.name, &a.manufacturer, &a.structure), (&b.name, &b.manufacturer, &b.structure));
    for (w_in, mode) in [Vec3::Z, -Vec3::Z]
        .into_iter()
        .flat_map(|w| [Mode::Transmission, Mode::Reflection].map(|mode| (w, mode)))
    {
        let (one, two) = match (a.distribution(w_in, mode), b.distribution(w_in, mode)) {
            (None, None) => continue,
            (one, two) => (one.unwrap(), two.unwrap()),
        };
        assert_eq!(one.reversed, two.reversed, "{name}");
        let (one, two) = (&one.distribution, &two.distribution);
        assert_eq!(one.columns(), two.columns(), "{name}");
        assert_eq!(one.color().is_some(), two.color().is_some(), "{name}");
        for column in 0..one.columns().len() {
            let cells = one.luminous().cells(one.columns(), column);
            let theirs = two.luminous().cells(two.columns(), column);
            assert_eq!(cells.len(), theirs.len(), "{name} {column}");
            for (cell, other) in cells.iter().zip(&theirs) {
                assert_eq!(cell.square(), other.square(), "{name} {column}");
                let (f, g) = (one.at_index(cell.index), two.at_index(other.index));
                assert!(close(f, g, tolerance), "{name} {mode:?} {column} {cell:?}: {f} {g}");
                let rest = |d: &Distribution, i| d.split().surround(column, i).unwrap_or(d.at_index(i));
                let (f, g) = (rest(one, cell.index), rest(two, other.index));
                assert!(close(f, g, tolerance), "{name} residual {column} {cell:?}: {f} {g}");
            }
        }
        assert!(one.split().columns().eq(two.split().columns()), "{name}");
    }
    for w in directions(200, true).into_iter().chain(directions(200, false)) {
        assert_eq!(a.through(w, PeakRule::Split), b.through(w, PeakRule::Split), "{name} {w}");
        let (r, s) = (a.through(w, PeakRule::Radiance), b.through(w, PeakRule::Radiance));
        assert!(close(r, s, tolerance.max(1e-12)), "{name} {w}: {r} {s}");
    }
}

#[test]
fn files_read_back_are_the_same_bsdf() {
    for (name, bsdf) in fabrics().into_iter().chain(shared_bsdfs()) {
        let colored =
            bsdf.distribution(Vec3::Z, Mode::Transmission).is_some_and(|o| o.distribution.color().is_some());
        check_same(&name, &bsdf, &round_trip(&name, &bsdf), if colored { 2e-6 } else { 0.0 });
    }
}

/// The residual's own file: what it holds is what the split left, whatever is read into it.
#[test]
fn the_residual_is_a_file_of_its_own() {
    for (name, bsdf) in fabrics().into_iter().chain(shared_bsdfs()) {
        let files = bsdf.split_files().unwrap();
        let residual = Bsdf::parse("residual.xml", files.residual_xml.as_bytes()).unwrap();
        for w_in in directions(60, true).into_iter().chain(directions(60, false)) {
            let Some(o) = bsdf.distribution(w_in, Mode::Transmission) else { continue };
            let truth = luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Split));
            let got = luminance(residual.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Off));
            // A residual of less than 0.1 % counts as none (as in Radiance); against trees sums are approximate.
            let limit = if o.reversed { 2e-2 } else { 2e-6 };
            assert!(
                (got - truth).abs() <= (limit * truth).max(1e-3 * f64::from(truth < 1e-3)),
                "{name} {w_in}: {got} {truth}"
            );
        }
    }
}

#[test]
fn the_ledger_balances() {
    for (name, bsdf) in fabrics().into_iter().chain(shared_bsdfs()) {
        let files = bsdf.split_files().unwrap();
        let mut lines = files.ledger_csv.lines();
        let head: Vec<&str> = lines.next().unwrap().split(',').collect();
        let at = |column: &str| head.iter().position(|h| *h == column).unwrap();
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |column: &str| cells[at(column)].parse::<f64>().unwrap();
            let (table, rest) = (number("table"), number("residual") + number("through"));
            assert!((table - rest - number("error")).abs() < 1e-12, "{name}: {line}");
            assert!(number("error").abs() <= 2e-6 * table, "{name}: {line}");
        }
        let columns: usize = [true, false].iter().map(|&f| bsdf.incident_columns(f).len()).sum();
        assert!(files.ledger_csv.lines().count() <= columns + 1, "{name}");
        assert_eq!(files.peak_csv.lines().count(), files.ledger_csv.lines().count(), "{name}");
    }
}

#[test]
fn files_by_rows_come_back() {
    let xml = quarter().to_xml().replace(">Columns<", ">Rows<");
    let by_rows = Bsdf::parse("rows.xml", xml.as_bytes()).unwrap();
    let back = round_trip("rows", &by_rows);
    assert_eq!((by_rows.structure.as_str(), back.structure.as_str()), ("Rows", "Columns"));
    for w_in in directions(50, true) {
        for w_out in directions(50, false) {
            assert_eq!(by_rows.evaluate(w_in, w_out), back.evaluate(w_in, w_out));
        }
    }
}

#[test]
fn a_product_that_only_reflects_has_a_split_too() {
    let basis = Arc::new(AngleBasis::known("LBNL/Klems Quarter").unwrap());
    let values = vec![0.1; basis.len() * basis.len()];
    let table = Table::Matrix(Matrix { incident: basis.clone(), exiting: basis, values });
    let sides =
        Sides { reflection_front: Some(Arc::new(Distribution::new(table, None))), ..Sides::default() };
    let bsdf = Bsdf::from_sides(Document { structure: "Columns".into(), ..Document::default() }, sides);
    check_same("mirror", &bsdf, &round_trip("mirror", &bsdf), 0.0);
}

/// A table with colour: a random tint on each cell.
fn tinted(bsdf: &Bsdf) -> Bsdf {
    let o = bsdf.distribution(-Vec3::Z, Mode::Transmission).unwrap();
    let table = o.distribution.luminous().clone();
    let channel = |seed: u32| -> Vec<f32> {
        let values = table.values().iter().enumerate();
        values.map(|(i, y)| y * (0.8 + 0.4 * random(2 * i as u32 + seed) as f32)).collect()
    };
    let color = Some([channel(0), channel(1)]);
    of_transmission(&bsdf.structure, Distribution::with_split(table, color))
}

#[test]
fn colour_comes_back() {
    for (name, bsdf) in fabrics() {
        let tinted = tinted(&bsdf);
        let o = tinted.distribution(-Vec3::Z, Mode::Transmission).unwrap();
        assert!(o.distribution.split().has_peak(), "{name}");
        check_same(&name, &tinted, &round_trip(&format!("tinted-{name}"), &tinted), 3e-6);
        // The plain writer has colour too.
        let back = Bsdf::parse("tinted.xml", tinted.to_xml().as_bytes()).unwrap();
        for w_in in directions(30, false) {
            for w_out in directions(30, true) {
                let (f, g) = (tinted.evaluate(w_in, w_out), back.evaluate(w_in, w_out));
                assert!(close(f, g, 3e-6), "{name}: {f} {g}");
            }
        }
    }
}

/// A tree as it stands in a file.
#[derive(Clone, Debug)]
enum Nested {
    Branch(Vec<Nested>),
    Grid(Vec<f32>),
}

fn feed(builder: &mut TreeBuilder, node: &Nested) {
    builder.open().unwrap();
    match node {
        Nested::Branch(children) => children.iter().for_each(|c| feed(builder, c)),
        Nested::Grid(values) => values.iter().for_each(|&v| builder.value(v).unwrap()),
    }
    builder.close().unwrap();
}

/// Trees of random shape with a few bright cells: leaves of all sizes, over many columns.
fn nested(rank: usize) -> impl Strategy<Value = Nested> {
    let value = prop_oneof![3 => 0.0f32..0.3, 1 => 5.0f32..60.0];
    let grid = (0u8..2).prop_flat_map(move |log2| {
        proptest::collection::vec(value.clone(), 1 << (rank * usize::from(log2))).prop_map(Nested::Grid)
    });
    grid.prop_recursive(3, 128, 16, move |inner| {
        proptest::collection::vec(inner, 1 << rank).prop_map(Nested::Branch)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn trees_of_any_shape_come_back(three in nested(3), four in nested(4)) {
        for (rank, root) in [(3, three), (4, four)] {
            let mut builder = TreeBuilder::new(rank, 1 << 20);
            feed(&mut builder, &root);
            let table = Table::Tree(builder.finish().unwrap());
            let bsdf = of_transmission(&format!("TensorTree{rank}"), Distribution::with_split(table, None));
            let files = bsdf.split_files().unwrap();
            let residual = Bsdf::parse("residual.xml", files.residual_xml.as_bytes()).unwrap();
            for w_in in directions(40, false) {
                for w_out in directions(40, true) {
                    let truth = bsdf.evaluate_smooth(w_in, w_out, PeakRule::Split);
                    let got = residual.evaluate(w_in, w_out);
                    prop_assert!(got == truth || residual.distribution(w_in, Mode::Transmission).is_none(), "{got} {truth}");
                }
            }
            check_same("random", &bsdf, &round_trip(&format!("random-{rank}"), &bsdf), 0.0);
        }
    }
}

fn quarter() -> Bsdf {
    Fabric::default().tabulate("klems-quarter".parse().unwrap()).unwrap()
}

/// What the reader says of a folder in which a text was replaced.
fn message(file: &str, from: &str, to: &str) -> String {
    let folder = Folder::new(&format!("broken-{}", from.len() * 1000 + to.len()));
    quarter().save_split(&folder.0).unwrap();
    let path = folder.0.join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{from}");
    std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
    Bsdf::load(&folder.0).unwrap_err().to_string()
}

#[test]
fn broken_splits_say_where_and_what() {
    for (from, to, expected) in [
        ("\"version\": 1", "\"version\": 9", "version 9; expected"),
        ("\"format\": \"sunpeak-split\"", "\"format\": \"other\"", "expected 'sunpeak-split'"),
        ("\"residual\": \"residual.xml\"", "\"residual\": \"../residual.xml\"", "a file beside"),
        ("\"residual\": \"residual.xml\"", "\"residual\": \"gone.xml\"", "gone.xml"),
        ("\"count\": 41", "\"count\": 42", "expected Patches { count: 42 }"),
        ("\"column\": 1,", "\"column\": 7,", "column 1: its number is 7"),
        ("\"patch\": 3", "\"patch\": 99", "patch from 0 to 40"),
        ("\"sides\": [", "\"sides\": [ {", "not a split of Sunpeak"),
    ] {
        let said = message("peak.json", from, to);
        assert!(said.contains(expected), "{from}: {said}");
        assert!(said.contains("peak.json") || said.contains("gone.xml"), "{said}");
    }
    let said = message("residual.xml", "<ScatteringData>\n", "<ScatteringData>\n ");
    assert!(said.contains("checksum"), "{said}");
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn files_are_written_whole_or_not_at_all() {
    let bsdf = quarter();
    let outer = Folder::new("outer");
    assert!(bsdf.save_split(&outer.0.join("inner")).is_err(), "no such folder");
    assert!(!outer.0.exists());
    std::fs::create_dir(&outer.0).unwrap();
    let inner = outer.0.join("inner");
    let complete = ["ledger.csv", "peak.csv", "peak.json", "residual.xml"];
    for _ in 0..2 {
        bsdf.save_split(&inner).unwrap(); // the second time over the first
        assert_eq!(names(&inner), complete);
        assert_eq!(names(&outer.0), ["inner"]);
    }
    // A folder where the residual should go: nothing is left behind, the other files stay as they were.
    std::fs::remove_file(inner.join("residual.xml")).unwrap();
    std::fs::create_dir_all(inner.join("residual.xml/full")).unwrap();
    std::fs::write(inner.join("peak.json"), "mine").unwrap();
    assert!(bsdf.save_split(&inner).is_err());
    assert_eq!(names(&inner), complete);
    assert_eq!(std::fs::read_to_string(inner.join("peak.json")).unwrap(), "mine");
    let file = outer.0.join("file");
    std::fs::write(&file, "mine").unwrap();
    assert!(bsdf.save_split(&file).is_err());
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine");
}
