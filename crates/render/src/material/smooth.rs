//! The smooth part of a material at one point: what shadow rays are weighted with and directions are sampled from.

use super::function::FunctionLobes;
use super::{ashikhmin::AshikhminLobes, table::TableLobes, volume::Phase, ward::WardLobes, ward::WgmdLobes};
use std::f64::consts::FRAC_1_PI;
use sunpeak_core::{Frame, Rgb, Sampler, Vec3, warp};

/// A bidirectional value, apart for diffuse and other lobes: only diffuse scattering counts as a bounce.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SmoothValue {
    /// Of Lambertian lobes.
    pub diffuse: Rgb,
    /// Of all others.
    pub glossy: Rgb,
}

impl SmoothValue {
    pub fn total(&self) -> Rgb {
        self.diffuse + self.glossy
    }

    pub fn scaled(&self, by: f64) -> Self {
        Self { diffuse: self.diffuse * by, glossy: self.glossy * by }
    }
}

/// A direction drawn from the smooth lobes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SmoothSample {
    /// Unit vector, world axes.
    pub direction: Vec3,
    /// Value times cosine over density.
    pub weight: SmoothValue,
    /// Density [1/sr].
    pub pdf: f64,
    /// What light sources that are met in this direction are multiplied with; see [`Smooth::toward_source`].
    pub source_factor: f64,
}

/// The smooth lobes at a point.
#[derive(Debug)]
pub(crate) enum Smooth<'w> {
    /// There are none.
    None,
    /// A receiver for irradiance: scatters all it gets with value 1, at its front.
    Sensor(Frame),
    /// Diffuse and Gaussian lobes.
    Ward(WardLobes<'w>),
    /// Such lobes, each in a frame of its own.
    Wgmd(Box<WgmdLobes>),
    /// Ashikhmin's and Shirley's lobes.
    Ashikhmin(AshikhminLobes),
    /// A table and diffuse lobes.
    Table(TableLobes<'w>),
    /// A function and diffuse lobes.
    Function(Box<FunctionLobes<'w>>),
    /// Air that scatters; there is no surface, and no cosine.
    Phase(Phase),
}

/// What smooth lobes are asked for at a vertex of a path; directions are unit vectors in world axes, away from the surface.
pub(crate) trait Lobes {
    /// Are they those of [`WardMaterial::plain`](super::WardMaterial::plain), so that there is nothing else at the vertex?
    const ARE_PLAIN: bool;

    /// Value [1/sr] towards a direction.
    fn evaluate(&self, direction: Vec3) -> SmoothValue {
        self.evaluate_with_pdf(direction).0
    }

    /// Density [1/sr] of [`Self::draw`].
    fn pdf(&self, direction: Vec3) -> f64 {
        self.evaluate_with_pdf(direction).1
    }

    /// Value and density in one.
    fn evaluate_with_pdf(&self, direction: Vec3) -> (SmoothValue, f64);

    /// As `evaluate`, towards a light source of this solid angle [sr]. Some materials treat light sources apart, as Radiance does.
    fn toward_source(&self, direction: Vec3, solid_angle: f64) -> SmoothValue;

    /// What light sources that a path meets in this direction are multiplied with; see [`Self::toward_source`].
    fn source_factor(&self, direction: Vec3) -> f64;

    /// May sampled directions find light sources? Not where `toward_source` is a rule of its own.
    fn samples_find_sources(&self) -> bool;

    /// The normal of the side on which all that is scattered stays; `None` if that is not known.
    fn one_sided(&self) -> Option<Vec3>;

    /// Cosine to a surface's normal, by which light counts.
    fn cosine(&self, direction: Vec3, normal: Vec3) -> f64;

    /// How far from the surface light in this direction starts: the other side of what a table with thickness stands for.
    fn offset(&self, direction: Vec3) -> Vec3;

    /// The direction of [`Self::draw`] by a number that chooses the lobe and a point of the square; it may have no weight.
    fn sample_direction(&self, choice: f64, u: [f64; 2], sampler: &mut Sampler) -> Option<Vec3>;

    /// Draw a direction; `None` if the draw fell where nothing is scattered.
    fn draw(&self, sampler: &mut Sampler) -> Option<SmoothSample>;
}

impl Smooth<'_> {
    /// Luminous share of the incident light that these lobes scatter, roughly; zero where they do nothing.
    pub fn albedo(&self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Sensor(_) => 1.0,
            Self::Ward(lobes) => lobes.albedo(),
            Self::Wgmd(lobes) => lobes.albedo(),
            Self::Ashikhmin(lobes) => lobes.albedo(),
            Self::Table(lobes) => lobes.albedo(),
            Self::Function(lobes) => lobes.albedo(),
            Self::Phase(_) => 1.0,
        }
    }

    /// Are directions best drawn with a guide's help? Not where a table knows better.
    pub fn can_be_guided(&self) -> bool {
        matches!(
            self,
            Self::Sensor(_) | Self::Ward(_) | Self::Wgmd(_) | Self::Ashikhmin(_) | Self::Function(_)
        )
    }

    /// Draw a direction by a number that chooses the lobe and a point of the square; `None` if the draw fell where nothing is
    /// scattered.
    pub fn sample(&self, choice: f64, u: [f64; 2], sampler: &mut Sampler) -> Option<SmoothSample> {
        match self {
            Self::None => None,
            Self::Sensor(frame) => {
                let local = warp::cosine_hemisphere(u);
                let weight = SmoothValue { diffuse: Rgb::splat(std::f64::consts::PI), glossy: Rgb::ZERO };
                let pdf = local.z * FRAC_1_PI;
                let direction = frame.to_world(local);
                (pdf > 0.0).then_some(SmoothSample { direction, weight, pdf, source_factor: 1.0 })
            }
            Self::Ward(lobes) => lobes.sample(choice, u),
            Self::Wgmd(lobes) => lobes.sample(choice, u),
            Self::Ashikhmin(lobes) => lobes.sample(choice, u),
            Self::Table(lobes) => lobes.sample(choice, u, sampler.next_1d()),
            Self::Function(lobes) => lobes.sample(choice, u),
            Self::Phase(phase) => Some(phase.sample(choice, u)),
        }
    }
}

