//! Polygons: cut into triangles where that works, else tested as they are.
//!
//! Holes reach the outline by seams, as Radiance writes them. A polygon that crosses itself has no triangulation; it is
//! tested by the even-odd rule, as Radiance does.

use super::{Bounds, Crossings, MISS, Ray, Triangle};
use sunpeak_core::Vec3;

/// How far the triangles' area may be from the polygon's, relative, before the triangulation counts as a failure.
const AREA_TOLERANCE: f64 = 1e-6;

/// A polygon is a line if its area is below this share of its extent squared: what rounding leaves of collinear points.
const NO_AREA: f64 = 1e-13;

/// Drops the axis along which a normal is largest, keeping orientation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    x: usize,
    y: usize,
}

impl Projection {
    pub fn along(normal: Vec3) -> Self {
        let axis = normal.abs().max_position();
        let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] < 0.0 { Self { x: y, y: x } } else { Self { x, y } }
    }

    pub fn apply(&self, p: Vec3) -> [f64; 2] {
        [p[self.x], p[self.y]]
    }
}

/// A polygon that is tested whole.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    vertices: Vec<Vec3>,
    pub normal: Vec3,
    projection: Projection,
}

/// Area times normal of a closed outline (Newell).
pub(crate) fn area_vector(vertices: &[Vec3]) -> Vec3 {
    let Some(&origin) = vertices.first() else { return Vec3::ZERO };
    let edges = vertices.iter().zip(vertices.iter().skip(1));
    0.5 * edges.map(|(&a, &b)| (a - origin).cross(b - origin)).sum::<Vec3>()
}

/// Where the holes begin among the vertices of all rings.
fn ring_starts(outline: &[usize], holes: &[Vec<usize>]) -> Vec<usize> {
    let lengths = std::iter::once(outline.len()).chain(holes.iter().map(Vec::len));
    lengths
        .scan(0, |sum, length| {
            *sum += length;
            Some(*sum)
        })
        .take(holes.len())
        .collect()
}

impl Polygon {
    /// `None` if it has no area.
    pub fn new(vertices: Vec<Vec3>) -> Option<Self> {
        let area = area_vector(&vertices);
        let bounds = Bounds::of_points(vertices.iter().copied());
        if area.length() <= NO_AREA * (bounds.max - bounds.min).length_squared() {
            return None;
        }
        let normal = area.try_normalize()?;
        Some(Self { vertices, normal, projection: Projection::along(normal) })
    }

    /// Triangles that cover it exactly; `None` if there is no such set.
    pub fn triangulate(&self) -> Option<Vec<Triangle>> {
        if let [a, b, c] = self.vertices[..] {
            return Some(vec![Triangle([a, b, c])]);
        }
        let rings = self.rings();
        let (outline, holes) = rings.split_first()?;
        let flat = rings.iter().flatten().map(|&i| self.flat(i));
        let starts = ring_starts(outline, holes);
        let mut corners: Vec<usize> = Vec::new();
        earcut::Earcut::new().earcut(flat, &starts, &mut corners);
        let indices: Vec<usize> = rings.concat();
        let triangle =
            |three: &[usize]| Triangle([three[0], three[1], three[2]].map(|i| self.vertices[indices[i]]));
        let triangles: Vec<Triangle> =
            corners.chunks_exact(3).map(triangle).map(|t| self.oriented(t)).collect();
        let covered =
            self.ring_area(outline).abs() - holes.iter().map(|h| self.ring_area(h).abs()).sum::<f64>();
        self.is_covered_by(&triangles, covered).then_some(triangles)
    }

    /// The holes, each in triangles.
    pub fn holes(&self) -> Vec<Vec<Triangle>> {
        // Two triangles and the ends of the seam.
        if self.vertices.len() < 8 {
            return Vec::new();
        }
        let rings = self.rings();
        let polygon = |ring: &Vec<usize>| Self::new(ring.iter().map(|&i| self.vertices[i]).collect());
        rings.iter().skip(1).filter_map(polygon).filter_map(|hole| hole.triangulate()).collect()
    }

    fn flat(&self, vertex: usize) -> [f64; 2] {
        self.projection.apply(self.vertices[vertex])
    }

    /// The outline taken apart where it comes back to a place: the outer ring first and, cut off their seams, the holes. (Holes
    /// may run either way round: what is inside is told by the even-odd rule.)
    fn rings(&self) -> Vec<Vec<usize>> {
        let mut rings = Vec::new();
        let mut path: Vec<usize> = Vec::new();
        for vertex in 0..self.vertices.len() {
            let place = self.vertices[vertex];
            if let Some(start) = path.iter().position(|&i| self.vertices[i] == place) {
                rings.push(path.split_off(start));
            }
            path.push(vertex);
        }
        rings.push(path);
        rings.retain(|ring| ring.len() >= 3);
        rings.sort_by(|a, b| self.ring_area(b).abs().total_cmp(&self.ring_area(a).abs()));
        rings
    }

    /// Area of a ring in the projection, positive if it turns counter-clockwise.
    fn ring_area(&self, ring: &[usize]) -> f64 {
        let next = ring.iter().cycle().skip(1);
        let cross = |(&i, &j): (&usize, &usize)| {
            let ([ax, ay], [bx, by]) = (self.flat(i), self.flat(j));
            ax * by - ay * bx
        };
        0.5 * ring.iter().zip(next).map(cross).sum::<f64>()
    }

