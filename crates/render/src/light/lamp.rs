//! Emitting surfaces in the room.

use super::{Light, LightSample};
use crate::material::Emitter;
use crate::shapes::{Cone, Ring, Sphere, Triangle};
use std::f64::consts::PI;
use sunpeak_core::{Frame, Sampler, Vec3, luminance, warp};
use sunpeak_scene::RayState;

/// Points and directions at which a lamp's patterns are tried.
const PATTERN_SAMPLES: u64 = 64;

/// A lamp whose patterns were dark wherever they were tried is still looked at.
const LEAST_PATTERN: f64 = 1e-3;

/// Where the light leaves.
#[derive(Clone, Debug)]
pub(crate) enum LampShape {
    /// A polygon, in triangles.
    Triangles { triangles: Vec<Triangle>, cumulated: Vec<f32>, normal: Vec3, area: f64 },
    /// A sphere or bubble.
    Sphere(Sphere),
    /// A cone, cylinder, cup or tube.
    Cone(Cone),
    /// A ring.
    Ring(Ring),
}

/// An emitting object.
#[derive(Clone, Debug)]
pub(crate) struct Lamp {
    pub object: u32,
    pub emitter: Emitter,
    pub shape: LampShape,
}

impl LampShape {
    /// `None` if the triangles have no area.
    pub fn triangles(triangles: Vec<Triangle>, normal: Vec3) -> Option<Self> {
        let areas: Vec<f64> = triangles.iter().map(Triangle::area).collect();
        let area = areas.iter().sum();
        let cumulated = running_sums(&areas);
        (area > 0.0).then_some(Self::Triangles { triangles, cumulated, normal, area })
    }

    pub fn area(&self) -> f64 {
        match self {
            Self::Triangles { area, .. } => *area,
            Self::Sphere(s) => 4.0 * PI * s.radius * s.radius,
            Self::Cone(s) => s.area(),
            Self::Ring(s) => s.area(),
        }
    }

    /// Centre and radius of a sphere around it.
    pub fn surroundings(&self) -> (Vec3, f64) {
        let b = match self {
            Self::Triangles { triangles, .. } => triangles
                .iter()
                .map(Triangle::bounds)
                .reduce(|a, b| a.union(b))
                .unwrap_or(crate::shapes::Bounds::EMPTY),
            Self::Sphere(s) => return (s.center, s.radius),
            Self::Cone(s) => s.bounds(),
            Self::Ring(s) => s.bounds(),
        };
        (0.5 * (b.min + b.max), 0.5 * (b.max - b.min).length())
    }

    /// A point uniform over the area, and the normal there.
    fn sample_area(&self, u: [f64; 2]) -> (Vec3, Vec3) {
        match self {
            Self::Triangles { triangles, cumulated, normal, .. } => {
                let (i, rest) = pick(cumulated, u[0]);
                (Triangle::sample([rest, u[1]], triangles[i].0), *normal)
            }
            Self::Sphere(s) => {
                let p = s.center + sunpeak_core::warp::uniform_sphere(u) * s.radius;
                (p, s.normal(p))
            }
            Self::Cone(s) => {
                let p = s.sample(u);
                (p, s.normal(p))
            }
            Self::Ring(s) => (s.sample(u), s.normal),
        }
    }
}

impl Lamp {
    /// Luminous power over pi, for choosing among lamps.
    pub fn strength(&self) -> f64 {
        luminance(self.emitter.radiance) * self.shape.area() * self.mean_pattern()
    }

    /// What patterns do to the power, roughly, but never nothing: lamps are chosen by it.
    fn mean_pattern(&self) -> f64 {
        if self.emitter.patterns.is_empty() {
            return 1.0;
        }
        let plain = luminance(self.emitter.radiance);
        let (_, far) = self.shape.surroundings();
        let one = |i| {
            let mut sampler = Sampler::new(0, 0, i);
            let (point, normal) = self.shape.sample_area(sampler.next_2d());
            let away = Frame::from_normal(normal).to_world(warp::cosine_hemisphere(sampler.next_2d()));
            let ray = RayState::new(point, normal, -away, 10.0 * far);
            luminance(self.emitter.radiance(&ray)) / plain
        };
        let mean = (0..PATTERN_SAMPLES).map(one).sum::<f64>() / PATTERN_SAMPLES as f64;
        if mean.is_finite() { mean.max(LEAST_PATTERN) } else { 1.0 }
    }

