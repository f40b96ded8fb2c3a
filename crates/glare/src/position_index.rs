//! How much a glare source matters by where it stands: Guth's position index.

use std::f64::consts::PI;
use sunpeak_core::Vec3;

/// Largest position index, as in evalglare: towards the top of the field of view the polynomial runs away from Guth's data.
const LARGEST: f64 = 16.0;

/// What heights below the line of sight are multiplied by ([`BelowSight::Evalglare3`]).
const HEIGHT_FACTOR: f64 = 1.15;

/// Model for sources below the line of sight, where Guth did not measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BelowSight {
    /// As [`Self::IwataOsterhaus`], with heights below the line of sight, in a plane across it, counted 1.15 times: what evalglare 3.06
    /// does, as its numbers for single sources all over the lower half of the field show (to 0.3 %).
    #[default]
    Evalglare3,
    /// As at the side, tau = 90 degrees: continuous at the height of the eyes (Iwata and Osterhaus 2010, "Assessment of
    /// discomfort glare in daylit offices using luminance distribution images", CIE x035).
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
    let head_up = up - sight * up.dot(sight);
    index_at(direction.angle_between(sight), angle_from(head_up, direction, sight), below)
}

/// The same with the angle to an up vector that need not be perpendicular to the line of sight (`-vu`): what evalglare 3.06 does. Where
/// the eye looks up or down, sources above it get a larger angle to the vertical, and so a lower index.
pub(crate) fn position_index_by_given_up(direction: Vec3, sight: Vec3, up: Vec3, below: BelowSight) -> f64 {
    index_at(direction.angle_between(sight), angle_from(up, direction, sight), below)
}

/// Angle between an up vector and a direction in the plane across the line of sight [rad].
fn angle_from(up: Vec3, direction: Vec3, sight: Vec3) -> f64 {
    let aside = direction - sight * direction.dot(sight);
    let is_on_axis = aside.length_squared() < 1e-24 || up.length_squared() < 1e-24;
    if is_on_axis { 0.0 } else { aside.angle_between(up) }
}

fn index_at(sigma: f64, tau: f64, below: BelowSight) -> f64 {
    let index = match below {
        _ if tau <= PI / 2.0 => guth(sigma, tau),
        BelowSight::Evalglare3 => guth(stretched_down(sigma, tau), PI / 2.0),
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

/// The angle from the line of sight when heights in a plane across it are multiplied.
fn stretched_down(sigma: f64, tau: f64) -> f64 {
    let (sin_tau, cos_tau) = tau.sin_cos();
    (sigma.sin() * sin_tau.hypot(HEIGHT_FACTOR * cos_tau)).atan2(sigma.cos())
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
        let osterhaus = position_index(low, Vec3::Y, Vec3::Z, BelowSight::IwataOsterhaus);
        assert!((osterhaus - index(towards(20.0, 0.0))).abs() < 1e-9);
        assert!(index(low) > osterhaus);
        assert!((index(towards(30.0, -1e-9)) - index(towards(30.0, 0.0))).abs() < 1e-6);
    }

    /// What `evalglare -d` 3.06 prints for sources in a picture with `-vd -0.6 -0.7 -0.3 -vu 0 0 1`.
    #[test]
    fn agrees_with_evalglare_where_the_eye_looks_down() {
        let sight = Vec3::new(-0.6, -0.7, -0.3).normalize();
        for (direction, expected) in [
            ([-0.068320, -0.931463, 0.357364], 6.186969),
            ([-0.432861, -0.895037, 0.107425], 2.407422),
            ([-0.766506, -0.614419, 0.186970], 2.878865),
        ] {
            let direction = Vec3::from_array(direction).normalize();
            let found = position_index_by_given_up(direction, sight, Vec3::Z, BelowSight::default());
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
            assert!(position_index(direction, sight, Vec3::Z, BelowSight::default()) > 1.02 * expected);
        }
    }

    /// What `evalglare -d` 3.06 prints for small discs: direction (right, ahead, up) and position index.
    #[test]
    fn agrees_with_evalglare_below_the_line_of_sight() {
        for (direction, expected) in [
            ([0.0581, 0.9977, -0.0361], 1.030537),
            ([0.6609, 0.6443, -0.3849], 2.403774),
            ([0.8523, 0.1743, -0.4932], 6.532462),
            ([0.2475, 0.8665, -0.4336], 1.548311),
            ([0.4695, 0.3401, -0.8148], 4.743033),
            ([-0.0015, 0.8647, -0.5023], 1.581027),
            ([-0.0011, 0.1735, -0.9848], 6.789197),
        ] {
            let found = index(Vec3::from_array(direction).normalize());
            assert!((found / expected - 1.0).abs() < 3e-3, "{direction:?}: {found}, {expected}");
        }
    }
}
