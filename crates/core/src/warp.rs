//! Maps from the unit square to directions, with their densities.

use crate::Vec3;
use std::f64::consts::PI;

/// Unit square to unit disk, area-preserving and continuous (Shirley and Chiu 1997).
#[inline]
pub fn square_to_disk([u, v]: [f64; 2]) -> [f64; 2] {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0, 0.0];
    }
    let is_beside = a.abs() > b.abs();
    let (r, other) = if is_beside { (a, b) } else { (b, a) };
    let [cos, sin] = within_octant(PI / 4.0 * other / r);
    if is_beside { [r * cos, r * sin] } else { [r * sin, r * cos] }
}

/// Cosine and sine of so many turns, not negative.
#[inline]
pub fn circle(turns: f64) -> [f64; 2] {
    let quarters = (4.0 * turns + 0.5) as u32;
    let [cos, sin] = within_octant(2.0 * PI * (turns - 0.25 * f64::from(quarters)));
    let [x, y] = if quarters.is_multiple_of(2) { [cos, sin] } else { [sin, cos] };
    [if (quarters + 1) & 2 == 0 { x } else { -x }, if quarters & 2 == 0 { y } else { -y }]
}

/// Cosine and sine of at most 45 degrees to either side [rad]: Taylor's series, whose remainders are below 1e-16. (The library's
/// functions, which take any angle, are a twentieth of a picture's time.)
fn within_octant(angle: f64) -> [f64; 2] {
    /// 1, -1/2!, 1/4! … of the cosine, and 1, -1/3!, 1/5! … of the sine.
    const COSINE: [f64; 9] = series(0);
    const SINE: [f64; 9] = series(1);
    // In pairs (Estrin): the processor can do several at once.
    let x = angle * angle;
    let x2 = x * x;
    let sum = |c: [f64; 9]| {
        let pair = |i: usize| c[i] + c[i + 1] * x;
        (pair(0) + pair(2) * x2) + (pair(4) + pair(6) * x2 + c[8] * (x2 * x2)) * (x2 * x2)
    };
    [sum(COSINE), angle * sum(SINE)]
}

/// Coefficients of the powers of x² in the series of the cosine (0) or of the sine over x (1).
const fn series(first: u32) -> [f64; 9] {
    let (mut found, mut term, mut i) = ([0.0; 9], 1.0, 0);
    while i < 9 {
        found[i] = term;
        let n = (2 * i as u32 + first) as f64;
        term /= -((n + 1.0) * (n + 2.0));
        i += 1;
    }
    found
}

/// The inverse of [`square_to_disk`]: unit disk to unit square.
pub fn disk_to_square([x, y]: [f64; 2]) -> [f64; 2] {
    // Not `hypot`, which takes care of numbers that no point of a disk has, and four times as long.
    let r = (x * x + y * y).sqrt();
    let (a, b) = if x.abs() > y.abs() {
        // Signed radius, so that the angle stays within 45 degrees of the axis.
        let a = r.copysign(x);
        (a, a * (y / x).atan() * (4.0 / PI))
    } else if y == 0.0 {
        (0.0, 0.0)
    } else {
        let b = r.copysign(y);
        (b * (x / y).atan() * (4.0 / PI), b)
    };
    [(0.5 + 0.5 * a).clamp(0.0, 1.0), (0.5 + 0.5 * b).clamp(0.0, 1.0)]
}

/// Cosine-distributed direction around +z; density cos(theta)/pi.
pub fn cosine_hemisphere(u: [f64; 2]) -> Vec3 {
    let [x, y] = square_to_disk(u);
    Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// Uniform direction on the sphere; density 1/(4 pi).
pub fn uniform_sphere([u, v]: [f64; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let [cos, sin] = circle(v);
    Vec3::new(r * cos, r * sin, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circle_is_that_of_the_library() {
        for i in 0..=10_000 {
            let turns = f64::from(i) / 5000.0;
            let [cos, sin] = circle(turns);
            let (y, x) = (2.0 * PI * turns).sin_cos();
            assert!((cos - x).abs() < 2e-15 && (sin - y).abs() < 2e-15, "{turns}: {cos} {x}, {sin} {y}");
        }
    }

    #[test]
    fn disk_and_square_undo_each_other() {
        for i in 0..41 {
            for j in 0..41 {
                let u = [i as f64 / 40.0, j as f64 / 40.0];
                let back = disk_to_square(square_to_disk(u));
                assert!((u[0] - back[0]).abs() < 1e-12 && (u[1] - back[1]).abs() < 1e-12, "{u:?} {back:?}");
            }
        }
    }
}
