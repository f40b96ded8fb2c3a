//! The box that is sampled: where rays start, and what happens at its sides.

use crate::World;
use crate::accel::Hit;
use crate::shapes::{Bounds, Ray};
use sunpeak_core::{Error, Result, Vec3};

/// How far before a face rays start, and how far past a side surfaces still belong to the box, relative to the box's size: so that
/// a surface in a face is met, and one in a side belongs to it.
const MARGIN: f64 = 1e-8;

/// The least margin [m], well above what a ray may not hit next to its start.
const LEAST_MARGIN: f64 = 1e-8;

/// Sides that one flight may cross; past it the ray runs along the product for ever, and is lost.
const MOST_CROSSINGS: u32 = 10_000;

/// How far geometry may stick out of the box in depth, relative to the box's size.
const STICK_OUT: f64 = 1e-6;

/// What lies beside the sampled box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Edges {
    /// What the scene has there: rays go on, and leave where they meet nothing any more (as with genBSDF).
    #[default]
    Open,
    /// The box again, in x and y, for ever: what the scene has outside the box is not seen.
    Periodic,
}

/// The sampled box, and its edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    min: Vec3,
    max: Vec3,
    edges: Edges,
    margin: f64,
    /// Past these z, seen from the geometry's middle, nothing is left to meet.
    reach: [f64; 2],
}

/// What comes next on a ray's way.
pub(super) enum Next {
    Hit(Hit),
    /// It has left the product.
    Out,
    /// It never ends.
    Lost,
}

impl Cell {
    /// From the smallest and the largest corner; without them, the box around the scene's geometry.
    pub fn new(world: &World, corners: Option<[Vec3; 2]>, edges: Edges) -> Result<Self> {
        let Some(all) = world.accel.extent() else {
            return Err(Error::value("the scene has no surfaces; expected the geometry of a product"));
        };
        let Bounds { min, max } = corners.map_or(all, |[min, max]| Bounds { min, max });
        let size = max - min;
        if !(min.is_finite() && max.is_finite() && size.x > 0.0 && size.y > 0.0 && size.z >= 0.0) {
            return Err(Error::value(format!(
                "the sampled box runs from {min} to {max}; expected a width and a height above zero"
            )));
        }
        let reach = STICK_OUT * size.max_element();
        if all.min.z < min.z - reach || all.max.z > max.z + reach {
            return Err(Error::value(format!(
                "the geometry reaches from z = {} to {}, the sampled box from {} to {}; expected all of it between the box's faces",
                all.min.z, all.max.z, min.z, max.z
            )));
        }
        let margin =
            (MARGIN * size.max_element().max(min.abs().max(max.abs()).max_element())).max(LEAST_MARGIN);
        Ok(Self { min, max, edges, margin, reach: [all.min.z + 0.5 * margin, all.max.z - 0.5 * margin] })
    }

    pub fn corners(&self) -> [Vec3; 2] {
        [self.min, self.max]
    }

    /// A ray through the face at which it enters; `u` is its place there.
    pub fn entering(&self, direction: Vec3, u: [f64; 2]) -> Ray {
        let z = if direction.z > 0.0 { self.min.z - self.margin } else { self.max.z + self.margin };
        let across = self.min + (self.max - self.min) * Vec3::new(u[0], u[1], 0.0);
        Ray::new(Vec3::new(across.x, across.y, z), direction)
    }

    /// Follow a ray to the next surface; it starts anew where it crosses a side of a periodic box. `passed` grows by the ways before.
    pub fn next(&self, world: &World, ray: &mut Ray, passed: &mut f64) -> Next {
        if self.has_left(ray) {
            return Next::Out;
        }
        if self.edges == Edges::Open {
            return world.accel.closest(ray, f64::INFINITY).map_or(Next::Out, Next::Hit);
        }
        for _ in 0..MOST_CROSSINGS {
            let (axis, t) = self.way_out(ray);
            if let Some(hit) = world.accel.closest(ray, t + self.margin) {
                return Next::Hit(hit);
            }
            if axis == 2 {
                return Next::Out;
            }
            let mut origin = ray.at(t);
            origin[axis] = if ray.direction[axis] > 0.0 { self.min[axis] } else { self.max[axis] };
            *passed += t;
            *ray = Ray::new(origin - ray.direction * self.margin, ray.direction);
        }
        Next::Lost
    }

    /// Is a ray on its way out, with all of the geometry behind it?
    pub fn has_left(&self, ray: &Ray) -> bool {
        let (from, to) = (ray.origin.z, ray.direction.z);
        from > self.reach[1] && to > 0.0 || from < self.reach[0] && to < 0.0
    }

    /// The place in the box of a point beside it.
    pub fn wrapped(&self, mut point: Vec3) -> Vec3 {
        if self.edges == Edges::Periodic {
            for axis in 0..2 {
                let size = self.max[axis] - self.min[axis];
                point[axis] = self.min[axis] + (point[axis] - self.min[axis]).rem_euclid(size);
            }
        }
        point
    }

    /// The axis along which a ray leaves the box, and how far it is there.
    fn way_out(&self, ray: &Ray) -> (usize, f64) {
        let mut first = (2, f64::INFINITY);
        for axis in 0..3 {
            let d = ray.direction[axis];
            if d == 0.0 {
                continue;
            }
            let beyond = if axis == 2 { self.margin } else { 0.0 };
            let side = if d > 0.0 { self.max[axis] + beyond } else { self.min[axis] - beyond };
            let t = ((side - ray.origin[axis]) / d).max(0.0);
            if t < first.1 {
                first = (axis, t);
            }
        }
        first
    }
}
