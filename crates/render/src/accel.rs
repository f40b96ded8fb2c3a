//! One bounding volume hierarchy over triangles and analytic shapes.
//!
//! The hierarchy is `obvhs`'s compressed wide BVH in single precision; it only culls. What is hit is decided in double
//! precision, so the boxes are padded by more than single precision can lose. Coordinates are taken relative to the
//! scene's centre, and a ray enters the hierarchy where it enters the scene's box: far origins cost no digits.

use crate::recorder::{Recorder, Search};
use crate::shapes::{Analytic, Bounds, COINCIDENT, Ray, Triangle};
use glam::{UVec2, Vec3A};
use obvhs::{Boundable, BvhBuildParams, aabb::Aabb, cwbvh::CwBvh, cwbvh::builder::build_cwbvh};
use std::{cell::Cell, collections::HashMap};
use sunpeak_core::{Error, Result, Vec3};

/// Nothing nearer than this is hit, relative to the size of the coordinates (at least 1): a ray does not hit the
/// surface that it leaves. Double precision places points to about 1e-15 of the coordinates.
const NEAREST: f64 = 1e-9;

/// `obvhs` skips boxes that end within 1e-4 of the ray's start; boxes are padded by more.
const BOX_PADDING: f64 = 1.1e-4;

/// Padding for single precision, relative to the scene's diameter: 2^-24 for each of the few roundings of origin,
/// direction and box, and 2^-23 for `obvhs`'s smallest direction component.
const ROUNDING_PADDING: f64 = 8.0 / (1 << 23) as f64;

/// More surfaces than this with the very same box are refused: they make a chain, too deep for the traversal stack.
const MAX_COINCIDENT: usize = 128;

/// `obvhs` keeps at most this many levels on its traversal stack.
const MAX_DEPTH: usize = 32;

thread_local! {
    /// Rays that this thread has traced.
    static RAYS: Cell<u64> = const { Cell::new(0) };
}

/// How many rays has this thread traced so far?
pub(crate) fn rays_of_this_thread() -> u64 {
    RAYS.get()
}

/// What a ray can hit.
#[derive(Clone, Debug)]
pub(crate) enum Geometry {
    Triangle(Triangle),
    /// Index among the analytic shapes.
    Analytic(u32),
}

/// A piece of an object.
#[derive(Clone, Debug)]
pub(crate) struct Primitive {
    pub geometry: Geometry,
    pub object: u32,
    /// Of surfaces at the same place an opaque one is hit…
    pub is_opaque: bool,
    /// … and of two alike (after one that shows its front) that of the higher rank.
    pub rank: u32,
}

/// A crossing of a ray and an object.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub t: f64,
    pub object: u32,
}

/// A primitive as the leaves hold it, packed for the search.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    /// Of no meaning for an analytic shape.
    triangle: Triangle,
    /// Index among the analytic shapes, or [`NO_SHAPE`] for a triangle.
    shape: u32,
    object: u32,
}

const NO_SHAPE: u32 = u32::MAX;

/// The hierarchy with its primitives in leaf order.
#[derive(Debug, Default)]
pub(crate) struct Accel {
    bvh: CwBvh,
    leaves: Vec<Leaf>,
    /// Opacity and rank of each leaf's primitive.
    precedence: Vec<(bool, u32)>,
    analytic: Vec<Analytic>,
    center: Vec3,
    /// The padded box of everything; `None` if there is nothing.
    bounds: Option<Bounds>,
    padding: f64,
    recorder: Recorder,
}

/// Boxes for the builder.
struct PaddedBox(Aabb);

