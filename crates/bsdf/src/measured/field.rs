//! The readings of one incidence as a function on the disk: linear between neighbours, constant beyond the last ones.

use super::scan::{Incidence, Points};
use delaunator::{EMPTY, Point, Triangulation, triangulate};
use glam::DVec2;
use std::collections::BTreeMap;
use sunpeak_core::{Error, Result, Vec3, warp::square_to_disk};

/// Cells a side of the square on which the function is known: 0.2 degrees at normal incidence.
pub const SIDE: usize = 512;

/// Readings closer than this on the disk are one.
const SAME: f64 = 1e-5;

/// BSDF [1/sr] at the middles of `SIDE * SIDE` cells of equal projected solid angle; `[i * SIDE + j]` is at `[i, j]` of the square.
#[derive(Clone, Debug)]
pub struct Field(pub Vec<f64>);

/// Where readings are, and where not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Largest angle of exit from the surface's normal [deg].
    pub largest_exit_deg: f64,
    /// Half the width of the largest hole between readings [deg].
    pub hole_deg: f64,
    /// Its middle, as a point of the disk.
    pub hole: DVec2,
}

impl Coverage {
    /// Angle of the hole's middle from the normal of the side on which light leaves [deg].
    pub fn hole_exit_deg(&self) -> f64 {
        self.hole.length().min(1.0).asin().to_degrees()
    }

    /// Azimuth of the hole's middle from x [deg].
    pub fn hole_phi_deg(&self) -> f64 {
        self.hole.y.atan2(self.hole.x).to_degrees().rem_euclid(360.0)
    }
}

/// The middle of a cell.
pub fn middle(i: usize, j: usize) -> DVec2 {
    let at = |k: usize| (k as f64 + 0.5) / SIDE as f64;
    square_to_disk([at(i), at(j)]).into()
}

/// Triangles between readings.
struct Net {
    points: Points,
    mesh: Triangulation,
}

impl Net {
    fn of(incidence: &Incidence) -> Result<Self> {
        let points = distinct(&incidence.points);
        let corners: Vec<Point> = points.iter().map(|(q, _)| Point { x: q.x, y: q.y }).collect();
        let mesh = triangulate(&corners);
        if mesh.triangles.is_empty() {
            return Err(Error::value(format!(
                "the {} readings at {:.2} degrees of incidence lie in one plane; expected readings over the hemisphere",
                incidence.points.len(),
                incidence.theta_deg()
            )));
        }
        Ok(Self { points, mesh })
    }

    fn corners(&self, triangle: usize) -> [(DVec2, f64); 3] {
        [0, 1, 2].map(|k| self.points[self.mesh.triangles[3 * triangle + k]])
    }

    /// The triangle at a point, from one nearby; none outside of all.
    fn walk(&self, mut triangle: usize, q: DVec2) -> Option<(usize, [f64; 3])> {
        for _ in 0..self.mesh.triangles.len() {
            let [a, b, c] = self.corners(triangle).map(|(p, _)| p);
            let weights = barycentric(q, [a, b, c]);
            let least = (0..3).min_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0);
            if weights[least] >= -1e-9 {
                return Some((triangle, weights));
            }
            // The edge across from a corner begins at the next one.
            let across = self.mesh.halfedges[3 * triangle + (least + 1) % 3];
            if across == EMPTY {
                return None;
            }
            triangle = across / 3;
        }
        None
    }

    fn coverage(&self) -> Coverage {
        let largest = self.points.iter().map(|(q, _)| q.length()).fold(0.0, f64::max).min(1.0);
        let mut found =
            Coverage { largest_exit_deg: largest.asin().to_degrees(), hole_deg: 0.0, hole: DVec2::ZERO };
        for triangle in 0..self.mesh.triangles.len() / 3 {
            let corners = self.corners(triangle).map(|(q, _)| q);
            let Some(center) = circumcenter(corners).filter(|c| c.length() < largest) else { continue };
            let half = lifted(center).dot(lifted(corners[0])).clamp(-1.0, 1.0).acos().to_degrees();
            if half > found.hole_deg {
                (found.hole_deg, found.hole) = (half, center);
            }
        }
        found
    }
}

/// The function on the square, and where it is known by readings.
pub fn field(incidence: &Incidence) -> Result<(Field, Coverage)> {
    let net = Net::of(incidence)?;
    let mut values: Vec<Option<f64>> = vec![None; SIDE * SIDE];
    let mut triangle = 0;
    for i in 0..SIDE {
        for step in 0..SIDE {
            // Back and forth, so that the next triangle is near.
            let j = if i % 2 == 0 { step } else { SIDE - 1 - step };
            if let Some((found, weights)) = net.walk(triangle, middle(i, j)) {
                triangle = found;
                let corners = net.corners(found);
                values[i * SIDE + j] = Some((0..3).map(|k| weights[k] * corners[k].1).sum::<f64>().max(0.0));
            }
        }
    }
    Ok((Field(filled(values)), net.coverage()))
}

