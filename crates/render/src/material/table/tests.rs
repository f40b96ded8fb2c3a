use super::*;
use crate::testing::{chi_square_of_sampler, hemispherical_sum};
use sunpeak_bsdf::synthetic::{Basis, Fabric};
use sunpeak_core::{Sampler, gray};

/// A fabric that reflects much and transmits little, with diffuse lobes beside the table.
fn table(rule: PeakRule, diffuse: f64) -> Table {
    let fabric = Fabric { reflectance: 0.6, scattered: 0.05, ..Fabric::default() };
    Table {
        bsdf: Arc::new(fabric.tabulate(Basis::KlemsFull).expect("tabulates")),
        is_aperture: true,
        thickness: Thickness::Fixed(0.0),
        rule,
        up: Orientation::Fixed(Vec3::Y),
        mirrored: false,
        front_diffuse: gray(diffuse),
        back_diffuse: gray(0.5 * diffuse),
        diffuse_transmission: gray(diffuse),
    }
}

fn arrival(direction: Vec3) -> Arrival {
    Arrival::new(Vec3::ZERO, Vec3::Z, direction.normalize())
}

const DIRECTIONS: [Vec3; 3] = [Vec3::NEG_Z, Vec3::new(0.6, 0.2, 0.5), Vec3::new(-0.9, 0.3, -0.4)];

#[test]
fn samples_follow_the_density() {
    for (rule, diffuse) in [(PeakRule::Split, 0.1), (PeakRule::Off, 0.0)] {
        let table = table(rule, diffuse);
        for direction in DIRECTIONS {
            let Smooth::Table(lobes) = table.scatter(&arrival(direction), false).smooth else {
                panic!("smooth")
            };
            // The third number of a draw is taken from the digits of the first that the choice left over.
            let sample = |choice: f64, u: [f64; 2]| {
                let rest = (choice * 1e6).fract();
                lobes.sample(choice, u, rest).map(|s| s.direction)
            };
            // Where nothing is scattered no sample is given out, though its density is not zero.
            let pdf = |d: Vec3| if lobes.evaluate(d).total() == Rgb::ZERO { 0.0 } else { lobes.pdf(d) };
            chi_square_of_sampler(&format!("{rule:?} {direction}"), sample, pdf);
        }
    }
}

#[test]
fn weights_times_density_are_the_value() {
    for rule in [PeakRule::Split, PeakRule::Off, PeakRule::Radiance] {
        let table = table(rule, 0.1);
        for direction in DIRECTIONS {
            let Smooth::Table(lobes) = table.scatter(&arrival(direction), false).smooth else {
                panic!("smooth")
            };
            let expected = hemispherical_sum(|d| lobes.evaluate(d).total());
            let n = 1 << 14;
            let mut mean = Rgb::ZERO;
            let mut transmitted = 0.0;
            for i in 0..n {
                let mut s = Sampler::new(3, 1, i);
                if let Some(sample) = lobes.sample(s.next_1d(), s.next_2d(), s.next_1d()) {
                    mean += sample.weight.total() / n as f64;
                    transmitted += f64::from(u8::from(sample.direction.z * direction.z > 0.0)) / n as f64;
                }
            }
            assert!((mean / expected - Rgb::ONE).abs().max_element() < 0.01, "{rule:?}: {mean} {expected}");
            assert!(transmitted > 0.3, "{transmitted}");
        }
    }
}

#[test]
fn a_mirrored_instance_has_a_left_handed_frame() {
    let plain = table(PeakRule::Split, 0.0);
    let mirrored = Table { mirrored: true, ..plain.clone() };
    let from_above = arrival(Vec3::NEG_Z);
    let (a, b) = (plain.frame(&from_above), mirrored.frame(&from_above));
    assert_eq!((a.x, a.y, a.z), (Vec3::X, Vec3::Y, Vec3::Z));
    assert_eq!((b.x, b.y, b.z), (Vec3::NEG_X, Vec3::Y, Vec3::Z));
}
