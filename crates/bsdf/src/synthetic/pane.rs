//! A pane of glass.

use super::product::Product;
use glam::DVec2;

/// A plane pane: all of it goes straight. Fresnel's equations for both polarisations, all orders of reflection between the
/// faces, absorption along the refracted path (Born and Wolf, Principles of Optics, 1.5.2 and 14.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    /// Refractive index [-].
    pub index: f64,
    /// Transmittance of the material at normal incidence, without the faces [-]: 1 for clear glass.
    pub internal: f64,
}

impl Product for Pane {
    fn name(&self) -> String {
        format!("Sunpeak pane, index {}, internal transmittance {}", self.index, self.internal)
    }

    fn through(&self, p_in: DVec2) -> f64 {
        let sine = p_in.length().min(1.0);
        let (cosine, inside) = ((1.0 - sine * sine).sqrt(), (1.0 - (sine / self.index).powi(2)).sqrt());
        let absorbed = self.internal.powf(1.0 / inside);
        let reflected = [
            (cosine - self.index * inside) / (cosine + self.index * inside),
            (self.index * cosine - inside) / (self.index * cosine + inside),
        ];
        let each = reflected.map(|amplitude| {
            let r = amplitude * amplitude;
            (1.0 - r).powi(2) * absorbed / (1.0 - (r * absorbed).powi(2))
        });
        0.5 * (each[0] + each[1])
    }

    fn smooth(&self, _p_in: DVec2, _p_out: DVec2) -> f64 {
        0.0
    }

    fn reflectance(&self) -> [f64; 2] {
        [0.0; 2]
    }
}
