//! A system in a basis.

use super::{
    Band, System,
    cells::{Cells, STRAIGHT_POINTS},
    operator::Operators,
    optics::{Around, Optics},
    range_of,
    shade::Range,
};
use crate::{
    bsdf::{Bsdf, Sides},
    distribution::Distribution,
    exact_peak::{Delta, with_exact_peak},
    synthetic::Basis,
    table::Columns,
    work::Work,
    xml::Document,
};
use glam::DVec2;
use ndarray::Array2;
use rayon::prelude::*;
use std::sync::Arc;
use sunpeak_core::Result;

/// What stands for a pane in a patch of a matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Panes {
    /// Its mean over the patch, by flux.
    #[default]
    Mean,
    /// Its value at the middle angle of the patch, as WINDOW has it.
    Middle,
}

/// Wavelengths at which all stacks of panes differ by less than this [-] are taken together: what scattering then misses is of second
/// order in it, and what goes straight is not touched.
const ALIKE: f64 = 0.02;

/// Side of the grid on which light that is scattered more than once is followed for trees.
const COARSE_SIDE: usize = 16;

/// Points a side of a tree's cell over which a residual is averaged for light that is scattered once.
const ONCE_POINTS: usize = 2;

/// The same for panes, which change fast at grazing incidence.
const PANE_POINTS: usize = 4;

/// Points a side of a patch for panes.
const PATCH_POINTS: usize = 8;

/// Wavelengths at which the system is alike.
struct Group {
    range: Range,
    weight: f64,
    wavelengths: Vec<[f64; 2]>,
    /// Normal optics of each stack at its first wavelength.
    sample: Vec<Optics>,
}

/// Scattered fluxes by the sides where they come from and go to.
type Fluxes = [[Array2<f64>; 2]; 2];

fn zeros(n: usize) -> Fluxes {
    let zero = || Array2::zeros((n, n));
    [[zero(), zero()], [zero(), zero()]]
}

impl System {
    /// One band of the system in a basis, its straight part kept exact.
    ///
    /// # Errors
    /// Where a shade lacks the band or does not fit the basis; when the work is stopped.
    pub fn tabulate(&self, basis: Basis, band: Band, panes: Panes, work: &Work) -> Result<Bsdf> {
        self.check(band)?;
        self.check_basis(basis)?;
        let solver = Solver::new(self, basis, band, panes);
        let scattered = solver.scattered(work)?;
        let [incident, exiting] = basis.divisions();
        let straight: Vec<Vec<(DVec2, Optics)>> = (0..incident.len())
            .into_par_iter()
            .map(|column| solver.straight_over(&incident, column))
            .collect();
        let delta = |of: &dyn Fn(&Optics) -> f64| -> Vec<Delta> {
            let each = straight.iter().map(|points| {
                let values: Vec<(DVec2, f64)> = points.iter().map(|(p, optics)| (*p, of(optics))).collect();
                Delta::over(&values, &exiting, basis.is_isotropic())
            });
            each.collect()
        };
        let value = |from: usize, to: usize| {
            let table = &scattered[from][to];
            move |column: usize, cell: usize| table[column][cell]
        };
        let transmission = |from: usize| {
            let deltas = delta(&|o| o.t[from]);
            Some(Arc::new(with_exact_peak(basis, value(from, 1 - from), &deltas, None)))
        };
        let reflection = |from: usize| {
            let deltas = delta(&|o| o.r[from]);
            let value = value(from, from);
            let table = basis
                .layout()
                .table(|column, cell| (f64::from(value(column, cell)) + deltas[column].at(cell)) as f32);
            Some(Arc::new(Distribution::new(table, None)))
        };
        let sides = Sides {
            transmission_front: transmission(0),
            transmission_back: transmission(1),
            reflection_front: reflection(0),
            reflection_back: reflection(1),
        };
        let document = Document {
            name: self.name.clone(),
            manufacturer: "Sunpeak (system)".into(),
            structure: basis.structure().into(),
            ..Document::default()
        };
        Ok(Bsdf::from_sides(document, sides))
    }

    fn check_basis(&self, basis: Basis) -> Result<()> {
        if basis.is_isotropic() && !self.shades.iter().all(super::Shade::is_isotropic) {
            return Err(sunpeak_core::Error::value(format!(
                "{}: a shade's table is not one for all azimuths; expected a matrix or a t4 basis",
                self.name
            )));
        }
        Ok(())
    }
}

struct Solver<'a> {
    system: &'a System,
    basis: Basis,
    band: Band,
    panes: Panes,
    /// Where light is followed through the matrices.
    cells: Cells,
    groups: Vec<Group>,
}

