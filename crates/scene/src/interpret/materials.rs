//! Materials and patterns from their arguments (reference manual, "Materials").

use super::{
    Interpreter, Named, Reference, Unusable, VOID,
    args::{check_counts, check_not_negative, smallest, title, triple, unsupported},
    bsdf, volumes,
};
use crate::{Anisotropy, Material, ModifierId, ModifierKind, Ward, raw::Primitive};

/// Refractive index of `glass` where none is given (reference manual, "Glass").
const GLASS_INDEX: f64 = 1.52;

/// A roughness up to this is none (Radiance, `FTINY`), which the anisotropic materials do not take.
const SMALLEST_ROUGHNESS: f64 = 1e-6;

impl Interpreter<'_> {
    pub(super) fn kind_of(&mut self, primitive: &Primitive) -> Result<ModifierKind, Unusable> {
        let material = match primitive.kind.name {
            "plastic" | "plastic2" => Material::Plastic(self.ward(primitive, "")?),
            "metal" | "metal2" => Material::Metal(self.ward(primitive, "")?),
            "trans" | "trans2" => self.trans(primitive)?,
            "ashik2" => self.ashikhmin(primitive)?,
            "glass" => glass(primitive)?,
            "dielectric" => dielectric(primitive)?,
            "interface" => volumes::interface(primitive)?,
            "mist" => volumes::mist(primitive)?,
            "antimatter" => self.antimatter(primitive)?,
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
            "WGMDfunc" => self.wgmd(primitive)?,
            "BSDF" | "aBSDF" => Material::Bsdf(bsdf::material(self, primitive)?),
            _ => {
                if let Some(material) = self.function_material(primitive)? {
                    return Ok(ModifierKind::Material(material));
                }
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
        self.named(primitive, name, "the modifier to be mixed,")
    }

    /// `void` among the names is the face only: it clips nothing.
    fn antimatter(&self, primitive: &Primitive) -> Result<Material, Unusable> {
        if primitive.strings.is_empty() || !primitive.reals.is_empty() {
            return Err(Unusable::Because(format!(
                "wrong number of arguments of {}: expected the names of one or more modifiers and no real arguments",
                title(primitive)
            )));
        }
        let named = |name: &String| self.named(primitive, name, "the modifier that is to be clipped,");
        let modifiers = primitive.strings.iter().map(named).collect::<Result<Vec<_>, _>>()?;
        Ok(Material::Antimatter { face: modifiers[0], clipped: modifiers.into_iter().flatten().collect() })
    }

    fn alternate(&self, primitive: &Primitive, name: &str) -> Result<Option<ModifierId>, Unusable> {
        self.named(primitive, name, "the material to be seen instead,")
    }

    /// A modifier that an argument names; `what` says what for.
    pub(super) fn named(
        &self,
        primitive: &Primitive,
        name: &str,
        what: &str,
    ) -> Result<Option<ModifierId>, Unusable> {
        match self.parent(primitive, name) {
            Ok(Reference::Void) => Ok(None),
            Ok(Reference::Named(Named::Modifier(id))) => Ok(Some(id)),
            Ok(Reference::Named(problem)) => Err(Unusable::Named(problem)),
            Err(_) => Err(Unusable::Because(format!(
                "{}: {what} \"{name}\", is not defined above",
                title(primitive)
            ))),
        }
    }

    /// The arguments that plastic, metal and trans, and their anisotropic siblings, begin with; `more` follows in `trans`.
    fn ward(&mut self, primitive: &Primitive, more: &str) -> Result<Ward, String> {
        let is_anisotropic = primitive.kind.name.ends_with('2');
        let strings = if is_anisotropic { primitive.strings.len() } else { 0 };
        let (roughnesses, count) = if is_anisotropic { ("urough vrough", 6) } else { ("roughness", 5) };
        let form = format!("red green blue specularity {roughnesses}{more}");
        check_counts(primitive, &[strings], &[count + if more.is_empty() { 0 } else { 2 }], &form)?;
        let roughness = primitive.reals[4];
        let color = triple(&primitive.reals, 0);
        let values =
            [("colour", smallest(color)), ("specularity", primitive.reals[3]), ("roughness", roughness)];
        check_not_negative(primitive, &values)?;
        let anisotropy = if is_anisotropic { Some(self.anisotropy(primitive)?) } else { None };
        Ok(Ward { color, specularity: primitive.reals[3], roughness, anisotropy })
    }

    fn anisotropy(&mut self, primitive: &Primitive) -> Result<Anisotropy, String> {
        for (name, value) in [("urough", primitive.reals[4]), ("vrough", primitive.reals[5])] {
            if value <= SMALLEST_ROUGHNESS {
                return Err(format!(
                    "{}: {name} is {value}, expected more than {SMALLEST_ROUGHNESS}; without roughness use {}",
                    title(primitive),
                    primitive.kind.name.trim_end_matches('2')
                ));
            }
        }
        let orientation = self.orientation(primitive, 0, "orientation")?;
        Ok(Anisotropy { orientation, roughness: primitive.reals[5] })
    }

    fn trans(&mut self, primitive: &Primitive) -> Result<Material, String> {
        let ward = self.ward(primitive, " transmissivity specular-transmission")?;
        let [.., transmissivity, specular_transmission] = primitive.reals[..] else {
            return Err(format!("{}: no real arguments", title(primitive)));
        };
        let values = [("transmissivity", transmissivity), ("specular transmission", specular_transmission)];
        check_not_negative(primitive, &values)?;
        Ok(Material::Trans { ward, transmissivity, specular_transmission })
    }

    fn ashikhmin(&mut self, primitive: &Primitive) -> Result<Material, String> {
        check_counts(
            primitive,
            &[primitive.strings.len()],
            &[8],
            "dred dgrn dblu sred sgrn sblu u-power v-power",
        )?;
        let (diffuse, specular) = (triple(&primitive.reals, 0), triple(&primitive.reals, 3));
        let powers = [primitive.reals[6], primitive.reals[7]];
        let values = [
            ("diffuse colour", smallest(diffuse)),
            ("specular colour", smallest(specular)),
            ("u-power", powers[0]),
            ("v-power", powers[1]),
        ];
        check_not_negative(primitive, &values)?;
        let orientation = self.orientation(primitive, 0, "orientation")?;
        Ok(Material::Ashikhmin { diffuse, specular, powers, orientation })
    }
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

pub(super) fn check_index(primitive: &Primitive, index: f64) -> Result<(), String> {
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
