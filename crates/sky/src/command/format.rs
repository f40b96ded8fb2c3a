//! Numbers as C's `printf` writes them, so that a text can be compared with the programs' own.

/// `%.3e`
pub(super) fn scientific(value: f64) -> String {
    let text = format!("{value:.3e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let (sign, digits) = match exponent.strip_prefix('-') {
                Some(digits) => ('-', digits),
                None => ('+', exponent),
            };
            format!("{mantissa}e{sign}{digits:0>2}")
        }
        None => text,
    }
}

/// `%f`
pub(super) fn fixed(value: f64) -> String {
    format!("{value:.6}")
}

/// `%f %f %f`
pub(super) fn direction(v: sunpeak_core::Vec3) -> String {
    format!("{} {} {}", fixed(v.x), fixed(v.y), fixed(v.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_look_as_in_c() {
        assert_eq!(scientific(6_816_000.0), "6.816e+06");
        assert_eq!(scientific(-0.000_012_345), "-1.234e-05"); // 1.2345e-5 lies just below the tie
        assert_eq!(scientific(0.0), "0.000e+00");
        assert_eq!(scientific(1e100), "1.000e+100");
        assert_eq!(fixed(0.5), "0.500000");
    }
}
