//! Choosing among lamps.

use super::{Lamp, LightSample};
use sunpeak_core::Vec3;

/// Up to so many lamps are weighed by their distance at every point; more are weighed by their power alone.
const WEIGHED_BY_DISTANCE: usize = 64;

/// All emitting objects that light.
#[derive(Debug, Default)]
pub(crate) struct Lamps {
    lamps: Vec<Lamp>,
    strengths: Vec<f64>,
    /// Centre and radius around each.
    places: Vec<(Vec3, f64)>,
}

impl Lamps {
    pub fn new(lamps: Vec<Lamp>) -> Self {
        let strengths = lamps.iter().map(Lamp::strength).collect();
        let places = lamps.iter().map(|l| l.shape.surroundings()).collect();
        Self { lamps, strengths, places }
    }

    /// A direction towards one of the lamps.
    pub fn sample(&self, from: Vec3, choice: f64, u: [f64; 2]) -> Option<LightSample> {
        let whole = self.whole(from);
        if whole <= 0.0 {
            return None;
        }
        let mut rest = choice * whole;
        let mut chosen = self.lamps.len() - 1;
        for i in 0..self.lamps.len() {
            rest -= self.weight(i, from);
            if rest < 0.0 {
                chosen = i;
                break;
            }
        }
        let probability = self.weight(chosen, from) / whole;
        let sample = self.lamps[chosen].sample(from, u)?;
        (probability > 0.0).then_some(LightSample { pdf: sample.pdf * probability, ..sample })
    }

    /// Density [1/sr] of `sample` for a direction that meets lamp `index`.
    pub fn pdf(&self, index: usize, from: Vec3, direction: Vec3, distance: f64, normal: Vec3) -> f64 {
        let whole = self.whole(from);
        if whole <= 0.0 {
            return 0.0;
        }
        self.lamps[index].pdf(from, direction, distance, normal) * self.weight(index, from) / whole
    }

    pub fn is_empty(&self) -> bool {
        self.lamps.is_empty()
    }

    fn whole(&self, from: Vec3) -> f64 {
        (0..self.lamps.len()).map(|i| self.weight(i, from)).sum()
    }

    fn weight(&self, i: usize, from: Vec3) -> f64 {
        // There is nothing to choose: any weight will do.
        if self.lamps.len() == 1 {
            return 1.0;
        }
        if self.lamps.len() > WEIGHED_BY_DISTANCE {
            return self.strengths[i];
        }
        let (center, radius) = self.places[i];
        self.strengths[i] / from.distance_squared(center).max(radius * radius)
    }
}