impl<'a> Solver<'a> {
    fn new(system: &'a System, basis: Basis, band: Band, panes: Panes) -> Self {
        let division = match basis.patches() {
            Some(patches) => Columns::Patches(patches),
            None => {
                let [_, exiting] = basis.divisions();
                let side = (exiting.len() as f64).sqrt().round() as usize;
                Columns::Square { side: side.min(COARSE_SIDE) }
            }
        };
        Self { system, basis, band, panes, cells: Cells { division }, groups: groups(system, band) }
    }

    /// What keeps its direction, over a column.
    fn straight_over(&self, incident: &Columns, column: usize) -> Vec<(DVec2, Optics)> {
        if self.in_middle() {
            let p = middle(incident, column);
            let through = |k: usize, range, from| self.through(k, range, from, column);
            let optics = self.system.straight_with(self.band, cosine(p), &through);
            return vec![(incident.point(column, [0.5, 0.5]), optics)];
        }
        let points = incident.points(column, STRAIGHT_POINTS);
        points.into_iter().map(|p| (p, self.system.straight_at(self.band, p))).collect()
    }

    fn in_middle(&self) -> bool {
        self.panes == Panes::Middle && matches!(self.cells.division, Columns::Patches(_))
    }

    /// A shade's through transmittance, its mean over a cell.
    fn through(&self, shade: usize, range: Range, from: usize, cell: usize) -> f64 {
        let points = self.cells.division.points(cell, STRAIGHT_POINTS);
        let sum: f64 = points.iter().map(|&p| self.system.shades[shade].through(range, from, p)).sum();
        sum / points.len() as f64
    }

    /// The panes of a stack over a cell.
    fn stack_over(&self, k: usize, group: &Group, cell: usize) -> Optics {
        let points = if self.in_middle() {
            vec![middle(&self.cells.division, cell)]
        } else {
            self.cells.division.points(cell, PATCH_POINTS)
        };
        let share = 1.0 / points.len() as f64;
        Optics::mean(points.into_iter().map(|p| (share, self.stack(k, group, p))))
    }

    /// The panes of a stack at a point, the mean over a group.
    fn stack(&self, k: usize, group: &Group, p: DVec2) -> Optics {
        let each = group.wavelengths.iter();
        Optics::mean(each.map(|&[um, w]| (w / group.weight, self.system.stack(k, um, cosine(p)))))
    }

    /// What is scattered [1/sr], by the sides where it comes from and goes to, by column and exiting cell.
    fn scattered(&self, work: &Work) -> Result<[[Vec<Vec<f32>>; 2]; 2]> {
        let [incident, exiting] = self.basis.divisions();
        if self.system.shades.is_empty() {
            let nothing = || vec![vec![0.0; exiting.len()]; incident.len()];
            return Ok([[nothing(), nothing()], [nothing(), nothing()]]);
        }
        let on_cells = matches!(self.cells.division, Columns::Patches(_));
        work.expect(self.groups.len() + 4 * incident.len());
        let fluxes = self.fluxes(!on_cells, work)?;
        let area = |cell: usize| self.cells.division.projected_solid_angle(cell);
        let once = (!on_cells).then(|| Once::new(self, &incident, &exiting));
        let side = |from: usize, to: usize| -> Result<Vec<Vec<f32>>> {
            let column = |column: usize| -> Vec<f32> {
                let i = self.cells.division.index(incident.point(column, [0.5, 0.5]));
                let first = once.as_ref().map(|once| once.column(self, from, to, column));
                let value = |cell: usize| {
                    let o = self.cells.division.index(exiting.point(cell, [0.5, 0.5]));
                    let rest = fluxes[from][to][[o, i]] / area(o);
                    (first.as_ref().map_or(0.0, |f| f[cell]) + rest).max(0.0) as f32
                };
                (0..exiting.len()).map(value).collect()
            };
            work.columns(("scattered", from, to), incident.len(), column)
        };
        Ok([[side(0, 0)?, side(0, 1)?], [side(1, 0)?, side(1, 1)?]])
    }

