//! The library: names, numbers of arguments, and what they do.
//!
//! By their documented meaning: manual pages of `rcalc` and `icalc`, and the head of Radiance's `rayinit.cal`, which lists what
//! its renderers define.

use crate::{noise, special};
use std::f64::consts::PI;

/// Constants that are always there.
pub(crate) const CONSTANTS: &[(&str, f64)] = &[("PI", PI), ("DEGREE", PI / 180.0), ("FTINY", 1e-7)];

/// Functions that take functions as arguments, in the language itself: vectors as functions of 1, 2, 3.
pub(crate) const VECTOR_FUNCTIONS: &str = "
dot(a, b) : a(1)*b(1) + a(2)*b(2) + a(3)*b(3);
cross(i, a, b) : select(i, a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1));
";

/// Whose arguments are evaluated one by one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Lazy {
    If,
    And,
    Or,
    Select,
    Min,
    Max,
    /// `arg`: the program's arguments by number.
    Arg,
}

/// A function of the library.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Builtin {
    Lazy(Lazy),
    /// Of so many numbers.
    Plain(fn(&[f64]) -> f64, u8),
}

impl PartialEq for Builtin {
    /// Two plain functions are never known to be the same.
    fn eq(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Lazy(a), Self::Lazy(b)) if a == b)
    }
}

/// Largest number of arguments of a plain function.
pub(crate) const MAX_PLAIN: usize = 5;

impl Builtin {
    /// Fewest arguments.
    pub fn parameters(self) -> usize {
        match self {
            Self::Lazy(Lazy::If) => 3,
            Self::Lazy(Lazy::And | Lazy::Or) => 2,
            Self::Lazy(_) => 1,
            Self::Plain(_, count) => usize::from(count),
        }
    }

    pub fn table() -> impl Iterator<Item = (&'static str, Self)> {
        let lazy = LAZY.iter().map(|&(name, lazy)| (name, Self::Lazy(lazy)));
        lazy.chain(PLAIN.iter().map(|&(name, count, function)| (name, Self::Plain(function, count))))
    }
}

const LAZY: &[(&str, Lazy)] = &[
    ("if", Lazy::If),
    ("and", Lazy::And),
    ("or", Lazy::Or),
    ("select", Lazy::Select),
    ("min", Lazy::Min),
    ("max", Lazy::Max),
    ("arg", Lazy::Arg),
];

