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
    pub fn brightness(&self, direction: Vec3) -> f64 {
        match *self {
            Self::Cie { kind, zenith, ground, normalization, sun } => {
                mix_at_horizon(zenith * cie_shape(kind, direction, sun, normalization), ground, direction.z)
            }
            Self::Perez { normalization, ground, coefficients, sun } => mix_at_horizon(
                normalization * perez_shape(&coefficients, direction, sun),
                ground,
                direction.z,
            ),
        }
    }

    /// The same with every brightness multiplied by `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Cie { kind, zenith, ground, normalization, sun } => {
                Self::Cie { kind, zenith: zenith * factor, ground: ground * factor, normalization, sun }
            }
            Self::Perez { normalization, ground, coefficients, sun } => Self::Perez {
                normalization: normalization * factor,
                ground: ground * factor,
                coefficients,
                sun,
            },
        }
    }
}

/// `wmean((Dz+1.01)^10, sky, (Dz+1.01)^-10, ground)`: both files blend sky and ground near the horizon, also above it.
fn mix_at_horizon(sky: f64, ground: f64, dz: f64) -> f64 {
    let share = sky_share(dz);
    // Far below the horizon the sky's formula may be infinite; its share is then zero.
    if share > 0.0 { share * sky + (1.0 - share) * ground } else { ground }
}

/// Weight of the sky in the blend of sky and ground, as both files have it.
pub(crate) fn sky_share(dz: f64) -> f64 {
    // a/(a + 1/a) with a = (dz + 1.01)^10, written so that neither power overflows; the base is 0 at most by rounding.
    let squared = (dz + 1.01).max(0.0).powi(20);
    squared / (squared + 1.0)
}

/// Angle between two unit vectors given their cosine [rad], as `Acos` of `rayinit.cal`: clamped to its domain.
fn angle_of(cosine: f64) -> f64 {
    cosine.clamp(-1.0, 1.0).acos()
}

/// Brightness over zenith brightness in the CIE skies of `skybright.cal`.
fn cie_shape(kind: CieSky, direction: Vec3, sun: Vec3, normalization: f64) -> f64 {
    let cos_gamma = direction.dot(sun);
    match kind {
        CieSky::Clear => {
            let gamma = angle_of(cos_gamma);
            let indicatrix = 0.91 + 10.0 * (-3.0 * gamma).exp() + 0.45 * cos_gamma * cos_gamma;
            let gradation = if direction.z > 0.01 { 1.0 - (-0.32 / direction.z).exp() } else { 1.0 };
            indicatrix * gradation / normalization
        }
        CieSky::Overcast => (1.0 + 2.0 * direction.z) / 3.0,
        CieSky::Uniform => 1.0,
        CieSky::Intermediate => {
            let (gamma, sun_zenith, eta) = (angle_of(cos_gamma), angle_of(sun.z), angle_of(direction.z));
            let gradation =
                (1.35 * (5.631 - 3.59 * eta).sin() + 3.12) * (4.396 - 2.6 * sun_zenith).sin() + 6.37 - eta;
            let around_sun = (-0.563 * gamma * ((2.629 - eta) * (1.562 - sun_zenith) + 0.812)).exp();
            gradation / 2.326 * around_sun / normalization
        }
    }
}

/// Relative luminance of Perez et al. 1993, equation 1, as `perezlum.cal` has it: at and below 0.6 degrees of altitude
/// the gradation stays what it is there.
pub(crate) fn perez_shape(&[a, b, c, d, e]: &[f64; 5], direction: Vec3, sun: Vec3) -> f64 {
    let cos_gamma = direction.dot(sun);
    let gamma = angle_of(cos_gamma);
    let gradation = 1.0 + a * exp_or_zero(b / direction.z.max(0.01));
    gradation * (1.0 + c * exp_or_zero(d * gamma) + e * cos_gamma * cos_gamma)
}

/// `Exp` of `rayinit.cal`.
fn exp_or_zero(x: f64) -> f64 {
    if x < -100.0 { 0.0 } else { x.exp() }
}
