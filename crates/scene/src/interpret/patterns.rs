//! Patterns, textures and mixtures from their arguments (reference manual, "Patterns", "Textures", "Mixtures").

use super::args::title;
use super::{Interpreter, Unusable, sky};
use crate::command::trailing_transform;
use crate::field::{DataArray, Field, FieldPlan, MAX_DIMENSIONS, Places, Spectrum};
use crate::{ModifierKind, Pattern, Weight, raw::Primitive};
use std::sync::Arc;
use sunpeak_core::Transform;

/// Samples of a spectral function.
const SPECTRAL_SAMPLES: usize = 40;

impl Interpreter<'_> {
    /// A pattern, texture or mixture; `None` for another type.
    pub(super) fn modulation(&mut self, primitive: &Primitive) -> Result<Option<ModifierKind>, Unusable> {
        let pattern = |pattern: Pattern| ModifierKind::Pattern(pattern);
        let kind = match primitive.kind.name {
            "brightfunc" => match sky::sky(primitive)? {
                Some(sky) => pattern(Pattern::Sky(sky)),
                None => pattern(Pattern::Bright(self.function(primitive, &[0], 1)?)),
            },
            "colorfunc" => pattern(Pattern::Color(self.function(primitive, &[0, 1, 2], 3)?)),
            "brightdata" => pattern(Pattern::Bright(self.data(primitive, 0, 1, 1)?)),
            "colordata" => pattern(Pattern::Color(self.data(primitive, 0, 3, 3)?)),
            "colorpict" => pattern(Pattern::Color(self.picture(primitive, 0, 3)?)),
            "brighttext" => pattern(self.text_pattern(primitive, 1)?),
            "colortext" => pattern(self.text_pattern(primitive, 3)?),
            "spectrum" => pattern(Pattern::Uniform(spectrum(primitive)?)),
            "specfile" => pattern(Pattern::Uniform(self.spectrum_file(primitive)?)),
            "specfunc" => pattern(self.spectral_function(primitive)?),
            "specdata" => pattern(self.spectral_data(primitive)?),
            "specpict" => pattern(self.spectral_picture(primitive)?),
            "texfunc" => ModifierKind::Texture(self.function(primitive, &[0, 1, 2], 3)?),
            "texdata" => ModifierKind::Texture(self.data(primitive, 0, 3, 3)?),
            "mixfunc" => {
                self.mixture(primitive, |this| this.function(primitive, &[2], 3).map(Weight::Field))?
            }
            "mixdata" => self.mixture(primitive, |this| this.data(primitive, 2, 1, 1).map(Weight::Field))?,
            "mixpict" => self.mixture(primitive, |this| this.picture(primitive, 2, 1).map(Weight::Field))?,
            "mixtext" => self.mixture(primitive, |this| this.text_mask(primitive).map(Weight::Text))?,
            _ => return Ok(None),
        };
        Ok(Some(kind))
    }

    /// Make a field; the transform stands after the argument `last`.
    pub(super) fn field(
        &mut self,
        primitive: &Primitive,
        file: usize,
        expressions: &[usize],
        functions: &[(usize, usize)],
        arrays: Vec<Arc<DataArray>>,
    ) -> Result<Arc<Field>, String> {
        let used = expressions.iter().chain(functions.iter().map(|(index, _)| index));
        let last = used.copied().max().unwrap_or(0).max(file);
        let to_world = transform_after(primitive, last)?;
        let plan = FieldPlan { file, expressions, functions, arrays, to_world };
        let places = Places { options: self.options, cwd: &self.cwd, primitive };
        let field = self.functions.field(places, plan);
        field.map(Arc::new).map_err(|message| format!("{}: {message}", title(primitive)))
    }

    /// `expressions… file [transform]`
    fn function(
        &mut self,
        primitive: &Primitive,
        expressions: &[usize],
        file: usize,
    ) -> Result<Arc<Field>, String> {
        at_least(primitive, file + 1, "expressions and a function file")?;
        self.field(primitive, file, expressions, &[], Vec::new())
    }

    /// `functions… datafiles… file coordinates… [transform]`, from argument `first`.
    fn data(
        &mut self,
        primitive: &Primitive,
        first: usize,
        functions: usize,
        files: usize,
    ) -> Result<Arc<Field>, String> {
        let file = first + functions + files;
        at_least(primitive, file + 2, "functions, data files, a function file and coordinates")?;
        let mut arrays = Vec::new();
        for name in &primitive.strings[first + functions..file] {
            arrays.push(self.data_file(primitive, name)?);
        }
        let dimensions = arrays[0].dimensions();
        if arrays.iter().any(|array| array.dimensions() != dimensions) {
            return Err(format!("{}: the data files have different dimensions", title(primitive)));
        }
        at_least(primitive, file + 1 + dimensions, "a coordinate for each dimension of the data")?;
        let coordinates: Vec<usize> = (file + 1..=file + dimensions).collect();
        let functions = self.calls(primitive, file, first..first + functions, files)?;
        self.field(primitive, file, &coordinates, &functions, arrays)
    }

    /// `functions… picture file x y [transform]`; the picture's rows are the first dimension of its data.
    fn picture(
        &mut self,
        primitive: &Primitive,
        first: usize,
        functions: usize,
    ) -> Result<Arc<Field>, String> {
        let file = first + functions + 1;
        at_least(primitive, file + 3, "functions, a picture, a function file and two coordinates")?;
        let places = Places { options: self.options, cwd: &self.cwd, primitive };
        let channels = self.functions.picture(places, &primitive.strings[file - 1]);
        let channels = channels.map_err(|message| format!("{}: {message}", title(primitive)))?;
        let functions = self.calls(primitive, file, first..first + functions, 3)?;
        self.field(primitive, file, &[file + 2, file + 1], &functions, channels.to_vec())
    }

    /// With how many arguments each function is called: all values, or its own alone if it takes fewer than three and is not
    /// the first.
    fn calls(
        &mut self,
        primitive: &Primitive,
        file: usize,
        functions: std::ops::Range<usize>,
        values: usize,
    ) -> Result<Vec<(usize, usize)>, String> {
        let first = functions.start;
        let mut calls = Vec::new();
        for index in functions {
            let places = Places { options: self.options, cwd: &self.cwd, primitive };
            let (file, name) = (&primitive.strings[file], &primitive.strings[index]);
            let takes = self.functions.parameters(places, file, name);
            let takes = takes.map_err(|message| format!("{}: {message}", title(primitive)))?;
            let is_alone =
                index > first && takes.is_some_and(|count| count < 3) && primitive.kind.name != "texdata";
            calls.push((index, if is_alone { 1 } else { values }));
        }
        Ok(calls)
    }

    pub(super) fn data_file(&mut self, primitive: &Primitive, name: &str) -> Result<Arc<DataArray>, String> {
        let places = Places { options: self.options, cwd: &self.cwd, primitive };
        self.functions.data(places, name).map_err(|message| format!("{}: {message}", title(primitive)))
    }

    fn spectrum_file(&mut self, primitive: &Primitive) -> Result<sunpeak_core::Rgb, String> {
        let [name] = primitive.strings.as_slice() else {
            return Err(format!("{}: expected 1 string argument, the data file", title(primitive)));
        };
        let data = self.data_file(primitive, name)?;
        if data.dimensions() != 1 {
            return Err(format!("{}: expected a data file of 1 dimension, the wavelength", title(primitive)));
        }
        let wavelengths = data.last_coordinates();
        let (first, last) = (wavelengths[0], wavelengths[wavelengths.len() - 1]);
        let spectrum = Spectrum::of_samples(first, last, wavelengths.len());
        let samples = spectrum.wavelengths_nm().iter().map(|nm| data.interpolate(&[*nm])).collect::<Vec<_>>();
        Ok(spectrum.color(samples))
    }

    /// `specfunc`: function, file; the first real arguments are the range of wavelengths.
    fn spectral_function(&mut self, primitive: &Primitive) -> Result<Pattern, String> {
        at_least(primitive, 2, "a function and a function file")?;
        let [begin, end, ..] = primitive.reals[..] else {
            return Err(format!(
                "{}: expected 2 or more real arguments, the wavelengths first",
                title(primitive)
            ));
        };
        check_wavelengths(primitive, begin, end)?;
        let field = self.field(primitive, 1, &[], &[(0, 1)], Vec::new())?;
        Ok(Pattern::Spectral { field, spectrum: Spectrum::of_intervals(begin, end, SPECTRAL_SAMPLES) })
    }

    /// `specdata`: function, data file, function file, coordinates but the last one, which is the wavelength.
    fn spectral_data(&mut self, primitive: &Primitive) -> Result<Pattern, String> {
        at_least(primitive, 4, "a function, a data file, a function file and coordinates")?;
        let data = self.data_file(primitive, &primitive.strings[1])?;
        let dimensions = data.dimensions();
        if !(2..=MAX_DIMENSIONS).contains(&dimensions) {
            return Err(format!(
                "{}: expected data of 2 or more dimensions, the last the wavelength",
                title(primitive)
            ));
        }
        at_least(primitive, 2 + dimensions, "a coordinate for each dimension of the data but the last")?;
        let coordinates: Vec<usize> = (3..2 + dimensions).collect();
        self.spectra_of(primitive, &coordinates, data)
    }

    /// `specpict`: function, picture, function file, x, y.
    fn spectral_picture(&mut self, primitive: &Primitive) -> Result<Pattern, String> {
        at_least(primitive, 5, "a function, a hyperspectral picture, a function file and two coordinates")?;
        let places = Places { options: self.options, cwd: &self.cwd, primitive };
        let data = self.functions.spectral_picture(places, &primitive.strings[1]);
        let data = data.map_err(|message| format!("{}: {message}", title(primitive)))?;
        self.spectra_of(primitive, &[4, 3], data)
    }

    /// Spectra in data whose last dimension is the wavelength; the coordinates of the others stand at these string arguments.
    fn spectra_of(
        &mut self,
        primitive: &Primitive,
        coordinates: &[usize],
        data: Arc<DataArray>,
    ) -> Result<Pattern, String> {
        let wavelengths = data.last_coordinates();
        let (first, last) = (wavelengths[0], wavelengths[wavelengths.len() - 1]);
        check_wavelengths(primitive, first, last)?;
        let spectrum = Spectrum::of_samples(first, last, wavelengths.len());
        let field = self.field(primitive, 2, coordinates, &[(0, 2)], vec![data])?;
        Ok(Pattern::Spectral { field, spectrum })
    }

    fn mixture(
        &mut self,
        primitive: &Primitive,
        weight: impl FnOnce(&mut Self) -> Result<Weight, String>,
    ) -> Result<ModifierKind, Unusable> {
        at_least(primitive, 2, "a foreground and a background modifier")?;
        let [fore, back] = [0, 1].map(|i| self.mixed(primitive, &primitive.strings[i]));
        Ok(ModifierKind::Mixture { fore: fore?, back: back?, weight: weight(self)? })
    }
}

