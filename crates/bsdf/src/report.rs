//! What a BSDF is and does: resolution, energy, reciprocity, and what peak extraction makes of it.
//!
//! Numbers only; the words are the caller's. Directions are `w_in`: the side of the traced ray, theta from the front normal.

use crate::{
    basis::AngleBasis,
    bsdf::{Bsdf, Mode},
    incident::Incident,
    peak::{NARROWEST, PeakRule},
    proposal::Oriented,
    table::Table,
};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;
use sunpeak_core::{Vec3, luminance, warp::cosine_hemisphere, warp::square_to_disk};

/// Angles of incidence [deg] at which hemispherical values are given.
pub const HEMISPHERICAL_THETA_DEG: [f64; 9] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];

/// Step of theta [deg] at which T is given, up to grazing.
pub const THROUGH_STEP_DEG: f64 = 5.0;

/// Azimuths at which T of an anisotropic table is given.
pub const THROUGH_AZIMUTHS: usize = 8;

/// Azimuths over which means are taken: every 5 degrees, beside the borders of cells that lie at multiples of 2.5.
const AZIMUTHS: usize = 72;
const OFF_BORDER_DEG: f64 = 1.1;

/// Step of the search for the angles between which the peak is taken [deg].
const SEARCH_STEP_DEG: f64 = 0.5;

/// Pairs of directions for the check of reciprocity.
const PAIRS: usize = 1 << 14;

/// Full width at tenth maximum of a Gaussian over its standard deviation: 2 sqrt(2 ln 10).
const TENTH_WIDTH: f64 = 4.291_932_052_578;

/// A report on a BSDF.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What rays meet.
    pub tables: Vec<TableReport>,
    /// Front, back.
    pub sides: Vec<SideReport>,
    /// Smooth parts and peaks, one direction against the other.
    pub reciprocity: Vec<Reciprocity>,
    /// Peak extraction by the split; one for each side that transmits.
    pub peaks: Vec<PeakReport>,
}

/// One table as rays meet it.
#[derive(Clone, Debug, PartialEq)]
pub struct TableReport {
    /// Reflection or transmission.
    pub mode: Mode,
    /// Met by rays at the frame's front.
    pub front: bool,
    /// Name of the basis.
    pub basis: String,
    /// Incident cells, the finest division.
    pub columns: usize,
    /// Number of values.
    pub values: usize,
    /// Smallest projected solid angle [sr].
    pub smallest_cell_sr: f64,
    /// Width of the smallest exiting cell [deg]: the square root of its solid angle.
    pub smallest_cell_deg: f64,
    /// The same for all azimuths of incidence.
    pub isotropic: bool,
    /// Has CIE X and Z.
    pub colored: bool,
    /// Serves this side by reciprocity: the table is the other side's.
    pub by_reciprocity: bool,
}

/// Hemispherical values of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct SideReport {
    /// Rays meet the frame's front.
    pub front: bool,
    /// By angle of incidence.
    pub angles: Vec<HemisphericalReport>,
    /// Largest transmittance plus reflectance [-].
    pub largest_sum: f64,
    /// Where: theta, phi [deg].
    pub largest_sum_at_deg: [f64; 2],
    /// Share of the incidences (by projected solid angle) where the sum is above 1.
    pub share_above_one: f64,
}

/// At one angle of incidence: means over azimuth, and their range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HemisphericalReport {
    /// Angle from this side's normal [deg].
    pub theta_deg: f64,
    /// Hemispherical transmittance [-], peak included.
    pub transmittance: Range,
    /// Hemispherical reflectance [-].
    pub reflectance: Range,
}

/// Mean, least and largest of some values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// Mean.
    pub mean: f64,
    /// Least.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

impl Range {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut n, mut min, mut max) = (0.0, 0.0, f64::INFINITY, f64::NEG_INFINITY);
        for v in values {
            (sum, n, min, max) = (sum + v, n + 1.0, min.min(v), max.max(v));
        }
        if n > 0.0 { Self { mean: sum / n, min, max } } else { Self::default() }
    }
}

