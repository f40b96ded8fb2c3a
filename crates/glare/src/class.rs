//! What a DGP means.

use crate::normal;
use crate::uncertainty::CONFIDENCE;
use std::fmt;

/// Glare in words. The limits are those of Wienold 2009, "Dynamic daylight glare evaluation", Building Simulation 2009, and of EN
/// 17037:2018, annex E.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum GlareClass {
    /// DGP up to 0.35: mostly not perceived.
    Imperceptible,
    /// DGP above 0.35, up to 0.40: perceived, mostly not disturbing.
    Perceptible,
    /// DGP above 0.40, up to 0.45: perceived and often disturbing.
    Disturbing,
    /// DGP above 0.45: mostly intolerable.
    Intolerable,
}

impl GlareClass {
    /// Upper limits of the first three classes.
    pub const LIMITS: [f64; 3] = [0.35, 0.40, 0.45];

    /// The class of a DGP.
    pub fn of(dgp: f64) -> Self {
        let [perceptible, disturbing, intolerable] = Self::LIMITS;
        match dgp {
            d if d > intolerable => Self::Intolerable,
            d if d > disturbing => Self::Disturbing,
            d if d > perceptible => Self::Perceptible,
            _ => Self::Imperceptible,
        }
    }

    /// All, the mildest first.
    pub const ALL: [Self; 4] = [Self::Imperceptible, Self::Perceptible, Self::Disturbing, Self::Intolerable];

    /// Its name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Imperceptible => "imperceptible",
            Self::Perceptible => "perceptible",
            Self::Disturbing => "disturbing",
            Self::Intolerable => "intolerable",
        }
    }
}

/// What can be said of the class where DGP is not known exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassVerdict {
    /// Probability of each class [-], the mildest first, for a normal distribution.
    pub probabilities: [f64; 4],
    /// The class, if the whole 95 % interval of DGP lies in it; otherwise it is undecided.
    pub class: Option<GlareClass>,
}

impl ClassVerdict {
    /// From DGP and the half-widths of its 95 % interval downwards and upwards.
    pub fn of(dgp: f64, [below, above]: [f64; 2]) -> Self {
        let probability_below = |limit: f64| {
            let half = if limit < dgp { below } else { above };
            match half > 0.0 {
                true => normal::cumulative((limit - dgp) / half * CONFIDENCE),
                false => f64::from(u8::from(dgp <= limit)),
            }
        };
        let [a, b, c] = GlareClass::LIMITS.map(probability_below);
        let (low, high) = (GlareClass::of(dgp - below), GlareClass::of(dgp + above));
        Self { probabilities: [a, b - a, c - b, 1.0 - c], class: (low == high).then_some(low) }
    }
}

impl fmt::Display for GlareClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_belong_to_the_milder_class() {
        assert_eq!(GlareClass::of(0.35), GlareClass::Imperceptible);
        assert_eq!(GlareClass::of(0.351), GlareClass::Perceptible);
        assert_eq!(GlareClass::of(0.45), GlareClass::Disturbing);
        assert_eq!(GlareClass::of(0.46).to_string(), "intolerable");
    }

    /// A DGP of 0.35 with a standard deviation of 0.01: one half below the border, 0.40 is five deviations away.
    #[test]
    fn probabilities_are_those_of_the_normal_distribution() {
        let verdict = ClassVerdict::of(0.35, [0.0196; 2]);
        let [imperceptible, perceptible, disturbing, intolerable] = verdict.probabilities;
        assert!((imperceptible - 0.5).abs() < 1e-9 && (perceptible - 0.5).abs() < 1e-6);
        assert!(disturbing < 1e-6 && intolerable < 1e-9);
        assert_eq!(verdict.class, None);
        let sure = ClassVerdict::of(0.3, [0.0; 2]);
        assert_eq!((sure.probabilities, sure.class), ([1.0, 0.0, 0.0, 0.0], Some(GlareClass::Imperceptible)));
    }
}
