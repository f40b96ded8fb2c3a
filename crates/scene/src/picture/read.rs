//! Radiance pictures in.

use super::{
    BlockErrors, Picture,
    header::{Format, Header},
    orientation::Orientation,
    rgbe, scanline,
};
use crate::files;
use std::path::Path;
use sunpeak_core::{Error, LUMINOUS_EFFICACY, Location, Result, Rgb, xyz_to_rgb};

impl Picture {
    /// Read a Radiance picture: RGBE or XYZE, any run-length code, any orientation.
    pub fn load(path: &Path) -> Result<Self> {
        Self::decode(&files::read(path)?, &path.to_string_lossy())
    }

    /// A picture from the bytes of its file; error messages call it `name`.
    pub fn decode(bytes: &[u8], name: &str) -> Result<Self> {
        let mut lines = Lines { rest: bytes, name, line: 0 };
        let header = lines.header()?;
        let orientation = lines.orientation()?;
        let convert = |pixel: [u8; 4]| {
            let value = Rgb::from_array(rgbe::decode(pixel)) / header.exposure;
            let value = match header.format {
                Format::Rgbe => value,
                Format::Xyze => xyz_to_rgb(value) / LUMINOUS_EFFICACY,
            };
            value.as_vec3().to_array()
        };
        let pixels =
            read_pixels(lines.rest, &orientation, convert).map_err(|message| lines.error(message))?;
        let (width, height) = (orientation.width, orientation.height);
        Ok(Self {
            width,
            height,
            pixels: orientation.upright(pixels),
            view: header.view,
            header: header.others,
            exact_sources: header.sources,
            exposures: header.exposures,
            block_errors: BlockErrors::from_lines(&header.errors, width, height),
        })
    }
}

/// The lines at the front of the file.
struct Lines<'f> {
    rest: &'f [u8],
    name: &'f str,
    line: usize,
}

impl Lines<'_> {
    fn next(&mut self) -> Option<String> {
        let end = self.rest.iter().position(|&byte| byte == b'\n')?;
        let line = String::from_utf8_lossy(&self.rest[..end]).trim_end_matches('\r').to_string();
        self.rest = &self.rest[end + 1..];
        self.line += 1;
        Some(line)
    }

    fn error(&self, message: impl Into<String>) -> Error {
        Error::input(Location::new(self.name, self.line, 0), message)
    }

    fn header(&mut self) -> Result<Header> {
        if !self.rest.starts_with(b"#?") {
            return Err(self.error("not a Radiance picture: expected \"#?RADIANCE\" at its beginning"));
        }
        self.next();
        let mut header = Header::default();
        loop {
            let line = self
                .next()
                .ok_or_else(|| self.error("the file ends in its header: expected an empty line"))?;
            if line.is_empty() {
                return Ok(header);
            }
            header.add(&line).map_err(|message| self.error(message))?;
        }
    }

    fn orientation(&mut self) -> Result<Orientation> {
        let line = self.next().unwrap_or_default();
        Orientation::parse(&line).ok_or_else(|| {
            self.error(format!("expected the picture's size, such as \"-Y 480 +X 640\", found \"{line}\""))
        })
    }
}

/// Pixels to a byte in the run-length code: four runs of 127 bytes in two each.
const TIGHTEST: usize = 16;

fn read_pixels(
    mut bytes: &[u8],
    orientation: &Orientation,
    convert: impl Fn([u8; 4]) -> [f32; 3],
) -> std::result::Result<Vec<[f32; 3]>, String> {
    let (count, length) = orientation.rows();
    let mut pixels = Vec::new();
    for row in 1..=count {
        let read = scanline::read(&mut bytes, length);
        let read = read.map_err(|message| format!("row {row} of {count}: {message}"))?;
        if row == 1 {
            // As much as the rest of the file can hold at its tightest, so that pixels need not be moved as they grow.
            let fits = bytes.len() / (length / TIGHTEST + 1) + 1 >= count;
            pixels.reserve_exact(if fits { count * length } else { 0 });
        }
        pixels.extend(read.into_iter().map(&convert));
    }
    Ok(pixels)
}
