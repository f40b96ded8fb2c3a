//! Which pixels a disc in the sky covers, and how much of each.
//!
//! A renderer adds `radiance * visible fraction * share` to a pixel, a glare program takes exactly that out again: both
//! ask here, so that nothing is left over.

use crate::{Camera, View, ViewKind};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use sunpeak_core::{Frame, Vec3};

/// Points of the disc for each pixel that it covers: shares at its edge are then exact to about one per cent.
const POINTS_PER_PIXEL: f64 = 256.0;

/// Fewest points: a disc smaller than a pixel may still lie on the border of two.
const FEWEST_POINTS: usize = 4096;

/// Most points: past some ten thousand pixels the edge counts for little.
const MOST_POINTS: usize = 1 << 21;

/// The pixels that a disc of directions covers: index in [`crate::Picture::pixels`] (rising), and the share of the pixel's solid
/// angle that is covered.
///
/// The sum of share times [`View::pixel_solid_angle`] is the solid angle of the part of the disc that lies in the view. Shares in
/// the inside of a disc are 1. For `-vtl`, which has no solid angles, the result is empty.
pub fn disc_coverage(
    view: &View,
    width: usize,
    height: usize,
    direction: Vec3,
    solid_angle_sr: f64,
) -> Vec<(usize, f64)> {
    let Some(direction) = direction.try_normalize() else { return Vec::new() };
    let is_disc = solid_angle_sr > 0.0 && solid_angle_sr <= 4.0 * PI;
    if width == 0 || height == 0 || view.kind == ViewKind::Parallel || !is_disc {
        return Vec::new();
    }
    let Some(camera) = Camera::new(view) else { return Vec::new() };
    let grid = Grid { camera, width, height };
    let disc = Disc { frame: Frame::from_normal(direction), solid_angle_sr };
    let covered = grid.covered_solid_angles(&disc);
    grid.shares(&disc, &covered)
}

/// A cone of directions around the frame's z axis.
struct Disc {
    frame: Frame,
    solid_angle_sr: f64,
}

impl Disc {
    /// The `i`-th of `n` points that each stand for the same solid angle, on a sunflower spiral (Vogel 1979).
    fn point(&self, i: usize, n: usize) -> Vec3 {
        let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
        // 1 - cos(theta) is uniform in solid angle; sin(theta) from it without cancellation.
        let depth = self.solid_angle_sr / (2.0 * PI) * (i as f64 + 0.5) / n as f64;
        let sine = (depth * (2.0 - depth)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (golden_angle * i as f64).sin_cos();
        self.frame.to_world(Vec3::new(sine * cos_phi, sine * sin_phi, 1.0 - depth))
    }

    fn contains(&self, direction: Vec3) -> bool {
        // The squared chord from centre to edge is solid angle over pi, for a cone of any width.
        (direction - self.frame.z).length_squared() <= self.solid_angle_sr / PI
    }
}

/// The pixels of a view.
struct Grid {
    camera: Camera,
    width: usize,
    height: usize,
}

impl Grid {
    /// Solid angle of the disc in each pixel that it touches.
    fn covered_solid_angles(&self, disc: &Disc) -> BTreeMap<usize, f64> {
        let pixel = self.smallest_pixel_near(disc.frame.z).unwrap_or(disc.solid_angle_sr);
        let wanted = POINTS_PER_PIXEL * disc.solid_angle_sr / pixel;
        let n = (wanted.min(MOST_POINTS as f64) as usize).max(FEWEST_POINTS);
        let each = disc.solid_angle_sr / n as f64;
        let mut covered = BTreeMap::new();
        for index in (0..n).filter_map(|i| self.pixel_of(disc.point(i, n))) {
            *covered.entry(index).or_insert(0.0) += each;
        }
        covered
    }

    /// Shares, with 1 where the whole pixel lies in the disc; the others take what that moved.
    fn shares(&self, disc: &Disc, covered: &BTreeMap<usize, f64>) -> Vec<(usize, f64)> {
        let mut inner = 0.0;
        let mut edge = 0.0;
        let pixels: Vec<_> = covered
            .iter()
            .map(|(&index, &solid_angle)| {
                let whole = self.solid_angle(index);
                let is_inner = self.lies_in(index, disc);
                *(if is_inner { &mut inner } else { &mut edge }) +=
                    if is_inner { whole } else { solid_angle };
                (index, whole, solid_angle, is_inner)
            })
            .collect();
        let in_view: f64 = covered.values().sum();
        let correction = if edge > 0.0 { ((in_view - inner) / edge).max(0.0) } else { 1.0 };
        let share =
            |whole: f64, part: f64, is_inner: bool| if is_inner { 1.0 } else { part * correction / whole };
        pixels
            .into_iter()
            .filter(|&(_, whole, ..)| whole > 0.0)
            .map(|(index, whole, part, is_inner)| (index, share(whole, part, is_inner)))
            .collect()
    }

