//! Hyperspectral pictures in: more than three components a pixel with a common exponent, as Radiance's `rpict -co+` and `rcomb` write them.
//!
//! The header says how many components (`NCOMP=`) and from where to where they reach (the first and last of `WAVELENGTH_SPLITS=`); each
//! is as wide as the others. Pixels are not run-length coded.

use super::{read::Lines, rgbe};
use crate::raw::parse_real;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use sunpeak_core::{Error, Result};

const FORMAT: &str = "Radiance_spectra";

/// With fewer it is no spectrum but a colour (in Radiance likewise).
const LEAST_COMPONENTS: usize = 4;

/// More are refused (Radiance: 24).
const MOST_COMPONENTS: usize = 1024;

/// A picture of spectra.
#[derive(Clone, Debug)]
pub struct SpectralPicture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Height over width of a pixel.
    pub aspect: f64,
    /// Where the first component begins and the last one ends [nm].
    pub range_nm: [f64; 2],
    /// Numbers to a pixel.
    pub components: usize,
    /// Top row first, pixel by pixel.
    pub values: Vec<f32>,
}

impl SpectralPicture {
    /// Read a file.
    ///
    /// # Errors
    /// Where the file is no hyperspectral picture, and what was expected.
    pub fn load(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|source| Error::io(path, source))?;
        Self::read(BufReader::new(file), &path.to_string_lossy())
    }

    /// The same from the bytes of a file; error messages call it `name`.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn decode(bytes: &[u8], name: &str) -> Result<Self> {
        Self::read(bytes, name)
    }

    fn read(file: impl BufRead, name: &str) -> Result<Self> {
        let mut lines = Lines { rest: file, name, line: 0 };
        let mut header = Header { aspect: 1.0, ..Header::default() };
        lines.each_header_line(|line| header.add(line))?;
        let (components, range_nm) = header.spectrum().map_err(|message| lines.error(message))?;
        let (width, height) = lines.standard_size()?;
        let mut values = Vec::new();
        let mut row = Vec::new();
        let bytes = (width as u64).saturating_mul(components as u64 + 1);
        for number in 1..=height {
            row.clear();
            // No more than there is in the file.
            let read = lines.rest.by_ref().take(bytes).read_to_end(&mut row);
            if read.map_err(|error| lines.error(error.to_string()))? as u64 != bytes {
                return Err(lines.error(format!("row {number} of {height}: the file ends too early")));
            }
            for pixel in row.chunks_exact(components + 1) {
                let (mantissas, exponent) = (&pixel[..components], pixel[components]);
                values.extend(mantissas.iter().map(|&mantissa| rgbe::component(mantissa, exponent) as f32));
            }
        }
        Ok(Self { width, height, aspect: header.aspect, range_nm, components, values })
    }
}

/// What the header says.
#[derive(Default)]
struct Header {
    format: String,
    components: usize,
    splits_nm: Vec<f64>,
    aspect: f64,
}

impl Header {
    fn add(&mut self, line: &str) -> std::result::Result<(), String> {
        if let Some(value) = line.strip_prefix("FORMAT=") {
            self.format = value.trim().to_owned();
        } else if let Some(value) = line.strip_prefix("NCOMP=") {
            self.components = value.trim().parse().map_err(|_| format!("expected a number in \"{line}\""))?;
        } else if let Some(value) = line.strip_prefix("WAVELENGTH_SPLITS=") {
            self.splits_nm = value.split_whitespace().map_while(parse_real).collect();
        } else if let Some(value) = line.strip_prefix(super::header::ASPECT_KEY) {
            self.aspect *= super::header::aspect(value)
                .ok_or_else(|| format!("expected a positive number in \"{line}\""))?;
        }
        Ok(())
    }

    /// Number of components and the range of wavelengths [nm].
    fn spectrum(&self) -> std::result::Result<(usize, [f64; 2]), String> {
        if self.format != FORMAT {
            return Err(format!("not a hyperspectral picture: expected FORMAT={FORMAT} in its header"));
        }
        if !(LEAST_COMPONENTS..=MOST_COMPONENTS).contains(&self.components) {
            let found = self.components;
            return Err(format!("expected NCOMP={LEAST_COMPONENTS} to {MOST_COMPONENTS}, found {found}"));
        }
        match self.splits_nm[..] {
            [first, _, _, last] if first != last && first >= 1.0 && last >= 1.0 => {
                Ok((self.components, [first, last]))
            }
            _ => {
                Err("expected four wavelengths [nm] in WAVELENGTH_SPLITS=, the first and last different"
                    .into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str =
        "#?RADIANCE\nNCOMP=4\nWAVELENGTH_SPLITS= 780 588 480 380\nFORMAT=Radiance_spectra\n\n";

    fn read(header: &str, size: &str, pixels: &[u8]) -> Result<SpectralPicture> {
        SpectralPicture::decode(&[header.as_bytes(), size.as_bytes(), pixels].concat(), "s.hsr")
    }

    #[test]
    fn components_share_an_exponent() {
        let picture = read(HEADER, "-Y 1 +X 2\n", &[0, 127, 255, 1, 128, 9, 9, 9, 9, 0]).expect("a picture");
        assert_eq!((picture.width, picture.height, picture.components), (2, 1, 4));
        assert_eq!(picture.range_nm, [780.0, 380.0]);
        let expected = [0.5, 127.5, 255.5, 1.5].map(|mantissa| mantissa / 256.0);
        assert_eq!(picture.values, [&expected[..], &[0.0; 4]].concat());
    }

    #[test]
    fn says_what_is_wrong() {
        let without = |line: &str| HEADER.replace(line, "");
        for (header, size, expected) in [
            (HEADER.into(), "-Y 1 +X 2\n", "row 1 of 1: the file ends too early"),
            (HEADER.into(), "-Y 1 +X 99999999999999\n", "the file ends too early"),
            (HEADER.into(), "+Y 1 +X 2\n", "expected rows from the top and columns from the left"),
            (HEADER.replace("=4", "=3"), "-Y 1 +X 1\n", "expected NCOMP=4 to 1024, found 3"),
            (without("FORMAT=Radiance_spectra\n"), "-Y 1 +X 1\n", "not a hyperspectral picture"),
            (without("WAVELENGTH_SPLITS= 780 588 480 380\n"), "-Y 1 +X 1\n", "expected four wavelengths"),
            ("P6\n".into(), "", "not a Radiance picture"),
        ] {
            let message = read(&header, size, &[1, 2, 3, 4, 5]).expect_err(&header).to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
