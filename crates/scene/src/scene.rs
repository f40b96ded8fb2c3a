//! What scene files say: surfaces and modifiers, in file order, with positions for error messages.

use crate::field::{Field, RayState, Spectrum};
use crate::text::Text;
use std::{path::PathBuf, sync::Arc};
use sunpeak_core::{Location, Rgb, Vec3};
use sunpeak_sky::SkyDistribution;

/// Index of a modifier in [`Scene::modifiers`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ModifierId(pub usize);

/// Everything the scene files say. Immutable once loaded.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Materials and patterns, in file order; a name may be defined again, later surfaces then mean the later one.
    pub modifiers: Vec<Modifier>,
    /// Surfaces and sources, in file order.
    pub surfaces: Vec<Surface>,
    /// What is odd in the files but no error: left-out degenerate surfaces, materials that nothing can use, …
    pub warnings: Vec<String>,
}

/// A named material or pattern.
#[derive(Clone, Debug)]
pub struct Modifier {
    /// Its name in the file.
    pub name: String,
    /// What it is modified by; `None` is `void`.
    pub parent: Option<ModifierId>,
    /// What it is.
    pub kind: ModifierKind,
    /// Where it stands.
    pub location: Location,
}

/// What a modifier is.
#[derive(Clone, Debug)]
pub enum ModifierKind {
    /// Says how a surface reflects, transmits or emits.
    Material(Material),
    /// Multiplies what the material says, by direction or place.
    Pattern(Pattern),
    /// Bends the normal: adds its three values, in its own frame, to the unit normal.
    Texture(Arc<Field>),
    /// One modifier or another: `fore` with the share that the weight says, 0 to 1, `back` with the rest.
    Mixture {
        /// Foreground; `None` is `void`.
        fore: Option<ModifierId>,
        /// Background; `None` is `void`.
        back: Option<ModifierId>,
        /// Share of the foreground.
        weight: Weight,
    },
}

/// What decides between the two sides of a mixture.
#[derive(Clone, Debug)]
pub enum Weight {
    /// The value of a field is the share of the foreground.
    Field(Arc<Field>),
    /// The foreground is where the text is.
    Text(Arc<Text>),
}

/// Patterns.
#[derive(Clone, Debug)]
pub enum Pattern {
    /// The same everywhere: a spectrum, in three channels.
    Uniform(Rgb),
    /// One value of a field for all channels.
    Bright(Arc<Field>),
    /// Three values of a field.
    Color(Arc<Field>),
    /// A spectrum over place or direction, in three channels. The field's function is asked for each wavelength: with the
    /// wavelength alone, or with the data's value and the wavelength.
    Spectral {
        /// The function, and the data without its last coordinate.
        field: Arc<Field>,
        /// Wavelengths and their weights.
        spectrum: Spectrum,
    },
    /// One colour where a text is, another where it is not.
    Text {
        /// The text.
        text: Arc<Text>,
        /// Its colour.
        fore: Rgb,
        /// The colour of all around it.
        back: Rgb,
    },
    /// `brightfunc … skybr skybright.cal` or `skybright perezlum.cal`: the sky over the ray's direction.
    Sky(SkyDistribution),
}

