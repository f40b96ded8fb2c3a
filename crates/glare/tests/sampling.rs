//! Do the intervals of sampling hold what they say? Pictures with known noise, drawn many times.
#![allow(clippy::unwrap_used)] // a helper that fails fails the test

use sunpeak_core::{LUMINOUS_EFFICACY, Sampler, Vec3};
use sunpeak_glare::{GlareOptions, GlareReport, evaluate};
use sunpeak_scene::{BlockErrors, Camera, Picture, View};

const SIZE: usize = 64;
const EDGE: usize = 4;

/// Samples of a pixel.
const SAMPLES: usize = 64;

/// Points along an edge of a pixel in which the scene is looked at.
const POINTS: usize = 8;

const DRAWS: usize = 80;

fn view() -> View {
    View::parse("-vta -vp 0 0 0 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180").unwrap()
}

fn towards(right_deg: f64, up_deg: f64) -> Vec3 {
    let (right, up) = (right_deg.to_radians(), up_deg.to_radians());
    Vec3::new(right.sin() * up.cos(), right.cos() * up.cos(), up.sin())
}

/// What there is to see in a grid of points of each pixel [cd/m²].
struct Scene(Vec<[f64; POINTS * POINTS]>);

impl Scene {
    fn new(luminance: impl Fn(Vec3) -> f64) -> Self {
        let camera = Camera::new(&view()).unwrap();
        let point = |pixel: usize, point: usize| {
            let place = |pixel: usize, point: usize| pixel as f64 + (point as f64 + 0.5) / POINTS as f64;
            let x = place(pixel % SIZE, point % POINTS) / SIZE as f64;
            let y = 1.0 - place(pixel / SIZE, point / POINTS) / SIZE as f64;
            camera.ray(x, y).map_or(0.0, |ray| luminance(ray.direction))
        };
        Self((0..SIZE * SIZE).map(|pixel| std::array::from_fn(|i| point(pixel, i))).collect())
    }

    /// Standard errors of the blocks of a picture drawn from it.
    fn errors(&self) -> BlockErrors {
        let columns = SIZE / EDGE;
        let mut variances = vec![0.0; columns * columns];
        for (pixel, points) in self.0.iter().enumerate() {
            let mean = points.iter().sum::<f64>() / points.len() as f64;
            let variance =
                points.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / points.len() as f64;
            variances[pixel / SIZE / EDGE * columns + pixel % SIZE / EDGE] += variance / SAMPLES as f64;
        }
        let error = |variance: f64| variance.sqrt() / (EDGE * EDGE) as f64;
        let luminance_cd_m2 = variances.into_iter().map(error).collect();
        BlockErrors { edge: EDGE, columns, luminance_cd_m2 }
    }

    /// Pixels are means of some points each.
    fn draw(&self, random: &mut Sampler) -> Vec<[f32; 3]> {
        let mut pixel = |points: &[f64; POINTS * POINTS]| {
            if points.iter().all(|value| *value == points[0]) {
                return [(points[0] / LUMINOUS_EFFICACY) as f32; 3];
            }
            let mut one = || points[(random.next_1d() * points.len() as f64) as usize];
            let mean = (0..SAMPLES).map(|_| one()).sum::<f64>() / SAMPLES as f64;
            [(mean / LUMINOUS_EFFICACY) as f32; 3]
        };
        self.0.iter().map(&mut pixel).collect()
    }

    /// Reports of many pictures.
    fn reports(&self, random: &mut Sampler) -> Vec<GlareReport> {
        let empty =
            Picture { view: Some(view()), block_errors: Some(self.errors()), ..Picture::new(SIZE, SIZE) };
        let mut one = |_| {
            evaluate(&Picture { pixels: self.draw(random), ..empty.clone() }, &GlareOptions::default())
                .unwrap()
        };
        (0..DRAWS).map(&mut one).collect()
    }
}

type Rating = fn(&GlareReport) -> f64;

/// Of the pictures of many scenes, for DGP and Ev: the stated variance over the true one, and the share of 95 % intervals that hold the mean
/// of the pictures.
fn stated_over_true(scenes: impl Iterator<Item = Scene>) -> [(&'static str, f64, f64); 2] {
    let mut random = Sampler::new(7, 0, 0);
    let reports: Vec<Vec<GlareReport>> = scenes.map(|scene| scene.reports(&mut random)).collect();
    let ratings: [(_, Rating); 2] = [("dgp", |report| report.dgp), ("ev_lux", |report| report.ev_lux)];
    ratings.map(|(name, rating)| {
        let (mut of_stated, mut of_true, mut held) = (0.0, 0.0, 0);
        for reports in &reports {
            let n = reports.len() as f64;
            let mean = reports.iter().map(rating).sum::<f64>() / n;
            for report in reports {
                let intervals = report.sampling.as_ref().unwrap();
                let &(_, [low, high]) = intervals.iter().find(|(key, _)| *key == name).unwrap();
                of_true += (rating(report) - mean).powi(2) * n / (n - 1.0);
                of_stated += ((high - low) / 2.0 / 1.96).powi(2);
                held += usize::from((low..=high).contains(&mean));
            }
        }
        let all: usize = reports.iter().map(Vec::len).sum();
        (name, of_stated / of_true, held as f64 / all as f64)
    })
}

/// Of so many pictures the ratio of variances is known to 7 %.
fn assert_honest(scenes: impl Iterator<Item = Scene>) {
    for (rating, ratio, held) in stated_over_true(scenes) {
        assert!((0.87..1.15).contains(&ratio), "{rating}: {ratio}");
        assert!((0.92..0.98).contains(&held), "{rating}: {held}");
    }
}

/// Bright discs with hard rims, here and there.
fn discs(luminance: impl Fn(f64) -> f64 + Copy) -> impl Iterator<Item = Scene> {
    (0..6).map(move |i| {
        let at = f64::from(i);
        let centre = towards(-25.0 + 9.3 * at, 30.0 - 4.7 * at);
        Scene::new(|direction| luminance(direction.angle_between(centre).to_degrees()))
    })
}

/// Pixels at the rim have all the noise, and some of them are about as bright as what counts as glare: the size of the source varies with
/// its light.
#[test]
fn discs_with_hard_rims() {
    assert_honest(discs(|angle| if angle < 8.1 { 11_000.0 } else { 100.0 }));
}

/// The same for what is split off from a bright surround.
#[test]
fn bright_discs_in_others() {
    assert_honest(discs(|angle| match angle {
        _ if angle < 7.3 => 150_000.0,
        _ if angle < 13.9 => 9000.0,
        _ => 100.0,
    }));
}
