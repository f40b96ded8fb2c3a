//! Text patterns and mixtures from their arguments (reference manual, "Brighttext", "Colortext", "Mixtext").

use super::{
    Interpreter,
    args::{title, triple},
    patterns::at_least,
};
use crate::field::Places;
use crate::text::{MAX_LINE, Text, TextFrame};
use crate::{Pattern, raw::Primitive};
use std::sync::Arc;
use sunpeak_core::Rgb;

/// Reals of the origin and the two motion vectors.
const FRAME: usize = 9;

/// Lines of a text file.
const MAX_LINES: usize = 10_000;

/// Distances between characters, in characters.
const MAX_SPACING: f64 = 100.0;

impl Interpreter<'_> {
    /// `fontfile textfile`, or `fontfile . words…`; with foreground and background, grey or coloured.
    pub(super) fn text_pattern(&mut self, primitive: &Primitive, channels: usize) -> Result<Pattern, String> {
        let text = self.text(primitive, 0, FRAME + 2 * channels)?;
        let color = |at: usize| match channels {
            1 => Rgb::splat(primitive.reals[at]),
            _ => triple(&primitive.reals, at),
        };
        Ok(Pattern::Text { text, fore: color(FRAME), back: color(FRAME + channels) })
    }

    /// The text of a mixture, whose names of modifiers come first.
    pub(super) fn text_mask(&mut self, primitive: &Primitive) -> Result<Arc<Text>, String> {
        self.text(primitive, 2, FRAME)
    }

    /// The font is string argument `at`; the spacing, if there is one, real argument `spacing`.
    fn text(&mut self, primitive: &Primitive, at: usize, spacing: usize) -> Result<Arc<Text>, String> {
        at_least(primitive, at + 2, "a font file, and a text file or \".\" and words")?;
        let found = primitive.reals.len();
        if found < spacing {
            return Err(format!(
                "wrong number of arguments of {}: expected {spacing} real arguments (origin, right and down vectors{}) and a \
                 spacing if there is one, found {found}",
                title(primitive),
                if spacing > FRAME { ", foreground, background" } else { "" }
            ));
        }
        let places = Places { options: self.options, cwd: &self.cwd, primitive };
        let said = |message: String| format!("{}: {message}", title(primitive));
        let font = self.functions.font(places, &primitive.strings[at]).map_err(said)?;
        let lines = match &primitive.strings[at + 1..] {
            [file] => places.read(file).map_err(|message| said(format!("text file: {message}")))?.1,
            [_, words @ ..] => words.join(" ").into_bytes(),
            [] => Vec::new(),
        };
        let [origin, right, down] = [0, 3, 6].map(|at| triple(&primitive.reals, at));
        let frame = TextFrame { origin, right, down };
        let distance = primitive.reals.get(spacing).copied();
        if distance.is_some_and(|distance| distance.abs() > MAX_SPACING) {
            return Err(said(format!(
                "the spacing is {}, expected about 0.1 to 0.3",
                primitive.reals[spacing]
            )));
        }
        let text = Text::new(lines_of(&lines).map_err(said)?, font, frame, distance);
        text.map(Arc::new).ok_or_else(|| {
            said("the right and down vectors span no plane: expected two that are not parallel".to_string())
        })
    }
}

fn lines_of(text: &[u8]) -> Result<Vec<Vec<u8>>, String> {
    let mut lines: Vec<Vec<u8>> = Vec::new();
    let text = text.strip_suffix(b"\n").unwrap_or(text);
    for line in text.split(|&byte| byte == b'\n') {
        if line.len() > MAX_LINE || lines.len() >= MAX_LINES {
            return Err(format!(
                "line {} of the text: expected at most {MAX_LINES} lines of at most {MAX_LINE} characters",
                lines.len() + 1
            ));
        }
        lines.push(line.to_vec());
    }
    Ok(lines)
}