/// Materials, with Radiance's arguments (reference manual, "Materials").
#[derive(Clone, Debug)]
pub enum Material {
    /// Uncoloured highlights over a coloured diffuse surface.
    Plastic(Ward),
    /// Highlights in the material's colour.
    Metal(Ward),
    /// Translucent: `transmissivity` of what is not reflected goes through, `specular_transmission` of that straight.
    Trans {
        /// Reflection as in plastic.
        ward: Ward,
        /// Fraction of penetrating light that is transmitted.
        transmissivity: f64,
        /// Fraction of the transmitted light that is not diffusely scattered.
        specular_transmission: f64,
    },
    /// A thin pane: transmissivity at normal incidence per channel, and refractive index.
    Glass {
        /// Fraction not absorbed in one crossing of the pane.
        transmissivity: Rgb,
        /// Index of refraction (1.52 unless given).
        index: f64,
    },
    /// A solid of glass or the like.
    Dielectric {
        /// Transmission per unit of length (one metre) in the volume.
        transmission: Rgb,
        /// Index of refraction.
        index: f64,
        /// Hartmann's constant, dispersion.
        hartmann: f64,
    },
    /// The boundary between two dielectrics.
    Interface {
        /// Behind the surface.
        inside: Medium,
        /// Before it.
        outside: Medium,
    },
    /// Ashikhmin and Shirley's anisotropic highlights over a diffuse surface.
    Ashikhmin {
        /// Diffuse reflectance.
        diffuse: Rgb,
        /// Specular reflectance at normal incidence.
        specular: Rgb,
        /// Exponents along and across the orientation: larger is smoother.
        powers: [f64; 2],
        /// Along what the first exponent lies.
        orientation: Orientation,
    },
    /// A volume of air that scatters; its surface is invisible.
    Mist {
        /// Names of light sources that Radiance looks for in it.
        sources: Vec<String>,
        /// Extinction: what is lost of a ray in one metre [1/m].
        extinction: Rgb,
        /// Share of that which is scattered.
        albedo: Rgb,
        /// Mean cosine of the scattering angle (Henyey and Greenstein's g).
        eccentricity: f64,
    },
    /// A volume in which surfaces of some modifiers do not exist.
    Antimatter {
        /// The modifiers.
        clipped: Vec<ModifierId>,
        /// What the cut face looks like; `None` leaves it open.
        face: Option<ModifierId>,
    },
    /// A planar mirror that makes virtual sources; `alternate` is shown to rays that are not shadow rays.
    Mirror {
        /// Reflectance.
        reflectance: Rgb,
        /// Material for all other rays, if named; `Some(None)` is `void`: such rays pass.
        alternate: Option<Option<ModifierId>>,
    },
    /// An emitter [W sr⁻¹ m⁻²].
    Light(Rgb),
    /// An emitter that looks like another material, or is invisible, when seen directly.
    Illum {
        /// Radiance as a light.
        radiance: Rgb,
        /// Material that view rays see; `Some(None)` is `void`, and so is a file that names none: such rays pass.
        alternate: Option<Option<ModifierId>>,
    },
    /// An emitter that lights only within `max_radius` directly (0: by reflection and view only; negative: never
    /// cast light, but visible).
    Glow {
        /// Radiance.
        radiance: Rgb,
        /// Largest distance at which it is sampled as a light.
        max_radius: f64,
    },
    /// An emitter confined to a cone.
    Spotlight {
        /// Radiance.
        radiance: Rgb,
        /// Full opening angle [deg].
        angle_deg: f64,
        /// Axis of the cone; its length is the distance of the focus behind the surface.
        axis: Vec3,
    },
    /// A measured or simulated BSDF.
    Bsdf(BsdfMaterial),
    /// Diffuse, and scattering by a function of the direction to the light.
    Function(Box<FunctionMaterial>),
    /// `WGMDfunc`: Ward's model with a modifier and functions for each component.
    Wgmd(Box<WgmdMaterial>),
    /// Sends rays on in other directions.
    Prism {
        /// For each way four expressions: the share, and the direction of the ray that goes on.
        field: Arc<Field>,
        /// One or two.
        ways: usize,
    },
}

/// A transparent medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Transmission per unit of length (one metre).
    pub transmission: Rgb,
    /// Index of refraction.
    pub index: f64,
}

/// Arguments shared by plastic, metal and trans, and by plastic2, metal2 and trans2: Ward's model.
#[derive(Clone, Debug)]
pub struct Ward {
    /// Diffuse colour (colour of everything for metal).
    pub color: Rgb,
    /// Fraction reflected specularly.
    pub specularity: f64,
    /// RMS slope of the facets; along the orientation, if there is one.
    pub roughness: f64,
    /// Set for plastic2, metal2 and trans2.
    pub anisotropy: Option<Anisotropy>,
}

