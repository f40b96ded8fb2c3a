//! The geometry of a view, made once for many rays.

use super::{View, ViewKind, ViewRay};
use std::f64::consts::PI;
use sunpeak_core::Vec3;

/// A view with its axes and sizes worked out.
///
/// Every kind maps the picture to a plane with coordinates (u, v), u right and v up from the view direction, and the
/// plane to directions. The plane is at distance 1 (`-vtv`), measured in metres (`-vtl`), angles from the direction
/// (`-vta`), their sines (`-vth`), the tangents of their halves (`-vts`); for `-vtc` u is the azimuth and v the tangent of the
/// elevation.
#[derive(Clone, Debug)]
pub struct Camera {
    pub(super) kind: ViewKind,
    position: Vec3,
    pub(super) forward: Vec3,
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    /// Size of the picture on the plane.
    pub(super) size: [f64; 2],
    /// Shift and lift, in parts of the picture.
    offset: [f64; 2],
    fore: f64,
    /// Infinite without an aft plane.
    aft: f64,
}

impl Camera {
    /// `None` if the view has no direction or no up (see [`View::check`]).
    pub fn new(view: &View) -> Option<Self> {
        let forward = view.direction.try_normalize()?;
        let right = forward.cross(view.up.try_normalize()?).try_normalize()?;
        Some(Self {
            kind: view.kind,
            position: view.position,
            forward,
            right,
            up: right.cross(forward),
            size: plane_size(view),
            offset: [view.shift, view.lift],
            fore: view.fore,
            aft: if view.aft > super::TINY { view.aft } else { f64::INFINITY },
        })
    }

    /// See [`View::aspect`].
    pub fn aspect(&self) -> f64 {
        self.size[1] / self.size[0]
    }

    /// The plane point of a picture point.
    pub(super) fn plane(&self, x: f64, y: f64) -> [f64; 2] {
        [(x + self.offset[0] - 0.5) * self.size[0], (y + self.offset[1] - 0.5) * self.size[1]]
    }

    pub(super) fn kind(&self) -> ViewKind {
        self.kind
    }

    fn picture(&self, u: f64, v: f64) -> [f64; 2] {
        [u / self.size[0] + 0.5 - self.offset[0], v / self.size[1] + 0.5 - self.offset[1]]
    }

    /// See [`View::ray`].
    pub fn ray(&self, x: f64, y: f64) -> Option<ViewRay> {
        let [u, v] = self.plane(x, y);
        let depth = self.aft - self.fore;
        if self.kind == ViewKind::Parallel {
            let origin = self.position + self.fore * self.forward + u * self.right + v * self.up;
            return Some(ViewRay { origin, direction: self.forward, max_distance: depth });
        }
        let local = self.local_direction(u, v)?;
        let along = local[0] * self.right + local[1] * self.up + local[2] * self.forward;
        // Planes of clipping for perspective, cylinders for -vtc, spheres for the fisheyes: `along` has length 1 there.
        let stretch = along.length();
        let origin = self.position + self.fore * along;
        Some(ViewRay { origin, direction: along / stretch, max_distance: depth * stretch })
    }

    /// Direction in the camera's axes; its length is the distance to the surface on which clipping is measured.
    pub(super) fn local_direction(&self, u: f64, v: f64) -> Option<[f64; 3]> {
        let r2 = u * u + v * v;
        Some(match self.kind {
            ViewKind::Perspective | ViewKind::Parallel => [u, v, 1.0],
            ViewKind::Cylindrical => [u.sin(), v, u.cos()],
            ViewKind::HemisphericalFisheye => {
                if r2 > 1.0 {
                    return None;
                }
                [u, v, (1.0 - r2).sqrt()]
            }
            ViewKind::AngularFisheye => {
                let theta = r2.sqrt();
                if theta > PI {
                    return None;
                }
                let (sine, cosine) = theta.sin_cos();
                // sin(theta) / theta, 1 in the middle.
                let shrink = if theta > 0.0 { sine / theta } else { 1.0 };
                [u * shrink, v * shrink, cosine]
            }
            ViewKind::PlanisphericFisheye => {
                let z = (1.0 - r2) / (1.0 + r2);
                [u * (1.0 + z), v * (1.0 + z), z]
            }
        })
    }

    /// See [`View::project`].
    pub fn project(&self, target: Vec3) -> Option<[f64; 2]> {
        let parallel = self.kind == ViewKind::Parallel;
        let target = if parallel { target - self.position } else { target.try_normalize()? };
        let (x, y, z) = (target.dot(self.right), target.dot(self.up), target.dot(self.forward));
        let [u, v] = match self.kind {
            ViewKind::Parallel => [x, y],
            ViewKind::Perspective if z > 0.0 => [x / z, y / z],
            ViewKind::HemisphericalFisheye if z >= 0.0 => [x, y],
            ViewKind::Cylindrical if x != 0.0 || z != 0.0 => [self.nearest_turn(x.atan2(z)), y / x.hypot(z)],
            ViewKind::AngularFisheye => {
                let sine = x.hypot(y);
                let theta = sine.atan2(z);
                // Straight behind, the whole rim is as good; Radiance takes its right end.
                if sine > 0.0 { [x * theta / sine, y * theta / sine] } else { [theta, 0.0] }
            }
            ViewKind::PlanisphericFisheye if z > -1.0 => [x / (1.0 + z), y / (1.0 + z)],
            _ => return None,
        };
        Some(self.picture(u, v))
    }

    /// The azimuth that lies nearest to the middle of the picture, which a shift may have moved round the back.
    fn nearest_turn(&self, azimuth: f64) -> f64 {
        let middle = self.offset[0] * self.size[0];
        azimuth + TURN * ((middle - azimuth) / TURN).round()
    }
}

/// A full turn [rad].
const TURN: f64 = 2.0 * PI;

/// Width and height of the picture on the plane.
fn plane_size(view: &View) -> [f64; 2] {
    let of = |degrees: f64| {
        let angle = degrees.to_radians();
        match view.kind {
            ViewKind::Perspective => 2.0 * (angle / 2.0).tan(),
            ViewKind::Parallel => degrees,
            ViewKind::AngularFisheye => angle,
            ViewKind::HemisphericalFisheye => 2.0 * (angle / 2.0).sin(),
            ViewKind::PlanisphericFisheye => 2.0 * (angle / 4.0).tan(),
            ViewKind::Cylindrical => angle,
        }
    };
    match view.kind {
        ViewKind::Cylindrical => {
            [of(view.horizontal_deg), 2.0 * (view.vertical_deg.to_radians() / 2.0).tan()]
        }
        _ => [of(view.horizontal_deg), of(view.vertical_deg)],
    }
}
