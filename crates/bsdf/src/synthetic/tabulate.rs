//! Any product into any basis, by averages over cells.

use super::{
    Basis, Goniophotometer,
    product::{Lobe, OtherSide, Product},
};
use crate::{
    bsdf::{Bsdf, Sides},
    distribution::Distribution,
    exact_peak::{Delta, with_exact_peak},
    kernel::{Kernel, Spread},
    layout::Layout,
    table::{Columns, Matrix, Table},
    tree::Tree,
    work::Work,
    xml::Document,
};
use glam::DVec2;
use rayon::prelude::*;
use std::{f64::consts::PI, sync::Arc};
use sunpeak_core::{Error, Result};

/// Points a side over which the smooth part's average is taken, incident and exiting: it is wide against a tree's cells, not
/// against a patch.
const TREE_POINTS: usize = 2;
const PATCH_POINTS: usize = 6;

/// Points a side over which the through transmittance is averaged; its slope is infinite at a cut-off.
const THROUGH_POINTS: usize = 64;

/// Incident points a side for narrow lobes: so many that they lie a standard deviation apart, within these bounds.
const LOBE_POINTS: [f64; 2] = [4.0, 40.0];

/// Off the border of two rows, along which the straight direction runs in isotropic trees.
const BESIDE: f64 = 1e-9;

/// Tabulate a product: transmission by cell averages (the delta's share of each cell is exact), as the goniophotometer sees them,
/// and diffuse reflection.
pub fn tabulate(product: &dyn Product, basis: Basis, seen_by: &Goniophotometer) -> Result<Bsdf> {
    tabulate_watched(product, basis, seen_by, &Work::default())
}

/// As [`tabulate`], as work that is watched and kept.
///
/// # Errors
/// As there; when the work is stopped.
pub fn tabulate_watched(
    product: &dyn Product,
    basis: Basis,
    seen_by: &Goniophotometer,
    work: &Work,
) -> Result<Bsdf> {
    with_sides(product, basis, seen_by.is_exact(), work, |product, front| {
        let seed = if front { seen_by.seed } else { seen_by.seed ^ 0x5bd1_e995 };
        let (table, color) =
            transmission(product, basis, &Goniophotometer { seed, ..*seen_by }, front, work)?;
        Ok(Distribution::with_split(table, color))
    })
}

/// Tabulate a product and keep its through part as it is known, rather than what a split would find in the table.
///
/// # Errors
/// Where the product is not the same at all azimuths and the basis is; when the work is stopped.
pub fn tabulate_exact(product: &dyn Product, basis: Basis, work: &Work) -> Result<Bsdf> {
    with_sides(product, basis, true, work, |product, front| {
        let [incident, exiting] = basis.divisions();
        let averages = Averages { product, incident, exiting, blur: None, isotropic: basis.is_isotropic() };
        let scattered = |column| averages.scattered(column).into_iter().map(|v| v as f32).collect();
        let scattered = work.columns(("scattered", front), averages.incident.len(), scattered)?;
        let deltas: Vec<Delta> =
            (0..scattered.len()).into_par_iter().map(|column| averages.delta(column)).collect();
        Ok(with_exact_peak(basis, |column, cell| scattered[column][cell], &deltas, product.tint()))
    })
}

/// Both sides of a product from what makes one.
fn with_sides(
    product: &dyn Product,
    basis: Basis,
    exact: bool,
    work: &Work,
    side: impl Fn(&dyn Product, bool) -> Result<Distribution>,
) -> Result<Bsdf> {
    if basis.is_isotropic() && !product.is_isotropic() {
        return Err(Error::value(format!(
            "{}: not the same at all azimuths; expected a matrix or a t4 basis",
            product.name()
        )));
    }
    // Isotropic products are the same from behind; counted anew, they differ by their noise.
    let alike = product.is_isotropic() && exact;
    let [incident, _] = basis.divisions();
    work.expect(if alike { 1 } else { 2 } * incident.len());
    let front = Arc::new(side(product, true)?);
    let back = if alike { front.clone() } else { Arc::new(side(&OtherSide(product), false)?) };
    let [reflection_front, reflection_back] = product
        .reflectance()
        .map(|reflectance| Some(Arc::new(diffuse(reflectance, product.reflected_tint(), basis))));
    let document = Document {
        name: product.name(),
        manufacturer: "Sunpeak (synthetic)".into(),
        structure: basis.structure().into(),
        ..Document::default()
    };
    let sides = Sides {
        transmission_front: Some(front),
        transmission_back: Some(back),
        reflection_front,
        reflection_back,
    };
    Ok(Bsdf::from_sides(document, sides))
}

fn diffuse(reflectance: f64, tint: Option<[f64; 2]>, basis: Basis) -> Distribution {
    let table = |value: f64| constant(value as f32, basis);
    let color = tint.map(|xz| xz.map(|tint| table(tint * reflectance / PI).into_values()));
    Distribution::new(table(reflectance / PI), color)
}

fn constant(value: f32, basis: Basis) -> Table {
    match basis.patches() {
        Some(basis) => {
            let values = vec![value; basis.len() * basis.len()];
            Table::Matrix(Matrix { incident: basis.clone(), exiting: basis, values })
        }
        None => Table::Tree(Tree::regular(if basis.is_isotropic() { 3 } else { 4 }, 0, |_| value)),
    }
}