/// Samples of a spectrum: the real arguments after the first and last wavelength.
fn spectrum(primitive: &Primitive) -> Result<sunpeak_core::Rgb, String> {
    let [first, last, samples @ ..] = primitive.reals.as_slice() else {
        return Err(format!("{}: expected 5 or more real arguments", title(primitive)));
    };
    if samples.len() < 3 || !primitive.strings.is_empty() {
        let message = "expected no string arguments, two wavelengths and 3 or more samples";
        return Err(format!("{}: {message}", title(primitive)));
    }
    check_wavelengths(primitive, *first, *last)?;
    Ok(Spectrum::of_samples(*first, *last, samples.len()).color(samples.iter().copied()))
}

fn check_wavelengths(primitive: &Primitive, first: f64, last: f64) -> Result<(), String> {
    if first != last && first > 0.0 && last > 0.0 {
        return Ok(());
    }
    Err(format!("{}: expected two different wavelengths [nm], found {first} and {last}", title(primitive)))
}

pub(super) fn at_least(primitive: &Primitive, count: usize, what: &str) -> Result<(), String> {
    let found = primitive.strings.len();
    if found >= count {
        return Ok(());
    }
    Err(format!(
        "wrong number of arguments of {}: expected at least {count} string arguments ({what}), found {found}",
        title(primitive)
    ))
}

/// The transform in the arguments after this one.
pub(super) fn transform_after(primitive: &Primitive, last: usize) -> Result<Transform, String> {
    let rest = primitive.strings.get(last + 1..).unwrap_or_default();
    trailing_transform(rest).map_err(|message| format!("{}: bad transform: {message}", title(primitive)))
}
