//! `Scene` and `View`: what scene files and view files say.

use crate::arrays::{Image, Numbers, Rows, directions, numbers, rows};
use crate::error::{InputError, OrRaise};
use numpy::{PyArray2, PyArray3, PyReadonlyArray2, ndarray};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_core::Vec3;
use sunpeak_scene::{
    Camera, LoadOptions, Modifier, ModifierKind, OctreeFile, Scene, Source, View, ViewRay, decode_octree,
    load_primitives,
};

/// Surfaces and modifiers, in file order.
#[pyclass(frozen, name = "Scene", module = "sunpeak._core")]
pub struct PyScene(pub Arc<Scene>);

#[pymethods]
impl PyScene {
    #[staticmethod]
    fn load(
        py: Python<'_>,
        files: Vec<PathBuf>,
        search_path: Vec<PathBuf>,
        allow_commands: bool,
    ) -> PyResult<Self> {
        let options = options(search_path, allow_commands);
        let scene = py.detach(|| Scene::load(&files, &options)).or_raise()?;
        Ok(Self(Arc::new(scene)))
    }

    #[staticmethod]
    fn parse(
        py: Python<'_>,
        text: &str,
        name: &str,
        search_path: Vec<PathBuf>,
        allow_commands: bool,
    ) -> PyResult<Self> {
        let options = options(search_path, allow_commands);
        let scene = py.detach(|| Scene::parse(text, name, &options)).or_raise()?;
        Ok(Self(Arc::new(scene)))
    }

    /// From parts, each a file (or `!command`) or a text with its name and folder; names are relative to `cwd`.
    #[staticmethod]
    fn load_parts(
        py: Python<'_>,
        parts: Vec<Part>,
        cwd: PathBuf,
        search_path: Vec<PathBuf>,
        allow_commands: bool,
    ) -> PyResult<Self> {
        let options = LoadOptions { cwd: Some(cwd), ..options(search_path, allow_commands) };
        let sources: Vec<Source> = parts.into_iter().map(source).collect();
        let scene = py.detach(|| Scene::load_sources(&sources, &options)).or_raise()?;
        Ok(Self(Arc::new(scene)))
    }

    /// What can be read, and the mistakes and oddities in it.
    #[staticmethod]
    fn check(
        py: Python<'_>,
        files: Vec<PathBuf>,
        search_path: Vec<PathBuf>,
        allow_commands: bool,
    ) -> (Self, Vec<String>, Vec<String>) {
        let options = options(search_path, allow_commands);
        let sources: Vec<Source> = files.into_iter().map(Source::File).collect();
        let found = py.detach(|| Scene::check(&sources, &options));
        let errors = found.errors.iter().map(ToString::to_string).collect();
        (Self(Arc::new(found.scene)), errors, found.warnings)
    }

    /// Name, modifier and material of each surface, and whether it shines.
    fn surface_labels(&self) -> Vec<(&str, &str, &str, bool)> {
        let all = self.0.surfaces.iter();
        all.map(|surface| {
            let chain = std::iter::successors(surface.modifier, |id| self.0.modifiers[id.0].parent);
            let chain: Vec<&Modifier> = chain.map(|id| &self.0.modifiers[id.0]).collect();
            let modifier = chain.first().map_or("void", |modifier| modifier.name.as_str());
            let material = chain.iter().find(|modifier| matches!(modifier.kind, ModifierKind::Material(_)));
            let shines = material.is_some_and(|material| shines(&material.kind));
            (surface.name.as_str(), modifier, material.map_or("void", |m| m.name.as_str()), shines)
        })
        .collect()
    }

    /// As MGF, moved by an offset.
    fn to_mgf(&self, py: Python<'_>, offset: [f64; 3]) -> PyResult<String> {
        py.detach(|| self.0.to_mgf(offset.into())).or_raise()
    }

    /// Lowest and highest coordinates of all surfaces; None if none is anywhere.
    fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        self.0.bounds().map(|[low, high]| (low.to_array(), high.to_array()))
    }

    #[getter]
    fn surface_names(&self) -> Vec<&str> {
        self.0.surfaces.iter().map(|surface| surface.name.as_str()).collect()
    }

    #[getter]
    fn modifier_names(&self) -> Vec<&str> {
        self.0.modifiers.iter().map(|modifier| modifier.name.as_str()).collect()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }
}

