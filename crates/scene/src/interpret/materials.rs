//! Materials and patterns from their arguments (reference manual, "Materials").

use super::{
    Interpreter, Named, Reference, Unusable, VOID,
    args::{check_counts, check_not_negative, smallest, title, triple, unsupported},
    bsdf,
};
use crate::{Material, ModifierId, ModifierKind, Ward, raw::Primitive};

/// Refractive index of `glass` where none is given (reference manual, "Glass").
const GLASS_INDEX: f64 = 1.52;

impl Interpreter<'_> {
    pub(super) fn kind_of(&mut self, primitive: &Primitive) -> Result<ModifierKind, Unusable> {
        let material = match primitive.kind.name {
            "plastic" => Material::Plastic(ward(primitive, 5)?),
            "metal" => Material::Metal(ward(primitive, 5)?),
            "trans" => trans(primitive)?,
            "glass" => glass(primitive)?,
            "dielectric" => dielectric(primitive)?,
            "mirror" => self.mirror(primitive)?,
            "light" => {
                check_counts(primitive, &[0], &[3], "red green blue")?;
                Material::Light(triple(&primitive.reals, 0))
            }
            "illum" => self.illum(primitive)?,
            "glow" => {
                check_counts(primitive, &[0], &[4], "red green blue maxrad")?;
                Material::Glow { radiance: triple(&primitive.reals, 0), max_radius: primitive.reals[3] }
            }
            "spotlight" => spotlight(primitive)?,
            "BSDF" | "aBSDF" => Material::Bsdf(bsdf::material(primitive, self.options, &self.cwd)?),
            _ => {
                let modulation = self.modulation(primitive)?;
                return modulation.ok_or_else(|| unsupported(primitive).into());
            }
        };
        Ok(ModifierKind::Material(material))
    }

    fn mirror(&self, primitive: &Primitive) -> Result<Material, Unusable> {
        check_counts(primitive, &[0, 1], &[3], "material; red green blue")?;
        let reflectance = triple(&primitive.reals, 0);
        check_not_negative(primitive, &[("reflectance", smallest(reflectance))])?;
        let alternate = primitive.strings.first().map(|name| self.alternate(primitive, name)).transpose()?;
        Ok(Material::Mirror { reflectance, alternate })
    }

    /// Without a name an illum is as invisible as with `void`.
    fn illum(&self, primitive: &Primitive) -> Result<Material, Unusable> {
        check_counts(primitive, &[0, 1], &[3], "material; red green blue")?;
        let name = primitive.strings.first().map_or(VOID, String::as_str);
        let alternate = Some(self.alternate(primitive, name)?);
        Ok(Material::Illum { radiance: triple(&primitive.reals, 0), alternate })
    }

    /// A modifier that a mixture names.
    pub(super) fn mixed(&self, primitive: &Primitive, name: &str) -> Result<Option<ModifierId>, Unusable> {
        self.alternate(primitive, name)
    }

    fn alternate(&self, primitive: &Primitive, name: &str) -> Result<Option<ModifierId>, Unusable> {
        match self.parent(primitive, name) {
            Ok(Reference::Void) => Ok(None),
            Ok(Reference::Named(Named::Modifier(id))) => Ok(Some(id)),
            Ok(Reference::Named(problem)) => Err(Unusable::Named(problem)),
            Err(_) => Err(Unusable::Because(format!(
                "{}: the material \"{name}\" that is to be seen instead is not defined above",
                title(primitive)
            ))),
        }
    }
}

/// The arguments that plastic, metal and trans begin with.
fn ward(primitive: &Primitive, count: usize) -> Result<Ward, String> {
    let form = match count {
        5 => "red green blue specularity roughness",
        _ => "red green blue specularity roughness transmissivity specular-transmission",
    };
    check_counts(primitive, &[0], &[count], form)?;
    let ward = Ward {
        color: triple(&primitive.reals, 0),
        specularity: primitive.reals[3],
        roughness: primitive.reals[4],
    };
    let values =
        [("colour", smallest(ward.color)), ("specularity", ward.specularity), ("roughness", ward.roughness)];
    check_not_negative(primitive, &values)?;
    Ok(ward)
}

fn trans(primitive: &Primitive) -> Result<Material, String> {
    let ward = ward(primitive, 7)?;
    let (transmissivity, specular_transmission) = (primitive.reals[5], primitive.reals[6]);
    let values = [("transmissivity", transmissivity), ("specular transmission", specular_transmission)];
    check_not_negative(primitive, &values)?;
    Ok(Material::Trans { ward, transmissivity, specular_transmission })
}

fn glass(primitive: &Primitive) -> Result<Material, String> {
    check_counts(primitive, &[0], &[3, 4], "red green blue [index]")?;
    let transmissivity = triple(&primitive.reals, 0);
    check_not_negative(primitive, &[("transmissivity", smallest(transmissivity))])?;
    let index = primitive.reals.get(3).copied().unwrap_or(GLASS_INDEX);
    check_index(primitive, index)?;
    Ok(Material::Glass { transmissivity, index })
}

fn dielectric(primitive: &Primitive) -> Result<Material, String> {
    check_counts(primitive, &[0], &[5], "red green blue index hartmann")?;
    let transmission = triple(&primitive.reals, 0);
    check_not_negative(primitive, &[("transmission", smallest(transmission))])?;
    let (index, hartmann) = (primitive.reals[3], primitive.reals[4]);
    check_index(primitive, index)?;
    Ok(Material::Dielectric { transmission, index, hartmann })
}

fn check_index(primitive: &Primitive, index: f64) -> Result<(), String> {
    if index > 0.0 {
        return Ok(());
    }
    Err(format!("{}: the index of refraction is {index}, expected a positive number", title(primitive)))
}

fn spotlight(primitive: &Primitive) -> Result<Material, String> {
    check_counts(primitive, &[0], &[7], "red green blue angle xdir ydir zdir")?;
    let (angle_deg, axis) = (primitive.reals[3], triple(&primitive.reals, 4));
    if angle_deg <= 0.0 {
        return Err(format!("{}: the angle is {angle_deg}, expected a positive number", title(primitive)));
    }
    if axis.length_squared() == 0.0 {
        return Err(format!("{}: the direction is zero", title(primitive)));
    }
    Ok(Material::Spotlight { radiance: triple(&primitive.reals, 0), angle_deg, axis })
}
