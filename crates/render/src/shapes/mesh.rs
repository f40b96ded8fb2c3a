//! Meshes that look curved: normals interpolated between the vertices of their triangles (Phong 1975).

use super::Triangle;
use sunpeak_core::Vec3;
use sunpeak_scene::Mesh;

/// A mesh with normals at its vertices.
#[derive(Clone, Debug)]
pub(crate) struct SmoothMesh(pub Mesh);

impl SmoothMesh {
    /// Does each corner of a triangle have a normal?
    pub fn is_smooth(mesh: &Mesh, triangle: [u32; 3]) -> bool {
        triangle.iter().all(|&i| mesh.normals.get(i as usize).is_some_and(|n| *n != Vec3::ZERO))
    }

    /// The triangle's own unit normal, and the interpolated one (of any length) at one of its points.
    pub fn normals_at(&self, triangle: u32, point: Vec3) -> (Vec3, Vec3) {
        let corners = self.0.triangles[triangle as usize];
        let triangle = Triangle(corners.map(|i| self.0.vertices[i as usize]));
        let flat = triangle.area_vector().normalize();
        let weights = triangle.weights(point);
        let smooth = corners.iter().zip(weights).map(|(&i, w)| self.0.normals[i as usize] * w).sum();
        (flat, smooth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_the_corners_of_an_octahedron_normals_are_those_of_the_sphere() {
        let corners = [Vec3::X, Vec3::Y, Vec3::Z];
        let mesh = SmoothMesh(Mesh {
            vertices: corners.into(),
            normals: corners.into(),
            local: [].into(),
            triangles: vec![[0, 1, 2]],
        });
        assert!(SmoothMesh::is_smooth(&mesh.0, [0, 1, 2]));
        for weights in [[1.0, 0.0, 0.0], [0.2, 0.5, 0.3], [0.0, 0.4, 0.6]] {
            let point: Vec3 = corners.iter().zip(weights).map(|(c, w)| *c * w).sum();
            let (flat, smooth) = mesh.normals_at(0, point);
            assert!((flat - Vec3::ONE.normalize()).length() < 1e-12);
            assert!((smooth.normalize() - point.normalize()).length() < 1e-12, "{smooth}");
        }
    }
}