fn shines(kind: &ModifierKind) -> bool {
    use sunpeak_scene::Material::{Glow, Illum, Light, Spotlight};
    matches!(kind, ModifierKind::Material(Light(_) | Illum { .. } | Glow { .. } | Spotlight { .. }))
}

/// A file or `!command`, or a name, a text and a folder.
#[derive(FromPyObject, IntoPyObject)]
pub enum Part {
    Text(String, PyBytes, PathBuf),
    #[pyo3(transparent)]
    File(PathBuf),
}

/// `bytes`.
pub struct PyBytes(Vec<u8>);

impl<'a, 'py> FromPyObject<'a, 'py> for PyBytes {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(object.extract::<&[u8]>()?.to_vec()))
    }
}

impl<'py> IntoPyObject<'py> for PyBytes {
    type Target = pyo3::types::PyBytes;
    type Output = Bound<'py, Self::Target>;
    type Error = std::convert::Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(pyo3::types::PyBytes::new(py, &self.0))
    }
}

fn source(part: Part) -> Source {
    match part {
        Part::Text(name, text, directory) => Source::Text { name, text: text.0, directory },
        Part::File(path) => Source::File(path),
    }
}

/// The primitives of parts after their commands are done, as texts; each with the folder where files that it names are looked for.
#[pyfunction]
pub fn expanded_scene(
    py: Python<'_>,
    parts: Vec<Part>,
    cwd: PathBuf,
    search_path: Vec<PathBuf>,
    allow_commands: bool,
) -> PyResult<Vec<(PathBuf, String)>> {
    let options = LoadOptions { cwd: Some(cwd), ..options(search_path, allow_commands) };
    let sources: Vec<Source> = parts.into_iter().map(source).collect();
    let primitives = py.detach(|| load_primitives(&sources, &options)).or_raise()?;
    let mut texts: Vec<(PathBuf, String)> = Vec::new();
    for primitive in primitives {
        if texts.last().is_none_or(|(directory, _)| **directory != *primitive.directory) {
            texts.push((primitive.directory.to_path_buf(), String::new()));
        }
        if let Some((_, text)) = texts.last_mut() {
            // Writing to a string does not fail.
            let _ = write!(text, "{primitive}");
        }
    }
    Ok(texts)
}

/// An octree file: header lines, folder, number of surfaces if it is known, parts.
type OctreeParts = (Vec<String>, PathBuf, Option<usize>, Vec<Part>);

/// Read the bytes of an octree file, ours or Radiance's.
#[pyfunction]
pub fn read_octree(py: Python<'_>, data: Vec<u8>, name: PathBuf) -> PyResult<OctreeParts> {
    let file = py.detach(|| decode_octree(data, &name)).or_raise()?;
    let part = |source| match source {
        Source::File(path) => Part::File(path),
        Source::Text { name, text, directory } => Part::Text(name, PyBytes(text), directory),
    };
    Ok((file.history, file.cwd, file.surfaces, file.sources.into_iter().map(part).collect()))
}

/// The bytes of an octree file.
#[pyfunction]
pub fn write_octree<'py>(
    py: Python<'py>,
    history: Vec<String>,
    cwd: PathBuf,
    surfaces: Option<usize>,
    parts: Vec<Part>,
) -> PyResult<Bound<'py, pyo3::types::PyBytes>> {
    let sources = parts.into_iter().map(source).collect();
    let bytes = py.detach(|| OctreeFile { history, cwd, surfaces, sources }.encode()).or_raise()?;
    Ok(pyo3::types::PyBytes::new(py, &bytes))
}

/// The search path given, then that of the environment (`RAYPATH`).
fn options(search_path: Vec<PathBuf>, allow_commands: bool) -> LoadOptions {
    let environment = LoadOptions::from_environment();
    let search_path = search_path.into_iter().chain(environment.search_path.clone()).collect();
    LoadOptions { search_path, allow_commands, ..environment }
}

/// How directions are laid on a picture.
#[pyclass(frozen, name = "View", module = "sunpeak._core")]
pub struct PyView(pub View);

