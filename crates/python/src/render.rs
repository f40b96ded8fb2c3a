//! Rendering: `World`, pictures, rays and sensors.

use crate::arrays::{Numbers, Rows, numbers, rows, vectors};
use crate::bsdf::peak_rule;
use crate::error::{InputError, OrRaise};
use crate::goal::GlareGoal;
use crate::picture::PyPicture;
use crate::scene::{PyScene, PyView};
use crate::watch::run_watched;
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::Arc;
use sunpeak_core::{Rgb, Vec3};
use sunpeak_render::{
    FirstDeltas, FirstSurface, PictureJudge, RenderOptions, World, WorldOptions, first_deltas,
    first_surfaces, render_until, trace_irradiance, trace_radiance,
};
use sunpeak_scene::Picture;

/// A scene compiled for rendering.
#[pyclass(frozen, name = "World", module = "sunpeak._core")]
pub struct PyWorld(pub Arc<World>);

#[pymethods]
impl PyWorld {
    #[staticmethod]
    #[pyo3(signature = (scene, peak, portals=Vec::new()))]
    fn compile(py: Python<'_>, scene: &PyScene, peak: &str, portals: Vec<String>) -> PyResult<Self> {
        let options = WorldOptions { peak: peak_rule(peak)?, portals, ..WorldOptions::default() };
        let world = py.detach(|| World::compile(&scene.0, &options)).or_raise()?;
        Ok(Self(Arc::new(world)))
    }

    /// What rays meet first: distances (n,), points (n, 3), normals of the front, without smoothing, and bent (n, 3), local coordinates and
    /// 0 (n, 3), indices of surfaces (n,); infinity, NaN and -1 where nothing is met.
    fn first_surfaces<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'py, f64>,
        directions: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<FirstSurfaces<'py>> {
        let (points, towards) = (vectors(&origins, "origins")?, vectors(&directions, "directions")?);
        let rays: Vec<_> = points.into_iter().zip(towards).collect();
        let found = py.detach(|| first_surfaces(&self.0, &rays)).or_raise()?;
        let part = |part: fn(&FirstSurface) -> Vec3| {
            let of_ray = |first: &Option<FirstSurface>| first.as_ref().map_or(Vec3::NAN, part);
            rows(py, &found.iter().map(of_ray).collect::<Vec<_>>())
        };
        let distances =
            found.iter().map(|first| first.map_or(f64::INFINITY, |first| first.distance)).collect();
        let surfaces = found.iter().map(|first| first.map_or(-1, |first| first.surface as i64)).collect();
        Ok((
            numbers(py, distances),
            part(|first| first.point),
            [part(|first| first.normal), part(|first| first.flat_normal), part(|first| first.bent_normal)],
            part(|first| Vec3::new(first.local[0], first.local[1], 0.0)),
            PyArray1::from_vec(py, surfaces),
        ))
    }

    /// What the first surfaces mirror and let through: points, mirrored shares, their directions, straight shares (n, 3), and which show
    /// things at their distance (n,); zeros where nothing is met or what shines.
    fn first_deltas<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'py, f64>,
        directions: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<FirstDeltaRows<'py>> {
        let (points, towards) = (vectors(&origins, "origins")?, vectors(&directions, "directions")?);
        let rays: Vec<_> = points.into_iter().zip(towards).collect();
        let found = py.detach(|| first_deltas(&self.0, &rays)).or_raise()?;
        let part = |part: fn(&FirstDeltas) -> Vec3| {
            let vectors: Vec<Vec3> =
                found.iter().map(|deltas| deltas.as_ref().map_or(Vec3::ZERO, part)).collect();
            rows(py, &vectors)
        };
        let is_plane_glass = found.iter().map(|deltas| deltas.is_some_and(|d| d.is_plane_glass)).collect();
        Ok((
            part(|d| d.point),
            part(|d| d.mirrored),
            part(|d| d.mirrored_direction),
            part(|d| d.straight),
            PyArray1::from_vec(py, is_plane_glass),
        ))
    }
}

/// Distances, points, normals, surfaces.
type FirstSurfaces<'py> = (Numbers<'py>, Rows<'py>, [Rows<'py>; 3], Rows<'py>, Bound<'py, PyArray1<i64>>);

/// Points, mirrored shares, mirrored directions, straight shares, whether glass is plane.
type FirstDeltaRows<'py> = (Rows<'py>, Rows<'py>, Rows<'py>, Rows<'py>, Bound<'py, PyArray1<bool>>);

fn options(
    samples: Option<u32>,
    time_s: Option<f64>,
    error: Option<f64>,
    seed: u64,
    threads: Option<usize>,
    max_bounces: Option<u32>,
    ambient: [f64; 3],
) -> RenderOptions {
    let ambient = Rgb::from_array(ambient);
    RenderOptions { samples, time_s, error, seed, threads, max_bounces, ambient, ..RenderOptions::default() }
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
    ambient: [f64; 3],
    goal: Option<(String, f64)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyPicture> {
    let options = options(samples, time_s, error, seed, threads, max_bounces, ambient);
    let goal = goal.map(|(kind, value)| GlareGoal::of(&kind, value)).transpose()?;
    let picture = run_watched(py, progress.as_ref(), |control| {
        let judge = goal.map(|goal| move |picture: &Picture| goal.is_reached(picture));
        let judge = judge.as_ref().map(|judge| judge as PictureJudge);
        render_until(&world.0, &view.0, (width, height), &options, control, judge)
    })?;
    Ok(PyPicture(Arc::new(picture)))
}

/// Radiance along rays, or irradiance at sensors: three channels (n, 3); and the standard errors of their luminous mean.
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
    ambient: [f64; 3],
    error_of_each: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Rows<'py>, Option<Numbers<'py>>)> {
    let options = options(samples, time_s, error, seed, threads, max_bounces, ambient);
    let options = RenderOptions { error_of_each, ..options };
    let (points, towards) = (vectors(&origins, "origins")?, vectors(&directions, "directions")?);
    if points.len() != towards.len() {
        return Err(InputError::new_err("origins and directions: expected as many rows of both"));
    }
    let rays: Vec<_> = points.into_iter().zip(towards).collect();
    let traced = run_watched(py, progress.as_ref(), |control| {
        let trace = if irradiance { trace_irradiance } else { trace_radiance };
        trace(&world.0, &rays, &options, control)
    })?;
    Ok((rows(py, &traced.values), traced.standard_errors.map(|errors| PyArray1::from_vec(py, errors))))
}