/// A luminous table, and CIE X and Z of coloured products.
type Planes = (Table, Option<[Vec<f32>; 2]>);

fn transmission(
    product: &dyn Product,
    basis: Basis,
    seen_by: &Goniophotometer,
    front: bool,
    work: &Work,
) -> Result<Planes> {
    let layout = basis.layout();
    let Layout { incident, exiting } = layout.clone();
    let averages =
        Averages { product, incident, exiting, blur: seen_by.blur(), isotropic: basis.is_isotropic() };
    let width = averages.exiting.len();
    let column = |i| averages.column(i, seen_by).concat();
    let columns = work.columns(("seen", front), averages.incident.len(), column)?;
    let plane = |k: usize| layout.table(|column, cell| columns[column][k * width + cell]);
    let color = product.tint().map(|_| [plane(1).into_values(), plane(2).into_values()]);
    Ok((plane(0), color))
}

/// Cell averages of one side of a product.
struct Averages<'a> {
    product: &'a dyn Product,
    incident: Columns,
    exiting: Columns,
    /// What the instrument makes of a delta.
    blur: Option<Spread>,
    isotropic: bool,
}

impl Averages<'_> {
    /// Y, X, Z [1/sr] of one incident cell's exiting cells; X and Z are empty for gray products.
    fn column(&self, column: usize, seen_by: &Goniophotometer) -> [Vec<f32>; 3] {
        let scattered = self.scattered(column);
        let mut straight = vec![0.0; scattered.len()];
        match self.blur {
            Some(spread) => {
                let lobe = |p: DVec2| Some(Lobe { flux: self.product.through(p), spread });
                self.add_lobes(column, &mut straight, lobe);
            }
            None => self.delta(column).cells.iter().for_each(|&(cell, density)| straight[cell] = density),
        }
        let exact: Vec<f64> = scattered.iter().zip(&straight).map(|(s, t)| s + t).collect();
        let area = |cell: usize| self.exiting.projected_solid_angle(cell);
        let seen = seen_by.counts(&exact, area, column);
        let plane = |tint: f64| {
            (0..exact.len())
                .map(|k| {
                    let share = if exact[k] > 0.0 { seen[k] / exact[k] } else { 0.0 };
                    (share * (tint * scattered[k] + straight[k])) as f32
                })
                .collect()
        };
        match self.product.tint() {
            Some([x, z]) => [plane(1.0), plane(x), plane(z)],
            None => [plane(1.0), Vec::new(), Vec::new()],
        }
    }

    fn scattered(&self, column: usize) -> Vec<f64> {
        let mut values = self.smooth(column);
        self.add_lobes(column, &mut values, |p| self.product.lobe(p));
        values
    }

    fn smooth(&self, column: usize) -> Vec<f64> {
        let n = if matches!(self.exiting, Columns::Patches(_)) { PATCH_POINTS } else { TREE_POINTS };
        let incident = self.incident.points(column, n);
        let mean_at = |q: DVec2| mean(incident.iter().map(|&p| self.product.smooth(p, q)));
        (0..self.exiting.len()).map(|o| mean(square(n).map(|u| mean_at(self.exiting.point(o, u))))).collect()
    }

    fn delta(&self, column: usize) -> Delta {
        let points = self.incident.points(column, THROUGH_POINTS).into_iter();
        let values: Vec<(DVec2, f64)> = points.map(|p| (p, self.product.through(p))).collect();
        Delta::over(&values, &self.exiting, self.isotropic)
    }

    fn add_lobes(&self, column: usize, values: &mut [f64], lobe: impl Fn(DVec2) -> Option<Lobe>) {
        let middle = self.incident.point(column, [0.5, 0.5]);
        let Some(spread) = lobe(middle).map(|l| l.spread) else { return };
        let width = |columns: &Columns, cell: usize| columns.projected_solid_angle(cell).sqrt();
        let exit = self.exiting.index(middle + DVec2::new(0.0, BESIDE));
        let kernel = Kernel::new(spread, width(&self.exiting, exit));
        let own = match self.incident {
            Columns::Radial { side } => 2.0 / side as f64,
            _ => width(&self.incident, column),
        };
        let n = (own / spread.sigma()).clamp(LOBE_POINTS[0], LOBE_POINTS[1]).ceil() as usize;
        let points = self.incident.points(column, n);
        let share = 1.0 / points.len() as f64;
        for p in points {
            let Some(lobe) = lobe(p).filter(|l| l.flux > 0.0) else { continue };
            // What would leave the hemisphere is spread over the rest.
            let mut kept = 0.0;
            kernel.around(p, |_, weight| kept += weight);
            kernel.around(p, |q, weight| {
                let cell = self.exiting.index(q);
                values[cell] += share * lobe.flux * weight / kept / self.exiting.projected_solid_angle(cell);
            });
        }
    }
}

fn midpoints(n: usize) -> impl Iterator<Item = f64> + Clone {
    (0..n).map(move |i| (i as f64 + 0.5) / n as f64)
}

fn square(n: usize) -> impl Iterator<Item = [f64; 2]> {
    midpoints(n).flat_map(move |u| midpoints(n).map(move |v| [u, v]))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
    if n > 0.0 { sum / n } else { 0.0 }
}
