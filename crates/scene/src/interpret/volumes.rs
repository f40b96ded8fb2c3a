//! Materials that bound volumes: `interface` and `mist` (`antimatter` needs names, see `materials`).

use super::args::{check_counts, check_not_negative, smallest, title, triple};
use super::materials::check_index;
use crate::{Material, Medium, raw::Primitive};
use sunpeak_core::Rgb;

/// The boundary of two dielectrics.
pub fn interface(primitive: &Primitive) -> Result<Material, String> {
    check_counts(primitive, &[0], &[8], "rtn1 gtn1 btn1 n1 rtn2 gtn2 btn2 n2")?;
    Ok(Material::Interface { inside: medium(primitive, 0)?, outside: medium(primitive, 4)? })
}

fn medium(primitive: &Primitive, at: usize) -> Result<Medium, String> {
    let (transmission, index) = (triple(&primitive.reals, at), primitive.reals[at + 3]);
    check_not_negative(primitive, &[("transmission", smallest(transmission))])?;
    check_index(primitive, index)?;
    Ok(Medium { transmission, index })
}

/// Scattering air. What is not given is Radiance's global medium, which is none unless options say so.
pub fn mist(primitive: &Primitive) -> Result<Material, String> {
    let reals = &primitive.reals;
    let form = "[rext gext bext [ralb galb balb [g]]]";
    check_counts(primitive, &[primitive.strings.len()], &[0, 3, 6, 7], form)?;
    let given = |at: usize| if reals.len() >= at + 3 { triple(reals, at) } else { Rgb::ZERO };
    let (extinction, albedo) = (given(0), given(3));
    let eccentricity = reals.get(6).copied().unwrap_or(0.0);
    check_not_negative(primitive, &[("extinction", smallest(extinction)), ("albedo", smallest(albedo))])?;
    if albedo.max_element() > 1.0 {
        return Err(format!("{}: the albedo is {}, expected 0 to 1", title(primitive), albedo.max_element()));
    }
    if !(-1.0 < eccentricity && eccentricity < 1.0) {
        return Err(format!("{}: the eccentricity is {eccentricity}, expected -1 to 1", title(primitive)));
    }
    Ok(Material::Mist { sources: primitive.strings.clone(), extinction, albedo, eccentricity })
}
