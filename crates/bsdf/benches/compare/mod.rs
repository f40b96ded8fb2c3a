//! Two ways to do the same, timed in turn in one run, so that a machine whose speed drifts slows both.

use std::time::Instant;

/// Rounds of each, after one that is not counted; the median counts.
const ROUNDS: usize = 15;

/// Print the heading of the table that [`row`] goes on with.
pub fn heading(title: &str, unit: &str, theirs: &str) {
    println!("\n{title} [{unit}]; theirs: {theirs}");
    println!("{:<32} {:>10} {:>12} {:>8}", "name", "ours", "theirs", "ratio");
}

/// Time `count` calls in each way, and print a row: name, ns a call in both, and the ratio of theirs to ours.
pub fn row(name: &str, count: usize, mut ours: impl FnMut(), mut theirs: impl FnMut()) {
    let (mut a, mut b, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for round in 0..=ROUNDS {
        let (x, y) = (time(&mut ours), time(&mut theirs));
        if round > 0 {
            a.push(x);
            b.push(y);
            ratios.push(y / x);
        }
    }
    let ns = |seconds: Vec<f64>| 1e9 * median(seconds) / count as f64;
    println!("{name:<32} {:>10.1} {:>12.1} {:>8.1}", ns(a), ns(b), median(ratios));
}

fn time(f: &mut impl FnMut()) -> f64 {
    let start = Instant::now();
    f();
    start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