/// Readings at the same place by their mean.
fn distinct(points: &Points) -> Points {
    let mut known: BTreeMap<[i64; 2], (DVec2, f64, f64)> = BTreeMap::new();
    for &(q, value) in points {
        let entry = known.entry((q / SAME).to_array().map(|v| v.round() as i64)).or_insert((q, 0.0, 0.0));
        entry.1 += value;
        entry.2 += 1.0;
    }
    known.into_values().map(|(q, sum, count)| (q, sum / count)).collect()
}

/// Weights of the corners at a point; they add up to 1.
pub fn barycentric(q: DVec2, [a, b, c]: [DVec2; 3]) -> [f64; 3] {
    let whole = (b - a).perp_dot(c - a);
    let (at_b, at_c) = ((q - a).perp_dot(c - a) / whole, (b - a).perp_dot(q - a) / whole);
    [1.0 - at_b - at_c, at_b, at_c]
}

fn circumcenter([a, b, c]: [DVec2; 3]) -> Option<DVec2> {
    let (u, v) = (b - a, c - a);
    let twice = 2.0 * u.perp_dot(v);
    let center = a + (v.perp() * u.length_squared() - u.perp() * v.length_squared()) / -twice;
    center.is_finite().then_some(center)
}

fn lifted(q: DVec2) -> Vec3 {
    q.extend((1.0 - q.length_squared()).max(0.0).sqrt())
}

/// Cells without a value take the mean of their neighbours that have one, ring by ring.
fn filled(mut values: Vec<Option<f64>>) -> Vec<f64> {
    let neighbours = |at: usize| {
        let (i, j) = (at / SIDE, at % SIDE);
        let steps = [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)];
        steps.into_iter().filter(|&(i, j)| i < SIDE && j < SIDE).map(|(i, j)| i * SIDE + j)
    };
    let mut missing: Vec<usize> = (0..values.len()).filter(|&at| values[at].is_none()).collect();
    while !missing.is_empty() {
        let ring: Vec<(usize, f64)> = missing
            .iter()
            .filter_map(|&at| {
                let known: Vec<f64> = neighbours(at).filter_map(|n| values[n]).collect();
                (!known.is_empty()).then(|| (at, known.iter().sum::<f64>() / known.len() as f64))
            })
            .collect();
        if ring.is_empty() {
            break;
        }
        ring.iter().for_each(|&(at, value)| values[at] = Some(value));
        missing.retain(|&at| values[at].is_none());
    }
    values.into_iter().map(|value| value.unwrap_or(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::warp::disk_to_square;

    /// The cell of a point.
    fn cell(q: DVec2) -> usize {
        let [x, y] = disk_to_square(q.into());
        let at = |v: f64| ((v * SIDE as f64) as usize).min(SIDE - 1);
        at(x) * SIDE + at(y)
    }

    /// Readings on rings, but for a hole.
    fn rings(value: impl Fn(DVec2) -> f64, hole: impl Fn(DVec2) -> bool) -> Incidence {
        let at = |r: usize, k: usize| {
            DVec2::from_angle(k as f64 * std::f64::consts::TAU / 72.0) * (r as f64 / 40.0)
        };
        let all = (0..39).flat_map(|r| (0..if r == 0 { 1 } else { 72 }).map(move |k| at(r, k)));
        Incidence { p: DVec2::ZERO, points: all.filter(|&q| !hole(q)).map(|q| (q, value(q))).collect() }
    }

    #[test]
    fn a_plane_is_met_exactly_between_readings_and_kept_constant_beyond() {
        let plane = |q: DVec2| 2.0 + q.x - 0.5 * q.y;
        let (field, coverage) = field(&rings(plane, |_| false)).unwrap();
        for q in [DVec2::new(0.1, 0.2), DVec2::new(-0.6, 0.5), DVec2::new(0.0, -0.9)] {
            let at = cell(q);
            let there = middle(at / SIDE, at % SIDE);
            assert!((field.0[at] - plane(there)).abs() < 1e-9);
        }
        assert!((field.0[cell(DVec2::new(0.9999, 0.0))] - plane(DVec2::new(0.95, 0.0))).abs() < 0.02);
        assert!((coverage.largest_exit_deg - 0.95_f64.asin().to_degrees()).abs() < 1e-9);
    }

    #[test]
    fn a_shadow_of_the_instrument_is_found() {
        let middle = DVec2::new(-0.5, 0.1);
        let (_, coverage) = field(&rings(|_| 1.0, |q| q.distance(middle) < 0.2)).unwrap();
        assert!(coverage.hole.distance(middle) < 0.05, "{coverage:?}");
        // The disk foreshortens: 0.2 there is 12 to 16 degrees.
        assert!(coverage.hole_deg > 11.0 && coverage.hole_deg < 17.0, "{coverage:?}");
    }

    #[test]
    fn readings_in_one_plane_are_refused() {
        let line = Incidence {
            p: DVec2::ZERO,
            points: (0..20).map(|k| (DVec2::X * (k as f64 / 25.0), 1.0)).collect(),
        };
        assert!(field(&line).unwrap_err().to_string().contains("in one plane"));
    }
}
