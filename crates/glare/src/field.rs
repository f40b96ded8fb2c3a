//! The picture as an eye sees it: luminance, solid angle and direction of each pixel in front.

use std::collections::BTreeMap;
use std::ops::Range;
use sunpeak_core::{Error, Result, Rgb, Vec3, luminance_cd_m2};
use sunpeak_scene::{Camera, Picture, View, ViewKind};

/// One pixel in front of the eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FieldPixel {
    /// Its index in the picture.
    pub index: usize,
    /// Unit vector to its centre.
    pub direction: Vec3,
    /// Solid angle [sr].
    pub solid_angle_sr: f64,
    /// Luminance [cd/m²].
    pub luminance_cd_m2: f64,
    /// Cosine of the angle to the line of sight, its mean over the pixel: the weight in the vertical illuminance.
    pub cosine: f64,
}

/// Pixels whose centre is nearer to the rim of the hemisphere than this many pixels get the mean cosine of a grid of points:
/// in `-vth` it is far from that of the centre.
const RIM_PIXELS: f64 = 4.0;

/// Points in a row of that grid.
const RIM_POINTS: usize = 8;

impl FieldPixel {
    /// Is it near the rim of the hemisphere?
    pub fn is_at_rim(&self) -> bool {
        self.cosine < RIM_PIXELS * self.solid_angle_sr.sqrt()
    }

    /// Illuminance at the eye [lx].
    pub fn illuminance_lux(&self) -> f64 {
        self.luminance_cd_m2 * self.solid_angle_sr * self.cosine
    }
}

/// A picture with a usable view. Nothing is copied: pixels are worked out when they are asked for.
pub(crate) struct Field<'a> {
    pub view: &'a View,
    pub picture: &'a Picture,
    camera: Camera,
    /// Line of sight, unit.
    pub sight: Vec3,
    pub width: usize,
    pub height: usize,
    /// Luminances that differ from the picture's, by index: those from which a sun was taken out.
    pub changed: BTreeMap<usize, f64>,
}

impl<'a> Field<'a> {
    /// Fails if the picture has no view that an eye could have, or not as many pixels as it says.
    pub fn new(picture: &'a Picture) -> Result<Self> {
        let view = usable_view(picture)?;
        let (width, height) = (picture.width, picture.height);
        if width == 0 || height == 0 || picture.pixels.len() != width * height {
            let found = picture.pixels.len();
            return Err(Error::value(format!("glare: a picture of {width} x {height} pixels holds {found}")));
        }
        let sight = view
            .direction
            .try_normalize()
            .ok_or_else(|| Error::value("glare: the view's direction (-vd) has no length"))?;
        let camera = Camera::new(view).ok_or_else(|| {
            Error::value("glare: the view's up vector (-vu) is parallel to its direction (-vd)")
        })?;
        Ok(Self { view, picture, camera, sight, width, height, changed: BTreeMap::new() })
    }

    /// Does its centre lie in front of the eye?
    pub fn is_ahead(&self, index: usize) -> bool {
        let (column, row) = (index % self.width, index / self.width);
        self.camera.pixel_ahead(column, row, self.width, self.height).is_some()
    }

    /// The pixel, if its centre lies in front of the eye.
    pub fn pixel(&self, index: usize) -> Option<FieldPixel> {
        self.with_luminance(index, self.luminance(index))
    }

    /// The pixel with a luminance that is known already.
    pub fn with_luminance(&self, index: usize, luminance_cd_m2: f64) -> Option<FieldPixel> {
        let (column, row) = (index % self.width, index / self.width);
        let pixel = self.camera.pixel_ahead(column, row, self.width, self.height)?;
        let (direction, solid_angle_sr) = (pixel.direction, pixel.solid_angle_sr);
        let centre_cosine = direction.dot(self.sight);
        if solid_angle_sr <= 0.0 || centre_cosine <= 0.0 {
            return None;
        }
        let cosine = if centre_cosine < RIM_PIXELS * solid_angle_sr.sqrt() {
            self.mean_cosine(column, row, solid_angle_sr).unwrap_or(centre_cosine)
        } else {
            centre_cosine
        };
        Some(FieldPixel { index, direction, solid_angle_sr, luminance_cd_m2, cosine })
    }

