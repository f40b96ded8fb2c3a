//! Data files: numbers on a grid of any number of dimensions (reference manual, "Data files").
//!
//! The file has the number of dimensions; for each `begin end count`, or `0 0 count` (begin equal to end) and the coordinates; then
//! the values, the last dimension varying fastest. `#` begins a comment.

use super::MAX_DIMENSIONS;
use crate::Picture;
use crate::picture::SpectralPicture;
use crate::raw::{parse_integer, parse_real};
use sunpeak_core::{Error, Location, Result};

/// More values than this are refused.
const MAX_VALUES: usize = 100_000_000;

/// Where the values of one dimension stand.
#[derive(Clone, Debug)]
enum Axis {
    Even {
        begin: f64,
        end: f64,
        count: usize,
    },
    /// Rising or falling.
    Uneven(Vec<f64>),
}

/// Values on a grid.
#[derive(Clone, Debug)]
pub struct DataArray {
    axes: Vec<Axis>,
    values: Vec<f64>,
}

impl Axis {
    fn count(&self) -> usize {
        match self {
            Self::Even { count, .. } => *count,
            Self::Uneven(points) => points.len(),
        }
    }

    /// The cell in which `x` lies, or the one nearest to it, and the place in units of the cells.
    fn place(&self, x: f64) -> (usize, f64) {
        match self {
            Self::Even { begin, end, count } => {
                let place = (x - begin) / (end - begin) * (count - 1) as f64;
                ((place.max(0.0) as usize).min(count - 2), place)
            }
            Self::Uneven(points) => {
                let rises = points[points.len() - 1] > points[0];
                let passed = points.partition_point(|&p| if rises { p <= x } else { p > x });
                let cell = passed.saturating_sub(1).min(points.len() - 2);
                (cell, cell as f64 + (x - points[cell]) / (points[cell + 1] - points[cell]))
            }
        }
    }

    /// Shares of the two values around: linear, also up to one cell outside, and farther out falling to nothing with one over the
    /// distance.
    fn shares(&self, x: f64) -> (usize, [f64; 2]) {
        let (cell, place) = self.place(x);
        let offset = place - cell as f64;
        let shares = if offset > 2.0 {
            let low = -1.0 / (offset + 1.0);
            [low, -2.0 * low]
        } else if offset < -1.0 {
            let high = 1.0 / offset;
            [-2.0 * high, high]
        } else {
            [1.0 - offset, offset]
        };
        (cell, shares)
    }
}

impl DataArray {
    /// Read a data file's text.
    ///
    /// # Errors
    /// Where in the file something else was expected.
    pub fn parse(text: &[u8], file: &str) -> Result<Self> {
        let mut words = Words { text, at: 0, file };
        let dimensions = words.count("the number of dimensions")?;
        if dimensions == 0 || dimensions > MAX_DIMENSIONS {
            return Err(words.error(format!("{dimensions} dimensions: expected 1 to {MAX_DIMENSIONS}")));
        }
        let mut axes = Vec::with_capacity(dimensions);
        for _ in 0..dimensions {
            axes.push(words.axis()?);
        }
        let total = axes.iter().try_fold(1usize, |total, axis| total.checked_mul(axis.count()));
        let Some(total) = total.filter(|total| *total <= MAX_VALUES) else {
            return Err(words.error(format!("more than {MAX_VALUES} values")));
        };
        // The text has at least two characters for each value.
        let mut values = Vec::with_capacity(total.min(text.len()));
        while values.len() < total {
            let what = format!("value {} of {total}", values.len() + 1);
            values.push(words.real(&what)?);
        }
        Ok(Self { axes, values })
    }

    /// The three channels of a picture, over y and x from its lower left corner, the shorter side 1 (reference manual,
    /// "colorpict"); its pixels are `aspect` times as high as wide.
    pub(crate) fn of_picture(picture: &Picture, aspect: f64) -> Option<[Self; 3]> {
        let (width, height) = (picture.width, picture.height);
        if width < 2 || height < 2 {
            return None;
        }
        let axes = picture_axes(width, height, aspect).to_vec();
        Some([0, 1, 2].map(|channel| {
            let rows = picture.pixels.chunks_exact(width).rev();
            let values = rows.flatten().map(|pixel| f64::from(pixel[channel])).collect();
            Self { axes: axes.clone(), values }
        }))
    }