    fn oriented(&self, t: Triangle) -> Triangle {
        let [a, b, c] = t.0;
        if t.area_vector().dot(self.normal) < 0.0 { Triangle([a, c, b]) } else { t }
    }

    /// Do the triangles add up to this area in the projection, and lie inside?
    fn is_covered_by(&self, triangles: &[Triangle], area: f64) -> bool {
        let flat_area = |t: &Triangle| {
            let [[ax, ay], [bx, by], [cx, cy]] = t.0.map(|v| self.projection.apply(v));
            0.5 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).abs()
        };
        let sum: f64 = triangles.iter().map(flat_area).sum();
        let middle = |t: &Triangle| (t.0[0] + t.0[1] + t.0[2]) / 3.0;
        (sum - area).abs() <= AREA_TOLERANCE * area
            && triangles.iter().all(|t| flat_area(t) <= AREA_TOLERANCE * area || self.contains(middle(t)))
    }

    /// Even-odd rule in the plane (Haines 1994, "Point in Polygon Strategies", Graphics Gems IV).
    fn contains(&self, point: Vec3) -> bool {
        let [px, py] = self.projection.apply(point);
        let mut inside = false;
        let mut previous = self.vertices[self.vertices.len() - 1];
        for &vertex in &self.vertices {
            let ([ax, ay], [bx, by]) = (self.projection.apply(previous), self.projection.apply(vertex));
            if (ay > py) != (by > py) && px < ax + (py - ay) / (by - ay) * (bx - ax) {
                inside = !inside;
            }
            previous = vertex;
        }
        inside
    }

    pub fn crossings(&self, ray: &Ray) -> Crossings {
        let t = (self.vertices[0] - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        if t.is_finite() && self.contains(ray.at(t)) { [t, f64::INFINITY] } else { MISS }
    }

    pub fn bounds(&self) -> Bounds {
        Bounds::of_points(self.vertices.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Sampler;

    fn lift(points: &[[f64; 2]]) -> Vec<Vec3> {
        // A tilted plane, so that no axis is special.
        let (x, y) = (Vec3::new(0.8, 0.1, 0.59), Vec3::new(-0.1, 0.98, -0.03));
        points.iter().map(|&[u, v]| Vec3::new(1.0, 2.0, 3.0) + x * u + y * v).collect()
    }

    /// A frame with a seam from the outer corner to the hole, as `genbox` users and architects write windows.
    fn frame() -> Vec<Vec3> {
        lift(&[
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [3.0, 2.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ])
    }

    /// A wall that begins at the seam (from a tutorial's room).
    fn wall() -> Vec<Vec3> {
        let (left, right) = (-0.178262, 6.274262);
        lift(&[
            [left, 3.055937],
            [0.0, 2.4384],
            [0.0, 0.9144],
            [6.096, 0.9144],
            [6.096, 2.4384],
            [0.0, 2.4384],
            [left, 3.055937],
            [left, 0.0],
            [right, 0.0],
            [right, 3.055937],
        ])
    }

    fn two_holes() -> Vec<Vec3> {
        lift(&[
            [0.0, 0.0],
            [6.0, 0.0],
            [6.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [4.0, 1.0],
            [4.0, 2.0],
            [5.0, 2.0],
            [5.0, 1.0],
            [4.0, 1.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ])
    }

    fn star() -> Vec<Vec3> {
        let corner = |i: usize| {
            let (r, phi) =
                (if i.is_multiple_of(2) { 2.0 } else { 0.5 }, i as f64 * std::f64::consts::PI / 9.0);
            [r * phi.cos(), r * phi.sin()]
        };
        lift(&(0..18).map(corner).collect::<Vec<_>>())
    }

    #[test]
    fn triangles_cover_what_the_even_odd_rule_covers() {
        for outline in
            [frame(), wall(), two_holes(), star(), lift(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])]
        {
            let polygon = Polygon::new(outline).expect("has an area");
            let triangles = polygon.triangulate().expect("can be cut");
            assert!(triangles.iter().all(|t| t.area_vector().dot(polygon.normal) >= 0.0));
            let mut sampler = Sampler::new(1, 1, 1);
            for _ in 0..3000 {
                let [u, v] = sampler.next_2d();
                let [target] = lift(&[[8.0 * u - 2.0, 6.0 * v - 2.0]])[..] else { unreachable!() };
                let ray = Ray::new(target - polygon.normal * 2.0, polygon.normal);
                let by_triangles = triangles.iter().any(|t| t.crossing(&ray).is_finite());
                assert_eq!(by_triangles, polygon.crossings(&ray)[0].is_finite(), "at {u} {v}");
            }
        }
    }

    #[test]
    fn a_polygon_that_crosses_itself_is_not_cut() {
        let bow_tie = lift(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]]);
        let polygon = Polygon::new(bow_tie).expect("has an area");
        assert!(polygon.triangulate().is_none());
    }

    #[test]
    fn no_area_no_polygon() {
        assert!(Polygon::new(lift(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]])).is_none());
        assert!(Polygon::new(vec![Vec3::ONE; 4]).is_none());
    }
}
