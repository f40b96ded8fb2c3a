//! Similarity transforms, as Radiance's `xform` makes them.

use crate::Vec3;
use glam::{DMat3, DMat4};

/// Rotation, uniform scale, mirror and translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    matrix: DMat4,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self { matrix: DMat4::IDENTITY };

    /// Move by `t`.
    pub fn translation(t: Vec3) -> Self {
        Self { matrix: DMat4::from_translation(t) }
    }

    /// Right-handed rotation about an axis through the origin.
    pub fn rotation(axis: Vec3, angle_deg: f64) -> Self {
        Self { matrix: DMat4::from_axis_angle(axis, angle_deg.to_radians()) }
    }

    /// Scale about the origin; negative factors mirror that axis.
    pub fn scaling(factors: Vec3) -> Self {
        Self { matrix: DMat4::from_scale(factors) }
    }

    /// First `self`, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        Self { matrix: next.matrix * self.matrix }
    }

    /// The uniform scale (positive).
    pub fn scale(&self) -> f64 {
        self.linear().determinant().abs().cbrt()
    }

    /// Does it turn right hands into left ones?
    pub fn is_mirror(&self) -> bool {
        self.linear().determinant() < 0.0
    }

    /// Transform a point.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.matrix.transform_point3(p)
    }

    /// Transform a vector: rotated, mirrored and scaled, not moved.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.linear() * v
    }

    /// The inverse transform.
    pub fn inverse(&self) -> Self {
        Self { matrix: self.matrix.inverse() }
    }

    fn linear(&self) -> DMat3 {
        DMat3::from_mat4(self.matrix)
    }
}