impl Boundable for PaddedBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Accel {
    pub fn build(primitives: Vec<Primitive>, analytic: Vec<Analytic>) -> Result<Self> {
        if primitives.is_empty() {
            return Ok(Self::default());
        }
        let boxes: Vec<Bounds> = primitives.iter().map(|p| bounds_of(p, &analytic)).collect();
        let all = boxes.iter().fold(Bounds::EMPTY, |a, b| a.union(*b));
        let center = 0.5 * (all.min + all.max);
        let padding = BOX_PADDING + ROUNDING_PADDING * (all.max - all.min).length();
        let padded: Vec<PaddedBox> = boxes.iter().map(|b| pad(b, center, padding)).collect();
        let bvh = build_checked(&padded)?;
        let in_leaf_order = || bvh.primitive_indices.iter().map(|&i| &primitives[i as usize]);
        let leaves = in_leaf_order().map(Leaf::new).collect();
        let precedence = in_leaf_order().map(|p| (p.is_opaque, p.rank)).collect();
        let bounds = Some(widened(all, padding));
        Ok(Self { bvh, leaves, precedence, analytic, center, bounds, padding, recorder: Recorder::default() })
    }

    /// The box around all surfaces; none if there are none.
    pub fn extent(&self) -> Option<Bounds> {
        self.bounds.map(|b| widened(b, -self.padding))
    }

    pub fn recorder(&self) -> &Recorder {
        &self.recorder
    }

    pub fn shape(&self, index: u32) -> &Analytic {
        &self.analytic[index as usize]
    }

    /// Nearest crossing before `t_max`. Of surfaces at the same place an opaque one wins, then one that shows its front, then the
    /// one of higher rank, as in Radiance.
    pub fn closest(&self, ray: &Ray, t_max: f64) -> Option<Hit> {
        if self.recorder.is_on() {
            self.recorder.add(ray, t_max, Search::Closest);
        }
        let mut best: Option<(Hit, usize)> = None;
        self.crossings(ray, t_max, |hit, leaf| {
            let is_better = match best {
                None => true,
                Some((old, _)) if hit.t < old.t - COINCIDENT => true,
                Some((old, _)) if hit.object == old.object => hit.t < old.t,
                Some((old, other)) => self.precedence(&hit, leaf, ray) > self.precedence(&old, other, ray),
            };
            if is_better {
                best = Some((hit, leaf));
            }
            Continue::UpTo(best.map_or(t_max, |(best, _)| t_max.min(best.t + COINCIDENT)))
        });
        best.map(|(hit, _)| hit)
    }

    /// Which of coincident surfaces is hit: the larger one.
    #[cold]
    fn precedence(&self, hit: &Hit, leaf: usize, ray: &Ray) -> (bool, bool, u32) {
        let Leaf { triangle, shape, .. } = &self.leaves[leaf];
        let normal = match *shape {
            NO_SHAPE => triangle.area_vector(),
            shape => self.shape(shape).normal(ray.at(hit.t)),
        };
        let (is_opaque, rank) = self.precedence[leaf];
        (is_opaque, ray.direction.dot(normal) < 0.0, rank)
    }

    /// Calls `visit` for crossings before `t_max`, in no order, until it says stop. A crossing on the seam of two triangles
    /// may come twice.
    pub fn each_crossing(&self, ray: &Ray, t_max: f64, mut visit: impl FnMut(Hit) -> bool) {
        if self.recorder.is_on() {
            return self.each_recorded(ray, t_max, &mut visit);
        }
        self.crossings(ray, t_max, |hit, _| if visit(hit) { Continue::UpTo(t_max) } else { Continue::Stop });
    }

    #[cold]
    fn each_recorded(&self, ray: &Ray, t_max: f64, visit: &mut dyn FnMut(Hit) -> bool) {
        let (mut visited, mut is_stopped) = (0, false);
        self.crossings(ray, t_max, |hit, _| {
            visited += 1;
            is_stopped = !visit(hit);
            if is_stopped { Continue::Stop } else { Continue::UpTo(t_max) }
        });
        self.recorder.add(ray, t_max, Search::Crossings { visited, is_stopped });
    }

    /// Where the ray crosses one object, whatever stands before it.
    pub fn crossing_of(&self, ray: &Ray, object: u32) -> Option<f64> {
        let mut nearest = None;
        self.each_crossing(ray, f64::INFINITY, |hit| {
            if hit.object == object && nearest.is_none_or(|t| hit.t < t) {
                nearest = Some(hit.t);
            }
            true
        });
        nearest
    }

