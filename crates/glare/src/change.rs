//! What the noise of pixels does to the sources to which they belong or not.

use crate::field::FieldPixel;
use crate::normal::Part;
use std::ops::Range;
use sunpeak_core::Vec3;

/// Two sources at most share a pixel's luminances: one is bright and was split off, the other is around it.
pub(crate) const OWNERS: usize = 2;

/// A change of a scene by noise.
#[derive(Clone, Debug, Default)]
pub(crate) struct Change {
    /// By source.
    pub sources: Vec<(usize, SourceChange)>,
    /// Luminance times solid angle of all that the eye sees [cd sr m⁻²].
    pub flux: f64,
    /// Illuminance at the eye [lx].
    pub illuminance_lux: f64,
}

impl Change {
    /// As much of a step of so many standard deviations as there are pixels for: a pixel of the source may leave, another may come; neither
    /// does both.
    pub fn possible(&self, step: f64) -> f64 {
        let share = |(_, change): &(usize, SourceChange)| {
            let [least, most] = change.limits_sr;
            let wanted = step * change.solid_angle_sr;
            if wanted == 0.0 { 1.0 } else { wanted.clamp(least, most) / wanted }
        };
        step * self.sources.iter().map(share).fold(1.0, f64::min)
    }
}

/// A change of a source.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SourceChange {
    pub solid_angle_sr: f64,
    /// What it can be at least and at most.
    pub limits_sr: [f64; 2],
    /// Luminance times solid angle [cd sr m⁻²].
    pub flux: f64,
    /// The same times its direction from the source's centre.
    pub moment: Vec3,
}

/// What belongs to a source: its number, and the luminances of its pixels [cd/m²].
#[derive(Clone, Debug)]
pub(crate) struct Owner {
    pub source: usize,
    pub luminances_cd_m2: Range<f64>,
}

/// Numbers that a pixel adds to: the solid angle of each owner; of each its flux, and the flux times the offset along two axes; of all
/// that is seen the flux and the illuminance.
const SUMS: usize = OWNERS + 3 * OWNERS + 2;

/// Probability of what lies outside of a 95 % interval on one side.
const RARE: f64 = 0.025;

/// What they depend on: of each owner, is the pixel its (I), and the deviation of the pixel's luminance from its mean if so (I D); and D.
const CAUSES: usize = 2 * OWNERS + 1;

/// Covariance of what independent pixels add to.
#[derive(Clone, Debug)]
pub(crate) struct Covariance {
    frames: Vec<(usize, Frame)>,
    sums: [[f64; SUMS]; SUMS],
    /// Of each owner the pixels that may leave, and those that may come.
    passing: [[Passing; 2]; OWNERS],
}

/// Pixels that may change their owner.
#[derive(Clone, Copy, Debug, Default)]
struct Passing {
    solid_angle_sr: f64,
    /// How many of those of which each is rare are to be expected.
    rare: f64,
}

impl Passing {
    fn add(&mut self, solid_angle_sr: f64, probability: f64) {
        if probability > RARE {
            self.solid_angle_sr += solid_angle_sr;
        } else {
            self.rare += probability;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.solid_angle_sr += other.solid_angle_sr;
        self.rare += other.rare;
    }

    /// Solid angle that passes at most, but in rare cases [sr]. Many pixels together are not rare, and their variance says how many pass.
    fn limit_sr(&self) -> f64 {
        if self.rare > RARE { f64::INFINITY } else { self.solid_angle_sr }
    }
}

/// A source's centre, and axes across it.
#[derive(Clone, Copy, Debug)]
struct Frame {
    centre: Vec3,
    axes: [Vec3; 2],
}

impl Frame {
    fn around(centre: Vec3) -> Self {
        let (first, second) = centre.any_orthonormal_pair();
        Self { centre, axes: [first, second] }
    }

    fn offset(&self, direction: Vec3) -> [f64; 2] {
        self.axes.map(|axis| (direction - self.centre).dot(axis))
    }
}

impl Covariance {
    /// Of nothing yet, for these owners of each pixel.
    pub fn new(owners: &[Owner], centre: impl Fn(usize) -> Vec3) -> Self {
        let frame = |owner: &Owner| (owner.source, Frame::around(centre(owner.source)));
        let frames = owners.iter().map(frame).collect();
        Self { frames, sums: [[0.0; SUMS]; SUMS], passing: Default::default() }
    }

