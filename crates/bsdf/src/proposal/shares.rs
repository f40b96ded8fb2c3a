//! Cumulative shares of the blocks of cells of each column, in 32 bits of fixed point.

/// One, in fixed point.
const ONE: f64 = u32::MAX as f64;

/// Blocks for one entry of the guide: with it the search takes the same few steps in every column.
const BLOCKS_AN_ENTRY: usize = 4;

/// For each column the upper ends of its blocks' shares of one.
///
/// A guide table (Chen and Asau 1974) says for equal parts of one where to begin.
#[derive(Debug)]
pub struct Shares {
    ends: Vec<u32>,
    blocks: usize,
    /// For each column and part, the block at which the part begins.
    guide: Vec<u32>,
    parts: usize,
}

impl Shares {
    /// From each column's ends, see [`Self::ends`].
    pub fn new(blocks: usize, columns: impl IntoIterator<Item = Vec<u32>>) -> Self {
        let parts = blocks.div_ceil(BLOCKS_AN_ENTRY);
        let (mut ends, mut guide) = (Vec::new(), Vec::new());
        for column in columns {
            guide.extend((0..parts).map(|part| {
                let begin = ((part as u64) << 32).div_ceil(parts as u64) as u32;
                column.partition_point(|&end| end <= begin) as u32
            }));
            ends.extend(column);
        }
        Self { ends, blocks, guide, parts }
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

    /// The block in whose share `u` in [0, 1) falls. A block without a share is never picked.
    #[inline]
    pub fn pick(&self, column: usize, u: f64) -> usize {
        let ends = self.of_column(column);
        let whole = (u * ONE) as u32; // ends are whole numbers: end <= u where end <= whole
        let part = ((u64::from(whole) * self.parts as u64) >> 32) as usize;
        let guide = &self.guide[column * self.parts..(column + 1) * self.parts];
        let first = guide[part] as usize;
        let last = guide.get(part + 1).map_or(ends.len(), |&block| block as usize);
        (first + ends[first..last].partition_point(|&end| end <= whole)).min(ends.len() - 1)
    }

    /// How far into the share of its block `u` is [0, 1).
    pub fn rest(&self, column: usize, block: usize, u: f64) -> f64 {
        let (below, end) = self.bounds(column, block);
        ((u * ONE - below) / (end - below)).clamp(0.0, 1.0 - f64::EPSILON)
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
            assert_eq!(shares.pick(1, u + 1e-9), block);
            assert!((shares.rest(1, block, u + 1e-9) - rest).abs() < 1e-8);
        }
        assert_eq!(shares.pick(1, 1.0 - f64::EPSILON), 3);
        assert!((shares.share(1, 1) - 0.75).abs() < 1e-9);
        assert_eq!(shares.share(1, 2), 0.0);
    }

    #[test]
    fn the_guide_leads_where_a_plain_search_does() {
        for blocks in [1, 7, 8, 9, 100, 145] {
            let weights: Vec<f64> =
                (0..blocks).map(|i| if i % 5 == 2 { 0.0 } else { (i * i % 13) as f64 + 1e-3 }).collect();
            let ends = Shares::ends(&weights);
            let shares = Shares::new(blocks, [ends.clone()]);
            let edges = ends.iter().flat_map(|&end| [-1.0, -0.5, 0.0, 0.5, 1.0].map(|d| f64::from(end) + d));
            for at in edges.chain((0..1000).map(|i| ONE * f64::from(i) / 1000.0)) {
                let u = (at / ONE).clamp(0.0, 1.0 - f64::EPSILON);
                let plain = ends.iter().position(|&end| f64::from(end) > u * ONE);
                assert_eq!(shares.pick(0, u), plain.unwrap_or(blocks - 1), "{u} of {blocks}");
            }
        }
    }
}
