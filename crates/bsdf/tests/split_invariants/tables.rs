//! Random tables of every kind: matrices on known bases and on others, regular trees, trees with leaves of mixed sizes.

use crate::common::random;
use glam::DVec2;
use proptest::prelude::*;
use std::{f64::consts::PI, fmt, sync::Arc};
use sunpeak_bsdf::{
    Distribution,
    basis::AngleBasis,
    table::{Matrix, Table},
    tree::{Tree, TreeBuilder},
};
use sunpeak_core::warp::square_to_disk;

/// Where the cells of a table are.
#[derive(Clone)]
pub enum Shape {
    /// Incident and exiting basis.
    Matrix(Arc<AngleBasis>, Arc<AngleBasis>),
    /// `2^log2` cells a side.
    Regular { rank: usize, log2: u8 },
    /// Leaves of random sizes, at most `depth` times halved.
    Mixed { rank: usize, depth: u32, seed: u32 },
}

impl fmt::Debug for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rings = |basis: &AngleBasis| -> Vec<(f64, usize)> {
            basis.rings().iter().map(|r| (r.upper_theta_deg, r.phi_count)).collect()
        };
        match self {
            Self::Matrix(a, b) => write!(f, "matrix of {:?} by {:?}", rings(a), rings(b)),
            Self::Regular { rank, log2 } => write!(f, "regular tree, rank {rank}, 2^{log2}"),
            Self::Mixed { rank, depth, seed } => {
                write!(f, "mixed tree, rank {rank}, depth {depth}, seed {seed}")
            }
        }
    }
}

/// What is in a table.
#[derive(Clone, Debug)]
pub struct Content {
    pub seed: u32,
    /// Diffuse part [1/sr].
    pub base: f64,
    /// Height [1/sr] and width of a lobe around the straight direction.
    pub lobe: f64,
    pub sigma: f64,
    /// Relative noise of each cell, from 0 (smooth) to 1.
    pub noise: f64,
    /// Share of cells, and of columns, that are empty.
    pub zeros: f64,
    /// What goes straight through [-].
    pub through: f64,
    /// CIE X and Z over Y.
    pub color: Option<[f64; 2]>,
}

/// A cell: middles of both sides, and what share of a delta through its incident side it holds [1/sr].
struct Place {
    number: u32,
    column: u32,
    p_in: DVec2,
    p_out: DVec2,
    delta: f64,
}

impl Content {
    /// The same everywhere.
    pub fn flat(base: f64) -> Self {
        Self { seed: 0, base, lobe: 0.0, sigma: 1.0, noise: 0.0, zeros: 0.0, through: 0.0, color: None }
    }

    /// All goes straight through.
    pub fn clear(through: f64) -> Self {
        Self { through, ..Self::flat(0.0) }
    }

    /// The `k`-th random number of something.
    fn random(&self, of: u32, k: u32) -> f64 {
        random(self.seed.wrapping_mul(0x9e37_79b9) ^ of.wrapping_mul(0x85eb_ca6b).wrapping_add(k))
    }

    fn value(&self, place: &Place) -> f32 {
        if self.random(place.number, 0) < self.zeros || self.random(place.column, 1) < self.zeros {
            return 0.0;
        }
        let lobe = (-0.5 * (place.p_out - place.p_in).length_squared() / self.sigma.powi(2)).exp();
        let noise = 1.0 + self.noise * (2.0 * self.random(place.number, 2) - 1.0);
        let smooth = (self.base + self.lobe * lobe) * noise;
        let through = self.through * (1.0 - self.noise * self.random(place.column, 3));
        (smooth + through * place.delta) as f32
    }

    /// The table, split.
    pub fn distribution(&self, shape: &Shape) -> Distribution {
        let table = self.table(shape);
        let color = self.color.map(|ratios| {
            // Another colour in each cell.
            let plane = |of: u32, ratio: f64| {
                let value =
                    |(k, v): (usize, &f32)| (f64::from(*v) * ratio * 2.0 * self.random(of, k as u32)) as f32;
                table.values().iter().enumerate().map(value).collect()
            };
            [plane(4, ratios[0]), plane(5, ratios[1])]
        });
        Distribution::with_split(table, color)
    }

    pub fn table(&self, shape: &Shape) -> Table {
        match shape {
            Shape::Matrix(incident, exiting) => self.matrix(incident, exiting),
            Shape::Regular { rank, log2 } => {
                let leaf = |corner: [usize; 4]| {
                    let size = 0.5f64.powi(i32::from(*log2));
                    self.value(&place(*rank, corner.map(|c| c as f64 * size), size))
                };
                Table::Tree(Tree::regular(*rank, *log2, leaf))
            }
            Shape::Mixed { rank, depth, seed } => {
                let mut builder = TreeBuilder::new(*rank, 1 << 20);
                self.grow(&mut builder, *rank, [0.0; 4], 1.0, (*depth, *seed));
                Table::Tree(builder.finish().unwrap())
            }
        }
    }

