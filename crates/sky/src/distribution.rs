//! Brightness of sky and ground over direction, as `skybright.cal` and `perezlum.cal` define it.

use sunpeak_core::Vec3;

/// The four skies of `skybright.cal` (gensky).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CieSky {
    /// CIE clear.
    Clear,
    /// CIE overcast.
    Overcast,
    /// Uniform.
    Uniform,
    /// CIE intermediate.
    Intermediate,
}

/// A function of direction: brightness [W sr⁻¹ m⁻²], sky above and ground below the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyDistribution {
    /// `skybright.cal`: A1 … A7.
    Cie {
        /// A1.
        kind: CieSky,
        /// A2: zenith brightness.
        zenith: f64,
        /// A3: ground plane brightness.
        ground: f64,
        /// A4: normalisation by the sun's direction.
        normalization: f64,
        /// A5 to A7: direction to the sun.
        sun: Vec3,
    },
    /// `perezlum.cal`: A1 … A10.
    Perez {
        /// A1: diffuse normalisation.
        normalization: f64,
        /// A2: ground brightness.
        ground: f64,
        /// A3 to A7: coefficients a to e of Perez et al. 1993, equation 1.
        coefficients: [f64; 5],
        /// A8 to A10: direction to the sun.
        sun: Vec3,
    },
}

impl SkyDistribution {
    /// Brightness [W sr⁻¹ m⁻²] towards the unit vector `direction`.
    pub fn brightness(&self, _direction: Vec3) -> f64 {
        0.0
    }
}
