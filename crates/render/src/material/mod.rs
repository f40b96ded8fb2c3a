//! Materials, as Radiance's reference manual defines them, compiled for rendering.

mod ashikhmin;
mod dielectric;
mod emitter;
mod function;
mod glass;
mod prism;
mod smooth;
mod table;
mod varying;
mod volume;
mod ward;

pub(crate) use ashikhmin::Ashikhmin;
pub(crate) use dielectric::Dielectric;
pub(crate) use emitter::{Emitter, EmitterKind};
pub(crate) use glass::Glass;
pub(crate) use prism::Prism;
pub(crate) use smooth::{Lobes, Smooth, SmoothSample, SmoothValue};
pub(crate) use table::{Table, stands_for_geometry};
pub(crate) use varying::{Mixture, Step, Varying, fault_of, modulation_of, tint_of};
pub(crate) use volume::{Air, Antimatter, Flight, Inside, Mist};
pub(crate) use ward::{Modifiers, Plain, WardMaterial, WgmdMaterial};

use sunpeak_core::{Error, Rgb, Vec3};
use sunpeak_scene::Orientation;

/// Index of a compiled material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MaterialId(pub u32);

/// What stands in for a material towards some rays; `None` is `void`: invisible.
pub(crate) type Alternate = Option<MaterialId>;

/// A material, ready to be asked.
#[derive(Debug)]
pub(crate) enum Material {
    /// `plastic`, `metal`, `trans`, and `plastic2`, `metal2`, `trans2`.
    Ward(WardMaterial),
    /// `ashik2`.
    Ashikhmin(Ashikhmin),
    /// `glass`.
    Glass(Glass),
    /// `dielectric`, `interface`.
    Dielectric(Dielectric),
    /// `mirror`.
    Mirror(Mirror),
    /// `light`, `illum`, `glow`, `spotlight`.
    Emitter(Emitter),
    /// `BSDF`, `aBSDF`.
    Table(Table),
    /// `mist`: the surface itself does nothing.
    Mist(Mist),
    /// `antimatter`, likewise.
    Antimatter(Antimatter),
    /// `plasfunc`, `BRTDfunc` and their like.
    Function(Box<sunpeak_scene::FunctionMaterial>),
    /// `WGMDfunc`.
    Wgmd(WgmdMaterial),
    /// `prism1`, `prism2`.
    Prism(Prism),
    /// Any of these with patterns, textures or mixtures. Only the world can tell which, so that to the questions here it is nothing.
    Varying(Varying),
}

/// A planar mirror: reflects at its front, its back is black.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    pub reflectance: Rgb,
    /// What rays see that are not on their way from a source.
    pub alternate: Option<Alternate>,
}

/// A point of a surface that a ray has reached.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub point: Vec3,
    /// Unit normal of the surface's front, by which it scatters: in a mesh interpolated, always on the ray's side.
    pub normal: Vec3,
    /// Unit normal of the front as the surface lies.
    pub flat_normal: Vec3,
    /// What interpolation and textures add to it before it is a unit vector again.
    pub bend: Vec3,
    /// Unit direction of the ray.
    pub direction: Vec3,
    /// Local coordinates on a mesh.
    pub local: [f64; 2],
    /// What patterns multiply the material's colour with.
    pub tint: Rgb,
    /// Way of the ray since it was last scattered [m].
    pub distance: f64,
    /// Way since the camera [m].
    pub travelled: f64,
}

impl Arrival {
    pub fn new(point: Vec3, normal: Vec3, direction: Vec3) -> Self {
        Self {
            point,
            normal,
            flat_normal: normal,
            bend: Vec3::ZERO,
            direction,
            local: [0.0; 2],
            tint: Rgb::ONE,
            distance: 0.0,
            travelled: 0.0,
        }
    }

    /// The same of a ray that has come so far: since it was last scattered, and since the camera [m].
    pub fn after(self, [distance, travelled]: [f64; 2]) -> Self {
        Self { distance, travelled, ..self }
    }

    /// The same with a smoothed normal. One that looks away from the ray is mirrored to its side (as Radiance does).
    pub fn smoothed(self, normal: Vec3) -> Self {
        let bend = normal - self.flat_normal;
        let cosine = normal.dot(self.direction);
        let is_away = (cosine < 0.0) != self.at_front();
        let normal = if is_away { normal - self.direction * (2.0 * cosine) } else { normal };
        Self { normal: normal.try_normalize().unwrap_or(self.flat_normal), bend, ..self }
    }

    /// The same at a surface that is turned around.
    pub fn turned(&self) -> Self {
        Self { normal: -self.normal, flat_normal: -self.flat_normal, bend: -self.bend, ..*self }
    }

    /// Did the ray come from the front?
    pub fn at_front(&self) -> bool {
        self.direction.dot(self.flat_normal) < 0.0
    }

    /// The normal on the ray's side.
    pub fn facing_normal(&self) -> Vec3 {
        // A factor, since a branch would often be guessed wrong.
        self.normal * if self.at_front() { 1.0 } else { -1.0 }
    }

    /// Cosine between the ray and the normal, positive.
    pub fn cosine(&self) -> f64 {
        self.direction.dot(self.normal).abs()
    }