/// What is compared in a check of reciprocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compared {
    /// BTDF from the front against BTDF from the back, without the peak.
    Transmission,
    /// Through transmittance from the front at `w` against that from the back at `-w`.
    Through,
    /// BRDF of the front with its directions swapped.
    ReflectionFront,
    /// BRDF of the back with its directions swapped.
    ReflectionBack,
}

/// One check of reciprocity (Helmholtz).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reciprocity {
    /// What.
    pub compared: Compared,
    /// Sum of the differences over the sum of the larger values [-], by projected solid angle: 0 to 1.
    pub mean_difference: f64,
    /// Largest difference [-] over the larger value, or over the mean of the larger values where that is more.
    pub largest_difference: f64,
    /// Where: theta, phi of `w_in`, then of `w_out` [deg].
    pub largest_at_deg: [f64; 4],
    /// One table serves both directions.
    pub by_construction: bool,
}

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
    /// Azimuth of `w_in` [deg].
    pub phi_deg: f64,
    /// Luminous [-].
    pub through: f64,
    /// What the data allow [-].
    pub interval: [f64; 2],
}

/// Direction on a side: theta from its normal, phi from x [deg].
fn on_side(front: bool, theta_deg: f64, phi_deg: f64) -> Vec3 {
    let ((st, ct), (sp, cp)) = (theta_deg.to_radians().sin_cos(), phi_deg.to_radians().sin_cos());
    Vec3::new(st * cp, st * sp, if front { ct } else { -ct })
}

/// Theta from the front normal and phi from 0 to 360 [deg].
fn angles(w: Vec3) -> [f64; 2] {
    let theta = w.z.clamp(-1.0, 1.0).acos().to_degrees();
    [theta, w.truncate().to_angle().to_degrees().rem_euclid(360.0)]
}

fn azimuths() -> impl Iterator<Item = f64> {
    (0..AZIMUTHS).map(|i| OFF_BORDER_DEG + 360.0 * i as f64 / AZIMUTHS as f64)
}

impl Bsdf {
    /// Look at all of it. Takes one pass over the tables, and makes what sampling needs.
    pub fn report(&self) -> Report {
        let sides = [true, false];
        let tables = [Mode::Transmission, Mode::Reflection]
            .into_iter()
            .flat_map(|mode| sides.into_iter().filter_map(move |front| self.table_report(mode, front)));
        Report {
            tables: tables.collect(),
            sides: sides.map(|front| self.side_report(front)).to_vec(),
            reciprocity: self.reciprocity(),
            peaks: sides.into_iter().filter_map(|front| self.peak_report(front)).collect(),
        }
    }

    fn table_report(&self, mode: Mode, front: bool) -> Option<TableReport> {
        let oriented = self.distribution(on_side(front, 0.0, 0.0), mode)?;
        let d = &oriented.distribution;
        let table = d.luminous();
        Some(TableReport {
            mode,
            front,
            basis: table.basis_name(),
            columns: d.columns().len(),
            values: table.values().len(),
            smallest_cell_sr: d.smallest_projected_solid_angle(),
            smallest_cell_deg: smallest_cell(table).sqrt().to_degrees(),
            isotropic: table.is_isotropic(),
            colored: d.color().is_some(),
            by_reciprocity: mode == Mode::Transmission && oriented.reversed,
        })
    }

    fn hemispherical_luminous(&self, w_in: Vec3, mode: Mode) -> f64 {
        luminance(self.hemispherical_smooth(w_in, mode, PeakRule::Off))
    }

