//! The rough transmitted lobe of `trans` and `trans2`: a Gaussian around the straight direction.
//!
//! With d the straight direction and h = w - d the lobe is exp(-|h|² q) / (pi a_x a_y), q = cos²(phi) / a_x² + sin²(phi) / a_y²
//! for the azimuth phi of h on the surface (Radiance's `diraniso`). With one roughness q = 1 / a², and |h|² = 2 (1 - cos) to d.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use sunpeak_core::{Frame, Vec3, warp};

/// With two roughnesses this share of samples comes from an ellipse of the straight direction's own plane, the rest from a
/// round lobe of the larger roughness, which the lobe nowhere exceeds by more than a factor: so all weights are bounded.
const ELLIPTIC: f64 = 0.5;

/// Steps of the table that bounds the flux, over the cosine and over a quarter of the azimuth.
const BOUND_STEPS: usize = 64;
const BOUND_AZIMUTHS: usize = 7;

/// The lobe for light that comes from `w_in`, z the normal on that side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transmission {
    straight: Vec3,
    alpha: [f64; 2],
}

impl Transmission {
    pub fn new(w_in: Vec3, alpha: [f64; 2]) -> Self {
        Self { straight: -w_in, alpha }
    }

    fn is_round(&self) -> bool {
        self.alpha[0] == self.alpha[1]
    }

    /// The Gaussian [1/sr].
    pub fn gaussian(&self, w_out: Vec3) -> f64 {
        let [a, b] = self.alpha;
        (-self.exponent(w_out - self.straight)).exp() * FRAC_1_PI / (a * b)
    }

    fn exponent(&self, h: Vec3) -> f64 {
        let [a, b] = self.alpha;
        let on_surface = h.x * h.x + h.y * h.y;
        if self.is_round() || on_surface == 0.0 {
            // An azimuth that is none counts as the mean one.
            return h.length_squared() / (a * b);
        }
        h.length_squared() * ((h.x / a).powi(2) + (h.y / b).powi(2)) / on_surface
    }

    /// Density [1/sr] of `sample`.
    pub fn pdf(&self, w_out: Vec3) -> f64 {
        let widest = self.alpha[0].max(self.alpha[1]);
        let local = self.frame().to_local(w_out);
        let height = 0.5 * (w_out - self.straight).length_squared();
        let round = exponential(height, 2.0 / (widest * widest)) / (2.0 * PI);
        if self.is_round() {
            return round;
        }
        let q = self.ellipse(local.x, local.y);
        let elliptic = exponential(height, 2.0 * q) / (2.0 * PI * self.alpha[0] * self.alpha[1] * q);
        ELLIPTIC * elliptic + (1.0 - ELLIPTIC) * round
    }

    /// A direction, on either side of the surface.
    pub fn sample(&self, [u, v]: [f64; 2]) -> Vec3 {
        let widest = self.alpha[0].max(self.alpha[1]);
        let [cos, sin] = warp::circle(v);
        if self.is_round() {
            return self.at(draw(u, 2.0 / (widest * widest)), [cos, sin]);
        }
        if u < ELLIPTIC {
            let [x, y] = [self.alpha[0] * cos, self.alpha[1] * sin];
            let scale = x.hypot(y);
            let side = [x / scale, y / scale];
            return self.at(draw(u / ELLIPTIC, 2.0 * self.ellipse(x, y)), side);
        }
        self.at(draw((u - ELLIPTIC) / (1.0 - ELLIPTIC), 2.0 / (widest * widest)), [cos, sin])
    }

    /// Around the straight direction, its x as near as can be to the surface's.
    fn frame(&self) -> Frame {
        if self.is_round() {
            return Frame::from_normal(self.straight);
        }
        let y = self.straight.cross(Vec3::X).normalize_or(Vec3::Y);
        Frame { x: y.cross(self.straight), y, z: self.straight }
    }

    /// cos² / a_x² + sin² / a_y² of the azimuth of (x, y).
    fn ellipse(&self, x: f64, y: f64) -> f64 {
        let [a, b] = self.alpha;
        let square = x * x + y * y;
        if square == 0.0 { 1.0 / (a * b) } else { ((x / a).powi(2) + (y / b).powi(2)) / square }
    }

