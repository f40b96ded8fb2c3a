//! Function files, data files, pictures and fonts, each read once.

use super::ray::ray_definitions;
use super::{DataArray, Field, FieldFrame};
use crate::files::{LoadOptions, read};
use crate::{Picture, picture::SpectralPicture, raw::Primitive, text::Font};
use std::{collections::HashMap, path::Path, path::PathBuf, sync::Arc, sync::OnceLock};
use sunpeak_cal::Definitions;
use sunpeak_core::{Error, Transform};

/// What a field is made of: places among the string arguments of its primitive.
pub(crate) struct FieldPlan<'a> {
    /// Of the function file.
    pub file: usize,
    /// Of expressions.
    pub expressions: &'a [usize],
    /// Of names of functions, and with how many arguments each is called.
    pub functions: &'a [(usize, usize)],
    /// What is looked up, as many as there are functions or one.
    pub arrays: Vec<Arc<DataArray>>,
    pub to_world: Transform,
}

/// Definitions and data that scene files name.
pub(crate) struct FunctionFiles {
    definitions: Definitions,
    data: HashMap<PathBuf, Arc<DataArray>>,
    pictures: HashMap<PathBuf, [Arc<DataArray>; 3]>,
    fonts: HashMap<PathBuf, Arc<Font>>,
}

/// Where to look for files of a primitive.
#[derive(Clone, Copy)]
pub(crate) struct Places<'a> {
    pub options: &'a LoadOptions,
    pub cwd: &'a Path,
    pub primitive: &'a Primitive,
}

impl Places<'_> {
    fn find(&self, name: &str) -> Result<PathBuf, String> {
        let Self { options, cwd, primitive } = self;
        options.find(name, cwd, &primitive.directory, &primitive.location).map_err(|error| match error {
            Error::Input { message, .. } => message,
            other => other.to_string(),
        })
    }

    pub fn read(&self, name: &str) -> Result<(PathBuf, Vec<u8>), String> {
        let path = self.find(name)?;
        let bytes = read(&path).map_err(|error| error.to_string())?;
        Ok((path, bytes))
    }
}

impl FunctionFiles {
    pub fn new() -> Self {
        Self {
            definitions: ray_definitions(),
            data: HashMap::new(),
            pictures: HashMap::new(),
            fonts: HashMap::new(),
        }
    }

    /// Number of parameters of a function that a primitive with this function file names.
    pub fn parameters(&mut self, places: Places, file: &str, name: &str) -> Result<Option<usize>, String> {
        let context = self.context(places, file)?;
        Ok(self.definitions.parameters(name, &context))
    }

    /// A field of a primitive.
    pub fn field(&mut self, places: Places, plan: FieldPlan) -> Result<Field, String> {
        let (primitive, strings) = (places.primitive, &places.primitive.strings);
        let context = self.context(places, &strings[plan.file])?;
        let mut parsed = Vec::new();
        for &index in plan.expressions {
            parsed.push(
                self.definitions
                    .expression(&strings[index], &primitive.location, &context)
                    .map_err(|error| told(error, primitive))?,
            );
        }
        for &(index, count) in plan.functions {
            parsed.push(self.definitions.call(&strings[index], count, &primitive.location, &context));
        }
        let program =
            self.definitions.compile(&parsed, &primitive.reals).map_err(|error| told(error, primitive))?;
        Ok(Field {
            program,
            takes_all: plan.functions.iter().map(|(_, count)| *count == plan.arrays.len()).collect(),
            coordinates: if plan.arrays.is_empty() { 0 } else { plan.expressions.len() },
            arrays: plan.arrays,
            frame: FieldFrame::new(plan.to_world),
            title: format!("{} \"{}\"", primitive.kind.name, primitive.name),
            location: primitive.location.clone(),
            fault: OnceLock::new(),
        })
    }

    /// The context of a function file, which is read if it was not yet.
    fn context(&mut self, places: Places, file: &str) -> Result<String, String> {
        let context = Definitions::context_of(file);
        if context.is_empty() || self.definitions.has_context(&context) {
            return Ok(context);
        }
        let (path, text) = places.read(file).map_err(|message| format!("function file: {message}"))?;
        self.definitions.load(&text, &path.to_string_lossy(), &context).map_err(|error| error.to_string())?;
        Ok(context)
    }

    /// A data file.
    pub fn data(&mut self, places: Places, name: &str) -> Result<Arc<DataArray>, String> {
        let path = places.find(name).map_err(|message| format!("data file: {message}"))?;
        if let Some(known) = self.data.get(&path) {
            return Ok(known.clone());
        }
        let bytes = read(&path).map_err(|error| error.to_string())?;
        let array = DataArray::parse(&bytes, &path.to_string_lossy()).map_err(|error| error.to_string())?;
        let array = Arc::new(array);
        self.data.insert(path, array.clone());
        Ok(array)
    }

    /// A font.
    pub fn font(&mut self, places: Places, name: &str) -> Result<Arc<Font>, String> {
        let path = places.find(name).map_err(|message| format!("font file: {message}"))?;
        if let Some(known) = self.fonts.get(&path) {
            return Ok(known.clone());
        }
        let bytes = read(&path).map_err(|error| error.to_string())?;
        let font = Font::parse(&bytes, &path.to_string_lossy()).map_err(|error| error.to_string())?;
        let font = Arc::new(font);
        self.fonts.insert(path, font.clone());
        Ok(font)
    }

    /// A picture, one array for each channel.
    pub fn picture(&mut self, places: Places, name: &str) -> Result<[Arc<DataArray>; 3], String> {
        let path = places.find(name).map_err(|message| format!("picture: {message}"))?;
        if let Some(known) = self.pictures.get(&path) {
            return Ok(known.clone());
        }
        let (picture, aspect) = Picture::load_stored(&path).map_err(|error| error.to_string())?;
        let channels = DataArray::of_picture(&picture, aspect)
            .ok_or_else(|| format!("{}: a picture of 2 by 2 pixels or more is expected", path.display()))?;
        let channels = channels.map(Arc::new);
        self.pictures.insert(path, channels.clone());
        Ok(channels)
    }

    /// A picture of spectra.
    pub fn spectral_picture(&mut self, places: Places, name: &str) -> Result<Arc<DataArray>, String> {
        let path = places.find(name).map_err(|message| format!("hyperspectral picture: {message}"))?;
        if let Some(known) = self.data.get(&path) {
            return Ok(known.clone());
        }
        let picture = SpectralPicture::load(&path).map_err(|error| error.to_string())?;
        let array = DataArray::of_spectral_picture(&picture)
            .ok_or_else(|| format!("{}: a picture of 2 by 2 pixels or more is expected", path.display()))?;
        let array = Arc::new(array);
        self.data.insert(path, array.clone());
        Ok(array)
    }
}

/// The primitive's own place is said once, where the message ends up; a place in a function file is kept.
fn told(error: Error, primitive: &Primitive) -> String {
    match error {
        Error::Input { location, message } if location != primitive.location && !location.file.is_empty() => {
            format!("{location}: {message}")
        }
        Error::Input { message, .. } => message,
        other => other.to_string(),
    }
}