    fn side_report(&self, front: bool) -> SideReport {
        let at = |theta_deg: f64, mode: Mode| {
            Range::of(azimuths().map(|phi| self.hemispherical_luminous(on_side(front, theta_deg, phi), mode)))
        };
        let angles_of = HEMISPHERICAL_THETA_DEG.map(|theta_deg| HemisphericalReport {
            theta_deg,
            transmittance: at(theta_deg, Mode::Transmission),
            reflectance: at(theta_deg, Mode::Reflection),
        });
        let (mut largest, mut place, mut above, mut all) = (0.0, Vec3::Z, 0.0, 0.0);
        for incident in self.incidences(front) {
            let sum = [Mode::Transmission, Mode::Reflection]
                .map(|mode| self.hemispherical_luminous(incident.w_in, mode))
                .iter()
                .sum::<f64>();
            if sum > largest {
                (largest, place) = (sum, incident.w_in);
            }
            all += incident.projected_solid_angle;
            above += if sum > 1.0 { incident.projected_solid_angle } else { 0.0 };
        }
        SideReport {
            front,
            angles: angles_of.to_vec(),
            largest_sum: largest,
            largest_sum_at_deg: angles(place),
            share_above_one: if all > 0.0 { above / all } else { 0.0 },
        }
    }

    /// Columns of transmission and of reflection on a side.
    fn incidences(&self, front: bool) -> Vec<Incident> {
        let w_in = on_side(front, 0.0, 0.0);
        let of = |mode| self.distribution(w_in, mode).map_or(Vec::new(), |o| Incident::all(o, front));
        let mut all = of(Mode::Transmission);
        all.extend(of(Mode::Reflection));
        all
    }

    fn reciprocity(&self) -> Vec<Reciprocity> {
        let mut checks = Vec::new();
        let transmits = self.distribution(Vec3::Z, Mode::Transmission);
        if let (Some(front), Some(back)) = (transmits, self.distribution(-Vec3::Z, Mode::Transmission)) {
            let one_table = front.reversed || back.reversed;
            checks.push(self.compare(Compared::Transmission, one_table));
            checks.push(self.compare(Compared::Through, one_table));
        }
        for (front, compared) in [(true, Compared::ReflectionFront), (false, Compared::ReflectionBack)] {
            if self.distribution(on_side(front, 0.0, 0.0), Mode::Reflection).is_some() {
                checks.push(self.compare(compared, false));
            }
        }
        checks
    }

    fn compare(&self, compared: Compared, by_construction: bool) -> Reciprocity {
        let smooth = |a: Vec3, b: Vec3| luminance(self.evaluate_smooth(a, b, PeakRule::Split));
        let through = |w: Vec3| luminance(self.through(w, PeakRule::Split));
        let flip = |w: Vec3| Vec3::new(w.x, w.y, -w.z);
        let values: Vec<Compare> = self
            .pairs(compared)
            .into_par_iter()
            .map(|(a, b, weight)| {
                let [one, other] = match compared {
                    Compared::Transmission => [smooth(a, flip(b)), smooth(flip(b), a)],
                    Compared::Through => [through(a), through(-a)],
                    Compared::ReflectionFront => [smooth(a, b), smooth(b, a)],
                    Compared::ReflectionBack => [smooth(flip(a), flip(b)), smooth(flip(b), flip(a))],
                };
                Compare { a, b, weight, one, other }
            })
            .collect();
        let sum = |of: &dyn Fn(&Compare) -> f64| values.iter().fold(0.0, |s, x| s + x.weight * of(x));
        let (differences, larger) = (sum(&|x| (x.one - x.other).abs()), sum(&|x| x.one.max(x.other)));
        let mean = larger / sum(&|_| 1.0).max(f64::MIN_POSITIVE);
        let relative = |x: &Compare| {
            let scale = x.one.max(x.other).max(mean);
            if scale > 0.0 { (x.one - x.other).abs() / scale } else { 0.0 }
        };
        let largest = values.iter().max_by(|a, b| relative(a).total_cmp(&relative(b)));
        let (largest_difference, largest_at_deg) = largest.map_or((0.0, [0.0; 4]), |x| {
            let (w_in, w_out) = match compared {
                Compared::Transmission => (x.a, flip(x.b)),
                Compared::Through => (x.a, -x.a),
                Compared::ReflectionFront => (x.a, x.b),
                Compared::ReflectionBack => (flip(x.a), flip(x.b)),
            };
            let ([t, p], [u, q]) = (angles(w_in), angles(w_out));
            (relative(x), [t, p, u, q])
        });
        let mean_difference = if larger > 0.0 { differences / larger } else { 0.0 };
        Reciprocity { compared, mean_difference, largest_difference, largest_at_deg, by_construction }
    }

