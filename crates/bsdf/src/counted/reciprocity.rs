//! Helmholtz's reciprocity: light that comes back along the way on which it left finds the same value. Two counts of the same thing.

use super::Counted;
use crate::table::Columns;

/// Average a reflection with itself, seen the other way round. Isotropic trees, whose incident and exiting sides are divided
/// differently, stay as they are.
pub fn average_within(reflection: &mut Counted) {
    let other = reflection.clone();
    average(reflection, &other, true);
}

/// Average the transmissions of both sides; isotropic trees stay as they are.
pub fn average_sides(front: &mut Counted, back: &mut Counted) {
    let other = front.clone();
    average(front, back, false);
    average(back, &other, false);
}

/// Weighted by the rays behind both. Each column then gets its own hemispherical value back, which is known far better than the
/// cells are.
fn average(own: &mut Counted, other: &Counted, is_same: bool) {
    let [incident, exiting] = own.basis.divisions();
    let Some(opposite) = opposites(&incident) else { return };
    let width = own.width();
    for i in 0..own.rays.len() {
        let before = own.scattered_in(&exiting, i);
        for o in 0..width {
            let (at, there) = (i * width + o, opposite[o] * width + opposite[i]);
            let whole = own.rays[i] + other.rays[opposite[o]];
            let [a, b] = [own.rays[i] / whole, other.rays[opposite[o]] / whole];
            let mean = |x: f32, y: f32| (a * f64::from(x) + b * f64::from(y)) as f32;
            own.luminous[at] = mean(own.luminous[at], other.luminous[there]);
            if let (Some(color), Some(theirs)) = (&mut own.color, &other.color) {
                color.iter_mut().zip(theirs).for_each(|(c, t)| c[at] = mean(c[at], t[there]));
            }
            // A cell that is its own other way round has told all that it knows.
            if !(is_same && at == there) {
                own.error[at] =
                    (a * f64::from(own.error[at])).hypot(b * f64::from(other.error[there])) as f32;
            }
        }
        let after = own.scattered_in(&exiting, i);
        if after > 0.0 {
            let scale = (before / after) as f32;
            own.luminous[i * width..(i + 1) * width].iter_mut().for_each(|v| *v *= scale);
            for plane in own.color.iter_mut().flatten() {
                plane[i * width..(i + 1) * width].iter_mut().for_each(|v| *v *= scale);
            }
        }
    }
}

/// The cell on the other side of the normal, for divisions that are the same for incident and exiting light.
fn opposites(columns: &Columns) -> Option<Vec<usize>> {
    match columns {
        Columns::Radial { .. } => None,
        Columns::Square { side } => Some((0..side * side).rev().collect()),
        Columns::Patches(basis) => {
            Some((0..basis.len()).map(|p| basis.index(-basis.point(p, [0.5, 0.5]))).collect())
        }
    }
}