    /// Fluxes that are scattered; if asked, without those that are scattered only once.
    fn fluxes(&self, beyond_once: bool, work: &Work) -> Result<Fluxes> {
        let n = self.cells.len();
        let (system, mut sum) = (self.system, zeros(n));
        let ranges = [Range::Visible, Range::Invisible].map(|range| {
            let used = self.groups.iter().any(|group| group.range == range);
            used.then(|| {
                let each = system.shades.iter().enumerate().map(|(k, shade)| {
                    let through: Vec<[f64; 2]> =
                        (0..n).map(|cell| [0, 1].map(|from| self.through(k, range, from, cell))).collect();
                    (through, self.cells.residual(shade, range))
                });
                each.collect::<Vec<_>>()
            })
        });
        for group in &self.groups {
            work.check()?;
            let Some(shades) = &ranges[usize::from(group.range == Range::Invisible)] else { continue };
            let stack = |k: usize| -> Vec<Optics> { (0..n).map(|c| self.stack_over(k, group, c)).collect() };
            let mut straight = vec![stack(0)];
            let mut whole = Operators::straight(&straight[0]);
            for (k, (through, residual)) in shades.iter().enumerate() {
                let holes: Vec<Optics> = through.iter().map(|&t| Optics { t, r: [0.0; 2] }).collect();
                whole = whole.then(&Operators::straight(&holes).with(residual));
                straight.push(holes);
                straight.push(stack(k + 1));
                whole = whole.then(&Operators::straight(&straight[2 * k + 2]));
            }
            let all = |c: usize| straight.iter().fold(Optics::CLEAR, |all, layer| all.then(layer[c]));
            let deltas = Operators::straight(&(0..n).map(all).collect::<Vec<_>>());
            for (from, sum) in sum.iter_mut().enumerate() {
                for (to, operator, delta) in
                    [(1 - from, &whole.t[from], &deltas.t[from]), (from, &whole.r[from], &deltas.r[from])]
                {
                    operator.add_to(&mut sum[to], group.weight);
                    delta.add_to(&mut sum[to], -group.weight);
                }
            }
            if beyond_once {
                for (k, (_, residual)) in shades.iter().enumerate() {
                    let around: Vec<Around> = (0..n).map(|c| around(&straight, 2 * k + 1, c)).collect();
                    take_once(&mut sum, group.weight, &around, residual);
                }
            }
            work.advance(1);
        }
        Ok(sum)
    }
}

/// Take away what one layer scatters once.
fn take_once(sum: &mut Fluxes, weight: f64, around: &[Around], residual: &Fluxes) {
    for (from, sum) in sum.iter_mut().enumerate() {
        let arriving: Vec<[f64; 2]> = around.iter().map(|a| a.arriving(from)).collect();
        for (upon, kernels) in residual.iter().enumerate() {
            for (leaves, kernel) in kernels.iter().enumerate() {
                let leaving: Vec<[f64; 2]> = around.iter().map(|a| a.leaving(leaves)).collect();
                for (to, sum) in sum.iter_mut().enumerate() {
                    for ((o, i), value) in sum.indexed_iter_mut() {
                        *value -= weight * leaving[o][to] * kernel[[o, i]] * arriving[i][upon];
                    }
                }
            }
        }
    }
}

/// Straight light around one layer of a list at a cell.
fn around(layers: &[Vec<Optics>], own: usize, cell: usize) -> Around {
    let fold = |layers: &[Vec<Optics>]| layers.iter().fold(Optics::CLEAR, |all, layer| all.then(layer[cell]));
    Around::new(fold(&layers[..own]), layers[own][cell], fold(&layers[own + 1..]))
}

/// Two sides by two sides.
type Shares = [[f64; 2]; 2];

/// Light that one shade scatters once, in the cells of a tree.
struct Once {
    incident: Vec<Vec<DVec2>>,
    exiting: Vec<Vec<DVec2>>,
    /// By group, shade and incident cell: light from a side of the system that comes upon a side of the shade.
    arriving: Vec<Vec<Vec<Shares>>>,
    /// By group, shade and exiting cell: light from a side of the shade that leaves on a side of the system.
    leaving: Vec<Vec<Vec<Shares>>>,
}

impl Once {
    fn new(solver: &Solver, incident: &Columns, exiting: &Columns) -> Self {
        let points = |division: &Columns| -> Vec<Vec<DVec2>> {
            (0..division.len()).map(|cell| division.points(cell, ONCE_POINTS)).collect()
        };
        let shares = |division: &Columns, of: fn(&Around, usize) -> [f64; 2]| -> Vec<Vec<Vec<Shares>>> {
            let of_cell = |group: &Group, cell: usize| {
                solver.shares_over(group, &division.points(cell, PANE_POINTS), of)
            };
            let of_group = |group: &Group| {
                let cells: Vec<Vec<Shares>> =
                    (0..division.len()).into_par_iter().map(|cell| of_cell(group, cell)).collect();
                (0..solver.system.shades.len()).map(|k| cells.iter().map(|c| c[k]).collect()).collect()
            };
            solver.groups.iter().map(of_group).collect()
        };
        Self {
            incident: points(incident),
            exiting: points(exiting),
            arriving: shares(incident, Around::arriving),
            leaving: shares(exiting, Around::leaving),
        }
    }