type Row = (&'static str, u8, fn(&[f64]) -> f64);

/// Sorted by what they are about.
const PLAIN: &[Row] = &[
    ("sin", 1, |a| a[0].sin()),
    ("cos", 1, |a| a[0].cos()),
    ("tan", 1, |a| a[0].tan()),
    ("asin", 1, |a| a[0].asin()),
    ("acos", 1, |a| a[0].acos()),
    ("atan", 1, |a| a[0].atan()),
    ("atan2", 2, |a| a[0].atan2(a[1])),
    ("exp", 1, |a| a[0].exp()),
    ("log", 1, |a| a[0].ln()),
    ("log10", 1, |a| a[0].log10()),
    ("sqrt", 1, |a| a[0].sqrt()),
    ("floor", 1, |a| a[0].floor()),
    ("ceil", 1, |a| a[0].ceil()),
    ("erf", 1, |a| special::erf(a[0])),
    ("erfc", 1, |a| special::erfc(a[0])),
    ("j0", 1, |a| special::j0(a[0])),
    ("j1", 1, |a| special::j1(a[0])),
    ("jn", 2, |a| special::jn(a[0], a[1])),
    ("y0", 1, |a| special::y0(a[0])),
    ("y1", 1, |a| special::y1(a[0])),
    ("yn", 2, |a| special::yn(a[0], a[1])),
    // Clamped to their domains.
    ("Asin", 1, |a| bound(-1.0, a[0], 1.0).asin()),
    ("Acos", 1, |a| bound(-1.0, a[0], 1.0).acos()),
    ("Atan2", 2, |a| if a[0] * a[0] + a[1] * a[1] > 0.0 { a[0].atan2(a[1]) } else { 0.0 }),
    ("Exp", 1, |a| if a[0] < -100.0 { 0.0 } else { a[0].exp() }),
    ("Sqrt", 1, |a| if a[0] > 0.0 { a[0].sqrt() } else { 0.0 }),
    // Conditions: true above 0.
    ("not", 1, |a| not(a[0])),
    ("xor", 2, |a| if a[0] > 0.0 { not(a[1]) } else { a[1] }),
    ("inside", 3, |a| if a[1] - a[0] > 0.0 { a[2] - a[1] } else { a[1] - a[0] }),
    // Parts and ranges of numbers.
    ("abs", 1, |a| a[0].abs()),
    ("sgn", 1, |a| sign(a[0])),
    ("sq", 1, |a| a[0] * a[0]),
    ("frac", 1, |a| a[0] - a[0].floor()),
    ("mod", 2, |a| modulo(a[0], a[1])),
    ("tri", 2, |a| (a[1] - modulo(a[0] - a[1], 2.0 * a[1])).abs()),
    ("bound", 3, |a| bound(a[0], a[1], a[2])),
    ("noop", 1, |a| a[0]),
    ("clip", 1, |a| bound(0.0, a[0], 1.0)),
    ("noneg", 1, |a| noneg(a[0])),
    // Of colours.
    ("red", 3, |a| noneg(a[0])),
    ("green", 3, |a| noneg(a[1])),
    ("blue", 3, |a| noneg(a[2])),
    ("grey", 3, |a| noneg(grey(a))),
    ("clip_r", 3, |a| bound(0.0, a[0], 1.0)),
    ("clip_g", 3, |a| bound(0.0, a[1], 1.0)),
    ("clip_b", 3, |a| bound(0.0, a[2], 1.0)),
    ("clipgrey", 3, |a| noneg(grey(a)).min(1.0)),
    // Between given values.
    ("linterp", 3, |a| (1.0 - a[0]) * a[1] + a[0] * a[2]),
    ("fade", 3, |a| fade(a[0], a[1], a[2])),
    ("hermite", 5, |a| hermite([a[0], a[1], a[2], a[3]], a[4])),
    ("bezier", 5, |a| bezier([a[0], a[1], a[2], a[3]], a[4])),
    ("bspline", 5, |a| bspline([a[0], a[1], a[2], a[3]], a[4])),
    // Random and noise.
    ("rand", 1, |a| special::rand(a[0])),
    ("unif2norm", 1, |a| special::normal_of_uniform(a[0])),
    ("nrand", 1, |a| special::normal_of_uniform(special::rand(a[0]))),
    ("noise3", 3, |a| noise::noise(point(a))),
    ("noise3x", 3, |a| noise::slope(point(a), 0)),
    ("noise3y", 3, |a| noise::slope(point(a), 1)),
    ("noise3z", 3, |a| noise::slope(point(a), 2)),
    ("noise3a", 3, |a| noise::slope(point(a), 0)),
    ("noise3b", 3, |a| noise::slope(point(a), 1)),
    ("noise3c", 3, |a| noise::slope(point(a), 2)),
    ("noise3d", 4, |a| {
        numbered(a[0], &[0, 1, 2]).map_or(f64::NAN, |axis| noise::slope(point(&a[1..]), axis))
    }),
    ("fnoise3", 3, |a| noise::fractal(point(a))),
    ("turbulence", 4, |a| noise::turbulence(point(a), a[3], |p| noise::noise(p).abs())),
    ("turbulencex", 4, |a| turbulence_slope(a, 0)),
    ("turbulencey", 4, |a| turbulence_slope(a, 1)),
    ("turbulencez", 4, |a| turbulence_slope(a, 2)),
];

fn point(a: &[f64]) -> [f64; 3] {
    [a[0], a[1], a[2]]
}

/// `select`'s rule: the nearest whole number, from 1.
fn numbered(index: f64, from: &[usize]) -> Option<usize> {
    if index < 0.5 { None } else { from.get((index + 0.5) as usize - 1).copied() }
}

fn turbulence_slope(a: &[f64], axis: usize) -> f64 {
    noise::turbulence_slope(point(a), a[3], axis)
}

fn not(a: f64) -> f64 {
    if a > 0.0 { -1.0 } else { 1.0 }
}

fn sign(a: f64) -> f64 {
    if a > 0.0 {
        1.0
    } else if a < 0.0 {
        -1.0
    } else {
        0.0
    }
}

fn bound(low: f64, x: f64, high: f64) -> f64 {
    if low - x > 0.0 {
        low
    } else if x - high > 0.0 {
        high
    } else {
        x
    }
}

fn noneg(a: f64) -> f64 {
    if a > 0.0 { a } else { 0.0 }
}

/// Not a number, and so a failure, for a modulus of 0.
fn modulo(n: f64, d: f64) -> f64 {
    n - (n / d).floor() * d
}

/// Luminance of Radiance's primaries, with the digits that its library has.
fn grey(a: &[f64]) -> f64 {
    0.265074126 * a[0] + 0.670114631 * a[1] + 0.064811243 * a[2]
}

/// From `near` to `far` with the inverse square of the distance, up to 16.
fn fade(near: f64, far: f64, distance: f64) -> f64 {
    far + if 16.0 - distance > 0.0 { (near - far) / (1.0 + distance * distance) } else { 0.0 }
}

/// Cubic from p0 to p1 with slopes r0 and r1 (Foley et al., "Computer Graphics", section 11.2.1).
fn hermite([p0, p1, r0, r1]: [f64; 4], t: f64) -> f64 {
    p0 * ((2.0 * t - 3.0) * t * t + 1.0)
        + p1 * (-2.0 * t + 3.0) * t * t
        + r0 * (((t - 2.0) * t + 1.0) * t)
        + r1 * ((t - 1.0) * t * t)
}

/// Cubic Bézier curve, in Bernstein's polynomials.
fn bezier([p1, p2, p3, p4]: [f64; 4], t: f64) -> f64 {
    let s = 1.0 - t;
    p1 * s * s * s + 3.0 * p2 * s * s * t + 3.0 * p3 * s * t * t + p4 * t * t * t
}

/// Uniform cubic B-spline segment.
fn bspline([before, p0, p1, after]: [f64; 4], t: f64) -> f64 {
    let s = 1.0 - t;
    (before * s * s * s
        + p0 * (4.0 + t * t * (3.0 * t - 6.0))
        + p1 * (1.0 + t * (3.0 + t * (3.0 - 3.0 * t)))
        + after * t * t * t)
        / 6.0
}