    /// Pairs of directions of the front with weights: the middles of all patches of a matrix, or points all over.
    fn pairs(&self, compared: Compared) -> Vec<(Vec3, Vec3, f64)> {
        let (w_in, mode) = match compared {
            Compared::Transmission | Compared::Through => (Vec3::Z, Mode::Transmission),
            Compared::ReflectionFront => (Vec3::Z, Mode::Reflection),
            Compared::ReflectionBack => (-Vec3::Z, Mode::Reflection),
        };
        match self.distribution(w_in, mode).map(|o| o.distribution.luminous()) {
            Some(Table::Matrix(m)) => {
                let middles = |basis: &AngleBasis, sign: f64| -> Vec<(Vec3, f64)> {
                    let middle = |p| {
                        let at = sign * basis.point(p, [0.5, 0.5]);
                        at.extend((1.0 - at.length_squared()).max(0.0).sqrt())
                    };
                    (0..basis.len()).map(|p| (middle(p), basis.projected_solid_angle(p))).collect()
                };
                let exits = middles(&m.exiting, 1.0);
                let all = middles(&m.incident, -1.0).into_iter();
                all.flat_map(|(a, v)| exits.iter().map(move |&(b, w)| (a, b, v * w))).collect()
            }
            _ => (0..PAIRS).map(pair).map(|[a, b]| (a, b, 1.0)).collect(),
        }
    }

    /// What the split does for rays that meet one side; none if nothing is transmitted.
    pub fn peak_report(&self, front: bool) -> Option<PeakReport> {
        let oriented = self.distribution(on_side(front, 0.0, 0.0), Mode::Transmission)?;
        let d = &oriented.distribution;
        let incident = Incident::all(oriented, front);
        let found = d.split().columns();
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
            through: self.through_grid(oriented, front),
        })
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
        let found = oriented.distribution.split().columns();
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

/// Values for a pair of directions, one way and the other.
struct Compare {
    a: Vec3,
    b: Vec3,
    weight: f64,
    one: f64,
    other: f64,
}

/// Between which angles the peak is taken.
struct Reach {
    taken_between_deg: Option<[f64; 2]>,
    last_angle_deg: Option<[f64; 2]>,
    share_between: f64,
}

/// Solid angle [sr] of the smallest exiting cell.
fn smallest_cell(table: &Table) -> f64 {
    let mut smallest = f64::INFINITY;
    match table {
        Table::Matrix(m) => {
            let cosine = |deg: f64| deg.to_radians().cos();
            for ring in m.exiting.rings() {
                let whole = 2.0 * PI * (cosine(ring.lower_theta_deg) - cosine(ring.upper_theta_deg));
                smallest = smallest.min(whole / ring.phi_count as f64);
            }
        }
        Table::Tree(tree) => {
            let d = tree.rank() - 2;
            tree.for_each_leaf(|leaf| {
                let middle = [d, d + 1].map(|k| leaf.corner[k] + 0.5 * leaf.size);
                let height = (1.0 - DVec2::from(square_to_disk(middle)).length_squared()).sqrt();
                smallest = smallest.min(PI * leaf.size * leaf.size / height);
            });
        }
    }
    smallest
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

/// The i-th pair of directions on the front, uniform in projected solid angle: an additive recurrence in four dimensions
/// (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
fn pair(i: usize) -> [Vec3; 2] {
    /// The root of x^5 = x + 1.
    const PHI_4: f64 = 1.167_303_978_261_418_7;
    let at = |d: i32| (0.5 + i as f64 / PHI_4.powi(d)).fract();
    [cosine_hemisphere([at(1), at(2)]), cosine_hemisphere([at(3), at(4)])]
}
