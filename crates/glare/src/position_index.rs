//! How much a glare source matters by where it stands: Guth's position index.

use std::f64::consts::PI;
use sunpeak_core::Vec3;

/// Largest position index, as in evalglare: towards the top of the field of view the polynomial runs away from Guth's data.
const LARGEST: f64 = 16.0;

/// Model for sources below the line of sight, where Guth did not measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BelowSight {
    /// As at the side, tau = 90 degrees: continuous at the height of the eyes (Iwata and Osterhaus 2010, "Assessment of
    /// discomfort glare in daylit offices using luminance distribution images", CIE x035). evalglare 3.06 is within 11 %.
    #[default]
    IwataOsterhaus,
    /// Iwata and Tokura 1997, "Position index for a glare source located below the line of vision", Lighting Research &
    /// Technology 29(3), in the form of Einhorn: 1 + 0.8 R/D, from R/D = 0.6 on 1 + 1.2 R/D.
    IwataTokura,
}

/// Position index [-] of a source towards `direction` for someone who looks along `sight` (unit vectors), head along `up`.
///
/// At and above the line of sight: Levin 1975, "Position index in VCP calculations", Journal of the IES 4(2), as in the IES Lighting
/// Handbook. 1 on the line of sight, never above 16.
pub fn position_index(direction: Vec3, sight: Vec3, up: Vec3, below: BelowSight) -> f64 {
    let sigma = direction.angle_between(sight);
    let aside = direction - sight * direction.dot(sight);
    let head_up = up - sight * up.dot(sight);
    let is_on_axis = aside.length_squared() < 1e-24 || head_up.length_squared() < 1e-24;
    let tau = if is_on_axis { 0.0 } else { aside.angle_between(head_up) };
    let index = match below {
        _ if tau <= PI / 2.0 => guth(sigma, tau),
        BelowSight::IwataOsterhaus => guth(sigma, PI / 2.0),
        BelowSight::IwataTokura => iwata_tokura(sigma),
    };
    index.clamp(1.0, LARGEST)
}

/// `sigma`: angle from the line of sight; `tau`: angle from the vertical in the plane across it [rad].
fn guth(sigma: f64, tau: f64) -> f64 {
    let (s, t) = (sigma.to_degrees(), tau.to_degrees());
    let linear = 35.2 - 0.31889 * t - 1.22 * (-2.0 * t / 9.0).exp();
    let square = 21.0 + 0.26667 * t - 0.002963 * t * t;
    (linear * 1e-3 * s + square * 1e-5 * s * s).exp()
}

fn iwata_tokura(sigma: f64) -> f64 {
    if sigma >= PI / 2.0 {
        return LARGEST;
    }
    let radius_over_distance = sigma.tan();
    let slope = if radius_over_distance < 0.6 { 0.8 } else { 1.2 };
    1.0 + slope * radius_over_distance
}

#[cfg(test)]
mod tests {
    use super::*;

    fn towards(right_deg: f64, up_deg: f64) -> Vec3 {
        // Looking north: right is east.
        let (right, up) = (right_deg.to_radians(), up_deg.to_radians());
        Vec3::new(right.sin() * up.cos(), right.cos() * up.cos(), up.sin())
    }

    fn index(direction: Vec3) -> f64 {
        position_index(direction, Vec3::Y, Vec3::Z, BelowSight::default())
    }

    /// What `evalglare -d` 3.06 prints for sources in two real pictures.
    #[test]
    fn agrees_with_evalglare_above_the_line_of_sight() {
        let window = Vec3::new(0.607436, 0.761906, 0.224770);
        assert!((index(window) / 2.545465 - 1.0).abs() < 1e-4);
        let lamp = Vec3::new(0.353150, 0.935562, 0.002825);
        assert!((index(lamp) / 1.255812 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn one_ahead_and_rising_to_every_side() {
        assert_eq!(index(Vec3::Y), 1.0);
        for aside in [towards(1.0, 0.0), towards(0.0, 1.0), towards(0.0, -1.0)] {
            assert!(index(aside) > 1.0 && index(aside) < 1.05);
        }
        assert!(index(towards(0.0, 60.0)) > index(towards(60.0, 0.0)), "up is less glaring than aside");
        assert_eq!(index(towards(0.0, 89.0)), 16.0);
    }

    #[test]
    fn left_equals_right_and_the_head_may_be_tilted() {
        assert!((index(towards(33.0, 20.0)) - index(towards(-33.0, 20.0))).abs() < 1e-12);
        let tilted = position_index(towards(0.0, 30.0), Vec3::Y, Vec3::X, BelowSight::default());
        assert!((tilted - index(towards(30.0, 0.0))).abs() < 1e-9);
    }

    #[test]
    fn below_by_either_model() {
        let low = towards(0.0, -20.0);
        let einhorn = position_index(low, Vec3::Y, Vec3::Z, BelowSight::IwataTokura);
        assert!((einhorn - (1.0 + 0.8 * 20.0_f64.to_radians().tan())).abs() < 1e-12);
        assert!((index(low) - index(towards(20.0, 0.0))).abs() < 1e-9);
    }
}
