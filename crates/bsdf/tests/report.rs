//! The report against closed forms of fabrics, and of tables that break a law on purpose.
#![allow(clippy::unwrap_used)]

mod common;

use common::shared_bsdfs;
use std::{f64::consts::PI, sync::Arc};
use sunpeak_bsdf::{
    Bsdf, Distribution, Mode, Sides,
    basis::AngleBasis,
    report::{Compared, HEMISPHERICAL_THETA_DEG, Report},
    synthetic::Fabric,
    table::{Matrix, Table},
    xml::Document,
};

const BASES: [&str; 6] = ["klems", "klems-half", "klems-quarter", "t3-1024", "t3-4096", "t4-1024"];

fn report(fabric: &Fabric, basis: &str) -> Report {
    fabric.tabulate(basis.parse().unwrap()).unwrap().report()
}

/// Mean of T over the hemisphere under diffuse light: the integral of T(theta) 2 sin(theta) cos(theta).
fn diffuse_through(fabric: &Fabric) -> f64 {
    let n = 100_000;
    let step = 0.5 * PI / f64::from(n);
    (0..n).map(|i| (f64::from(i) + 0.5) * step).map(|t| fabric.through(t) * (2.0 * t).sin() * step).sum()
}

#[test]
fn a_fabric_is_reported_as_it_was_made() {
    let fabric = Fabric::default();
    for basis in BASES {
        let report = report(&fabric, basis);
        assert_eq!(report.peaks.len(), 2, "{basis}");
        for peak in &report.peaks {
            let klems = basis.starts_with("klems");
            // Openness: the target of the basis.
            let limit = if klems { 0.05 } else { 0.006 };
            assert!((peak.openness / fabric.openness - 1.0).abs() < limit, "{basis}: {}", peak.openness);
            let [low, high] = peak.openness_interval;
            assert!(low <= fabric.openness && fabric.openness <= high, "{basis}: {low} {high}");
            // Incidences within the cut-off, to a column on either side of it.
            let share = fabric.cutoff_deg.to_radians().sin().powi(2);
            let limit = if klems { 0.15 } else { 0.07 };
            assert!(
                (peak.share_of_incidences - share).abs() < limit,
                "{basis}: {}",
                peak.share_of_incidences
            );
            // Flux under diffuse light: scattered is the same for all incidences.
            let through = diffuse_through(&fabric);
            let truth = through / (through + fabric.scattered);
            let limit = if klems { 0.05 } else { 0.01 };
            let got = peak.extracted_share_diffuse;
            assert!((got / truth - 1.0).abs() < limit, "{basis}: {got} {truth}");
            let truth = fabric.openness / (fabric.openness + fabric.scattered);
            let limit = if klems { 0.06 } else { 0.01 };
            assert!((peak.extracted_share_normal / truth - 1.0).abs() < limit, "{basis}");
            let [first, last] = peak.taken_between_deg.unwrap();
            // To the border of the column that straddles the cut-off.
            let border = if basis == "klems" {
                75.0
            } else if klems {
                90.0
            } else {
                fabric.cutoff_deg + 6.0
            };
            assert!(
                first == 0.0 && last > fabric.cutoff_deg - 6.0 && last <= border,
                "{basis}: {first} {last}"
            );
            assert_eq!(peak.share_between, 1.0, "{basis}");
            let contrast = peak.contrast.unwrap();
            assert!(contrast.min > 0.0 && contrast.median >= contrast.min, "{basis}");
        }
        let [front, back] = [&report.peaks[0], &report.peaks[1]];
        assert!((front.openness - back.openness).abs() < 1e-9);
    }
}

#[test]
fn hemispherical_values_are_those_of_the_fabric() {
    let fabric = Fabric::default();
    let report = report(&fabric, "t3-4096");
    for side in &report.sides {
        for (angle, theta) in side.angles.iter().zip(HEMISPHERICAL_THETA_DEG) {
            let truth = fabric.through(theta.to_radians()) + fabric.scattered;
            assert!((angle.transmittance.mean - truth).abs() < 0.02 * truth, "{theta}: {angle:?} {truth}");
            assert!((angle.reflectance.mean - fabric.reflectance).abs() < 1e-5, "{theta}: {angle:?}");
            assert!(angle.transmittance.max - angle.transmittance.min < 1e-9, "isotropic");
        }
        let truth = fabric.openness + fabric.scattered + fabric.reflectance;
        assert!((side.largest_sum - truth).abs() < 1e-3, "{}", side.largest_sum);
        assert_eq!(side.share_above_one, 0.0);
    }
}

#[test]
fn through_is_given_by_direction_with_its_interval() {
    let fabric = Fabric::default();
    for (basis, azimuths) in [("t3-4096", 1), ("t4-1024", 8)] {
        let peak = &report(&fabric, basis).peaks[0];
        assert_eq!(peak.through.len(), 18 * azimuths);
        let (mut held, mut rows) = (0, 0);
        for row in peak.through.iter().filter(|r| r.theta_deg < 0.8 * fabric.cutoff_deg) {
            let truth = fabric.through(row.theta_deg.to_radians());
            assert!((row.through / truth - 1.0).abs() < 0.05, "{basis}: {row:?} {truth}");
            assert!(row.interval[0] <= row.through && row.through <= row.interval[1], "{basis}: {row:?}");
            rows += 1;
            held += u32::from(row.interval[0] <= truth && truth <= row.interval[1]);
        }
        assert!(held * 10 >= rows * 9, "{basis}: {held} of {rows} intervals hold the truth");
    }
}

