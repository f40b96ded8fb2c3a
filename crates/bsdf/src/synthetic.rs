//! Fabrics of our own making: analytic through transmittance with a cut-off and a scattered part, tabulated by cell averages.
//!
//! The model is that of the design studies for peak extraction: a closed form for every quantity that a table should give back.

use crate::{
    basis::AngleBasis,
    bsdf::{Bsdf, Sides},
    distribution::Distribution,
    table::{Matrix, Table},
    tree::Tree,
    xml::Document,
};
use glam::DVec2;
use rayon::prelude::*;
use std::{f64::consts::PI, sync::Arc};
use sunpeak_core::{Error, Result, warp::square_to_disk};

/// An isotropic fabric: a delta straight through, a diffuse part and a lobe around the straight direction; both sides alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fabric {
    /// Through transmittance at normal incidence [-]: the openness factor.
    pub openness: f64,
    /// Angle of incidence past which nothing goes straight through [deg].
    pub cutoff_deg: f64,
    /// Steepness p of `T(theta) = openness cos(90 deg theta / cutoff)^p`.
    pub exponent: f64,
    /// Scattered transmittance [-], the same for every incidence.
    pub scattered: f64,
    /// Share of the scattered part in the lobe; the rest is diffuse.
    pub lobe_share: f64,
    /// Standard deviation of the Gaussian lobe on the disk of projected directions.
    pub lobe_sigma: f64,
    /// Diffuse reflectance [-].
    pub reflectance: f64,
}

impl Default for Fabric {
    /// A 2 % fabric with a cut-off at 68 degrees.
    fn default() -> Self {
        Self {
            openness: 0.02,
            cutoff_deg: 68.0,
            exponent: 0.6,
            scattered: 0.06,
            lobe_share: 0.4,
            lobe_sigma: 0.25,
            reflectance: 0.35,
        }
    }
}

/// The basis to tabulate in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// LBNL/Klems Full (145 patches).
    KlemsFull,
    /// LBNL/Klems Half (77 patches).
    KlemsHalf,
    /// LBNL/Klems Quarter (41 patches).
    KlemsQuarter,
    /// Isotropic tensor tree of `side * side` exiting cells: "1024" is a side of 32.
    TensorTree3 {
        /// Cells a side, a power of two.
        side: usize,
    },
    /// Anisotropic tensor tree of `side * side` exiting cells.
    TensorTree4 {
        /// Cells a side, a power of two.
        side: usize,
    },
}

impl std::str::FromStr for Basis {
    type Err = Error;

    /// `klems`, `klems-half`, `klems-quarter`, `t3-N`, `t4-N` with N = 4^k exiting cells.
    fn from_str(name: &str) -> Result<Self> {
        let wrong = || {
            Error::value(format!(
                "basis '{name}'; expected klems, klems-half, klems-quarter, t3-N or t4-N (N = 64, 256, 1024, 4096 or 16384)"
            ))
        };
        match name {
            "klems" | "klems-full" => return Ok(Self::KlemsFull),
            "klems-half" => return Ok(Self::KlemsHalf),
            "klems-quarter" => return Ok(Self::KlemsQuarter),
            _ => {}
        }
        let (rank, cells) = name.split_once('-').ok_or_else(wrong)?;
        let side = match cells {
            "64" => 8,
            "256" => 16,
            "1024" => 32,
            "4096" => 64,
            "16384" => 128,
            _ => return Err(wrong()),
        };
        match rank {
            "t3" => Ok(Self::TensorTree3 { side }),
            "t4" => Ok(Self::TensorTree4 { side }),
            _ => Err(wrong()),
        }
    }
}

/// Points a side over which a cell's average is taken, incident and exiting: the lobe is wide against a tree's cells, not
/// against a patch.
const TREE_POINTS: usize = 2;
const PATCH_POINTS: usize = 6;

/// Points over which the through transmittance is averaged; its slope is infinite at the cut-off.
const THROUGH_POINTS: usize = 64;

impl Fabric {
    /// Is every number in its domain, and is no more light scattered than comes in?
    pub fn check(&self) -> Result<()> {
        let unit = |name: &str, value: f64| {
            (0.0..=1.0).contains(&value).then_some(()).ok_or_else(|| {
                Error::value(format!("fabric: {name} is {value}; expected a number from 0 to 1"))
            })
        };
        unit("openness", self.openness)?;
        unit("scattered", self.scattered)?;
        unit("lobe_share", self.lobe_share)?;
        unit("reflectance", self.reflectance)?;
        let sum = self.openness + self.scattered + self.reflectance;
        if sum > 1.0 {
            return Err(Error::value(format!(
                "fabric: openness, scattered and reflectance add up to {sum}; expected no more than 1"
            )));
        }
        if !(self.cutoff_deg > 0.0 && self.cutoff_deg <= 90.0) {
            return Err(Error::value(format!("fabric: cutoff_deg is {}; expected 0 to 90", self.cutoff_deg)));
        }
        if !(self.exponent > 0.0
            && self.exponent.is_finite()
            && self.lobe_sigma > 0.0
            && self.lobe_sigma.is_finite())
        {
            return Err(Error::value("fabric: exponent and lobe_sigma must be positive"));
        }
        Ok(())
    }

