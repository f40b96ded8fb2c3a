//! What is known of a measurement, beside its tables.

use super::{
    field::Coverage,
    scan::{Incidence, Kind, SAME},
    specular::Straight,
    symmetry::Symmetry,
};

/// One incidence as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct IncidenceReport {
    /// Angle of incidence from the normal of the side that the light meets [deg].
    pub theta_deg: f64,
    /// Azimuth of the direction to the light, from x [deg].
    pub phi_deg: f64,
    /// Readings.
    pub readings: usize,
    /// What goes straight, where it was looked for.
    pub straight: Option<Straight>,
    /// Hemispherical value of what is scattered [-].
    pub scattered: f64,
    /// Where readings are missing.
    pub coverage: Coverage,
}

impl IncidenceReport {
    /// After its peak was taken out.
    pub fn new(
        incidence: &Incidence,
        straight: Option<Straight>,
        scattered: f64,
        coverage: Coverage,
    ) -> Self {
        Self {
            theta_deg: incidence.theta_deg(),
            phi_deg: (-incidence.p.y).atan2(-incidence.p.x).to_degrees().rem_euclid(360.0),
            readings: incidence.points.len(),
            straight,
            scattered,
            coverage,
        }
    }

    /// What goes straight through [-].
    pub fn through(&self) -> f64 {
        self.straight.map_or(0.0, Straight::through)
    }
}

/// One side and mode.
#[derive(Clone, Debug, PartialEq)]
pub struct KindReport {
    /// Which.
    pub kind: Kind,
    /// As it was asked for or found.
    pub symmetry: Symmetry,
    /// The incidences that were measured; those mirrored from them are left out.
    pub incidences: Vec<IncidenceReport>,
}

impl KindReport {
    /// From the reports on all incidences, mirrored ones too.
    pub fn new(kind: Kind, symmetry: Symmetry, measured: &[Incidence], all: Vec<IncidenceReport>) -> Self {
        let own = |report: &IncidenceReport| {
            let sine = report.theta_deg.to_radians().sin();
            let is_at = |incidence: &Incidence| {
                let off =
                    (-incidence.p).distance(glam::DVec2::from_angle(report.phi_deg.to_radians()) * sine);
                symmetry == Symmetry::Isotropic || off < 2.0 * SAME
            };
            measured.iter().any(is_at)
        };
        let mut incidences: Vec<IncidenceReport> = all.into_iter().filter(own).collect();
        incidences.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg).then(a.phi_deg.total_cmp(&b.phi_deg)));
        Self { kind, symmetry, incidences }
    }
}
