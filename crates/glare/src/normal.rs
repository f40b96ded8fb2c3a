//! The normal distribution.

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
    use super::cumulative;

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
}
