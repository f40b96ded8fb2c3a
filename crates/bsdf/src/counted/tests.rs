use super::*;
use std::f64::consts::PI;

/// Columns of a product that is scattered evenly, with a straight part that depends on the column, counted without any noise.
fn counted(basis: Basis) -> Counted {
    let [incident, exiting] = basis.divisions();
    let n = incident.len();
    Counted {
        basis,
        luminous: vec![(0.1 / PI) as f32; n * exiting.len()],
        color: None,
        error: vec![1e-6; n * exiting.len()],
        rays: vec![1e6; n],
        whole_error: vec![0.0; n],
        through: (0..n).map(|c| gray(0.2 * incident.point(c, [0.5; 2]).length())).collect(),
        through_error: vec![1e-4; n],
    }
}

#[test]
fn the_straight_part_stands_in_its_cells_and_in_the_split() {
    for name in ["klems", "t3-256", "t4-64"] {
        let counts = counted(name.parse().expect("a basis"));
        let d = counts.distribution(0.01);
        let columns = d.columns().clone();
        assert_eq!(columns.len(), counts.rays.len(), "{name}");
        // The split keeps its numbers in 32 bits.
        for c in 0..columns.len() {
            let cells = d.luminous().cells(&columns, c);
            let whole: f64 = cells
                .iter()
                .map(|k| f64::from(d.luminous().values()[k.index]) * k.projected_solid_angle)
                .sum();
            let through = luminance(counts.through[c]);
            assert!((whole - 0.1 - through).abs() < 1e-6, "{name} {c}: {whole}");
            let rest: f64 = cells.iter().map(|k| d.residual_at(c, k.index) * k.projected_solid_angle).sum();
            assert!((rest - 0.1).abs() < 1e-6, "{name} {c}: {rest}");
            let peak = d.split().column(c).expect("a column");
            assert!((luminance(peak.through) - through).abs() < 1e-7);
            assert!(peak.interval[0] <= through + 1e-7 && through <= peak.interval[1] + 1e-7);
        }
    }
}

#[test]
fn nothing_straight_is_no_peak() {
    let mut counts = counted(Basis::TensorTree4 { side: 8 });
    counts.through.iter_mut().for_each(|t| *t = Rgb::ZERO);
    let d = counts.distribution(0.01);
    assert!(!d.split().has_peak());
    assert_eq!(d.luminous().values().len(), 1);
}

#[test]
fn reciprocity_averages_what_is_the_same() {
    let basis = Basis::KlemsQuarter;
    let mut counts = counted(basis);
    let [incident, exiting] = basis.divisions();
    let n = exiting.len();
    // One value is known twice as well as its other way round: a third of the weight there, two here.
    let (i, o) = (3, 17);
    let opposite = |c: usize| incident.index(-incident.point(c, [0.5; 2]));
    counts.luminous[i * n + o] = 0.9;
    counts.rays[i] = 2e6;
    let other = f64::from(counts.luminous[opposite(o) * n + opposite(i)]);
    let before = counts.scattered(i);
    average_within(&mut counts);
    assert!((counts.scattered(i) - before).abs() < 1e-6);
    let expected = (2.0 * f64::from(0.9f32) + other) / 3.0;
    // The column then gets its own sum back, which the average has lowered.
    let ratio = f64::from(counts.luminous[i * n + o]) / f64::from(counts.luminous[i * n]);
    assert!((ratio - expected / (0.1 / PI)).abs() < 1e-3 * ratio, "{ratio}");
    assert!(f64::from(counts.error[i * n + o]) < 1e-6);
}