impl Lobes for Smooth<'_> {
    const ARE_PLAIN: bool = false;

    fn evaluate(&self, direction: Vec3) -> SmoothValue {
        match self {
            Self::None => SmoothValue::default(),
            Self::Sensor(frame) => {
                let front = if direction.dot(frame.z) > 0.0 { Rgb::ONE } else { Rgb::ZERO };
                SmoothValue { diffuse: front, glossy: Rgb::ZERO }
            }
            Self::Ward(lobes) => lobes.evaluate(direction),
            Self::Wgmd(lobes) => lobes.evaluate(direction),
            Self::Ashikhmin(lobes) => lobes.evaluate(direction),
            Self::Table(lobes) => lobes.evaluate(direction),
            Self::Function(lobes) => lobes.evaluate(direction),
            Self::Phase(phase) => SmoothValue { diffuse: phase.evaluate(direction), glossy: Rgb::ZERO },
        }
    }

    fn one_sided(&self) -> Option<Vec3> {
        match self {
            Self::Sensor(frame) => Some(frame.z),
            Self::Ward(lobes) => lobes.one_sided(),
            _ => None,
        }
    }

    fn cosine(&self, direction: Vec3, normal: Vec3) -> f64 {
        match self {
            Self::Phase(_) => 1.0,
            _ => direction.dot(normal).abs(),
        }
    }

    fn offset(&self, direction: Vec3) -> Vec3 {
        match self {
            Self::Table(lobes) => lobes.offset(direction),
            _ => Vec3::ZERO,
        }
    }

    fn toward_source(&self, direction: Vec3, solid_angle: f64) -> SmoothValue {
        match self {
            Self::Ward(lobes) => lobes.toward_source(direction, solid_angle),
            Self::Wgmd(lobes) => lobes.toward_source(direction),
            Self::Table(lobes) => lobes.toward_source(direction, solid_angle),
            Self::Function(lobes) => lobes.toward_source(direction, solid_angle),
            _ => self.evaluate(direction),
        }
    }

    fn source_factor(&self, direction: Vec3) -> f64 {
        match self {
            Self::Ward(lobes) => lobes.source_factor(direction),
            Self::Wgmd(lobes) => lobes.source_factor(direction),
            Self::Table(lobes) if lobes.has_source_rule() => 0.0,
            Self::Function(_) => 0.0,
            _ => 1.0,
        }
    }

    fn samples_find_sources(&self) -> bool {
        match self {
            Self::Table(lobes) => !lobes.has_source_rule(),
            Self::Wgmd(lobes) => lobes.samples_find_sources(),
            Self::Function(_) => false,
            _ => true,
        }
    }

    fn pdf(&self, direction: Vec3) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Sensor(frame) => direction.dot(frame.z).max(0.0) * FRAC_1_PI,
            Self::Ward(lobes) => lobes.pdf(direction),
            Self::Wgmd(lobes) => lobes.pdf(direction),
            Self::Ashikhmin(lobes) => lobes.pdf(direction),
            Self::Table(lobes) => lobes.pdf(direction),
            Self::Function(lobes) => lobes.pdf(direction),
            Self::Phase(phase) => phase.pdf(direction),
        }
    }

    fn evaluate_with_pdf(&self, direction: Vec3) -> (SmoothValue, f64) {
        match self {
            Self::Ward(lobes) => lobes.evaluate_with_pdf(direction),
            _ => (self.evaluate(direction), self.pdf(direction)),
        }
    }

    fn sample_direction(&self, choice: f64, u: [f64; 2], sampler: &mut Sampler) -> Option<Vec3> {
        match self {
            Self::Ward(lobes) => lobes.sample_direction(choice, u),
            _ => self.sample(choice, u, sampler).map(|sample| sample.direction),
        }
    }

    fn draw(&self, sampler: &mut Sampler) -> Option<SmoothSample> {
        // A sensor has one lobe.
        let choice = if matches!(self, Self::Sensor(_)) { 0.0 } else { sampler.next_1d() };
        let u = sampler.next_2d();
        self.sample(choice, u, sampler)
    }
}

impl Lobes for WardLobes<'_> {
    const ARE_PLAIN: bool = true;

    fn evaluate_with_pdf(&self, direction: Vec3) -> (SmoothValue, f64) {
        self.evaluate_with_pdf(direction)
    }

    fn toward_source(&self, direction: Vec3, _solid_angle: f64) -> SmoothValue {
        self.evaluate(direction).scaled(self.source_factor(direction))
    }

    fn source_factor(&self, direction: Vec3) -> f64 {
        self.source_factor(direction)
    }

    fn samples_find_sources(&self) -> bool {
        true
    }

    fn one_sided(&self) -> Option<Vec3> {
        self.one_sided()
    }

    fn cosine(&self, direction: Vec3, normal: Vec3) -> f64 {
        direction.dot(normal).abs()
    }

    fn offset(&self, _direction: Vec3) -> Vec3 {
        Vec3::ZERO
    }

    fn sample_direction(&self, choice: f64, u: [f64; 2], _sampler: &mut Sampler) -> Option<Vec3> {
        self.sample_direction(choice, u)
    }

    fn draw(&self, sampler: &mut Sampler) -> Option<SmoothSample> {
        let choice = sampler.next_1d();
        self.sample(choice, sampler.next_2d())
    }
}
