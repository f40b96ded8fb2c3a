//! Numbers as Radiance accepts them: decimal, with a point and an exponent; no `inf`, no `nan`, no hexadecimal.

/// A finite real number; `None` if the word is anything else.
pub fn parse_real(word: &str) -> Option<f64> {
    // Rust's own parser also takes "inf" and "nan" in many spellings; they all begin with other characters.
    let numeric = word.bytes().all(|b| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
    if !numeric {
        return None;
    }
    word.parse().ok().filter(|value: &f64| value.is_finite())
}

/// A whole number; `None` if the word is anything else.
pub fn parse_integer(word: &str) -> Option<i64> {
    word.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_decimals_are_numbers() {
        for (word, value) in [("1", 1.0), ("-.5", -0.5), ("+2.", 2.0), ("1.e3", 1000.0), ("6.02E-2", 0.0602)]
        {
            assert_eq!(parse_real(word), Some(value), "{word}");
        }
        for word in ["", "-", ".", "e5", "nan", "inf", "-Infinity", "1e999", "0x10", "1,5", "1 2", "１"] {
            assert_eq!(parse_real(word), None, "{word}");
        }
    }
}
