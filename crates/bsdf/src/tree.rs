//! Tensor trees: BSDFs of variable resolution over two unit squares (Ward et al. 2012, LBNL-5954E).
//!
//! Squares map to projected hemispheres by Shirley and Chiu's area-preserving map. A rank-4 tree has the incident point (two
//! coordinates) and the exiting point (two); a rank-3 tree, isotropic, has the incident radius as (1 - sin theta)/2
//! and the exiting point turned so that the unscattered direction lies on the positive first axis.

mod build;
mod pack;
mod reduce;

pub use build::TreeBuilder;
pub use reduce::Regular;

/// Most values that a file may hold: 128 cells a side in four dimensions, 1 GB.
pub const MAX_VALUES: usize = 1 << 28;

/// What to say past that.
pub fn too_many_values() -> String {
    format!("more than {MAX_VALUES} values in the file; this is the most")
}

/// A tree of values over the unit hypercube of `rank` dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    rank: usize,
    nodes: Vec<Node>,
    values: Vec<f32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Node {
    /// First of `2^rank` children; bit i of a child's number is the upper half of dimension i.
    Branch(u32),
    /// A regular grid of `2^log2` cells a side, the last dimension running fastest.
    Grid { log2: u8, first: u32 },
}

/// A cell of a tree: a hypercube of constant value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf {
    /// Index of its value.
    pub index: usize,
    /// Lower corner; dimensions past the rank are 0.
    pub corner: [f64; 4],
    /// Edge length.
    pub size: f64,
}

/// What [`Tree::region`] finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The value, if all cells have the same.
    pub uniform: Option<f32>,
    /// Edge of the smallest cell.
    pub smallest: f64,
}

impl Tree {
    /// A regular tree of `2^log2` cells a side; `value` gets the cell's coordinates.
    pub fn regular(rank: usize, log2: u8, mut value: impl FnMut([usize; 4]) -> f32) -> Self {
        let side = 1usize << log2;
        let values = (0..side.pow(rank as u32))
            .map(|i| {
                let mut cell = [0; 4];
                for (d, c) in cell.iter_mut().enumerate().take(rank) {
                    *c = (i >> (usize::from(log2) * (rank - 1 - d))) & (side - 1);
                }
                value(cell)
            })
            .collect();
        Self { rank, nodes: vec![Node::Grid { log2, first: 0 }], values }
    }

    /// 3 (isotropic) or 4.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// All values.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// All values, without the cells.
    pub fn into_values(self) -> Vec<f32> {
        self.values
    }

    /// Do values of the same index stand for the same cell?
    pub fn has_cells_of(&self, other: &Self) -> bool {
        self.rank == other.rank && self.nodes == other.nodes
    }

    /// Another tree of the same shape.
    pub fn map_leaves(&self, value: impl Fn(&Leaf, f32) -> f32) -> Self {
        let mut mapped = self.clone();
        self.for_each_leaf(|leaf| mapped.values[leaf.index] = value(leaf, self.values[leaf.index]));
        mapped
    }

    /// The cell that holds `position` (each coordinate in [0, 1]).
    pub fn leaf(&self, position: [f64; 4]) -> Leaf {
        let mut local = position;
        let mut leaf = Leaf { index: 0, corner: [0.0; 4], size: 1.0 };
        let mut node = self.nodes[0];
        loop {
            match node {
                Node::Branch(first) => {
                    leaf.size *= 0.5;
                    let mut child = 0;
                    for (d, (x, corner)) in local.iter_mut().zip(&mut leaf.corner).take(self.rank).enumerate()
                    {
                        *x *= 2.0;
                        if *x >= 1.0 {
                            *x -= 1.0;
                            *corner += leaf.size;
                            child |= 1 << d;
                        }
                    }
                    node = self.nodes[first as usize + child];
                }
                Node::Grid { log2, first } => {
                    let side = 1usize << log2;
                    leaf.size /= side as f64;
                    let mut index = 0;
                    for (x, corner) in local.iter().zip(&mut leaf.corner).take(self.rank) {
                        let cell = ((x * side as f64) as usize).min(side - 1);
                        *corner += cell as f64 * leaf.size;
                        index = (index << log2) | cell;
                    }
                    leaf.index = first as usize + index;
                    return leaf;
                }
            }
        }
    }

    /// The value at `position`.
    pub fn value(&self, position: [f64; 4]) -> f32 {
        self.values[self.leaf(position).index]
    }

    /// Visit every cell.
    pub fn for_each_leaf(&self, mut visit: impl FnMut(&Leaf)) {
        self.visit(0, [0.0; 4], 1.0, &[(0.0, 1.0); 4], &mut visit);
    }

    /// Visit the cells that overlap the bounds of each coordinate; bounds of no width are a point.
    pub fn for_each_leaf_in(&self, bounds: &[(f64, f64); 4], mut visit: impl FnMut(&Leaf)) {
        self.visit(0, [0.0; 4], 1.0, bounds, &mut visit);
    }

