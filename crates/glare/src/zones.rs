//! Mean luminances of zones of the field of view.

use crate::exact::VisibleSource;
use crate::options::TaskZone;
use crate::report::ZoneLuminances;
use crate::survey::{Cone, Mean, Survey};
use sunpeak_core::Vec3;

/// Full opening angles of ergorama and panorama [deg] (see [`ZoneLuminances`]).
const ERGORAMA_DEG: f64 = 60.0;
const PANORAMA_DEG: f64 = 120.0;

/// Nested zones around the line of sight, the task first.
pub(crate) struct Zones {
    task: Option<Cone>,
    ergorama: Cone,
    panorama: Cone,
}

/// Place of a zone among the means.
const TASK: usize = 0;
const ERGORAMA: usize = 1;
const PANORAMA: usize = 2;
pub(crate) const PERIPHERY: usize = 3;

impl Zones {
    pub fn new(sight: Vec3, task: Option<TaskZone>) -> Self {
        let around_sight = |angle: f64| Cone::new(sight, angle.to_radians());
        Self {
            task: task.map(|zone| Cone::new(zone.direction, zone.opening_angle_rad)),
            ergorama: around_sight(ERGORAMA_DEG),
            panorama: around_sight(PANORAMA_DEG),
        }
    }

    /// Which zone a direction lies in; the task goes before the others.
    pub fn of(&self, direction: Vec3) -> usize {
        match () {
            () if self.task.is_some_and(|task| task.contains(direction)) => TASK,
            () if self.ergorama.contains(direction) => ERGORAMA,
            () if self.panorama.contains(direction) => PANORAMA,
            () => PERIPHERY,
        }
    }

    /// Mean luminances, suns included.
    pub fn luminances(&self, survey: &Survey, suns: &[VisibleSource]) -> ZoneLuminances {
        let mut means = survey.zones;
        for sun in suns {
            means[self.of(sun.direction)].flux += sun.luminance_cd_m2 * sun.solid_angle_sr;
        }
        let [task, ergorama, panorama, periphery] = means.map(|mean: Mean| mean.luminance());
        ZoneLuminances { task, ergorama, panorama, periphery }
    }
}
