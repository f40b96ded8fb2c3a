//! Sampling a tensor tree: blocks are squares of the exiting disk's square, in which the tree's own cells are looked up.
//!
//! So nothing is stored for a cell, and regular and mixed trees are one. Along the table the cells have their own values. Against
//! it (anisotropic trees only), a cell that lies over several columns of a residual has their mean value.

use super::{Choice, Target, most_blocks};
use crate::{
    table::{Columns, Table, turned_back},
    tree::{Leaf, Tree},
};
use glam::DVec2;
use std::{collections::HashMap, f64::consts::PI};
use sunpeak_core::{
    Rgb, luminance,
    warp::{disk_to_square, square_to_disk},
};

/// The cells of a tree as rays meet them.
#[derive(Debug)]
pub struct Leaves {
    target: Target,
    /// The finest division of the side where rays come from.
    columns: Columns,
    /// Cells a side of that division, and blocks a side of the other.
    side: usize,
    blocks: usize,
    /// Against a table whose peak was taken: what it took from cells, in the mean over the incident square [1/sr].
    taken: Option<HashMap<usize, Rgb>>,
}

/// Part of a cell: the square where rays go.
#[derive(Clone, Copy)]
struct Part {
    corner: [f64; 2],
    size: f64,
}

impl Leaves {
    /// Of a tree; none against an isotropic one, where turning with the incidence cuts across the cells.
    pub fn new(target: &Target) -> Option<Self> {
        let d = &*target.oriented.distribution;
        let columns = d.columns().clone();
        let side = match columns {
            Columns::Radial { side } if !target.oriented.reversed => side,
            Columns::Square { side } => side,
            _ => return None,
        };
        let most = most_blocks(d.luminous().values().len()) / columns.len();
        let mut blocks = 1;
        while 2 * blocks <= side && 4 * blocks * blocks <= most {
            blocks *= 2;
        }
        let taken = (target.oriented.reversed && target.residual).then(|| {
            let mut taken = HashMap::new();
            for column in 0..columns.len() {
                for (index, surround) in d.split().overlay(column) {
                    *taken.entry(index).or_insert(Rgb::ZERO) +=
                        (d.at_index(index) - surround) / (side * side) as f64;
                }
            }
            taken
        });
        Some(Self { target: target.clone(), columns, side, blocks, taken })
    }

    /// How many columns.
    pub fn columns(&self) -> usize {
        self.columns.len()
    }

    /// The column of an incident point.
    pub fn column(&self, p_in: DVec2) -> usize {
        // Against the table the same point that the table is asked for, so that borders fall to the same side.
        self.columns.index(if self.target.oriented.reversed { -p_in } else { p_in })
    }

    /// Blocks in a column.
    pub fn blocks(&self) -> usize {
        self.blocks * self.blocks
    }

    fn tree(&self) -> Option<&Tree> {
        match self.target.oriented.distribution.luminous() {
            Table::Tree(tree) => Some(tree),
            Table::Matrix(_) => None,
        }
    }

    fn value(&self, column: usize, leaf: &Leaf) -> Rgb {
        match &self.taken {
            None => self.target.value(column, leaf.index),
            Some(taken) => {
                let whole = self.target.oriented.distribution.at_index(leaf.index);
                let taken = taken.get(&leaf.index).map_or(Rgb::ZERO, |t| *t / (leaf.size * leaf.size));
                (whole - taken).max(Rgb::ZERO)
            }
        }
    }

    /// Visit the parts of a column's cells in a window.
    fn visit(&self, column: usize, window: Part, mut visit: impl FnMut(&Leaf, Part)) {
        let Some(tree) = self.tree() else { return };
        let [a, b] = window.corner.map(|c| (c, c + window.size));
        let bounds = self.in_column(column, [a, b], |middle| (middle, middle), (0.0, 1.0));
        tree.for_each_leaf_in(&bounds, |leaf| visit(leaf, self.part(leaf, window)));
    }

