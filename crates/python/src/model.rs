//! Scattering models from formulas.

use crate::arrays::{Numbers, directions, numbers};
use crate::bsdf::PyBsdf;
use crate::error::{InputError, OrRaise};
use crate::kept::{PyKept, run_kept};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use sunpeak_bsdf::{
    model::{CookTorrance, Ggx, Glass, Lambert, Mirror, Model, Phong, Ward, tabulate},
    synthetic::Basis,
};

type Numbered = BTreeMap<String, f64>;

/// A model by its name and numbers; the Python face knows the names, and gives all of them.
fn model(kind: &str, given: &Numbered) -> PyResult<Box<dyn Model>> {
    let take = |name: &str| {
        given.get(name).copied().ok_or_else(|| InputError::new_err(format!("{kind}: {name} is missing")))
    };
    let boxed: Box<dyn Model> = match kind {
        "lambert" => {
            let m = Lambert { reflectance: take("reflectance")?, transmittance: take("transmittance")? };
            m.check().or_raise()?;
            Box::new(m)
        }
        "phong" => {
            let m =
                Phong { diffuse: take("diffuse")?, specular: take("specular")?, exponent: take("exponent")? };
            m.check().or_raise()?;
            Box::new(m)
        }
        "ward" | "wgmd" => {
            let m = Ward {
                diffuse: take("diffuse")?,
                specular: take("specular")?,
                roughness: [take("roughness_x")?, take("roughness_y")?],
                bounded: kind == "wgmd",
            };
            m.check().or_raise()?;
            Box::new(m)
        }
        "cook-torrance" => {
            let m = CookTorrance {
                diffuse: take("diffuse")?,
                specular: take("specular")?,
                index: take("index")?,
                roughness: take("roughness")?,
            };
            m.check().or_raise()?;
            Box::new(m)
        }
        "ggx" | "rough-dielectric" => {
            let transmits = kind == "rough-dielectric";
            let m = Ggx { index: take("index")?, roughness: take("roughness")?, transmits };
            m.check().or_raise()?;
            Box::new(m)
        }
        "glass" => {
            let m = Glass { index: take("index")?, internal: take("internal")? };
            m.check().or_raise()?;
            Box::new(m)
        }
        "mirror" => {
            let m = Mirror { reflectance: take("reflectance")? };
            m.check().or_raise()?;
            Box::new(m)
        }
        _ => return Err(InputError::new_err(format!("no model is called {kind:?}"))),
    };
    Ok(boxed)
}

/// A table of a model.
#[pyfunction]
#[pyo3(signature = (kind, numbers, basis, kept=None, progress=None))]
pub fn model_bsdf(
    py: Python<'_>,
    kind: &str,
    numbers: Numbered,
    basis: &str,
    kept: Option<PyRef<'_, PyKept>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyBsdf> {
    let model = model(kind, &numbers)?;
    let basis: Basis = basis.parse().or_raise()?;
    let bsdf = run_kept(
        py,
        kept.as_deref(),
        progress.as_ref(),
        |sum| sum.text(&format!("{kind} {numbers:?} {basis}")),
        |work| tabulate(model.as_ref(), basis, work),
    )?;
    Ok(PyBsdf(Arc::new(bsdf)))
}

/// A model's value [1/sr] for light from `to_light` (n, 3) that leaves towards `leaving` (n, 3).
#[pyfunction]
pub fn model_value<'py>(
    py: Python<'py>,
    kind: &str,
    numbers_in: Numbered,
    to_light: PyReadonlyArray2<'py, f64>,
    leaving: PyReadonlyArray2<'py, f64>,
) -> PyResult<Numbers<'py>> {
    let model = model(kind, &numbers_in)?;
    let (lights, exits) = (directions(&to_light, "to_light")?, directions(&leaving, "leaving")?);
    if lights.len() != exits.len() {
        let message =
            format!("leaving: expected {} rows, as in to_light, found {}", lights.len(), exits.len());
        return Err(InputError::new_err(message));
    }
    Ok(numbers(py, lights.iter().zip(&exits).map(|(&l, &e)| model.value(l, e)).collect()))
}
