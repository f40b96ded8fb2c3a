//! A model into any basis: means over cells, by Gauss's rule on incident cells and adaptive halving of exiting ones.

use super::Model;
use crate::{
    bsdf::{Bsdf, Sides},
    distribution::Distribution,
    layout::Layout,
    synthetic::Basis,
    table::{Columns, Table},
    work::Work,
    xml::Document,
};
use glam::DVec2;
use std::sync::Arc;
use sunpeak_core::{Error, Result, Vec3};

/// Relative error at which halving stops, against the cell's mean, or against this share of a diffuse surface's value.
const TOLERANCE: f64 = 2e-4;
const OF_A_DIFFUSER: f64 = 1e-3;

/// Most halvings of a cell.
const MOST_HALVINGS: usize = 10;

/// A cell that is nearer to a lobe's axis than so many widths is halved until it is no wider than the lobe.
const NEAR: f64 = 4.0;

/// Least and most points a side over an incident cell: of matrices and of trees.
const PATCH_POINTS: [f64; 2] = [4.0, 16.0];
const TREE_POINTS: [f64; 2] = [2.0, 8.0];

/// Points a side over which deltas are averaged, of matrices and of trees.
const DELTA_POINTS: [usize; 2] = [64, 16];

/// Off the border of two rows, along which mirrored and straight directions run in isotropic trees.
const BESIDE: f64 = 1e-9;

/// Two points of Gauss's rule on the unit interval.
const GAUSS_2: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// Tabulate a model: every value is its mean over a pair of cells.
///
/// # Errors
/// Where the model is not the same at all azimuths and the basis is; when the work is stopped.
pub fn tabulate(model: &dyn Model, basis: Basis, work: &Work) -> Result<Bsdf> {
    if basis.is_isotropic() && !model.is_isotropic() {
        return Err(Error::value(format!(
            "{}: not the same at all azimuths; expected a matrix or a t4 basis",
            model.name()
        )));
    }
    let layout = basis.layout();
    let tables = if model.transmits() { 4 } else { 2 };
    work.expect(tables * layout.incident.len());
    let table =
        |front: bool, reflection: bool| Means { model, layout: &layout, front, reflection }.table(work);
    let reflection = |front: bool| -> Result<Option<Arc<Distribution>>> {
        Ok(Some(Arc::new(Distribution::new(table(front, true)?, None))))
    };
    let transmission = |front: bool| -> Result<Option<Arc<Distribution>>> {
        let table = model.transmits().then(|| table(front, false)).transpose()?;
        Ok(table.map(|table| Arc::new(Distribution::with_split(table, None))))
    };
    let document = Document {
        name: model.name(),
        manufacturer: "Sunpeak (formula)".into(),
        structure: basis.structure().into(),
        comments: format!(
            "Sunpeak: {} tabulated in {basis} by integration over cells, to {:.2} % of each cell; no statistical error.",
            model.name(),
            100.0 * TOLERANCE
        ),
        ..Document::default()
    };
    let sides = Sides {
        transmission_front: transmission(true)?,
        transmission_back: transmission(false)?,
        reflection_front: reflection(true)?,
        reflection_back: reflection(false)?,
    };
    Ok(Bsdf::from_sides(document, sides))
}

/// One side and mode.
struct Means<'a> {
    model: &'a dyn Model,
    layout: &'a Layout,
    front: bool,
    reflection: bool,
}

