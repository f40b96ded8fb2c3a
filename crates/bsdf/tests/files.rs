//! Reading and writing files: real ones, our own, and broken ones.
#![allow(clippy::unwrap_used)]

mod common;

use common::{directions, fabrics, shared_files};
use proptest::prelude::*;
use sunpeak_bsdf::Bsdf;

#[test]
fn every_real_file_loads_or_says_what_is_wrong() {
    for file in shared_files() {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        match (Bsdf::load(&file), name.as_str()) {
            (Ok(_), "short-matrix_must-be-refused.xml" | "not-xml.xml") => panic!("{name} must be refused"),
            (Err(e), "short-matrix_must-be-refused.xml") => {
                assert!(e.to_string().contains("4 values; expected 145 x 145"), "{e}")
            }
            (Err(e), "not-xml.xml") => assert!(e.to_string().contains("not a BSDF file"), "{e}"),
            (Ok(_), _) => {}
            (Err(e), _) => panic!("{e}"),
        }
    }
}

#[test]
fn a_written_file_reads_back_the_same() {
    for (name, bsdf) in fabrics() {
        let back = Bsdf::parse("back.xml", bsdf.to_xml().as_bytes()).unwrap();
        for w_in in directions(40, true).into_iter().chain(directions(40, false)) {
            for w_out in directions(40, true).into_iter().chain(directions(40, false)) {
                assert_eq!(bsdf.evaluate(w_in, w_out), back.evaluate(w_in, w_out), "{name}");
            }
        }
    }
}

fn small() -> String {
    static TEXT: std::sync::LazyLock<String> = std::sync::LazyLock::new(|| {
        let fabric = sunpeak_bsdf::synthetic::Fabric::default();
        fabric.tabulate("t3-64".parse().unwrap()).unwrap().to_xml()
    });
    TEXT.clone()
}

fn message(text: &str) -> String {
    Bsdf::parse("x.xml", text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn broken_files_say_where_and_what() {
    let good = small();
    for share in [3, 5, 7] {
        let cut = message(&good[..good.len() * share / 10]);
        assert!(cut.starts_with("x.xml:") && cut.contains("complete"), "{cut}");
    }
    let nan = good.replacen("<ScatteringData>\n{", "<ScatteringData>\n{ nan", 1);
    assert!(message(&nan).contains("nan"), "{}", message(&nan));
    let negative = good.replacen("{0e0}", "{-1e0}", 1);
    assert!(message(&negative).contains("not negative"), "{}", message(&negative));
    let few = good.replacen("{0e0}\n", "", 1);
    assert!(message(&few).contains("expected"), "{}", message(&few));
    let basis = good.replace("LBNL/Shirley-Chiu", "LBNL/Other");
    assert!(message(&basis).contains("LBNL/Other"), "{}", message(&basis));
    let structure = good.replace("TensorTree3", "TensorTree9");
    assert!(message(&structure).contains("TensorTree9"), "{}", message(&structure));
    let entities = good.replacen("<WindowElement ", "<!DOCTYPE x [<!ENTITY a \"b\">]><WindowElement ", 1);
    assert!(message(&entities).contains("document type"), "{}", message(&entities));
    let braces = good.replacen("<ScatteringData>", &format!("<ScatteringData>{}", "{".repeat(100_000)), 1);
    assert!(message(&braces).contains("levels deep"), "{}", message(&braces));
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(at in 0usize..20_000, cut in 0usize..400, bytes in proptest::collection::vec(any::<u8>(), 0..20)) {
        let mut text = small().into_bytes();
        let at = at.min(text.len());
        let end = (at + cut).min(text.len());
        text.splice(at..end, bytes);
        let _ = Bsdf::parse("x.xml", &text);
    }
}