    /// Through transmittance [-] at an angle of incidence [rad].
    pub fn through(&self, theta: f64) -> f64 {
        let cutoff = self.cutoff_deg.to_radians();
        if theta >= cutoff {
            0.0
        } else {
            self.openness * (0.5 * PI * theta / cutoff).cos().powf(self.exponent)
        }
    }

    fn through_at(&self, p: DVec2) -> f64 {
        self.through(p.length().min(1.0).asin())
    }

    /// Scattered BTDF [1/sr]: diffuse, and the lobe normalised to its share over the disk.
    fn scattered(&self, p_in: DVec2, p_out: DVec2, lobe_norm: f64) -> f64 {
        let lobe = (-0.5 * (p_out - p_in).length_squared() / self.lobe_sigma.powi(2)).exp();
        self.scattered * ((1.0 - self.lobe_share) / PI + self.lobe_share * lobe * lobe_norm)
    }

    /// One over the lobe's integral over the disk, for incidence at radius `r`: by summing over a fine grid.
    fn lobe_norm(&self, r: f64) -> f64 {
        let n = 200;
        let mut sum = 0.0;
        for i in 0..n * n {
            let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
            let p: DVec2 = square_to_disk(u).into();
            sum += (-0.5 * (p - DVec2::new(r, 0.0)).length_squared() / self.lobe_sigma.powi(2)).exp();
        }
        (n * n) as f64 / (PI * sum)
    }

    /// Tabulate transmission by averages over cells; the delta's share of each cell is exact.
    pub fn tabulate(&self, basis: Basis) -> Result<Bsdf> {
        self.check()?;
        let (transmission, reflection) = (self.transmission(basis), self.reflection(basis));
        let transmission = Arc::new(Distribution::with_split(transmission, None));
        let reflection = Arc::new(Distribution::new(reflection, None));
        let document = Document {
            name: format!("Sunpeak fabric {:.3} % open", 100.0 * self.openness),
            manufacturer: "Sunpeak (synthetic)".into(),
            structure: match basis {
                Basis::TensorTree3 { .. } => "TensorTree3".into(),
                Basis::TensorTree4 { .. } => "TensorTree4".into(),
                _ => "Columns".into(),
            },
            ..Document::default()
        };
        let sides = Sides {
            transmission_front: Some(transmission.clone()),
            transmission_back: Some(transmission),
            reflection_front: Some(reflection.clone()),
            reflection_back: Some(reflection),
        };
        Ok(Bsdf::from_sides(document, sides))
    }

    fn reflection(&self, basis: Basis) -> Table {
        let value = (self.reflectance / PI) as f32;
        match known_basis(basis) {
            Some(basis) => {
                let values = vec![value; basis.len() * basis.len()];
                Table::Matrix(Matrix { incident: basis.clone(), exiting: basis, values })
            }
            None => {
                let rank = if matches!(basis, Basis::TensorTree3 { .. }) { 3 } else { 4 };
                Table::Tree(Tree::regular(rank, 0, |_| value))
            }
        }
    }

    fn transmission(&self, basis: Basis) -> Table {
        let norms: Vec<f64> = (0..=256).map(|i| self.lobe_norm(f64::from(i) / 256.0)).collect();
        let norm = |r: f64| {
            let at = r.min(1.0) * 256.0;
            let i = (at as usize).min(255);
            norms[i] + (at - i as f64) * (norms[i + 1] - norms[i])
        };
        match basis {
            Basis::TensorTree3 { side } => self.isotropic_tree(side, norm),
            Basis::TensorTree4 { side } => self.anisotropic_tree(side, norm),
            matrix => match known_basis(matrix) {
                Some(basis) => self.matrix(basis, norm),
                None => unreachable!("every other basis is a known matrix basis"),
            },
        }
    }

