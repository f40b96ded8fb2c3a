//! Header lines that mean something.

use super::{BlockErrors, ExactSource, errors};
use crate::{View, raw::parse_real, view::apply_header_line};
use std::fmt::Write;
use sunpeak_core::{Rgb, Vec3};

/// The line of an exact source: direction, solid angle [sr], radiance, visible fraction.
const SOURCE_KEY: &str = "SUNPEAK_SOURCE=";

/// Height over width of a pixel; several lines multiply.
pub(super) const ASPECT_KEY: &str = "PIXASPECT=";

/// What stands behind it.
pub(super) fn aspect(value: &str) -> Option<f64> {
    positive(value).map(|[aspect]| aspect)
}

/// What is in a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Radiance in Radiance's primaries.
    Rgbe,
    /// CIE X, Y, Z, Y in cd/m².
    Xyze,
}

/// A header, read line by line.
#[derive(Debug)]
pub struct Header {
    pub format: Format,
    /// What the pixels were multiplied by.
    pub exposure: Rgb,
    /// The factors of the `EXPOSURE=` lines.
    pub exposures: Vec<f64>,
    /// Height over width of a pixel.
    pub aspect: f64,
    pub view: Option<View>,
    /// Lines of block errors, without their key.
    pub errors: Vec<String>,
    pub sources: Vec<ExactSource>,
    /// All lines that are not turned into something else.
    pub others: Vec<String>,
}

impl Default for Header {
    fn default() -> Self {
        Self {
            format: Format::Rgbe,
            exposure: Rgb::ONE,
            exposures: Vec::new(),
            aspect: 1.0,
            view: None,
            errors: Vec::new(),
            sources: Vec::new(),
            others: Vec::new(),
        }
    }
}

impl Header {
    /// Take a line in.
    pub fn add(&mut self, line: &str) -> Result<(), String> {
        if let Some(value) = line.strip_prefix("FORMAT=") {
            self.format = match value.trim() {
                "32-bit_rle_rgbe" => Format::Rgbe,
                "32-bit_rle_xyze" => Format::Xyze,
                other => {
                    return Err(format!("the format {other}: expected 32-bit_rle_rgbe or 32-bit_rle_xyze"));
                }
            };
        } else if let Some(value) = line.strip_prefix("EXPOSURE=") {
            let [exposure] =
                positive(value).ok_or_else(|| format!("expected a positive number in \"{line}\""))?;
            self.exposure *= exposure;
            self.exposures.push(exposure);
        } else if let Some(value) = line.strip_prefix("COLORCORR=") {
            let factors =
                positive(value).ok_or_else(|| format!("expected three positive numbers in \"{line}\""))?;
            self.exposure *= Rgb::from_array(factors);
        } else if let Some(value) = line.strip_prefix(errors::KEY) {
            self.errors.push(value.to_owned());
        } else if let Some(value) = line.strip_prefix(SOURCE_KEY) {
            self.sources.push(source(value).ok_or_else(|| {
                format!("expected dx dy dz solid_angle_sr R G B visible_fraction in \"{line}\"")
            })?);
        } else {
            if let Some(value) = line.strip_prefix(ASPECT_KEY) {
                self.aspect *=
                    aspect(value).ok_or_else(|| format!("expected a positive number in \"{line}\""))?;
            }
            let mut view = self.view.clone().unwrap_or_default();
            if apply_header_line(&mut view, line) {
                self.view = Some(view);
            }
            // The line of a program that has a view is its history too.
            if !line.starts_with("VIEW=") {
                self.others.push(line.to_string());
            }
        }
        Ok(())
    }
}

fn reals<const N: usize>(text: &str) -> Option<[f64; N]> {
    let values: Option<Vec<f64>> = text.split_whitespace().map(parse_real).collect();
    values?.try_into().ok()
}

fn positive<const N: usize>(text: &str) -> Option<[f64; N]> {
    reals(text).filter(|values| values.iter().all(|&value| value > 0.0))
}

fn source(text: &str) -> Option<ExactSource> {
    let [dx, dy, dz, solid_angle_sr, r, g, b, visible_fraction] = reals(text)?;
    let direction = Vec3::new(dx, dy, dz);
    // A unit vector keeps its very digits.
    let direction = if direction.is_normalized() { direction } else { direction.try_normalize()? };
    let valid = solid_angle_sr > 0.0 && (0.0..=1.0).contains(&visible_fraction);
    valid.then(|| ExactSource { direction, solid_angle_sr, radiance: Rgb::new(r, g, b), visible_fraction })
}

/// The header of a picture in Radiance's units, up to the resolution line.
pub fn text(
    others: &[String],
    view: Option<&View>,
    sources: &[ExactSource],
    block_errors: Option<&BlockErrors>,
) -> String {
    const OURS: [&str; 6] = ["FORMAT=", "EXPOSURE=", "COLORCORR=", "VIEW=", SOURCE_KEY, errors::KEY];
    let mut text = String::from("#?RADIANCE\n");
    // A line with a line end in it is several; an empty one would end the header, "#?" would begin another.
    let lines = others.iter().flat_map(|line| line.lines()).filter(|line| !line.is_empty());
    for line in lines.filter(|line| !line.starts_with("#?") && !OURS.iter().any(|key| line.starts_with(key)))
    {
        text.push_str(line);
        text.push('\n');
    }
    // Writing to a string does not fail.
    if let Some(view) = view {
        let _ = writeln!(text, "VIEW= {view}");
    }
    for source in sources {
        let (d, r) = (source.direction, source.radiance);
        let (solid_angle, visible) = (source.solid_angle_sr, source.visible_fraction);
        let _ = writeln!(
            text,
            "{SOURCE_KEY} {} {} {} {solid_angle} {} {} {} {visible}",
            d.x, d.y, d.z, r.x, r.y, r.z
        );
    }
    for line in block_errors.map(BlockErrors::lines).unwrap_or_default() {
        text.push_str(&line);
        text.push('\n');
    }
    text.push_str("FORMAT=32-bit_rle_rgbe\n\n");
    text
}