    /// A direction towards the lamp from `from`; `None` if its point shows its back.
    pub fn sample(&self, from: Vec3, u: [f64; 2]) -> Option<LightSample> {
        if let Some((direction, distance, pdf)) = self.sample_sphere(from, u) {
            let normal = self.sphere_normal(from + direction * distance);
            return Some(self.light_sample(from, direction, distance, normal, pdf));
        }
        let (point, normal) = self.shape.sample_area(u);
        let distance = point.distance(from);
        let direction = (point - from) / distance;
        let pdf = self.area_pdf(direction, distance, normal);
        (pdf.is_finite() && pdf > 0.0).then(|| self.light_sample(from, direction, distance, normal, pdf))
    }

    /// Density [1/sr] of `sample` for a direction that meets the lamp at this distance, where its normal is `normal`.
    pub fn pdf(&self, from: Vec3, direction: Vec3, distance: f64, normal: Vec3) -> f64 {
        match self.outside_cone(from) {
            Some((_, solid_angle)) => 1.0 / solid_angle,
            None => self.area_pdf(direction, distance, normal),
        }
    }

    fn area_pdf(&self, direction: Vec3, distance: f64, normal: Vec3) -> f64 {
        let cosine = -direction.dot(normal);
        if cosine > 0.0 { distance * distance / (cosine * self.shape.area()) } else { 0.0 }
    }

    /// For a sphere seen from outside: sine squared of its angular radius, and its solid angle [sr].
    fn outside_cone(&self, from: Vec3) -> Option<(f64, f64)> {
        let LampShape::Sphere(Sphere { center, radius, inward: false }) = self.shape else { return None };
        let sine2 = radius * radius / from.distance_squared(center);
        // 1 - cos without cancellation.
        let height = sine2 / (1.0 + (1.0 - sine2).max(0.0).sqrt());
        (sine2 < 1.0).then_some((sine2, 2.0 * PI * height))
    }

    /// Uniform in the cone that a sphere fills (Pharr, Jakob and Humphreys 2023, section 6.2.4).
    fn sample_sphere(&self, from: Vec3, u: [f64; 2]) -> Option<(Vec3, f64, f64)> {
        let (_, solid_angle) = self.outside_cone(from)?;
        let LampShape::Sphere(Sphere { center, radius, .. }) = self.shape else { return None };
        let height = u[0] * solid_angle / (2.0 * PI);
        let side = (height * (2.0 - height)).sqrt();
        let [cos, sin] = warp::circle(u[1]);
        let axis = (center - from).normalize_or(Vec3::Z);
        let direction = Frame::from_normal(axis).to_world(Vec3::new(side * cos, side * sin, 1.0 - height));
        let along = (center - from).dot(direction);
        let half_chord2 = radius * radius - (center - from).length_squared() + along * along;
        Some((direction, along - half_chord2.max(0.0).sqrt(), 1.0 / solid_angle))
    }

    fn sphere_normal(&self, point: Vec3) -> Vec3 {
        match &self.shape {
            LampShape::Sphere(sphere) => sphere.normal(point),
            _ => Vec3::ZERO,
        }
    }

    fn light_sample(
        &self,
        from: Vec3,
        direction: Vec3,
        distance: f64,
        normal: Vec3,
        pdf: f64,
    ) -> LightSample {
        let ray = RayState::new(from + direction * distance, normal, direction, distance);
        LightSample {
            direction,
            distance,
            light: Light::Known(self.emitter.radiance(&ray) * self.emitter.falloff(distance)),
            pdf,
            solid_angle: (1.0 / pdf).min(4.0 * PI),
            is_direct: self.emitter.is_direct(distance),
            object: Some(self.object),
            is_dome: false,
            is_hidden_by_illum: self.emitter.is_hidden_by_illum(),
        }
    }
}

/// Running sums, normalised to end at 1.
fn running_sums(weights: &[f64]) -> Vec<f32> {
    let whole: f64 = weights.iter().sum();
    let mut sum = 0.0;
    let mut add = |w: &f64| {
        sum += w / whole;
        sum as f32
    };
    weights.iter().map(&mut add).collect()
}

