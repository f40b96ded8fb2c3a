//! What expressions see of a ray.

use super::FieldFrame;
use std::f64::consts::PI;
use sunpeak_cal::{Definitions, Inputs};
use sunpeak_core::{Rgb, Vec3};

/// A ray that has met a surface, in world axes.
#[derive(Clone, Copy, Debug)]
pub struct RayState {
    /// Where.
    pub point: Vec3,
    /// Unit normal of the surface as it lies, on its front.
    pub normal: Vec3,
    /// Unit direction of the ray.
    pub direction: Vec3,
    /// Way of the ray since it was last scattered [m] (`Ts`).
    pub distance: f64,
    /// Way since the camera [m] (`T`).
    pub travelled: f64,
    /// Local coordinates on a mesh (`Lu`, `Lv`).
    pub local: [f64; 2],
    /// Unit normal after textures (`NxP` …).
    pub perturbed: Vec3,
    /// Colour after patterns (`CrP` …).
    pub color: Rgb,
    /// Direction to the light source that a prism is asked for, zero if none (`DxA` …).
    pub target: Vec3,
}

impl RayState {
    /// A ray that meets a surface without textures and patterns.
    pub fn new(point: Vec3, normal: Vec3, direction: Vec3, distance: f64) -> Self {
        Self {
            point,
            normal,
            direction,
            distance,
            travelled: distance,
            local: [0.0; 2],
            perturbed: normal,
            color: Rgb::ONE,
            target: Vec3::ZERO,
        }
    }
}

/// Names and numbers of the channels; the first 27 are Radiance's.
const CHANNELS: &[&str] = &[
    "Dx", "Dy", "Dz", "Nx", "Ny", "Nz", "Px", "Py", "Pz", "T", "Rdot", "S", "Tx", "Ty", "Tz", "Ix", "Iy",
    "Iz", "Jx", "Jy", "Jz", "Kx", "Ky", "Kz", "Ts", "Lu", "Lv", "NxP", "NyP", "NzP", "RdotP", "CrP", "CgP",
    "CbP", "DxA", "DyA", "DzA",
];

const SOURCE_CORR: u32 = 0;
const SOURCE_THETA: u32 = 1;
const SOURCE_PHI: u32 = 2;