    fn solid_angle(&self, index: usize) -> f64 {
        let (column, row) = (index % self.width, index / self.width);
        self.camera.pixel_solid_angle(column, row, self.width, self.height)
    }

    fn pixel_of(&self, direction: Vec3) -> Option<usize> {
        let [x, y] = self.camera.project(direction)?;
        let in_picture = (0.0..1.0).contains(&x) && y > 0.0 && y <= 1.0;
        in_picture.then(|| {
            let column = ((x * self.width as f64) as usize).min(self.width - 1);
            let row = (((1.0 - y) * self.height as f64) as usize).min(self.height - 1);
            row * self.width + column
        })
    }

    /// Do all corners of the pixel lie in the disc? (As good as the whole pixel: both are convex.)
    fn lies_in(&self, index: usize, disc: &Disc) -> bool {
        let (column, row) = (index % self.width, index / self.width);
        [(0, 0), (0, 1), (1, 0), (1, 1)].iter().all(|&(right, down)| {
            let x = (column + right) as f64 / self.width as f64;
            let y = 1.0 - (row + down) as f64 / self.height as f64;
            self.camera.ray(x, y).is_some_and(|ray| disc.contains(ray.direction))
        })
    }

    /// Solid angle of the pixel that holds the direction; if it lies outside, of a typical pixel of the view.
    fn smallest_pixel_near(&self, direction: Vec3) -> Option<f64> {
        let index = self.pixel_of(direction).unwrap_or((self.height / 2) * self.width + self.width / 2);
        Some(self.solid_angle(index)).filter(|&solid_angle| solid_angle > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::cone_solid_angle;

    fn fisheye(kind: ViewKind) -> View {
        View {
            kind,
            position: Vec3::ZERO,
            direction: Vec3::Y,
            up: Vec3::Z,
            horizontal_deg: 180.0,
            vertical_deg: 180.0,
            fore: 0.0,
            aft: 0.0,
            shift: 0.0,
            lift: 0.0,
        }
    }

    fn total(view: &View, size: usize, coverage: &[(usize, f64)]) -> f64 {
        let each = |&(index, share): &(usize, f64)| {
            share * view.pixel_solid_angle(index % size, index / size, size, size)
        };
        coverage.iter().map(each).sum()
    }

    fn off_axis(angle_deg: f64) -> Vec3 {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        Vec3::new(0.6 * sin, cos, 0.8 * sin)
    }

    #[test]
    fn shares_add_up_to_the_disc_for_every_size_and_place() {
        for kind in [ViewKind::AngularFisheye, ViewKind::HemisphericalFisheye, ViewKind::PlanisphericFisheye]
        {
            let view = fisheye(kind);
            for size in [64, 500] {
                for angle_deg in [0.01, 0.5, 0.533, 5.0, 40.0] {
                    for place_deg in [0.0, 17.3, 60.0] {
                        let disc = cone_solid_angle(angle_deg);
                        let coverage = disc_coverage(&view, size, size, off_axis(place_deg), disc);
                        let error = total(&view, size, &coverage) / disc - 1.0;
                        assert!(error.abs() < 1e-3, "{kind:?} {size} {angle_deg} {place_deg}: {error}");
                    }
                }
            }
        }
    }

    #[test]
    fn inner_pixels_are_full_and_none_is_much_more() {
        let view = fisheye(ViewKind::AngularFisheye);
        let coverage = disc_coverage(&view, 400, 400, off_axis(30.0), cone_solid_angle(10.0));
        let full = coverage.iter().filter(|(_, share)| *share == 1.0).count();
        assert!(full * 10 > coverage.len() * 8, "{full} of {}", coverage.len());
        assert!(coverage.iter().all(|&(_, share)| share > 0.0 && share < 1.05));
        assert!(coverage.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn a_disc_on_the_edge_of_the_view_counts_with_its_inner_half() {
        let view = fisheye(ViewKind::AngularFisheye);
        let disc = cone_solid_angle(2.0);
        let coverage = disc_coverage(&view, 800, 800, Vec3::X, disc);
        let inside = total(&view, 800, &coverage) / disc;
        assert!((inside - 0.5).abs() < 5e-3, "{inside}");
        assert!(disc_coverage(&view, 800, 800, -Vec3::Y, disc).is_empty());
    }

    #[test]
    fn odd_arguments_cover_nothing() {
        let view = fisheye(ViewKind::AngularFisheye);
        assert!(disc_coverage(&view, 0, 10, Vec3::Y, 0.1).is_empty());
        assert!(disc_coverage(&view, 10, 10, Vec3::ZERO, 0.1).is_empty());
        assert!(disc_coverage(&view, 10, 10, Vec3::Y, f64::NAN).is_empty());
        assert!(disc_coverage(&fisheye(ViewKind::Parallel), 10, 10, Vec3::Y, 0.1).is_empty());
    }
}
