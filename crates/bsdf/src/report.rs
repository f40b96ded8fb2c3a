//! What a BSDF is and does: resolution, energy, reciprocity, and what peak extraction makes of it.
//!
//! Numbers only; the words are the caller's. An incidence is a ray: it comes down at theta from a normal and runs towards the
//! azimuth phi from x, so that `w_in` has the azimuth phi + 180 degrees.

mod peak;
mod reciprocity;

pub use peak::{Contrast, PeakReport, THROUGH_AZIMUTHS, THROUGH_STEP_DEG, ThroughReport};
pub use reciprocity::{Compared, Reciprocity};

use crate::{
    bsdf::{Bsdf, Mode},
    incident::Incident,
    peak::PeakRule,
    table::Table,
};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Vec3, luminance, warp::square_to_disk};

/// Angles of incidence [deg] at which hemispherical values are given.
pub const HEMISPHERICAL_THETA_DEG: [f64; 9] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];

/// Azimuths over which means are taken: every 5 degrees, beside the borders of cells that lie at multiples of 2.5.
const AZIMUTHS: usize = 72;
const OFF_BORDER_DEG: f64 = 1.1;

/// A report on a BSDF.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What rays meet.
    pub tables: Vec<TableReport>,
    /// Front, back.
    pub sides: Vec<SideReport>,
    /// Smooth parts and peaks, one direction against the other.
    pub reciprocity: Vec<Reciprocity>,
    /// Peak extraction by the split; one for each side that transmits.
    pub peaks: Vec<PeakReport>,
}

/// One table as rays meet it.
#[derive(Clone, Debug, PartialEq)]
pub struct TableReport {
    /// Reflection or transmission.
    pub mode: Mode,
    /// Met by rays at the frame's front.
    pub front: bool,
    /// Name of the basis.
    pub basis: String,
    /// Incident cells, the finest division.
    pub columns: usize,
    /// Number of values.
    pub values: usize,
    /// Smallest projected solid angle [sr].
    pub smallest_cell_sr: f64,
    /// Width of the smallest exiting cell [deg]: the square root of its solid angle.
    pub smallest_cell_deg: f64,
    /// The same for all azimuths of incidence.
    pub isotropic: bool,
    /// Has CIE X and Z.
    pub colored: bool,
    /// Serves this side by reciprocity: the table is the other side's.
    pub by_reciprocity: bool,
}

/// Hemispherical values of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct SideReport {
    /// Rays meet the frame's front.
    pub front: bool,
    /// By angle of incidence.
    pub angles: Vec<HemisphericalReport>,
    /// Largest transmittance plus reflectance [-].
    pub largest_sum: f64,
    /// Where: theta from the front normal, phi [deg].
    pub largest_sum_at_deg: [f64; 2],
    /// Share of the incidences (by projected solid angle) where the sum is above 1.
    pub share_above_one: f64,
    /// Sums over the table's own cells; a tree that is met by reciprocity is summed over points.
    pub exact: bool,
}

/// At one angle of incidence: means over azimuth, and their range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HemisphericalReport {
    /// Angle from this side's normal [deg].
    pub theta_deg: f64,
    /// Hemispherical transmittance [-], peak included.
    pub transmittance: Range,
    /// Hemispherical reflectance [-].
    pub reflectance: Range,
}

/// Mean, least and largest of some values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// Mean.
    pub mean: f64,
    /// Least.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

impl Range {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut n, mut min, mut max) = (0.0, 0.0, f64::INFINITY, f64::NEG_INFINITY);
        for v in values {
            (sum, n, min, max) = (sum + v, n + 1.0, min.min(v), max.max(v));
        }
        if n > 0.0 { Self { mean: sum / n, min, max } } else { Self::default() }
    }
}

/// `w_in` of the ray that comes down on a side at theta from its normal and runs towards phi [deg].
fn on_side(front: bool, theta_deg: f64, phi_deg: f64) -> Vec3 {
    let ((st, ct), (sp, cp)) = (theta_deg.to_radians().sin_cos(), phi_deg.to_radians().sin_cos());
    Vec3::new(-st * cp, -st * sp, if front { ct } else { -ct })
}

/// Theta from the front normal and azimuth from x, 0 to 360 [deg], of a direction.
fn angles(w: Vec3) -> [f64; 2] {
    let theta = w.z.clamp(-1.0, 1.0).acos().to_degrees();
    let azimuth = w.truncate().to_angle().to_degrees().rem_euclid(360.0);
    [theta, if w.truncate().length() > 0.0 { azimuth } else { 0.0 }]
}

