//! Python bindings of Sunpeak: conversions, error mapping and the release of the interpreter's lock; no algorithms.

mod arrays;
mod bsdf;
mod bsdf_files;
mod bsdf_report;
mod error;
mod expressions;
mod fabric;
mod generate;
mod glare;
mod goal;
mod kept;
mod measured;
mod model;
mod picture;
mod render;
mod scene;
mod sky;
mod synthetic;
mod system;
mod watch;

use pyo3::prelude::*;

/// The compiled core of `sunpeak`.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::bsdf::PyBsdf;
    #[pymodule_export]
    use super::bsdf_files::{bsdf_xml, convert_bsdf, load_solar};
    #[pymodule_export]
    use super::bsdf_report::{
        bsdf_report, exit_cells, incident_cells, instrument_seen, probe_directions, save_split,
        through_interval,
    };
    #[pymodule_export]
    use super::error::InputError;
    #[pymodule_export]
    use super::expressions::evaluate;
    #[pymodule_export]
    use super::fabric::{roller_blind, roller_blind_transmittance};
    #[pymodule_export]
    use super::generate::{PyGenerated, generate_bsdf, straight_transmittance};
    #[pymodule_export]
    use super::glare::{glare, glare_sources, position_indices};
    #[pymodule_export]
    use super::kept::PyKept;
    #[pymodule_export]
    use super::measured::{PyMeasured, PyScan, measured_bsdf, read_scans};
    #[pymodule_export]
    use super::model::{model_bsdf, model_value};
    #[pymodule_export]
    use super::picture::PyPicture;
    #[pymodule_export]
    use super::render::{PyWorld, render, trace};
    #[pymodule_export]
    use super::scene::{PyScene, PyView, expanded_scene, read_octree, write_octree};
    #[pymodule_export]
    use super::sky::PySky;
    #[pymodule_export]
    use super::synthetic::{exact_bsdf, synthetic_bsdf, synthetic_through};
    #[pymodule_export]
    use super::system::{PyLayer, PySystem, slab_optics, visible_share};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
