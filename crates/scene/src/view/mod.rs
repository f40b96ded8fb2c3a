//! Views, as Radiance's `rpict -vt…` has them.

mod camera;
mod parse;
mod pixel;
mod print;
mod solid_angle;
#[cfg(test)]
mod tests;

pub use camera::Camera;
pub(crate) use parse::apply_header_line;
pub use pixel::PixelRay;

use sunpeak_core::{Error, Result, Vec3};

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

/// What Radiance takes for zero in views (`FTINY` of its `view.h`).
const TINY: f64 = 1e-6;

impl Default for View {
    /// Radiance's standard view: 45 degrees north from the origin.
    fn default() -> Self {
        Self {
            kind: ViewKind::Perspective,
            position: Vec3::ZERO,
            direction: Vec3::Y,
            up: Vec3::Z,
            horizontal_deg: 45.0,
            vertical_deg: 45.0,
            fore: 0.0,
            aft: 0.0,
            shift: 0.0,
            lift: 0.0,
        }
    }
}

impl View {
    /// The ray through the picture point (x right, y up, both 0 to 1 over the whole picture); `None` where the view does
    /// not reach (outside a fisheye's circle; a view of no sense). No clamping: points beyond the picture have rays too.
    ///
    /// For many rays make a [`Camera`] once.
    pub fn ray(&self, x: f64, y: f64) -> Option<ViewRay> {
        Camera::new(self)?.ray(x, y)
    }

    /// Where a direction (for `-vtl`: a point) falls on the picture: x right, y up, 0 to 1 over the picture and beyond
    /// these outside of it; `None` if the projection does not reach it.
    pub fn project(&self, direction: Vec3) -> Option<[f64; 2]> {
        Camera::new(self)?.project(direction)
    }

    /// Solid angle [sr] of the pixel in column `column` (from the left) and row `row` (from the top), as far as the view
    /// reaches; 0 for `-vtl`.
    pub fn pixel_solid_angle(&self, column: usize, row: usize, width: usize, height: usize) -> f64 {
        Camera::new(self).map_or(0.0, |camera| camera.pixel_solid_angle(column, row, width, height))
    }

    /// Is it a view that one can look through: sizes positive and not too large for the kind, direction and up not parallel?
    pub fn check(&self) -> Result<()> {
        let problem =
            self.problem_of_clipping().or_else(|| self.problem_of_axes()).or_else(|| self.problem_of_size());
        match problem {
            Some(problem) => Err(Error::value(format!("the view cannot be used: {problem}"))),
            None => Ok(()),
        }
    }

    /// Height over width of the picture when pixels are square.
    pub fn aspect(&self) -> f64 {
        Camera::new(self).map_or(1.0, |camera| camera.aspect())
    }

    /// The largest picture with square pixels in `max_width` by `max_height`, as `rpict -x -y -pa 1` makes it.
    pub fn fit_size(&self, max_width: usize, max_height: usize) -> (usize, usize) {
        let (width, height, aspect) = (max_width as f64, max_height as f64, self.aspect());
        let rounded = |size: f64| ((size + 0.5) as usize).max(1);
        if aspect * width > height {
            (rounded(height / aspect), max_height)
        } else {
            (max_width, rounded(width * aspect))
        }
    }

    fn problem_of_clipping(&self) -> Option<String> {
        let (fore, aft) = (self.fore, self.aft);
        if !(fore.is_finite() && aft.is_finite() && self.shift.is_finite() && self.lift.is_finite()) {
            return Some("clipping, shift and lift must be finite numbers".into());
        }
        let sound = fore >= -TINY && aft >= -TINY && (aft <= TINY || aft > fore);
        (!sound).then(|| {
            format!("fore clipping {fore} and aft clipping {aft}: expected 0 or more, and the aft plane behind the fore")
        })
    }

    fn problem_of_axes(&self) -> Option<String> {
        if !(self.position.is_finite() && self.direction.is_finite() && self.up.is_finite()) {
            return Some("position, direction and up must be finite numbers".into());
        }
        let direction = self.direction.try_normalize();
        let up = self.up.try_normalize();
        match (direction, up) {
            (None, _) => Some("the direction -vd is zero".into()),
            (_, None) => Some("the up vector -vu is zero".into()),
            (Some(direction), Some(up)) if direction.cross(up).length() < TINY * TINY => {
                Some("the up vector -vu is parallel to the direction -vd".into())
            }
            _ => None,
        }
    }

    fn problem_of_size(&self) -> Option<String> {
        // Largest sizes, and whether they may be reached.
        let (horizontal_limit, vertical_limit) = match self.kind {
            ViewKind::Perspective => (180.0 - TINY, 180.0 - TINY),
            ViewKind::Parallel => (f64::MAX, f64::MAX),
            ViewKind::Cylindrical => (360.0 + TINY, 180.0 - TINY),
            ViewKind::AngularFisheye => (360.0 + TINY, 360.0 + TINY),
            ViewKind::HemisphericalFisheye => (180.0 + TINY, 180.0 + TINY),
            ViewKind::PlanisphericFisheye => (360.0 - TINY, 360.0 - TINY),
        };
        let sizes =
            [("-vh", self.horizontal_deg, horizontal_limit), ("-vv", self.vertical_deg, vertical_limit)];
        let wrong = sizes.into_iter().find(|&(_, size, limit)| !(size > TINY && size <= limit));
        wrong.map(|(option, size, limit)| {
            let unit = if self.kind == ViewKind::Parallel { "m" } else { "degrees" };
            let limit =
                if limit == f64::MAX { String::new() } else { format!(", up to {:.0} {unit}", limit) };
            format!(
                "the size {option} of a view {} is {size} {unit}: expected more than 0{limit}",
                self.kind.option()
            )
        })
    }
}

impl ViewKind {
    /// The kind of an option's letter, as in `-vta`.
    pub fn from_letter(letter: char) -> Option<Self> {
        Some(match letter {
            'v' => Self::Perspective,
            'l' => Self::Parallel,
            'a' => Self::AngularFisheye,
            'h' => Self::HemisphericalFisheye,
            's' => Self::PlanisphericFisheye,
            'c' => Self::Cylindrical,
            _ => return None,
        })
    }

    /// The option, as `-vta`.
    pub fn option(self) -> &'static str {
        match self {
            Self::Perspective => "-vtv",
            Self::Parallel => "-vtl",
            Self::AngularFisheye => "-vta",
            Self::HemisphericalFisheye => "-vth",
            Self::PlanisphericFisheye => "-vts",
            Self::Cylindrical => "-vtc",
        }
    }
}
