//! Tensor trees: BSDFs of variable resolution over two unit squares (Ward et al. 2012, LBNL-5954E).
//!
//! Squares map to projected hemispheres by Shirley and Chiu's area-preserving map. A rank-4 tree has the incident point (two
//! coordinates) and the exiting point (two); a rank-3 tree, isotropic, has the incident radius as (1 - sin theta)/2
//! and the exiting point turned so that the unscattered direction lies on the positive first axis.

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

/// A tree as it is read: nested, before equal grids are merged.
#[derive(Clone, Debug, PartialEq)]
pub enum Nested {
    /// `2^rank` children.
    Branch(Vec<Nested>),
    /// `2^(rank * log2)` values.
    Grid(u8, Vec<f32>),
}

impl Tree {
    /// Lay a nested tree out flat; branches whose children are equal grids become one grid.
    pub fn from_nested(rank: usize, root: Nested) -> Self {
        let mut tree = Self { rank, nodes: vec![Node::Grid { log2: 0, first: 0 }], values: Vec::new() };
        tree.place(0, merge(rank, root));
        tree
    }

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

    fn place(&mut self, at: usize, node: Nested) {
        match node {
            Nested::Grid(log2, values) => {
                self.nodes[at] = Node::Grid { log2, first: self.values.len() as u32 };
                self.values.extend(values);
            }
            Nested::Branch(children) => {
                let first = self.nodes.len();
                self.nodes[at] = Node::Branch(first as u32);
                self.nodes.resize(first + children.len(), Node::Grid { log2: 0, first: 0 });
                for (i, child) in children.into_iter().enumerate() {
                    self.place(first + i, child);
                }
            }
        }
    }

    /// 3 (isotropic) or 4.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// All values.
    pub fn values(&self) -> &[f32] {
        &self.values
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
        let side = match self.nodes[node] {
            Node::Branch(_) => 2,
            Node::Grid { log2, .. } => 1usize << log2,
        };
        let step = size / side as f64;
        let range = |d: usize| {
            if d >= self.rank {
                return 0..1;
            }
            let (low, high) = bounds[d];
            let first = (((low - corner[d]) / step).max(0.0) as usize).min(side - 1);
            let end = if high > low { ((high - corner[d]) / step).ceil().max(0.0) as usize } else { 0 };
            first..end.clamp(first + 1, side)
        };
        for a in range(0) {
            for b in range(1) {
                for c in range(2) {
                    for d in range(3) {
                        let cell = [a, b, c, d];
                        let mut at = corner;
                        for (x, &k) in at.iter_mut().zip(&cell).take(self.rank) {
                            *x += k as f64 * step;
                        }
                        match self.nodes[node] {
                            Node::Grid { log2, first } => {
                                let offset = cell[..self.rank].iter().fold(0, |n, &k| (n << log2) | k);
                                visit(&Leaf { index: first as usize + offset, corner: at, size: step });
                            }
                            Node::Branch(first) => {
                                let child = (0..self.rank).fold(0, |n, i| n | (cell[i] << i));
                                self.visit(first as usize + child, at, step, bounds, visit);
                            }
                        }
                    }
                }
            }
        }
    }

    /// Edge of the smallest cell.
    pub fn smallest(&self) -> f64 {
        let mut smallest: f64 = 1.0;
        self.for_each_leaf(|leaf| smallest = smallest.min(leaf.size));
        smallest
    }
}

fn merge(rank: usize, node: Nested) -> Nested {
    let Nested::Branch(children) = node else { return node };
    let children: Vec<_> = children.into_iter().map(|c| merge(rank, c)).collect();
    let Some(&Nested::Grid(log2, _)) = children.first() else { return Nested::Branch(children) };
    if !children.iter().all(|c| matches!(c, Nested::Grid(l, _) if *l == log2)) || log2 >= 15 {
        return Nested::Branch(children);
    }
    let (side, half) = (2usize << log2, 1usize << log2);
    let mut values = vec![0.0; side.pow(rank as u32)];
    for (number, child) in children.iter().enumerate() {
        let Nested::Grid(_, small) = child else { continue };
        // Rows of the last dimension are copied whole.
        for (row, chunk) in small.chunks_exact(half).enumerate() {
            let mut at = 0;
            for d in 0..rank - 1 {
                let cell = (row >> (usize::from(log2) * (rank - 2 - d))) & (half - 1);
                at = at * side + cell + half * ((number >> d) & 1);
            }
            let at = at * side + half * ((number >> (rank - 1)) & 1);
            values[at..at + half].copy_from_slice(chunk);
        }
    }
    Nested::Grid(log2 + 1, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn nested(rank: usize, depth: u32) -> BoxedStrategy<Nested> {
        let grid = (0u8..2).prop_flat_map(move |log2| {
            proptest::collection::vec(0.0f32..9.0, 1 << (rank * usize::from(log2)))
                .prop_map(move |v| Nested::Grid(log2, v))
        });
        grid.prop_recursive(depth, 64, 16, move |inner| {
            proptest::collection::vec(inner, 1 << rank).prop_map(Nested::Branch)
        })
        .boxed()
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

    proptest! {
        #[test]
        fn merging_keeps_every_value(root in nested(3, 2), p in proptest::array::uniform4(0.0..0.999f64)) {
            let tree = Tree::from_nested(3, root.clone());
            prop_assert_eq!(tree.value(p), look_up(&root, 3, p));
            let leaf = tree.leaf(p);
            for (corner, x) in leaf.corner.iter().zip(p).take(3) {
                prop_assert!(*corner <= x && x < corner + leaf.size);
            }
        }

        #[test]
        fn leaves_over_an_incidence_tile_the_square(root in nested(4, 1), p in proptest::array::uniform2(0.0..0.999f64)) {
            let tree = Tree::from_nested(4, root);
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
    fn a_regular_tree_gives_back_its_cells() {
        let tree = Tree::regular(4, 2, |c| (c[0] * 64 + c[1] * 16 + c[2] * 4 + c[3]) as f32);
        assert_eq!(tree.value([0.9, 0.0, 0.3, 0.6]), (3 * 64 + 4 + 2) as f32);
        assert_eq!(tree.smallest(), 0.25);
    }
}
