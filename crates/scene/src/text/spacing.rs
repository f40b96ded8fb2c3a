//! Where the characters of a line stand (reference manual, "Brighttext"), in units of which a character's box has 255.
//!
//! All numbers are whole, with the same roundings as in Radiance, so that a text looks the same.

use super::font::{Font, Glyph};

/// As many spaces as this after a character are an indent: what follows starts in its own column.
const INDENT: usize = 3;

/// How a line is set: by the distance between characters, in units of the box.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spacing {
    /// Each character in a box of its own.
    Uniform,
    /// This distance, with columns kept.
    Columns(i32),
    /// This distance.
    Tight(i32),
}

impl Spacing {
    /// From the argument: 0 is uniform, a positive number keeps columns, a negative one is tight.
    pub fn new(argument: f64) -> Self {
        match (argument * super::font::BOX) as i32 {
            0 => Self::Uniform,
            distance if distance > 0 => Self::Columns(distance),
            distance => Self::Tight(-distance),
        }
    }
}

/// A line: where each character's box begins, and how wide it is altogether.
#[derive(Debug)]
pub(super) struct Line {
    pub starts: Vec<i32>,
    pub width: i32,
}

impl Line {
    pub fn new(text: &[u8], font: &Font, spacing: Spacing) -> Self {
        let glyphs: Vec<Option<&Glyph>> = text.iter().map(|&code| font.glyph(code)).collect();
        let (steps, width) = match spacing {
            Spacing::Uniform => uniform(&glyphs),
            Spacing::Tight(distance) => {
                let steps = tight(&glyphs, font, distance);
                let width = steps.iter().sum();
                (steps, width)
            }
            Spacing::Columns(distance) => columns(&glyphs, font, distance),
        };
        let mut at = 0;
        let place = |step: &i32| {
            at += step;
            at
        };
        Self { starts: steps.iter().take(glyphs.len()).map(place).collect(), width }
    }
}

/// One step more than there are characters: before each, and behind the last.
fn uniform(glyphs: &[Option<&Glyph>]) -> (Vec<i32>, i32) {
    let advance = |glyph: &Option<&Glyph>| if glyph.is_some() { 255 } else { 0 };
    let steps: Vec<i32> = std::iter::once(0).chain(glyphs.iter().map(advance)).collect();
    let width = steps.iter().sum();
    (steps, width)
}

/// The same distance between the extents of neighbours; spaces have the mean width, unknown characters none.
fn tight(glyphs: &[Option<&Glyph>], font: &Font, distance: i32) -> Vec<i32> {
    let half = distance / 2;
    let mut steps = Vec::with_capacity(glyphs.len() + 1);
    let mut step = 0;
    let mut is_first = true;
    for glyph in glyphs {
        if glyph.is_some() && std::mem::take(&mut is_first) {
            step = half;
        }
        match glyph {
            None => steps.push(std::mem::take(&mut step)),
            Some(space) if space.is_space() => steps.push(std::mem::replace(&mut step, font.mean_width)),
            Some(glyph) => steps.push(std::mem::replace(&mut step, glyph.right + half) + half - glyph.left),
        }
    }
    steps.push(step + half);
    steps
}

/// Tight, then each stretch up to the next indent is drawn out evenly to as many mean widths as it has characters.
fn columns(glyphs: &[Option<&Glyph>], font: &Font, distance: i32) -> (Vec<i32>, i32) {
    let mut steps = tight(glyphs, font, distance);
    let mut width = steps[0];
    let mut start = 0;
    while start < glyphs.len() {
        let (end, characters) = stretch(glyphs, start);
        let target = characters as i32 * (font.mean_width + distance);
        width += target;
        let inside = &mut steps[start + 1..=end];
        let mut missing = target - inside.iter().sum::<i32>();
        for (done, step) in inside.iter_mut().enumerate() {
            let share = missing / (end - start - done) as i32;
            *step += share;
            missing -= share;
        }
        start = end;
    }
    (steps, width)
}

/// Where a stretch ends, and how many known characters it has.
fn stretch(glyphs: &[Option<&Glyph>], start: usize) -> (usize, usize) {
    let is_space = |glyph: &&Option<&Glyph>| glyph.is_some_and(Glyph::is_space);
    let (mut at, mut characters) = (start, 0);
    while at < glyphs.len() {
        let mut step = 1;
        if glyphs[at].is_some() {
            step += glyphs[at + 1..].iter().take_while(is_space).count();
            characters += step;
        }
        at += step;
        if step > INDENT {
            break;
        }
    }
    (at, characters)
}