#[test]
fn the_narrowest_lobe_is_two_cells_wide() {
    for (basis, cell_rad) in [
        ("t3-4096", PI.sqrt() / 64.0),
        ("t4-1024", PI.sqrt() / 32.0),
        ("klems", PI.sqrt() * 5.0_f64.to_radians().sin()),
    ] {
        let report = report(&Fabric::default(), basis);
        let got = report.peaks[0].narrowest_lobe_deg;
        assert!((got - 2.0 * cell_rad.to_degrees()).abs() < 2e-3 * got, "{basis}: {got}");
        let smallest = report.tables[0].smallest_cell_deg;
        assert!(smallest <= 1.01 * cell_rad.to_degrees(), "{basis}: {smallest}");
    }
}

#[test]
fn a_diffuser_has_no_peak_to_report() {
    let fabric = Fabric { openness: 0.0, lobe_share: 0.0, ..Fabric::default() };
    let report = report(&fabric, "klems");
    let peak = &report.peaks[0];
    assert_eq!((peak.columns_with_peak, peak.share_of_incidences, peak.openness), (0, 0.0, 0.0));
    assert_eq!((peak.contrast, peak.taken_between_deg, peak.extracted_share_diffuse), (None, None, 0.0));
    assert!(peak.openness_interval[1] > 0.0 && peak.openness_interval[1] < 0.01);
    for check in &report.reciprocity {
        assert!(check.largest_difference < 1e-5, "{check:?}");
    }
}

/// A Lambertian matrix of reflection whose values are changed for one pair of patches.
fn reflecting(change: impl Fn(&mut [f32])) -> Bsdf {
    let basis = Arc::new(AngleBasis::known("LBNL/Klems Full").unwrap());
    let mut values = vec![(0.5 / PI) as f32; basis.len() * basis.len()];
    change(&mut values);
    let table = Table::Matrix(Matrix { incident: basis.clone(), exiting: basis, values });
    let sides = Sides { reflection_back: Some(Arc::new(Distribution::new(table, None))), ..Sides::default() };
    Bsdf::from_sides(Document { structure: "Columns".into(), ..Document::default() }, sides)
}

#[test]
fn broken_reciprocity_is_found_where_it_is() {
    // Light from patch 10 to patch 60 three times as bright as it should be.
    let bsdf = reflecting(|values| values[10 * 145 + 60] *= 3.0);
    let report = bsdf.report();
    let check = report.reciprocity.iter().find(|c| c.compared == Compared::ReflectionFront).unwrap();
    assert!((check.largest_difference - 2.0 / 3.0).abs() < 1e-6, "{check:?}");
    let basis = AngleBasis::known("LBNL/Klems Full").unwrap();
    let thetas = [check.largest_at_deg[0], check.largest_at_deg[2]];
    let ring = |patch: usize| basis.ring_of(patch).0.clone();
    let within = |t: f64, patch: usize| ring(patch).lower_theta_deg <= t && t <= ring(patch).upper_theta_deg;
    assert!(
        (within(thetas[0], 10) && within(thetas[1], 60)) || (within(thetas[0], 60) && within(thetas[1], 10)),
        "{check:?}"
    );
    // One pair of patches, each way, differs by twice the value.
    let area = |p| basis.projected_solid_angle(p);
    let truth = 2.0 * 2.0 * area(10) * area(60) / (PI * PI);
    assert!((check.mean_difference - truth).abs() < 1e-2 * truth, "{} {truth}", check.mean_difference);
    assert_eq!(report.peaks.len(), 0);
}

#[test]
fn too_much_light_is_found_where_it_is() {
    let bsdf = reflecting(|values| values[7 * 145..8 * 145].iter_mut().for_each(|v| *v *= 2.4));
    let side = &bsdf.report().sides[0];
    assert!((side.largest_sum - 1.2).abs() < 1e-4, "{}", side.largest_sum);
    assert!(
        (side.share_above_one * PI - AngleBasis::known("LBNL/Klems Full").unwrap().projected_solid_angle(7))
            .abs()
            < 1e-9
    );
    assert!((side.largest_sum_at_deg[0] - 10.0).abs() < 1.0, "{:?}", side.largest_sum_at_deg);
    let back = &bsdf.report().sides[1];
    assert_eq!(back.largest_sum, 0.0);
}

#[test]
fn every_real_file_is_reported() {
    for (name, bsdf) in shared_bsdfs() {
        let report = bsdf.report();
        for mode in [Mode::Transmission, Mode::Reflection] {
            let tables = report.tables.iter().filter(|t| t.mode == mode).count();
            assert!(tables <= 2, "{name}");
        }
        for peak in &report.peaks {
            assert!((0.0..=1.0 + 1e-9).contains(&peak.share_of_incidences), "{name}");
            assert!((0.0..=1.0 + 1e-3).contains(&peak.extracted_share_diffuse), "{name}");
        }
        for check in &report.reciprocity {
            assert!((0.0..=1.0).contains(&check.largest_difference), "{name}: {check:?}");
            let here = [check.mean_difference, check.largest_difference].map(|v| 100.0 * v);
            println!("{name} {:?}: mean {:.2} %, largest {:.1} %", check.compared, here[0], here[1]);
        }
        for side in &report.sides {
            println!("{name}: R + T up to {:.4} at {:?}", side.largest_sum, side.largest_sum_at_deg);
        }
        for p in &report.peaks {
            println!(
                "{name}: fires {:.3} of incidences, T(0) {:.4} {:?}, extracted {:.3}, contrast {:?}, lobe {:.1} deg, {:?} gaps {:.3}",
                p.share_of_incidences,
                p.openness,
                p.openness_interval,
                p.extracted_share_diffuse,
                p.contrast,
                p.narrowest_lobe_deg,
                p.taken_between_deg,
                p.share_between
            );
        }
    }
}
