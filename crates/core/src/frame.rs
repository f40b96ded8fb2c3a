//! Orthonormal frames.

use crate::Vec3;

/// A right-handed orthonormal frame; `z` is the surface normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// y cross z.
    pub x: Vec3,
    /// The up vector projected on the surface.
    pub y: Vec3,
    /// The normal.
    pub z: Vec3,
}

impl Frame {
    /// Any frame around a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    pub fn from_normal(normal: Vec3) -> Self {
        let (x, y) = normal.any_orthonormal_pair();
        Self { x, y, z: normal }
    }

    /// The frame of a BSDF: z the unit normal, y the up vector projected on the surface, x = y cross z.
    /// `None` if `up` is parallel to the normal or zero.
    pub fn from_normal_up(normal: Vec3, up: Vec3) -> Option<Self> {
        let y = (up - normal * up.dot(normal)).try_normalize()?;
        (y.dot(normal).abs() < 1e-6).then(|| Self { x: y.cross(normal), y, z: normal })
    }

    /// World to local.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local to world.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}
