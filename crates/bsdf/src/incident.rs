//! Where the columns of a table lie for the rays that meet it.

use crate::{
    bsdf::{Bsdf, Mode},
    distribution::Distribution,
    outline::AngularBounds,
    proposal::Oriented,
    table::Columns,
};
use glam::DVec2;
use sunpeak_core::Vec3;

/// Points an edge of a column that bound it.
const EDGE_POINTS: usize = 16;

/// One column as rays meet it: theta from the front normal (above 90 from behind), phi the azimuth from x towards which the ray
/// runs, opposite to that of `w_in`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incident {
    /// Number of the column in the table.
    pub column: usize,
    /// Middle of the column: the side of the traced ray.
    pub w_in: Vec3,
    /// Angle of the middle from the front normal [deg].
    pub theta_deg: f64,
    /// Azimuth of the middle [deg] from 0 to 360; 0 where all azimuths belong to the column.
    pub phi_deg: f64,
    /// Least and largest theta [deg].
    pub theta_bounds_deg: [f64; 2],
    /// Azimuths [deg], around `phi_deg`.
    pub phi_bounds_deg: [f64; 2],
    /// Projected solid angle of the column [sr].
    pub projected_solid_angle: f64,
}

impl Incident {
    /// A column for rays that meet the frame's front (`front`) or back. `reversed`: against the table, as in [`Oriented`].
    pub fn of(distribution: &Distribution, column: usize, front: bool, reversed: bool) -> Self {
        let columns = distribution.columns();
        // A table's incident point is minus the ray's; against the table it is the ray's own.
        let sign = if reversed { 1.0 } else { -1.0 };
        let toward = -sign * middle(columns, column);
        let outline: Vec<DVec2> =
            columns.outline(column, EDGE_POINTS).into_iter().map(|p| -sign * p).collect();
        let isotropic = distribution.luminous().is_isotropic();
        let bounds = if isotropic {
            let radius = |u: f64| columns.point(column, [u, 0.5]).x.min(1.0).asin().to_degrees();
            AngularBounds { theta_deg: [radius(1.0), radius(0.0)], phi_deg: [-180.0, 180.0] }
        } else {
            AngularBounds::of(&outline, toward)
        };
        let full_turn = bounds.phi_deg[1] - bounds.phi_deg[0] >= 360.0;
        let toward = if isotropic { DVec2::new(toward.length(), 0.0) } else { toward };
        let theta = toward.length().min(1.0).asin().to_degrees();
        let [near, far] = bounds.theta_deg;
        let phi = toward.to_angle().to_degrees();
        let shift = if full_turn {
            180.0
        } else if phi < 0.0 {
            360.0
        } else {
            0.0
        };
        // The azimuths of the bounds were counted from their own start.
        let turns = if full_turn { 0.0 } else { ((bounds.phi_deg[0] - phi) / 360.0).round() * 360.0 };
        let height = (1.0 - toward.length_squared()).max(0.0).sqrt();
        Self {
            column,
            w_in: (-toward).extend(if front { height } else { -height }),
            theta_deg: if front { theta } else { 180.0 - theta },
            phi_deg: if full_turn { 0.0 } else { phi + shift },
            theta_bounds_deg: if front { [near, far] } else { [180.0 - far, 180.0 - near] },
            phi_bounds_deg: bounds.phi_deg.map(|p| p - turns + shift),
            projected_solid_angle: columns.projected_solid_angle(column),
        }
    }

    /// Column by column, as an oriented table is met from a side.
    pub fn all(oriented: &Oriented, front: bool) -> Vec<Self> {
        let d = &oriented.distribution;
        (0..d.columns().len()).map(|c| Self::of(d, c, front, oriented.reversed)).collect()
    }
}

/// Middle of a column as the field has it: of a patch halfway between its angles (Klems 1994), of other cells halfway between their
/// coordinates.
fn middle(columns: &Columns, column: usize) -> DVec2 {
    let middle = columns.point(column, [0.5, 0.5]);
    match columns {
        Columns::Patches(basis) => {
            let (ring, _) = basis.ring_of(column);
            let theta_deg = 0.5 * (ring.lower_theta_deg + ring.upper_theta_deg);
            middle.normalize_or_zero() * theta_deg.to_radians().sin()
        }
        _ => middle,
    }
}

impl Bsdf {
    /// The columns of transmission that rays meet at the front or at the back.
    pub fn incident_columns(&self, front: bool) -> Vec<Incident> {
        let w_in = if front { Vec3::Z } else { -Vec3::Z };
        self.distribution(w_in, Mode::Transmission).map_or(Vec::new(), |o| Incident::all(o, front))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Fabric;

    #[test]
    fn the_middle_of_a_column_leads_to_it_within_its_bounds() {
        for name in ["klems", "klems-quarter", "t3-256", "t4-64"] {
            let bsdf = Fabric::default().tabulate(name.parse().unwrap()).unwrap();
            for front in [true, false] {
                let all = bsdf.incident_columns(front);
                let sum: f64 = all.iter().map(|c| c.projected_solid_angle).sum();
                assert!((sum - std::f64::consts::PI).abs() < 1e-9, "{name}");
                for c in all {
                    let o = bsdf.distribution(c.w_in, Mode::Transmission).unwrap();
                    let (a, _) = o.points(-c.w_in.truncate(), -c.w_in.truncate());
                    assert_eq!(o.distribution.columns().index(a), c.column, "{name} {c:?}");
                    let inside = |v: f64, [low, high]: [f64; 2]| low - 1e-9 <= v && v <= high + 1e-9;
                    assert!(inside(c.theta_deg, c.theta_bounds_deg), "{name} {c:?}");
                    assert!(inside(c.phi_deg, c.phi_bounds_deg), "{name} {c:?}");
                    assert!((c.w_in.z.acos().to_degrees() - c.theta_deg).abs() < 1e-6, "{name} {c:?}");
                }
            }
        }
    }
}
