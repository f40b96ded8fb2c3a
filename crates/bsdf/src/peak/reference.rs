//! Rules 1 ("paper", 2020/21) and 2 ("radiance", 2021-08 on): the peak judged from 29 look-ups at every hit.
//!
//! Facts of `m_bsdf.c`, revisions 2.61 and 2.62 on, written anew. Radiance tells cells apart by their (perturbed) value; here they
//! have an identity. Kept for comparison with the reference; the split is the default.

use super::PeakRule;
use crate::bsdf::{Bsdf, Mode};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Rgb, Vec3, gray, luminance};

/// A cell may join the peak up to this multiple of the smallest projected solid angle of the table.
const LARGEST_PEAK_CELL: f64 = 1.5;

/// … and while the running mean of the peak is at most this multiple of the cell's value.
const DIMMEST_PEAK_CELL: f64 = 8.0;

/// Rule 1: the peak's mean over the surround's (paper, Method).
const PAPER_CONTRAST: f64 = 1.5;

/// Least transmittance of a peak less its diffuse part [-], rules 1 and 2.
const LEAST_THROUGH: [f64; 2] = [0.001, 0.0005];

/// Rule 2: least projected solid angle of the surround over the peak's.
const LEAST_SURROUND: f64 = 0.2;

/// What a rule found at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencePeak {
    /// Through transmittance [-].
    pub through: Rgb,
    /// Mean BTDF of the surround without its diffuse part [1/sr].
    pub surround: Rgb,
    /// Diffuse (Lambertian) BTDF of this side [1/sr].
    pub diffuse: Rgb,
    smallest: f64,
}

/// The 29 offsets, in units of the search radius: the middle, square rings at 0.6, 1.2, 1.8, and 2.4 along the axes.
fn offsets() -> Vec<DVec2> {
    let mut offsets = vec![DVec2::ZERO];
    for ring in [0.6, 1.2, 1.8] {
        for (x, y) in [(-1, 0), (0, 1), (0, -1), (1, 0), (-1, 1), (-1, -1), (1, 1), (1, -1)] {
            offsets.push(ring * DVec2::new(f64::from(x), f64::from(y)));
        }
    }
    offsets.extend([DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y, DVec2::X].map(|axis| 2.4 * axis));
    offsets
}

/// The directions that are looked at around the straight one, for the smallest projected solid angle [sr] of the table.
pub fn probe(w_in: Vec3, smallest: f64) -> impl Iterator<Item = Vec3> {
    let radius = smallest.sqrt();
    offsets().into_iter().map(move |offset| (-w_in + radius * offset.extend(0.0)).normalize())
}

/// The peak that `rule` finds for a ray from `w_in`, if any.
pub fn peak(bsdf: &Bsdf, w_in: Vec3, rule: PeakRule) -> Option<ReferencePeak> {
    let oriented = bsdf.distribution(w_in, Mode::Transmission)?;
    let table = oriented.distribution.luminous();
    let smallest = oriented.distribution.smallest_projected_solid_angle();
    let mut seen: Vec<(usize, f64, Rgb)> = Vec::new(); // cell, projected solid angle, value
    for w in probe(w_in, smallest) {
        let (a, b) = oriented.points(-w_in.truncate(), w.truncate());
        let index = table.index(a, b);
        if seen.iter().all(|s| s.0 != index) {
            seen.push((index, table.projected_solid_angle(a, b), oriented.distribution.at_index(index)));
        }
    }
    seen.sort_by(|a, b| luminance(b.2).total_cmp(&luminance(a.2)));
    if luminance(seen[0].2) <= 0.0 {
        return None;
    }

    let (mut through, mut surround) = (Rgb::ZERO, Rgb::ZERO);
    let (mut peak_area, mut surround_area, mut sum, mut count) = (0.0, 0.0, 0.0, 0.0);
    for (i, &(_, area, value)) in seen.iter().enumerate() {
        let y = luminance(value);
        if area > LARGEST_PEAK_CELL * smallest || sum > DIMMEST_PEAK_CELL * y * count {
            if i == 0 {
                return None;
            }
            surround += area * value;
            surround_area += area;
        } else {
            through += area * value;
            peak_area += area;
            sum += y;
            count += 1.0;
        }
    }
    let diffuse = gray(oriented.distribution.diffuse());
    let mean = if surround_area > 0.0 { surround / surround_area } else { Rgb::ZERO };
    let less_diffuse = (through - peak_area * diffuse).max(Rgb::ZERO);
    let least = LEAST_THROUGH[usize::from(rule == PeakRule::Radiance)];
    let found = if rule == PeakRule::Radiance {
        surround_area >= LEAST_SURROUND * peak_area
    } else {
        luminance(through) / peak_area >= PAPER_CONTRAST * luminance(mean)
    };
    (found && luminance(less_diffuse) >= least).then_some(ReferencePeak {
        through: if rule == PeakRule::Radiance { less_diffuse } else { through },
        surround: (mean - diffuse).max(Rgb::ZERO),
        diffuse,
        smallest,
    })
}

/// The BSDF towards a light source: the surround's mean within the exclusion zone, the table outside it.
pub fn evaluate_to_source(bsdf: &Bsdf, w_in: Vec3, w_out: Vec3, solid_angle: f64, rule: PeakRule) -> Rgb {
    if (w_in.z > 0.0) != (w_out.z > 0.0)
        && let Some(peak) = peak(bsdf, w_in, rule)
    {
        let source = solid_angle * w_out.z.abs();
        let zone = 2.5 * 4.0 / PI * (source + peak.smallest + 2.0 * (source * peak.smallest).sqrt());
        if (w_in + w_out).truncate().length_squared() <= zone {
            return peak.surround + peak.diffuse;
        }
    }
    bsdf.evaluate(w_in, w_out)
}

/// Is a sample within the square root of the cell's projected solid angle of the straight direction?
pub fn is_muted_for_view(bsdf: &Bsdf, w_in: Vec3, w_out: Vec3, rule: PeakRule) -> bool {
    if (w_in.z > 0.0) == (w_out.z > 0.0) {
        return false;
    }
    let Some(oriented) = bsdf.distribution(w_in, Mode::Transmission) else { return false };
    let (a, b) = oriented.points(-w_in.truncate(), -w_in.truncate());
    let area = oriented.distribution.luminous().projected_solid_angle(a, b);
    (w_in + w_out).truncate().length_squared() <= area && peak(bsdf, w_in, rule).is_some()
}