    #[inline(always)]
    fn crossings(&self, ray: &Ray, t_max: f64, mut visit: impl FnMut(Hit, usize) -> Continue) {
        RAYS.set(RAYS.get() + 1);
        let Some(start) = self.entry(ray) else { return };
        let t_min = ray.start.max(NEAREST * ray.origin.abs().max_element().max(1.0));
        let mut limit = t_max;
        let mut single = self.single_precision(ray, start, limit);
        let mut state = self.bvh.new_traversal(single.direction);
        let mut node;
        'search: {
            obvhs::traverse!(self.bvh, node, state, node.intersect_ray(&single, state.oct_inv4), {
                let index = state.primitive_id as usize;
                let leaf = &self.leaves[index];
                let [mut t, mut next] = match leaf.shape {
                    NO_SHAPE => [leaf.triangle.crossing(ray), f64::INFINITY],
                    shape => ordered(self.shape(shape).crossings(ray)),
                };
                while t < limit {
                    if t > t_min {
                        match visit(Hit { t, object: leaf.object }, index) {
                            Continue::UpTo(t) => limit = t,
                            Continue::Stop => break 'search,
                        }
                        single.tmax = self.single_limit(limit - start);
                    }
                    (t, next) = (next, f64::INFINITY);
                }
            });
        }
    }

    /// Where the ray enters the scene's box, 0 from inside; `None` if it misses it.
    #[inline(always)]
    fn entry(&self, ray: &Ray) -> Option<f64> {
        let bounds = self.bounds?;
        let is_inside = ray.origin.cmpge(bounds.min).all() && ray.origin.cmple(bounds.max).all();
        if is_inside { Some(0.0) } else { bounds.crossing(ray).map(|(enter, _)| enter.max(0.0)) }
    }

    fn single_precision(&self, ray: &Ray, start: f64, limit: f64) -> obvhs::ray::Ray {
        let origin = (ray.at(start) - self.center).as_vec3a();
        // Adding zero makes +0 of -0, of which `obvhs` would miss everything.
        let direction = (ray.direction + Vec3::ZERO).as_vec3a();
        obvhs::ray::Ray::new(origin, direction, 0.0, self.single_limit(limit - start))
    }

    /// A limit that rounding cannot pull in front of a hit.
    fn single_limit(&self, limit: f64) -> f32 {
        (limit + self.padding) as f32
    }
}

/// What a visitor wants next.
enum Continue {
    UpTo(f64),
    Stop,
}

fn ordered([a, b]: [f64; 2]) -> [f64; 2] {
    if b < a { [b, a] } else { [a, b] }
}

impl Leaf {
    fn new(primitive: &Primitive) -> Self {
        let (triangle, shape) = match primitive.geometry {
            Geometry::Triangle(triangle) => (triangle, NO_SHAPE),
            Geometry::Analytic(shape) => (Triangle([Vec3::NAN; 3]), shape),
        };
        Self { triangle, shape, object: primitive.object }
    }
}

fn bounds_of(primitive: &Primitive, analytic: &[Analytic]) -> Bounds {
    match &primitive.geometry {
        Geometry::Triangle(t) => t.bounds(),
        Geometry::Analytic(i) => analytic[*i as usize].bounds(),
    }
}

fn widened(b: Bounds, by: f64) -> Bounds {
    Bounds { min: b.min - by, max: b.max + by }
}

fn pad(b: &Bounds, center: Vec3, padding: f64) -> PaddedBox {
    let b = widened(*b, padding);
    let single = |v: Vec3| -> Vec3A { (v - center).as_vec3a() };
    PaddedBox(Aabb::new(single(b.min), single(b.max)))
}

/// Builds, and builds plainer if the tree is too deep for the traversal stack.
fn build_checked(boxes: &[PaddedBox]) -> Result<CwBvh> {
    if most_coincident(boxes) > MAX_COINCIDENT {
        return Err(too_many_at_one_place());
    }
    let presets =
        [BvhBuildParams::slow_build(), BvhBuildParams::medium_build(), BvhBuildParams::fastest_build()];
    let build = |p| build_cwbvh(boxes, BvhBuildParams { pre_split: false, ..p }, &mut Default::default());
    presets.into_iter().map(build).find(|bvh| depth(bvh) < MAX_DEPTH).ok_or_else(too_many_at_one_place)
}

