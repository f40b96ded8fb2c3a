//! Outlines of columns and cells: polygons on the unit disk, for drawing and for angular bounds.

use crate::table::{Cell, Columns, Table};
use glam::DVec2;
use std::f64::consts::PI;

impl Columns {
    /// The border of a column as `4 * edge_points` points of the unit disk, once around. A ring of an isotropic table gives its
    /// outer circle: the rings that come after it in order lie inside.
    pub fn outline(&self, column: usize, edge_points: usize) -> Vec<DVec2> {
        match self {
            Self::Radial { .. } => {
                let radius = self.point(column, [0.0, 0.5]).x;
                let n = 4 * edge_points.max(1);
                (0..n).map(|i| radius * DVec2::from_angle(2.0 * PI * i as f64 / n as f64)).collect()
            }
            _ => border(edge_points).map(|u| self.point(column, u)).collect(),
        }
    }

    /// Area of a column on the unit disk: its projected solid angle [sr].
    pub fn projected_solid_angle(&self, column: usize) -> f64 {
        match self {
            Self::Patches(basis) => basis.projected_solid_angle(column),
            Self::Square { side } => PI / (side * side) as f64,
            Self::Radial { .. } => {
                let radius = |u: f64| self.point(column, [u, 0.5]).x;
                PI * (radius(0.0).powi(2) - radius(1.0).powi(2))
            }
        }
    }
}

impl Table {
    /// The border of a cell, as [`Columns::outline`]; in an isotropic tree in the frame of [`Self::point`].
    pub fn outline(&self, cell: &Cell, edge_points: usize) -> Vec<DVec2> {
        border(edge_points).map(|u| self.point(cell, u)).collect()
    }
}

/// Once around the unit square.
fn border(edge_points: usize) -> impl Iterator<Item = [f64; 2]> {
    let n = edge_points.max(1);
    (0..4 * n).map(move |i| {
        let t = (i % n) as f64 / n as f64;
        match i / n {
            0 => [t, 0.0],
            1 => [1.0, t],
            2 => [1.0 - t, 1.0],
            _ => [0.0, 1.0 - t],
        }
    })
}

/// Angular bounds of an outline on the unit disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngularBounds {
    /// Least and largest angle from the normal [deg].
    pub theta_deg: [f64; 2],
    /// Azimuths [deg]: the first in [-180, 180), the second at most 360 more.
    pub phi_deg: [f64; 2],
}

impl AngularBounds {
    /// Of an outline; `middle` is a point inside it. An outline around the pole, or one that ends in it, reaches down to theta 0.
    pub fn of(outline: &[DVec2], middle: DVec2) -> Self {
        let theta = |r: f64| r.min(1.0).asin().to_degrees();
        let largest = outline.iter().map(|p| p.length()).fold(0.0, f64::max);
        // Azimuths against the middle's; around the pole they add up to a full turn.
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        let turn: f64 =
            edges.map(|(a, b)| if at_pole(*a) || at_pole(*b) { 0.0 } else { a.angle_to(*b) }).sum();
        if turn.abs() > PI || at_pole(middle) {
            return Self { theta_deg: [0.0, theta(largest)], phi_deg: [-180.0, 180.0] };
        }
        let least = outline.iter().map(|p| p.length()).fold(f64::INFINITY, f64::min);
        let own = middle.to_angle();
        let (low, high) = outline
            .iter()
            .filter(|p| !at_pole(**p))
            .map(|p| middle.angle_to(*p))
            .fold((0.0_f64, 0.0_f64), |(low, high), a| (low.min(a), high.max(a)));
        let phi_deg = [(own + low).to_degrees(), (own + high).to_degrees()];
        let shift = if phi_deg[0] < -180.0 { 360.0 } else { 0.0 };
        Self { theta_deg: [theta(least), theta(largest)], phi_deg: phi_deg.map(|p| p + shift) }
    }
}

/// Too close to the pole to have an azimuth.
fn at_pole(p: DVec2) -> bool {
    const NO_LENGTH: f64 = 1e-9;
    p.length() < NO_LENGTH
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::AngleBasis;
    use std::sync::Arc;

    /// Area of a polygon (shoelace formula).
    fn area(outline: &[DVec2]) -> f64 {
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        0.5 * edges.map(|(a, b)| a.perp_dot(*b)).sum::<f64>().abs()
    }

    #[test]
    fn outlines_have_the_area_of_their_columns() {
        let klems = Columns::Patches(Arc::new(AngleBasis::known("LBNL/Klems Full").unwrap()));
        for columns in [klems, Columns::Square { side: 8 }] {
            for column in 0..columns.len() {
                let (got, truth) =
                    (area(&columns.outline(column, 64)), columns.projected_solid_angle(column));
                assert!((got - truth).abs() < 1e-3 * truth, "{columns:?} {column}: {got} {truth}");
            }
        }
        let rings = Columns::Radial { side: 16 };
        let sum: f64 = (0..rings.len()).map(|c| rings.projected_solid_angle(c)).sum();
        assert!((sum - PI).abs() < 1e-12);
    }

    #[test]
    fn patches_have_the_bounds_that_klems_gave_them() {
        let basis = Arc::new(AngleBasis::known("LBNL/Klems Full").unwrap());
        let columns = Columns::Patches(basis.clone());
        let bounds = |c: usize| AngularBounds::of(&columns.outline(c, 8), columns.point(c, [0.5, 0.5]));
        let close = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6;
        assert!(close(bounds(0).theta_deg, [0.0, 5.0]) && close(bounds(0).phi_deg, [-180.0, 180.0]));
        for (patch, theta, phi) in [
            (1, [5.0, 15.0], [-22.5, 22.5]),
            (5, [5.0, 15.0], [157.5, 202.5]),
            (7, [5.0, 15.0], [-112.5, -67.5]),
            (144, [75.0, 90.0], [-45.0, -15.0]),
        ] {
            let found = bounds(patch);
            assert!(close(found.theta_deg, theta) && close(found.phi_deg, phi), "{patch}: {found:?}");
        }
    }

    #[test]
    fn squares_at_the_pole_reach_it() {
        let columns = Columns::Square { side: 2 };
        for column in 0..4 {
            let found = AngularBounds::of(&columns.outline(column, 8), columns.point(column, [0.5, 0.5]));
            assert!(found.theta_deg[0].abs() < 1e-6 && (found.theta_deg[1] - 90.0).abs() < 1e-6, "{found:?}");
            assert!((found.phi_deg[1] - found.phi_deg[0] - 90.0).abs() < 1e-6, "{found:?}");
        }
    }
}
