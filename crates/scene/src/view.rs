//! Views, as Radiance's `rpict -vt…` has them.

use sunpeak_core::{Result, Vec3};

/// How directions are laid on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewKind {
    /// `-vtv`
    Perspective,
    /// `-vtl`
    Parallel,
    /// `-vta`
    AngularFisheye,
    /// `-vth`
    HemisphericalFisheye,
    /// `-vts`
    PlanisphericFisheye,
    /// `-vtc`
    Cylindrical,
}

/// A view. Fields as the options of `rpict`; angles in degrees (sizes in metres for `-vtl`).
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// `-vt`
    pub kind: ViewKind,
    /// `-vp`
    pub position: Vec3,
    /// `-vd`; its length counts for focus only.
    pub direction: Vec3,
    /// `-vu`
    pub up: Vec3,
    /// `-vh`
    pub horizontal_deg: f64,
    /// `-vv`
    pub vertical_deg: f64,
    /// `-vo`
    pub fore: f64,
    /// `-va`; 0 is none.
    pub aft: f64,
    /// `-vs`
    pub shift: f64,
    /// `-vl`
    pub lift: f64,
}

/// A ray of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// Where it ends (aft clipping), or infinity.
    pub max_distance: f64,
}

impl View {
    /// The ray through the picture point (x right, y up, both 0 to 1 over the whole picture); `None` where the view
    /// does not reach (outside a fisheye's circle). Arguments first are normalised by the caller: no clamping here.
    pub fn ray(&self, _x: f64, _y: f64) -> Option<ViewRay> {
        None
    }

    /// Where a direction (for `-vtl`: a point) falls on the picture: x right, y up, 0 to 1; `None` if outside the projection.
    pub fn project(&self, _direction: Vec3) -> Option<[f64; 2]> {
        None
    }

    /// Solid angle [sr] of the pixel in column `column` (from the left) and row `row` (from the top); 0 where the view does not
    /// reach or for `-vtl`.
    pub fn pixel_solid_angle(&self, _column: usize, _row: usize, _width: usize, _height: usize) -> f64 {
        0.0
    }

    /// Is it a view that one can look through: sizes positive and not too large for the kind, direction and up not parallel?
    pub fn check(&self) -> Result<()> {
        Ok(())
    }
}
