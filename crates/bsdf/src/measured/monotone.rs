//! A function through points that rises and falls only where they do: cubic pieces (Fritsch and Butland, "A Method for Constructing Local
//! Monotone Piecewise Cubic Interpolants", SIAM J. Sci. Stat. Comput. 5, 1984).

/// Points in ascending order, with slopes.
#[derive(Clone, Debug)]
pub struct Monotone {
    points: Vec<[f64; 2]>,
    slopes: Vec<f64>,
}

impl Monotone {
    /// Through points at zero or above, of a function that is the same on both sides of zero; linear past the last one.
    pub fn even(points: Vec<[f64; 2]>) -> Self {
        let mirrored = points.iter().find(|p| p[0] > 0.0).map(|p| [-p[0], p[1]]);
        let mut all: Vec<[f64; 2]> = mirrored.into_iter().chain(points).collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let chord = |k: usize| (all[k + 1][1] - all[k][1]) / (all[k + 1][0] - all[k][0]);
        let last = all.len() - 1;
        let slope = |k: usize| match k {
            _ if last == 0 => 0.0,
            0 => chord(0),
            _ if k == last => chord(last - 1),
            _ => inner(chord(k - 1), chord(k), all[k][0] - all[k - 1][0], all[k + 1][0] - all[k][0]),
        };
        let slopes = (0..all.len()).map(slope).collect();
        Self { points: all, slopes }
    }

    /// Its value; past the last point it falls on, but does not rise.
    pub fn at(&self, x: f64) -> f64 {
        let last = self.points.len() - 1;
        let k = self.points.partition_point(|p| p[0] <= x).clamp(1, last.max(1)) - 1;
        if x >= self.points[last][0] || last == 0 {
            return self.points[last][1] + self.slopes[last].min(0.0) * (x - self.points[last][0]).max(0.0);
        }
        let ([x0, y0], [x1, y1]) = (self.points[k], self.points[k + 1]);
        let (h, t) = (x1 - x0, (x - x0) / (x1 - x0));
        let (m0, m1) = (h * self.slopes[k], h * self.slopes[k + 1]);
        let bend = t * t * (3.0 - 2.0 * t);
        y0 + (y1 - y0) * bend + t * (1.0 - t) * (m0 * (1.0 - t) - m1 * t)
    }
}

/// Harmonic mean of the slopes on both sides, weighted by the other one's length; none where they turn.
fn inner(before: f64, after: f64, h_before: f64, h_after: f64) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let weight = (h_before + 2.0 * h_after) / (3.0 * (h_before + h_after));
    before * after / (weight * after + (1.0 - weight) * before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_meets_its_points_and_a_cosine_between_them() {
        let truth = |x: f64| (1.2 * x).cos();
        let curve = Monotone::even((0..10).map(|k| [0.1 * k as f64, truth(0.1 * k as f64)]).collect());
        for k in 0..89 {
            let x = 0.01 * k as f64;
            assert!((curve.at(x) - truth(x)).abs() < 1.5e-3, "{x}: {} {}", curve.at(x), truth(x));
        }
        assert!((curve.at(0.3) - truth(0.3)).abs() < 1e-12);
        assert_eq!(Monotone::even(vec![[0.3, 0.2]]).at(0.7), 0.2);
    }
}
