//! The error of the split against a known truth, on fabrics of our own. What holds for every table is in `split_invariants`.
#![allow(clippy::unwrap_used)]

mod common;

use common::halton;
use sunpeak_bsdf::{
    PeakRule,
    synthetic::{Basis, Fabric},
};
use sunpeak_core::{Vec3, luminance};

/// Mean error and misses of T over directions up to 90 % of the cut-off, on fabrics of the design's family.
fn errors(basis: Basis) -> (f64, usize) {
    let (mut sum, mut count, mut missed) = (0.0, 0, 0);
    for k in 0..3 {
        let u = |base| halton(k, base);
        let fabric = Fabric {
            openness: 0.01 + 0.04 * u(2),
            cutoff_deg: 60.0 + 12.0 * u(3),
            exponent: 0.5 + 0.3 * u(5),
            scattered: 0.05 + 0.04 * u(7),
            lobe_share: 0.4,
            lobe_sigma: 0.22 + 0.08 * u(11),
            reflectance: 0.3,
        };
        let bsdf = fabric.tabulate(basis).unwrap();
        for i in 0..200 {
            let largest = (0.9 * fabric.cutoff_deg).to_radians().sin();
            let theta = (halton(i, 2).sqrt() * largest).asin();
            let (sin_phi, cos_phi) = (std::f64::consts::TAU * halton(i, 3)).sin_cos();
            let w_in = Vec3::new(theta.sin() * cos_phi, theta.sin() * sin_phi, theta.cos());
            let got = luminance(bsdf.through(w_in, PeakRule::Split));
            sum += (got / fabric.through(theta) - 1.0).abs();
            count += 1;
            missed += usize::from(got == 0.0);
        }
        let beyond = (fabric.cutoff_deg + 12.0).to_radians();
        let w_in = Vec3::new(beyond.sin(), 0.0, beyond.cos());
        if matches!(basis, Basis::TensorTree3 { .. }) {
            assert_eq!(luminance(bsdf.through(w_in, PeakRule::Split)), 0.0, "a leak past the cut-off");
        }
    }
    (sum / f64::from(count), missed)
}

/// The targets of the design study: mean error of T, no miss.
#[test]
fn through_transmittance_is_close_to_the_closed_form() {
    for (name, limit) in [
        ("t3-16384", 0.0005),
        ("t3-4096", 0.0015),
        ("t3-1024", 0.006),
        ("t4-1024", 0.006),
        ("klems", 0.015),
        ("klems-half", 0.03),
        ("klems-quarter", 0.05),
    ] {
        let (error, missed) = errors(name.parse().unwrap());
        println!("{name}: mean error of T {:.3} %, {missed} missed", 100.0 * error);
        assert!(error < limit && missed == 0, "{name}: {error} {missed}");
    }
}