    /// A picture of spectra, over y and x from its lower left corner as [`Self::of_picture`], and wavelength.
    pub(crate) fn of_spectral_picture(picture: &SpectralPicture) -> Option<Self> {
        let (width, height) = (picture.width, picture.height);
        if width < 2 || height < 2 {
            return None;
        }
        let [y, x] = picture_axes(width, height, picture.aspect);
        let [first, last] = picture.range_nm;
        // Values belong to the middles of the components.
        let half = 0.5 * (last - first) / picture.components as f64;
        let nm = Axis::Even { begin: first + half, end: last - half, count: picture.components };
        let rows = picture.values.chunks_exact(width * picture.components).rev();
        Some(Self { axes: vec![y, x, nm], values: rows.flatten().copied().map(f64::from).collect() })
    }

    /// Number of dimensions.
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    /// The last dimension's coordinates.
    pub fn last_coordinates(&self) -> Vec<f64> {
        match &self.axes[self.axes.len() - 1] {
            Axis::Even { begin, end, count } => {
                let step = (end - begin) / (count - 1) as f64;
                (0..*count).map(|i| begin + step * i as f64).collect()
            }
            Axis::Uneven(points) => points.clone(),
        }
    }

    /// The value at a point, linear in every dimension between the grid's points; `point` has a coordinate for each dimension.
    pub fn interpolate(&self, point: &[f64]) -> f64 {
        self.part(&self.axes, 0, point)
    }

    fn part(&self, axes: &[Axis], start: usize, point: &[f64]) -> f64 {
        let Some((axis, rest)) = axes.split_first() else { return self.values[start] };
        let stride: usize = rest.iter().map(Axis::count).product();
        let (cell, [low, high]) = axis.shares(point[0]);
        let at = |cell: usize, share: f64| match share {
            0.0 => 0.0,
            share => share * self.part(rest, start + cell * stride, &point[1..]),
        };
        at(cell, low) + at(cell + 1, high)
    }
}

/// The axes y and x of a picture whose pixels are `aspect` times as high as wide; the shorter side is 1.
fn picture_axes(width: usize, height: usize, aspect: f64) -> [Axis; 2] {
    let shape = aspect * height as f64 / width as f64;
    let (up, across) = if shape >= 1.0 { (shape, 1.0) } else { (1.0, 1.0 / shape) };
    [Axis::Even { begin: 0.0, end: up, count: height }, Axis::Even { begin: 0.0, end: across, count: width }]
}

/// Words of a data file.
struct Words<'t> {
    text: &'t [u8],
    at: usize,
    file: &'t str,
}

