//! Three channels in Radiance's primaries.

use glam::{DMat3, DVec3};

/// Radiance, irradiance, reflectance or transmittance in three channels (red, green, blue of Radiance).
pub type Rgb = DVec3;

/// Luminous efficacy of Radiance's white [lm/W] (Ward and Shakespeare 1998; `WHTEFFICACY` of the manual).
pub const LUMINOUS_EFFICACY: f64 = 179.0;

/// Share of each channel in the luminous value, for Radiance's primaries and equal-energy white.
const LUMINANCE_WEIGHTS: DVec3 = DVec3::new(0.265, 0.670, 0.065);

/// The same value in all three channels.
pub fn gray(value: f64) -> Rgb {
    Rgb::splat(value)
}

/// Luminous mean of the channels, in their own unit.
pub fn luminance(rgb: Rgb) -> f64 {
    rgb.dot(LUMINANCE_WEIGHTS)
}

/// Luminance [cd/m²] of a radiance [W sr⁻¹ m⁻²], or illuminance [lx] of an irradiance [W m⁻²].
pub fn luminance_cd_m2(rgb: Rgb) -> f64 {
    LUMINOUS_EFFICACY * luminance(rgb)
}

/// CIE XYZ to Radiance's RGB: primaries (0.640, 0.330), (0.290, 0.600), (0.150, 0.060), white (1/3, 1/3).
///
/// The matrix is derived here from these chromaticities, so that X = Y = Z = v gives R = G = B = v.
pub fn xyz_to_rgb(xyz: DVec3) -> Rgb {
    rgb_to_xyz_matrix().inverse() * xyz
}

/// Radiance's RGB to CIE XYZ: the inverse of [`xyz_to_rgb`].
pub fn rgb_to_xyz(rgb: Rgb) -> DVec3 {
    rgb_to_xyz_matrix() * rgb
}

fn rgb_to_xyz_matrix() -> DMat3 {
    let primary = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let primaries = DMat3::from_cols(primary(0.640, 0.330), primary(0.290, 0.600), primary(0.150, 0.060));
    let white = primary(1.0 / 3.0, 1.0 / 3.0);
    primaries * DMat3::from_diagonal(primaries.inverse() * white)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_keeps_its_luminance() {
        assert!((luminance_cd_m2(gray(1.0)) - 179.0).abs() < 1e-9);
        assert!((xyz_to_rgb(DVec3::splat(0.4)) - gray(0.4)).length() < 1e-12);
    }

    #[test]
    fn there_and_back_is_the_same_colour() {
        let rgb = DVec3::new(0.3, 0.01, 2.0);
        assert!((xyz_to_rgb(rgb_to_xyz(rgb)) - rgb).length() < 1e-12);
    }

    #[test]
    fn weights_follow_from_the_primaries() {
        // The second row of RGB -> XYZ is the luminance of each primary.
        let row = rgb_to_xyz_matrix().row(1);
        assert!((row - LUMINANCE_WEIGHTS).abs().max_element() < 1e-3, "{row}");
    }
}
