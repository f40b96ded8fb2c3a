//! The Radiance scene language, views and pictures. It knows files; it does not know how light moves.
//!
//! A scene file goes through three layers: [`raw`] reads words and counts, `command` does the `!commands` (in this
//! process, never in a shell unless that is allowed), `interpret` looks names up and checks arguments. Octrees and meshes that
//! a scene names are read by `compiled`, and become surfaces of the scene.
//!
//! ```
//! use sunpeak_scene::{LoadOptions, Scene};
//! let text = "void plastic white 0 0 5 .8 .8 .8 0 0\n!genbox white box 2 3 1 | xform -t 0 0 .5";
//! let scene = Scene::parse(text, "room.rad", &LoadOptions::default())?;
//! assert_eq!(scene.surfaces.len(), 6);
//! # Ok::<(), sunpeak_core::Error>(())
//! ```

mod bounds;
mod check;
mod command;
mod compiled;
mod disc_coverage;
mod field;
mod files;
mod interpret;
mod load;
mod mgf;
mod picture;
pub mod raw;
mod scene;
mod text;
mod view;

pub use check::SceneCheck;
pub use compiled::{OctreeFile, decode_octree};
pub use disc_coverage::disc_coverage;
pub use field::{DataArray, Field, RayState, Spectrum};
pub use files::LoadOptions;
pub use load::{Source, load_primitives};
pub use picture::{BlockErrors, ExactSource, Picture, SpectralPicture};
pub use scene::{
    Anisotropy, BsdfMaterial, ComponentModifier, FunctionMaterial, FunctionValue, Material, Medium, Mesh,
    Modifier, ModifierId, ModifierKind, Orientation, Pattern, Scene, Shape, Surface, Thickness, Ward, Weight,
    WgmdMaterial,
};
pub use text::{Font, Text};
pub use view::{Camera, PixelRay, View, ViewKind, ViewRay};
