//! BSDF files: what is read has finite values.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sunpeak_bsdf::{Bsdf, PeakRule};
use sunpeak_core::Vec3;

fuzz_target!(|data: &[u8]| {
    let Ok(bsdf) = Bsdf::parse("fuzz.xml", data) else { return };
    for w_in in [Vec3::Z, Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.0, 0.96, 0.28)] {
        assert!(bsdf.evaluate(w_in, -w_in).is_finite());
        assert!(bsdf.through(w_in, PeakRule::Split).is_finite());
    }
});
