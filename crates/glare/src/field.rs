//! The picture as an eye sees it: luminance, solid angle and direction of each pixel in front.

use std::f64::consts::PI;
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
    /// Illuminance at the eye [lx].
    pub fn illuminance_lux(&self) -> f64 {
        self.luminance_cd_m2 * self.solid_angle_sr * self.cosine
    }
}

/// All pixels in front of the eye, in picture order.
#[derive(Debug)]
pub(crate) struct Field<'a> {
    pub view: &'a View,
    /// Line of sight, unit.
    pub sight: Vec3,
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<FieldPixel>,
}

impl<'a> Field<'a> {
    /// Fails if the picture has no view, or values that no light has.
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
        let mut field = Self { view, sight, width, height, pixels: Vec::new() };
        for (index, &value) in picture.pixels.iter().enumerate() {
            if let Some(mut pixel) = field.geometry(&camera, index) {
                pixel.luminance_cd_m2 = luminance_of(value).map_err(|what| field.bad_pixel(index, &what))?;
                field.pixels.push(pixel);
            }
        }
        if field.pixels.is_empty() {
            return Err(Error::value("glare: no pixel of the picture lies in front of its view"));
        }
        Ok(field)
    }

    /// The pixel, still black, if its centre lies in front of the eye.
    fn geometry(&self, camera: &Camera, index: usize) -> Option<FieldPixel> {
        let (column, row) = (index % self.width, index / self.width);
        let [x, y] = self.picture_point(column as f64 + 0.5, row as f64 + 0.5);
        let direction = camera.ray(x, y)?.direction;
        let solid_angle_sr = camera.pixel_solid_angle(column, row, self.width, self.height);
        let centre_cosine = direction.dot(self.sight);
        if solid_angle_sr <= 0.0 || centre_cosine <= 0.0 {
            return None;
        }
        let cosine = if centre_cosine < RIM_PIXELS * solid_angle_sr.sqrt() {
            self.mean_cosine(camera, column, row).unwrap_or(centre_cosine)
        } else {
            centre_cosine
        };
        Some(FieldPixel { index, direction, solid_angle_sr, luminance_cd_m2: 0.0, cosine })
    }

    /// Mean cosine over the solid angle of a pixel.
    fn mean_cosine(&self, camera: &Camera, column: usize, row: usize) -> Option<f64> {
        let (mut sum, mut weight) = (0.0, 0.0);
        let step = 1.0 / RIM_POINTS as f64;
        for i in 0..RIM_POINTS {
            for j in 0..RIM_POINTS {
                let (left, top) = (column as f64 + i as f64 * step, row as f64 + j as f64 * step);
                let [x0, y1] = self.picture_point(left, top);
                let [x1, y0] = self.picture_point(left + step, top + step);
                if let Some(ray) = camera.ray((x0 + x1) / 2.0, (y0 + y1) / 2.0) {
                    let solid_angle = camera.solid_angle([x0, x1], [y0, y1]);
                    sum += solid_angle * ray.direction.dot(self.sight).max(0.0);
                    weight += solid_angle;
                }
            }
        }
        (weight > 0.0).then(|| sum / weight)
    }

    /// A place in pixels from the top left, as the picture point of a view.
    fn picture_point(&self, column: f64, row: f64) -> [f64; 2] {
        [column / self.width as f64, 1.0 - row / self.height as f64]
    }

    fn bad_pixel(&self, index: usize, what: &str) -> Error {
        let (column, row) = (index % self.width, index / self.width);
        Error::value(format!(
            "glare: the picture's pixel in column {column}, row {row} (from 0, top left) is {what}; expected radiances of 0 or more"
        ))
    }

    /// Vertical illuminance at the eye [lx].
    pub fn illuminance_lux(&self) -> f64 {
        self.pixels.iter().map(FieldPixel::illuminance_lux).sum()
    }

    /// Share of the hemisphere in front, weighted as for illuminance, that the picture covers.
    pub fn coverage(&self) -> f64 {
        self.pixels.iter().map(|p| p.solid_angle_sr * p.cosine).sum::<f64>() / PI
    }

    /// Mean luminance [cd/m²] over the solid angle of the pixels that are chosen; `None` if there are none.
    pub fn mean_luminance(&self, chosen: impl Fn(&FieldPixel) -> bool) -> Option<f64> {
        let (mut sum, mut weight) = (0.0, 0.0);
        for pixel in self.pixels.iter().filter(|&pixel| chosen(pixel)) {
            sum += pixel.luminance_cd_m2 * pixel.solid_angle_sr;
            weight += pixel.solid_angle_sr;
        }
        (weight > 0.0).then(|| sum / weight)
    }

    /// The brightest pixel's luminance [cd/m²].
    pub fn max_luminance(&self) -> f64 {
        self.pixels.iter().map(|pixel| pixel.luminance_cd_m2).fold(0.0, f64::max)
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

fn luminance_of(value: [f32; 3]) -> std::result::Result<f64, String> {
    let rgb = Rgb::from(value.map(f64::from));
    let luminance = luminance_cd_m2(rgb);
    if !rgb.is_finite() || luminance < 0.0 {
        return Err(format!("{} {} {}", value[0], value[1], value[2]));
    }
    Ok(luminance)
}