    /// The cell of a column that covers a whole window, if one does.
    fn covering(&self, column: usize, window: Part) -> Option<Leaf> {
        let [a, b] = window.corner.map(|c| c + 0.5 * window.size);
        let leaf = self.tree()?.leaf(self.in_column(column, [a, b], |middle| middle, 0.0));
        (leaf.size >= window.size).then_some(leaf)
    }

    /// Coordinates of the tree, or ranges of them, from those on the square where rays go and the middle of the column; `unused`
    /// stands past the tree's rank.
    fn in_column<T: Copy>(&self, column: usize, [a, b]: [T; 2], at: impl Fn(f64) -> T, unused: T) -> [T; 4] {
        let middle = |cell: usize| at((cell as f64 + 0.5) / self.side as f64);
        if let Columns::Radial { .. } = self.columns {
            return [middle(column), a, b, unused];
        }
        let (i, j) = (middle(column / self.side), middle(column % self.side));
        if self.target.oriented.reversed { [a, b, i, j] } else { [i, j, a, b] }
    }

    /// The part of a cell that is in a window.
    fn part(&self, leaf: &Leaf, window: Part) -> Part {
        let first = match (&self.columns, self.target.oriented.reversed) {
            (Columns::Radial { .. }, _) => 1,
            (_, false) => 2,
            (_, true) => 0,
        };
        let corner = [leaf.corner[first], leaf.corner[first + 1]];
        Part { corner: [0, 1].map(|k| corner[k].max(window.corner[k])), size: leaf.size.min(window.size) }
    }

    fn block(&self, block: usize) -> Part {
        let size = 1.0 / self.blocks as f64;
        Part { corner: [block / self.blocks, block % self.blocks].map(|k| k as f64 * size), size }
    }

    /// The flux of each part of a column [-], with its block.
    pub fn for_each_flux(&self, column: usize, mut visit: impl FnMut(usize, Rgb)) {
        let block_size = 1.0 / self.blocks as f64;
        self.visit(column, Part { corner: [0.0; 2], size: 1.0 }, |leaf, part| {
            let value = self.value(column, leaf);
            let flux = value * PI * part.size.min(block_size).powi(2);
            let [i, j] = part.corner.map(|c| (c * self.blocks as f64) as usize);
            // A cell that is larger than a block fills several.
            let span = (part.size * self.blocks as f64).ceil() as usize;
            for block in (i..i + span).flat_map(|i| (j..j + span).map(move |j| i * self.blocks + j)) {
                visit(block, flux);
            }
        });
    }

    /// A point of a block, in proportion to the values, and its cell's value [1/sr] where that is the table's; `pick` gives a random
    /// number where one cell of several has to be chosen.
    pub fn point(
        &self,
        p_in: DVec2,
        column: usize,
        block: usize,
        pick: impl Fn() -> f64,
        [u, v]: [f64; 2],
    ) -> Option<(DVec2, Option<Rgb>)> {
        let window = self.block(block);
        let (part, value) = match self.covering(column, window) {
            Some(leaf) => (window, self.value(column, &leaf)),
            None => {
                let mut choice = Choice::new(pick());
                self.visit(column, window, |leaf, part| {
                    let value = self.value(column, leaf);
                    choice.offer(luminance(value) * part.size * part.size, (part, value));
                });
                choice.taken()?
            }
        };
        let p: DVec2 =
            square_to_disk([part.corner[0] + u * part.size, part.corner[1] + v * part.size]).into();
        let p = match (&self.columns, self.target.oriented.reversed) {
            (Columns::Radial { .. }, _) => turned_back(p_in, p),
            (_, false) => p,
            (_, true) => -p,
        };
        Some((p, self.taken.is_none().then_some(value)))
    }

    /// The luminous value that is sampled [1/sr], where the table has `value` [1/sr].
    pub fn sampled_value(&self, p_in: DVec2, p_out: DVec2, value: f64) -> f64 {
        let (Some(tree), true) = (self.tree(), self.taken.is_some()) else { return value };
        let ([a, b], [c, d]) = (disk_to_square((-p_out).into()), disk_to_square((-p_in).into()));
        luminance(self.value(0, &tree.leaf([a, b, c, d])))
    }
}