impl<'t> Words<'t> {
    fn next(&mut self) -> Option<&'t str> {
        loop {
            while self.text.get(self.at).is_some_and(|c| c.is_ascii_whitespace() || *c == b',') {
                self.at += 1;
            }
            if self.text.get(self.at) != Some(&b'#') {
                break;
            }
            while self.text.get(self.at).is_some_and(|c| *c != b'\n') {
                self.at += 1;
            }
        }
        let start = self.at;
        while self.text.get(self.at).is_some_and(|c| !c.is_ascii_whitespace() && !matches!(c, b',' | b'#')) {
            self.at += 1;
        }
        let word = std::str::from_utf8(&self.text[start..self.at]).unwrap_or("?");
        (start < self.at).then_some(word)
    }

    fn error(&self, message: String) -> Error {
        Error::input(Location::of_offset(self.file, self.text, self.at.saturating_sub(1)), message)
    }

    fn value<T>(&mut self, what: &str, convert: impl Fn(&str) -> Option<T>) -> Result<T> {
        let word = self.next();
        word.and_then(convert).ok_or_else(|| {
            let found = word.map_or("the end of the file".to_string(), |word| format!("\"{word}\""));
            self.error(format!("expected {what}, found {found}"))
        })
    }

    fn real(&mut self, what: &str) -> Result<f64> {
        self.value(what, parse_real)
    }

    fn count(&mut self, what: &str) -> Result<usize> {
        self.value(what, |word| parse_integer(word).and_then(|n| usize::try_from(n).ok()))
    }

    fn axis(&mut self) -> Result<Axis> {
        let begin = self.real("where a dimension begins")?;
        let end = self.real("where the dimension ends")?;
        let count = self.count("the number of points of the dimension")?;
        if count < 2 {
            return Err(self.error(format!("a dimension of {count} points: expected 2 or more")));
        }
        if begin != end {
            return Ok(Axis::Even { begin, end, count });
        }
        let mut points = Vec::new();
        while points.len() < count {
            points.push(self.real("a coordinate of the unevenly spaced dimension")?);
        }
        let rises = points.windows(2).all(|pair| pair[0] < pair[1]);
        let falls = points.windows(2).all(|pair| pair[0] > pair[1]);
        if rises || falls {
            return Ok(Axis::Uneven(points));
        }
        Err(self.error("the coordinates of a dimension neither rise nor fall throughout".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(text: &str) -> DataArray {
        DataArray::parse(text.as_bytes(), "t.dat").expect("a data file")
    }

    #[test]
    fn between_points_it_is_linear_in_each_dimension() {
        // 1 + 2 x + 10 y + 3 x y is reproduced exactly, also on an uneven grid, and backwards.
        let f = |x: f64, y: f64| 1.0 + 2.0 * x + 10.0 * y + 3.0 * x * y;
        let mut text = String::from("# head\n2 # two\n0 0 3 0 1 4\n2 -1 4\n");
        for x in [0.0, 1.0, 4.0] {
            for y in [2.0, 1.0, 0.0, -1.0] {
                text += &format!("{}, ", f(x, y));
            }
        }
        let data = array(&text);
        for (x, y) in [(0.3, 0.4), (3.9, -0.9), (1.0, 2.0), (4.0, 1.5), (0.0, -1.0)] {
            assert!((data.interpolate(&[x, y]) - f(x, y)).abs() < 1e-12, "{x} {y}");
        }
        // One cell outside it goes on.
        assert!((data.interpolate(&[0.5, 2.5]) - f(0.5, 2.5)).abs() < 1e-12);
    }

    #[test]
    fn far_outside_it_falls_to_nothing() {
        let data = array("1 0 1 2 3 5");
        assert_eq!(data.interpolate(&[2.0]), 7.0);
        assert!((data.interpolate(&[-1.0]) - 1.0).abs() < 1e-12);
        // Radiance: at 11 cells the shares are -1/12 and 2/12 of the last two values, at -10 cells 2/10 and -1/10.
        assert!((data.interpolate(&[-10.0]) - (0.2 * 3.0 - 0.1 * 5.0)).abs() < 1e-12);
        assert!((data.interpolate(&[11.0]) - (-3.0 / 12.0 + 10.0 / 12.0)).abs() < 1e-12);
    }

    #[test]
    fn says_what_is_wrong() {
        for (text, expected) in [
            ("", "t.dat:1:1: expected the number of dimensions, found the end"),
            ("0", "0 dimensions: expected 1 to 8"),
            ("1\n0 1 1", "t.dat:2:5: a dimension of 1 points"),
            ("1\n0 1 3\n1 2", "expected value 3 of 3, found the end of the file"),
            ("1\n0 1 2\n1 x", "t.dat:3:3: expected value 2 of 2, found \"x\""),
            ("1 0 0 3 1 2 1", "neither rise nor fall"),
            ("3 0 1 100000 0 1 100000 0 1 100000 1", "more than"),
        ] {
            let message = DataArray::parse(text.as_bytes(), "t.dat").expect_err(text).to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
