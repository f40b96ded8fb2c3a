//! Surfaces from their arguments (reference manual, "Surfaces").

use super::args::{check_counts, title, triple};
use crate::{Shape, raw::Primitive};
use sunpeak_core::Vec3;

/// Twice a polygon's area below this share of its outline's squared length is rounding, not area.
const SMALLEST_RELATIVE_AREA: f64 = 1e-13;
/// How far vertices may lie off the plane, in parts of the outline's length, before it is worth a word.
const PLANE_TOLERANCE: f64 = 1e-3;

/// What a surface's arguments make.
#[derive(Debug, PartialEq)]
pub enum Outcome {
    /// A shape.
    Good(Shape),
    /// A shape, after something was put right.
    Odd(Shape, String),
    /// Nothing that light could meet.
    Skip(String),
}

/// The shape of a surface.
pub fn shape(primitive: &Primitive) -> Result<Outcome, String> {
    match primitive.kind.name {
        "polygon" => polygon(primitive),
        "sphere" => sphere(primitive, false),
        "bubble" => sphere(primitive, true),
        "cylinder" => cylinder(primitive, false),
        "tube" => cylinder(primitive, true),
        "cone" => cone(primitive, false),
        "cup" => cone(primitive, true),
        "ring" => ring(primitive),
        "source" => source(primitive),
        other => Err(format!("\"{other}\" is no surface")),
    }
}

fn polygon(primitive: &Primitive) -> Result<Outcome, String> {
    let reals = &primitive.reals;
    if !primitive.strings.is_empty() || reals.len() < 9 || !reals.len().is_multiple_of(3) {
        return Err(format!(
            "wrong number of arguments of {}: expected 0 string arguments and 3 real arguments a vertex, 9 or more, \
             found {} and {}",
            title(primitive),
            primitive.strings.len(),
            reals.len()
        ));
    }
    let mut vertices: Vec<Vec3> = reals.chunks_exact(3).map(Vec3::from_slice).collect();
    if vertices.len() > 3 && vertices.first() == vertices.last() {
        vertices.pop();
    }
    let closed = || vertices.iter().zip(vertices.iter().cycle().skip(1));
    let outline: f64 = closed().map(|(a, b)| a.distance(*b)).sum();
    let first = vertices[0];
    // Newell's normal, about the first vertex to keep the digits of far places.
    let normal: Vec3 = closed().map(|(a, b)| (a - first).cross(b - first)).sum();
    if normal.length() <= SMALLEST_RELATIVE_AREA * outline * outline {
        return Ok(Outcome::Skip("has no area".into()));
    }
    let normal = normal.normalize();
    let off_plane = vertices.iter().map(|v| (v - first).dot(normal).abs()).fold(0.0, f64::max);
    if off_plane > PLANE_TOLERANCE * outline {
        return Ok(Outcome::Odd(
            Shape::Polygon(vertices),
            format!("has a vertex {off_plane:.2e} m off its plane"),
        ));
    }
    Ok(Outcome::Good(Shape::Polygon(vertices)))
}

fn sphere(primitive: &Primitive, inward: bool) -> Result<Outcome, String> {
    check_counts(primitive, &[0], &[4], "xcent ycent zcent radius")?;
    let (center, radius) = (triple(&primitive.reals, 0), primitive.reals[3]);
    if radius == 0.0 {
        return Ok(Outcome::Skip("has no radius".into()));
    }
    let shape = Shape::Sphere { center, radius: radius.abs(), inward: inward != (radius < 0.0) };
    Ok(odd_if(radius < 0.0, shape, "has a negative radius: turned inside out"))
}

fn cylinder(primitive: &Primitive, inward: bool) -> Result<Outcome, String> {
    check_counts(primitive, &[0], &[7], "x0 y0 z0 x1 y1 z1 radius")?;
    Ok(frustum(primitive, [primitive.reals[6]; 2], inward))
}

fn cone(primitive: &Primitive, inward: bool) -> Result<Outcome, String> {
    check_counts(primitive, &[0], &[8], "x0 y0 z0 x1 y1 z1 r0 r1")?;
    Ok(frustum(primitive, [primitive.reals[6], primitive.reals[7]], inward))
}

fn frustum(primitive: &Primitive, radii: [f64; 2], inward: bool) -> Outcome {
    let (start, end) = (triple(&primitive.reals, 0), triple(&primitive.reals, 3));
    if start == end {
        return Outcome::Skip("has no length".into());
    }
    let [r0, r1] = radii;
    if r0 * r1 < 0.0 || r0 == 0.0 && r1 == 0.0 {
        return Outcome::Skip(format!("has the radii {r0} and {r1}"));
    }
    let negative = r0 + r1 < 0.0;
    let (start_radius, end_radius) = (r0.abs(), r1.abs());
    let shape = Shape::Cone { start, end, start_radius, end_radius, inward: inward != negative };
    odd_if(negative, shape, "has a negative radius: turned inside out")
}

fn ring(primitive: &Primitive) -> Result<Outcome, String> {
    check_counts(primitive, &[0], &[8], "xcent ycent zcent xdir ydir zdir r0 r1")?;
    let reals = &primitive.reals;
    let Some(normal) = triple(reals, 3).try_normalize() else {
        return Ok(Outcome::Skip("has no direction".into()));
    };
    let (inner_radius, outer_radius) = (reals[6].min(reals[7]), reals[6].max(reals[7]));
    if inner_radius < 0.0 || inner_radius == outer_radius {
        return Ok(Outcome::Skip(format!("has the radii {} and {}", reals[6], reals[7])));
    }
    Ok(Outcome::Good(Shape::Ring { center: triple(reals, 0), normal, inner_radius, outer_radius }))
}

fn source(primitive: &Primitive) -> Result<Outcome, String> {
    check_counts(primitive, &[0], &[4], "xdir ydir zdir angle")?;
    let angle_deg = primitive.reals[3];
    let direction = triple(&primitive.reals, 0).try_normalize();
    let direction = direction.ok_or_else(|| format!("{}: the direction is zero", title(primitive)))?;
    if angle_deg <= 0.0 || angle_deg > 360.0 {
        return Err(format!(
            "{}: the angle is {angle_deg}, expected degrees over 0, up to 360",
            title(primitive)
        ));
    }
    Ok(Outcome::Good(Shape::Source { direction, angle_deg }))
}

fn odd_if(odd: bool, shape: Shape, oddity: &str) -> Outcome {
    if odd { Outcome::Odd(shape, oddity.into()) } else { Outcome::Good(shape) }
}