    /// Visit the cells over the incident position (the first `rank - 2` coordinates).
    pub fn for_each_leaf_over(&self, incident: &[f64], mut visit: impl FnMut(&Leaf)) {
        let mut bounds = [(0.0, 1.0); 4];
        for (bound, &x) in bounds.iter_mut().zip(incident).take(self.rank - 2) {
            *bound = (x, x);
        }
        self.visit(0, [0.0; 4], 1.0, &bounds, &mut visit);
    }

    /// What a hypercube of the tree holds; `corner` and `size` are those of a branch of the tree.
    pub fn region(&self, corner: [f64; 4], size: f64) -> Region {
        let first = self.value(corner);
        let mut region = Region { uniform: Some(first), smallest: size };
        self.visit(0, [0.0; 4], 1.0, &corner.map(|c| (c, c + size)), &mut |leaf| {
            region.smallest = region.smallest.min(leaf.size);
            if self.values[leaf.index] != first {
                region.uniform = None;
            }
        });
        region
    }

    /// Visit the cells of a node (at `corner`, of edge `size`) that overlap the bounds; bounds of no width are a point.
    fn visit(
        &self,
        node: usize,
        corner: [f64; 4],
        size: f64,
        bounds: &[(f64, f64); 4],
        visit: &mut impl FnMut(&Leaf),
    ) {
        let (node, corner, size) = self.narrowest(node, corner, size, bounds);
        let log2 = match self.nodes[node] {
            Node::Branch(_) => 1,
            Node::Grid { log2, .. } => log2,
        };
        let side = 1usize << log2;
        // Sizes are powers of two, so that this is exact.
        let (step, per_step) = (size / side as f64, side as f64 / size);
        let range = |d: usize| {
            if d >= self.rank {
                return 0..1;
            }
            let (low, high) = bounds[d];
            let first = (((low - corner[d]) * per_step) as usize).min(side - 1);
            let end = if high > low { ceil((high - corner[d]) * per_step) } else { 0 };
            first..end.clamp(first + 1, side)
        };
        let ranges = [0, 1, 2, 3].map(range);
        let at = |d: usize, k: usize| corner[d] + k as f64 * step;
        for a in ranges[0].clone() {
            for b in ranges[1].clone() {
                for c in ranges[2].clone() {
                    for d in ranges[3].clone() {
                        let cell = [a, b, c, d];
                        let corner = [at(0, a), at(1, b), at(2, c), at(3, d)];
                        match self.nodes[node] {
                            Node::Grid { first, .. } => {
                                let offset = cell[..self.rank].iter().fold(0, |n, &k| (n << log2) | k);
                                visit(&Leaf { index: first as usize + offset, corner, size: step });
                            }
                            Node::Branch(first) => {
                                let child = (0..self.rank).fold(0, |n, i| n | (cell[i] << i));
                                self.visit(first as usize + child, corner, step, bounds, visit);
                            }
                        }
                    }
                }
            }
        }
    }

    /// The last node on the way down from one that still holds all of the bounds.
    fn narrowest(
        &self,
        mut node: usize,
        mut corner: [f64; 4],
        mut size: f64,
        bounds: &[(f64, f64); 4],
    ) -> (usize, [f64; 4], f64) {
        while let Node::Branch(first) = self.nodes[node] {
            let half = 0.5 * size;
            let (mut child, mut inner) = (0, corner);
            for d in 0..self.rank {
                let (middle, (low, high)) = (corner[d] + half, bounds[d]);
                if low >= middle {
                    child |= 1 << d;
                    inner[d] = middle;
                } else if high > middle {
                    return (node, corner, size);
                }
            }
            (node, corner, size) = (first as usize + child, inner, half);
        }
        (node, corner, size)
    }

    /// Edge of the smallest cell.
    pub fn smallest(&self) -> f64 {
        self.smallest_below(0)
    }

    fn smallest_below(&self, node: usize) -> f64 {
        match self.nodes[node] {
            Node::Grid { log2, .. } => 0.5f64.powi(i32::from(log2)),
            Node::Branch(first) => {
                let children = first as usize..first as usize + (1 << self.rank);
                0.5 * children.map(|child| self.smallest_below(child)).fold(1.0, f64::min)
            }
        }
    }
}

/// The next whole number, without a call; 0 for negative ones.
fn ceil(x: f64) -> usize {
    let whole = x as usize;
    whole + usize::from(x > whole as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_tree_gives_back_its_cells() {
        let tree = Tree::regular(4, 2, |c| (c[0] * 64 + c[1] * 16 + c[2] * 4 + c[3]) as f32);
        assert_eq!(tree.value([0.9, 0.0, 0.3, 0.6]), (3 * 64 + 4 + 2) as f32);
        assert_eq!(tree.smallest(), 0.25);
    }
}
