//! Pictures.

use crate::exact_sun::ExactSuns;
use crate::integrator::{Integrator, Limits};
use crate::passes::{Means, Reports, estimate};
use crate::shapes::Ray;
use crate::{RenderOptions, World};
use sunpeak_core::{Control, Error, Result, Rgb, Sampler};
use sunpeak_scene::{Camera, ExactSource, Picture, View, disc_coverage};

/// Render a picture of `width` by `height` pixels; each pixel is the mean over its area (a box filter).
///
/// Suns that the eye sees along straight or flatly mirrored chains are put in exactly: see the crate's front page.
///
/// # Errors
/// A view or size that makes no picture, options out of their domain, or an interruption by `control`.
pub fn render_picture(
    world: &World,
    view: &View,
    width: usize,
    height: usize,
    options: &RenderOptions,
    control: &Control,
) -> Result<Picture> {
    view.check()?;
    if width == 0 || height == 0 {
        return Err(Error::value(format!("a picture of {width} by {height} pixels has none")));
    }
    let Some(camera) = Camera::new(view) else { return Err(Error::value("the view has no direction")) };
    let exact_suns = options.exact_suns.then(|| ExactSuns::find(world, view, width, height, options.seed));
    let film = Film { camera, width, height, seed: options.seed };
    let integrator = Integrator { world, limits: Limits::of(options), exact_suns: exact_suns.as_ref() };
    let reports = Reports { control, rays: &world.rays };
    let means = estimate(
        width * height,
        options,
        reports,
        |pixel| film.block(pixel),
        |pixel, s| film.sample(&integrator, pixel, s),
    )?;
    let mut picture = Picture {
        width,
        height,
        header: vec![software(), settings(world, options, &means)],
        pixels: means.values.iter().map(|v| v.as_vec3().to_array()).collect(),
        view: Some(view.clone()),
        exact_sources: exact_suns.map_or_else(Vec::new, ExactSuns::into_sources),
    };
    for source in picture.exact_sources.clone() {
        add(&mut picture, view, &source);
    }
    Ok(picture)
}

/// The pixels and how rays go through them.
struct Film {
    camera: Camera,
    width: usize,
    height: usize,
    seed: u64,
}

/// Edge of the blocks of pixels whose error counts [pixels].
const BLOCK: usize = 8;

impl Film {
    fn block(&self, pixel: usize) -> u32 {
        let (column, row) = (pixel % self.width, pixel / self.width);
        (row / BLOCK * self.width.div_ceil(BLOCK) + column / BLOCK) as u32
    }

    fn sample(&self, integrator: &Integrator, pixel: usize, index: u64) -> Rgb {
        let mut sampler = Sampler::new(self.seed, pixel as u64, index);
        let [u, v] = sampler.next_2d();
        let (column, row) = (pixel % self.width, pixel / self.width);
        let x = (column as f64 + u) / self.width as f64;
        let y = 1.0 - (row as f64 + v) / self.height as f64;
        let Some(ray) = self.camera.ray(x, y) else { return Rgb::ZERO };
        let start = Ray::new(ray.origin, ray.direction);
        integrator.radiance(start, ray.max_distance, &mut sampler)
    }
}

/// The source's share of each pixel.
fn add(picture: &mut Picture, view: &View, source: &ExactSource) {
    let shares = disc_coverage(view, picture.width, picture.height, source.direction, source.solid_angle_sr);
    for (pixel, share) in shares {
        let light = source.radiance * (source.visible_fraction * share);
        for (channel, value) in picture.pixels[pixel].iter_mut().zip(light.to_array()) {
            *channel += value as f32;
        }
    }
}

fn software() -> String {
    format!("SOFTWARE= Sunpeak {}", env!("CARGO_PKG_VERSION"))
}

/// What the picture was made with, on one header line.
fn settings(world: &World, options: &RenderOptions, means: &Means) -> String {
    let bounces = options.max_bounces.map_or(String::new(), |n| format!(" max_bounces={n}"));
    let peak = format!("{:?}", world.peak_rule()).to_lowercase();
    let error = means.error.map_or(String::new(), |e| format!(" error={e:.5}"));
    format!("SUNPEAK_RENDER= peak={peak} samples={} seed={}{bounces}{error}", means.samples, options.seed)
}
