//! Scene files: reading ends with a scene or a message, and the check of all mistakes finds one exactly where reading does.
#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use sunpeak_scene::{LoadOptions, Scene, Source};

/// Counts up to this keep an input within the memory and time of a fuzzer; larger ones are the business of limits that tests try.
const LONGEST_NUMBER: usize = 3;

fuzz_target!(|data: &[u8]| -> Corpus {
    let has_large_counts = data
        .split(|byte| !byte.is_ascii_digit())
        .any(|digits| digits.len() > LONGEST_NUMBER);
    if data.contains(&b'!') && has_large_counts {
        return Corpus::Reject;
    }
    let text = String::from_utf8_lossy(data);
    let options = LoadOptions { cwd: Some("fuzz/none".into()), ..LoadOptions::default() };
    let read = Scene::parse(&text, "fuzz.rad", &options);
    let source = Source::Text {
        name: "fuzz.rad".into(),
        text: text.as_bytes().to_vec(),
        directory: "fuzz/none".into(),
    };
    let check = Scene::check(&[source], &options);
    assert_eq!(read.is_ok(), check.errors.is_empty(), "{:?} {:?}", read.err(), check.errors);
    Corpus::Keep
});