/// What is defined of rays in the language itself: vectors as functions, coordinates on the surface, and the local hemisphere
/// of function and data materials, whose up vector is the last three real arguments.
///
/// U and V: the origin's offset along the horizontal in the surface, and along the surface's steepest line.
const RAY_FUNCTIONS: &str = "
D(i) = select(i, Dx, Dy, Dz);
N(i) = select(i, Nx, Ny, Nz);
P(i) = select(i, Px, Py, Pz);
horizontal`ray = Nx*Nx + Ny*Ny;
U = if(horizontal`ray - FTINY, (Py*Nx - Px*Ny) / horizontal`ray, Px);
V = if(horizontal`ray - FTINY, Pz - Nz * (Px*Nx + Py*Ny) / horizontal`ray, Py);
up`ray(i) = arg(AC - 3 + i);
normal`ray(i) = select(i, NxP, NyP, NzP);
right`ray(i) = cross(i, up`ray, normal`ray);
length`ray = sqrt(dot(right`ray, right`ray));
y`ray(i) = right`ray(i) / length`ray;
x`ray(i) = cross(i, normal`ray, y`ray);
Ldx(dx, dy, dz) = dx*x`ray(1) + dy*x`ray(2) + dz*x`ray(3);
Ldy(dx, dy, dz) = dx*y`ray(1) + dy*y`ray(2) + dz*y`ray(3);
Ldz(dx, dy, dz) = dx*NxP + dy*NyP + dz*NzP;
Idx = Ldx(-Dx, -Dy, -Dz);
Idy = Ldy(-Dx, -Dy, -Dz);
Idz = RdotP;
";

/// The library with everything that can be asked of a ray.
pub(crate) fn ray_definitions() -> Definitions {
    let mut definitions = Definitions::new();
    for (name, channel) in CHANNELS.iter().zip(1..) {
        definitions.name_channel(name, channel);
    }
    for (name, id, parameters) in
        [("source_corr", SOURCE_CORR, 2), ("source_theta", SOURCE_THETA, 1), ("source_phi", SOURCE_PHI, 1)]
    {
        definitions.name_function(name, id, parameters);
    }
    definitions.load(RAY_FUNCTIONS.as_bytes(), "the ray's functions", "").expect("they are in the language");
    definitions
}

/// A ray in the frame of a field.
pub(super) struct Seen<'a> {
    pub ray: &'a RayState,
    pub frame: &'a FieldFrame,
    /// Real arguments.
    pub arguments: &'a [f64],
}

impl Seen<'_> {
    fn direction(&self, world: Vec3) -> Vec3 {
        self.frame.to_local.vector(world) / self.frame.scale
    }

    fn point(&self) -> Vec3 {
        self.frame.to_local.point(self.ray.point)
    }

    fn cosine(&self, normal: Vec3) -> f64 {
        (-normal.dot(self.ray.direction)).clamp(-1.0, 1.0)
    }

    /// `source_corr(value, kind)`: candela to radiance, by the luminous area as the ray sees it. The first real argument
    /// multiplies; the next are the sizes of the source [m].
    fn source_corr(&self, value: f64, kind: f64) -> Option<f64> {
        let value = if self.arguments.len() > 1 { value * self.arguments[0] } else { value };
        if value <= 0.0 {
            return Some(0.0);
        }
        let size = |i: usize| self.arguments.get(i).copied();
        let d = self.direction(self.ray.direction);
        let faces = |w: Vec3| -> Option<f64> {
            let (x, y, z) = (size(1)?, size(2)?, size(3)?);
            Some(w.x * y * z + w.y * x * z + w.z * x * y)
        };
        match (kind + 0.5) as i64 {
            0 => Some(value),
            1 => Some(value / self.cosine(self.ray.normal)),
            2 => Some(value / faces(d.abs())?),
            3 => {
                // From nearby: the faces that the ray's origin sees, each by its distance.
                let distance = self.ray.distance * self.frame.scale;
                let half = Vec3::new(size(1)?, size(2)?, size(3)?) * 0.5;
                let outside = ((self.point() - d * distance).abs() - half).max(Vec3::ZERO);
                Some(value * distance / faces(outside)?)
            }
            4 => {
                let (diameter, height) = (size(1)?, size(2)?);
                let sine = (1.0 - d.z * d.z).max(0.0).sqrt();
                Some(value / (diameter * height * sine + 0.25 * PI * diameter * diameter * d.z.abs()))
            }
            _ => None,
        }
    }

    /// Angle from the negative z axis, in which light leaves a lamp that hangs [deg].
    fn source_theta(&self) -> f64 {
        self.direction(self.ray.direction).z.clamp(-1.0, 1.0).acos().to_degrees()
    }

    /// Azimuth of leaving light from the x axis [deg]; `symmetry` is the range that the data has.
    fn source_phi(&self, symmetry: f64) -> Option<f64> {
        let d = self.direction(self.ray.direction);
        let phi = (-d.y).atan2(-d.x).to_degrees();
        let phi = if phi < 0.0 { phi + 360.0 } else { phi };
        match (symmetry + 0.5) as i64 {
            360 => Some(phi),
            180 => Some(if phi < 180.0 { phi } else { 360.0 - phi }),
            90 => {
                let phi = if phi >= 180.0 { phi - 180.0 } else { phi };
                Some(if phi < 90.0 { phi } else { 180.0 - phi })
            }
            _ => None,
        }
    }
}

impl Inputs for Seen<'_> {
    fn channel(&self, number: u32) -> f64 {
        let (ray, frame) = (self.ray, self.frame);
        let axis = |first: u32| (number - first) as usize;
        match number {
            1..=3 => self.direction(ray.direction)[axis(1)],
            4..=6 => self.direction(ray.normal)[axis(4)],
            7..=9 => self.point()[axis(7)],
            10 => ray.travelled * frame.scale,
            11 => self.cosine(ray.normal),
            12 => frame.scale,
            13..=15 => frame.to_local.point(Vec3::ZERO)[axis(13)],
            16..=18 => self.direction(Vec3::X)[axis(16)],
            19..=21 => self.direction(Vec3::Y)[axis(19)],
            22..=24 => self.direction(Vec3::Z)[axis(22)],
            25 => ray.distance * frame.scale,
            26 | 27 => ray.local[axis(26)],
            28..=30 => self.direction(ray.perturbed)[axis(28)],
            31 => self.cosine(ray.perturbed),
            32..=34 => ray.color[axis(32)],
            35..=37 => self.direction(ray.target)[axis(35)],
            _ => f64::NAN,
        }
    }

    fn function(&self, id: u32, arguments: &[f64]) -> Option<f64> {
        match (id, arguments) {
            (SOURCE_CORR, [value, kind, ..]) => self.source_corr(*value, *kind),
            (SOURCE_THETA, _) => Some(self.source_theta()),
            (SOURCE_PHI, [symmetry, ..]) => self.source_phi(*symmetry),
            _ => None,
        }
    }
}
