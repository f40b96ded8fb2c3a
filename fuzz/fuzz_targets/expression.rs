//! Expression files: definitions, then an expression after the last empty line, compiled and evaluated.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sunpeak_cal::{Definitions, NoInputs};
use sunpeak_core::Location;

fuzz_target!(|data: &[u8]| {
    let text = String::from_utf8_lossy(data);
    let (file, expression) = text.rsplit_once("\n\n").unwrap_or(("", &text));
    let mut definitions = Definitions::new();
    if definitions.load(file.as_bytes(), "fuzz.cal", "fuzz").is_err() {
        return;
    }
    let Ok(expression) = definitions.expression(expression, &Location::default(), "fuzz") else { return };
    if let Ok(program) = definitions.compile(&[expression], &[1.5, -2.0, 0.0]) {
        let _ = program.start(&NoInputs).value(0, &[]);
    }
});