    /// 1 - cos is `height`, the azimuth that of the unit vector `side`.
    fn at(&self, height: f64, [x, y]: [f64; 2]) -> Vec3 {
        let radius = (height * (2.0 - height)).max(0.0).sqrt();
        self.frame().to_world(Vec3::new(radius * x, radius * y, 1.0 - height))
    }
}

/// Density of the exponential distribution of this rate, cut off at 2.
fn exponential(height: f64, rate: f64) -> f64 {
    rate * (-rate * height).exp() / (1.0 - (-2.0 * rate).exp())
}

/// Its inverse distribution function.
fn draw(u: f64, rate: f64) -> f64 {
    (-(1.0 - u * (1.0 - (-2.0 * rate).exp())).ln() / rate).clamp(0.0, 2.0)
}

/// 1 over what the rough transmission would give out, where that is more than it gets: its factor sqrt(cos/cos) does that at
/// grazing incidence, and with two roughnesses the azimuth on the surface does. Radiance leaves it so; a path tracer would make
/// light of it.
#[derive(Clone, Debug)]
pub(super) struct Bound {
    /// A row over the cosine for each azimuth, from the orientation to across it.
    rows: Vec<[f64; BOUND_STEPS]>,
}

impl Bound {
    pub fn new(alpha: [f64; 2]) -> Self {
        let count = if alpha[0] == alpha[1] { 1 } else { BOUND_AZIMUTHS };
        let azimuth = |k: usize| FRAC_PI_2 * k as f64 / (BOUND_AZIMUTHS - 1) as f64;
        let cosine = |i: usize| (i as f64 + 0.5) / BOUND_STEPS as f64;
        let row = |k| std::array::from_fn(|i| 1.0 / flux(alpha, cosine(i), azimuth(k)).max(1.0));
        Self { rows: (0..count).map(row).collect() }
    }

    /// For light from `w_in`, x along the orientation.
    pub fn at(&self, w_in: Vec3) -> f64 {
        let azimuth = w_in.y.abs().atan2(w_in.x.abs()) / FRAC_PI_2 * (self.rows.len() - 1) as f64;
        let (low, high, share) = neighbours(azimuth, self.rows.len());
        let along = |row: &[f64; BOUND_STEPS]| {
            let (low, high, share) = neighbours(w_in.z * BOUND_STEPS as f64 - 0.5, BOUND_STEPS);
            row[low] * (1.0 - share) + row[high] * share
        };
        along(&self.rows[low]) * (1.0 - share) + along(&self.rows[high]) * share
    }
}

/// The entries of a table before and after a position, and how far it is to the second.
fn neighbours(position: f64, count: usize) -> (usize, usize, f64) {
    let low = position.floor().clamp(0.0, (count - 1) as f64);
    let high = (low + 1.0).min((count - 1) as f64);
    (low as usize, high as usize, (position - low).clamp(0.0, 1.0))
}

/// The factor of [`Bound::at`] for roughnesses of one point alone.
pub(super) fn bound_at(w_in: Vec3, alpha: [f64; 2]) -> f64 {
    1.0 / flux(alpha, w_in.z, w_in.y.atan2(w_in.x)).max(1.0)
}

/// What the lobe gives out of a unit of flux.
fn flux(alpha: [f64; 2], cosine: f64, azimuth: f64) -> f64 {
    const SAMPLES: usize = 40;
    let midpoints = || (0..SAMPLES).map(|i| (i as f64 + 0.5) / SAMPLES as f64);
    let sine = (1.0 - cosine * cosine).sqrt();
    let lobe = Transmission::new(Vec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine), alpha);
    let through = |u, v| {
        let out = lobe.sample([u, v]);
        (-out.z / cosine).max(0.0).sqrt() * lobe.gaussian(out) / lobe.pdf(out)
    };
    let sum: f64 =
        midpoints().flat_map(|u| midpoints().map(move |v| (u, v))).map(|(u, v)| through(u, v)).sum();
    sum / (SAMPLES * SAMPLES) as f64
}
