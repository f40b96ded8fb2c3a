//! Solid angles of pixels: the integral of the projection's density over a rectangle of its plane.

use super::{Camera, ViewKind};
use std::f64::consts::{FRAC_PI_2, PI};

/// A rectangle on the plane: low and high u, low and high v.
struct Rectangle {
    u: [f64; 2],
    v: [f64; 2],
}

impl Camera {
    /// See [`super::View::pixel_solid_angle`].
    pub fn pixel_solid_angle(&self, column: usize, row: usize, width: usize, height: usize) -> f64 {
        if width == 0 || height == 0 {
            return 0.0;
        }
        let x = |column: usize| column as f64 / width as f64;
        let y = |row: usize| 1.0 - row as f64 / height as f64;
        self.solid_angle([x(column), x(column + 1)], [y(row + 1), y(row)])
    }

    /// Solid angles [sr] of all pixels, top row first.
    pub fn solid_angles(&self, width: usize, height: usize) -> Vec<f64> {
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        pixels.map(|(column, row)| self.pixel_solid_angle(column, row, width, height)).collect()
    }

    /// Solid angle [sr] of a rectangle of the picture, as far as the view reaches.
    pub fn solid_angle(&self, x: [f64; 2], y: [f64; 2]) -> f64 {
        let (low, high) = (self.plane(x[0], y[0]), self.plane(x[1], y[1]));
        let rectangle = Rectangle { u: [low[0], high[0]], v: [low[1], high[1]] };
        match self.kind() {
            ViewKind::Perspective => rectangle.corners(perspective),
            ViewKind::Parallel => 0.0,
            ViewKind::AngularFisheye => rectangle.angular(),
            ViewKind::HemisphericalFisheye => rectangle.corners(hemispherical),
            ViewKind::PlanisphericFisheye => rectangle.corners(planispheric),
            ViewKind::Cylindrical => {
                let sine = |v: f64| v / v.hypot(1.0);
                (rectangle.u[1] - rectangle.u[0]) * (sine(rectangle.v[1]) - sine(rectangle.v[0]))
            }
        }
    }
}

impl Rectangle {
    /// The integral over the rectangle from an antiderivative in both coordinates.
    fn corners(&self, antiderivative: fn(f64, f64) -> f64) -> f64 {
        let [u0, u1] = self.u;
        let [v0, v1] = self.v;
        let value =
            antiderivative(u1, v1) - antiderivative(u0, v1) - antiderivative(u1, v0) + antiderivative(u0, v0);
        value.max(0.0)
    }

    /// `-vta` has no closed form; by Stokes the integral is that of (1 - cos theta) dphi round the outline.
    fn angular(&self) -> f64 {
        let [u0, u1] = self.u;
        let [v0, v1] = self.v;
        // Along an edge of constant v, dphi = -v du / r²; of constant u, dphi = u dv / r².
        let value = edge(u1, v0, v1) - edge(u0, v0, v1) + edge(v1, u0, u1) - edge(v0, u0, u1);
        value.max(0.0)
    }
}

/// Density (1 + u² + v²)^(-3/2): the solid angle of a flat rectangle.
fn perspective(u: f64, v: f64) -> f64 {
    (u * v / (1.0 + u * u + v * v).sqrt()).atan()
}

/// Density 4 (1 + u² + v²)^-2 (stereographic).
fn planispheric(u: f64, v: f64) -> f64 {
    let half = |a: f64, b: f64| {
        let h = a.hypot(1.0);
        a / h * (b / h).atan()
    };
    2.0 * (half(u, v) + half(v, u))
}

/// Density (1 - u² - v²)^(-1/2) in the unit circle, 0 outside: the integral over t from 0 to u of
/// asin(v / sqrt(1 - t²)), whose argument stays at ±1 outside the circle.
fn hemispherical(u: f64, v: f64) -> f64 {
    let (u, v) = (u.clamp(-1.0, 1.0), v.clamp(-1.0, 1.0));
    let rim = (1.0 - v * v).sqrt();
    if u.abs() <= rim {
        return inside_circle(u, v);
    }
    let beyond = (u.abs() - rim) * FRAC_PI_2 * v.signum();
    u.signum() * (inside_circle(rim, v) + beyond)
}

fn inside_circle(u: f64, v: f64) -> f64 {
    let z = (1.0 - u * u - v * v).max(0.0).sqrt();
    v * u.atan2(z) + u * v.atan2(z) - (u * v).atan2(z)
}

/// The integral of (1 - cos r) dphi along the line at distance `d` from the middle, from `t0` to `t1`, with
/// dphi = d dt / r². Beyond r = pi, where the view ends, cos r stays at -1.
fn edge(d: f64, t0: f64, t1: f64) -> f64 {
    let reach = PI * PI - d * d;
    if reach <= 0.0 {
        return 2.0 * (turned(d, t1) - turned(d, t0));
    }
    let rim = reach.sqrt();
    let (a, b) = (t0.clamp(-rim, rim), t1.clamp(-rim, rim));
    let outside = 2.0 * (turned(d, a) - turned(d, t0) + turned(d, t1) - turned(d, b));
    outside + d * integrate(a, b, |t| one_minus_cos_over_square(d * d + t * t))
}

/// The angle phi of the point at `t` on the line at distance `d`.
fn turned(d: f64, t: f64) -> f64 {
    if d == 0.0 { 0.0 } else { (t / d).atan() }
}

/// (1 - cos r) / r² = 2 sin²(r/2) / r², from r².
fn one_minus_cos_over_square(r2: f64) -> f64 {
    let half = 0.5 * r2.sqrt();
    if half < 1e-8 {
        return 0.5;
    }
    let sinc = half.sin() / half;
    0.5 * sinc * sinc
}

/// Gauss-Legendre with eight points: nodes and weights (Abramowitz and Stegun 1964, table 25.4).
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_650, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887),
    (0.796_666_477_413_627, 0.222_381_034_453_374),
    (0.960_289_856_497_536, 0.101_228_536_290_376),
];

/// The integrand is smooth on the scale of a radian: eight points on half a radian leave nothing but rounding.
const LONGEST_STEP: f64 = 0.5;

fn integrate(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let steps = ((b - a).abs() / LONGEST_STEP).ceil().max(1.0);
    let half = 0.5 * (b - a) / steps;
    let step = |i: usize| {
        let middle = a + (2 * i + 1) as f64 * half;
        GAUSS.iter().map(|(x, w)| w * (f(middle - x * half) + f(middle + x * half))).sum::<f64>()
    };
    half * (0..steps as usize).map(step).sum::<f64>()
}
