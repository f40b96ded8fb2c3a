//! What a DGP means.

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
}
