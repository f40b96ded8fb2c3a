//! `source`s: cones of directions at infinity.
//!
//! Where sources overlap one of them is seen, as in Radiance: the first light source in the scene's order, else the first
//! `illum`, else the first `glow`. A sun stands before the sky and does not add to it.

use super::{Light, LightSample, dome::Dome};
use crate::SMALL_SOURCE_DEG;
use crate::material::{Emitter, EmitterKind};
use sunpeak_core::{Cone, Rgb, Sampler, Vec3};
use sunpeak_scene::RayState;

/// Where expressions see a source [m] (Radiance, `FHUGE`).
const FAR_AWAY: f64 = 1e10;

/// A ray that has come to a source: it faces the ray, far away.
pub(crate) fn at_infinity(direction: Vec3) -> RayState {
    RayState::new(direction * FAR_AWAY, -direction, direction, FAR_AWAY)
}

/// One `source`.
#[derive(Clone, Debug)]
pub(crate) struct Distant {
    /// Where it is seen.
    pub cone: Cone,
    /// What it emits.
    pub emitter: Emitter,
    /// A sample of it, but for direction and density.
    sample: LightSample,
    /// Does it light, and is it no sun?
    lights_widely: bool,
    /// Which surface of the scene it is.
    pub surface: u32,
}

impl Distant {
    /// Around the unit vector `direction`, of this full angle [deg].
    pub fn new(direction: Vec3, angle_deg: f64, emitter: Emitter, surface: u32) -> Self {
        let cone = Cone::new(direction, angle_deg);
        let is_small = angle_deg < SMALL_SOURCE_DEG;
        let sample = LightSample {
            direction,
            distance: f64::INFINITY,
            light: Light::OfSource(0),
            pdf: 0.0,
            solid_angle: cone.solid_angle(),
            is_direct: emitter.is_direct(f64::INFINITY),
            is_dome: !is_small,
            object: None,
            is_hidden_by_illum: emitter.is_hidden_by_illum(),
        };
        Self { cone, sample, lights_widely: !is_small && emitter.illuminates(), emitter, surface }
    }

    /// Unit vector towards its centre.
    pub fn direction(&self) -> Vec3 {
        self.cone.axis()
    }

    /// Is it a sun: sampled one by one, and not left to chance?
    pub fn is_small(&self) -> bool {
        self.cone.angle_deg() < SMALL_SOURCE_DEG
    }

    /// Rank where sources overlap; the smallest is seen.
    fn rank(&self) -> u8 {
        match self.emitter.kind {
            EmitterKind::Light | EmitterKind::Spotlight { .. } => 0,
            EmitterKind::Illum { alternate: Some(_) } => 0,
            EmitterKind::Illum { alternate: None } => 1,
            EmitterKind::Glow { .. } => 2,
        }
    }
}

/// All sources of a scene.
#[derive(Debug, Default)]
pub(crate) struct DistantSources {
    sources: Vec<Distant>,
    /// Suns that light: indices among `sources`.
    suns: Vec<usize>,
    dome: Option<Dome>,
    /// The source that is seen in all of a strip of the dome, where that is one.
    of_strips: Vec<Option<usize>>,
}

impl DistantSources {
    /// In the scene's order.
    pub fn new(mut sources: Vec<Distant>) -> Self {
        sources.sort_by_key(Distant::rank);
        for (index, source) in sources.iter_mut().enumerate() {
            source.sample.light = Light::OfSource(index);
        }
        let lights = |s: &Distant| s.emitter.illuminates();
        let suns = (0..sources.len()).filter(|&i| sources[i].is_small() && lights(&sources[i])).collect();
        let mut all = Self { sources, suns, dome: None, of_strips: Vec::new() };
        let has_dome = all.sources.iter().any(|s| s.lights_widely);
        all.dome = has_dome.then(|| Dome::new(|d| all.dome_radiance(d))).flatten();
        let strips = all.dome.iter().flat_map(Dome::strips);
        all.of_strips = strips.map(|heights| all.seen_in_strip(heights)).collect();
        all
    }