/// A vector by which a material is turned, to be projected on the surface.
#[derive(Clone, Debug)]
pub enum Orientation {
    /// World axes, of any length.
    Fixed(Vec3),
    /// Three expressions, the vector in the field's frame.
    Varying(Arc<Field>),
}

/// A second roughness.
#[derive(Clone, Debug)]
pub struct Anisotropy {
    /// Along what the first roughness lies.
    pub orientation: Orientation,
    /// RMS slope across the orientation.
    pub roughness: f64,
}

/// `plasfunc`, `metfunc`, `transfunc`, `plasdata`, `metdata`, `transdata`, `BRTDfunc`.
#[derive(Clone, Debug)]
pub struct FunctionMaterial {
    /// Colour before patterns (white for `BRTDfunc`, whose functions see the pattern alone).
    pub color: Rgb,
    /// Diffuse reflectance of front and back.
    pub diffuse: [Rgb; 2],
    /// Diffuse transmittance.
    pub diffuse_transmission: Rgb,
    /// What the function is multiplied with for light on the ray's side.
    pub reflection: Rgb,
    /// And for light on the other side.
    pub transmission: Rgb,
    /// Do patterns multiply the reflected function as well?
    pub is_metal: bool,
    /// Is the surface turned to face the ray before the function sees it?
    pub is_turned: bool,
    /// Are the first six expressions what is mirrored, and what goes straight on?
    pub has_straight: bool,
    /// How the field is asked for a value.
    pub value: FunctionValue,
    /// The functions.
    pub field: Arc<Field>,
}

/// A scattering function [1/sr] of the direction to the light and its solid angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FunctionValue {
    /// One expression for all channels.
    Grey(usize),
    /// An expression for each channel; `None` is 0.
    Color([Option<usize>; 3]),
    /// So many coordinates of the field's data, the first expressions; the next one takes the data's value first.
    Data(usize),
}

impl FunctionMaterial {
    /// A black surface.
    pub(crate) fn new(field: Arc<Field>, value: FunctionValue) -> Self {
        Self {
            color: Rgb::ONE,
            diffuse: [Rgb::ZERO; 2],
            diffuse_transmission: Rgb::ZERO,
            reflection: Rgb::ZERO,
            transmission: Rgb::ZERO,
            is_metal: false,
            is_turned: true,
            has_straight: false,
            value,
            field,
        }
    }

    /// The value for light from a unit vector, away from the surface, of this solid angle [sr]; never negative.
    pub fn evaluate(&self, ray: &RayState, direction: Vec3, solid_angle: f64) -> Rgb {
        let field = &self.field;
        let d = field.local_direction(direction);
        let light = [d.x, d.y, d.z, solid_angle];
        let value = match self.value {
            FunctionValue::Grey(root) => Rgb::splat(field.call(ray, root, &light).unwrap_or(0.0)),
            FunctionValue::Color(roots) => Rgb::from_array(
                roots.map(|root| root.and_then(|root| field.call(ray, root, &light)).unwrap_or(0.0)),
            ),
            FunctionValue::Data(dimensions) => {
                let mut point = Vec::with_capacity(dimensions);
                point.extend((0..dimensions).filter_map(|root| field.call(ray, root, &light)));
                match field.arrays().first() {
                    Some(data) if point.len() == dimensions => {
                        let value = data.interpolate(&point);
                        let arguments = [value, d.x, d.y, d.z, solid_angle];
                        Rgb::splat(field.call(ray, dimensions, &arguments).unwrap_or(0.0))
                    }
                    _ => Rgb::ZERO,
                }
            }
        };
        value.max(Rgb::ZERO)
    }
}

