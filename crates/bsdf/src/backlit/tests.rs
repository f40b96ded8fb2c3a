use crate::{Bsdf, PeakRule, synthetic::Basis, synthetic::Fabric};
use sunpeak_core::{Rgb, Vec3, gray, warp};

/// A field that is brighter to one side, with a horizon.
fn light(direction: Vec3) -> Rgb {
    let sky = if direction.y > 0.0 { 1.0 + direction.y + 0.8 * direction.x } else { 0.3 };
    Rgb::new(sky, 0.8 * sky, 0.5 * sky + 0.1)
}

/// The integral over the other hemisphere by the sum over many points.
fn summed(bsdf: &Bsdf, rule: PeakRule, w_in: Vec3) -> Rgb {
    let n = 512;
    let at = |i: usize| (i as f64 + 0.5) / n as f64;
    let mut sum = Rgb::ZERO;
    for i in 0..n * n {
        let [x, y] = warp::square_to_disk([at(i / n), at(i % n)]);
        let w_out = Vec3::new(x, y, -w_in.z.signum() * (1.0 - x * x - y * y).max(0.0).sqrt());
        sum += bsdf.evaluate_smooth(w_in, w_out, rule) * light(w_out);
    }
    sum * std::f64::consts::PI / (n * n) as f64
}

fn bsdf(basis: Basis) -> Bsdf {
    // Asymmetric: the file has one direction, so the other is traced against the table.
    Fabric { openness: 0.05, scattered: 0.1, ..Fabric::default() }.tabulate(basis).expect("tabulates")
}

#[test]
fn radiance_is_the_integral_over_the_light() {
    let bases = [
        (Basis::KlemsFull, 3e-3),
        (Basis::TensorTree4 { side: 16 }, 2e-3),
        (Basis::TensorTree3 { side: 32 }, 6e-3),
    ];
    for (basis, tolerance) in bases {
        let bsdf = bsdf(basis);
        for rule in [PeakRule::Split, PeakRule::Off] {
            for side in [1.0, -1.0] {
                let backlit = bsdf.backlit(side > 0.0, rule, light).expect("something comes through");
                for at in [Vec3::new(0.1, 0.05, 0.9), Vec3::new(-0.5, 0.3, 0.7), Vec3::new(0.2, -0.8, 0.3)] {
                    let w_in = Vec3::new(at.x, at.y, side * at.z).normalize();
                    let (ours, truth) = (backlit.radiance(w_in), summed(&bsdf, rule, w_in));
                    let error = ((ours - truth) / truth).abs().max_element();
                    assert!(error < tolerance, "{basis:?} {rule:?} {w_in}: {ours} {truth}");
                }
            }
        }
    }
}

/// A tree of 128 cells a side has a peak in one cell, far smaller than the bins: its flux is all there.
#[test]
fn no_flux_of_a_fine_tree_is_lost() {
    let bsdf = bsdf(Basis::TensorTree3 { side: 128 });
    for side in [1.0, -1.0] {
        let backlit =
            bsdf.backlit(side > 0.0, PeakRule::Off, |_| gray(1.0)).expect("something comes through");
        for sine in [0.05, 0.3, 0.6, 0.8] {
            let w_in = Vec3::new(0.6 * sine, 0.8 * sine, side * (1.0 - sine * sine).sqrt());
            let truth = bsdf.hemispherical_smooth(w_in, crate::Mode::Transmission, PeakRule::Off);
            let error = (backlit.radiance(w_in) / truth - Rgb::ONE).abs().max_element();
            assert!(error < if side > 0.0 { 4e-3 } else { 3e-2 }, "{side} {sine}: {error}");
        }
    }
}

#[test]
fn a_uniform_field_gives_the_hemispherical_transmittance() {
    for basis in [Basis::KlemsFull, Basis::TensorTree4 { side: 16 }, Basis::TensorTree3 { side: 32 }] {
        let bsdf = bsdf(basis);
        let backlit = bsdf.backlit(true, PeakRule::Split, |_| gray(2.0)).expect("something comes through");
        let w_in = Vec3::new(0.3, -0.4, 0.8).normalize();
        let truth = 2.0 * bsdf.hemispherical_smooth(w_in, crate::Mode::Transmission, PeakRule::Split);
        assert!((backlit.radiance(w_in) / truth - Rgb::ONE).abs().max_element() < 4e-3, "{basis:?}");
    }
}
