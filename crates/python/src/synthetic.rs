//! Products of our own making, in closed form and tabulated.

use crate::arrays::{Numbers, directions, numbers};
use crate::bsdf::PyBsdf;
use crate::error::{InputError, OrRaise};
use crate::kept::{PyKept, run_kept};
use glam::DVec2;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use sunpeak_bsdf::synthetic::{
    Basis, Blind, Diffuser, Fabric, Goniophotometer, Mesh, Pane, Panel, Perforated, Product, Weave, Woven,
    tabulate_exact, tabulate_watched,
};

type Numbered = BTreeMap<String, f64>;

/// A product by its kind and numbers.
fn product(kind: &str, numbers: &Numbered) -> PyResult<Box<dyn Product>> {
    let mut left = numbers.clone();
    let mut take = |name: &str| {
        left.remove(name).ok_or_else(|| InputError::new_err(format!("{kind}: {name} is missing")))
    };
    let product: Box<dyn Product> = match kind {
        "fabric" | "weave" => {
            let fabric = Fabric {
                openness: take("openness")?,
                cutoff_deg: take("cut_off_deg")?,
                exponent: take("exponent")?,
                scattered: take("scattered")?,
                lobe_share: take("lobe_share")?,
                lobe_sigma: take("lobe_sigma")?,
                reflectance: take("reflectance")?,
            };
            fabric.check().or_raise()?;
            if kind == "fabric" {
                Box::new(Woven::new(fabric))
            } else {
                let tint = [take("tint_x")?, take("tint_z")?];
                Box::new(Weave::new(fabric, take("cut_off_y_deg")?, Some(tint)).or_raise()?)
            }
        }
        "perforated" => {
            let sheet = Perforated {
                open_area: take("open_area")?,
                thickness: take("thickness")?,
                from_walls: take("from_walls")?,
                reflectance: take("reflectance")?,
            };
            sheet.check().or_raise()?;
            Box::new(sheet)
        }
        "mesh" => {
            let mesh = Mesh {
                pitch: [take("long_way")?, take("short_way")?],
                strand: take("strand")?,
                thickness: take("thickness")?,
                reflectance: take("reflectance")?,
            };
            mesh.check().or_raise()?;
            Box::new(mesh)
        }
        "pane" => Box::new(Pane { index: take("index")?, internal: take("internal")? }),
        "blind" => Box::new(Blind {
            width: take("width")?,
            tilt_deg: take("tilt_deg")?,
            scattered: take("scattered")?,
        }),
        "panel" => Box::new(Panel {
            transmittance: take("transmittance")?,
            tenth_width_deg: take("tenth_width_deg")?,
            same_angle: take("same_angle")? > 0.0,
        }),
        "diffuser" => Box::new(Diffuser { transmittance: take("transmittance")? }),
        _ => return Err(InputError::new_err(format!("no product of the kind {kind:?}"))),
    };
    match left.keys().next() {
        Some(name) => Err(InputError::new_err(format!("{kind}: what is {name}?"))),
        None => Ok(product),
    }
}

/// Tabulate a product as a goniophotometer sees it.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
#[pyo3(signature = (kind, numbers, basis, rays, value_noise, fwhm_deg, seed, kept=None, progress=None))]
pub fn synthetic_bsdf(
    py: Python<'_>,
    kind: &str,
    numbers: Numbered,
    basis: &str,
    rays: Option<u64>,
    value_noise: f64,
    fwhm_deg: f64,
    seed: u64,
    kept: Option<PyRef<'_, PyKept>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyBsdf> {
    let product = product(kind, &numbers)?;
    let basis: Basis = basis.parse().or_raise()?;
    let seen_by = Goniophotometer { rays, value_noise, fwhm_deg, seed };
    let bsdf = run_kept(
        py,
        kept.as_deref(),
        progress.as_ref(),
        |sum| sum.text(&format!("{kind} {numbers:?} {basis} {seen_by:?}")),
        |work| tabulate_watched(product.as_ref(), basis, &seen_by, work),
    )?;
    Ok(PyBsdf(Arc::new(bsdf)))
}

/// Tabulate a product and keep its through part as its closed form has it.
#[pyfunction]
#[pyo3(signature = (kind, numbers, basis, kept=None, progress=None))]
pub fn exact_bsdf(
    py: Python<'_>,
    kind: &str,
    numbers: Numbered,
    basis: &str,
    kept: Option<PyRef<'_, PyKept>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyBsdf> {
    let product = product(kind, &numbers)?;
    let basis: Basis = basis.parse().or_raise()?;
    let bsdf = run_kept(
        py,
        kept.as_deref(),
        progress.as_ref(),
        |sum| sum.text(&format!("exact {kind} {numbers:?} {basis}")),
        |work| tabulate_exact(product.as_ref(), basis, work),
    )?;
    Ok(PyBsdf(Arc::new(bsdf)))
}

/// Through transmittance of a product in closed form, for rays from `w_in` (n, 3).
#[pyfunction]
pub fn synthetic_through<'py>(
    py: Python<'py>,
    kind: &str,
    numbers_in: Numbered,
    w_in: PyReadonlyArray2<'py, f64>,
) -> PyResult<Numbers<'py>> {
    let product = product(kind, &numbers_in)?;
    // Light that meets the back of the frame is what the closed form is for; at the front it runs the other way.
    let through = |w: sunpeak_core::Vec3| product.through(DVec2::new(w.x, w.y) * w.z.signum());
    Ok(numbers(py, directions(&w_in, "w_in")?.into_iter().map(through).collect()))
}