    /// Is a direction on the same side of the surface as it lies and as its normal is bent?
    pub fn agrees_on(&self, direction: Vec3) -> bool {
        self.normal == self.flat_normal
            || (direction.dot(self.normal) > 0.0) == (direction.dot(self.flat_normal) > 0.0)
    }

    /// The vector by which a material is turned here; zero where its mathematics fails.
    pub fn orientation(&self, orientation: &Orientation) -> Vec3 {
        match orientation {
            Orientation::Fixed(vector) => *vector,
            Orientation::Varying(field) => {
                let vector = field.values(&self.ray_state()).map(|v: [f64; 3]| Vec3::from_array(v));
                vector.map_or(Vec3::ZERO, |v| field.world_direction(v))
            }
        }
    }

    /// Direction of the mirrored ray, not into the surface.
    pub fn mirrored(&self) -> Vec3 {
        let mirrored = reflect(self.direction, self.normal);
        let is_outside = (mirrored.dot(self.flat_normal) > 0.0) == self.at_front();
        if is_outside { mirrored } else { reflect(self.direction, self.flat_normal) }
    }
}

/// What an evaluation of an orientation has found to be wrong.
pub(crate) fn fault_of_orientation(orientation: &Orientation) -> Option<Error> {
    match orientation {
        Orientation::Fixed(_) => None,
        Orientation::Varying(field) => field.fault(),
    }
}

/// Mirror a direction at a plane.
pub(crate) fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// What a surface does to a ray that arrives: a delta straight on, a delta mirrored, a delta refracted, and the smooth rest.
#[derive(Debug)]
pub(crate) struct Scattering<'w> {
    /// Share that goes straight on.
    pub straight: Rgb,
    /// Share that is mirrored.
    pub mirrored: Rgb,
    /// Where rays are refracted to, and with what share; a prism has two ways.
    pub refracted: [Option<(Vec3, Rgb)>; 2],
    /// All the rest.
    pub smooth: Smooth<'w>,
}

impl Scattering<'_> {
    /// Nothing comes back from the surface.
    pub const BLACK: Scattering<'static> =
        Scattering { straight: Rgb::ZERO, mirrored: Rgb::ZERO, refracted: [None; 2], smooth: Smooth::None };
}

impl Material {
    /// How the material scatters a ray. `view`: the ray comes from the camera and met only mirrors and clear panes.
    pub fn scatter(&self, arrival: &Arrival, view: bool) -> Scattering<'_> {
        match self {
            Self::Ward(m) => m.scatter(arrival),
            Self::Ashikhmin(m) => m.scatter(arrival),
            Self::Glass(m) => m.scatter(arrival, view),
            Self::Dielectric(m) => m.scatter(arrival),
            Self::Mirror(m) if arrival.at_front() => {
                Scattering { mirrored: m.reflectance * arrival.tint, ..Scattering::BLACK }
            }
            Self::Function(m) => function::scatter(m, arrival),
            Self::Wgmd(m) => m.scatter(arrival),
            Self::Prism(m) => m.scatter(arrival),
            Self::Mirror(_) | Self::Emitter(_) | Self::Varying(_) => Scattering::BLACK,
            Self::Mist(_) | Self::Antimatter(_) => Scattering { straight: Rgb::ONE, ..Scattering::BLACK },
            Self::Table(m) => m.scatter(arrival, view),
        }
    }

    /// Share of a shadow ray that goes straight on. `direct`: it is on its way to a light source, not to the sky
    /// (see [`Table::straight`]).
    pub fn straight(&self, arrival: &Arrival, direct: bool) -> Rgb {
        match self {
            Self::Ward(m) => m.straight(arrival),
            Self::Glass(m) => m.transmittance(arrival.cosine()) * arrival.tint,
            Self::Table(m) => m.straight(arrival, direct),
            Self::Mist(_) | Self::Antimatter(_) => Rgb::ONE,
            Self::Function(m) => function::straight(m, arrival),
            Self::Wgmd(m) => m.straight(arrival),
            _ => Rgb::ZERO,
        }
    }

    /// Is [`Self::straight`] nothing, by whatever ray it is met?
    pub fn is_wall(&self) -> bool {
        match self {
            Self::Ward(m) => !m.is_trans(),
            Self::Ashikhmin(_) => true,
            _ => false,
        }
    }

    /// Does it scatter light to its other side?
    pub fn is_shade(&self) -> bool {
        match self {
            Self::Ward(m) => m.is_trans(),
            Self::Function(m) => (m.diffuse_transmission + m.transmission).max_element() > 0.0,
            Self::Wgmd(m) => m.is_shade(),
            Self::Table(_) => true,
            _ => false,
        }
    }

    /// Does Radiance call it transparent? Of surfaces at the same place opaque ones are seen; a transparent alternate hides its
    /// mirror altogether.
    pub fn is_transparent(&self) -> bool {
        match self {
            Self::Glass(_) | Self::Dielectric(_) | Self::Mist(_) | Self::Antimatter(_) => true,
            Self::Ward(m) => m.is_trans(),
            Self::Function(m) => (m.diffuse_transmission + m.transmission).max_element() > 0.0,
            Self::Wgmd(m) => m.is_trans(),
            Self::Prism(_) => true,
            Self::Table(m) => m.is_aperture,
            _ => false,
        }
    }
}
