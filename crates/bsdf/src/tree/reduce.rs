//! Bringing cells together that do not differ, in measured or traced trees: beside a tolerance, by what their errors can tell.

use super::{Node, Tree};

/// Differences below so many standard errors are noise: of the 16 children of a branch one lies farther off in 4 % of all cases.
const NOISE: f64 = 3.0;

/// A regular tree that is to be reduced: `2^log2` cells a side, the last dimension running fastest.
pub struct Regular<'a> {
    /// 3 or 4.
    pub rank: usize,
    /// Cells a side.
    pub log2: u8,
    /// Values of each plane; the first one decides.
    pub planes: &'a [Vec<f32>],
    /// Standard errors of the first plane.
    pub error: &'a [f32],
    /// Does a cell stay alone, whatever is beside it?
    pub is_kept: &'a dyn Fn(usize) -> bool,
    /// Cells are put together where they differ from their mean by no more than this share of it, or by no more than their
    /// errors explain.
    pub tolerance: f64,
}

/// A finished piece: one cell, or something finer.
enum Piece {
    /// Means of the planes, and the standard error of the first one's.
    Uniform(Vec<f64>, f64),
    Finer(Node),
}

impl Regular<'_> {
    /// One tree a plane, all of the same cells.
    pub fn reduced(&self) -> Vec<Tree> {
        let mut values = vec![Vec::new(); self.planes.len()];
        let mut nodes = vec![Node::Grid { log2: 0, first: 0 }];
        let root = self.piece([0; 4], self.log2, &mut nodes, &mut values);
        nodes[0] = settle(root, &mut values);
        values.into_iter().map(|values| Tree { rank: self.rank, nodes: nodes.clone(), values }).collect()
    }

    fn index(&self, cell: [usize; 4]) -> usize {
        cell[..self.rank].iter().fold(0, |n, &c| (n << self.log2) | c)
    }

    /// The hypercube of `2^level` cells a side at `corner`.
    fn piece(
        &self,
        corner: [usize; 4],
        level: u8,
        nodes: &mut Vec<Node>,
        values: &mut Vec<Vec<f32>>,
    ) -> Piece {
        if level == 0 {
            let at = self.index(corner);
            let own: Vec<f64> = self.planes.iter().map(|p| f64::from(p[at])).collect();
            if !(self.is_kept)(at) {
                return Piece::Uniform(own, f64::from(self.error[at]));
            }
            return Piece::Finer(settle(Piece::Uniform(own, 0.0), values));
        }
        let children: Vec<Piece> = (0..1usize << self.rank)
            .map(|child| {
                let mut at = corner;
                for (d, x) in at.iter_mut().enumerate().take(self.rank) {
                    *x += (child >> d & 1) << (level - 1);
                }
                self.piece(at, level - 1, nodes, values)
            })
            .collect();
        if let Some(together) = self.together(&children) {
            return together;
        }
        let first = nodes.len();
        nodes.resize(first + children.len(), Node::Grid { log2: 0, first: 0 });
        for (n, child) in children.into_iter().enumerate() {
            nodes[first + n] = settle(child, values);
        }
        Piece::Finer(Node::Branch(first as u32))
    }

    /// One cell of all children, if they are cells that do not differ.
    fn together(&self, children: &[Piece]) -> Option<Piece> {
        let n = children.len() as f64;
        let mut means = vec![0.0; self.planes.len()];
        let mut variance = 0.0;
        for child in children {
            let Piece::Uniform(own, error) = child else { return None };
            means.iter_mut().zip(own).for_each(|(m, v)| *m += v / n);
            variance += (error / n).powi(2);
        }
        let differs = |child: &Piece| match child {
            Piece::Uniform(own, error) => {
                (own[0] - means[0]).abs() > (self.tolerance * means[0]).max(NOISE * error)
            }
            Piece::Finer(_) => true,
        };
        if children.iter().any(differs) {
            return None;
        }
        Some(Piece::Uniform(means, variance.sqrt()))
    }
}

/// Give a cell its place among the values.
fn settle(piece: Piece, values: &mut [Vec<f32>]) -> Node {
    match piece {
        Piece::Finer(node) => node,
        Piece::Uniform(means, _) => {
            let first = values[0].len() as u32;
            values.iter_mut().zip(means).for_each(|(plane, mean)| plane.push(mean as f32));
            Node::Grid { log2: 0, first }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reduced(values: Vec<f32>, error: f32, tolerance: f64, kept: usize) -> Tree {
        let error = vec![error; values.len()];
        let regular = Regular {
            rank: 4,
            log2: 2,
            planes: &[values],
            error: &error,
            is_kept: &|at| at == kept,
            tolerance,
        };
        regular.reduced().remove(0)
    }

    #[test]
    fn what_does_not_differ_comes_together_and_nothing_else() {
        let flat = reduced(vec![0.5; 256], 0.0, 0.0, 999);
        assert_eq!(flat.values(), &[0.5]);
        // One cell stands out: its branch and the one above stay apart.
        let mut values = vec![1.0; 256];
        values[37] = 3.0;
        let tree = reduced(values.clone(), 0.0, 0.1, 999);
        assert_eq!(tree.values().len(), 15 + 16);
        // 37 is 0 2 1 1 in base 4.
        assert_eq!(tree.value([0.1, 0.6, 0.3, 0.3]), 3.0);
        assert_eq!(tree.value([0.1, 0.6, 0.3, 0.6]), 1.0);
        // Within its error it is noise, and the mean stays.
        let noise = reduced(values, 0.7, 0.0, 999);
        assert!((noise.values()[0] - (1.0 + 2.0 / 256.0)).abs() < 1e-6 && noise.values().len() == 1);
        // A cell that is kept stays alone, though it is the same.
        assert_eq!(reduced(vec![1.0; 256], 0.0, 0.1, 37).values().len(), 31);
    }
}