    fn matrix(&self, incident: &Arc<AngleBasis>, exiting: &Arc<AngleBasis>) -> Table {
        let middle = |basis: &AngleBasis, patch| basis.point(patch, [0.5, 0.5]);
        let value = |i: usize| {
            let (column, row) = (i / exiting.len(), i % exiting.len());
            let (p_in, p_out) = (middle(incident, column), middle(exiting, row));
            let delta =
                if exiting.index(p_in) == row { 1.0 / exiting.projected_solid_angle(row) } else { 0.0 };
            self.value(&Place { number: i as u32, column: column as u32, p_in, p_out, delta })
        };
        let values = (0..incident.len() * exiting.len()).map(value).collect();
        Table::Matrix(Matrix { incident: incident.clone(), exiting: exiting.clone(), values })
    }

    fn grow(
        &self,
        builder: &mut TreeBuilder,
        rank: usize,
        corner: [f64; 4],
        size: f64,
        (depth, seed): (u32, u32),
    ) {
        builder.open().unwrap();
        if depth > 0 && random(seed) < 0.6 {
            for child in 0..1u32 << rank {
                let upper = |d: usize| if child >> d & 1 == 1 { size / 2.0 } else { 0.0 };
                let below = (depth - 1, seed.wrapping_mul(31).wrapping_add(child + 1));
                self.grow(builder, rank, std::array::from_fn(|d| corner[d] + upper(d)), size / 2.0, below);
            }
        } else {
            builder.value(self.value(&place(rank, corner, size))).unwrap();
        }
        builder.close().unwrap();
    }
}

/// A leaf of a tree. Cells are as wide on one side as on the other, so a delta is in one cell as a whole, or, in isotropic trees,
/// half on each side of the border along which it runs.
fn place(rank: usize, corner: [f64; 4], size: f64) -> Place {
    let middle = |a: usize| [corner[a] + size / 2.0, corner[a + 1] + size / 2.0];
    let hash = |n: usize| {
        corner[..n].iter().fold(17, |h: u32, c| h.wrapping_mul(1009).wrapping_add((c * 256.0) as u32))
    };
    let (p_in, p_out, share) = if rank == 3 {
        let row = if size == 1.0 {
            1.0
        } else if corner[2] + size == 0.5 || corner[2] == 0.5 {
            0.5
        } else {
            0.0
        };
        let share = if corner[1] == 1.0 - corner[0] - size { row } else { 0.0 };
        (DVec2::new(1.0 - 2.0 * corner[0] - size, 0.0), square_to_disk(middle(1)).into(), share)
    } else {
        let share = f64::from(corner[0] == corner[2] && corner[1] == corner[3]);
        (square_to_disk(middle(0)).into(), square_to_disk(middle(2)).into(), share)
    };
    Place { number: hash(rank), column: hash(rank - 2), p_in, p_out, delta: share / (PI * size * size) }
}

/// Rings that nobody else has.
fn own_basis() -> impl Strategy<Value = Arc<AngleBasis>> {
    (prop_oneof![Just(1usize), 2usize..6], proptest::collection::vec((3.0..30.0f64, 2usize..14), 1..5))
        .prop_map(|(pole, rings)| {
            let whole: f64 = 10.0 + rings.iter().map(|r| r.0).sum::<f64>();
            let mut upper = 10.0 * 90.0 / whole;
            let mut bounds = vec![(upper, pole)];
            for (width, count) in rings {
                upper += width * 90.0 / whole;
                bounds.push((upper, count));
            }
            bounds.last_mut().unwrap().0 = 90.0;
            Arc::new(AngleBasis::new("own", &bounds).unwrap())
        })
}

pub fn known_basis() -> impl Strategy<Value = Arc<AngleBasis>> {
    proptest::sample::select(vec!["LBNL/Klems Full", "LBNL/Klems Half", "LBNL/Klems Quarter"])
        .prop_map(|name| Arc::new(AngleBasis::known(name).unwrap()))
}

pub fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        2 => prop_oneof![known_basis().boxed(), own_basis().boxed()].prop_map(|b| Shape::Matrix(b.clone(), b)),
        1 => (own_basis(), own_basis()).prop_map(|(a, b)| Shape::Matrix(a, b)),
        2 => (3usize..5, 0u8..4).prop_map(|(rank, log2)| Shape::Regular { rank, log2 }),
        3 => (3usize..5, 1u32..4, any::<u32>()).prop_map(|(rank, depth, seed)| Shape::Mixed {
            rank,
            depth: if rank == 3 { depth + 1 } else { depth },
            seed
        }),
    ]
}

fn often_zero(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), range]
}

pub fn content() -> impl Strategy<Value = Content> {
    (
        any::<u32>(),
        often_zero(0.001..0.3),
        often_zero(0.01..3.0),
        0.05..1.0f64,
        often_zero(0.001..1.0),
        often_zero(0.05..0.8),
        often_zero(0.0001..0.9),
        proptest::option::of([0.3..2.0f64, 0.0..3.0f64]),
    )
        .prop_map(|(seed, base, lobe, sigma, noise, zeros, through, color)| Content {
            seed,
            base,
            lobe,
            sigma,
            noise,
            zeros,
            through,
            color,
        })
}
