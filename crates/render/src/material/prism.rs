//! `prism1`, `prism2`: a plane that stands for a layer of prisms and sends rays on in other directions, by its functions.
//!
//! Suns shine through as virtual suns: see `Integrator::suns_through_prisms`.

use super::{Arrival, Scattering};
use std::sync::Arc;
use sunpeak_core::Vec3;
use sunpeak_scene::{Field, RayState};

/// The material.
#[derive(Clone, Debug)]
pub(crate) struct Prism {
    pub field: Arc<Field>,
    /// One or two.
    pub ways: usize,
}

impl Prism {
    /// Share and direction of a ray that goes on by way `index`; `target` is where a light source stands, zero for none.
    pub fn way(&self, index: usize, ray: &RayState, target: Vec3) -> Option<(f64, Vec3)> {
        let ray = RayState { target, ..*ray };
        let value = |i: usize| self.field.call(&ray, 4 * index + i, &[]);
        let share = value(0).filter(|share| *share > 0.0)?;
        let direction = Vec3::new(value(1)?, value(2)?, value(3)?);
        Some((share, self.field.world_direction(direction).try_normalize()?))
    }

    pub fn scatter(&self, arrival: &Arrival) -> Scattering<'static> {
        let ray = arrival.ray_state();
        let ways = [0, 1].map(|i| if i < self.ways { self.way(i, &ray, Vec3::ZERO) } else { None });
        let refracted = ways.map(|way| way.map(|(share, direction)| (direction, arrival.tint * share)));
        Scattering { refracted, ..Scattering::BLACK }
    }
}
