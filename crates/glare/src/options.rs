//! What the publications leave to the user.

use crate::{BelowSight, DgpFit, low_light_factor};
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

/// How well what goes in is known: half-widths of 95 % intervals; 0 is exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tolerances {
    /// Through transmittance (openness) of what suns are seen through, relative. It moves exact sources.
    pub through: f64,
    /// Radiance of the sky and the sun, relative. It moves everything.
    pub sky: f64,
    /// Position of sources in the field of view, by that of the eye, the line of sight or the sun [deg].
    pub position_deg: f64,
}

/// Where the middle of a source is, from which its position index follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SourceCentre {
    /// Centre of gravity of luminance on the angular fisheye around the line of sight, whatever the kind of the picture: in `-vta` what
    /// evalglare finds, but for half a pixel.
    #[default]
    Angular,
    /// Mean direction of its light: the very middle of a round source. In large windows it lies nearer to the rim.
    Sphere,
    /// Centre of gravity on the picture itself, of the lower left corners of the pixels, then the middle of the pixel in which it lies: what
    /// evalglare 3.06 does. A large window in a `-vth` picture so has another centre than in a `-vta` picture of the same view.
    Evalglare3,
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
    /// Take the view's up vector as it is, even if it is not perpendicular to the line of sight (evalglare 3.06).
    pub up_as_given: bool,
    /// Whose coefficients DGP has.
    pub dgp_fit: DgpFit,
    /// Where the middle of a source is.
    pub centre: SourceCentre,
    /// A smaller source counts as if it had this solid angle [sr], with as much less luminance: the eye cannot tell (the proposal of a
    /// daylight glare metric DGM with a minimum, Lighting Research & Technology 2025, doi 10.1177/14771535251314413). `None`: it counts as it is.
    pub least_solid_angle_sr: Option<f64>,
    /// Where the task is, for the luminances of zones; by default the zone of [`Threshold::TimesTask`], if that is the threshold.
    pub task: Option<TaskZone>,
    /// How far away sources are [m], for the small-source extension of UGR.
    pub source_distance_m: Option<f64>,
    /// How well what goes in is known.
    pub tolerances: Tolerances,
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
            up_as_given: false,
            dgp_fit: DgpFit::default(),
            centre: SourceCentre::default(),
            least_solid_angle_sr: None,
            task: None,
            source_distance_m: None,
            tolerances: Tolerances::default(),
            relative_error: 0.0,
        }
    }
}

impl GlareOptions {
    /// The task zone that is stated, or that of the threshold.
    pub(crate) fn task_zone(&self) -> Option<TaskZone> {
        match self.threshold {
            Threshold::TimesTask(_, zone) => Some(self.task.unwrap_or(zone)),
            _ => self.task,
        }
    }

    /// The factor on DGP for dim scenes, if that is asked for.
    pub(crate) fn low_light_factor(&self, ev_lux: f64) -> f64 {
        if self.low_light { low_light_factor(ev_lux) } else { 1.0 }
    }

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
            Threshold::TimesTask(factor, _) => positive("threshold factor", factor)?,
        }
        if let Some(zone) = self.task_zone() {
            positive("opening angle of the task zone [rad]", zone.opening_angle_rad)?;
            positive("length of the task zone's direction", zone.direction.length())?;
        }
        positive("least solid angle [sr]", self.least_solid_angle_sr.unwrap_or(1.0))?;
        positive("distance of the sources [m]", self.source_distance_m.unwrap_or(1.0))?;
        positive("search angle [rad]", self.search_angle_rad)?;
        positive("peak luminance [cd/m²]", self.peak_cd_m2.unwrap_or(1.0))?;
        positive("vertical illuminance [lx]", self.ev_lux.unwrap_or(1.0))?;
        let Tolerances { through, sky, position_deg } = self.tolerances;
        positive("1 + tolerance of transmittance", 1.0 + through.min(0.0))?;
        positive("1 + tolerance of the sky", 1.0 + sky.min(0.0))?;
        positive("1 + tolerance of position", 1.0 + position_deg.min(0.0))?;
        positive("1 + relative error", 1.0 + self.relative_error)
    }
}