    /// The source that is seen in all directions between two heights, if it is known to be one.
    fn seen_in_strip(&self, heights: [f64; 2]) -> Option<usize> {
        let found = self.sources.iter().map(|source| source.cone.holds_strip(heights));
        let (index, [all, _]) = found.enumerate().find(|(_, [_, any])| *any)?;
        all.then_some(index)
    }

    /// The source that is seen in a direction.
    pub fn seen(&self, direction: Vec3) -> Option<usize> {
        self.sources.iter().position(|source| source.cone.contains(direction))
    }

    pub fn get(&self, index: usize) -> &Distant {
        &self.sources[index]
    }

    /// Indices of the suns that light.
    pub fn suns(&self) -> &[usize] {
        &self.suns
    }

    /// Is there light from anything else than suns?
    pub fn has_dome(&self) -> bool {
        self.dome.is_some()
    }

    /// Radiance of all that lights and is no sun.
    pub fn dome_radiance(&self, direction: Vec3) -> Rgb {
        match self.seen(direction).map(|i| &self.sources[i]) {
            Some(s) if s.lights_widely => s.emitter.radiance(&at_infinity(direction)),
            _ => Rgb::ZERO,
        }
    }

    /// Density [1/sr] with which shadow rays are sent in a direction in which source `index` is seen.
    pub fn pdf(&self, index: usize, direction: Vec3) -> f64 {
        let source = &self.sources[index];
        match (&self.dome, source.is_small()) {
            (_, true) => 1.0 / source.cone.solid_angle(),
            (Some(dome), false) => dome.pdf(direction),
            (None, false) => 0.0,
        }
    }

    /// Density [1/sr] with which shadow rays are sent to the sky.
    pub fn dome_pdf(&self, direction: Vec3) -> f64 {
        self.dome.as_ref().map_or(0.0, |dome| dome.pdf(direction))
    }

    /// A direction to sun `index`; `None` where another source stands before it.
    pub fn sample_sun(&self, index: usize, u: [f64; 2]) -> Option<LightSample> {
        let sun = &self.sources[index];
        let direction = sun.cone.sample(u);
        let is_hidden = self.sources[..index].iter().any(|source| source.cone.contains(direction));
        (!is_hidden).then(|| self.light_sample(index, direction, 1.0 / sun.cone.solid_angle()))
    }

    /// A direction into the sky, if there is one, by numbers of the sampler.
    pub fn draw_sky(&self, sampler: &mut Sampler) -> Option<LightSample> {
        self.dome.as_ref().and_then(|_| self.sample_dome(sampler.next_2d()))
    }

    /// A direction into the sky, in proportion to its brightness.
    pub fn sample_dome(&self, u: [f64; 2]) -> Option<LightSample> {
        let (direction, pdf, strip) = self.dome.as_ref()?.sample(u);
        let index = self.of_strips[strip].or_else(|| self.seen(direction))?;
        self.sources[index].lights_widely.then(|| self.light_sample(index, direction, pdf))
    }

    /// What the emitter of a sample sends here if nothing is in between.
    pub fn radiance(&self, sample: &LightSample) -> Rgb {
        match sample.light {
            Light::Known(radiance) => radiance,
            Light::OfSource(index) => self.sources[index].emitter.radiance(&at_infinity(sample.direction)),
        }
    }

    fn light_sample(&self, index: usize, direction: Vec3, pdf: f64) -> LightSample {
        LightSample { direction, pdf, ..self.sources[index].sample }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, chi_square_of_sampler, sphere_sum};
    use sunpeak_core::{gray, luminance};
    use sunpeak_sky::{CieSky, SkyDistribution};

    fn source(direction: Vec3, angle_deg: f64, value: f64, kind: EmitterKind) -> Distant {
        let emitter = Emitter { radiance: gray(value), patterns: Vec::new(), kind };
        Distant::new(direction, angle_deg, emitter, 0)
    }

