//! Least squares with coefficients that may not be negative, for three regressors.

/// The best combination found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Coefficient of each regressor.
    pub coefficients: [f64; 3],
    /// Sum of squared misfits.
    pub misfit: f64,
}

/// Regressors whose determinant is below this share of the product of their squares are taken for dependent.
const DEGENERATE: f64 = 1e-13;

/// The best combination of three regressors, none of them negative: all of their subsets are tried.
pub fn least_squares(regressors: [&[f64]; 3], values: &[f64]) -> Fit {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let squares = dot(values, values);
    let mut best = Fit { coefficients: [0.0; 3], misfit: squares };
    for subset in 1..8usize {
        let used: Vec<usize> = (0..3).filter(|k| subset >> k & 1 == 1).collect();
        let n = used.len();
        // The others stand aside: unknowns of their own that are zero.
        let entry = |i: usize, j: usize| match (used.get(i), used.get(j)) {
            (Some(&a), Some(&b)) => dot(regressors[a], regressors[b]),
            _ => f64::from(u8::from(i == j)),
        };
        let right = |i: usize| used.get(i).map_or(0.0, |&a| dot(regressors[a], values));
        let matrix = glam::DMat3::from_cols_array_2d(&[0, 1, 2].map(|j| [0, 1, 2].map(|i| entry(i, j))));
        let diagonal: f64 = (0..3).map(|k| entry(k, k)).product();
        if matrix.determinant() <= DEGENERATE * diagonal {
            continue;
        }
        let b = glam::DVec3::new(right(0), right(1), right(2));
        let x = matrix.inverse() * b;
        let misfit = squares - x.dot(b);
        if x.to_array()[..n].iter().all(|v| *v >= 0.0) && misfit < best.misfit {
            let mut coefficients = [0.0; 3];
            used.iter().zip(x.to_array()).for_each(|(&k, value)| coefficients[k] = value);
            best = Fit { coefficients, misfit };
        }
    }
    Fit { misfit: best.misfit.max(0.0), ..best }
}
