//! Cumulative shares of the blocks of cells of each column, in 32 bits of fixed point.

/// One, in fixed point.
const ONE: f64 = u32::MAX as f64;

/// For each column the upper ends of its blocks' shares of one.
#[derive(Debug)]
pub struct Shares {
    ends: Vec<u32>,
    blocks: usize,
}

impl Shares {
    /// From each column's ends, see [`Self::ends`].
    pub fn new(blocks: usize, columns: impl IntoIterator<Item = Vec<u32>>) -> Self {
        Self { ends: columns.into_iter().flatten().collect(), blocks }
    }

    /// The ends of the shares of weights that are in proportion to what they should be.
    pub fn ends(weights: &[f64]) -> Vec<u32> {
        let total: f64 = weights.iter().sum();
        let mut sum = 0.0;
        weights
            .iter()
            .map(|w| {
                sum += w;
                // The last block with a weight ends at one exactly: the sums are the same ones.
                if total > 0.0 { (sum / total * ONE) as u32 } else { 0 }
            })
            .collect()
    }

    fn of_column(&self, column: usize) -> &[u32] {
        &self.ends[column * self.blocks..(column + 1) * self.blocks]
    }

    /// The block in whose share `u` in [0, 1) falls, and how far into it [0, 1). A block without a share is never picked.
    pub fn pick(&self, column: usize, u: f64) -> (usize, f64) {
        let ends = self.of_column(column);
        let at = u * ONE;
        let block = ends.partition_point(|&end| f64::from(end) <= at).min(ends.len() - 1);
        let (below, end) = self.bounds(column, block);
        (block, ((at - below) / (end - below)).clamp(0.0, 1.0 - f64::EPSILON))
    }

    fn bounds(&self, column: usize, block: usize) -> (f64, f64) {
        let ends = self.of_column(column);
        let below = if block == 0 { 0 } else { ends[block - 1] };
        (f64::from(below), f64::from(ends[block]))
    }

    /// A block's share of its column.
    pub fn share(&self, column: usize, block: usize) -> f64 {
        let (below, end) = self.bounds(column, block);
        (end - below) / ONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picks_follow_the_weights_and_never_the_empty() {
        let weights = [0.0, 3.0, 0.0, 1.0, 0.0, 0.0];
        let shares = Shares::new(6, [vec![0; 6], Shares::ends(&weights)]);
        for (u, block, rest) in [(0.0, 1, 0.0), (0.375, 1, 0.5), (0.75, 3, 0.0), (0.875, 3, 0.5)] {
            let (got, within) = shares.pick(1, u + 1e-9);
            assert_eq!(got, block);
            assert!((within - rest).abs() < 1e-8);
        }
        assert_eq!(shares.pick(1, 1.0 - f64::EPSILON).0, 3);
        assert!((shares.share(1, 1) - 0.75).abs() < 1e-9);
        assert_eq!(shares.share(1, 2), 0.0);
    }
}
