//! The normal distribution.

/// The part of a standard normal distribution between two limits: what it holds of 1, x and x².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub probability: f64,
    pub first: f64,
    pub second: f64,
}

impl Part {
    pub fn between(from: f64, to: f64) -> Self {
        let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let times_density = |x: f64| if x.is_finite() { x * density(x) } else { 0.0 };
        let probability = cumulative(to) - cumulative(from);
        Self {
            probability,
            first: density(from) - density(to),
            second: probability + times_density(from) - times_density(to),
        }
    }
}

/// Probability [-] that a standard normal number is below `x`.
pub(crate) fn cumulative(x: f64) -> f64 {
    0.5 * complementary_error_function(-x / std::f64::consts::SQRT_2)
}

/// erfc, by the series of erf where it converges fast, by its continued fraction elsewhere (Abramowitz and Stegun 7.1.6, 7.1.14).
fn complementary_error_function(x: f64) -> f64 {
    if x < 0.0 {
        return 2.0 - complementary_error_function(-x);
    }
    let two_over_root_pi = std::f64::consts::FRAC_2_SQRT_PI;
    if x < 2.5 {
        let (mut term, mut sum) = (x, x);
        for n in 1..80 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
        }
        return 1.0 - two_over_root_pi * (-x * x).exp() * sum;
    }
    let fraction = (1..=60).rev().fold(x, |tail, n| x + 0.5 * f64::from(n) / tail);
    0.5 * two_over_root_pi * (-x * x).exp() / fraction
}

#[cfg(test)]
mod tests {
    use super::{Part, cumulative};

    /// Tables of the normal distribution.
    #[test]
    fn agrees_with_tables() {
        for (x, p) in [
            (0.0, 0.5),
            (1.0, 0.841344746068543),
            (-1.96, 0.024997895148220),
            (3.0, 0.998650101968370),
            (-4.0, 3.167124183311986e-5),
            (f64::INFINITY, 1.0),
        ] {
            assert!((cumulative(x) - p).abs() < 1e-12, "{x}: {}", cumulative(x));
        }
    }

    /// Between -1 and 1, above 0, and all of it.
    #[test]
    fn parts_hold_what_tables_say() {
        let infinity = f64::INFINITY;
        for (from, to, expected) in [
            (-1.0, 1.0, [0.682689492137086, 0.0, 0.198748043098799]),
            (0.0, infinity, [0.5, 0.398942280401433, 0.5]),
            (-infinity, infinity, [1.0, 0.0, 1.0]),
        ] {
            let part = Part::between(from, to);
            for (found, expected) in [part.probability, part.first, part.second].into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{part:?}");
            }
        }
    }
}
