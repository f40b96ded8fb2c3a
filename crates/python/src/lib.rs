//! Python bindings of Sunpeak: conversions, error mapping and the release of the interpreter's lock; no algorithms.

mod arrays;
mod bsdf;
mod bsdf_report;
mod error;
mod expressions;
mod fabric;
mod generate;
mod glare;
mod goal;
mod picture;
mod render;
mod scene;
mod sky;
mod synthetic;
mod watch;

use pyo3::prelude::*;

/// The compiled core of `sunpeak`.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::bsdf::PyBsdf;
    #[pymodule_export]
    use super::bsdf_report::{
        bsdf_report, bsdf_xml, exit_cells, incident_cells, instrument_seen, probe_directions, save_split,
        through_interval,
    };
    #[pymodule_export]
    use super::error::InputError;
    #[pymodule_export]
    use super::expressions::evaluate;
    #[pymodule_export]
    use super::fabric::{fabric_xml, roller_blind_transmittance, roller_blind_xml};
    #[pymodule_export]
    use super::generate::{PyGenerated, generate_bsdf, straight_transmittance};
    #[pymodule_export]
    use super::glare::{glare, glare_sources, position_indices};
    #[pymodule_export]
    use super::picture::PyPicture;
    #[pymodule_export]
    use super::render::{PyWorld, render, trace};
    #[pymodule_export]
    use super::scene::{PyScene, PyView, expanded_scene, read_octree, write_octree};
    #[pymodule_export]
    use super::sky::PySky;
    #[pymodule_export]
    use super::synthetic::{synthetic_bsdf, synthetic_through};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