    /// Take in a pixel whose luminance is normally distributed with this variance: it belongs to the owner between whose luminances it
    /// falls, so that solid angle, flux and illuminance change together.
    pub fn add(&mut self, pixel: &FieldPixel, variance: f64, owners: &[Owner]) {
        let (solid_angle, luminance) = (pixel.solid_angle_sr, pixel.luminance_cd_m2);
        let mut effects = [[0.0; CAUSES]; SUMS];
        for (k, (_, frame)) in self.frames.iter().enumerate() {
            let [first, second] = frame.offset(pixel.direction);
            effects[k][2 * k] = solid_angle;
            for (i, factor) in [1.0, first, second].into_iter().enumerate() {
                effects[OWNERS + 3 * k + i][2 * k] = factor * solid_angle * luminance;
                effects[OWNERS + 3 * k + i][2 * k + 1] = factor * solid_angle;
            }
        }
        effects[SUMS - 2][CAUSES - 1] = solid_angle;
        effects[SUMS - 1][CAUSES - 1] = solid_angle * pixel.cosine;
        let deviation = variance.sqrt();
        let part = |owner: &Owner| {
            let Range { start, end } = owner.luminances_cd_m2;
            Part::between((start - luminance) / deviation, (end - luminance) / deviation)
        };
        let parts: Vec<Part> = owners.iter().map(part).collect();
        for ((owner, part), [leaving, coming]) in owners.iter().zip(&parts).zip(&mut self.passing) {
            if owner.luminances_cd_m2.contains(&luminance) {
                leaving.add(solid_angle, 1.0 - part.probability);
            } else {
                coming.add(solid_angle, part.probability);
            }
        }
        let causes = causes(&parts, deviation);
        for (i, of_one) in effects.iter().enumerate() {
            let half: [f64; CAUSES] =
                std::array::from_fn(|b| (0..CAUSES).map(|a| of_one[a] * causes[a][b]).sum());
            for (sum, of_other) in self.sums[i].iter_mut().zip(&effects) {
                *sum += half.iter().zip(of_other).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }

    /// Take in the pixels of another with the same owners.
    pub fn merge(&mut self, other: &Self) {
        self.sums.iter_mut().flatten().zip(other.sums.iter().flatten()).for_each(|(a, b)| *a += b);
        self.passing.iter_mut().flatten().zip(other.passing.iter().flatten()).for_each(|(a, b)| a.merge(b));
    }

    /// Independent changes of one standard deviation that have this covariance together: the columns of its Cholesky factor.
    pub fn changes(&self) -> Vec<Change> {
        let (mut changes, mut rest) = (Vec::new(), self.sums);
        for k in 0..SUMS {
            // What rounding leaves of a sum that depends on those before is nothing.
            if rest[k][k] <= 1e-9 * self.sums[k][k] {
                continue;
            }
            let column: [f64; SUMS] =
                std::array::from_fn(|i| if i < k { 0.0 } else { rest[i][k] / rest[k][k].sqrt() });
            for (i, row) in rest.iter_mut().enumerate() {
                row.iter_mut().zip(&column).for_each(|(value, other)| *value -= column[i] * other);
            }
            changes.push(self.change(&column));
        }
        changes
    }

    fn change(&self, sums: &[f64; SUMS]) -> Change {
        let of_source = |(k, &(source, frame)): (usize, &(usize, Frame))| {
            let [flux, first, second] = std::array::from_fn(|i| sums[OWNERS + 3 * k + i]);
            let moment = first * frame.axes[0] + second * frame.axes[1];
            let [leaving, coming] = self.passing[k].map(|passing| passing.limit_sr());
            (source, SourceChange { solid_angle_sr: sums[k], limits_sr: [-leaving, coming], flux, moment })
        };
        let sources = self.frames.iter().enumerate().map(of_source).collect();
        Change { sources, flux: sums[SUMS - 2], illuminance_lux: sums[SUMS - 1] }
    }
}

/// Covariance of I and I D of each owner, and D.
fn causes(parts: &[Part], deviation: f64) -> [[f64; CAUSES]; CAUSES] {
    let mut found = [[0.0; CAUSES]; CAUSES];
    for (j, one) in parts.iter().enumerate() {
        for (k, other) in parts.iter().enumerate() {
            let same = if j == k { 1.0 } else { 0.0 };
            found[2 * j][2 * k] = same * one.probability - one.probability * other.probability;
            found[2 * j][2 * k + 1] = deviation * (same * one.first - one.probability * other.first);
            found[2 * k + 1][2 * j] = found[2 * j][2 * k + 1];
            found[2 * j + 1][2 * k + 1] =
                deviation * deviation * (same * one.second - one.first * other.first);
        }
        for (cause, with_all) in
            [(2 * j, deviation * one.first), (2 * j + 1, deviation * deviation * one.second)]
        {
            found[cause][CAUSES - 1] = with_all;
            found[CAUSES - 1][cause] = with_all;
        }
    }
    found[CAUSES - 1][CAUSES - 1] = deviation * deviation;
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::{Sampler, warp};

    /// A normal number (Box and Muller).
    fn normal(random: &mut Sampler) -> f64 {
        let [u, v] = random.next_2d();
        (-2.0 * (1.0 - u).ln()).sqrt() * warp::circle(v)[0]
    }

    fn pixel(luminance_cd_m2: f64, right_rad: f64) -> FieldPixel {
        let (sin, cos) = right_rad.sin_cos();
        let direction = Vec3::new(sin, cos, 0.0);
        FieldPixel {
            index: 0,
            direction,
            solid_angle_sr: 1e-3 * (1.0 + right_rad),
            luminance_cd_m2,
            cosine: cos,
        }
    }

    const CENTRES: [Vec3; OWNERS] = [Vec3::new(0.28, 0.96, 0.0), Vec3::new(0.6, 0.8, 0.0)];

    fn owners() -> [Owner; OWNERS] {
        let owner = |source, from, to| Owner { source, luminances_cd_m2: from..to };
        [owner(0, 5000.0, f64::INFINITY), owner(1, 2000.0, 5000.0)]
    }

    /// Solid angle, flux and moment of both owners, and what is seen in all.
    type Sums = [f64; 8];

    fn along(source: usize) -> Vec3 {
        CENTRES[source].cross(Vec3::Z)
    }

    fn sums(change: &Change) -> Sums {
        let [(_, one), (_, other)] = change.sources[..] else { panic!("{change:?}") };
        let moment = |source: usize, change: SourceChange| change.moment.dot(along(source));
        let [first, second] = [moment(0, one), moment(1, other)];
        let [flux, lux] = [change.flux, change.illuminance_lux];
        [one.solid_angle_sr, one.flux, first, other.solid_angle_sr, other.flux, second, flux, lux]
    }

    /// What pixels of these luminances bring.
    fn drawn(pixels: &[FieldPixel], luminances: &[f64]) -> Sums {
        let mut sums = [0.0; 8];
        for (pixel, &luminance) in pixels.iter().zip(luminances) {
            let flux = luminance * pixel.solid_angle_sr;
            for (k, owner) in
                owners().iter().enumerate().filter(|(_, o)| o.luminances_cd_m2.contains(&luminance))
            {
                let moment = flux * (pixel.direction - CENTRES[k]).dot(along(k));
                for (i, value) in [pixel.solid_angle_sr, flux, moment].into_iter().enumerate() {
                    sums[3 * k + i] += if owner.source == k { value } else { 0.0 };
                }
            }
            sums[6] += flux;
            sums[7] += flux * pixel.cosine;
        }
        sums
    }

    /// Pixels inside, near either limit and outside, drawn many times.
    #[test]
    fn covariances_are_those_of_pixels_that_are_drawn() {
        let pixels: Vec<FieldPixel> = [9000.0, 5200.0, 4700.0, 3000.0, 2100.0, 1800.0, 700.0]
            .iter()
            .enumerate()
            .map(|(i, &luminance)| pixel(luminance, 0.2 + 0.07 * i as f64))
            .collect();
        let deviations = [300.0, 400.0, 350.0, 900.0, 200.0, 500.0, 100.0];
        let mut covariance = Covariance::new(&owners(), |source| CENTRES[source]);
        for (pixel, deviation) in pixels.iter().zip(deviations) {
            covariance.add(pixel, f64::powi(deviation, 2), &owners());
        }
        let changes: Vec<Sums> = covariance.changes().iter().map(sums).collect();

        let (draws, mut random) = (200_000, Sampler::new(3, 0, 0));
        let mut draw = |_| {
            let with_noise = |(pixel, deviation): (&FieldPixel, f64)| {
                pixel.luminance_cd_m2 + deviation * normal(&mut random)
            };
            let luminances: Vec<f64> = pixels.iter().zip(deviations).map(with_noise).collect();
            drawn(&pixels, &luminances)
        };
        let all: Vec<Sums> = (0..draws).map(&mut draw).collect();
        let product =
            |i: usize, j: usize, all: &[Sums]| all.iter().map(|sums| sums[i] * sums[j]).sum::<f64>();
        let mean = |i: usize| all.iter().map(|sums| sums[i]).sum::<f64>() / f64::from(draws);
        let truth = |i: usize, j: usize| product(i, j, &all) / f64::from(draws) - mean(i) * mean(j);
        for i in 0..8 {
            for j in 0..8 {
                let error = product(i, j, &changes) - truth(i, j);
                let scale = (truth(i, i) * truth(j, j)).sqrt();
                assert!(error.abs() < 0.015 * scale, "{i} {j}: {error} of {scale}");
            }
        }
    }

    #[test]
    fn one_pixel_leaves_or_comes_but_not_both() {
        for (luminance, side) in [(1900.0, 1.0), (2100.0, -1.0)] {
            let mut covariance = Covariance::new(&owners()[1..], |source| CENTRES[source]);
            let pixel = pixel(luminance, 0.3);
            covariance.add(&pixel, 400.0 * 400.0, &owners()[1..]);
            let changes = covariance.changes();
            let change = &changes[0];
            let (_, of_source) = change.sources[0];
            assert!(of_source.solid_angle_sr > 0.45 * pixel.solid_angle_sr, "{of_source:?}");
            assert_eq!(change.possible(-side), 0.0);
            assert_eq!(change.possible(side), side);
            let whole = change.possible(9.0 * side) * of_source.solid_angle_sr;
            assert!((whole - side * pixel.solid_angle_sr).abs() < 1e-12, "{whole}");
        }
    }
}