impl Means<'_> {
    fn table(&self, work: &Work) -> Result<Table> {
        let part = ("model", self.front, self.reflection);
        let columns = work.columns(part, self.layout.incident.len(), |c| self.column(c))?;
        Ok(self.layout.table(|column, cell| columns[column][cell]))
    }

    fn is_matrix(&self) -> bool {
        matches!(self.layout.exiting, Columns::Patches(_))
    }

    /// The direction to the light of a table's incident point, and the direction of an exiting one.
    fn to_light(&self, p: DVec2) -> Vec3 {
        above(-p, self.front)
    }

    fn exit(&self, p: DVec2) -> Vec3 {
        above(p, self.front == self.reflection)
    }

    fn column(&self, column: usize) -> Vec<f32> {
        let mut sums = vec![0.0; self.layout.exiting.len()];
        for (p, weight) in self.incident(column) {
            let to_light = self.to_light(p);
            let axis = self.model.axis(to_light, self.reflection).truncate();
            for (cell, sum) in sums.iter_mut().enumerate() {
                *sum += weight * self.mean(to_light, axis, cell);
            }
        }
        self.add_deltas(column, &mut sums);
        sums.into_iter().map(|s| s as f32).collect()
    }

    /// Points of an incident cell with weights that add up to 1.
    fn incident(&self, column: usize) -> Vec<(DVec2, f64)> {
        let [least, most] = if self.is_matrix() { PATCH_POINTS } else { TREE_POINTS };
        let width = self.layout.incident.projected_solid_angle(column).sqrt();
        let lobes = self.model.width().map_or(0.0, |lobe| 1.5 * width / lobe);
        let n = lobes.clamp(least, most).ceil() as usize;
        let rule = composite(n.div_ceil(2));
        let division = &self.layout.incident;
        let weighed: Vec<(DVec2, f64)> = match division {
            Columns::Radial { .. } => rule
                .iter()
                .map(|&u| {
                    let p = division.point(column, [u, 0.5]);
                    (p, p.x)
                })
                .collect(),
            _ => rule
                .iter()
                .flat_map(|&u| rule.iter().map(move |&v| (division.point(column, [u, v]), 1.0)))
                .collect(),
        };
        let sum: f64 = weighed.iter().map(|w| w.1).sum();
        weighed.into_iter().map(|(p, w)| (p, w / sum)).collect()
    }

    fn value(&self, to_light: Vec3, cell: usize, u: [f64; 2]) -> f64 {
        self.model.value(to_light, self.exit(self.layout.exiting.point(cell, u)))
    }

    /// Mean over an exiting cell.
    fn mean(&self, to_light: Vec3, axis: DVec2, cell: usize) -> f64 {
        if self.model.width().is_none() {
            return self.value(to_light, cell, [0.5, 0.5]);
        }
        let first = self.four(to_light, cell, [0.0; 2], 1.0);
        self.halved(to_light, axis, cell, [0.0; 2], 1.0, first, 0)
    }

    fn four(&self, to_light: Vec3, cell: usize, corner: [f64; 2], size: f64) -> f64 {
        let at = |k: usize, u: f64| corner[k] + size * u;
        let points = GAUSS_2.iter().flat_map(|&u| GAUSS_2.iter().map(move |&v| [u, v]));
        0.25 * points.map(|[u, v]| self.value(to_light, cell, [at(0, u), at(1, v)])).sum::<f64>()
    }

    #[expect(clippy::too_many_arguments, reason = "a recursion's own state")]
    fn halved(
        &self,
        to_light: Vec3,
        axis: DVec2,
        cell: usize,
        corner: [f64; 2],
        size: f64,
        coarse: f64,
        depth: usize,
    ) -> f64 {
        let half = 0.5 * size;
        let corners =
            [0, 1, 2, 3].map(|k| [corner[0] + half * (k / 2) as f64, corner[1] + half * (k % 2) as f64]);
        let parts = corners.map(|c| self.four(to_light, cell, c, half));
        let fine = 0.25 * parts.iter().sum::<f64>();
        if depth >= MOST_HALVINGS {
            return fine;
        }
        let floor = OF_A_DIFFUSER / std::f64::consts::PI;
        // An error in a part of the cell counts by its area.
        let allowed = TOLERANCE * fine.max(floor) / (size * size);
        if (fine - coarse).abs() <= allowed && !self.may_hide(axis, cell, corner, size) {
            return fine;
        }
        let each = corners.iter().zip(parts);
        0.25 * each.map(|(&c, part)| self.halved(to_light, axis, cell, c, half, part, depth + 1)).sum::<f64>()
    }

    /// Can a lobe lie between the points?
    fn may_hide(&self, axis: DVec2, cell: usize, corner: [f64; 2], size: f64) -> bool {
        let Some(lobe) = self.model.width() else { return false };
        let width = size * self.layout.exiting.projected_solid_angle(cell).sqrt();
        if width <= lobe {
            return false;
        }
        let middle = self.layout.exiting.point(cell, [corner[0] + 0.5 * size, corner[1] + 0.5 * size]);
        middle.distance(axis) < NEAR * lobe + width
    }

    fn add_deltas(&self, column: usize, values: &mut [f64]) {
        let n = DELTA_POINTS[usize::from(!self.is_matrix())];
        let middles = |n: usize| (0..n).map(move |i| (i as f64 + 0.5) / n as f64);
        let division = &self.layout.incident;
        let isotropic = self.layout.is_isotropic();
        let points: Vec<(DVec2, f64)> = if isotropic {
            let ring = middles(n * n).map(|u| division.point(column, [u, 0.5]));
            ring.map(|p| (p, p.x)).collect()
        } else {
            let all = middles(n).flat_map(|u| middles(n).map(move |v| [u, v]));
            all.map(|u| (division.point(column, u), 1.0)).collect()
        };
        let sum: f64 = points.iter().map(|p| p.1).sum();
        let sides: &[f64] = if isotropic { &[-BESIDE, BESIDE] } else { &[0.0] };
        for (p, weight) in points {
            let share = self.model.deltas(self.to_light(p))[usize::from(self.reflection)];
            for &side in sides {
                // In a table's points the mirrored direction is where the straight one is.
                let cell = self.layout.exiting.index(p + DVec2::new(0.0, side));
                let area = self.layout.exiting.projected_solid_angle(cell);
                values[cell] += weight / sum * share / sides.len() as f64 / area;
            }
        }
    }
}

/// Gauss's two points in each of `n` equal parts of the unit interval.
fn composite(n: usize) -> Vec<f64> {
    (0..n).flat_map(|k| GAUSS_2.map(|u| (k as f64 + u) / n as f64)).collect()
}

fn above(p: DVec2, front: bool) -> Vec3 {
    // Not in the surface's own plane, where nothing is defined.
    let height = (1.0 - p.length_squared()).max(1e-12).sqrt();
    p.extend(if front { height } else { -height })
}
