//! The faces of a box with rounded edges made of polygons.

use super::genbox::{Box, EDGES, INNER_SIDES};
use std::f64::consts::FRAC_PI_2;
use sunpeak_core::Vec3;

/// Faces in the order in which genbox writes them: the last made comes first.
pub(super) fn rounded_faces(shape: &Box, subdivisions: u32) -> Vec<Vec<Vec3>> {
    let mut faces: Vec<Vec<Vec3>> =
        INNER_SIDES.iter().map(|side| side.iter().map(|&v| shape.vertex(v)).collect()).collect();
    for ends in &EDGES {
        edge(shape, *ends, 1 << subdivisions, &mut faces);
    }
    for corner in 0o70..0o100 {
        round_corner(shape, corner, subdivisions, &mut faces);
    }
    faces.reverse();
    faces
}

/// A quarter of a cylinder in strips.
fn edge(shape: &Box, [start, end]: [u8; 2], segments: u32, faces: &mut Vec<Vec<Vec3>>) {
    let (p0, p1) = (shape.vertex(start), shape.vertex(end));
    let outwards = |axis: usize| {
        let sign = if p1[axis] < 0.5 * shape.size[axis] { -1.0 } else { 1.0 };
        Vec3::AXES[axis] * sign * shape.bevel
    };
    let (from, to) = match (start ^ end) & 0o7 {
        0o1 => (outwards(2), outwards(1)),
        0o2 => (outwards(0), outwards(2)),
        _ => (outwards(1), outwards(0)),
    };
    let offset = |i: u32| {
        let (sin, cos) = (FRAC_PI_2 * f64::from(i) / f64::from(segments)).sin_cos();
        from * cos + to * sin
    };
    for i in 0..segments {
        let (near, far) = (offset(i), offset(i + 1));
        faces.push(vec![p0 + near, p1 + near, p1 + far, p0 + far]);
    }
}

/// An eighth of a sphere in triangles.
fn round_corner(shape: &Box, corner: u8, subdivisions: u32, faces: &mut Vec<Vec<Vec3>>) {
    let outwards =
        |axis: usize| Vec3::AXES[axis] * if (corner >> axis & 1 == 1) != shape.inward { 1.0 } else { -1.0 };
    let (mut a, mut b, c) = (outwards(0), outwards(1), outwards(2));
    // An even number of high sides turns the order round.
    if (corner & 0o7).count_ones().is_multiple_of(2) {
        (a, b) = (b, a);
    }
    subdivide(shape.vertex(corner), shape.bevel, [a, b, c], subdivisions, faces);
}

fn subdivide(center: Vec3, radius: f64, [a, b, c]: [Vec3; 3], level: u32, faces: &mut Vec<Vec<Vec3>>) {
    if level == 0 {
        faces.push([a, b, c].map(|direction| center + radius * direction).to_vec());
        return;
    }
    let (ab, bc, ca) = ((a + b).normalize(), (b + c).normalize(), (c + a).normalize());
    for part in [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]] {
        subdivide(center, radius, part, level - 1, faces);
    }
}
