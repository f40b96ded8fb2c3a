//! Convex polygons in a quadrant of the unit disk, in coordinates in which the cells of every basis have straight edges.
//!
//! In the quadrant around the azimuth k·90°, a point of radius r and azimuth phi has rho = r and s = r·t, with t = (phi - k·90°)/45°
//! from -1 to 1: the map of Shirley and Chiu (1997) without its turn. Areas are those of the disk times 4/pi. Cells of tensor trees
//! are rectangles here, rings and azimuths of matrix bases strips and rays; a turn of the disk is a shear.

use glam::DVec2;
use std::f64::consts::FRAC_PI_4;

/// Most corners: a cell's four, and one for each of up to six cuts.
const MOST: usize = 12;

/// Areas below this [of the square of side 2] are rounding.
const NOTHING: f64 = 1e-15;

/// A convex polygon in a quadrant: x is rho, y is s.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    /// 0 to 3: around the azimuths 0, 90, 180 and 270 degrees.
    pub quadrant: usize,
    count: usize,
    corners: [DVec2; MOST],
}

impl Polygon {
    /// From its corners, in order; anything but three to twelve of them is empty.
    pub fn new(quadrant: usize, corners: &[DVec2]) -> Self {
        let mut polygon = Self { quadrant: quadrant % 4, count: 0, corners: [DVec2::ZERO; MOST] };
        corners.iter().for_each(|&c| polygon.push(c));
        polygon
    }

    fn push(&mut self, corner: DVec2) {
        if self.count < MOST {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Between two radii and two azimuths t of the quadrant.
    pub fn sector(quadrant: usize, [r0, r1]: [f64; 2], [t0, t1]: [f64; 2]) -> Self {
        let corner = |r: f64, t: f64| DVec2::new(r, r * t);
        Self::new(quadrant, &[corner(r0, t0), corner(r1, t0), corner(r1, t1), corner(r0, t1)])
    }

    fn corners(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }

    /// Nothing is left?
    pub fn is_empty(&self) -> bool {
        self.count < 3 || self.area() <= NOTHING
    }

    /// Area on the unit disk: projected solid angle [sr].
    pub fn projected_solid_angle(&self) -> f64 {
        FRAC_PI_4 * self.area()
    }

    fn area(&self) -> f64 {
        let corners = self.corners();
        let Some(&first) = corners.first() else { return 0.0 };
        let fan = corners.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first));
        0.5 * fan.sum::<f64>().abs()
    }

    /// What lies where `normal . x <= bound`.
    pub fn clipped(&self, normal: DVec2, bound: f64) -> Self {
        let mut left = Self { count: 0, ..*self };
        let corners = self.corners();
        let Some(&last) = corners.last() else { return left };
        let mut before = (last, normal.dot(last) - bound);
        for &corner in corners {
            let here = (corner, normal.dot(corner) - bound);
            if (before.1 < 0.0 && here.1 > 0.0) || (before.1 > 0.0 && here.1 < 0.0) {
                left.push(before.0.lerp(here.0, before.1 / (before.1 - here.1)));
            }
            if here.1 <= 0.0 {
                left.push(corner);
            }
            before = here;
        }
        left
    }

    /// What lies between two bounds of a coordinate.
    pub fn between(&self, axis: DVec2, [low, high]: [f64; 2]) -> Self {
        self.clipped(-axis, -low).clipped(axis, high)
    }

    /// What lies between two azimuths t of the quadrant.
    pub fn between_azimuths(&self, [t0, t1]: [f64; 2]) -> Self {
        self.clipped(DVec2::new(t0, -1.0), 0.0).clipped(DVec2::new(-t1, 1.0), 0.0)
    }

    /// Least and largest of a coordinate.
    pub fn range(&self, coordinate: impl Fn(DVec2) -> f64) -> [f64; 2] {
        let values = self.corners().iter().map(|&c| coordinate(c));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    }

    /// Turned by an angle [rad], counterclockwise: the pieces in the quadrants that it then lies in.
    pub fn turned(&self, angle: f64) -> Vec<Self> {
        let shift = angle / FRAC_PI_4;
        let first = ((shift - 2.0) / 2.0).floor() as i64;
        let mut pieces = Vec::with_capacity(2);
        for quarters in first..=first + 3 {
            // Azimuths against the middle of the quadrant `quarters` further on.
            let shear = shift - 2.0 * quarters as f64;
            if shear.abs() >= 2.0 {
                continue;
            }
            let quadrant = (self.quadrant as i64 + quarters).rem_euclid(4) as usize;
            let mut sheared = Self { quadrant, ..*self };
            sheared.corners.iter_mut().for_each(|c| c.y += shear * c.x);
            pieces.push(sheared.between_azimuths([-1.0, 1.0]));
        }
        pieces.retain(|p| !p.is_empty());
        pieces
    }

    /// Mirrored: azimuth 180° - phi if `x`, else -phi.
    pub fn mirrored(&self, x: bool) -> Self {
        let turn = if x { 6 } else { 4 };
        let mut mirrored = Self { quadrant: (turn - self.quadrant) % 4, ..*self };
        mirrored.corners.iter_mut().for_each(|c| c.y = -c.y);
        mirrored
    }
}
