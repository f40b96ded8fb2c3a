//! Maps from the unit square to directions, with their densities.

use crate::Vec3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_8, PI, SQRT_2};

/// Unit square to unit disk, area-preserving and continuous (Shirley and Chiu 1997).
#[inline(always)]
pub fn square_to_disk([u, v]: [f64; 2]) -> [f64; 2] {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0, 0.0];
    }
    let is_beside = a.abs() > b.abs();
    let (r, other) = if is_beside { (a, b) } else { (b, a) };
    // At most an eighth to either side of a whole turn.
    let [cos, sin] = circle_at(SECTORS as f64 * (1.0 + 0.125 * (other / r)));
    if is_beside { [r * cos, r * sin] } else { [r * sin, r * cos] }
}

/// Cosine and sine of so many turns, not negative.
#[inline]
pub fn circle(turns: f64) -> [f64; 2] {
    circle_at(SECTORS as f64 * turns)
}

/// The circle in sectors, whose middles' cosines and sines are known.
const SECTORS: usize = 128;
static MIDDLES: [[f64; 2]; SECTORS] = middles();

/// Cosine and sine of so many sectors, not negative: Taylor's series from the middle of the nearest, whose remainders are below 1e-16. (The
/// library's functions, which take any angle, are a twentieth of a picture's time.)
#[inline]
fn circle_at(sectors: f64) -> [f64; 2] {
    let nearest = (sectors + 0.5) as u32;
    let [cos, sin] = MIDDLES[nearest as usize % SECTORS];
    let angle = (sectors - f64::from(nearest)) * (2.0 * PI / SECTORS as f64);
    let x = angle * angle;
    let along = 1.0 - x * (1.0 / 2.0 - x * (1.0 / 24.0 - x * (1.0 / 720.0)));
    let across = angle * (1.0 - x * (1.0 / 6.0 - x * (1.0 / 120.0 - x * (1.0 / 5040.0))));
    [cos * along - sin * across, sin * along + cos * across]
}

const fn middles() -> [[f64; 2]; SECTORS] {
    let (mut found, mut i) = ([[0.0; 2]; SECTORS], 0);
    while i < SECTORS {
        // From the nearest axis, at most 45 degrees to either side.
        let axis = (i + SECTORS / 8) / (SECTORS / 4);
        let angle = 2.0 * PI * (i as f64 - (axis * SECTORS / 4) as f64) / SECTORS as f64;
        let [cos, sin] = [series(angle, 0), angle * series(angle, 1)];
        found[i] = [[cos, sin], [-sin, cos], [-cos, -sin], [sin, -cos]][axis % 4];
        i += 1;
    }
    found
}

/// Taylor's series of the cosine (0), or of the sine over the angle (1).
const fn series(angle: f64, first: u32) -> f64 {
    let (mut sum, mut i) = (0.0, 10);
    // From the smallest term: 1 - x²/(n + 1)(n + 2) (1 - x²/(n + 3)(n + 4) (1 - …
    while i > 0 {
        i -= 1;
        let n = (2 * i + first) as f64;
        sum = 1.0 - angle * angle / ((n + 1.0) * (n + 2.0)) * sum;
    }
    sum
}

/// Angle of a point from the x axis, 0 to pi [rad], within 1e-15; `y` is not negative, and of the origin the angle is any. (The library's
/// function, which tells signs of zeros and infinities apart, is a call with several times as many instructions.)
#[inline]
pub fn angle([x, y]: [f64; 2]) -> f64 {
    const MIDDLE: f64 = SQRT_2 - 1.0;
    let across = x.abs();
    let (low, high) = if y < across { (y, across) } else { (across, y) };
    // The octant turned back by half of itself.
    let tangent = (low - MIDDLE * high) / (high + MIDDLE * low + f64::MIN_POSITIVE);
    let octant = FRAC_PI_8 + within_half_octant(tangent);
    let quarter = if y < across { octant } else { FRAC_PI_2 - octant };
    if x < 0.0 { PI - quarter } else { quarter }
}

/// Angle of at most 22.5 degrees to either side [rad] by its tangent: Chebyshev's series, whose remainder is below 2e-16.
#[inline]
fn within_half_octant(tangent: f64) -> f64 {
    const ANGLE: [f64; 10] = chebyshev();
    let x = tangent * tangent;
    let x2 = x * x;
    let x4 = x2 * x2;
    let pair = |i: usize| ANGLE[i] + ANGLE[i + 1] * x;
    let four = |i: usize| pair(i) + pair(i + 2) * x2;
    tangent * (four(0) + four(4) * x4 + pair(8) * (x4 * x4))
}

/// Coefficients of the powers of t² in the angle over its tangent t. With t = tan(pi/8) cos a and p = tan(pi/16) the angle is that of the
/// complex number (1 + i p e^(ia)) (1 + i p e^(-ia)), the imaginary part of its logarithm: by the logarithm's series the sum of
/// 2 (-1)^k p^(2k+1)/(2k+1) cos (2k+1)a, where the cosines are Chebyshev's polynomials T_2k+1 of cos a.
const fn chebyshev() -> [f64; 10] {
    const P: f64 = 0.198_912_367_379_658;
    let (mut found, mut k) = ([0.0; 10], 0);
    // T_2k-1 and T_2k+1, by their coefficients of x, x³, x⁵ …: T_-1 is T_1.
    let (mut before, mut at) = ([0.0; 10], [0.0; 10]);
    (before[0], at[0]) = (1.0, 1.0);
    let mut power = P;
    while k < 10 {
        let mut scale = 2.0 * power / (2 * k + 1) as f64;
        let mut i = 0;
        let mut next = [0.0; 10];
        while i < 10 {
            scale *= 1.0 / (SQRT_2 - 1.0);
            found[i] += scale * at[i];
            scale *= 1.0 / (SQRT_2 - 1.0);
            // T_n+2 = (4 x² - 2) T_n - T_n-2.
            next[i] = -2.0 * at[i] - before[i] + if i > 0 { 4.0 * at[i - 1] } else { 0.0 };
            i += 1;
        }
        (before, at) = (at, next);
        power *= -P * P;
        k += 1;
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
    fn the_angle_is_that_of_the_library() {
        for i in 0..=100_000 {
            let (y, x) = (PI * f64::from(i) / 100_000.0).sin_cos();
            for scale in [1e-30, 1.0, 1e30] {
                let (found, expected) = (angle([scale * x, scale * y]), (scale * y).atan2(scale * x));
                assert!((found - expected).abs() < 9e-16, "{x} {y}: {found} {expected}");
            }
        }
        assert!((0.0..=PI).contains(&angle([0.0, 0.0])));
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
