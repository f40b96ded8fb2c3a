//! The box around a scene.

use crate::{Scene, Shape};
use sunpeak_core::Vec3;

impl Scene {
    /// Lowest and highest coordinates of all surfaces that are somewhere (a `source` is not); `None` if there are none.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let boxes = self.surfaces.iter().filter_map(|surface| surface.shape.bounds());
        boxes.reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
    }
}

impl Shape {
    /// Lowest and highest coordinates; `None` for a source.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        match self {
            Self::Polygon(vertices) => around(vertices.iter().copied()),
            Self::Sphere { center, radius, .. } => Some([center - *radius, center + *radius]),
            Self::Cone { start, end, start_radius, end_radius, .. } => {
                let axis = (end - start).normalize_or_zero();
                let ([a, b], [c, d]) = (disc(*start, axis, *start_radius), disc(*end, axis, *end_radius));
                Some([a.min(c), b.max(d)])
            }
            Self::Ring { center, normal, outer_radius, .. } => Some(disc(*center, *normal, *outer_radius)),
            Self::Mesh(mesh) => {
                around(mesh.triangles.iter().flatten().map(|&index| mesh.vertices[index as usize]))
            }
            Self::Source { .. } => None,
        }
    }
}

fn around(points: impl Iterator<Item = Vec3>) -> Option<[Vec3; 2]> {
    points.map(|point| [point; 2]).reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
}

/// Around a disc: along an axis it reaches as far as the sine of the angle between normal and axis.
fn disc(center: Vec3, normal: Vec3, radius: f64) -> [Vec3; 2] {
    let reach = (Vec3::ONE - normal * normal).max(Vec3::ZERO).map(f64::sqrt) * radius;
    [center - reach, center + reach]
}

#[cfg(test)]
mod tests {
    use crate::{LoadOptions, Scene};
    use sunpeak_core::Vec3;

    #[test]
    fn boxes_touch_what_they_hold() {
        let bounds = |text: &str| {
            let text = format!("void plastic m 0 0 5 .5 .5 .5 0 0\nvoid light l 0 0 3 1 1 1\n{text}");
            Scene::parse(&text, "t.rad", &LoadOptions::default()).expect("a scene").bounds()
        };
        assert_eq!(bounds("l source s 0 0 4 0 0 1 5"), None);
        let sphere = "m sphere s 0 0 4 1 2 3 .5\n";
        assert_eq!(bounds(sphere), Some([Vec3::new(0.5, 1.5, 2.5), Vec3::new(1.5, 2.5, 3.5)]));
        let cylinder = "m cylinder c 0 0 7 0 0 0 0 4 0 2\nm polygon p 0 0 9 0 0 0 1 0 0 0 9 -7";
        assert_eq!(bounds(cylinder), Some([Vec3::new(-2.0, 0.0, -7.0), Vec3::new(2.0, 9.0, 2.0)]));
        let [low, high] = bounds("m ring r 0 0 8 0 0 0 1 1 0 0 2").expect("a ring");
        let flat = 2f64.sqrt();
        assert!((high - Vec3::new(flat, flat, 2.0)).length() < 1e-12 && (low + high).length() < 1e-12);
    }
}