    fn matrix(&self, basis: Arc<AngleBasis>, norm: impl Fn(f64) -> f64 + Sync) -> Table {
        let n = basis.len();
        let columns: Vec<Vec<f32>> = (0..n)
            .into_par_iter()
            .map(|i| {
                let mut column = vec![0.0; n];
                let incident: Vec<DVec2> = points(PATCH_POINTS).map(|u| basis.point(i, u)).collect();
                for (o, value) in column.iter_mut().enumerate() {
                    let exits: Vec<DVec2> = points(PATCH_POINTS).map(|u| basis.point(o, u)).collect();
                    *value = f64::from(self.mean_scattered(&incident, &exits, &norm));
                }
                let through = mean(points(THROUGH_POINTS).map(|u| self.through_at(basis.point(i, u))));
                column[i] += through / basis.projected_solid_angle(i);
                column.into_iter().map(|v: f64| v as f32).collect()
            })
            .collect();
        Table::Matrix(Matrix { incident: basis.clone(), exiting: basis, values: columns.concat() })
    }

    fn isotropic_tree(&self, side: usize, norm: impl Fn(f64) -> f64 + Sync) -> Table {
        let log2 = side.trailing_zeros() as u8;
        let radius = |k: usize, u: f64| 1.0 - 2.0 * (k as f64 + u) / side as f64;
        let area = PI / (side * side) as f64;
        let columns: Vec<Vec<f32>> = (0..side)
            .into_par_iter()
            .map(|k| {
                if k >= side / 2 {
                    return vec![0.0; side * side]; // the unused half
                }
                let incident: Vec<DVec2> =
                    midpoints(TREE_POINTS).map(|u| DVec2::new(radius(k, u), 0.0)).collect();
                let mut column: Vec<f64> = (0..side * side)
                    .map(|cell| {
                        let exits: Vec<DVec2> = square_points(cell, side, TREE_POINTS).collect();
                        f64::from(self.mean_scattered(&incident, &exits, &norm))
                    })
                    .collect();
                let through = mean(
                    midpoints(THROUGH_POINTS * THROUGH_POINTS)
                        .map(|u| self.through_at(DVec2::new(radius(k, u), 0.0))),
                );
                // The straight direction runs along the border of two rows.
                for row in [side / 2 - 1, side / 2] {
                    column[(side - 1 - k) * side + row] += 0.5 * through / area;
                }
                column.into_iter().map(|v| v as f32).collect()
            })
            .collect();
        Table::Tree(Tree::regular(3, log2, |c| columns[c[0]][c[1] * side + c[2]]))
    }

    fn anisotropic_tree(&self, side: usize, norm: impl Fn(f64) -> f64 + Sync) -> Table {
        let log2 = side.trailing_zeros() as u8;
        let area = PI / (side * side) as f64;
        let columns: Vec<Vec<f32>> = (0..side * side)
            .into_par_iter()
            .map(|i| {
                let incident: Vec<DVec2> = square_points(i, side, TREE_POINTS).collect();
                let mut column: Vec<f32> = (0..side * side)
                    .map(|o| {
                        let exits: Vec<DVec2> = square_points(o, side, TREE_POINTS).collect();
                        self.mean_scattered(&incident, &exits, &norm)
                    })
                    .collect();
                let through = mean(square_points(i, side, THROUGH_POINTS).map(|p| self.through_at(p)));
                column[i] += (through / area) as f32;
                column
            })
            .collect();
        Table::Tree(Tree::regular(4, log2, |c| columns[c[0] * side + c[1]][c[2] * side + c[3]]))
    }

    fn mean_scattered(&self, incident: &[DVec2], exits: &[DVec2], norm: impl Fn(f64) -> f64) -> f32 {
        let each = incident.iter().map(|&p| {
            let norm = norm(p.length());
            mean(exits.iter().map(|&q| self.scattered(p, q, norm)))
        });
        mean(each) as f32
    }
}

fn known_basis(basis: Basis) -> Option<Arc<AngleBasis>> {
    let name = match basis {
        Basis::KlemsFull => "LBNL/Klems Full",
        Basis::KlemsHalf => "LBNL/Klems Half",
        Basis::KlemsQuarter => "LBNL/Klems Quarter",
        Basis::TensorTree3 { .. } | Basis::TensorTree4 { .. } => return None,
    };
    AngleBasis::known(name).map(Arc::new)
}

fn midpoints(n: usize) -> impl Iterator<Item = f64> + Clone {
    (0..n).map(move |i| (i as f64 + 0.5) / n as f64)
}

fn points(n: usize) -> impl Iterator<Item = [f64; 2]> {
    midpoints(n).flat_map(move |u| midpoints(n).map(move |v| [u, v]))
}

fn square_points(cell: usize, side: usize, n: usize) -> impl Iterator<Item = DVec2> {
    points(n).map(move |[u, v]| {
        let at = |cell: usize, u: f64| (cell as f64 + u) / side as f64;
        square_to_disk([at(cell / side, u), at(cell % side, v)]).into()
    })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
    if n > 0.0 { sum / n } else { 0.0 }
}