/// The step of running sums into which `u` falls, and where in it, 0 to 1.
fn pick(sums: &[f32], u: f64) -> (usize, f64) {
    let i = sums.partition_point(|&sum| f64::from(sum) <= u).min(sums.len() - 1);
    let before = if i > 0 { f64::from(sums[i - 1]) } else { 0.0 };
    (i, ((u - before).max(0.0) / (f64::from(sums[i]) - before)).min(1.0 - f64::EPSILON))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::EmitterKind;
    use sunpeak_core::gray;

    fn lamp(shape: LampShape) -> Lamp {
        let emitter = Emitter { radiance: gray(1.0), patterns: Vec::new(), kind: EmitterKind::Light };
        Lamp { object: 0, emitter, shape }
    }

    /// Mean of cos/pdf: the irradiance of a lamp of radiance 1 on a surface that faces up.
    fn irradiance(lamp: &Lamp, from: Vec3) -> f64 {
        let n = 1 << 14;
        let one = |i| lamp.sample(from, Sampler::new(4, 0, i).next_2d());
        let light = |s: LightSample| {
            let Light::Known(radiance) = s.light else { panic!("a lamp is no source at infinity") };
            radiance.x * s.direction.z.max(0.0) / s.pdf
        };
        (0..n).filter_map(one).map(light).sum::<f64>() / n as f64
    }

    #[test]
    fn lamps_light_as_closed_forms_say() {
        // Disc and sphere centred overhead: pi sin² of the angular radius.
        let ring = Ring {
            center: Vec3::new(0.0, 0.0, 2.0),
            normal: Vec3::NEG_Z,
            inner_radius: 0.0,
            outer_radius: 1.0,
        };
        let e = irradiance(&lamp(LampShape::Ring(ring)), Vec3::ZERO);
        assert!((e - PI / 5.0).abs() < 1e-3 * PI, "{e}");
        let sphere = Sphere { center: Vec3::new(0.0, 0.0, 2.0), radius: 1.0, inward: false };
        let e = irradiance(&lamp(LampShape::Sphere(sphere)), Vec3::ZERO);
        assert!((e - PI / 4.0).abs() < 1e-3 * PI, "{e}");
        // From inside a bubble everything shines.
        let bubble = Sphere { inward: true, ..sphere };
        let e = irradiance(&lamp(LampShape::Sphere(bubble)), Vec3::new(0.0, 0.3, 1.8));
        assert!((e - PI).abs() < 2e-2 * PI, "{e}");
        // A tube around the sensor: sky factor of a ring of elevation, from the floor to 45 degrees: pi/2.
        let tube = Cone::new(Vec3::ZERO, Vec3::Z, 1.0, 1.0, true).expect("a cone");
        let e = irradiance(&lamp(LampShape::Cone(tube)), Vec3::ZERO);
        assert!((e - PI / 2.0).abs() < 1e-2 * PI, "{e}");
        // A square of side 2 at height 1: four times the corner formula (Howell, catalog B-4 in units of pi).
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, y]| Vec3::new(x, y, 1.0));
        let halves = [[0, 1, 2], [0, 2, 3]].map(|t| Triangle(t.map(|i| corners[i]))).to_vec();
        let square = LampShape::triangles(halves, Vec3::NEG_Z).expect("has an area");
        let root = 2f64.sqrt();
        let expected = 4.0 * (1.0 / root) * (1.0 / root).atan();
        let e = irradiance(&lamp(square), Vec3::ZERO);
        assert!((e - expected).abs() < 1e-2, "{e} {expected}");
    }

    #[test]
    fn density_is_that_of_the_samples() {
        let sphere = lamp(LampShape::Sphere(Sphere { center: Vec3::ONE, radius: 0.3, inward: false }));
        let s = sphere.sample(Vec3::ZERO, [0.3, 0.6]).expect("a sample");
        let p = s.direction * s.distance;
        assert!((p.distance(Vec3::ONE) - 0.3).abs() < 1e-12);
        let normal = (p - Vec3::ONE) / 0.3;
        assert!((sphere.pdf(Vec3::ZERO, s.direction, s.distance, normal) / s.pdf - 1.0).abs() < 1e-12);
    }
}