fn too_many_at_one_place() -> Error {
    Error::value(format!(
        "more than {MAX_COINCIDENT} surfaces stand at the very same place: is a file included too often?"
    ))
}

fn most_coincident(boxes: &[PaddedBox]) -> usize {
    let mut counts: HashMap<[u32; 6], usize> = HashMap::new();
    for b in boxes {
        let (min, max) = (b.0.min.to_array(), b.0.max.to_array());
        let key = [min[0], min[1], min[2], max[0], max[1], max[2]].map(f32::to_bits);
        *counts.entry(key).or_default() += 1;
    }
    counts.into_values().max().unwrap_or(0)
}

fn depth(bvh: &CwBvh) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0usize, 1usize)];
    while let Some((index, level)) = open.pop() {
        let Some(node) = bvh.nodes.get(index) else { continue };
        deepest = deepest.max(level);
        let inner = node.imask.count_ones() as usize;
        open.extend((0..inner).map(|child| (node.child_base_idx as usize + child, level + 1)));
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Cone, Ring, Sphere};
    use sunpeak_core::{Sampler, warp};

    /// Random triangles and shapes; `stretch` draws them out into needles.
    fn soup(count: usize, size: f64, offset: Vec3, seed: u64) -> (Vec<Primitive>, Vec<Analytic>) {
        let mut s = Sampler::new(seed, 0, 0);
        let (mut primitives, mut analytic) = (Vec::new(), Vec::new());
        for i in 0..count {
            let center = offset + 10.0 * Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
            let dir = warp::uniform_sphere(s.next_2d());
            let radius = size * (0.2 + s.next_1d());
            let geometry = if i % 3 > 0 {
                let corner = |s: &mut Sampler| center + size * warp::uniform_sphere(s.next_2d());
                Geometry::Triangle(Triangle([corner(&mut s), corner(&mut s), corner(&mut s)]))
            } else {
                analytic.push(match i % 9 {
                    0 => Analytic::Sphere(Sphere { center, radius, inward: false }),
                    3 => Analytic::Ring(Ring {
                        center,
                        normal: dir,
                        inner_radius: 0.4 * radius,
                        outer_radius: radius,
                    }),
                    _ => Analytic::Cone(
                        Cone::new(center, center + dir * size, radius, 0.5 * radius, false).expect("a cone"),
                    ),
                });
                Geometry::Analytic(analytic.len() as u32 - 1)
            };
            primitives.push(Primitive { geometry, object: i as u32, is_opaque: true, rank: 0 });
        }
        (primitives, analytic)
    }

    fn brute_force(
        primitives: &[Primitive],
        analytic: &[Analytic],
        ray: &Ray,
        t_min: f64,
    ) -> Vec<(f64, u32)> {
        let mut all = Vec::new();
        for p in primitives {
            let ts = match &p.geometry {
                Geometry::Triangle(t) => [t.crossing(ray), f64::INFINITY],
                Geometry::Analytic(i) => analytic[*i as usize].crossings(ray),
            };
            all.extend(ts.into_iter().filter(|t| *t > t_min && t.is_finite()).map(|t| (t, p.object)));
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    fn compare(count: usize, size: f64, offset: Vec3, seed: u64, rays: u64) {
        let (primitives, analytic) = soup(count, size, offset, seed);
        let accel = Accel::build(primitives.clone(), analytic.clone()).expect("builds");
        let t_min = NEAREST * offset.abs().max_element().max(20.0);
        for i in 0..rays {
            let mut s = Sampler::new(seed + 1, i, 0);
            let origin = offset + 14.0 * Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) - 2.0;
            // Every fourth ray runs along an axis: the worst case for slabs.
            let direction = match i % 12 {
                0 => Vec3::X,
                4 => Vec3::NEG_Y,
                8 => Vec3::Z,
                _ => warp::uniform_sphere(s.next_2d()),
            };
            let ray = Ray::new(origin, direction);
            let expected = brute_force(&primitives, &analytic, &ray, t_min);
            let hit = accel.closest(&ray, f64::INFINITY);
            assert_eq!(hit.map(|h| (h.t, h.object)), expected.first().copied());
            let mut all = Vec::new();
            accel.each_crossing(&ray, f64::INFINITY, |h| {
                all.push((h.t, h.object));
                true
            });
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert_eq!(all, expected);
        }
    }

    #[test]
    fn finds_what_brute_force_finds() {
        compare(300, 1.0, Vec3::ZERO, 1, 2000);
        compare(300, 0.05, Vec3::ZERO, 2, 2000);
    }

    #[test]
    fn finds_it_far_from_the_origin() {
        compare(200, 1.0, Vec3::new(5.0e6, -4.0e5, 100.0), 3, 1000);
    }

    #[test]
    fn finds_it_beside_a_wide_ground() {
        let (mut primitives, mut analytic) = soup(100, 0.5, Vec3::ZERO, 4);
        analytic.push(Analytic::Ring(Ring {
            center: Vec3::ZERO,
            normal: Vec3::Z,
            inner_radius: 0.0,
            outer_radius: 5000.0,
        }));
        primitives.push(Primitive {
            geometry: Geometry::Analytic(analytic.len() as u32 - 1),
            object: 100,
            is_opaque: true,
            rank: 0,
        });
        let accel = Accel::build(primitives.clone(), analytic.clone()).expect("builds");
        for i in 0..2000 {
            let mut s = Sampler::new(8, i, 0);
            let origin = 10.0 * Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
            let ray = Ray::new(origin, warp::uniform_sphere(s.next_2d()));
            let expected = brute_force(&primitives, &analytic, &ray, NEAREST * 10.0).first().copied();
            assert_eq!(accel.closest(&ray, f64::INFINITY).map(|h| (h.t, h.object)), expected);
        }
    }

    fn stack(count: u32) -> Vec<Primitive> {
        let triangle = Triangle([Vec3::ZERO, Vec3::X, Vec3::Y]);
        (0..count)
            .map(|i| Primitive {
                geometry: Geometry::Triangle(triangle),
                object: i,
                is_opaque: true,
                rank: 0,
            })
            .collect()
    }

    #[test]
    fn surfaces_at_one_place_are_all_crossed() {
        let accel = Accel::build(stack(100), Vec::new()).expect("builds");
        let mut count = 0;
        let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
        accel.each_crossing(&ray, f64::INFINITY, |_| {
            count += 1;
            true
        });
        assert_eq!(count, 100);
        assert!(Accel::build(stack(20_000), Vec::new()).is_err());
    }

    #[test]
    fn of_coincident_surfaces_the_right_one_is_hit() {
        let up = Triangle([Vec3::ZERO, Vec3::X, Vec3::Y]);
        let down = Triangle([Vec3::ZERO, Vec3::Y, Vec3::X]);
        let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
        let hit = |candidates: &[(Triangle, bool, u32)]| {
            let piece = |(i, &(t, is_opaque, rank)): (usize, &(Triangle, bool, u32))| Primitive {
                geometry: Geometry::Triangle(t),
                object: i as u32,
                is_opaque,
                rank,
            };
            let accel =
                Accel::build(candidates.iter().enumerate().map(piece).collect(), Vec::new()).expect("builds");
            accel.closest(&ray, f64::INFINITY).expect("a hit").object
        };
        let below = Triangle(up.0.map(|v| v - Vec3::Z * 1e-7));
        for (one, other) in [
            ((up, false, 5), (down, true, 1)),
            ((down, true, 5), (up, true, 1)),
            ((up, true, 1), (up, true, 5)),
            ((up, true, 1), (below, true, 5)),
        ] {
            assert_eq!((hit(&[one, other]), hit(&[other, one])), (1, 0), "{one:?} {other:?}");
        }
    }

    #[test]
    fn an_empty_scene_is_missed() {
        let accel = Accel::build(Vec::new(), Vec::new()).expect("builds");
        assert!(accel.closest(&Ray::new(Vec3::ZERO, Vec3::X), f64::INFINITY).is_none());
    }
}