#[pymethods]
impl PyView {
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        Ok(Self(View::load(&path).or_raise()?))
    }

    #[staticmethod]
    fn parse(options: &str) -> PyResult<Self> {
        Ok(Self(View::parse(options).or_raise()?))
    }

    /// From options as words, which may hold blanks.
    #[staticmethod]
    fn parse_words(words: Vec<String>) -> PyResult<Self> {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        Ok(Self(View::parse_words(&words).or_raise()?))
    }

    /// Height over width when pixels are square.
    #[getter]
    fn aspect(&self) -> f64 {
        self.0.aspect()
    }

    /// Rays through picture points (n, 2): origins, unit directions (n, 3) and lengths (n,), which may be infinite; NaN where the view
    /// does not reach.
    fn rays_at<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Rows<'py>, Rows<'py>, Numbers<'py>)> {
        let camera = self.camera()?;
        let points = points.as_array();
        if points.ncols() != 2 {
            return Err(InputError::new_err("points: expected the shape (n, 2)"));
        }
        let nowhere = ViewRay { origin: Vec3::NAN, direction: Vec3::NAN, max_distance: f64::NAN };
        let ray = |point: ndarray::ArrayView1<'_, f64>| camera.ray(point[0], point[1]).unwrap_or(nowhere);
        let rays: Vec<ViewRay> = points.rows().into_iter().map(ray).collect();
        let part = |part: fn(&ViewRay) -> Vec3| rows(py, &rays.iter().map(part).collect::<Vec<_>>());
        let lengths = rays.iter().map(|ray| ray.max_distance).collect();
        Ok((part(|ray| ray.origin), part(|ray| ray.direction), numbers(py, lengths)))
    }

    fn options(&self) -> String {
        self.0.to_string()
    }

    /// The fields, by the names of the Python class.
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let view = &self.0;
        let fields = PyDict::new(py);
        fields.set_item("kind", view.kind.option())?;
        fields.set_item("position", view.position.to_array())?;
        fields.set_item("direction", view.direction.to_array())?;
        fields.set_item("up", view.up.to_array())?;
        fields.set_item("horizontal_deg", view.horizontal_deg)?;
        fields.set_item("vertical_deg", view.vertical_deg)?;
        fields.set_item("fore", view.fore)?;
        fields.set_item("aft", view.aft)?;
        Ok(fields)
    }

    fn fit_size(&self, max_width: usize, max_height: usize) -> (usize, usize) {
        self.0.fit_size(max_width, max_height)
    }

    /// Origins and unit directions (h, w, 3) of the rays through the middles of the pixels; NaN where the view does not reach.
    fn rays<'py>(&self, py: Python<'py>, width: usize, height: usize) -> PyResult<(Image<'py>, Image<'py>)> {
        let camera = self.camera()?;
        let nowhere = ViewRay { origin: Vec3::NAN, direction: Vec3::NAN, max_distance: f64::NAN };
        let rays: Vec<ViewRay> = py.detach(|| {
            let middles = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
            middles
                .map(|(column, row)| {
                    let x = (column as f64 + 0.5) / width as f64;
                    let y = 1.0 - (row as f64 + 0.5) / height as f64;
                    camera.ray(x, y).unwrap_or(nowhere)
                })
                .collect()
        });
        let array = |part: fn(&ViewRay) -> Vec3| {
            let values =
                ndarray::Array3::from_shape_fn((height, width, 3), |(r, c, i)| part(&rays[r * width + c])[i]);
            PyArray3::from_owned_array(py, values)
        };
        Ok((array(|ray| ray.origin), array(|ray| ray.direction)))
    }

    /// Solid angles [sr] of the pixels (h, w).
    fn solid_angles<'py>(
        &self,
        py: Python<'py>,
        width: usize,
        height: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let camera = self.camera()?;
        let angles = py.detach(|| camera.solid_angles(width, height));
        let array = ndarray::Array2::from_shape_vec((height, width), angles)
            .map_err(|error| InputError::new_err(error.to_string()))?;
        Ok(PyArray2::from_owned_array(py, array))
    }

    /// Where directions (n, 3) fall on the picture: x to the right and y upwards, 0 to 1 (n, 2); NaN where they do not.
    fn project<'py>(
        &self,
        py: Python<'py>,
        towards: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Numbers<'py>, Numbers<'py>)> {
        let camera = self.camera()?;
        let points: Vec<[f64; 2]> = directions(&towards, "directions")?
            .into_iter()
            .map(|direction| camera.project(direction).unwrap_or([f64::NAN; 2]))
            .collect();
        let [x, y] = [0, 1].map(|axis| numbers(py, points.iter().map(|point| point[axis]).collect()));
        Ok((x, y))
    }
}

impl PyView {
    fn camera(&self) -> PyResult<Camera> {
        self.0.check().or_raise()?;
        Camera::new(&self.0).ok_or_else(|| InputError::new_err("the view cannot be used"))
    }
}