/// Theta and phi [deg] of an incidence.
fn incidence(w_in: Vec3) -> [f64; 2] {
    let [theta, azimuth] = angles(w_in);
    [theta, (azimuth + 180.0).rem_euclid(360.0)]
}

fn azimuths() -> impl Iterator<Item = f64> {
    (0..AZIMUTHS).map(|i| OFF_BORDER_DEG + 360.0 * i as f64 / AZIMUTHS as f64)
}

impl Bsdf {
    /// Look at all of it. Takes one pass over the tables, and makes what sampling needs.
    pub fn report(&self) -> Report {
        let sides = [true, false];
        let tables = [Mode::Transmission, Mode::Reflection]
            .into_iter()
            .flat_map(|mode| sides.into_iter().filter_map(move |front| self.table_report(mode, front)));
        Report {
            tables: tables.collect(),
            sides: sides.map(|front| self.side_report(front)).to_vec(),
            reciprocity: self.reciprocity(),
            peaks: sides.into_iter().filter_map(|front| self.peak_report(front)).collect(),
        }
    }

    fn table_report(&self, mode: Mode, front: bool) -> Option<TableReport> {
        let oriented = self.distribution(on_side(front, 0.0, 0.0), mode)?;
        let d = &oriented.distribution;
        let table = d.luminous();
        Some(TableReport {
            mode,
            front,
            basis: table.basis_name(),
            columns: d.columns().len(),
            values: table.values().len(),
            smallest_cell_sr: d.smallest_projected_solid_angle(),
            smallest_cell_deg: smallest_cell(table).sqrt().to_degrees(),
            isotropic: table.is_isotropic(),
            colored: d.color().is_some(),
            by_reciprocity: mode == Mode::Transmission && oriented.reversed,
        })
    }

    fn hemispherical_luminous(&self, w_in: Vec3, mode: Mode) -> f64 {
        luminance(self.hemispherical_smooth(w_in, mode, PeakRule::Off))
    }

    fn side_report(&self, front: bool) -> SideReport {
        let at = |theta_deg: f64, mode: Mode| {
            Range::of(azimuths().map(|phi| self.hemispherical_luminous(on_side(front, theta_deg, phi), mode)))
        };
        let angles_of = HEMISPHERICAL_THETA_DEG.map(|theta_deg| HemisphericalReport {
            theta_deg,
            transmittance: at(theta_deg, Mode::Transmission),
            reflectance: at(theta_deg, Mode::Reflection),
        });
        let (mut largest, mut place, mut above, mut all) = (0.0, Vec3::Z, 0.0, 0.0);
        for incident in self.incidences(front) {
            let sum = [Mode::Transmission, Mode::Reflection]
                .map(|mode| self.hemispherical_luminous(incident.w_in, mode))
                .iter()
                .sum::<f64>();
            if sum > largest {
                (largest, place) = (sum, incident.w_in);
            }
            all += incident.projected_solid_angle;
            above += if sum > 1.0 { incident.projected_solid_angle } else { 0.0 };
        }
        SideReport {
            front,
            angles: angles_of.to_vec(),
            largest_sum: largest,
            largest_sum_at_deg: incidence(place),
            share_above_one: if all > 0.0 { above / all } else { 0.0 },
            exact: self
                .distribution(on_side(front, 0.0, 0.0), Mode::Transmission)
                .is_none_or(|o| !o.reversed || matches!(o.distribution.luminous(), Table::Matrix(_))),
        }
    }

    /// Columns of transmission and of reflection on a side.
    fn incidences(&self, front: bool) -> Vec<Incident> {
        let w_in = on_side(front, 0.0, 0.0);
        let of = |mode| self.distribution(w_in, mode).map_or(Vec::new(), |o| Incident::all(o, front));
        let mut all = of(Mode::Transmission);
        all.extend(of(Mode::Reflection));
        all
    }
}

/// Solid angle [sr] of the smallest exiting cell.
fn smallest_cell(table: &Table) -> f64 {
    let mut smallest = f64::INFINITY;
    match table {
        Table::Matrix(m) => {
            let cosine = |deg: f64| deg.to_radians().cos();
            for ring in m.exiting.rings() {
                let whole = 2.0 * PI * (cosine(ring.lower_theta_deg) - cosine(ring.upper_theta_deg));
                smallest = smallest.min(whole / ring.phi_count as f64);
            }
        }
        Table::Tree(tree) => {
            let d = tree.rank() - 2;
            tree.for_each_leaf(|leaf| {
                let middle = [d, d + 1].map(|k| leaf.corner[k] + 0.5 * leaf.size);
                let height = (1.0 - DVec2::from(square_to_disk(middle)).length_squared()).sqrt();
                smallest = smallest.min(PI * leaf.size * leaf.size / height);
            });
        }
    }
    smallest
}
