//! The resolution line: the size of a picture, and the order of its pixels.

/// How pixels follow each other in a file: the first axis is that of rows, the second runs along a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// Does a row run along x?
    rows_along_x: bool,
    /// Does x fall?
    x_falls: bool,
    /// Does y fall (as in `-Y`, the top first)?
    y_falls: bool,
    pub width: usize,
    pub height: usize,
}

impl Orientation {
    /// From a line such as `-Y 480 +X 640`.
    pub fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [first, first_size, second, second_size] = words.as_slice() else { return None };
        let axis = |word: &str| match word {
            "+X" => Some((true, false)),
            "-X" => Some((true, true)),
            "+Y" => Some((false, false)),
            "-Y" => Some((false, true)),
            _ => None,
        };
        let ((first_is_x, first_falls), (second_is_x, second_falls)) = (axis(first)?, axis(second)?);
        let size = |word: &str| word.parse::<usize>().ok().filter(|&n| n > 0);
        let (first_size, second_size) = (size(first_size)?, size(second_size)?);
        if first_is_x == second_is_x {
            return None;
        }
        Some(if second_is_x {
            let (height, width) = (first_size, second_size);
            Self { rows_along_x: true, x_falls: second_falls, y_falls: first_falls, width, height }
        } else {
            let (width, height) = (first_size, second_size);
            Self { rows_along_x: false, x_falls: first_falls, y_falls: second_falls, width, height }
        })
    }

    /// Is it `-Y +X`: rows from the top, columns from the left?
    pub fn is_standard(&self) -> bool {
        self.rows_along_x && self.y_falls && !self.x_falls
    }

    /// Number of rows in the file and pixels in each.
    pub fn rows(&self) -> (usize, usize) {
        if self.rows_along_x { (self.height, self.width) } else { (self.width, self.height) }
    }

    /// Pixels in the file's order to the top row first, left to right. Nothing is copied where they stand so already.
    pub fn upright<T: Copy>(&self, pixels: Vec<T>) -> Vec<T> {
        if self.is_standard() {
            return pixels;
        }
        let (_, length) = self.rows();
        let mut result = Vec::with_capacity(pixels.len());
        for y in 0..self.height {
            // Rows from the top: y falls in the result.
            let y = if self.y_falls { y } else { self.height - 1 - y };
            for x in 0..self.width {
                let x = if self.x_falls { self.width - 1 - x } else { x };
                let (row, place) = if self.rows_along_x { (y, x) } else { (x, y) };
                result.push(pixels[row * length + place]);
            }
        }
        result
    }
}
