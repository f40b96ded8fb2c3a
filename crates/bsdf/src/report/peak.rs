//! What the split makes of one side.

use super::{Range, azimuths, on_side};
use crate::{
    bsdf::{Bsdf, Mode},
    incident::Incident,
    kernel::TENTH_WIDTH,
    peak::{ColumnPeak, NARROWEST, PeakRule, find_instrument},
    proposal::Oriented,
    table::Table,
};
use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Vec3, luminance};

/// Step of theta [deg] at which T is given, up to grazing.
pub const THROUGH_STEP_DEG: f64 = 5.0;

/// Azimuths at which T of an anisotropic table is given.
pub const THROUGH_AZIMUTHS: usize = 8;

/// Step of the search for the angles between which the peak is taken [deg].
const SEARCH_STEP_DEG: f64 = 0.5;

/// What the split does on one side.
#[derive(Clone, Debug, PartialEq)]
pub struct PeakReport {
    /// Rays meet the frame's front.
    pub front: bool,
    /// Columns of the table.
    pub columns: usize,
    /// Columns in which a peak was taken.
    pub columns_with_peak: usize,
    /// Share of the incidences (by projected solid angle) where it is taken.
    pub share_of_incidences: f64,
    /// Through transmittance at normal incidence [-]: the openness factor of a fabric.
    pub openness: f64,
    /// Lowest and highest openness that the data allow [-].
    pub openness_interval: [f64; 2],
    /// What a peak at normal incidence must exceed to be taken [-].
    pub detection_limit: f64,
    /// Share of the transmitted flux that is extracted, diffuse incidence.
    pub extracted_share_diffuse: f64,
    /// The same at normal incidence.
    pub extracted_share_normal: f64,
    /// Flux of the peak over the flux of the surround in its cells: least and median over columns with a peak; may be infinite.
    pub contrast: Option<Contrast>,
    /// The narrowest lobe that this basis can tell from a delta at normal incidence: full width at tenth maximum [deg].
    pub narrowest_lobe_deg: f64,
    /// Least and largest such width over the columns with a peak; over all columns where there is none.
    pub narrowest_lobe_range_deg: [f64; 2],
    /// Least and largest angle from this side's normal at which the peak is taken [deg].
    pub taken_between_deg: Option<[f64; 2]>,
    /// The largest angle, by azimuth: its least and its largest value [deg].
    pub last_angle_deg: Option<[f64; 2]>,
    /// Share of the directions between the first and the last angle of each azimuth in which it is taken: 1 without gaps.
    pub share_between: f64,
    /// Columns within which the peak ends: across a cut-off, or at grazing incidence. There T is open.
    pub columns_at_edge: usize,
    /// Through transmittance by direction.
    pub through: Vec<ThroughReport>,
}

/// Least and median contrast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contrast {
    /// Least.
    pub min: f64,
    /// Median.
    pub median: f64,
}

/// Through transmittance in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThroughReport {
    /// Angle from this side's normal [deg].
    pub theta_deg: f64,
    /// Azimuth towards which the ray runs [deg].
    pub phi_deg: f64,
    /// Luminous [-].
    pub through: f64,
    /// What the data allow [-].
    pub interval: [f64; 2],
}

