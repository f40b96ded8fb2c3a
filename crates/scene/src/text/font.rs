//! Font files (reference manual, "Text fonts"): for each character its code, a number of vertices, and the vertices of a polygon in a
//! box of 256 by 256, x to the right and y up. `#` starts a comment.

use sunpeak_core::{Error, Location, Result};

/// The largest coordinate; characters are this wide and high.
pub(super) const BOX: f64 = 255.0;

/// All boxes of characters hold the middle, as in Radiance.
const MIDDLE: i32 = 128;

/// Vertices of one character at most (as in Radiance).
const MAX_VERTICES: i64 = 32000;

/// Characters as polygons.
#[derive(Debug)]
pub struct Font {
    glyphs: Vec<Option<Glyph>>,
    /// Mean width of the characters that have an area.
    pub(super) mean_width: i32,
}

/// One character.
#[derive(Debug)]
pub(super) struct Glyph {
    vertices: Vec<[u8; 2]>,
    pub left: i32,
    pub right: i32,
    bottom: i32,
    top: i32,
}

impl Font {
    /// Read a font; `file` is its name in messages.
    ///
    /// # Errors
    /// Where something else than the numbers of a font stands: file, line and what was expected.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self> {
        let mut words = Words { words: words(bytes), file };
        let mut glyphs: Vec<Option<Glyph>> = (0..256).map(|_| None).collect();
        while let Some((code, line)) = words.next("the code of a character, 1 to 255", 1, 255)? {
            let missing = |what: &str| {
                Error::input(
                    Location::new(file, line, 1),
                    format!("the font ends within character {code}: expected {what}"),
                )
            };
            let (count, _) = words
                .next("a number of vertices, 0 to 32000", 0, MAX_VERTICES)?
                .ok_or_else(|| missing("a number of vertices"))?;
            let mut vertices = Vec::new();
            for _ in 0..count {
                let mut vertex = [0; 2];
                for coordinate in &mut vertex {
                    let (value, _) = words
                        .next("a coordinate, 0 to 255", 0, 255)?
                        .ok_or_else(|| missing("two coordinates for each vertex"))?;
                    *coordinate = value as u8;
                }
                vertices.push(vertex);
            }
            let glyph = &mut glyphs[code as usize];
            if glyph.is_some() {
                let message = format!("character {code} is in the font twice");
                return Err(Error::input(Location::new(file, line, 1), message));
            }
            *glyph = Some(Glyph::new(vertices));
        }
        let widths: Vec<i32> = glyphs.iter().flatten().filter_map(Glyph::width).collect();
        let mean_width = widths.iter().sum::<i32>() / (widths.len() as i32).max(1);
        Ok(Self { glyphs, mean_width })
    }

    pub(super) fn glyph(&self, code: u8) -> Option<&Glyph> {
        self.glyphs[usize::from(code)].as_ref()
    }
}

impl Glyph {
    fn new(vertices: Vec<[u8; 2]>) -> Self {
        let axis = |i: usize| vertices.iter().map(move |v| i32::from(v[i])).chain([MIDDLE]);
        let (left, bottom) = (axis(0).min().unwrap_or(MIDDLE), axis(1).min().unwrap_or(MIDDLE));
        let (right, top) = (axis(0).max().unwrap_or(MIDDLE), axis(1).max().unwrap_or(MIDDLE));
        Self { left, right, bottom, top, vertices }
    }

    /// `None` if it has no area.
    fn width(&self) -> Option<i32> {
        (self.right > self.left && self.top > self.bottom).then_some(self.right - self.left)
    }

    pub fn is_space(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Is the point inside the polygon, by the number of edges to its right?
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let in_box = |v: f64, low: i32, high: i32| f64::from(low) <= v && v <= f64::from(high);
        if !in_box(x, self.left, self.right) || !in_box(y, self.bottom, self.top) {
            return false;
        }
        let edges = self.vertices.iter().zip(self.vertices.iter().cycle().skip(1));
        let crosses = |(a, b): &(&[u8; 2], &[u8; 2])| {
            let [[ax, ay], [bx, by]] = [a, b].map(|v| v.map(f64::from));
            (ay > y) != (by > y) && ax + (y - ay) / (by - ay) * (bx - ax) > x
        };
        edges.filter(crosses).count() % 2 == 1
    }
}

/// Numbers of a font file with their lines.
struct Words<'a, I> {
    words: I,
    file: &'a str,
}

impl<'b, I: Iterator<Item = (&'b [u8], usize)>> Words<'_, I> {
    /// The next whole number and its line; `None` at the end of the file.
    fn next(&mut self, what: &str, least: i64, most: i64) -> Result<Option<(i64, usize)>> {
        let Some((word, line)) = self.words.next() else { return Ok(None) };
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        match number.filter(|number| (least..=most).contains(number)) {
            Some(number) => Ok(Some((number, line))),
            None => {
                let word: String = String::from_utf8_lossy(word).chars().take(20).collect();
                let message = format!("expected {what}, found \"{word}\"");
                Err(Error::input(Location::new(self.file, line, 1), message))
            }
        }
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = (&[u8], usize)> {
    bytes.split(|&byte| byte == b'\n').zip(1..).flat_map(|(line, number)| {
        let content = line.split(|&byte| byte == b'#').next().unwrap_or_default();
        let words = content.split(|byte| byte.is_ascii_whitespace() || *byte == b',');
        words.filter(|word| !word.is_empty()).map(move |word| (word, number))
    })
}
