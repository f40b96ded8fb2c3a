//! Radiance pictures in.

use super::{
    BlockErrors, Picture,
    header::{Format, Header},
    orientation::Orientation,
    rgbe, scanline,
};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use sunpeak_core::{Error, LUMINOUS_EFFICACY, Location, Result, Rgb, xyz_to_rgb};

impl Picture {
    /// Read a Radiance picture: RGBE or XYZE, any run-length code, any orientation. The file is read row by row.
    pub fn load(path: &Path) -> Result<Self> {
        Self::open(path, true).map(|(picture, _)| picture)
    }

    /// The same with the values that stand in the file, `EXPOSURE` and `COLORCORR` in them (so Radiance takes pictures as patterns), and
    /// how many times as high as wide its pixels are.
    pub(crate) fn load_stored(path: &Path) -> Result<(Self, f64)> {
        Self::open(path, false)
    }

    fn open(path: &Path, undo_exposure: bool) -> Result<(Self, f64)> {
        let file = File::open(path).map_err(|source| Error::io(path, source))?;
        let length = file.metadata().map_err(|source| Error::io(path, source))?.len();
        let file = BufReader::with_capacity(BUFFER, file);
        Self::read(file, length, &path.to_string_lossy(), undo_exposure)
    }

    /// A picture from the bytes of its file; error messages call it `name`.
    pub fn decode(bytes: &[u8], name: &str) -> Result<Self> {
        Self::read(bytes, bytes.len() as u64, name, true).map(|(picture, _)| picture)
    }

    /// A picture from a file of so many bytes (0 if that is not known).
    fn read(file: impl BufRead, length: u64, name: &str, undo_exposure: bool) -> Result<(Self, f64)> {
        let mut lines = Lines { rest: file, name, line: 0 };
        let header = lines.header()?;
        let orientation = lines.orientation()?;
        let exposure = if undo_exposure { header.exposure } else { Rgb::ONE };
        let convert = |pixel: [u8; 4]| {
            let value = Rgb::from_array(rgbe::decode(pixel)) / exposure;
            let value = match header.format {
                Format::Rgbe => value,
                Format::Xyze => xyz_to_rgb(value) / LUMINOUS_EFFICACY,
            };
            value.as_vec3().to_array()
        };
        let pixels = read_pixels(&mut lines.rest, length, &orientation, convert)
            .map_err(|message| lines.error(message))?;
        let (width, height) = (orientation.width, orientation.height);
        let picture = Self {
            width,
            height,
            pixels: orientation.upright(pixels),
            view: header.view,
            header: header.others,
            exact_sources: header.sources,
            exposures: header.exposures,
            block_errors: BlockErrors::from_lines(&header.errors, width, height),
        };
        Ok((picture, header.aspect))
    }
}

/// Bytes of the file that are in memory at a time.
const BUFFER: usize = 1 << 20;

/// Longer lines of a header are none.
const LONGEST_LINE: u64 = 1 << 20;

/// The lines at the front of the file.
pub(super) struct Lines<'f, R> {
    pub rest: R,
    pub name: &'f str,
    pub line: usize,
}

impl<R: BufRead> Lines<'_, R> {
    /// The next line; `None` if the file ends in it or it is far too long.
    fn next(&mut self) -> Result<Option<String>> {
        let mut bytes = Vec::new();
        let read = self.rest.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes);
        read.map_err(|error| self.error(error.to_string()))?;
        if bytes.pop() != Some(b'\n') {
            return Ok(None);
        }
        self.line += 1;
        Ok(Some(String::from_utf8_lossy(&bytes).trim_end_matches('\r').to_string()))
    }

    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::input(Location::new(self.name, self.line, 0), message)
    }

    fn header(&mut self) -> Result<Header> {
        let mut header = Header::default();
        self.each_header_line(|line| header.add(line))?;
        Ok(header)
    }

    /// Take in the lines up to the empty one.
    pub fn each_header_line(
        &mut self,
        mut add: impl FnMut(&str) -> std::result::Result<(), String>,
    ) -> Result<()> {
        let mut magic = [0; 2];
        let is_picture = self.rest.read_exact(&mut magic).is_ok() && magic == *b"#?";
        if !is_picture || self.next()?.is_none() {
            self.line = 0;
            return Err(self.error("not a Radiance picture: expected \"#?RADIANCE\" at its beginning"));
        }
        loop {
            let line = self
                .next()?
                .ok_or_else(|| self.error("the file ends in its header: expected an empty line"))?;
            if line.is_empty() {
                return Ok(());
            }
            add(&line).map_err(|message| self.error(message))?;
        }
    }

    fn orientation(&mut self) -> Result<Orientation> {
        let line = self.next()?.unwrap_or_default();
        Orientation::parse(&line).ok_or_else(|| {
            self.error(format!("expected the picture's size, such as \"-Y 480 +X 640\", found \"{line}\""))
        })
    }

    /// Width and height of a picture whose rows can have no other order than the usual one.
    pub fn standard_size(&mut self) -> Result<(usize, usize)> {
        let orientation = self.orientation()?;
        if !orientation.is_standard() {
            return Err(self.error("expected rows from the top and columns from the left, -Y and +X"));
        }
        Ok((orientation.width, orientation.height))
    }
}

/// Pixels to a byte in the run-length code: four runs of 127 bytes in two each.
const TIGHTEST: usize = 16;

fn read_pixels(
    file: &mut impl BufRead,
    length: u64,
    orientation: &Orientation,
    convert: impl Fn([u8; 4]) -> [f32; 3],
) -> std::result::Result<Vec<[f32; 3]>, String> {
    let (count, width) = orientation.rows();
    // As much as the file can hold at its tightest, so that pixels need not be moved as they grow.
    let fits = length as usize / (width / TIGHTEST + 1) + 1 >= count;
    let mut pixels = Vec::new();
    let mut row = Vec::new();
    for number in 1..=count {
        let read = scanline::read(file, width, &mut row);
        read.map_err(|message| format!("row {number} of {count}: {message}"))?;
        if number == 1 {
            pixels.reserve_exact(if fits { count * width } else { 0 });
        }
        pixels.extend(row.iter().copied().map(&convert));
    }
    Ok(pixels)
}
