//! What the publications leave to the user.

use crate::BelowSight;
use sunpeak_core::{Error, Result, Vec3};

/// Above which luminance a pixel may glare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threshold {
    /// A luminance [cd/m²].
    Luminance(f64),
    /// A multiple of the mean luminance of the whole field of view.
    TimesMean(f64),
    /// A multiple of the mean luminance of a task zone (Wienold and Christoffersen 2006: 4 to 7 times; 5 is usual).
    TimesTask(f64, TaskZone),
}

/// A round zone of the field of view where the task is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskZone {
    /// Unit vector towards its centre, world axes.
    pub direction: Vec3,
    /// Full opening angle [rad].
    pub opening_angle_rad: f64,
}

/// How to look for glare. The defaults are those of evalglare 3.
#[derive(Clone, Debug, PartialEq)]
pub struct GlareOptions {
    /// Which pixels may glare: those above 2000 cd/m² unless told otherwise (Pierson, Wienold and Bodart 2018, "Daylight discomfort glare
    /// evaluation with evalglare", Buildings 8(8)).
    pub threshold: Threshold,
    /// Pixels within half of this opening angle of each other belong to the same source [rad].
    pub search_angle_rad: f64,
    /// Pixels above this luminance [cd/m²] are sources of their own, taken out of the larger one around them; `None`: not.
    pub peak_cd_m2: Option<f64>,
    /// Vertical illuminance at the eye, if it is known from elsewhere [lx].
    pub ev_lux: Option<f64>,
    /// Multiply `dgp` by the factor for dim scenes ([`crate::low_light_factor`]). It is in the report in any case.
    pub low_light: bool,
    /// Position index below the line of sight.
    pub below_sight: BelowSight,
    /// Standard error of the picture, relative, as far as it is common to Ev and the sources; 0 if there is none.
    pub relative_error: f64,
}

impl Default for GlareOptions {
    fn default() -> Self {
        Self {
            threshold: Threshold::Luminance(2000.0),
            search_angle_rad: 0.2,
            peak_cd_m2: Some(50_000.0),
            ev_lux: None,
            low_light: false,
            below_sight: BelowSight::default(),
            relative_error: 0.0,
        }
    }
}

impl GlareOptions {
    pub(crate) fn check(&self) -> Result<()> {
        let positive = |name: &str, value: f64| {
            if value > 0.0 && value.is_finite() {
                return Ok(());
            }
            Err(Error::value(format!("glare: {name} is {value}, expected a number above 0")))
        };
        match self.threshold {
            Threshold::Luminance(luminance) => positive("threshold [cd/m²]", luminance)?,
            Threshold::TimesMean(factor) => positive("threshold factor", factor)?,
            Threshold::TimesTask(factor, zone) => {
                positive("threshold factor", factor)?;
                positive("opening angle of the task zone [rad]", zone.opening_angle_rad)?;
                positive("length of the task zone's direction", zone.direction.length())?;
            }
        }
        positive("search angle [rad]", self.search_angle_rad)?;
        positive("peak luminance [cd/m²]", self.peak_cd_m2.unwrap_or(1.0))?;
        positive("vertical illuminance [lx]", self.ev_lux.unwrap_or(1.0))?;
        positive("1 + relative error", 1.0 + self.relative_error)
    }
}
