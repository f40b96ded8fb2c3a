//! The statistical error of a picture, block by block, and how it travels in a header.

/// Standard errors of the mean luminance of square blocks of pixels, errors of different blocks being independent.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockErrors {
    /// Pixels along an edge of a block; blocks at the right and at the bottom may be cut.
    pub edge: usize,
    /// Blocks in a row.
    pub columns: usize,
    /// One number a block [cd/m²], top row first.
    pub luminance_cd_m2: Vec<f64>,
}

/// Header line of some blocks: edge, row, first column, two characters a block.
pub(super) const KEY: &str = "SUNPEAK_ERROR=";

/// Blocks on a line: Radiance's programs read lines of up to 2047 bytes.
const BLOCKS_PER_LINE: usize = 800;

/// Characters from '!' to '~' as digits; a pair stands for a number on a logarithmic scale in steps of 0.5 %.
const DIGITS: u32 = 94;
const FIRST_DIGIT: u8 = b'!';
const LEAST_CD_M2: f64 = 1e-9;
const STEP: f64 = 1.005;

impl BlockErrors {
    /// The block of a pixel.
    pub fn block(&self, column: usize, row: usize) -> usize {
        row / self.edge * self.columns + column / self.edge
    }

    /// Indices of the pixels of a block of a picture of that size, row by row.
    pub fn pixels(&self, block: usize, width: usize, height: usize) -> impl Iterator<Item = usize> {
        let (left, top) = (block % self.columns * self.edge, block / self.columns * self.edge);
        let columns = left..(left + self.edge).min(width);
        (top..(top + self.edge).min(height))
            .flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Does it belong to a picture of that size?
    pub fn fits(&self, width: usize, height: usize) -> bool {
        let rows = height.div_ceil(self.edge.max(1));
        self.columns == width.div_ceil(self.edge.max(1)) && self.luminance_cd_m2.len() == self.columns * rows
    }

    /// Header lines.
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (row, values) in self.luminance_cd_m2.chunks(self.columns.max(1)).enumerate() {
            for (part, values) in values.chunks(BLOCKS_PER_LINE).enumerate() {
                let codes: String = values.iter().flat_map(|&value| encode(value)).collect();
                lines.push(format!("{KEY} {} {row} {} {codes}", self.edge, part * BLOCKS_PER_LINE));
            }
        }
        lines
    }

    /// From what stands behind the key in header lines; `None` if they do not make the blocks of a picture of that size.
    pub(super) fn from_lines(lines: &[String], width: usize, height: usize) -> Option<Self> {
        let edge = lines.first()?.split_whitespace().next()?.parse().ok().filter(|&edge| edge > 0)?;
        let mut errors = Self { edge, columns: width.div_ceil(edge), luminance_cd_m2: Vec::new() };
        for line in lines {
            let [line_edge, row, column, codes] = line.split_whitespace().collect::<Vec<_>>()[..] else {
                return None;
            };
            let place =
                row.parse::<usize>().ok()?.checked_mul(errors.columns)?.checked_add(column.parse().ok()?)?;
            if line_edge.parse() != Ok(edge)
                || place != errors.luminance_cd_m2.len()
                || !codes.len().is_multiple_of(2)
            {
                return None;
            }
            let values = codes.as_bytes().chunks_exact(2).map(|pair| decode(pair[0], pair[1]));
            errors.luminance_cd_m2.extend(values.collect::<Option<Vec<_>>>()?);
        }
        errors.fits(width, height).then_some(errors)
    }
}

/// 0 is a code of its own; the largest code stands for all that is larger.
fn encode(value: f64) -> [char; 2] {
    let code =
        if value > 0.0 { 1.0 + ((value / LEAST_CD_M2).ln() / STEP.ln()).round().max(0.0) } else { 0.0 };
    let code = (code as u32).min(DIGITS * DIGITS - 1);
    [code / DIGITS, code % DIGITS].map(|digit| char::from(FIRST_DIGIT + digit as u8))
}

fn decode(high: u8, low: u8) -> Option<f64> {
    let digit = |byte: u8| byte.checked_sub(FIRST_DIGIT).map(u32::from).filter(|&digit| digit < DIGITS);
    let code = digit(high)? * DIGITS + digit(low)?;
    Some(if code == 0 { 0.0 } else { LEAST_CD_M2 * STEP.powf(f64::from(code) - 1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_come_back_to_a_quarter_per_cent() {
        let luminance_cd_m2: Vec<f64> =
            (0..15).map(|i| if i == 3 { 0.0 } else { 10f64.powi(i - 6) * 1.2345 }).collect();
        let errors = BlockErrors { edge: 8, columns: 5, luminance_cd_m2 };
        let lines: Vec<_> =
            errors.lines().iter().map(|line| line.strip_prefix(KEY).expect("its key").to_owned()).collect();
        let back = BlockErrors::from_lines(&lines, 39, 17).expect("a whole set");
        for (a, b) in errors.luminance_cd_m2.iter().zip(&back.luminance_cd_m2) {
            assert!((a - b).abs() <= 2.6e-3 * a, "{a} {b}");
        }
        assert_eq!(BlockErrors::from_lines(&lines, 80, 17), None, "another size");
        assert_eq!(BlockErrors::from_lines(&lines[1..], 39, 17), None, "a row is missing");
        assert_eq!(BlockErrors::from_lines(&["8 0 0 \u{e9}".into()], 8, 8), None);
    }
}
