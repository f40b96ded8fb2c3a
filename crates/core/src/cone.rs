//! Cones of directions.

use crate::{Frame, Vec3, cone_solid_angle, warp};
use std::f64::consts::PI;

/// Cones are closed: a ray along the horizon, between a sky and a ground of 180 degrees each, sees one of them whatever rounding
/// does to it.
const EDGE: f64 = 1e-9;

/// What comes so near to it [rad] may touch it: more than arc cosines lose at the poles.
const NEAR_EDGE: f64 = 1e-6;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    frame: Frame,
    angle_deg: f64,
    /// 1 - cos of half the angle, which keeps its digits for a disc as small as the sun's.
    height: f64,
    solid_angle: f64,
}

impl Cone {
    /// Around the unit vector `axis`, of this full angle [deg].
    pub fn new(axis: Vec3, angle_deg: f64) -> Self {
        let height = 2.0 * (angle_deg.to_radians() / 4.0).sin().powi(2);
        Self { frame: Frame::from_normal(axis), angle_deg, height, solid_angle: cone_solid_angle(angle_deg) }
    }

    /// Unit vector in its middle.
    pub fn axis(&self) -> Vec3 {
        self.frame.z
    }

    /// Full angle [deg].
    pub fn angle_deg(&self) -> f64 {
        self.angle_deg
    }

    /// [sr]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Does all of it point to the back of a surface with this unit normal?
    pub fn is_behind(&self, normal: Vec3) -> bool {
        // sin² of half the angle from 1 - cos; wider than a hemisphere it always shows before the surface.
        let cosine = self.axis().dot(normal);
        self.height < 1.0
            && cosine < 0.0
            && cosine * cosine > self.height * (2.0 - self.height) * (1.0 + EDGE)
    }

    /// Does the unit vector `direction` point into it?
    pub fn contains(&self, direction: Vec3) -> bool {
        // 1 - cos from the chord.
        0.5 * (direction - self.axis()).length_squared() <= self.height * (1.0 + EDGE)
    }

    /// Does it hold all directions, or any, between two heights z of unit vectors?
    pub fn holds_strip(&self, heights: [f64; 2]) -> [bool; 2] {
        let [z0, z1] = heights.map(|z| z.clamp(-1.0, 1.0));
        let (axis, half) = (self.axis().z.clamp(-1.0, 1.0).acos(), 0.5 * self.angle_deg.to_radians());
        // Angles from the zenith, and from the axis to directions there: the difference on its side of the zenith, and the sum, or what that
        // leaves of a whole turn, on the other.
        let [from, to] = [z1.acos(), z0.acos()];
        let nearest = (from - axis).max(axis - to);
        let farthest = match (from + axis, to + axis) {
            (_, sum) if sum <= PI => sum,
            (sum, _) if sum >= PI => 2.0 * PI - sum,
            _ => PI,
        };
        [farthest <= half + EDGE, nearest <= half + NEAR_EDGE]
    }

    /// A direction evenly from it, by a point of the unit square; density 1 over the solid angle.
    pub fn sample(&self, u: [f64; 2]) -> Vec3 {
        let [dx, dy] = warp::square_to_disk(u);
        // 1 - cos(theta) is uniform; sin(theta) over the radius from it without cancellation.
        let height = self.height * (dx * dx + dy * dy);
        let scale = (self.height * (2.0 - height)).sqrt();
        self.frame.to_world(Vec3::new(dx * scale, dy * scale, 1.0 - height))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_stay_in_the_cone_and_fill_it() {
        let cone = Cone::new(Vec3::new(0.6, 0.0, 0.8), 0.533);
        let edge = (cone.angle_deg() / 2.0).to_radians();
        let n = 200;
        let mut mean = 0.0;
        for i in 0..n {
            for j in 0..n {
                let d = cone.sample([(i as f64 + 0.5) / n as f64, (j as f64 + 0.5) / n as f64]);
                let theta = d.cross(cone.axis()).length().asin();
                assert!(theta <= edge * (1.0 + 1e-9) && (d.length() - 1.0).abs() < 1e-12);
                assert!(cone.contains(d));
                mean += (theta / edge).powi(2) / (n * n) as f64;
            }
        }
        // theta² is uniform on a small disc: its mean is half the largest.
        assert!((mean - 0.5).abs() < 1e-3, "{mean}");
        assert!(!cone.contains(Vec3::Z));
    }

    #[test]
    fn what_is_behind_a_surface_is_not_before_it() {
        for angle_deg in [0.533, 60.0, 179.0, 200.0] {
            for turned in 0..=36 {
                let tilt = f64::from(turned) * 5.0 + 0.1;
                let normal = Vec3::new(tilt.to_radians().sin(), 0.0, tilt.to_radians().cos());
                let is_behind = tilt - 90.0 > angle_deg / 2.0;
                assert_eq!(Cone::new(Vec3::Z, angle_deg).is_behind(normal), is_behind, "{angle_deg} {tilt}");
            }
        }
    }

    #[test]
    fn strips_that_it_holds_are_those_of_its_directions() {
        for axis in [Vec3::Z, Vec3::NEG_Z, Vec3::new(0.6, 0.0, 0.8), Vec3::X, Vec3::new(0.0, 0.28, -0.96)] {
            for angle in [0.533, 30.0, 90.0, 180.0, 250.0, 360.0] {
                let cone = Cone::new(axis, angle);
                for i in 0..40 {
                    let heights = [0, 1].map(|end| f64::from(i + end) / 20.0 - 1.0);
                    let inside = (0..=20).flat_map(|j| (0..200).map(move |k| (j, k))).filter(|&(j, k)| {
                        let z = heights[0] + f64::from(j) / 20.0 * (heights[1] - heights[0]);
                        let r = (1.0 - z * z).max(0.0).sqrt();
                        let [x, y] = warp::circle(f64::from(k) / 200.0);
                        cone.contains(Vec3::new(r * x, r * y, z))
                    });
                    let (count, [all, any]) = (inside.count(), cone.holds_strip(heights));
                    assert!(!all || count == 21 * 200, "{axis} {angle} {heights:?}");
                    assert!(any || count == 0, "{axis} {angle} {heights:?}");
                    // With a vertical axis there is nothing in between but where the edge is.
                    let is_edge = ((cone.height - 1.0) * -axis.z - heights[0]).abs() <= 0.05 + 1e-9;
                    assert!(axis.z.abs() < 1.0 || is_edge || all == any, "{axis} {angle} {heights:?}");
                }
            }
        }
    }
}
