//! Tables with changed cells: the residual of a split, and the table that it was split from.
//!
//! A cell of a tree may lie over several columns, and the residual differs from column to column. Such cells are subdivided until
//! each part lies over columns of the same residual; putting the table together again undoes that.

use crate::{
    distribution::{Distribution, to_rgb},
    table::{Columns, Matrix, Table},
    tree::{Leaf, MAX_VALUES, Tree, TreeBuilder},
};
use glam::DVec3;
use std::collections::HashMap;
use sunpeak_core::{Error, Result, Rgb, gray, rgb_to_xyz};

/// CIE Y, X, Z of a cell [1/sr]; gray tables have Y in all three.
pub type Channels = [f32; 3];

/// A luminous table with CIE X and Z of the same cells.
pub type ColorTable = (Table, Option<[Vec<f32>; 2]>);

/// Channels of a value by its index.
pub fn channels_at((table, color): (&Table, Option<&[Vec<f32>; 2]>), index: usize) -> Channels {
    let y = table.values()[index];
    color.map_or([y; 3], |[x, z]| [y, x[index], z[index]])
}

/// Channels of a value in Radiance's primaries.
pub fn channels_of(rgb: Rgb, colored: bool) -> Channels {
    if colored {
        let xyz = rgb_to_xyz(rgb).max(DVec3::ZERO);
        [xyz.y as f32, xyz.x as f32, xyz.z as f32]
    } else {
        [rgb.x as f32; 3]
    }
}

/// A value in Radiance's primaries, as [`Distribution`] makes it.
pub fn rgb_of([y, x, z]: Channels, colored: bool) -> Rgb {
    let [y, x, z] = [y, x, z].map(f64::from);
    if colored { to_rgb(DVec3::new(x, y, z)) } else { gray(y) }
}

/// What a distribution is after its split: the table with each column's candidates lowered to their surround.
pub fn residual(d: &Distribution) -> Result<ColorTable> {
    let whole = (d.luminous(), d.color());
    match d.luminous() {
        Table::Matrix(m) => {
            let mut values: Vec<Channels> = (0..m.values.len()).map(|i| channels_at(whole, i)).collect();
            for column in 0..d.columns().len() {
                for (index, rgb) in d.split().overlay(column) {
                    values[index] = channels_of(rgb, d.color().is_some());
                }
            }
            Ok(matrix(m, &values, d.color().is_some()))
        }
        Table::Tree(tree) => Lowered::new(d, tree).build(),
    }
}

fn matrix(shape: &Matrix, values: &[Channels], colored: bool) -> ColorTable {
    let channel = |k: usize| values.iter().map(|v| v[k]).collect::<Vec<f32>>();
    let (incident, exiting) = (shape.incident.clone(), shape.exiting.clone());
    let table = Table::Matrix(Matrix { incident, exiting, values: channel(0) });
    (table, colored.then(|| [channel(1), channel(2)]))
}

/// A matrix with some of its values replaced.
pub fn with_changes(shape: &Matrix, whole: &Distribution, changes: &[(usize, Channels)]) -> ColorTable {
    let parts = (whole.luminous(), whole.color());
    let mut values: Vec<Channels> = (0..shape.values.len()).map(|i| channels_at(parts, i)).collect();
    for &(index, channels) in changes {
        values[index] = channels;
    }
    matrix(shape, &values, whole.color().is_some())
}

/// A tree and what the split lowered in it, column by column.
struct Lowered<'a> {
    distribution: &'a Distribution,
    tree: &'a Tree,
    /// Cells by their index; in them the columns that have them as candidates.
    cells: HashMap<usize, HashMap<usize, Channels>>,
}

impl<'a> Lowered<'a> {
    fn new(distribution: &'a Distribution, tree: &'a Tree) -> Self {
        let mut cells: HashMap<usize, HashMap<usize, Channels>> = HashMap::new();
        let colored = distribution.color().is_some();
        for column in 0..distribution.columns().len() {
            for (index, rgb) in distribution.split().overlay(column) {
                cells.entry(index).or_default().insert(column, channels_of(rgb, colored));
            }
        }
        Self { distribution, tree, cells }
    }

    fn build(&self) -> Result<ColorTable> {
        build(self.tree.rank(), self.distribution.color().is_some(), &|corner, size| {
            let leaf = self.tree.leaf(corner);
            (leaf.size >= size).then(|| self.uniform(&leaf, corner, size)).flatten()
        })
    }

    /// The value of a part of a cell, if it is the same in all columns that the part lies over.
    fn uniform(&self, leaf: &Leaf, corner: [f64; 4], size: f64) -> Option<Channels> {
        let d = self.distribution;
        let whole = channels_at((d.luminous(), d.color()), leaf.index);
        let Some(lowered) = self.cells.get(&leaf.index) else { return Some(whole) };
        let value = |column: Option<usize>| column.and_then(|c| lowered.get(&c)).copied().unwrap_or(whole);
        let mut values = columns_over(d.columns(), corner, size).map(value);
        let first = values.next()?;
        values.all(|v| v == first).then_some(first)
    }
}

