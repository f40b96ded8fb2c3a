//! Predicted glare sensation vote, for windows: 0 just perceptible, 1 just acceptable, 2 just uncomfortable, 3 just intolerable.

use super::Seen;

/// `PGSV = log10(L^3.2 omega^-0.64 / Lb^(0.61 - 0.79 log10 omega)) - 8.2` (Tokura, Iwata and Shukuya 1996, "Experimental study on
/// discomfort glare caused by windows, part 3", Journal of Architecture, Planning and Environmental Engineering 489; Iwata and Tokura
/// 1998, Lighting Research & Technology 30(2)).
///
/// The window is what glares: `omega` is the solid angle of all sources together, `L` their mean luminance, `Lb` the mean luminance of
/// the rest of the field of view. It was fitted for one window. `None` without sources, or if they fill the view.
pub(crate) fn contrast_vote(seen: &Seen) -> Option<f64> {
    let background = seen.surround_luminance_cd_m2?;
    let solid_angle: f64 = seen.sources.iter().map(|s| s.solid_angle_sr).sum();
    let flux: f64 = seen.sources.iter().map(|s| s.luminance_cd_m2 * s.solid_angle_sr).sum();
    if solid_angle <= 0.0 {
        return None;
    }
    let background_exponent = 0.61 - 0.79 * solid_angle.log10();
    Some(
        3.2 * (flux / solid_angle).log10()
            - 0.64 * solid_angle.log10()
            - background_exponent * background.log10()
            - 8.2,
    )
}

/// Vote in bright scenes, where contrast counts no more: from -0.57 to 3.3, `PGSV = 3.3 - 3.87 / (1 + (La / 1250)^1.7)`, with the
/// adaptation luminance `La = Ev / pi` (the saturation term that goes with the contrast term; its constants are those that evalglare
/// 3.06 shows over 480 to 9000 lx).
pub(crate) fn saturation_vote(seen: &Seen) -> f64 {
    let (lowest, highest, middle, steepness) = (-0.57, 3.3, 1250.0, 1.7);
    let adaptation: f64 = seen.ev_lux / std::f64::consts::PI;
    highest - (highest - lowest) / (1.0 + (adaptation / middle).powf(steepness))
}

#[cfg(test)]
mod tests {
    use super::super::testing::blind;
    use super::*;

    /// What evalglare 3.06 prints for a mask over one round window: solid angle, luminance, rest of the view, Ev; both votes.
    #[test]
    fn agrees_with_evalglare_on_one_window() {
        for (solid_angle, luminance, rest, ev, contrast, saturation) in [
            (0.095306, 3009.437456, 200.675781, 860.517, 0.323063, -0.297603),
            (0.378939, 3009.437456, 200.675781, 1524.393, 1.029826, 0.075412),
            (0.378939, 6018.874912, 499.242187, 3325.161, 1.619884, 1.093197),
            (0.842113, 2500.406250, 998.484375, 4158.779, 0.714974, 1.459249),
        ] {
            let mut seen = blind();
            seen.sources.truncate(1);
            seen.sources[0].solid_angle_sr = solid_angle;
            seen.sources[0].luminance_cd_m2 = luminance;
            seen.surround_luminance_cd_m2 = Some(rest);
            seen.ev_lux = ev;
            let found = contrast_vote(&seen).expect("a source and a background");
            assert!((found - contrast).abs() < 1e-3, "{found} {contrast}");
            assert!(
                (saturation_vote(&seen) - saturation).abs() < 1e-3,
                "{} {saturation}",
                saturation_vote(&seen)
            );
        }
    }
}
