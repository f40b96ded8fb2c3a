//! Error functions, Bessel functions, random numbers.

pub(crate) use libm::{erf, erfc, j0, j1, y0, y1};

/// Orders of Bessel functions above this are refused: their recurrence takes as many steps.
const MAX_ORDER: f64 = 10_000.0;

/// Bessel function of the first kind; the order is rounded.
pub(crate) fn jn(order: f64, x: f64) -> f64 {
    if order.abs() <= MAX_ORDER { libm::jn((order + 0.5) as i32, x) } else { f64::NAN }
}

/// Bessel function of the second kind; the order is rounded.
pub(crate) fn yn(order: f64, x: f64) -> f64 {
    if order.abs() <= MAX_ORDER { libm::yn((order + 0.5) as i32, x) } else { f64::NAN }
}

/// e, with the digits that Radiance's `rand` has: one more would be other numbers.
#[allow(clippy::approx_constant)]
const RAND_FACTOR: f64 = 2.71828182845904;

/// A number in [0, 1) that looks random, the same for the same x. The formula is that of Radiance's `rand`.
pub(crate) fn rand(x: f64) -> f64 {
    let mixed = x * (1.0 / (1.0 + x * x) + RAND_FACTOR);
    let inverse = 1e5 / (mixed + (0.785398163397447 - mixed.floor()));
    inverse - inverse.floor()
}

/// The normal deviate of a uniform one in (0, 1) (Abramowitz and Stegun 1964, equation 26.2.23: to 4.5e-4).
pub(crate) fn normal_of_uniform(p: f64) -> f64 {
    let tail = |p: f64| {
        let t = (-2.0 * p.ln()).sqrt();
        t - (2.515517 + t * (0.802853 + t * 0.010328))
            / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)))
    };
    if 0.5 - p > 0.0 { -tail(p) } else { tail(1.0 - p) }
}
