//! Pixels one by one, fast enough for pictures of many millions.

use super::{Camera, ViewKind};
use sunpeak_core::Vec3;

/// A pixel as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct PixelRay {
    /// Unit vector towards its centre.
    pub direction: Vec3,
    /// Its solid angle [sr], as far as the view reaches.
    pub solid_angle_sr: f64,
}

/// Largest relative error of a solid angle that is taken as area times density at the centre.
const MIDPOINT_ERROR: f64 = 1e-6;

impl Camera {
    /// Direction and solid angle of a pixel, columns from the left, rows from the top; `None` where the view does not reach its centre,
    /// or reaches it behind the eye.
    ///
    /// The solid angle is [`Camera::pixel_solid_angle`] to one part in a million.
    pub fn pixel_ahead(&self, column: usize, row: usize, width: usize, height: usize) -> Option<PixelRay> {
        let (width_f, height_f) = (width as f64, height as f64);
        let [u, v] = self.plane((column as f64 + 0.5) / width_f, 1.0 - (row as f64 + 0.5) / height_f);
        let local = self.local_direction(u, v).filter(|local| local[2] > 0.0)?;
        let edges = [self.size[0] / width_f, self.size[1] / height_f];
        let solid_angle_sr = self
            .midpoint_solid_angle([u, v], local, edges)
            .unwrap_or_else(|| self.pixel_solid_angle(column, row, width, height));
        let along = local[0] * self.right + local[1] * self.up + local[2] * self.forward;
        let is_unit = !matches!(self.kind, ViewKind::Perspective | ViewKind::Cylindrical);
        let direction = if is_unit { along } else { along.normalize() };
        Some(PixelRay { direction, solid_angle_sr })
    }

    /// Solid angle over area of the picture (whose edges are 1) at a point, and the direction there; `None` where the view does not
    /// reach, and for views other than fisheyes.
    pub fn density(&self, x: f64, y: f64) -> Option<PixelRay> {
        let [u, v] = self.plane(x, y);
        let local = self.local_direction(u, v)?;
        let (density, _) = self.plane_density([u, v], local)?;
        let direction = local[0] * self.right + local[1] * self.up + local[2] * self.forward;
        Some(PixelRay { direction, solid_angle_sr: density * self.size[0] * self.size[1] })
    }

    /// Area times density; `None` where the density bends too much over the pixel: the midpoint rule errs by edge² / 24 times its curvature.
    fn midpoint_solid_angle(&self, point: [f64; 2], local: [f64; 3], edges: [f64; 2]) -> Option<f64> {
        let (density, curvature) = self.plane_density(point, local)?;
        let error = curvature * (edges[0].powi(2) + edges[1].powi(2)) / 24.0;
        (error < MIDPOINT_ERROR).then(|| density * edges[0] * edges[1])
    }

    /// Solid angle over area of the view's plane, and a bound of its Laplacian over itself, in front of the eye.
    ///
    /// The density f is for `-vta` sin(theta) / theta, bent by at most 2/3, for `-vth` 1/z, by at most 5 / z⁴, for `-vts` 4 / (1 + r²)², by at
    /// most 8.
    fn plane_density(&self, [u, v]: [f64; 2], local: [f64; 3]) -> Option<(f64, f64)> {
        let z = local[2];
        match self.kind {
            ViewKind::AngularFisheye if z >= 0.0 => {
                let theta2 = u * u + v * v;
                let sine2 = local[0] * local[0] + local[1] * local[1];
                Some((if theta2 > 0.0 { (sine2 / theta2).sqrt() } else { 1.0 }, 2.0 / 3.0))
            }
            ViewKind::HemisphericalFisheye if z > 0.0 => Some((1.0 / z, 5.0 / z.powi(4))),
            ViewKind::PlanisphericFisheye if z >= 0.0 => Some(((1.0 + z).powi(2), 8.0)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;

    #[test]
    fn solid_angles_are_those_of_the_integral() {
        for kind in [
            ViewKind::AngularFisheye,
            ViewKind::HemisphericalFisheye,
            ViewKind::PlanisphericFisheye,
            ViewKind::Perspective,
            ViewKind::Cylindrical,
        ] {
            let angle =
                if kind == ViewKind::Perspective || kind == ViewKind::Cylindrical { 90.0 } else { 180.0 };
            let view = View { kind, horizontal_deg: angle, vertical_deg: angle, ..View::default() };
            let camera = Camera::new(&view).expect("a view");
            let size = 3000;
            for (column, row) in [(1500, 1500), (40, 1500), (700, 2200), (1499, 2950), (446, 445)] {
                let Some(pixel) = camera.pixel_ahead(column, row, size, size) else { continue };
                let exact = camera.pixel_solid_angle(column, row, size, size);
                assert!((pixel.solid_angle_sr / exact - 1.0).abs() < 2e-6, "{kind:?} {column} {row}");
                let [x, y] = [(column as f64 + 0.5) / 3000.0, 1.0 - (row as f64 + 0.5) / 3000.0];
                let ray = camera.ray(x, y).expect("in view");
                assert!(ray.direction.distance(pixel.direction) < 1e-12);
            }
        }
    }
}
