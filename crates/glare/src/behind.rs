//! What lies behind a sun: the luminance of its pixels without it.

use crate::field::Field;
use std::collections::{BTreeMap, BTreeSet};
use sunpeak_core::LUMINOUS_EFFICACY;

/// An eight-bit mantissa (RGBE) holds a pixel to this share of its largest channel: what is left of a pixel after a sun was
/// taken out is known no better.
const PIXEL_PRECISION: f64 = 1.0 / 128.0;

/// A pixel that lacks more than this many times its precision was not made with the source as it is stated.
const LARGEST_LACK: f64 = 2.0;

/// How far a resampled sun may have spread [pixels].
const SPREAD: usize = 2;

/// Widest ring of pixels around a sun that is searched for what may lie behind it [pixels].
const WIDEST_RING: usize = 12;

/// How well the pixels and the stated sources go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fit {
    /// Each pixel holds what the sources put there.
    Good,
    /// Some hold clearly less: resampled, blurred or changed since.
    Poor,
}

/// Take luminances [cd/m²] out of pixels (indices of the picture). Where no more is left than the pixel's own precision the pixels
/// around say what lies behind. If the fit is poor they say so for all pixels that a resampled sun may have reached.
pub(crate) fn uncover(field: &mut Field, removed: &BTreeMap<usize, f64>) -> Fit {
    let mut unknown = BTreeSet::new();
    let mut fit = Fit::Good;
    for (&index, &taken) in removed {
        let largest = field.picture.pixels[index].iter().fold(0.0_f32, |a, &b| a.max(b));
        let precision = LUMINOUS_EFFICACY * f64::from(largest) * PIXEL_PRECISION;
        let left = field.luminance(index) - taken;
        if left < -LARGEST_LACK * precision {
            fit = Fit::Poor;
        }
        if left <= precision {
            unknown.insert(index);
        }
        field.changed.insert(index, left.max(0.0));
    }
    if fit == Fit::Poor {
        unknown = reach(field, removed);
    }
    fill(field, removed, &unknown);
    fit
}

/// The covered pixels and those near them.
fn reach(field: &Field, removed: &BTreeMap<usize, f64>) -> BTreeSet<usize> {
    let near = |&index: &usize| (0..=SPREAD).flat_map(move |radius| ring(field, index, radius));
    removed.keys().flat_map(near).filter(|&index| field.pixel(index).is_some()).collect()
}

/// Give the unknown pixels the mean of the nearest ring of pixels that no sun reaches.
fn fill(field: &mut Field, removed: &BTreeMap<usize, f64>, unknown: &BTreeSet<usize>) {
    let is_clear = |index: &usize| !removed.contains_key(index) && !unknown.contains(index);
    let around = |index: usize| {
        (1..=WIDEST_RING).find_map(|radius| {
            let clear: Vec<f64> = ring(field, index, radius)
                .filter(is_clear)
                .filter_map(|index| field.pixel(index))
                .map(|pixel| pixel.luminance_cd_m2)
                .collect();
            (!clear.is_empty()).then(|| clear.iter().sum::<f64>() / clear.len() as f64)
        })
    };
    let behind: Vec<_> = unknown.iter().filter_map(|&i| around(i).map(|luminance| (i, luminance))).collect();
    field.changed.extend(behind);
}

/// Indices of the pixels at exactly `radius` columns or rows from a pixel.
fn ring(field: &Field, index: usize, radius: usize) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (field.width, field.height);
    let (column, row) = (index % width, index / width);
    let columns = column.saturating_sub(radius)..=(column + radius).min(width - 1);
    let rows = row.saturating_sub(radius)..=(row + radius).min(height - 1);
    rows.flat_map(move |r| columns.clone().map(move |c| (r, c)))
        .filter(move |&(r, c)| r.abs_diff(row).max(c.abs_diff(column)) == radius)
        .map(move |(r, c)| r * width + c)
}
