//! Glare in Radiance pictures, as evalglare lists it.
//!
//! ```sh
//! cargo run --release -p sunpeak-glare --example picture_glare -- room.hdr
//! ```

use std::path::Path;
use sunpeak_core::Result;
use sunpeak_glare::{GlareOptions, evaluate};
use sunpeak_scene::Picture;

fn main() -> Result<()> {
    for file in std::env::args().skip(1) {
        let picture = Picture::load(Path::new(&file))?;
        let report = evaluate(&picture, &GlareOptions::default())?;
        println!(
            "{file}: DGP {:.4} ({}), Ev {:.1} lx; {}",
            report.dgp, report.class, report.ev_lux, report.rule
        );
        for s in &report.sources {
            println!(
                "  {:10.1} cd/m²  {:.6} sr  P {:.3}  {} pixels  towards {:.4}",
                s.luminance_cd_m2, s.solid_angle_sr, s.position_index, s.pixels, s.direction
            );
        }
        for warning in &report.warnings {
            println!("  note: {warning}");
        }
    }
    Ok(())
}
