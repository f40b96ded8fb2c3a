//! Suns that the picture knows exactly: out of their pixels, and sources of their own.

use crate::field::Field;
use std::collections::BTreeMap;
use sunpeak_core::{LUMINOUS_EFFICACY, Vec3, luminance_cd_m2};
use sunpeak_scene::{ExactSource, Picture, disc_coverage};

/// An eight-bit mantissa (RGBE) holds a pixel to this share of its largest channel: what is left of a pixel after a sun was
/// taken out is known no better.
const PIXEL_PRECISION: f64 = 1.0 / 128.0;

/// Widest ring of pixels around a sun that is searched for what may lie behind it [pixels].
const WIDEST_RING: usize = 8;

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
pub(crate) fn take_out(
    field: &mut Field,
    picture: &Picture,
    warnings: &mut Vec<String>,
) -> Vec<VisibleSource> {
    let sources = &picture.exact_sources[..];
    if sources.is_empty() {
        return Vec::new();
    }
    let place = places(field);
    let mut removed = BTreeMap::new();
    let mut found = Vec::new();
    for source in sources {
        let covered = covered_pixels(field, source, &place);
        let Some(visible) = visible_part(field, source, &covered) else {
            warnings.push(outside(source));
            continue;
        };
        for &(i, share) in &covered {
            *removed.entry(i).or_insert(0.0) += visible.luminance_cd_m2 * source.visible_fraction * share;
        }
        found.push(visible);
    }
    if lacks_light(field, &removed) {
        warnings.push(
            "the pixels hold less light than the exact sources in the header say: was the picture changed since?".into(),
        );
    }
    subtract(field, picture, &removed, &place);
    found
}

/// Where each pixel of the picture stands in the field.
fn places(field: &Field) -> Vec<Option<usize>> {
    let mut place = vec![None; field.width * field.height];
    for (i, pixel) in field.pixels.iter().enumerate() {
        place[pixel.index] = Some(i);
    }
    place
}

/// The pixels (as positions in the field) that the source's disc covers, with their covered share.
fn covered_pixels(field: &Field, source: &ExactSource, place: &[Option<usize>]) -> Vec<(usize, f64)> {
    disc_coverage(field.view, field.width, field.height, source.direction, source.solid_angle_sr)
        .into_iter()
        .filter_map(|(index, share)| place[index].map(|i| (i, share)))
        .collect()
}

fn visible_part(field: &Field, source: &ExactSource, covered: &[(usize, f64)]) -> Option<VisibleSource> {
    let direction = source.direction.try_normalize()?;
    let solid_angle = |&(i, share): &(usize, f64)| share * field.pixels[i].solid_angle_sr;
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
        covered.iter().map(|part| solid_angle(part) * field.pixels[part.0].cosine).sum()
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

/// Do the pixels hold clearly less than what is to be taken out of them?
fn lacks_light(field: &Field, removed: &BTreeMap<usize, f64>) -> bool {
    let flux = |luminance: &dyn Fn(usize, f64) -> f64| -> f64 {
        removed.iter().map(|(&i, &taken)| luminance(i, taken) * field.pixels[i].solid_angle_sr).sum()
    };
    flux(&|i, _| field.pixels[i].luminance_cd_m2) < 0.95 * flux(&|_, taken| taken)
}

/// Take the luminances out. Where no more is left than the pixel's own uncertainty, the pixels around say what lies behind.
fn subtract(field: &mut Field, picture: &Picture, removed: &BTreeMap<usize, f64>, place: &[Option<usize>]) {
    let mut unknown = Vec::new();
    for (&i, &taken) in removed {
        let pixel = &mut field.pixels[i];
        let largest = picture.pixels[pixel.index].iter().fold(0.0_f32, |a, &b| a.max(b));
        let uncertainty = LUMINOUS_EFFICACY * f64::from(largest) * PIXEL_PRECISION;
        pixel.luminance_cd_m2 -= taken;
        if pixel.luminance_cd_m2 <= uncertainty {
            pixel.luminance_cd_m2 = pixel.luminance_cd_m2.max(0.0);
            unknown.push(i);
        }
    }
    let is_clear = |i: &usize| !removed.contains_key(i);
    let behind: Vec<_> = unknown.iter().map(|&i| mean_around(field, i, place, is_clear)).collect();
    for (i, luminance) in unknown.into_iter().zip(behind) {
        if let Some(luminance) = luminance {
            field.pixels[i].luminance_cd_m2 = luminance;
        }
    }
}

/// Mean luminance of the nearest ring around a pixel of the field that has usable pixels.
fn mean_around(
    field: &Field,
    i: usize,
    place: &[Option<usize>],
    is_usable: impl Fn(&usize) -> bool,
) -> Option<f64> {
    let index = field.pixels[i].index;
    let (column, row) = (index % field.width, index / field.width);
    (1..=WIDEST_RING).find_map(|radius| {
        let around: Vec<f64> = ring(column, row, radius, field.width, field.height)
            .filter_map(|index| place[index])
            .filter(&is_usable)
            .map(|i| field.pixels[i].luminance_cd_m2)
            .collect();
        (!around.is_empty()).then(|| around.iter().sum::<f64>() / around.len() as f64)
    })
}

/// Indices of the pixels at a distance of exactly `radius` columns or rows.
fn ring(
    column: usize,
    row: usize,
    radius: usize,
    width: usize,
    height: usize,
) -> impl Iterator<Item = usize> {
    let (rows, columns) =
        (row.saturating_sub(radius)..=row + radius, column.saturating_sub(radius)..=column + radius);
    rows.flat_map(move |r| columns.clone().map(move |c| (r, c)))
        .filter(move |&(r, c)| r < height && c < width && r.abs_diff(row).max(c.abs_diff(column)) == radius)
        .map(move |(r, c)| r * width + c)
}
