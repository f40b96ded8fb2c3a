//! A scene compiled for rendering.

mod compile;

use crate::WorldOptions;
use crate::accel::{Accel, Hit};
use crate::guide::Guide;
use crate::light::{DistantSources, Lamps};
use crate::material::{Alternate, Arrival, Emitter, EmitterKind, Material, MaterialId};
use crate::shapes::Ray;
use std::sync::atomic::{AtomicU64, Ordering};
use sunpeak_bsdf::PeakRule;
use sunpeak_core::{Result, Rgb, Vec3};
use sunpeak_scene::Scene;

/// Surfaces in one hierarchy, materials and emitters. Immutable, shared by all threads.
#[derive(Debug)]
pub struct World {
    pub(crate) accel: Accel,
    pub(crate) objects: Vec<Object>,
    /// Of each object: which surface of the scene it is.
    pub(crate) surfaces: Vec<u32>,
    pub(crate) materials: Vec<Material>,
    pub(crate) distant: DistantSources,
    pub(crate) lamps: Lamps,
    /// Objects that are planar mirrors.
    pub(crate) mirrors: Vec<u32>,
    pub(crate) rule: PeakRule,
    pub(crate) rays: AtomicU64,
    /// Where diffuse surfaces look for light, if there are shades.
    pub(crate) guide: Option<Guide>,
}

/// A surface of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Object {
    pub material: MaterialId,
    pub facing: Facing,
    /// Index among the lamps.
    pub lamp: Option<u32>,
}

/// Where the normal comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Facing {
    /// The same all over.
    Flat(Vec3),
    /// From an analytic shape.
    Curved(u32),
}

/// What a path meets at a surface.
pub(crate) enum Seen<'w> {
    /// Nothing: the surface is invisible to this ray.
    Void,
    /// A source of light.
    Emitter(&'w Emitter),
    /// A surface that scatters.
    Surface(&'w Material),
}

impl World {
    /// Compile a scene: triangulate, load BSDF files, build the hierarchy, find the emitters.
    ///
    /// # Errors
    /// Where the scene asks for something that cannot be rendered: the place in the file and what to do.
    pub fn compile(scene: &Scene, options: &WorldOptions) -> Result<Self> {
        compile::compile(scene, options)
    }

    /// Number of surfaces that rays can hit.
    pub fn surface_count(&self) -> usize {
        self.objects.len()
    }

    /// The rule by which `aBSDF` materials pass light straight.
    pub fn peak_rule(&self) -> PeakRule {
        self.rule
    }

    /// Distance from `origin` to the first surface in the unit vector's `direction`, visible or not.
    pub fn distance(&self, origin: Vec3, direction: Vec3) -> Option<f64> {
        self.accel.closest(&Ray::new(origin, direction), f64::INFINITY).map(|hit| hit.t)
    }

    /// Rays that were traced for pictures, rays and sensors so far, shadow rays included.
    pub fn rays_traced(&self) -> u64 {
        self.rays.load(Ordering::Relaxed)
    }

    pub(crate) fn object(&self, hit: &Hit) -> &Object {
        &self.objects[hit.object as usize]
    }

    pub(crate) fn material(&self, id: MaterialId) -> &Material {
        &self.materials[id.0 as usize]
    }

    pub(crate) fn arrival(&self, hit: &Hit, ray: &Ray) -> Arrival {
        let point = ray.at(hit.t);
        let normal = match self.object(hit).facing {
            Facing::Flat(normal) => normal,
            Facing::Curved(shape) => self.accel.shape(shape).normal(point),
        };
        Arrival { point, normal, direction: ray.direction }
    }

    /// What a path sees. `view`: it comes from the camera and met only mirrors and clear panes.
    pub(crate) fn seen(&self, object: &Object, arrival: &Arrival, view: bool) -> Seen<'_> {
        match self.material(object.material) {
            Material::Emitter(emitter) => match emitter.kind {
                EmitterKind::Illum { alternate } if view || !arrival.at_front() => self.alternate(alternate),
                _ => Seen::Emitter(emitter),
            },
            Material::Mirror(mirror) => match mirror.alternate {
                Some(alternate) if view || !arrival.at_front() || self.is_transparent(alternate) => {
                    self.alternate(alternate)
                }
                _ => Seen::Surface(self.material(object.material)),
            },
            material => Seen::Surface(material),
        }
    }

    /// Reflectance of an object that is a mirror.
    pub(crate) fn mirror_reflectance(&self, object: u32) -> Rgb {
        match self.material(self.objects[object as usize].material) {
            Material::Mirror(mirror) => mirror.reflectance,
            _ => Rgb::ZERO,
        }
    }

    fn alternate(&self, alternate: Alternate) -> Seen<'_> {
        match alternate.map(|id| self.material(id)) {
            None => Seen::Void,
            Some(Material::Emitter(emitter)) => Seen::Emitter(emitter),
            Some(material) => Seen::Surface(material),
        }
    }

    fn is_transparent(&self, alternate: Alternate) -> bool {
        alternate.is_none_or(|id| self.material(id).is_transparent())
    }
}
