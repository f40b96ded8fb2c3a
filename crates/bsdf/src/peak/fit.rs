//! Base and height of a smooth lobe by least squares, with the peak's flux left open.

use super::neighbourhood::{Neighbourhood, Region};

/// `b + a g` around a peak: what was found, and what its error at a cell follows from.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fit {
    base: f64,
    height: f64,
    /// Inverse of the normal matrix: of base, of both, of height.
    inverse: [f64; 3],
    /// Mean square misfit of a cell next to the peak (weight 1) [1/sr²].
    variance: f64,
    /// Sum of squares of the data, weighted; nothing to fit if zero.
    squares: f64,
    /// The same of the misfit.
    misfit: f64,
    /// Variance over value [1/sr], and over squared value.
    over_value: f64,
    over_square: f64,
}

/// Below this share of its scale a normal matrix tells base and height not apart.
const SINGULAR: f64 = 1e-9;

impl Fit {
    /// Fit one channel's values, neither base nor height negative. `at_core` and `around` are averages of a lobe of height 1.
    ///
    /// The core's excess over the fit, over the core's share of it, is the peak T; its tails are taken out of the cells around,
    /// which depend on the fit itself: they become part of the two regressors.
    pub fn new(n: &Neighbourhood, values: &[f32], at_core: &[f64], around: &[f64]) -> Self {
        let Region { core, fringe, core_share } = &n.region;
        let over_core = |f: &dyn Fn(usize) -> f64| -> f64 {
            core.iter().enumerate().map(|(i, b)| f(i) * b.cell.projected_solid_angle).sum()
        };
        let share = core_share.max(f64::MIN_POSITIVE);
        let flux = over_core(&|i| f64::from(values[core[i].cell.index])) / share;
        let (area, lobe) = (over_core(&|_| 1.0) / share, over_core(&|i| at_core[i]) / share);
        let mut sums = [0.0; 6]; // of uu, uv, vv, uy, vy, yy, weighted
        let (mut weights, mut data, mut squares) = (0.0, 0.0, 0.0);
        for (i, (&(cell, w), &g)) in n.around.iter().zip(around).enumerate() {
            let tail = fringe.get(i).map_or(0.0, |b| b.share / b.cell.projected_solid_angle);
            let value = f64::from(values[cell.index]);
            let (u, v, y) = (1.0 - area * tail, g - lobe * tail, value - flux * tail);
            for (sum, term) in sums.iter_mut().zip([u * u, u * v, v * v, u * y, v * y, y * y]) {
                *sum += w * term;
            }
            weights += w;
            data += w * value;
            squares += w * value * value;
        }
        let [uu, uv, vv, uy, vy, yy] = sums;
        if uu <= 0.0 || squares <= 0.0 {
            return Self::default();
        }
        let determinant = uu * vv - uv * uv;
        let mut fit = Self { base: uy / uu, inverse: [1.0 / uu, 0.0, 0.0], squares, ..Self::default() };
        if determinant > SINGULAR * uu * vv {
            let (b, a) = ((vv * uy - uv * vy) / determinant, (uu * vy - uv * uy) / determinant);
            if b >= 0.0 && a >= 0.0 {
                (fit.base, fit.height) = (b, a);
                fit.inverse = [vv / determinant, -uv / determinant, uu / determinant];
            } else if b < 0.0 && vv > 0.0 {
                (fit.base, fit.height) = (0.0, vy / vv);
                fit.inverse = [0.0, 0.0, 1.0 / vv];
            }
        }
        let (b, a) = (fit.base, fit.height);
        fit.misfit = (yy - 2.0 * (b * uy + a * vy) + b * b * uu + 2.0 * b * a * uv + a * a * vv).max(0.0);
        fit.variance = fit.misfit / weights;
        fit.over_value = if data > 0.0 { fit.misfit / data } else { 0.0 };
        fit.over_square = fit.misfit / squares;
        fit
    }

    /// There was something to fit.
    pub fn is_something(&self) -> bool {
        self.squares > 0.0
    }

    /// Squared misfit relative to the data.
    pub fn misfit(&self) -> f64 {
        if self.squares > 0.0 { self.misfit / self.squares } else { 0.0 }
    }

    /// The smooth value where the lobe of height 1 has the average `g` [1/sr].
    pub fn value(&self, g: f64) -> f64 {
        self.base + self.height * g
    }

    /// Variance of [`Self::value`] over that of a cell: how errors around the peak grow towards its middle.
    pub fn leverage(&self, g: f64) -> f64 {
        let [a, b, c] = self.inverse;
        (a + 2.0 * b * g + c * g * g).max(0.0)
    }

    /// Mean square misfit of a cell next to the peak [1/sr²].
    pub fn variance(&self) -> f64 {
        self.variance
    }

    /// Variance over value [1/sr] and over squared value [-]: counted rays keep the first the same for bright and dark cells,
    /// a detector's relative error the second.
    pub fn noise_ratios(&self) -> [f64; 2] {
        [self.over_value, self.over_square]
    }
}
