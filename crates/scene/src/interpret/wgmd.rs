//! `WGMDfunc` from its arguments (reference manual, "WGMDfunc").

use super::{
    INHERIT, Interpreter, Unusable,
    args::{check_not_negative, smallest, title, triple},
    functions::check_reals,
    patterns::at_least,
};
use crate::{ComponentModifier, Material, WgmdMaterial, raw::Primitive};

/// String arguments up to the function file: four each for specular reflection and transmission, the modifier of the diffuse
/// transmission, the orientation.
const FUNCTION_FILE: usize = 12;

/// Where the expressions stand among the strings.
const EXPRESSIONS: [usize; 9] = [1, 2, 3, 5, 6, 7, 9, 10, 11];

impl Interpreter<'_> {
    /// `rs_mod rs rs_urough rs_vrough ts_mod ts ts_urough ts_vrough td_mod ux uy uz file [transform]`
    pub(super) fn wgmd(&mut self, primitive: &Primitive) -> Result<Material, Unusable> {
        let form = "modifier, value and two roughnesses of the specular reflection and of the transmission, \
                    modifier of the diffuse transmission, ux uy uz, and a function file or \".\"";
        at_least(primitive, FUNCTION_FILE + 1, form)?;
        check_reals(primitive, 9, "front, back and transmitted diffuse colour")?;
        let [front, back, through] = [0, 3, 6].map(|at| triple(&primitive.reals, at));
        check_not_negative(primitive, &[("diffuse colour", smallest(front.min(back).min(through)))])?;
        Ok(Material::Wgmd(Box::new(WgmdMaterial {
            diffuse: [front, back],
            diffuse_transmission: through,
            reflection_modifier: self.component(primitive, 0)?,
            transmission_modifier: self.component(primitive, 4)?,
            diffuse_transmission_modifier: self.component(primitive, 8)?,
            field: self.field(primitive, FUNCTION_FILE, &EXPRESSIONS, &[], Vec::new())?,
        })))
    }

    /// The modifier that string argument `at` names: patterns and textures.
    fn component(&self, primitive: &Primitive, at: usize) -> Result<ComponentModifier, Unusable> {
        let name = &primitive.strings[at];
        if name == INHERIT {
            return Ok(ComponentModifier::Own);
        }
        let modifier = self.named(primitive, name, "the modifier of a component,")?;
        match modifier.filter(|id| self.makings[id.0].has_material) {
            Some(_) => Err(Unusable::Because(format!(
                "{}: \"{name}\" is a material: expected a pattern, a texture, void or inherit",
                title(primitive)
            ))),
            None => Ok(ComponentModifier::Named(modifier)),
        }
    }
}
