//! Flattened expanded metal.

use super::product::Product;
use glam::DVec2;
use sunpeak_core::{Error, Result};

/// A sheet with rhombic openings between straight strands, all walls upright. What goes straight is what the upper and the lower rim of
/// an opening have in common: two rhombi displaced by thickness · tan(theta), which in coordinates along their sides are two squares.
/// What meets a wall is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh {
    /// From the middle of a knuckle to that of the next: along x (long way) and along y (short way) [any unit of length].
    pub pitch: [f64; 2],
    /// Width of the strands in the plane of the sheet, across them [the same unit].
    pub strand: f64,
    /// Thickness of the sheet [the same unit].
    pub thickness: f64,
    /// Diffuse reflectance of the strands [-], both sides.
    pub reflectance: f64,
}

impl Mesh {
    /// Can a mesh be like that?
    pub fn check(&self) -> Result<()> {
        let [long, short] = self.pitch;
        let lengths = [
            ("long way", long),
            ("short way", short),
            ("strand", self.strand),
            ("thickness", self.thickness),
        ];
        for (name, length) in lengths {
            let least = if name == "thickness" { 0.0 } else { f64::MIN_POSITIVE };
            if !(least..f64::INFINITY).contains(&length) {
                return Err(Error::value(format!("expanded mesh: {name} is {length}; expected more than 0")));
            }
        }
        if self.strand >= self.height() {
            return Err(Error::value(format!(
                "expanded mesh: strands of {} leave no opening; expected less than {:.4}, the distance of its sides",
                self.strand,
                self.height()
            )));
        }
        if !(0.0..=1.0).contains(&self.reflectance) {
            return Err(Error::value(format!(
                "expanded mesh: reflectance is {}; expected 0 to 1",
                self.reflectance
            )));
        }
        Ok(())
    }

    /// Distance of opposite sides of the rhombus of strand axes.
    fn height(&self) -> f64 {
        let [long, short] = self.pitch;
        long * short / long.hypot(short)
    }

    /// An opening's size over the rhombus of strand axes.
    fn scale(&self) -> f64 {
        1.0 - self.strand / self.height()
    }

    /// Share of the area that is openings [-].
    pub fn open_area(&self) -> f64 {
        self.scale().powi(2)
    }
}

impl Product for Mesh {
    fn name(&self) -> String {
        let [long, short] = self.pitch;
        format!("Sunpeak expanded mesh {long} x {short}, strands {}, {} thick", self.strand, self.thickness)
    }

    fn through(&self, p_in: DVec2) -> f64 {
        let cosine = (1.0 - p_in.length_squared()).max(0.0).sqrt();
        let shift = p_in * (self.thickness / cosine.max(f64::MIN_POSITIVE));
        let half = DVec2::from(self.pitch) * (0.5 * self.scale());
        let along = shift / half;
        let left = |way: f64| (1.0 - 0.5 * way.abs()).max(0.0);
        self.open_area() * left(along.x + along.y) * left(along.x - along.y)
    }

    fn smooth(&self, _p_in: DVec2, _p_out: DVec2) -> f64 {
        0.0
    }

    fn reflectance(&self) -> [f64; 2] {
        [self.reflectance * (1.0 - self.open_area()); 2]
    }

    fn is_isotropic(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Sampler;

    const MESH: Mesh = Mesh { pitch: [10.0, 6.0], strand: 1.2, thickness: 0.8, reflectance: 0.5 };

    /// Does a point of the sheet lie in an opening? By its distances to the strands' axes, which is all that they are.
    fn is_open(at: DVec2) -> bool {
        let [long, short] = MESH.pitch;
        let axes = [DVec2::new(short, long), DVec2::new(short, -long)].map(DVec2::normalize);
        axes.iter().all(|axis| {
            let spacing = long * short / long.hypot(short);
            // Axes of strands lie half a spacing off the middle of an opening.
            let from_axis = (axis.dot(at) / spacing - 0.5).rem_euclid(1.0) * spacing;
            from_axis.min(spacing - from_axis) > 0.5 * MESH.strand
        })
    }

    #[test]
    fn rays_through_both_faces_are_counted_to_the_closed_form() {
        MESH.check().unwrap();
        for (theta, phi) in [(0.0f64, 0.0f64), (0.5, 0.3), (0.9, 1.2), (1.1, 2.5)] {
            let p = DVec2::from_angle(phi) * theta.sin();
            let shift = p / theta.cos() * MESH.thickness;
            let (mut open, n) = (0, 400_000);
            for i in 0..n {
                let [u, v] = Sampler::new(7, 0, i).next_2d();
                let at = DVec2::new(10.0 * u, 6.0 * v);
                // A wall is met unless the whole way is open: the openings are convex, but a ray may end in another one.
                open += u32::from((0..=8).all(|k| is_open(at + shift * (f64::from(k) / 8.0))));
            }
            let (got, want) = (f64::from(open) / n as f64, MESH.through(p));
            let error = 4.0 * (want * (1.0 - want) / n as f64).sqrt();
            assert!((got - want).abs() < error + 1e-3, "{theta} {phi}: {got} {want}");
        }
    }

    #[test]
    fn strands_that_leave_no_opening_are_refused() {
        assert!(Mesh { strand: 5.2, ..MESH }.check().unwrap_err().to_string().contains("leave no opening"));
    }
}
