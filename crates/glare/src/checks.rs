//! Is the picture what it seems to be? What users of glare programs get wrong most, each with what to do.

use crate::field::Field;
use crate::report::Source;
use std::f64::consts::PI;
use sunpeak_scene::{Picture, ViewKind};

/// A sun of 0.533 degrees needs a picture of so many pixels across to be more than a few of them.
const LEAST_PIXELS_FOR_SUN: usize = 800;

/// A source that bright is the sun, or what is left of it behind a shade [cd/m²].
const SUN_CD_M2: f64 = 50_000.0;

/// Brighter than the sun outside the atmosphere, 2e9 cd/m² [cd/m²].
const BRIGHTER_THAN_SUN_CD_M2: f64 = 2.5e9;

/// Ev of a night scene [lx].
const NIGHT_LUX: f64 = 10.0;

/// Near the largest value of RGBE, 2^127.
const LARGEST_RGBE: f32 = 1.6e38;

/// So many pixels with the very same largest value are clipped in a photograph.
const CLIPPED_PIXELS: usize = 9;

/// Programs that render: their pictures have neither lenses nor sensors.
const RENDERERS: [&str; 7] = ["SUNPEAK_RENDER=", "rpict", "rtpict", "rvu", "rtrace", "rpiece", "rcontrib"];

/// Points across the field of view at which its rim is looked at.
const POINTS: usize = 400;

/// Warnings about a picture; where Ev was stated, not about what only Ev needs.
pub(crate) fn warnings(field: &Field, sources: &[Source], ev_lux: f64, is_ev_stated: bool) -> Vec<String> {
    let all = [
        projection(field).filter(|_| !is_ev_stated),
        exposure(field.picture, ev_lux),
        overflow(field.picture),
        small_picture(field, sources),
        clipped(field),
    ];
    all.into_iter().flatten().chain(rim(field)).collect()
}

fn projection(field: &Field) -> Option<String> {
    let fisheye = [ViewKind::AngularFisheye, ViewKind::HemisphericalFisheye, ViewKind::PlanisphericFisheye];
    (!fisheye.contains(&field.view.kind)).then(|| {
        let kind = field.view.kind.option();
        format!(
            "the view is {kind}, not a fisheye: Ev needs 180 degrees; expected -vta or -vth with -vh 180 -vv 180, or Ev stated"
        )
    })
}

fn exposure(picture: &Picture, ev_lux: f64) -> Option<String> {
    if let [first, .., last] = picture.exposures[..] {
        let count = picture.exposures.len();
        return Some(format!(
            "the header has {count} EXPOSURE lines ({first} … {last}): all were undone, as Radiance does; if one is a repetition, luminances are \
             wrong by that factor; compare a known luminance or Ev"
        ));
    }
    if ev_lux >= NIGHT_LUX {
        return None;
    }
    let lost = if picture.exposures.is_empty() {
        "; there is no EXPOSURE line: was it lost (pfilt, pcompos, pcomb)?"
    } else {
        ""
    };
    Some(format!("Ev of {ev_lux:.2} lx is that of a night scene{lost}"))
}

fn overflow(picture: &Picture) -> Option<String> {
    let largest = picture.pixels.iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
    let luminance = 179.0 * f64::from(largest);
    if largest > LARGEST_RGBE {
        return Some(
            "a pixel holds the largest value of RGBE: it overflowed, and its true value is lost".into(),
        );
    }
    (luminance > BRIGHTER_THAN_SUN_CD_M2).then(|| {
        format!("a pixel of {luminance:.2e} cd/m² is brighter than the sun: was an exposure undone twice, or a unit mistaken?")
    })
}

fn small_picture(field: &Field, sources: &[Source]) -> Option<String> {
    let (width, height) = (field.width, field.height);
    let sun = sources.iter().any(|source| !source.exact && source.luminance_cd_m2 > SUN_CD_M2);
    (sun && width.min(height) < LEAST_PIXELS_FOR_SUN).then(|| {
        format!(
            "{width} x {height} pixels with a sun in them: a disc of 0.533 degrees covers {:.0} pixels; use {LEAST_PIXELS_FOR_SUN} x {LEAST_PIXELS_FOR_SUN} or \
             more, or a picture that knows its suns (SUNPEAK_SOURCE=)",
            PI / 4.0 * (0.533 / field.view.horizontal_deg * width as f64).powi(2)
        )
    })
}