/// `WGMDfunc`: diffuse and Gaussian components, each with a modifier of its own.
#[derive(Clone, Debug)]
pub struct WgmdMaterial {
    /// Diffuse reflectance of front and back; the material's own modifier colours it.
    pub diffuse: [Rgb; 2],
    /// Diffuse transmittance.
    pub diffuse_transmission: Rgb,
    /// What colours the specular reflection.
    pub reflection_modifier: ComponentModifier,
    /// What colours the specular transmission.
    pub transmission_modifier: ComponentModifier,
    /// What colours the diffuse transmission.
    pub diffuse_transmission_modifier: ComponentModifier,
    /// Nine expressions: specular reflectance and its two roughnesses, specular transmittance and its two, and the vector along
    /// which the first roughnesses lie.
    pub field: Arc<Field>,
}

/// The modifier of one component of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComponentModifier {
    /// The material's own (`inherit`).
    Own,
    /// Another one; `None` is `void`.
    Named(Option<ModifierId>),
}

/// How far the geometry reaches behind a surface that stands for it (negative: before it) [m]; 0: there is none.
#[derive(Clone, Debug)]
pub enum Thickness {
    /// The same everywhere.
    Fixed(f64),
    /// An expression of the ray that arrives.
    Varying {
        /// One expression.
        field: Arc<Field>,
        /// What the transform multiplies it with.
        scale: f64,
    },
}

/// `BSDF` and `aBSDF`.
#[derive(Clone, Debug)]
pub struct BsdfMaterial {
    /// `true` for `aBSDF`: the material for peak extraction.
    pub extract_peak: bool,
    /// Thickness for proxy geometry, always 0 for `aBSDF`.
    pub thickness: Thickness,
    /// The XML file, found.
    pub file: PathBuf,
    /// Up vector.
    pub up: Orientation,
    /// Does an xform mirror the frame (x = -(y cross z))?
    pub mirrored: bool,
    /// Diffuse reflectance added at the front.
    pub front_diffuse: Rgb,
    /// Diffuse reflectance added at the back.
    pub back_diffuse: Rgb,
    /// Diffuse transmittance added.
    pub diffuse_transmission: Rgb,
}

/// A surface or source.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its name in the file.
    pub name: String,
    /// What it is made of; `None` (`void`) is invisible.
    pub modifier: Option<ModifierId>,
    /// Its geometry in world axes.
    pub shape: Shape,
    /// Where it stands.
    pub location: Location,
}

/// Geometry, in world axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A flat polygon; the front is where the vertices turn counter-clockwise. Holes by seams.
    Polygon(Vec<Vec3>),
    /// `sphere`, or `bubble` if `inward`.
    Sphere {
        /// Centre.
        center: Vec3,
        /// Radius, positive [m].
        radius: f64,
        /// Does the normal point to the centre?
        inward: bool,
    },
    /// `cone`, `cylinder`, or `cup`, `tube` if `inward`. Open at both ends.
    Cone {
        /// Centre of the first end.
        start: Vec3,
        /// Centre of the second end.
        end: Vec3,
        /// Radius at `start` [m].
        start_radius: f64,
        /// Radius at `end` [m].
        end_radius: f64,
        /// Does the normal point to the axis?
        inward: bool,
    },
    /// A disc, or a disc with a hole.
    Ring {
        /// Centre.
        center: Vec3,
        /// Unit normal.
        normal: Vec3,
        /// Inner radius [m].
        inner_radius: f64,
        /// Outer radius [m].
        outer_radius: f64,
    },
    /// Triangles that share vertices.
    Mesh(Mesh),
    /// A cone of directions at infinity.
    Source {
        /// Unit vector towards it.
        direction: Vec3,
        /// Full angle [deg].
        angle_deg: f64,
    },
}

/// A mesh in world axes; what one file holds is shared by the surfaces that its materials make.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Places of the vertices.
    pub vertices: Arc<[Vec3]>,
    /// Unit normal at each vertex, zero where there is none; empty if there are none at all. Between them the normal is
    /// interpolated in triangles whose corners all have one.
    pub normals: Arc<[Vec3]>,
    /// Local coordinates (Radiance's `Lu`, `Lv`) at each vertex; empty if there are none.
    pub local: Arc<[[f64; 2]]>,
    /// Indices of vertices, counter-clockwise at the front.
    pub triangles: Vec<[u32; 3]>,
}