    fn sky_and_sun() -> DistantSources {
        let sun = Vec3::new(0.3, -0.6, 0.74).normalize();
        let pattern =
            SkyDistribution::Cie { kind: CieSky::Clear, zenith: 10.0, ground: 3.0, normalization: 0.3, sun };
        let mut sky = source(Vec3::Z, 180.0, 1.0, EmitterKind::Glow { max_radius: 0.0 });
        sky.emitter.patterns.push(crate::material::Step::Pattern(sunpeak_scene::Pattern::Sky(pattern)));
        let ground = source(Vec3::NEG_Z, 180.0, 2.0, EmitterKind::Glow { max_radius: 0.0 });
        DistantSources::new(vec![sky, ground, source(sun, 0.533, 1e6, EmitterKind::Light)])
    }

    #[test]
    fn the_sun_stands_before_the_sky() {
        let all = sky_and_sun();
        let sun = all.get(all.suns()[0]).direction();
        assert_eq!(all.seen(sun), Some(all.suns()[0]));
        assert!(all.dome_radiance(sun) == Rgb::ZERO);
        assert!(all.seen(Vec3::Z).is_some() && all.seen(Vec3::NEG_Z).is_some());
        assert!(all.sample_sun(all.suns()[0], [0.3, 0.4]).is_some());
    }

    #[test]
    fn there_is_no_gap_at_the_horizon() {
        let all = sky_and_sun();
        for i in 0..1000 {
            let (sin, cos) = (0.01 * f64::from(i)).sin_cos();
            assert!(all.seen(Vec3::new(cos, sin, 0.0)).is_some());
        }
    }

    #[test]
    fn the_dome_is_sampled_as_its_density_says() {
        let all = sky_and_sun();
        let dome = all.dome.as_ref().expect("a dome");
        chi_square_of_sampler("dome", |_, u| Some(dome.sample(u).0), |d| dome.pdf(d));
    }

    #[test]
    fn dome_samples_give_its_irradiance() {
        let all = sky_and_sun();
        let expected = sphere_sum(|d| all.dome_radiance(d) * d.z.max(0.0));
        let n = 1 << 14;
        let mean = (0..n)
            .filter_map(|i| all.sample_dome(sunpeak_core::Sampler::new(1, 0, i).next_2d()))
            .map(|s| all.radiance(&s) * s.direction.z.max(0.0) / s.pdf / n as f64)
            .sum::<Rgb>();
        assert!((mean - expected).length() < 3e-3 * expected.length(), "{mean} {expected}");
    }

    /// Variance of the brightness over the density, relative to its mean squared, and its largest: drawn in proportion to the brightness
    /// they would be 0 and 1.
    fn spread_of_weights(all: &DistantSources) -> (f64, f64) {
        let (mut random, n) = (Random(3), 200_000);
        let weights: Vec<f64> = (0..n)
            .filter_map(|_| all.sample_dome([random.next(), random.next()]))
            .map(|sample| luminance(all.radiance(&sample)) / sample.pdf)
            .collect();
        let mean = weights.iter().sum::<f64>() / f64::from(n);
        let square = weights.iter().map(|w| w * w).sum::<f64>() / f64::from(n);
        (square / (mean * mean) - 1.0, weights.iter().fold(0.0, |a, &b| b.max(a)) / mean)
    }

    #[test]
    fn a_sky_is_drawn_in_proportion_to_its_brightness() {
        let (variance, largest) = spread_of_weights(&sky_and_sun());
        assert!(variance < 0.003 && largest < 1.3, "{variance} {largest}");
        // Bright and black, with an edge that the cells in which brightness is looked at do not follow.
        let glow = || EmitterKind::Glow { max_radius: 0.0 };
        for (axis, angle) in [(Vec3::Z, 90.0), (Vec3::X, 60.0), (Vec3::new(0.6, 0.0, 0.8), 20.0)] {
            let (variance, largest) =
                spread_of_weights(&DistantSources::new(vec![source(axis, angle, 1.0, glow())]));
            assert!(variance < 0.15 && largest < 8.0, "{axis} {angle}: {variance} {largest}");
        }
    }
}