impl Bsdf {
    /// What the split does for rays that meet one side; none if nothing is transmitted.
    pub fn peak_report(&self, front: bool) -> Option<PeakReport> {
        let oriented = self.distribution(on_side(front, 0.0, 0.0), Mode::Transmission)?;
        let d = &oriented.distribution;
        let incident = Incident::all(oriented, front);
        let found: Vec<ColumnPeak> = d.split().columns().collect();
        let taken = |c: &&Incident| luminance(found[c.column].through) > 0.0;
        let with_peak: Vec<&Incident> = incident.iter().filter(taken).collect();
        let area = |columns: &[&Incident]| columns.iter().fold(0.0, |sum, c| sum + c.projected_solid_angle);
        let normal = on_side(front, 0.0, 0.0);
        let own = found[d.columns().index(DVec2::ZERO)];
        let lobes = |columns: &mut dyn Iterator<Item = &Incident>| {
            Range::of(columns.map(|c| narrowest_lobe_deg(oriented, c.w_in)))
        };
        let lobe_range = if with_peak.is_empty() {
            lobes(&mut incident.iter())
        } else {
            lobes(&mut with_peak.iter().copied())
        };
        let reach = self.reach(front);
        let openness = luminance(self.through(normal, PeakRule::Split));
        let hemispherical = self.hemispherical_luminous(normal, Mode::Transmission);
        Some(PeakReport {
            front,
            columns: incident.len(),
            columns_with_peak: with_peak.len(),
            share_of_incidences: area(&with_peak) / PI,
            openness,
            openness_interval: interval(oriented, normal),
            detection_limit: own.detection_limit,
            extracted_share_diffuse: self.extracted_share(oriented, front),
            extracted_share_normal: if hemispherical > 0.0 { openness / hemispherical } else { 0.0 },
            contrast: contrast(with_peak.iter().map(|c| found[c.column].contrast).collect()),
            narrowest_lobe_deg: narrowest_lobe_deg(oriented, normal),
            narrowest_lobe_range_deg: [lobe_range.min, lobe_range.max],
            taken_between_deg: reach.taken_between_deg,
            last_angle_deg: reach.last_angle_deg,
            share_between: reach.share_between,
            columns_at_edge: with_peak.iter().filter(|c| at_edge(oriented, c.column)).count(),
            through: self.through_grid(oriented, front),
        })
    }

    /// Full width at half maximum [deg] of a lobe of constant angular width that follows the straight direction at a side, as an
    /// instrument's would; none if there is none. Takes a second or so.
    pub fn instrument_seen(&self, front: bool) -> Option<f64> {
        let d = &self.distribution(on_side(front, 0.0, 0.0), Mode::Transmission)?.distribution;
        find_instrument(d.luminous(), d.columns())
    }

    /// Lowest and highest luminous through transmittance [-] that the data allow at `w_in`, by the split.
    pub fn through_interval(&self, w_in: Vec3) -> [f64; 2] {
        self.distribution(w_in, Mode::Transmission).map_or([0.0; 2], |o| interval(o, w_in))
    }

    fn through_grid(&self, oriented: &Oriented, front: bool) -> Vec<ThroughReport> {
        let isotropic = oriented.distribution.luminous().is_isotropic();
        let azimuths = if isotropic { 1 } else { THROUGH_AZIMUTHS };
        let steps = (90.0 / THROUGH_STEP_DEG) as usize;
        let at = |theta_deg: f64, phi_deg: f64| {
            let w_in = on_side(front, theta_deg, phi_deg);
            let through = luminance(self.through(w_in, PeakRule::Split));
            ThroughReport { theta_deg, phi_deg, through, interval: interval(oriented, w_in) }
        };
        (0..steps)
            .flat_map(|i| {
                (0..azimuths).map(move |k| (i as f64 * THROUGH_STEP_DEG, 360.0 * k as f64 / azimuths as f64))
            })
            .map(|(theta, phi)| at(theta, phi))
            .collect()
    }

    /// Straight flux over all transmitted flux under diffuse light.
    fn extracted_share(&self, oriented: &Oriented, front: bool) -> f64 {
        let found: Vec<ColumnPeak> = oriented.distribution.split().columns().collect();
        let isotropic = oriented.distribution.luminous().is_isotropic();
        let (mut straight, mut all) = (0.0, 0.0);
        for c in Incident::all(oriented, front) {
            // A column's T is its mean over the column, in isotropic tables over the radius: by area it is another.
            let through = if isotropic {
                let points = ring_points(&c, front);
                Range::of(points.map(|w| luminance(self.through(w, PeakRule::Split)))).mean
            } else {
                luminance(found[c.column].through)
            };
            straight += c.projected_solid_angle * through;
            all += c.projected_solid_angle * self.hemispherical_luminous(c.w_in, Mode::Transmission);
        }
        if all > 0.0 { straight / all } else { 0.0 }
    }

