use super::*;
use std::{f64::consts::PI, sync::Arc};

fn divisions() -> Vec<Columns> {
    let mut all: Vec<Columns> = ["LBNL/Klems Full", "LBNL/Klems Half", "LBNL/Klems Quarter"]
        .map(|name| Columns::Patches(Arc::new(AngleBasis::known(name).unwrap())))
        .into();
    let odd = AngleBasis::new("odd", &[(20.0, 3), (50.0, 7), (90.0, 2)]).unwrap();
    all.push(Columns::Patches(Arc::new(odd)));
    all.extend([1, 2, 8, 16].map(|side| Columns::Square { side }));
    all.push(Columns::Radial { side: 16 });
    all
}

fn area(region: &[Polygon]) -> f64 {
    region.iter().map(Polygon::projected_solid_angle).sum()
}

#[test]
fn regions_have_the_area_of_their_cells_however_they_are_turned() {
    for division in divisions() {
        for cell in 0..division.len() {
            let region = division.region(cell);
            let truth = division.projected_solid_angle(cell);
            assert!((area(&region) - truth).abs() < 1e-12, "{division:?} {cell}");
            for angle in [0.0, 0.3, -2.0, 9.0, PI / 2.0] {
                let turned: Region = region.iter().flat_map(|p| p.turned(angle)).collect();
                assert!((area(&turned) - truth).abs() < 1e-12, "{division:?} {cell} {angle}");
            }
        }
    }
}

#[test]
fn a_cell_shares_all_of_itself_with_the_cells_below_it() {
    for own in divisions() {
        for other in divisions() {
            let mut given = vec![0.0; other.len()];
            for cell in 0..own.len() {
                let shares = other.shares(&own.region(cell));
                let sum: f64 = shares.iter().map(|s| s.1).sum();
                assert!((sum - own.projected_solid_angle(cell)).abs() < 1e-11, "{own:?} {other:?} {cell}");
                shares.iter().for_each(|&(at, shared)| given[at as usize] += shared);
            }
            for (at, sum) in given.into_iter().enumerate() {
                assert!((sum - other.projected_solid_angle(at)).abs() < 1e-11, "{own:?} {other:?} {at}");
            }
        }
    }
}

/// Against counting: points of a cell, turned or mirrored, looked up in the other division.
#[test]
fn shares_are_what_points_count() {
    const N: usize = 60;
    let divisions = divisions();
    for (own, other) in divisions.iter().flat_map(|a| divisions.iter().map(move |b| (a, b))) {
        if matches!(own, Columns::Radial { .. }) {
            continue; // its points lie on one axis
        }
        for (cell, turn) in [(0, 0.0), (own.len() / 2, 0.7), (own.len() - 1, -2.4)] {
            let moved: Region =
                own.region(cell).iter().flat_map(|p| p.turned(turn)).map(|p| p.mirrored(true)).collect();
            let shares = other.shares(&moved);
            let mut counted = vec![0.0; other.len()];
            for k in 0..N * N {
                let u = [k / N, k % N].map(|i| (i as f64 + 0.5) / N as f64);
                let p = DVec2::from_angle(turn).rotate(own.point(cell, u));
                counted[other.index(DVec2::new(-p.x, p.y))] +=
                    own.projected_solid_angle(cell) / (N * N) as f64;
            }
            for &(at, shared) in &shares {
                counted[at as usize] -= shared;
            }
            let worst = counted.iter().map(|d| d.abs()).fold(0.0, f64::max);
            assert!(worst < 0.04 * own.projected_solid_angle(cell), "{own:?} {other:?} {cell} {worst}");
        }
    }
}
