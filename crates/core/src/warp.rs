//! Maps from the unit square to directions, with their densities.

use crate::Vec3;
use std::f64::consts::PI;

/// Unit square to unit disk, area-preserving and continuous (Shirley and Chiu 1997).
pub fn square_to_disk([u, v]: [f64; 2]) -> [f64; 2] {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0, 0.0];
    }
    let (r, phi) = if a.abs() > b.abs() { (a, PI / 4.0 * b / a) } else { (b, PI / 2.0 - PI / 4.0 * a / b) };
    [r * phi.cos(), r * phi.sin()]
}

/// The inverse of [`square_to_disk`]: unit disk to unit square.
pub fn disk_to_square([x, y]: [f64; 2]) -> [f64; 2] {
    // Not `hypot`, which takes care of numbers that no point of a disk has, and four times as long.
    let r = (x * x + y * y).sqrt();
    let (a, b) = if x.abs() > y.abs() {
        // Signed radius, so that the angle stays within 45 degrees of the axis.
        let a = r.copysign(x);
        (a, a * (y / x).atan() * (4.0 / PI))
    } else if y == 0.0 {
        (0.0, 0.0)
    } else {
        let b = r.copysign(y);
        (b * (x / y).atan() * (4.0 / PI), b)
    };
    [(0.5 + 0.5 * a).clamp(0.0, 1.0), (0.5 + 0.5 * b).clamp(0.0, 1.0)]
}

/// Cosine-distributed direction around +z; density cos(theta)/pi.
pub fn cosine_hemisphere(u: [f64; 2]) -> Vec3 {
    let [x, y] = square_to_disk(u);
    Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// Uniform direction in the cone of full angle `angle_deg` around +z; density 1/[`crate::cone_solid_angle`].
pub fn uniform_cone(u: [f64; 2], angle_deg: f64) -> Vec3 {
    let [dx, dy] = square_to_disk(u);
    let radius_squared = dx * dx + dy * dy;
    // 1 - cos(theta) is uniform; sin(theta) from it without cancellation.
    let height = 2.0 * (angle_deg.to_radians() / 4.0).sin().powi(2) * radius_squared;
    let scale = if radius_squared > 0.0 { (height * (2.0 - height) / radius_squared).sqrt() } else { 0.0 };
    Vec3::new(dx * scale, dy * scale, 1.0 - height)
}

/// Uniform direction on the sphere; density 1/(4 pi).
pub fn uniform_sphere([u, v]: [f64; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * (2.0 * PI * v).cos(), r * (2.0 * PI * v).sin(), z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disk_and_square_undo_each_other() {
        for i in 0..41 {
            for j in 0..41 {
                let u = [i as f64 / 40.0, j as f64 / 40.0];
                let back = disk_to_square(square_to_disk(u));
                assert!((u[0] - back[0]).abs() < 1e-12 && (u[1] - back[1]).abs() < 1e-12, "{u:?} {back:?}");
            }
        }
    }

    #[test]
    fn cone_samples_stay_in_the_cone_and_fill_it() {
        let angle_deg: f64 = 0.533;
        let edge = (angle_deg / 2.0).to_radians();
        let n = 200;
        let mut mean = 0.0;
        for i in 0..n {
            for j in 0..n {
                let d = uniform_cone([(i as f64 + 0.5) / n as f64, (j as f64 + 0.5) / n as f64], angle_deg);
                let theta = d.x.hypot(d.y).asin();
                assert!(theta <= edge * (1.0 + 1e-9) && (d.length() - 1.0).abs() < 1e-12);
                mean += (theta / edge).powi(2) / (n * n) as f64;
            }
        }
        // theta² is uniform on a small disc: its mean is half the largest.
        assert!((mean - 0.5).abs() < 1e-3, "{mean}");
    }
}
