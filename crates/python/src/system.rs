//! Glazing systems: panes and shades behind each other.

use crate::arrays::{Rows, directions};
use crate::bsdf::PyBsdf;
use crate::error::{InputError, OrRaise};
use crate::kept::{PyKept, run_kept};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::Arc;
use sunpeak_bsdf::{
    synthetic::Basis,
    system::{Band, Curve, Layer, Pane, Panes, Shade, System, slab},
};

/// One layer of a system.
#[pyclass(frozen, name = "Layer", module = "sunpeak._core")]
pub struct PyLayer(Layer);

#[pymethods]
impl PyLayer {
    /// A pane by its normal values: wavelengths [um], transmittance, front and back reflectance [-]; `curve` is `fresnel`, `coated`,
    /// `clear` or `bronze`.
    #[staticmethod]
    fn pane(
        wavelengths_um: Vec<f64>,
        transmittance: Vec<f64>,
        front: Vec<f64>,
        back: Vec<f64>,
        curve: &str,
    ) -> PyResult<Self> {
        let curve = match curve {
            "fresnel" => Curve::Fresnel,
            "coated" => Curve::Coated,
            "clear" => Curve::Clear,
            "bronze" => Curve::Bronze,
            _ => {
                return Err(InputError::new_err(format!(
                    "curve: {curve:?}; expected fresnel, coated, clear or bronze"
                )));
            }
        };
        let pane = Pane { wavelengths_um, transmittance, reflectance: [front, back], curve };
        pane.check().or_raise()?;
        Ok(Self(Layer::Pane(pane)))
    }

    /// A shade by its visible values and, if known, its solar ones.
    #[staticmethod]
    fn shade(visible: &PyBsdf, solar: Option<&PyBsdf>, flipped: bool) -> Self {
        let solar = solar.map(|bsdf| bsdf.0.clone());
        Self(Layer::Shade(Shade { visible: visible.0.clone(), solar, flipped }))
    }
}

/// Layers from outside to inside.
#[pyclass(frozen, name = "System", module = "sunpeak._core")]
pub struct PySystem(System);

fn band(name: &str) -> PyResult<Band> {
    match name {
        "visible" => Ok(Band::Visible),
        "solar" => Ok(Band::Solar),
        _ => Err(InputError::new_err(format!("band: {name:?}; expected visible or solar"))),
    }
}

#[pymethods]
impl PySystem {
    #[new]
    fn new(name: String, layers: Vec<PyRef<'_, PyLayer>>) -> PyResult<Self> {
        let layers = layers.iter().map(|layer| layer.0.clone()).collect();
        Ok(Self(System::new(name, layers).or_raise()?))
    }

    fn lacks_solar(&self) -> bool {
        self.0.lacks_solar()
    }

    /// For light from `w_in` (n, 3), outside at positive z: straight-through transmittance and mirror reflectance [-], (n, 2).
    fn straight<'py>(
        &self,
        py: Python<'py>,
        w_in: PyReadonlyArray2<'py, f64>,
        band: &str,
    ) -> PyResult<Rows<'py>> {
        let band = self::band(band)?;
        let rows = directions(&w_in, "w_in")?.into_iter().map(|w| {
            let optics = self.0.straight(band, -w.truncate())?;
            let from = usize::from(w.z < 0.0);
            Ok(vec![optics.t[from], optics.r[from]])
        });
        let rows = rows.collect::<sunpeak_core::Result<Vec<_>>>().or_raise()?;
        PyArray2::from_vec2(py, &rows).map_err(|error| InputError::new_err(error.to_string()))
    }

    /// One band in a basis; `middle`: panes by their value at the middle of a patch.
    #[pyo3(signature = (basis, band, middle, kept=None, progress=None))]
    fn tabulate(
        &self,
        py: Python<'_>,
        basis: &str,
        band: &str,
        middle: bool,
        kept: Option<PyRef<'_, PyKept>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyBsdf> {
        let (band, basis) = (self::band(band)?, basis.parse::<Basis>().or_raise()?);
        let panes = if middle { Panes::Middle } else { Panes::Mean };
        let bsdf = run_kept(
            py,
            kept.as_deref(),
            progress.as_ref(),
            |sum| sum.text(&format!("{basis} {band:?} {panes:?}")).and_then(|()| self.0.sum_up(sum)),
            |work| self.0.tabulate(basis, band, panes, work),
        )?;
        Ok(PyBsdf(Arc::new(bsdf)))
    }
}

/// Transmittance and reflectance [-] at normal incidence of a slab of an index with what one pass through it leaves.
#[pyfunction]
pub fn slab_optics(index: f64, pass: f64, cosine: f64) -> (f64, f64) {
    let [t, r] = slab(index, pass, cosine);
    (t, r)
}

/// Share of the visible wavelengths in the sun's energy [-].
#[pyfunction]
pub fn visible_share() -> f64 {
    Band::Solar.visible_share()
}