/// Has the picture been taken, not rendered? An empty header says nothing.
fn is_photograph(picture: &Picture) -> bool {
    let rendered = picture.header.iter().any(|line| RENDERERS.iter().any(|name| line.contains(name)));
    !picture.header.is_empty() && !rendered
}

fn clipped(field: &Field) -> Option<String> {
    let picture = field.picture;
    let largest = picture.pixels.iter().map(|p| p[1]).fold(0.0_f32, f32::max);
    if !is_photograph(picture) || 179.0 * largest < SUN_CD_M2 as f32 {
        return None;
    }
    let count = picture.pixels.iter().filter(|p| p[1] == largest).count();
    (count >= CLIPPED_PIXELS).then(|| {
        format!(
            "{count} pixels have the very same largest luminance, {:.3e} cd/m²: the photograph is clipped there, and DGP too low; take a \
             darker exposure or a filter, or compare Ev with a lux meter and state it",
            179.0 * largest
        )
    })
}

/// Mean luminance of rings around the line of sight, and whether all light ends before the rim.
fn rim(field: &Field) -> Vec<String> {
    let rings = Rings::of(field);
    let mut found = Vec::new();
    if let Some(edge) = rings.black_from() {
        found.push(format!(
            "the picture is black from {edge} degrees off the line of sight on: a border, or a view angle in the header that is not the \
             picture's; crop it to the circle and state the true -vh and -vv"
        ));
    } else if is_photograph(field.picture) && rings.fall_off() {
        found.push(
            "the photograph gets darker towards its rim on all sides: was the lens's vignetting corrected? Ev is too low otherwise".into(),
        );
    }
    found
}

/// Degrees in a ring.
const RING_DEG: usize = 3;
const RINGS: usize = 90 / RING_DEG;
const SECTORS: usize = 8;

/// Luminance by angle from the line of sight and by sector.
struct Rings {
    sums: [[f64; SECTORS]; RINGS],
    counts: [[u32; SECTORS]; RINGS],
}

impl Rings {
    fn of(field: &Field) -> Self {
        let mut rings = Self { sums: [[0.0; SECTORS]; RINGS], counts: [[0; SECTORS]; RINGS] };
        let stride = (field.width.min(field.height) / POINTS).max(1);
        for row in (0..field.height).step_by(stride) {
            for column in (0..field.width).step_by(stride) {
                if let Some(pixel) = field.pixel(row * field.width + column) {
                    let angle = pixel.direction.dot(field.sight).clamp(-1.0, 1.0).acos().to_degrees();
                    let (right, up) =
                        (column as f64 / field.width as f64 - 0.5, row as f64 / field.height as f64 - 0.5);
                    let sector = ((up.atan2(right) / (2.0 * PI) + 0.5) * SECTORS as f64) as usize % SECTORS;
                    let ring = (angle as usize / RING_DEG).min(RINGS - 1);
                    rings.sums[ring][sector] += pixel.luminance_cd_m2;
                    rings.counts[ring][sector] += 1;
                }
            }
        }
        rings
    }

    fn is_black(&self, ring: usize) -> bool {
        self.sums[ring].iter().sum::<f64>() <= 0.0
    }

    /// The angle [deg] from which on all is black, if that is before the rim and there is light inside.
    fn black_from(&self) -> Option<usize> {
        let is_there = |ring: &usize| self.counts[*ring].iter().sum::<u32>() > 0;
        let last = (0..RINGS).rev().find(is_there)?;
        let lit = (0..=last).rev().find(|&ring| !self.is_black(ring))?;
        (lit < last).then_some((lit + 1) * RING_DEG)
    }

    /// Does luminance fall to less than a third in each sector from the ring around 66 to that around 85 degrees?
    fn fall_off(&self) -> bool {
        let mean = |rings: std::ops::Range<usize>, sector: usize| {
            let sum: f64 = rings.clone().map(|ring| self.sums[ring][sector]).sum();
            let count: u32 = rings.map(|ring| self.counts[ring][sector]).sum();
            sum / f64::from(count.max(1))
        };
        (0..SECTORS).all(|sector| mean(27..30, sector) < mean(20..24, sector) / 3.0)
    }
}
