//! The state of a path while it is traced.

use crate::material::{Arrival, Inside, Material};
use crate::shapes::Ray;
use sunpeak_core::{Rgb, Vec3};

/// The last vertex at which the path was scattered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure {
    pub point: Vec3,
    /// Density [1/sr] of the direction that was taken.
    pub pdf: f64,
    /// What light sources in this direction are multiplied with.
    pub source_factor: f64,
    /// Are paths from here tied to patches of sun as well?
    pub is_tied: bool,
}

/// A path from the camera or a sensor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    pub ray: Ray,
    /// Nothing farther than this is seen (a view's aft plane).
    pub reach: f64,
    pub throughput: Rgb,
    /// Surfaces met.
    pub events: u32,
    /// Diffuse bounces taken.
    pub bounces: u32,
    /// `None` while the chain reaches back to the camera.
    pub departure: Option<Departure>,
    /// Mirrored or refracted since the departure, or since the camera?
    pub is_bent: bool,
    /// Met nothing since the departure?
    pub is_clear: bool,
    /// Passed the peak of a table since the departure?
    pub is_past_peak: bool,
    /// Refracted, or mirrored by a curved surface, since the camera?
    pub is_distorted: bool,
    /// Direction of the first segment.
    pub first_direction: Vec3,
    /// What the light past the last diffuse bounce adds at the end.
    pub ambient: Rgb,
    /// Radiance that the path may find of a far field that was counted before (see [`crate::backlight`]).
    pub known: Rgb,
    /// May it find such light?
    pub is_known: bool,
    /// Extinction of the solid that the path is in [1/m].
    extinction: Rgb,
    /// Way since the camera, and since the path was last scattered, mirrored or refracted [m].
    travelled: f64,
    distance: f64,
    /// Mist and antimatter that the path is in.
    pub inside: Inside,
}

impl Path {
    pub fn from_camera(ray: Ray, reach: f64, inside: Inside) -> Self {
        Self {
            ray,
            reach,
            throughput: Rgb::ONE,
            events: 0,
            bounces: 0,
            departure: None,
            is_bent: false,
            is_clear: false,
            is_past_peak: false,
            is_distorted: false,
            first_direction: ray.direction,
            ambient: Rgb::ZERO,
            known: Rgb::ZERO,
            is_known: false,
            extinction: Rgb::ZERO,
            travelled: 0.0,
            distance: 0.0,
            inside,
        }
    }

    /// Another path that goes on from here.
    pub fn branch(&self) -> Self {
        Self { ambient: Rgb::ZERO, ..*self }
    }

    /// Does the path come from the camera with nothing but straight passes, mirrors and refractions?
    pub fn is_view(&self) -> bool {
        self.departure.is_none()
    }

    /// Take off what is known, times what the path carries, once.
    pub fn take_known(&mut self) -> Rgb {
        std::mem::replace(&mut self.known, Rgb::ZERO) * self.throughput
    }

    /// Count the way to a surface.
    pub fn travel(&mut self, distance: f64) {
        self.reach -= distance;
        self.travelled += distance;
        self.distance += distance;
        self.events += 1;
        if self.extinction != Rgb::ZERO {
            self.throughput *= (-self.extinction * distance).exp();
        }
    }

    /// Way since the path was last scattered, mirrored or refracted, and since the camera [m].
    pub fn way(&self) -> [f64; 2] {
        [self.distance, self.travelled]
    }

    /// Weaken the way to the face of a solid that the path did not enter by a face: it started inside.
    pub fn absorb(&mut self, material: &Material, arrival: &Arrival, distance: f64) {
        if let Material::Dielectric(solid) = material
            && let Some(extinction) = solid.extinction_before(arrival)
            && self.extinction == Rgb::ZERO
        {
            self.throughput *= (-extinction * distance).exp();
        }
    }

    /// A null event.
    pub fn go_straight(&mut self, point: Vec3, share: Rgb) {
        self.ray = Ray::past(point, self.ray.direction);
        self.throughput *= share;
        self.is_clear = false;
    }

    pub fn mirror(&mut self, arrival: &Arrival, share: Rgb, is_flat: bool) {
        self.ray = Ray::new(arrival.point, arrival.mirrored());
        self.distance = 0.0;
        self.reach = f64::INFINITY;
        self.throughput *= share;
        self.is_bent = true;
        self.is_clear = false;
        self.is_distorted |= !is_flat;
    }

    pub fn refract(&mut self, arrival: &Arrival, direction: Vec3, share: Rgb, material: Option<&Material>) {
        self.ray = Ray::new(arrival.point, direction);
        self.distance = 0.0;
        self.throughput *= share;
        self.is_bent = true;
        self.is_clear = false;
        self.is_distorted = true;
        self.extinction = match material {
            Some(Material::Dielectric(solid)) => solid.extinction_behind(arrival),
            _ => Rgb::ZERO,
        };
    }

    pub fn depart(&mut self, departure: Departure, direction: Vec3, weight: Rgb) {
        self.ray = Ray::new(departure.point, direction);
        self.distance = 0.0;
        self.reach = f64::INFINITY;
        self.throughput *= weight;
        self.departure = Some(departure);
        self.is_bent = false;
        self.is_clear = true;
        self.is_past_peak = false;
        self.is_known = false;
    }
}
