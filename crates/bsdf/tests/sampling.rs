//! Samplers against their densities: normalisation, chi-square, energy.
#![allow(clippy::unwrap_used)]

mod common;

use common::{directions, fabrics, halton, one_sided, random, shared_bsdfs, uncommon_tables};
use glam::DVec2;
use rayon::prelude::*;
use std::{f64::consts::PI, sync::Arc};
use sunpeak_bsdf::{
    Bsdf, Distribution, Mode, Oriented, PeakRule, Sides,
    synthetic::Fabric,
    table::{Columns, Table, turned, turned_back},
    xml::Document,
};
use sunpeak_core::{Vec3, luminance};

const RULES: [PeakRule; 2] = [PeakRule::Off, PeakRule::Split];

fn every_bsdf() -> Vec<(String, Bsdf)> {
    fabrics().into_iter().chain(one_sided()).chain(shared_bsdfs()).collect()
}

/// Cells a side of [`grid`]: a multiple of every tree's.
const SIDE: usize = 512;

/// Projected solid angle of a cell of the grid [sr].
const CELL: f64 = PI / (SIDE * SIDE) as f64;

/// Directions over the sphere, one for each cell of a fine grid on both disks.
fn grid() -> impl Iterator<Item = Vec3> {
    (0..SIDE * SIDE).flat_map(|i| {
        let u = [(i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5].map(|x| x / SIDE as f64);
        let v = sunpeak_core::warp::cosine_hemisphere(u);
        [v, Vec3::new(v.x, v.y, -v.z)]
    })
}

/// Groups of cells that are counted together, on each side.
const GROUPS: usize = 64;

/// The group of cells that a direction falls in: the table's own cells, or, where it is traced against, those of a fine square.
fn group(bsdf: &Bsdf, w_in: Vec3, w_out: Vec3) -> usize {
    let mode = if w_in.z * w_out.z > 0.0 { Mode::Reflection } else { Mode::Transmission };
    let Some(o) = bsdf.distribution(w_in, mode) else { return 0 };
    let (p_in, p_out) = (-w_in.truncate(), w_out.truncate());
    let (a, b) = o.points(p_in, p_out);
    let cell = match o.distribution.luminous() {
        Table::Tree(t) if o.reversed => {
            Columns::Square { side: 64 }.index(if t.rank() == 3 { turned(p_in, p_out) } else { p_out })
        }
        Table::Matrix(m) if o.reversed => m.incident.index(a),
        table => table.index(a, b),
    };
    2 * (cell % GROUPS) + usize::from(w_out.z > 0.0)
}

/// Exiting points with their areas [sr], one or more for each cell of [`group`].
fn exits(o: &Oriented, p_in: DVec2) -> Vec<(DVec2, f64)> {
    match o.distribution.luminous() {
        Table::Tree(t) if o.reversed => {
            let side = 256;
            let points = (0..side * side).map(|i| {
                let u = [(i % side) as f64 + 0.5, (i / side) as f64 + 0.5].map(|x| x / side as f64);
                let p: DVec2 = sunpeak_core::warp::square_to_disk(u).into();
                let p = if t.rank() == 3 { turned_back(p_in, p) } else { p };
                (p, PI / (side * side) as f64)
            });
            points.collect()
        }
        Table::Matrix(m) if o.reversed => (0..m.incident.len())
            .map(|patch| (-m.incident.point(patch, [0.5, 0.5]), m.incident.projected_solid_angle(patch)))
            .collect(),
        table => {
            let columns = o.distribution.columns();
            let cells = table.cells(columns, columns.index(p_in));
            let turn = |p| if table.is_isotropic() { turned_back(p_in, p) } else { p };
            cells.iter().map(|c| (turn(table.point(c, [0.5, 0.5])), c.projected_solid_angle)).collect()
        }
    }
}

/// Pearson's chi-square of sample counts against the density integrated over groups, and the number of groups.
fn chi_square(bsdf: &Bsdf, w_in: Vec3, rule: PeakRule) -> Option<(f64, f64)> {
    let n = 40_000;
    let mut counts = [0.0; 2 * GROUPS];
    for i in 0..n {
        let u = [random(3 * i), random(3 * i + 1), random(3 * i + 2)];
        counts[group(bsdf, w_in, bsdf.sample_smooth(w_in, u, rule)?.w_out)] += 1.0;
    }
    let mut expected = [0.0; 2 * GROUPS];
    for mode in [Mode::Transmission, Mode::Reflection] {
        let Some(o) = bsdf.distribution(w_in, mode) else { continue };
        let up = (w_in.z > 0.0) == (mode == Mode::Reflection);
        for (p, area) in exits(o, -w_in.truncate()) {
            let height = (1.0 - p.length_squared()).sqrt();
            let w_out = p.extend(if up { height } else { -height });
            let density = bsdf.pdf_smooth(w_in, w_out, rule) / height;
            expected[group(bsdf, w_in, w_out)] += density * area * f64::from(n);
        }
    }
    let (mut chi, mut groups) = (0.0, 0.0);
    for (c, e) in counts.iter().zip(expected) {
        if e > 5.0 {
            chi += (c - e) * (c - e) / e;
            groups += 1.0;
        }
    }
    Some((chi, groups))
}

#[test]
fn tables_of_one_side_have_a_peak_to_leave_out() {
    for (name, bsdf) in one_sided() {
        for front in [true, false] {
            let through = |w: &Vec3| luminance(bsdf.through(*w, PeakRule::Split)) > 0.0;
            let count = directions(40, front).iter().filter(|w| through(w)).count();
            assert!(count > 20, "{name} {front}: {count} of 40");
        }
    }
}

/// Uncommon tables on both halves: what comes back has a lobe too.
fn reflecting() -> Vec<(String, Bsdf)> {
    let both = |(name, _, table): (&str, &str, Table)| {
        let reflection = Some(Arc::new(Distribution::new(table.clone(), None)));
        let transmission_back = Some(Arc::new(Distribution::with_split(table, None)));
        let sides = Sides {
            reflection_front: reflection.clone(),
            reflection_back: reflection,
            transmission_back,
            ..Sides::default()
        };
        (format!("{name}, reflecting"), Bsdf::from_sides(Document::default(), sides))
    };
    uncommon_tables().map(both).into()
}

/// Fabrics with more cells than blocks of them are remembered.
fn large_fabrics() -> Vec<(String, Bsdf)> {
    let fabric = |name: &str| (name.to_owned(), Fabric::default().tabulate(name.parse().unwrap()).unwrap());
    ["t3-16384", "t4-1024"].map(fabric).into()
}

/// Near the normal, halfway, and grazing, on both sides.
fn incidences() -> [Vec3; 6] {
    let at = |theta_deg: f64, phi_deg: f64| {
        let (sin, cos) = theta_deg.to_radians().sin_cos();
        DVec2::from_angle(phi_deg.to_radians()).extend(0.0) * sin + Vec3::Z * cos
    };
    [
        at(0.7, 41.0),
        directions(8, true)[6],
        at(87.3, 203.0),
        at(179.2, 118.0),
        directions(5, false)[4],
        at(93.1, 317.0),
    ]
}

/// How many standard deviations chi-square is from its mean (Wilson and Hilferty 1931): right for few degrees of freedom too.
fn deviation(chi: f64, freedom: f64) -> f64 {
    let variance = 2.0 / (9.0 * freedom);
    ((chi / freedom).cbrt() - (1.0 - variance)) / variance.sqrt()
}

#[test]
fn samples_follow_their_density() {
    let all: Vec<_> = every_bsdf().into_iter().chain(reflecting()).chain(large_fabrics()).collect();
    let counted: usize = all
        .par_iter()
        .map(|(name, bsdf)| {
            let mut counted = 0;
            for (rule, w_in) in RULES.into_iter().flat_map(|rule| incidences().map(|w_in| (rule, w_in))) {
                let Some((chi, groups)) = chi_square(bsdf, w_in, rule) else { continue };
                let sigmas = deviation(chi, (groups - 1.0).max(1.0));
                assert!(sigmas < 4.0, "{name} {rule:?} {w_in}: chi-square {chi} in {groups} groups");
                counted += 1;
            }
            counted
        })
        .sum();
    // Nothing but a pure peak leaves nothing to sample.
    let possible = all.len() * RULES.len() * incidences().len();
    assert!(counted * 10 > possible * 9, "{counted} of {possible}");
}

/// The weights' mean is the integral of what is sampled; where columns are the table's own, it is the hemispherical value.
#[test]
fn weights_average_to_the_integral() {
    for (name, bsdf) in every_bsdf() {
        for rule in RULES {
            for w_in in [directions(8, true)[6], directions(5, false)[4]] {
                let n = 8192;
                let (mut sampled, mut integral) = ([0.0; 2], [0.0; 2]);
                let reflected = |w: Vec3| usize::from(w.z * w_in.z > 0.0);
                for i in 0..n {
                    let u = [halton(i, 2), halton(i, 3), halton(i, 5)];
                    if let Some(s) = bsdf.sample_smooth(w_in, u, rule) {
                        sampled[reflected(s.w_out)] += luminance(s.weight) / f64::from(n);
                    }
                }
                for w in grid() {
                    integral[reflected(w)] += luminance(bsdf.evaluate_smooth(w_in, w, rule)) * CELL;
                }
                for (k, mode) in [Mode::Transmission, Mode::Reflection].into_iter().enumerate() {
                    let (got, truth) = (sampled[k], integral[k]);
                    assert!(
                        (got - truth).abs() < 0.03 * truth + 1e-3,
                        "{name} {rule:?} {mode:?} {w_in}: {got} {truth}"
                    );
                    let own = bsdf.distribution(w_in, mode).is_none_or(|o| !o.reversed);
                    let hemispherical = luminance(bsdf.hemispherical_smooth(w_in, mode, rule));
                    // The grid knows the area of a patch to two percent.
                    let limit = if own { 2e-2 } else { 0.1 };
                    assert!(
                        (hemispherical - truth).abs() < limit * truth + 1e-4,
                        "{name} {mode:?}: {hemispherical} {truth}"
                    );
                }
            }
        }
    }
}
