//! Suns that the picture knows exactly: out of their pixels, and sources of their own.

use crate::behind::{self, Fit};
use crate::field::{Field, FieldPixel};
use std::collections::BTreeMap;
use sunpeak_core::{Vec3, luminance_cd_m2};
use sunpeak_scene::{ExactSource, disc_coverage};

/// The part of an exact source that lies in the picture, in front of the eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VisibleSource {
    pub direction: Vec3,
    /// Of the part that is in view and not hidden [sr].
    pub solid_angle_sr: f64,
    pub luminance_cd_m2: f64,
    pub illuminance_lux: f64,
    pub pixels: usize,
}

/// Take the picture's exact sources out of the field's pixels. Overlapping ones are taken out together.
pub(crate) fn take_out(field: &mut Field, warnings: &mut Vec<String>) -> Vec<VisibleSource> {
    let sources = &field.picture.exact_sources[..];
    if sources.is_empty() {
        return Vec::new();
    }
    let mut removed = BTreeMap::new();
    let mut found = Vec::new();
    for source in sources {
        let covered = covered_pixels(field, source);
        let Some(visible) = visible_part(field, source, &covered) else {
            warnings.push(outside(source));
            continue;
        };
        for (pixel, share) in &covered {
            *removed.entry(pixel.index).or_insert(0.0) +=
                visible.luminance_cd_m2 * source.visible_fraction * share;
        }
        found.push(visible);
    }
    if behind::uncover(field, &removed) == Fit::Poor {
        warnings.push(
            "the pixels do not hold the exact sources that the header states (was the picture resampled or changed since?): the \
             sources count as stated, the pixels near them as those around"
                .into(),
        );
    }
    found
}

/// The pixels in front of the eye that the source's disc covers, with their covered share.
fn covered_pixels(field: &Field, source: &ExactSource) -> Vec<(FieldPixel, f64)> {
    disc_coverage(field.view, field.width, field.height, source.direction, source.solid_angle_sr)
        .into_iter()
        .filter_map(|(index, share)| field.pixel(index).map(|pixel| (pixel, share)))
        .collect()
}

fn visible_part(field: &Field, source: &ExactSource, covered: &[(FieldPixel, f64)]) -> Option<VisibleSource> {
    let direction = source.direction.try_normalize()?;
    let solid_angle = |(pixel, share): &(FieldPixel, f64)| share * pixel.solid_angle_sr;
    let in_view: f64 = covered.iter().map(solid_angle).sum();
    let luminance = luminance_cd_m2(source.radiance);
    let is_light = [in_view, luminance, source.visible_fraction].iter().all(|&v| v > 0.0 && v.is_finite());
    if !is_light {
        return None;
    }
    // A disc that is all in view counts with its own cosine, not with that of the pixels' centres.
    let is_whole = in_view > 0.999 * source.solid_angle_sr;
    let projected = if is_whole {
        source.solid_angle_sr * direction.dot(field.sight).max(0.0)
    } else {
        covered.iter().map(|part| solid_angle(part) * part.0.cosine).sum()
    };
    Some(VisibleSource {
        direction,
        solid_angle_sr: if is_whole { source.solid_angle_sr } else { in_view } * source.visible_fraction,
        luminance_cd_m2: luminance,
        illuminance_lux: luminance * projected * source.visible_fraction,
        pixels: covered.len(),
    })
}

fn outside(source: &ExactSource) -> String {
    let d = source.direction;
    format!(
        "the exact source towards {:.4} {:.4} {:.4} lies outside the picture or gives no light: left out",
        d.x, d.y, d.z
    )
}
