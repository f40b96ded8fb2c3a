//! Product files that others made: light under a uniform sky is the same with and without peak extraction.
//!
//! The files are looked for in `$SUNPEAK_SHARED/data/bsdf`, else beside the repository; without them the test says so and passes.

mod common;

use common::*;
use std::path::PathBuf;
use sunpeak_bsdf::{Bsdf, PeakRule};
use sunpeak_core::{Vec3, luminance};
use sunpeak_render::WorldOptions;

fn product_files() -> Vec<PathBuf> {
    let shared = std::env::var_os("SUNPEAK_SHARED")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    let folder = shared.join("data/bsdf");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no product files in {}", folder.display());
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "xml"));
    files.sort();
    files
}

#[test]
fn a_sky_through_a_product_is_the_same_by_split_and_without() {
    for file in product_files() {
        if Bsdf::load(&file).is_err() {
            println!("{}: does not load, as it should not", file.display());
            continue;
        }
        let text = format!(
            "{UNIFORM_SKY}void aBSDF product 5 {} 0 1 0 . 0 0\nproduct ring pane 0 0 8 0 0 0.01 0 0 1 0 1000\n",
            file.display()
        );
        let sky = |peak| {
            let world = world_with(&text, &WorldOptions { peak, ..Default::default() });
            luminance(irradiance(&world, Vec3::ZERO, Vec3::Z, &samples(1 << 14)))
        };
        let [off, split, radiance] = [PeakRule::Off, PeakRule::Split, PeakRule::Radiance].map(sky);
        println!("{}: {off:.4} off, {split:.4} split, {radiance:.4} radiance", file.display());
        assert!((split / off - 1.0).abs() < 5e-3, "{}: {split} with, {off} without", file.display());
        // By the rules of the reference a sensor finds the sky by the table alone.
        assert!((radiance / off - 1.0).abs() < 5e-3, "{}: {radiance}, {off} without", file.display());
    }
}
