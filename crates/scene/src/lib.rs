//! The Radiance scene language, views and pictures. It knows files; it does not know how light moves.

mod picture;
mod scene;
mod view;

pub use picture::{ExactSource, Picture};
pub use scene::{
    BsdfMaterial, Material, Modifier, ModifierId, ModifierKind, Pattern, Scene, Shape, Surface, Ward,
};
pub use view::{View, ViewKind, ViewRay};
