//! The numbers of a distribution, a column at a time: luminous values, and CIE X and Z where it has colour.

use crate::{
    distribution::Distribution,
    layout::Layout,
    table::{CellSquare, Columns},
};
use sunpeak_core::{Rgb, luminance, rgb_to_xyz};

/// A distribution whose columns are read.
pub struct Planes<'a> {
    pub distribution: &'a Distribution,
    pub layout: Layout,
    /// Without the split's peak.
    residual: bool,
}

/// Values Y, or Y, X and Z.
pub type Numbers = [f64; 3];

impl<'a> Planes<'a> {
    pub fn new(distribution: &'a Distribution, residual: bool) -> Self {
        Self { distribution, layout: Layout::of(distribution.luminous()), residual }
    }

    /// 1, or 3 with colour.
    pub fn count(&self) -> usize {
        if self.distribution.color().is_some() { 3 } else { 1 }
    }

    /// Add a column's values [1/sr], weighted, to one list of exiting cells for each plane.
    pub fn add_column(&self, column: usize, weight: f64, sums: &mut [Vec<f64>]) {
        let d = self.distribution;
        let width = self.layout.exiting.len();
        let side = match self.layout.exiting {
            Columns::Square { side } => side,
            _ => 0,
        };
        for cell in d.luminous().cells(d.columns(), column) {
            let values = self.values(column, cell.index).map(|v| v * weight);
            match cell.square() {
                None => {
                    let at = cell.index % width;
                    sums.iter_mut().zip(values).for_each(|(sum, v)| sum[at] += v);
                }
                Some(CellSquare { corner, size }) => {
                    let whole = |x: f32| (x * side as f32).round() as usize;
                    let [i, j, n] = [whole(corner[0]), whole(corner[1]), whole(size).max(1)];
                    for (sum, v) in sums.iter_mut().zip(values) {
                        for row in i..i + n {
                            sum[row * side + j..row * side + j + n].iter_mut().for_each(|x| *x += v);
                        }
                    }
                }
            }
        }
    }

    fn values(&self, column: usize, index: usize) -> Numbers {
        let d = self.distribution;
        let surround = if self.residual { d.split().surround(column, index) } else { None };
        if let Some(rgb) = surround {
            return self.numbers(rgb);
        }
        let y = f64::from(d.luminous().values()[index]);
        match d.color() {
            None => [y, 0.0, 0.0],
            Some([x, z]) => [y, f64::from(x[index]), f64::from(z[index])],
        }
    }

    /// Three channels as planes.
    pub fn numbers(&self, rgb: Rgb) -> Numbers {
        if self.distribution.color().is_none() {
            return [luminance(rgb), 0.0, 0.0];
        }
        let xyz = rgb_to_xyz(rgb);
        [xyz.y, xyz.x, xyz.z].map(|v| v.max(0.0))
    }
}