    /// Mean cosine over the solid angle of a pixel: that of a grid of points, weighted with the density of solid angle there; `None` for
    /// views other than fisheyes.
    fn mean_cosine(&self, column: usize, row: usize, solid_angle_sr: f64) -> Option<f64> {
        let step = 1.0 / RIM_POINTS as f64;
        let place = |start: usize, i: usize| start as f64 + (i as f64 + 0.5) * step;
        let mut projected = 0.0;
        let mut seen = false;
        for i in 0..RIM_POINTS {
            for j in 0..RIM_POINTS {
                let [x, y] = self.picture_point(place(column, i), place(row, j));
                if let Some(point) = self.camera.density(x, y) {
                    projected += point.solid_angle_sr * point.direction.dot(self.sight).max(0.0);
                    seen = true;
                }
            }
        }
        let area = step * step / (self.width * self.height) as f64;
        seen.then(|| projected * area / solid_angle_sr)
    }

    /// Direction of a place in pixels from the top left.
    pub fn towards(&self, column: f64, row: f64) -> Option<Vec3> {
        let [x, y] = self.picture_point(column, row);
        self.camera.ray(x, y).map(|ray| ray.direction)
    }

    /// A place in pixels from the top left, as the picture point of a view.
    fn picture_point(&self, column: f64, row: f64) -> [f64; 2] {
        [column / self.width as f64, 1.0 - row / self.height as f64]
    }

    /// Luminance of a pixel [cd/m²] without the suns that were taken out.
    pub fn luminance(&self, index: usize) -> f64 {
        self.changed.get(&index).copied().unwrap_or_else(|| luminance_of(self.picture.pixels[index]))
    }

    /// Luminances [cd/m²] of the pixels in a range.
    pub fn luminances(&self, range: Range<usize>) -> impl Iterator<Item = (usize, f64)> {
        let mut changed = self.changed.range(range.clone()).peekable();
        range.map(move |index| match changed.next_if(|&(&at, _)| at == index) {
            Some((_, &luminance)) => (index, luminance),
            None => (index, luminance_of(self.picture.pixels[index])),
        })
    }

    /// The message on a pixel that holds what light does not.
    pub fn bad_pixel(&self, index: usize) -> Error {
        let (column, row) = (index % self.width, index / self.width);
        let [r, g, b] = self.picture.pixels[index];
        Error::value(format!(
            "glare: the picture's pixel in column {column}, row {row} (from 0, top left) is {r} {g} {b}; expected radiances of 0 or more"
        ))
    }
}

fn usable_view(picture: &Picture) -> Result<&View> {
    let Some(view) = &picture.view else {
        return Err(Error::value(
            "glare: the picture's header has no VIEW= line (or it was cropped or rotated since); expected a fisheye view such as \
             -vta -vh 180 -vv 180",
        ));
    };
    view.check()?;
    if view.kind == ViewKind::Parallel {
        return Err(Error::value(
            "glare: a parallel view (-vtl) has no eye; expected a fisheye view (-vta or -vth)",
        ));
    }
    Ok(view)
}

fn luminance_of(value: [f32; 3]) -> f64 {
    luminance_cd_m2(Rgb::from(value.map(f64::from)))
}

#[cfg(test)]
pub(crate) mod testing {
    use super::*;
    use sunpeak_core::LUMINOUS_EFFICACY;

    /// A square fisheye picture with luminances [cd/m²] by column and row.
    pub(crate) fn picture(size: usize, luminance: impl Fn(usize, usize) -> f64) -> Picture {
        let view = View::parse("-vta -vp 0 0 0 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180").expect("a view");
        let value = |index: usize| [(luminance(index % size, index / size) / LUMINOUS_EFFICACY) as f32; 3];
        Picture {
            pixels: (0..size * size).map(value).collect(),
            view: Some(view),
            ..Picture::new(size, size)
        }
    }
}
