//! Building a tree from its text, cell by cell in the file's order, without keeping the nesting.
//!
//! Values go straight to their place. A branch of which all children are equal grids is itself a grid; how deep its values are
//! nested is only noted, and they are brought into rows once, when the grid has its full size.

use super::{Node, Tree};

/// Deepest division, by rank less 3: 2^12 cells a side resolve 0.014 degrees, 2^8 0.2 degrees; no file is known past 2^7. A column
/// of the finest incident division is analysed each, so that a single deep branch costs 2^11 or 2^16 of them.
pub(super) const MAX_LOG2: [u8; 2] = [12, 8];

/// Most nodes: 16 regular cells each would be four times as many values as one may read.
const MAX_NODES: usize = 1 << 26;

/// A tree that is being read.
#[derive(Debug)]
pub struct TreeBuilder {
    tree: Tree,
    /// Values that may still come.
    allowance: usize,
    open: Vec<Open>,
    /// Finished children of all open branches.
    pieces: Vec<Piece>,
}

/// An open brace.
#[derive(Clone, Copy, Debug)]
struct Open {
    first_piece: usize,
    first_value: usize,
}

/// A finished node that has no place yet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    Grid(Grid),
    Branch(u32),
}

/// `2^log2` cells a side: nested by halves down to grids of `2^base` cells a side in rows.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid {
    log2: u8,
    base: u8,
    first: usize,
}

impl TreeBuilder {
    /// An empty tree of rank 3 or 4 that may get so many values.
    pub fn new(rank: usize, allowance: usize) -> Self {
        let tree = Tree { rank, nodes: vec![Node::Grid { log2: 0, first: 0 }], values: Vec::new() };
        Self { tree, allowance, open: Vec::new(), pieces: Vec::new() }
    }

    fn max_log2(&self) -> u8 {
        MAX_LOG2[self.tree.rank - 3]
    }

    fn is_finished(&self) -> bool {
        self.open.is_empty() && !self.pieces.is_empty()
    }

    /// `{`
    pub fn open(&mut self) -> Result<(), String> {
        if self.is_finished() {
            return Err("something follows the end of the tensor tree".into());
        }
        if self.open.len() > usize::from(self.max_log2()) {
            return Err(format!("the tensor tree is more than {} levels deep", self.max_log2()));
        }
        if let Some(parent) = self.open.last() {
            let all = 1usize << self.tree.rank;
            if self.holds_values(parent) {
                return Err("found '{' among values; expected a value or '}'".into());
            }
            if self.pieces.len() - parent.first_piece == all {
                return Err(format!("a branch of the tensor tree has more than {all} children"));
            }
        }
        self.open.push(Open { first_piece: self.pieces.len(), first_value: self.tree.values.len() });
        Ok(())
    }

    fn holds_values(&self, open: &Open) -> bool {
        self.pieces.len() == open.first_piece && self.tree.values.len() > open.first_value
    }

    /// A number; the caller has seen to it that it is finite and not negative.
    pub fn value(&mut self, value: f32) -> Result<(), String> {
        match self.open.last() {
            None if self.is_finished() => return Err("something follows the end of the tensor tree".into()),
            None => return Err(format!("found {value}; expected '{{'")),
            Some(open) if self.pieces.len() > open.first_piece => {
                let (n, all) = (self.pieces.len() - open.first_piece, 1usize << self.tree.rank);
                return Err(format!("a branch of the tensor tree has {n} children; expected {all}"));
            }
            Some(_) if self.allowance == 0 => return Err(super::too_many_values()),
            Some(_) => {}
        }
        self.allowance -= 1;
        self.tree.values.push(value);
        Ok(())
    }

    /// `}`
    pub fn close(&mut self) -> Result<(), String> {
        let Some(open) = self.open.pop() else {
            return Err("found '}'; expected '{'".into());
        };
        let piece = if self.pieces.len() > open.first_piece {
            self.branch(open.first_piece)?
        } else {
            self.grid(open.first_value)?
        };
        self.pieces.truncate(open.first_piece);
        self.pieces.push(piece);
        Ok(())
    }

    fn grid(&self, first: usize) -> Result<Piece, String> {
        let (count, rank) = (self.tree.values.len() - first, self.tree.rank);
        let log2 = count.trailing_zeros() as usize / rank;
        if count == 0 || count != 1 << (rank * log2) {
            let all = 1 << rank;
            return Err(format!("a grid of the tensor tree has {count} values; expected a power of {all}"));
        }
        if self.open.len() + log2 > usize::from(self.max_log2()) {
            let max = self.max_log2();
            return Err(format!("the tensor tree has more than 2^{max} cells a side; this is the most"));
        }
        Ok(Piece::Grid(Grid { log2: log2 as u8, base: log2 as u8, first }))
    }

