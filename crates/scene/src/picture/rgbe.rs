//! Pixels of four bytes: three mantissas and a common exponent (Ward 1991, "Real Pixels", Graphics Gems II).

/// Below this Radiance writes black.
const SMALLEST: f64 = 1e-32;
/// Largest value that the exponent can hold, just under 2^127.
const LARGEST: f64 = 1.7e38;
/// Added to the exponent of two.
const EXPONENT_BIAS: i32 = 128;
/// A mantissa is in parts of 256, and stands for the middle of its step.
const MANTISSA_BITS: i32 = 8;

/// Values of a pixel.
pub fn decode([r, g, b, exponent]: [u8; 4]) -> [f64; 3] {
    [r, g, b].map(|mantissa| component(mantissa, exponent))
}

/// One of the values of a pixel.
pub fn component(mantissa: u8, exponent: u8) -> f64 {
    if exponent == 0 {
        return 0.0;
    }
    (f64::from(mantissa) + 0.5) * 2f64.powi(i32::from(exponent) - EXPONENT_BIAS - MANTISSA_BITS)
}

/// The pixel of values. Negative ones and NaN, which it cannot hold, become 0; too large ones the largest.
pub fn encode(values: [f32; 3]) -> [u8; 4] {
    let values = values.map(|value| if value.is_nan() { 0.0 } else { f64::from(value).clamp(0.0, LARGEST) });
    let largest = values.into_iter().fold(0.0, f64::max);
    if largest <= SMALLEST {
        return [0; 4];
    }
    let exponent = binary_exponent(largest);
    let steps_per_unit = 2f64.powi(MANTISSA_BITS - exponent);
    let [r, g, b] = values.map(|value| (value * steps_per_unit) as u8);
    [r, g, b, (exponent + EXPONENT_BIAS) as u8]
}

/// The exponent that leaves a mantissa from 1/2 to 1, of a normal number.
fn binary_exponent(value: f64) -> i32 {
    const EXPONENT_FIELD: u64 = 0x7ff;
    (value.to_bits() >> 52 & EXPONENT_FIELD) as i32 - 1022
}
