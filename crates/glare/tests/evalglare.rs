//! Against evalglare 3.06 on pictures of others; skipped where they are missing.
#![allow(clippy::unwrap_used)] // a picture that does not load fails the test

use std::path::PathBuf;
use sunpeak_glare::{GlareOptions, evaluate};
use sunpeak_scene::Picture;

/// A file of the shared material: below `$SUNPEAK_SHARED`, or `shared` beside the checkout.
fn shared(file: &str) -> Option<PathBuf> {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let root = std::env::var_os("SUNPEAK_SHARED").map_or(beside, PathBuf::from);
    let path = root.join("data").join(file);
    if !path.is_file() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    Some(path)
}

/// `evalglare -d`: the file, DGP, Ev [lx], and of each source (worst first) luminance [cd/m²], solid angle [sr], position index.
fn compare(file: &str, dgp: f64, ev_lux: f64, sources: &[[f64; 3]]) {
    let Some(path) = shared(file) else { return };
    let report = evaluate(&Picture::load(&path).unwrap(), &GlareOptions::default()).unwrap();
    assert!((report.dgp - dgp).abs() < 0.002, "{file}: DGP {} instead of {dgp}", report.dgp);
    assert!((report.ev_lux / ev_lux - 1.0).abs() < 1e-3, "{file}: Ev {} instead of {ev_lux}", report.ev_lux);
    assert_eq!(report.sources.len(), sources.len(), "{file}");
    for (found, [luminance, solid_angle, index]) in report.sources.iter().zip(sources) {
        assert!((found.luminance_cd_m2 / luminance - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found.solid_angle_sr / solid_angle - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found.position_index / index - 1.0).abs() < 0.05, "{found:?}");
    }
}

#[test]
fn room_with_a_blind() {
    let sources = [
        [3901.193202, 1.8150347884, 2.545465],
        [2041.712983, 0.0000751695, 4.669596],
        [2034.238854, 0.0000354835, 5.989152],
    ];
    compare("hdr/evalglare-testimage.hdr", 0.530615, 6124.936725, &sources);
}

#[test]
fn sun_spot_through_a_window_with_its_peak_apart() {
    let sources = [[72816.288546, 0.0003590529, 1.251118], [5510.636676, 0.0082526338, 1.255812]];
    compare("hdr/two-exposures.hdr", 0.292288, 494.687158, &sources);
}