    fn branch(&mut self, first_piece: usize) -> Result<Piece, String> {
        let (count, all) = (self.pieces.len() - first_piece, 1usize << self.tree.rank);
        if count != all {
            return Err(format!("a branch of the tensor tree has {count} children; expected {all}"));
        }
        if let Some(grid) = self.merged(first_piece) {
            return Ok(Piece::Grid(grid));
        }
        let first = self.tree.nodes.len();
        if first + all > MAX_NODES {
            return Err(format!("the tensor tree has more than {MAX_NODES} nodes; this is the most"));
        }
        for i in first_piece..self.pieces.len() {
            let node = match self.pieces[i] {
                Piece::Grid(grid) => self.in_rows(grid),
                Piece::Branch(first) => Node::Branch(first),
            };
            self.tree.nodes.push(node);
        }
        Ok(Piece::Branch(first as u32))
    }

    /// One grid from children that are equal grids.
    fn merged(&mut self, first_piece: usize) -> Option<Grid> {
        let Piece::Grid(first) = self.pieces[first_piece] else { return None };
        let (mut equal, mut base) = (true, true);
        for piece in &self.pieces[first_piece..] {
            let Piece::Grid(grid) = piece else { return None };
            equal &= grid.log2 == first.log2;
            base &= grid.base == first.base;
        }
        if !equal {
            return None;
        }
        if base {
            return Some(Grid { log2: first.log2 + 1, ..first });
        }
        for i in first_piece..self.pieces.len() {
            if let Piece::Grid(grid) = self.pieces[i] {
                self.in_rows(grid);
            }
        }
        Some(Grid { log2: first.log2 + 1, base: first.log2, first: first.first })
    }

    /// Bring a grid's values into rows, the last dimension running fastest.
    fn in_rows(&mut self, grid: Grid) -> Node {
        let Grid { log2, base, first } = grid;
        let rank = self.tree.rank;
        if log2 > base {
            let count = 1usize << (rank * usize::from(log2));
            let nested = &self.tree.values[first..first + count];
            let mut rows = vec![0.0; count];
            let block = 1usize << (rank * usize::from(base));
            let width = 1usize << base;
            for (number, values) in nested.chunks_exact(block).enumerate() {
                let corner = corner(rank, log2 - base, number).map(|c| c << base);
                for (row, run) in values.chunks_exact(width).enumerate() {
                    let mut at = 0;
                    for (d, c) in corner.iter().enumerate().take(rank) {
                        // The run's place in the block; its last coordinate is 0.
                        let shift = usize::from(base) * (rank - 1 - d);
                        let local = ((row << base) >> shift) & (width - 1);
                        at = (at << log2) | (c + local);
                    }
                    rows[at..at + width].copy_from_slice(run);
                }
            }
            if first == 0 && count == self.tree.values.len() {
                self.tree.values = rows;
            } else {
                self.tree.values[first..first + count].copy_from_slice(&rows);
            }
        }
        Node::Grid { log2, first: first as u32 }
    }

    /// The tree, once its last brace has been closed.
    pub fn finish(mut self) -> Result<Tree, String> {
        if !self.open.is_empty() {
            return Err("the tensor tree ends too early; expected '}'".into());
        }
        self.tree.nodes[0] = match self.pieces.first() {
            None => return Err("the tensor tree ends too early; expected '{'".into()),
            Some(&Piece::Grid(grid)) => self.in_rows(grid),
            Some(&Piece::Branch(first)) => Node::Branch(first),
        };
        self.tree.values.shrink_to_fit();
        self.tree.nodes.shrink_to_fit();
        Ok(self.tree)
    }
}

