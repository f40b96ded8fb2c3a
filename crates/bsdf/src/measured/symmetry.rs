//! What of a sample is the same when it is turned or mirrored, told by the azimuths at which it was measured.

use super::scan::{Incidence, merged};
use glam::DVec2;
use sunpeak_core::{Error, Result};

/// Symmetry of a sample about the planes through its normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// The same at all azimuths, and in a mirror.
    Isotropic,
    /// The same in both mirrors, x and y: a quarter of the incidences is enough.
    Quadrilateral,
    /// The same in one mirror: a half is enough.
    Bilateral {
        /// Left and right change places; else above and below.
        left_right: bool,
    },
    /// None.
    Anisotropic,
}

/// Azimuths that differ by less are the same [deg].
const SAME_DEG: f64 = 0.6;

/// Incidences closer to the normal have no azimuth [sine].
const NORMAL: f64 = 0.01;

impl Symmetry {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Isotropic => "isotropic",
            Self::Quadrilateral => "quadrilateral",
            Self::Bilateral { left_right: true } => "bilateral (left and right alike)",
            Self::Bilateral { left_right: false } => "bilateral (above and below alike)",
            Self::Anisotropic => "anisotropic",
        }
    }

    /// That which the azimuths of incidence tell: one azimuth, a quarter of the hemisphere, a half, or more.
    pub fn find(incidences: &[Incidence]) -> Self {
        let azimuths = azimuths_deg(incidences);
        if azimuths.iter().all(|a| apart_deg(*a, azimuths[0]) < SAME_DEG) {
            return Self::Isotropic;
        }
        let within = |start: f64, width: f64| {
            azimuths.iter().all(|a| (a - start + SAME_DEG).rem_euclid(360.0) <= width + 2.0 * SAME_DEG)
        };
        let starts = [0.0, 90.0, 180.0, 270.0];
        if starts.iter().any(|&start| within(start, 90.0)) {
            Self::Quadrilateral
        } else if let Some(&start) = starts.iter().find(|&&start| within(start, 180.0)) {
            Self::Bilateral { left_right: start == 90.0 || start == 270.0 }
        } else {
            Self::Anisotropic
        }
    }

    /// The symmetry that was asked for by its name, if what was measured is enough for it.
    pub fn named(name: &str, incidences: &[Incidence]) -> Result<Self> {
        let found = Self::find(incidences);
        let asked = match (name, found) {
            ("find", _) => return Ok(found),
            ("isotropic", _) => Self::Isotropic,
            ("quadrilateral", _) => Self::Quadrilateral,
            ("bilateral", Self::Bilateral { left_right }) => Self::Bilateral { left_right },
            ("bilateral", _) => Self::Bilateral { left_right: true },
            ("anisotropic", _) => Self::Anisotropic,
            _ => {
                let expected = "find, isotropic, quadrilateral, bilateral or anisotropic";
                return Err(Error::value(format!("symmetry '{name}'; expected {expected}")));
            }
        };
        if asked.rank() < found.rank() {
            return Err(Error::value(format!(
                "symmetry {name}: the azimuths of incidence cover what is enough for {} alone; expected more of them, or that symmetry",
                found.name()
            )));
        }
        Ok(asked)
    }

    /// How much it takes for given.
    fn rank(self) -> usize {
        match self {
            Self::Isotropic => 3,
            Self::Quadrilateral => 2,
            Self::Bilateral { .. } => 1,
            Self::Anisotropic => 0,
        }
    }

    /// All incidences that follow from those measured; of an isotropic sample they lie on the positive x axis.
    pub fn completed(self, incidences: &[Incidence]) -> Vec<Incidence> {
        let mirrors: &[DVec2] = match self {
            Self::Isotropic => &[DVec2::ONE, DVec2::new(1.0, -1.0)],
            Self::Quadrilateral => {
                &[DVec2::ONE, DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0), DVec2::NEG_ONE]
            }
            Self::Bilateral { left_right: true } => &[DVec2::ONE, DVec2::new(-1.0, 1.0)],
            Self::Bilateral { left_right: false } => &[DVec2::ONE, DVec2::new(1.0, -1.0)],
            Self::Anisotropic => &[DVec2::ONE],
        };
        let turned = incidences.iter().map(|i| if self == Self::Isotropic { i.turned() } else { i.clone() });
        merged(turned.flat_map(|i| mirrors.iter().map(move |&signs| i.mirrored(signs))))
    }
}

fn azimuths_deg(incidences: &[Incidence]) -> Vec<f64> {
    let slanted = incidences.iter().filter(|i| i.p.length() > NORMAL);
    // Of the direction to the light, as the files have it.
    slanted.map(|i| (-i.p.y).atan2(-i.p.x).to_degrees().rem_euclid(360.0)).collect()
}

fn apart_deg(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(360.0);
    turn.min(360.0 - turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(azimuths_deg: &[f64]) -> Vec<Incidence> {
        let point = |a: &f64| -DVec2::from_angle(a.to_radians()) * 0.5;
        let slanted =
            azimuths_deg.iter().map(|a| Incidence { p: point(a), points: vec![(DVec2::X * 0.1, 1.0)] });
        std::iter::once(Incidence { p: DVec2::ZERO, points: Vec::new() }).chain(slanted).collect()
    }

    #[test]
    fn azimuths_tell_the_symmetry_as_the_manual_of_pabopto2bsdf_says() {
        let cases: [(&[f64], Symmetry); 7] = [
            (&[180.0, 180.2], Symmetry::Isotropic),
            (&[0.0, 45.0, 90.0], Symmetry::Quadrilateral),
            (&[280.0, 350.0], Symmetry::Quadrilateral),
            (&[0.0, 90.0, 180.0], Symmetry::Bilateral { left_right: false }),
            (&[270.0, 0.0, 90.0], Symmetry::Bilateral { left_right: true }),
            (&[100.0, 260.0], Symmetry::Bilateral { left_right: true }),
            (&[0.0, 90.0, 180.0, 270.0], Symmetry::Anisotropic),
        ];
        for (azimuths, expected) in cases {
            assert_eq!(Symmetry::find(&at(azimuths)), expected, "{azimuths:?}");
        }
        assert!(Symmetry::named("anisotropic", &at(&[0.0, 90.0])).is_err());
        assert!(Symmetry::named("isotropic", &at(&[0.0, 90.0])).is_ok());
    }

    #[test]
    fn mirrored_incidences_have_mirrored_readings() {
        let all = Symmetry::Quadrilateral.completed(&at(&[20.0]));
        // The normal one is its own mirror image.
        assert_eq!(all.len(), 5);
        for i in &all[1..] {
            assert_eq!(i.points[0].0.x > 0.0, i.p.x < 0.0);
        }
        let [mean] = &Symmetry::Isotropic.completed(&at(&[20.0, 70.0])[1..])[..] else {
            panic!("one incidence")
        };
        assert_eq!(mean.points.len(), 4);
    }
}
