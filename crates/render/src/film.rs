//! Pictures.

use crate::exact_sun::ExactSuns;
use crate::integrator::{Integrator, Limits};
use crate::passes::{Draw, Means, estimate_until};
use crate::shapes::Ray;
use crate::stopping::Groups;
use crate::{RenderOptions, World};
use sunpeak_core::{Control, Error, LUMINOUS_EFFICACY, Result, Rgb};
use sunpeak_scene::{BlockErrors, Camera, ExactSource, Picture, View, disc_coverage};

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
    render_until(world, view, (width, height), options, control, None)
}

/// Says whether a picture is good enough.
pub type PictureJudge<'a> = &'a dyn Fn(&Picture) -> Result<bool>;

/// The same, until a judge is content with the picture so far: it is asked after each pass from which errors can be told.
///
/// # Errors
/// As [`render_picture`], and those of the judge.
pub fn render_until(
    world: &World,
    view: &View,
    (width, height): (usize, usize),
    options: &RenderOptions,
    control: &Control,
    judge: Option<PictureJudge>,
) -> Result<Picture> {
    view.check()?;
    if width == 0 || height == 0 {
        return Err(Error::value(format!("a picture of {width} by {height} pixels has none")));
    }
    let Some(camera) = Camera::new(view) else { return Err(Error::value("the view has no direction")) };
    let exact_suns = options.exact_suns.then(|| ExactSuns::find(world, view, width, height, options.seed));
    let edge = block_edge(&camera, width, height);
    let film = Film { camera, width, height, edge, seed: options.seed };
    let integrator = Integrator { world, limits: Limits::of(options), exact_suns: exact_suns.as_ref() };
    let sources = exact_suns.as_ref().map_or_else(Vec::new, ExactSuns::sources);
    let picture = |means: &Means| film.picture(world, view, options, means, &sources);
    let is_enough = |judge: PictureJudge, means: &Means| match means.group_errors {
        Some(_) => judge(&picture(means)),
        None => Ok(false),
    };
    let judge_means = judge.map(|judge| move |means: &Means| is_enough(judge, means));
    let means = estimate_until(
        width * height,
        options,
        control,
        film.blocks(),
        |pixel, draw| film.sample(&integrator, pixel, draw),
        judge_means.as_ref().map(|judge| judge as _),
    )?;
    world.check_expressions()?;
    Ok(picture(&means))
}

/// The pixels and how rays go through them.
struct Film {
    camera: Camera,
    width: usize,
    height: usize,
    /// Edge of the blocks of pixels whose error counts [pixels]: a power of two.
    edge: usize,
    seed: u64,
}

/// Width of the blocks whose error counts, about [deg], and its limits [pixels].
const BLOCK_DEG: f64 = 3.0;
const BLOCK_PIXELS: (usize, usize) = (4, 32);

/// Edge of the blocks of a view without angles [pixels].
const BLOCK_OF_PARALLEL_VIEW: usize = 8;

/// Pixels along an edge of a block that is about [`BLOCK_DEG`] wide in the middle of the picture.
fn block_edge(camera: &Camera, width: usize, height: usize) -> usize {
    let (w, h) = (width as f64, height as f64);
    let direction = |x: f64, y: f64| camera.ray(0.5 + x / w, 0.5 + y / h).map(|ray| ray.direction);
    let step = |x: f64, y: f64| Some(direction(-x, -y)?.angle_between(direction(x, y)?));
    let Some(angle) = step(0.5, 0.0).zip(step(0.0, 0.5)).map(|(x, y)| x.max(y)) else {
        return BLOCK_OF_PARALLEL_VIEW;
    };
    if angle <= 0.0 {
        return BLOCK_OF_PARALLEL_VIEW;
    }
    let (least, most) = BLOCK_PIXELS;
    let edge = (BLOCK_DEG.to_radians() / angle).clamp(least as f64, most as f64);
    1 << edge.log2().round() as u32
}

impl Film {
    fn block(&self, pixel: usize) -> u32 {
        let (column, row) = (pixel % self.width, pixel / self.width);
        (row / self.edge * self.columns() + column / self.edge) as u32
    }

    /// Blocks in a row.
    fn columns(&self) -> usize {
        self.width.div_ceil(self.edge)
    }

    fn blocks(&self) -> Groups {
        let blocks = (0..self.width * self.height).map(|pixel| self.block(pixel)).collect();
        Groups::grid(blocks, self.columns())
    }

    /// The picture that means make, exact sources put in.
    fn picture(
        &self,
        world: &World,
        view: &View,
        options: &RenderOptions,
        means: &Means,
        sources: &[ExactSource],
    ) -> Picture {
        let block_errors = means.group_errors.as_ref().map(|errors| BlockErrors {
            edge: self.edge,
            columns: self.columns(),
            luminance_cd_m2: errors.iter().map(|error| LUMINOUS_EFFICACY * error).collect(),
        });
        let mut picture = Picture {
            width: self.width,
            height: self.height,
            header: vec![software(), settings(world, options, means)],
            pixels: self.without_negative(&means.values).iter().map(|v| v.as_vec3().to_array()).collect(),
            view: Some(view.clone()),
            exact_sources: sources.to_vec(),
            block_errors,
            ..Picture::new(0, 0)
        };
        for source in sources {
            add(&mut picture, view, source);
        }
        picture
    }

    /// Differences from a far field can leave a dark pixel below zero. It becomes zero, and the others of its block give what it
    /// lacks, so that the block's mean stays what it is.
    fn without_negative(&self, values: &[Rgb]) -> Vec<Rgb> {
        if values.iter().all(|value| value.min_element() >= 0.0) {
            return values.to_vec();
        }
        let blocks = self.columns() * self.height.div_ceil(self.edge);
        let mut sums = vec![(Rgb::ZERO, Rgb::ZERO); blocks];
        for (pixel, value) in values.iter().enumerate() {
            let (above, below) = &mut sums[self.block(pixel) as usize];
            *above += value.max(Rgb::ZERO);
            *below -= value.min(Rgb::ZERO);
        }
        let kept = |(above, below): (Rgb, Rgb)| {
            ((above - below) / above.max(Rgb::splat(f64::MIN_POSITIVE))).clamp(Rgb::ZERO, Rgb::ONE)
        };
        let shares: Vec<Rgb> = sums.into_iter().map(kept).collect();
        let share = |pixel: usize| shares[self.block(pixel) as usize];
        values.iter().enumerate().map(|(pixel, value)| value.max(Rgb::ZERO) * share(pixel)).collect()
    }

    fn sample(&self, integrator: &Integrator, pixel: usize, draw: Draw) -> Rgb {
        let (column, row) = (pixel % self.width, pixel / self.width);
        let place = z_order(column % self.edge, row % self.edge);
        let mut sampler = draw.together(self.seed, u64::from(self.block(pixel)), place);
        let [u, v] = sampler.next_2d();
        let x = (column as f64 + u) / self.width as f64;
        let y = 1.0 - (row as f64 + v) / self.height as f64;
        let Some(ray) = self.camera.ray(x, y) else { return Rgb::ZERO };
        let start = Ray::new(ray.origin, ray.direction);
        integrator.radiance(start, ray.max_distance, &mut sampler)
    }
}

/// Place along the curve that goes through a square so that what is near on the curve is near in the square.
fn z_order(column: usize, row: usize) -> u64 {
    let bit = |k: u32| ((column >> k & 1) << (2 * k) | (row >> k & 1) << (2 * k + 1)) as u64;
    (0..=BLOCK_PIXELS.1.ilog2()).map(bit).sum()
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
