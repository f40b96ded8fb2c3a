//! Meshes: normals interpolated between the vertices of their triangles (Phong 1975), and local coordinates.

use super::Triangle;
use sunpeak_core::Vec3;
use sunpeak_scene::Mesh;

/// A mesh with normals or local coordinates at its vertices.
#[derive(Clone, Debug)]
pub(crate) struct MeshSurface(pub Mesh);

impl MeshSurface {
    /// Is there anything to interpolate?
    pub fn is_one(mesh: &Mesh) -> bool {
        !mesh.local.is_empty() || mesh.triangles.iter().any(|t| is_smooth(mesh, *t))
    }

    /// At a point of a triangle: its own unit normal, the interpolated one (of any length) if each corner has one, local coordinates.
    pub fn at(&self, triangle: u32, point: Vec3) -> (Vec3, Option<Vec3>, [f64; 2]) {
        let corners = self.0.triangles[triangle as usize];
        let triangle = Triangle(corners.map(|i| self.0.vertices[i as usize]));
        let flat = triangle.area_vector().normalize();
        let weights = triangle.weights(point);
        let weighed = || corners.iter().map(|&i| i as usize).zip(weights);
        let smooth = is_smooth(&self.0, corners);
        let bent = smooth.then(|| weighed().map(|(i, w)| self.0.normals[i] * w).sum());
        let local = |k: usize| weighed().map(|(i, w)| self.0.local.get(i).map_or(0.0, |uv| uv[k] * w)).sum();
        (flat, bent, [local(0), local(1)])
    }
}

/// Does each corner have a normal?
fn is_smooth(mesh: &Mesh, triangle: [u32; 3]) -> bool {
    triangle.iter().all(|&i| mesh.normals.get(i as usize).is_some_and(|n| *n != Vec3::ZERO))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_the_corners_of_an_octahedron_normals_are_those_of_the_sphere() {
        let corners = [Vec3::X, Vec3::Y, Vec3::Z];
        let mesh = MeshSurface(Mesh {
            vertices: corners.into(),
            normals: corners.into(),
            local: [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]].into(),
            triangles: vec![[0, 1, 2]],
        });
        assert!(MeshSurface::is_one(&mesh.0));
        for weights in [[1.0, 0.0, 0.0], [0.2, 0.5, 0.3], [0.0, 0.4, 0.6]] {
            let point: Vec3 = corners.iter().zip(weights).map(|(c, w)| *c * w).sum();
            let (flat, smooth, local) = mesh.at(0, point);
            let smooth = smooth.expect("smooth");
            assert!((local[0] - weights[1]).abs() < 1e-12 && (local[1] - 2.0 * weights[2]).abs() < 1e-12);
            assert!((flat - Vec3::ONE.normalize()).length() < 1e-12);
            assert!((smooth.normalize() - point.normalize()).length() < 1e-12, "{smooth}");
        }
    }
}
