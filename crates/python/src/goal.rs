//! Rendering until a glare number is known well enough.

use crate::error::InputError;
use pyo3::prelude::*;
use sunpeak_core::Result;
use sunpeak_glare::{ClassVerdict, GlareOptions, GlareReport, evaluate};
use sunpeak_scene::Picture;

/// What is to be known.
#[derive(Clone, Copy, Debug)]
pub enum GlareGoal {
    /// The comfort class.
    Class,
    /// DGP, to this half-width of its 95 % interval.
    Dgp(f64),
    /// Vertical illuminance, to this half-width of its 95 % interval, relative.
    Ev(f64),
}

/// A class counts as known where an interval so many times as wide as that of 95 % lies in it: it is asked for after each pass, and one
/// wrong answer would end the work.
const CLASS_SAFETY: f64 = 1.5;

/// Half-width of the interval of DGP at which a class that is still open stays undecided: the third digit is known then.
const NARROWEST: f64 = 0.0005;

impl GlareGoal {
    /// From a name and a number.
    pub fn of(kind: &str, value: f64) -> PyResult<Self> {
        match kind {
            "class" => Ok(Self::Class),
            "dgp" if value > 0.0 => Ok(Self::Dgp(value)),
            "ev" if value > 0.0 => Ok(Self::Ev(value)),
            _ => Err(InputError::new_err(format!(
                "error: {kind:?} with {value}; expected class, or dgp or ev with a positive number"
            ))),
        }
    }

    /// Is a picture good enough for it?
    pub fn is_reached(self, picture: &Picture) -> Result<bool> {
        let report = evaluate(picture, &GlareOptions::default())?;
        let half = |[low, high]: [f64; 2]| (high - low) / 2.0;
        Ok(match self {
            Self::Class => is_class_known(&report),
            Self::Dgp(goal) => half(report.dgp_interval) <= goal,
            Self::Ev(goal) => {
                let interval = report.sampling.iter().flatten().find(|(name, _)| *name == "ev_lux");
                interval.is_some_and(|&(_, interval)| half(interval) <= goal * report.ev_lux)
            }
        })
    }
}

fn is_class_known(report: &GlareReport) -> bool {
    let [low, high] = report.dgp_interval;
    let halves = [report.dgp - low, high - report.dgp];
    let safe = ClassVerdict::of(report.dgp, halves.map(|half| CLASS_SAFETY * half));
    safe.class.is_some() || halves.iter().all(|&half| half < NARROWEST)
}
