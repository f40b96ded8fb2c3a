//! `plasfunc`, `metfunc`, `transfunc`, their `…data` siblings and `BRTDfunc`: diffuse lobes and a function of the direction to the light.
//!
//! Radiance asks the function only for light sources, and takes the whole for diffuse where it gathers other light. Here the
//! function scatters all light, which is the same where it integrates to 1, as the manual demands. Light sources are left to shadow rays
//! alone: the function may ask for their solid angle.

use super::{Arrival, Scattering, Smooth, SmoothSample, SmoothValue};
use std::f64::consts::FRAC_1_PI;
use sunpeak_core::{Frame, Rgb, Vec3, luminance, warp};
use sunpeak_scene::{FunctionMaterial, RayState};

/// Solid angle that a function is told for light that is no light source [sr].
const NO_SOURCE: f64 = 1e-6;

/// Smallest cosine at which light counts (Radiance, `FTINY`).
const SMALLEST_COSINE: f64 = 1e-6;

/// The share of light that a function is taken to scatter where its own factor does not say so.
const LARGEST_GUESS: f64 = 1.0;

/// What the functions see of the ray.
fn seen(material: &FunctionMaterial, arrival: &Arrival) -> RayState {
    let mut ray = arrival.ray_state();
    ray.perturbed = arrival.facing_normal();
    ray.color = material.color * arrival.tint;
    if material.is_turned && !arrival.at_front() {
        ray.normal = -ray.normal;
    }
    ray
}

/// Three of the first six expressions of a material that has them.
fn share(material: &FunctionMaterial, ray: &RayState, first: usize) -> Rgb {
    if !material.has_straight {
        return Rgb::ZERO;
    }
    let value = |i: usize| material.field.call(ray, first + i, &[]);
    match (value(0), value(1), value(2)) {
        (Some(r), Some(g), Some(b)) => Rgb::new(r, g, b).max(Rgb::ZERO),
        _ => Rgb::ZERO,
    }
}

/// Share of a shadow ray that goes straight on.
pub(super) fn straight(material: &FunctionMaterial, arrival: &Arrival) -> Rgb {
    share(material, &seen(material, arrival), 3)
}

pub(super) fn scatter<'w>(material: &'w FunctionMaterial, arrival: &Arrival) -> Scattering<'w> {
    let ray = seen(material, arrival);
    let diffuse = material.diffuse[usize::from(!arrival.at_front())];
    let of_metal = if material.is_metal { arrival.tint } else { Rgb::ONE };
    // The transmitted function has the colour of `trans`; that of `BRTDfunc` is its own.
    let through = if material.has_straight { Rgb::ONE } else { arrival.tint };
    let lobes = FunctionLobes {
        material,
        frame: Frame::from_normal(arrival.facing_normal()),
        diffuse: [diffuse * arrival.tint, material.diffuse_transmission * arrival.tint],
        function: [material.reflection * of_metal, material.transmission * through],
        ray,
    };
    let smooth = if lobes.albedo() > 0.0 { Smooth::Function(Box::new(lobes)) } else { Smooth::None };
    Scattering {
        straight: share(material, &ray, 3),
        mirrored: share(material, &ray, 0),
        refracted: [None; 2],
        smooth,
    }
}

/// The lobes at one point, z towards the ray's side.
#[derive(Clone, Debug)]
pub(crate) struct FunctionLobes<'w> {
    material: &'w FunctionMaterial,
    frame: Frame,
    ray: RayState,
    /// Reflected and transmitted.
    diffuse: [Rgb; 2],
    /// Factors of the function, reflected and transmitted.
    function: [Rgb; 2],
}

impl FunctionLobes<'_> {
    fn weight(&self, side: usize) -> f64 {
        let has_none = self.material.value == sunpeak_scene::FunctionValue::Color([None; 3]);
        let function = if has_none { 0.0 } else { luminance(self.function[side]).min(LARGEST_GUESS) };
        luminance(self.diffuse[side]) + function
    }

    pub fn albedo(&self) -> f64 {
        self.weight(0) + self.weight(1)
    }

    pub fn evaluate(&self, direction: Vec3) -> SmoothValue {
        self.toward_source(direction, NO_SOURCE)
    }

    pub fn toward_source(&self, direction: Vec3, solid_angle: f64) -> SmoothValue {
        let cosine = direction.dot(self.frame.z);
        if cosine.abs() <= SMALLEST_COSINE {
            return SmoothValue::default();
        }
        let side = usize::from(cosine < 0.0);
        let factor = self.function[side];
        let glossy = match factor == Rgb::ZERO {
            true => Rgb::ZERO,
            false => factor * self.material.evaluate(&self.ray, direction, solid_angle),
        };
        SmoothValue { diffuse: self.diffuse[side] * FRAC_1_PI, glossy }
    }

    pub fn pdf(&self, direction: Vec3) -> f64 {
        let cosine = direction.dot(self.frame.z);
        self.weight(usize::from(cosine < 0.0)) / self.albedo() * cosine.abs() * FRAC_1_PI
    }

    pub fn sample(&self, choice: f64, u: [f64; 2]) -> Option<SmoothSample> {
        let mut local = warp::cosine_hemisphere(u);
        if choice * self.albedo() >= self.weight(0) {
            local.z = -local.z;
        }
        let direction = self.frame.to_world(local);
        let pdf = self.pdf(direction);
        let weight = self.evaluate(direction).scaled(local.z.abs() / pdf);
        (pdf > 0.0).then_some(SmoothSample { direction, weight, pdf, source_factor: 0.0 })
    }
}