/// Coordinates of the `number`-th block of a nest of `levels`: bit d of a child's number is the upper half of dimension d.
fn corner(rank: usize, levels: u8, number: usize) -> [usize; 4] {
    let mut corner = [0; 4];
    for level in (0..usize::from(levels)).rev() {
        let child = number >> (rank * level);
        for (d, c) in corner.iter_mut().enumerate().take(rank) {
            *c = (*c << 1) | ((child >> d) & 1);
        }
    }
    corner
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A tree as it stands in the text.
    #[derive(Clone, Debug)]
    enum Nested {
        Branch(Vec<Nested>),
        Grid(u8, Vec<f32>),
    }

    fn nested(rank: usize, depth: u32) -> BoxedStrategy<Nested> {
        let grid = (0u8..3).prop_flat_map(move |log2| {
            let log2 = if rank == 4 { log2 / 2 } else { log2 };
            proptest::collection::vec(0.0f32..9.0, 1 << (rank * usize::from(log2)))
                .prop_map(move |v| Nested::Grid(log2, v))
        });
        grid.prop_recursive(depth, 64, 16, move |inner| {
            proptest::collection::vec(inner, 1 << rank).prop_map(Nested::Branch)
        })
        .boxed()
    }

    /// A full tree whose leaves are grids of one or two cells a side.
    fn full(rank: usize, levels: u32) -> BoxedStrategy<Nested> {
        if levels == 0 {
            return (0.0f32..9.0).prop_map(|v| Nested::Grid(0, vec![v])).boxed();
        }
        let branch = proptest::collection::vec(full(rank, levels - 1), 1 << rank).prop_map(Nested::Branch);
        if levels == 1 {
            let row = proptest::collection::vec(0.0f32..9.0, 1 << rank).prop_map(|v| Nested::Grid(1, v));
            return prop_oneof![branch, row].boxed();
        }
        branch.boxed()
    }

    fn feed(builder: &mut TreeBuilder, node: &Nested) {
        builder.open().unwrap();
        match node {
            Nested::Branch(children) => children.iter().for_each(|c| feed(builder, c)),
            Nested::Grid(_, values) => values.iter().for_each(|&v| builder.value(v).unwrap()),
        }
        builder.close().unwrap();
    }

    fn built(rank: usize, root: &Nested) -> Tree {
        let mut builder = TreeBuilder::new(rank, 1 << 20);
        feed(&mut builder, root);
        builder.finish().unwrap()
    }

    /// The plain descent, without merging.
    fn look_up(node: &Nested, rank: usize, mut p: [f64; 4]) -> f32 {
        match node {
            Nested::Branch(children) => {
                let mut n = 0;
                for (d, x) in p.iter_mut().enumerate().take(rank) {
                    *x *= 2.0;
                    if *x >= 1.0 {
                        *x -= 1.0;
                        n |= 1 << d;
                    }
                }
                look_up(&children[n], rank, p)
            }
            Nested::Grid(log2, values) => {
                let side = 1usize << log2;
                values[p[..rank].iter().fold(0, |n, x| n * side + (x * side as f64) as usize)]
            }
        }
    }

    fn check(rank: usize, root: &Nested, p: [f64; 4]) -> Tree {
        let tree = built(rank, root);
        assert_eq!(tree.value(p), look_up(root, rank, p));
        let leaf = tree.leaf(p);
        for (corner, x) in leaf.corner.iter().zip(p).take(rank) {
            assert!(*corner <= x && x < corner + leaf.size);
        }
        tree
    }

    proptest! {
        #[test]
        fn merging_keeps_every_value(root in nested(3, 2), p in proptest::array::uniform4(0.0..0.999f64)) {
            check(3, &root, p);
        }

        #[test]
        fn full_trees_become_one_grid(a in full(3, 3), b in full(4, 2), p in proptest::array::uniform4(0.0..0.999f64)) {
            prop_assert_eq!(check(3, &a, p).nodes.len(), 1);
            prop_assert_eq!(check(4, &b, p).nodes.len(), 1);
        }

        #[test]
        fn leaves_over_an_incidence_tile_the_square(root in nested(4, 1), p in proptest::array::uniform2(0.0..0.999f64)) {
            let tree = built(4, &root);
            let mut area = 0.0;
            tree.for_each_leaf_over(&p, |leaf| {
                area += leaf.size * leaf.size;
                let q = [p[0], p[1], leaf.corner[2] + leaf.size / 2.0, leaf.corner[3] + leaf.size / 2.0];
                assert_eq!(tree.leaf(q), *leaf);
            });
            prop_assert!((area - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_no_tree_is_refused() {
        let said = |text: &str| {
            let mut builder = TreeBuilder::new(3, 20);
            let step = |c| match c {
                '{' => builder.open(),
                '}' => builder.close(),
                _ => builder.value(1.0),
            };
            match text.chars().try_for_each(step) {
                Err(message) => message,
                Ok(()) => builder.finish().unwrap_err(),
            }
        };
        for (text, message) in [
            ("", "ends too early; expected '{'"),
            ("{1", "ends too early; expected '}'"),
            ("1", "expected '{'"),
            ("}", "expected '{'"),
            ("{}", "0 values; expected a power of 8"),
            ("{11}", "2 values; expected a power of 8"),
            ("{{1}{1}}", "2 children; expected 8"),
            ("{{1}1}", "1 children; expected 8"),
            ("{{1}{1}{1}{1}{1}{1}{1}{1}{", "more than 8 children"),
            ("{1{", "'{' among values"),
            ("{1}1", "follows the end"),
            ("{1}{", "follows the end"),
            ("{1}}", "expected '{'"),
            ("{{{{{{{{{{{{{{", "more than 12 levels deep"),
            ("{111111111111111111111", "values"),
        ] {
            assert!(said(text).contains(message), "{text}: {}", said(text));
        }
    }
}