    /// One column's values [1/sr].
    fn column(&self, solver: &Solver, from: usize, to: usize, column: usize) -> Vec<f64> {
        let mut values = vec![0.0; self.exiting.len()];
        for (k, shade) in solver.system.shades.iter().enumerate() {
            for range in [Range::Visible, Range::Invisible] {
                let groups: Vec<usize> =
                    (0..solver.groups.len()).filter(|&g| solver.groups[g].range == range).collect();
                if groups.is_empty() {
                    continue;
                }
                for (upon, leaves) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    for (cell, value) in values.iter_mut().enumerate() {
                        let factor: f64 = groups
                            .iter()
                            .map(|&g| {
                                let arriving = self.arriving[g][k][column][from][upon];
                                let leaving = self.leaving[g][k][cell][leaves][to];
                                solver.groups[g].weight * arriving * leaving
                            })
                            .sum();
                        if factor <= 0.0 {
                            continue;
                        }
                        let (incident, exiting) = (&self.incident[column], &self.exiting[cell]);
                        let pairs = incident.iter().flat_map(|&p| exiting.iter().map(move |&q| (p, q)));
                        let sum: f64 = pairs.map(|(p, q)| shade.residual(range, upon, leaves, p, q)).sum();
                        *value += factor * sum / (incident.len() * exiting.len()) as f64;
                    }
                }
            }
        }
        values
    }
}

impl Solver<'_> {
    /// Means over points of what comes upon each shade, or leaves it.
    fn shares_over(
        &self,
        group: &Group,
        points: &[DVec2],
        of: fn(&Around, usize) -> [f64; 2],
    ) -> Vec<Shares> {
        let mut means = vec![Shares::default(); self.system.shades.len()];
        for &p in points {
            let layers = self.layers_at(group, p);
            for (k, mean) in means.iter_mut().enumerate() {
                let around = around(&layers, 2 * k + 1, 0);
                for (side, shares) in mean.iter_mut().enumerate() {
                    for (share, value) in shares.iter_mut().zip(of(&around, side)) {
                        *share += value / points.len() as f64;
                    }
                }
            }
        }
        means
    }

    /// Stacks and shades in their order at one point, as lists of one cell.
    fn layers_at(&self, group: &Group, p: DVec2) -> Vec<Vec<Optics>> {
        let mut layers = vec![vec![self.stack(0, group, p)]];
        for (k, shade) in self.system.shades.iter().enumerate() {
            let t = [0, 1].map(|from| shade.through(group.range, from, p));
            layers.push(vec![Optics { t, r: [0.0; 2] }]);
            layers.push(vec![self.stack(k + 1, group, p)]);
        }
        layers
    }
}

fn cosine(p: DVec2) -> f64 {
    (1.0 - p.length_squared()).max(0.0).sqrt()
}

/// The middle of a patch as WINDOW has it: halfway between its bounds in theta, the pole at the normal.
fn middle(division: &Columns, cell: usize) -> DVec2 {
    let Columns::Patches(basis) = division else { return division.point(cell, [0.5, 0.5]) };
    let (ring, _) = basis.ring_of(cell);
    if ring.phi_count == 1 {
        return DVec2::ZERO;
    }
    let theta = 0.5 * (ring.lower_theta_deg + ring.upper_theta_deg);
    division.point(cell, [0.5, 0.5]).normalize_or_zero() * theta.to_radians().sin()
}

/// Put wavelengths together at which no stack of panes differs by much.
fn groups(system: &System, band: Band) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for &[um, weight] in band.weights().iter().filter(|w| w[1] > 0.0) {
        let range = range_of(um);
        let sample: Vec<Optics> = (0..system.panes.len()).map(|k| system.stack(k, um, 1.0)).collect();
        let alike = |group: &&mut Group| {
            group.range == range && group.sample.iter().zip(&sample).all(|(a, b)| a.distance(b) < ALIKE)
        };
        match groups.iter_mut().find(alike) {
            Some(group) => {
                group.weight += weight;
                group.wavelengths.push([um, weight]);
            }
            None => groups.push(Group { range, weight, wavelengths: vec![[um, weight]], sample }),
        }
    }
    groups
}
