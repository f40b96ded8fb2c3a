//! Function and data materials, and prisms (reference manual, "Materials").

use super::Interpreter;
use super::args::{check_not_negative, smallest, title, triple};
use super::patterns::at_least;
use crate::field::DataArray;
use crate::{FunctionMaterial, FunctionValue, Material, raw::Primitive};
use std::sync::Arc;
use sunpeak_core::Rgb;

/// Arguments that a scattering function is called with: direction to the light, and its solid angle.
const OF_LIGHT: usize = 4;

impl Interpreter<'_> {
    /// A material with a function; `None` for another type.
    pub(super) fn function_material(&mut self, primitive: &Primitive) -> Result<Option<Material>, String> {
        let material = match primitive.kind.name {
            "plasfunc" | "metfunc" | "transfunc" => self.with_function(primitive)?,
            "plasdata" | "metdata" | "transdata" => self.with_data(primitive)?,
            "BRTDfunc" => self.brtd(primitive)?,
            "prism1" => return self.prism(primitive, 1).map(Some),
            "prism2" => return self.prism(primitive, 2).map(Some),
            _ => return Ok(None),
        };
        Ok(Some(Material::Function(Box::new(material))))
    }

    /// `function file [transform]`
    fn with_function(&mut self, primitive: &Primitive) -> Result<FunctionMaterial, String> {
        at_least(primitive, 2, "a function and a function file")?;
        let field = self.field(primitive, 1, &[], &[(0, OF_LIGHT)], Vec::new())?;
        scatterer(primitive, FunctionMaterial::new(field, FunctionValue::Grey(0)))
    }

    /// `function datafile file coordinates… [transform]`
    fn with_data(&mut self, primitive: &Primitive) -> Result<FunctionMaterial, String> {
        at_least(primitive, 4, "a function, a data file, a function file and coordinates")?;
        let data: Arc<DataArray> = self.data_file(primitive, &primitive.strings[1])?;
        let dimensions = data.dimensions();
        at_least(primitive, 3 + dimensions, "a function for each dimension of the data")?;
        let coordinates = (3..3 + dimensions).map(|index| (index, OF_LIGHT));
        let functions: Vec<_> = coordinates.chain([(0, 1 + OF_LIGHT)]).collect();
        let field = self.field(primitive, 2, &[], &functions, vec![data])?;
        scatterer(primitive, FunctionMaterial::new(field, FunctionValue::Data(dimensions)))
    }

    /// `rrefl grefl brefl rtrns gtrns btrns rbrtd gbrtd bbrtd file [transform]`
    fn brtd(&mut self, primitive: &Primitive) -> Result<FunctionMaterial, String> {
        at_least(
            primitive,
            10,
            "three each of reflection, transmission and scattering, and a function file",
        )?;
        check_reals(primitive, 9, "front, back and transmitted diffuse colour")?;
        // A function that is the number 0 is none.
        let names: Vec<usize> = (6..9).filter(|&index| primitive.strings[index] != "0").collect();
        let functions: Vec<_> = names.iter().map(|&index| (index, OF_LIGHT)).collect();
        let field = self.field(primitive, 9, &[0, 1, 2, 3, 4, 5], &functions, Vec::new())?;
        let root = |index: usize| names.iter().position(|&name| name == index).map(|at| 6 + at);
        let colour = [6, 7, 8].map(root);
        let reals = &primitive.reals;
        let [front, back, through] = [0, 3, 6].map(|at| triple(reals, at));
        check_not_negative(primitive, &[("diffuse colour", smallest(front.min(back).min(through)))])?;
        Ok(FunctionMaterial {
            diffuse: [front, back],
            diffuse_transmission: through,
            reflection: Rgb::ONE,
            transmission: Rgb::ONE,
            has_straight: true,
            is_turned: false,
            ..FunctionMaterial::new(field, FunctionValue::Color(colour))
        })
    }

    /// For each way: a coefficient and a direction; then the function file.
    fn prism(&mut self, primitive: &Primitive, ways: usize) -> Result<Material, String> {
        at_least(primitive, 4 * ways + 1, "a coefficient and a direction for each way, and a function file")?;
        let expressions: Vec<usize> = (0..4 * ways).collect();
        let field = self.field(primitive, 4 * ways, &expressions, &[], Vec::new())?;
        Ok(Material::Prism { field, ways })
    }
}

/// The real arguments of plastic, metal and trans with a function.
fn scatterer(primitive: &Primitive, material: FunctionMaterial) -> Result<FunctionMaterial, String> {
    let name = primitive.kind.name;
    let is_trans = name.starts_with("trans");
    check_reals(primitive, if is_trans { 6 } else { 4 }, "red green blue rspec [trans tspec]")?;
    let reals = &primitive.reals;
    let (color, specularity) = (triple(reals, 0), reals[3]);
    let (trans, tspec) = if is_trans { (reals[4] * (1.0 - specularity), reals[5]) } else { (0.0, 0.0) };
    let values =
        [("colour", smallest(color)), ("specularity", specularity), ("transmission", trans.min(tspec))];
    check_not_negative(primitive, &values)?;
    let is_metal = name.starts_with("met");
    Ok(FunctionMaterial {
        color,
        diffuse: [color * (1.0 - trans - specularity).max(0.0); 2],
        diffuse_transmission: color * (trans * (1.0 - tspec)),
        reflection: if is_metal { color } else { Rgb::ONE } * specularity,
        transmission: color * (trans * tspec),
        is_metal,
        ..material
    })
}

pub(super) fn check_reals(primitive: &Primitive, count: usize, form: &str) -> Result<(), String> {
    let found = primitive.reals.len();
    if found >= count {
        return Ok(());
    }
    Err(format!(
        "wrong number of arguments of {}: expected at least {count} real arguments ({form}), found {found}",
        title(primitive)
    ))
}
