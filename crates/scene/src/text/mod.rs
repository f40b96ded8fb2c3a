//! Text on a surface: what `brighttext`, `colortext` and `mixtext` are made of (reference manual, "Brighttext").

mod font;
mod spacing;

pub use font::Font;

use font::BOX;
use spacing::{Line, Spacing};
use std::sync::Arc;
use sunpeak_core::Vec3;

/// The longest line [bytes] (as in Radiance).
pub(crate) const MAX_LINE: usize = 510;

/// Motion vectors that span less than this are no plane, as a share of what they span at a right angle.
const FLATTEST: f64 = 1e-12;

/// Lines of text in a plane, seen from everywhere along its normal.
#[derive(Debug)]
pub struct Text {
    font: Arc<Font>,
    lines: Vec<(Vec<u8>, Line)>,
    origin: Vec3,
    /// What a vector is multiplied with to give its coordinates: units of the box along the line, lines down.
    right: Vec3,
    down: Vec3,
}

/// Where a text stands, in world axes: its upper left corner, from character to character, from line to line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextFrame {
    pub origin: Vec3,
    pub right: Vec3,
    pub down: Vec3,
}

impl Text {
    /// `None` if the motion vectors span no plane.
    pub(crate) fn new(
        lines: Vec<Vec<u8>>,
        font: Arc<Font>,
        frame: TextFrame,
        spacing: Option<f64>,
    ) -> Option<Self> {
        let TextFrame { origin, right, down } = frame;
        // Coordinates in the plane's own, perhaps oblique, axes.
        let (rr, rd, dd) = (right.length_squared(), right.dot(down), down.length_squared());
        let determinant = rr * dd - rd * rd;
        let is_plane = determinant.is_finite() && determinant > FLATTEST * rr * dd && origin.is_finite();
        if !is_plane {
            return None;
        }
        // With a spacing given, a step to the right is a mean character and the distance to the next.
        let step = spacing.map_or(BOX, |spacing| f64::from(font.mean_width) + BOX * spacing.abs());
        let style = Spacing::new(spacing.unwrap_or(0.0));
        let set = |text: Vec<u8>| {
            let line = Line::new(&text, &font, style);
            (text, line)
        };
        Some(Self {
            lines: lines.into_iter().map(set).collect(),
            origin,
            right: (right * dd - down * rd) / determinant * step,
            down: (down * rr - right * rd) / determinant,
            font,
        })
    }

    /// Is there ink at, before or behind this point (world axes)?
    pub fn contains(&self, point: Vec3) -> bool {
        let from_origin = point - self.origin;
        let (x, y) = (from_origin.dot(self.right), from_origin.dot(self.down));
        if !(x >= 0.0 && y >= 0.0 && y < self.lines.len() as f64) {
            return false;
        }
        let (text, line) = &self.lines[y as usize];
        if x >= f64::from(line.width) {
            return false;
        }
        let height = (1.0 - y.fract()) * BOX;
        let mut characters = text.iter().zip(&line.starts);
        characters.any(|(&code, &start)| {
            let x = x - f64::from(start);
            (0.0..BOX).contains(&x) && self.font.glyph(code).is_some_and(|glyph| glyph.contains([x, height]))
        })
    }
}

#[cfg(test)]
mod tests;