/// The columns that a cube lies over; none for those of the unused half of an isotropic tree.
fn columns_over(columns: &Columns, corner: [f64; 4], size: f64) -> impl Iterator<Item = Option<usize>> {
    let (side, isotropic) = division(columns);
    let span = move |d: usize| {
        let first = (corner[d] * side as f64) as usize;
        first..first + ((size * side as f64) as usize).max(1)
    };
    span(0).flat_map(move |i| {
        let across = if isotropic { 0..1 } else { span(1) };
        across.map(move |j| if isotropic { (i < side / 2).then_some(i) } else { Some(i * side + j) })
    })
}

/// Columns a side of the square, and whether only the first half of one coordinate counts.
fn division(columns: &Columns) -> (usize, bool) {
    match columns {
        Columns::Radial { side } => (*side, true),
        Columns::Square { side } => (*side, false),
        Columns::Patches(basis) => (basis.len(), false),
    }
}

/// A place in a tree in whole numbers: corner and edge, in widths of a column.
pub type Cube = ([u32; 4], u32);

/// The cell of the table over a column whose exiting side is the square at `exit` of edge `size`; cells are cubes, and lie at
/// multiples of their size.
pub fn cube(columns: &Columns, column: usize, exit: [f64; 2], size: f64) -> Cube {
    let (side, isotropic) = division(columns);
    let edge = ((size * side as f64) as u32).max(1);
    let aligned = |at: usize| at as u32 / edge * edge;
    let [x, y] = exit.map(|e| (e * side as f64) as u32);
    let corner = if isotropic {
        [aligned(column), x, y, 0]
    } else {
        [aligned(column / side), aligned(column % side), x, y]
    };
    (corner, edge)
}

/// A point inside the part of a cube that lies over a column, on the unit hypercube.
pub fn point_over(columns: &Columns, column: usize, exit: [f64; 2]) -> [f64; 4] {
    let (side, isotropic) = division(columns);
    let middle = |k: usize| (k as f64 + 0.5) / side as f64;
    if isotropic {
        [middle(column), exit[0], exit[1], 0.0]
    } else {
        [middle(column / side), middle(column % side), exit[0], exit[1]]
    }
}

/// A tree in which cubes are single cells again; elsewhere it is as it was.
pub fn with_cubes(whole: &Distribution, tree: &Tree, cubes: &HashMap<Cube, Channels>) -> Result<ColorTable> {
    let (side, _) = division(whole.columns());
    build(tree.rank(), whole.color().is_some(), &|corner, size| {
        let key = (corner.map(|c| (c * side as f64) as u32), (size * side as f64) as u32);
        cubes.get(&key).copied().or_else(|| {
            let leaf = tree.leaf(corner);
            (leaf.size >= size).then(|| channels_at((whole.luminous(), whole.color()), leaf.index))
        })
    })
}

/// A tree from what each cube is: one cell with channels, or none where it has to be divided.
fn build(
    rank: usize,
    colored: bool,
    cell: &impl Fn([f64; 4], f64) -> Option<Channels>,
) -> Result<ColorTable> {
    let builders = (0..if colored { 3 } else { 1 }).map(|_| TreeBuilder::new(rank, MAX_VALUES)).collect();
    let mut trees = Trees { rank, builders };
    let built = trees.node(cell, [0.0; 4], 1.0).and_then(|()| {
        trees.builders.into_iter().map(TreeBuilder::finish).collect::<std::result::Result<Vec<_>, _>>()
    });
    let mut trees = built.map_err(|e| Error::value(format!("the split's tree: {e}")))?.into_iter();
    let luminous = trees.next().ok_or_else(|| Error::value("the split's tree is empty"))?;
    let color = trees.next().zip(trees.next()).map(|(x, z)| [x.values().to_vec(), z.values().to_vec()]);
    Ok((Table::Tree(luminous), color))
}

/// The trees of all channels: the same cells in each.
struct Trees {
    rank: usize,
    builders: Vec<TreeBuilder>,
}

impl Trees {
    fn node(
        &mut self,
        cell: &impl Fn([f64; 4], f64) -> Option<Channels>,
        corner: [f64; 4],
        size: f64,
    ) -> std::result::Result<(), String> {
        self.builders.iter_mut().try_for_each(TreeBuilder::open)?;
        if let Some(channels) = cell(corner, size) {
            self.builders.iter_mut().zip(channels).try_for_each(|(b, value)| b.value(value))?;
        } else {
            for child in 0..1usize << self.rank {
                let mut at = corner;
                for (d, x) in at.iter_mut().enumerate().take(self.rank) {
                    *x += 0.5 * size * (child >> d & 1) as f64;
                }
                self.node(cell, at, 0.5 * size)?;
            }
        }
        self.builders.iter_mut().try_for_each(TreeBuilder::close)
    }
}
