//! Trees as numbers, and back with all checks: no file may lead a look-up astray.

use super::{Node, Tree, build::MAX_LOG2};

/// Bits of a packed grid's index; above them its `log2 + 1`, or 0 for a branch.
const INDEX_BITS: u32 = 32;

impl Tree {
    /// The nodes as numbers.
    pub(crate) fn packed_nodes(&self) -> impl ExactSizeIterator<Item = u64> {
        self.nodes.iter().map(|node| match *node {
            Node::Branch(first) => u64::from(first),
            Node::Grid { log2, first } => (u64::from(log2) + 1) << INDEX_BITS | u64::from(first),
        })
    }

    /// A tree from numbers; none if they are not one.
    pub(crate) fn from_packed(rank: usize, packed: &[u64], values: Vec<f32>) -> Option<Self> {
        if !(3..=4).contains(&rank) {
            return None;
        }
        let nodes = packed.iter().map(|&number| unpack(number)).collect::<Option<Vec<_>>>()?;
        let tree = Self { rank, nodes, values };
        tree.is_sound().then_some(tree)
    }

    /// Does every node stand under one other, within the limits of depth, and every value in one grid?
    fn is_sound(&self) -> bool {
        let (rank, children) = (self.rank, 1usize << self.rank);
        let max_log2 = MAX_LOG2[rank - 3];
        let mut depths: Vec<Option<u8>> = vec![None; self.nodes.len()];
        let Some(root) = depths.first_mut() else { return false };
        *root = Some(0);
        let (mut cells, mut reached) = (0, 1);
        // Blocks of children stand before the block that holds their parent; the root stands first and alone.
        let order = std::iter::once(0).chain((1..self.nodes.len()).rev());
        for at in order {
            let Some(depth) = depths[at] else { return false };
            match self.nodes[at] {
                Node::Grid { log2, first } => {
                    let count = 1usize << (rank * usize::from(log2.min(max_log2)));
                    if depth + log2 > max_log2 || first as usize + count > self.values.len() {
                        return false;
                    }
                    cells += count;
                }
                Node::Branch(first) => {
                    let block = first as usize..first as usize + children;
                    let in_place = first % children as u32 == 1 && block.end <= self.nodes.len();
                    let before = at == 0 || block.end <= at;
                    if !in_place || !before || depth >= max_log2 || depths[block.start].is_some() {
                        return false;
                    }
                    depths[block].fill(Some(depth + 1));
                    reached += children;
                }
            }
        }
        reached == self.nodes.len() && cells == self.values.len()
    }
}

fn unpack(number: u64) -> Option<Node> {
    let first = number as u32;
    match number >> INDEX_BITS {
        0 => Some(Node::Branch(first)),
        kind => Some(Node::Grid { log2: u8::try_from(kind - 1).ok().filter(|l| *l < 64)?, first }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Halves at the lower corner, twice.
    fn mixed() -> Tree {
        let mut builder = super::super::TreeBuilder::new(3, 100);
        builder.open().unwrap();
        for i in 0..8 {
            builder.open().unwrap();
            for j in 0..8 {
                if i == 0 {
                    builder.open().unwrap();
                    for k in 0..if j == 3 { 8 } else { 1 } {
                        builder.value((8 * j + k) as f32).unwrap();
                    }
                    builder.close().unwrap();
                }
            }
            if i > 0 {
                builder.value(i as f32).unwrap();
            }
            builder.close().unwrap();
        }
        builder.close().unwrap();
        builder.finish().unwrap()
    }

    #[test]
    fn packed_trees_come_back() {
        for tree in [mixed(), Tree::regular(4, 2, |c| c[1] as f32), Tree::regular(3, 0, |_| 1.0)] {
            let packed: Vec<u64> = tree.packed_nodes().collect();
            assert_eq!(Tree::from_packed(tree.rank, &packed, tree.values.clone()), Some(tree));
        }
    }

    proptest! {
        #[test]
        fn what_is_damaged_is_refused_or_leads_nowhere_else(at in 0usize..17, bit in 0u32..40, p in proptest::array::uniform4(0.0..0.999f64)) {
            let tree = mixed();
            let mut packed: Vec<u64> = tree.packed_nodes().collect();
            prop_assert_eq!(packed.len(), 17);
            packed[at] ^= 1 << bit;
            if let Some(damaged) = Tree::from_packed(3, &packed, tree.values.clone()) {
                damaged.value(p);
                damaged.for_each_leaf(|leaf| assert!(leaf.index < tree.values.len()));
            }
        }
    }
}
