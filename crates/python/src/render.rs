//! Rendering: `World`, pictures, rays and sensors.

use crate::arrays::{Rows, rows, vectors};
use crate::bsdf::peak_rule;
use crate::error::{InputError, OrRaise};
use crate::goal::GlareGoal;
use crate::picture::PyPicture;
use crate::scene::{PyScene, PyView};
use crate::watch::run_watched;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::sync::Arc;
use sunpeak_render::{
    PictureJudge, RenderOptions, World, WorldOptions, render_until, trace_irradiance, trace_radiance,
};
use sunpeak_scene::Picture;

/// A scene compiled for rendering.
#[pyclass(frozen, name = "World", module = "sunpeak._core")]
pub struct PyWorld(Arc<World>);

#[pymethods]
impl PyWorld {
    #[staticmethod]
    fn compile(py: Python<'_>, scene: &PyScene, peak: &str) -> PyResult<Self> {
        let options = WorldOptions { peak: peak_rule(peak)?, ..WorldOptions::default() };
        let world = py.detach(|| World::compile(&scene.0, &options)).or_raise()?;
        Ok(Self(Arc::new(world)))
    }
}

fn options(
    samples: Option<u32>,
    time_s: Option<f64>,
    error: Option<f64>,
    seed: u64,
    threads: Option<usize>,
    max_bounces: Option<u32>,
) -> RenderOptions {
    RenderOptions { samples, time_s, error, seed, threads, max_bounces, ..RenderOptions::default() }
}

/// Render a picture; `progress` is called with the work done and in all.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn render(
    py: Python<'_>,
    world: &PyWorld,
    view: &PyView,
    width: usize,
    height: usize,
    samples: Option<u32>,
    time_s: Option<f64>,
    error: Option<f64>,
    seed: u64,
    threads: Option<usize>,
    max_bounces: Option<u32>,
    goal: Option<(String, f64)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyPicture> {
    let options = options(samples, time_s, error, seed, threads, max_bounces);
    let goal = goal.map(|(kind, value)| GlareGoal::of(&kind, value)).transpose()?;
    let picture = run_watched(py, progress.as_ref(), |control| {
        let judge = goal.map(|goal| move |picture: &Picture| goal.is_reached(picture));
        let judge = judge.as_ref().map(|judge| judge as PictureJudge);
        render_until(&world.0, &view.0, (width, height), &options, control, judge)
    })?;
    Ok(PyPicture(Arc::new(picture)))
}

/// Radiance along rays, or irradiance at sensors: three channels (n, 3).
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
pub fn trace<'py>(
    py: Python<'py>,
    world: &PyWorld,
    origins: PyReadonlyArray2<'py, f64>,
    directions: PyReadonlyArray2<'py, f64>,
    irradiance: bool,
    samples: Option<u32>,
    time_s: Option<f64>,
    error: Option<f64>,
    seed: u64,
    threads: Option<usize>,
    max_bounces: Option<u32>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Rows<'py>> {
    let options = options(samples, time_s, error, seed, threads, max_bounces);
    let (points, towards) = (vectors(&origins, "origins")?, vectors(&directions, "directions")?);
    if points.len() != towards.len() {
        return Err(InputError::new_err("origins and directions: expected as many rows of both"));
    }
    let rays: Vec<_> = points.into_iter().zip(towards).collect();
    let values = run_watched(py, progress.as_ref(), |control| {
        let trace = if irradiance { trace_irradiance } else { trace_radiance };
        trace(&world.0, &rays, &options, control)
    })?;
    Ok(rows(py, &values))
}