    fn reach(&self, front: bool) -> Reach {
        let steps = (90.0 / SEARCH_STEP_DEG) as usize;
        let taken =
            |theta: f64, phi: f64| luminance(self.through(on_side(front, theta, phi), PeakRule::Split)) > 0.0;
        let (mut first, mut last, mut inside, mut total) = (f64::INFINITY, Vec::new(), 0.0, 0.0);
        for phi in azimuths() {
            let all: Vec<usize> =
                (0..steps).filter(|&i| taken((i as f64 + 0.5) * SEARCH_STEP_DEG, phi)).collect();
            if let (Some(&low), Some(&high)) = (all.first(), all.last()) {
                first = first.min(low as f64 * SEARCH_STEP_DEG);
                last.push((high + 1) as f64 * SEARCH_STEP_DEG);
                inside += all.len() as f64;
                total += (high - low + 1) as f64;
            } else {
                last.push(0.0);
            }
        }
        let range = Range::of(last.into_iter());
        let any = total > 0.0;
        Reach {
            taken_between_deg: any.then_some([first, range.max]),
            last_angle_deg: any.then_some([range.min, range.max]),
            share_between: if any { inside / total } else { 0.0 },
        }
    }
}

fn at_edge(oriented: &Oriented, column: usize) -> bool {
    let columns = oriented.distribution.columns();
    oriented.distribution.split().is_edge(columns, columns.point(column, [0.5, 0.5]))
}

/// Between which angles the peak is taken.
struct Reach {
    taken_between_deg: Option<[f64; 2]>,
    last_angle_deg: Option<[f64; 2]>,
    share_between: f64,
}

/// Full width at tenth maximum [deg] of the narrowest lobe around `-w_in` that the basis can tell from a delta: so many cells
/// that they take up as much solid angle as a square of this width.
fn narrowest_lobe_deg(oriented: &Oriented, w_in: Vec3) -> f64 {
    let straight = -w_in.truncate();
    let (a, b) = oriented.points(straight, straight);
    // The exiting cell's own size; isotropic tables have it beside the x axis.
    let area = exiting_area(oriented.distribution.luminous(), a, b);
    let width = (area / w_in.z.abs().max(f64::MIN_POSITIVE)).sqrt();
    (TENTH_WIDTH * NARROWEST * width).to_degrees()
}

/// Projected solid angle [sr] of the exiting cell at a pair of points.
fn exiting_area(table: &Table, p_in: DVec2, p_out: DVec2) -> f64 {
    match table {
        Table::Matrix(m) => m.exiting.projected_solid_angle(m.exiting.index(p_out)),
        Table::Tree(_) => table.projected_solid_angle(p_in, p_out),
    }
}

fn interval(oriented: &Oriented, w_in: Vec3) -> [f64; 2] {
    let straight = -w_in.truncate();
    let (a, _) = oriented.points(straight, straight);
    oriented.distribution.split().interval(oriented.distribution.columns(), a)
}

fn contrast(mut values: Vec<f64>) -> Option<Contrast> {
    values.sort_by(f64::total_cmp);
    let min = *values.first()?;
    Some(Contrast { min, median: values[values.len() / 2] })
}

/// Directions of a ring that stand for equal areas of it.
fn ring_points(c: &Incident, front: bool) -> impl Iterator<Item = Vec3> {
    const POINTS: usize = 16;
    let [a, b] = c.theta_bounds_deg.map(|deg| deg.to_radians().sin().powi(2));
    (0..POINTS).map(move |i| {
        let sin2 = a + (b - a) * (i as f64 + 0.5) / POINTS as f64;
        let height = (1.0 - sin2).sqrt();
        Vec3::new(sin2.sqrt(), 0.0, if front { height } else { -height })
    })
}
