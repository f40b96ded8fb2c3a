//! Owen-scrambled Sobol samples (Burley 2020, "Practical Hash-based Owen Scrambling"), and past their dimensions independent ones.

use sobol_burley::parts::{Int4, hash, hash_int4, owen_scramble_int4_rev, owen_scramble_rev, sobol_int4_rev};
use std::sync::LazyLock;

/// Sets of four dimensions in which samples are points of the sequence: those of the first vertices of a path. What it meets farther on
/// is so different from sample to sample that independent numbers, which cost less, do as well.
const SETS: u32 = 16;

/// What each digit of an index, of four bits, adds to the points of the sequence, for each set of dimensions: points are sums over the bits
/// of their index, bit by bit without carry.
static DIGITS: LazyLock<[[[Int4; 16]; 4]; SETS as usize]> =
    LazyLock::new(|| std::array::from_fn(|set| [0, 1, 2, 3].map(|place| digits(set as u32, place))));

fn digits(set: u32, place: u32) -> [Int4; 16] {
    std::array::from_fn(|digit| sobol_int4_rev((digit as u32) << (28 - 4 * place), set))
}

/// A sample sequence for one pixel or sensor: each sample index is one path, each call one or two dimensions.
///
/// The same seed, stream and index give the same numbers, on any number of threads.
#[derive(Clone, Debug)]
pub struct Sampler {
    /// Seed of the sequence's scrambling.
    scrambling: u32,
    /// Seed of the independent numbers, another one for each index.
    independence: u64,
    /// The index in the order in which this seed visits the sequence, bits reversed.
    shuffled: u32,
    /// Sets of dimensions that were used.
    set: u32,
    values: [f32; 4],
    /// How many of the values were given out.
    used: usize,
}

impl Sampler {
    /// The `index`-th sample (below 65536, then the sequence goes on in a new scrambling) of `stream` (a pixel's number).
    pub fn new(seed: u64, stream: u64, index: u64) -> Self {
        let chunk = index / Self::CHUNK;
        let mixed = mix(seed ^ mix(stream.wrapping_add(mix(chunk).wrapping_mul(u64::from(chunk > 0)))));
        let (index, scrambling) = ((index % Self::CHUNK) as u32, mixed as u32);
        Self {
            scrambling,
            independence: mix(mixed.wrapping_add(u64::from(index))),
            shuffled: shuffled(index, scrambling),
            set: 0,
            values: [0.0; 4],
            used: 4,
        }
    }

    /// Length of the sequence in `sobol_burley`.
    const CHUNK: u64 = 1 << 16;

    /// A number in [0, 1).
    pub fn next_1d(&mut self) -> f64 {
        let [u] = self.next();
        u
    }

    /// Two numbers in [0, 1) that are well distributed together.
    pub fn next_2d(&mut self) -> [f64; 2] {
        self.next()
    }

    /// Three numbers in [0, 1) that are well distributed together.
    pub fn next_3d(&mut self) -> [f64; 3] {
        self.next()
    }

    /// At most four numbers of one set of dimensions.
    #[inline]
    fn next<const N: usize>(&mut self) -> [f64; N] {
        if self.used + N > 4 {
            self.refill();
        }
        let used = self.used;
        self.used += N;
        std::array::from_fn(|i| f64::from(self.values[(used + i) % 4]))
    }

    fn refill(&mut self) {
        self.values = if self.set < SETS {
            values(self.shuffled, self.set, self.scrambling)
        } else {
            independent(self.independence, self.set)
        };
        self.set += 1;
        self.used = 0;
    }
}

/// Where a seed puts an index of the sequence, bits reversed. With [`values`] it is [`sobol_burley::sample_4d`], cut in two: this half is
/// the same for all sets of dimensions.
fn shuffled(index: u32, seed: u32) -> u32 {
    owen_scramble_rev(index.reverse_bits(), hash(seed ^ 0x79c6_8e4a))
}

fn values(shuffled: u32, set: u32, seed: u32) -> [f32; 4] {
    let mixed = seed.wrapping_mul(0x9c8f_2d3b) ^ set;
    let scramble =
        [0x912f_69ba, 0x174f_18ab, 0x691e_72ca, 0xb40c_c1b8].map(|dimension: u32| dimension ^ mixed);
    let [a, b, c, d] = &DIGITS[set as usize];
    let digit = |place: u32| (shuffled >> (28 - 4 * place)) as usize % 16;
    let point = a[digit(0)] ^ b[digit(1)] ^ c[digit(2)] ^ d[digit(3)];
    let scrambled = owen_scramble_int4_rev(point, hash_int4(scramble.into()));
    scrambled.reverse_bits().to_f32_norm()
}

/// Numbers that have nothing to do with those of other sets or seeds (SplitMix64: Steele, Lea, Flood 2014).
fn independent(seed: u64, set: u32) -> [f32; 4] {
    let at = |i: u64| mix(seed.wrapping_add((2 * u64::from(set) + i).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    let (a, b) = (at(0), at(1));
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32]
        .map(|bits| (bits >> 8) as f32 * (0.5 / (1 << 23) as f32))
}

/// Finaliser of SplitMix64 (Steele, Lea, Flood 2014).
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_a_product_faster_than_chance() {
        // The integral of x y over the unit square is 1/4.
        let n = 1024;
        let sum: f64 = (0..n)
            .map(|i| {
                let [x, y] = Sampler::new(7, 3, i).next_2d();
                x * y
            })
            .sum();
        assert!((sum / n as f64 - 0.25).abs() < 1e-3);
    }

    #[test]
    fn the_halves_make_the_whole() {
        let many = (0..1000u32).map(|i| (i * 65_521 % 65_536, i % SETS, i.wrapping_mul(0x9e37_79b9)));
        for (index, set, seed) in many.chain([(0, 0, 0), (65_535, SETS - 1, 0xffff_ffff)]) {
            let whole = sobol_burley::sample_4d(index, set, seed);
            assert_eq!(values(shuffled(index, seed), set, seed), whole);
        }
    }

    #[test]
    fn past_the_sequence_numbers_are_even_and_unrelated() {
        let (n, streams) = (4096, 4);
        let drawn: Vec<[f64; 8]> = (0..n * streams)
            .map(|i| {
                let mut s = Sampler::new(5, i / n, i % n);
                (0..4 * SETS).for_each(|_| _ = s.next_1d());
                std::array::from_fn(|_| s.next_1d() - 0.5)
            })
            .collect();
        let count = drawn.len() as f64;
        for i in 0..8 {
            // With itself, with the other numbers of its sample, with those of the next sample, and with those of the next stream.
            for (other, ahead) in (0..8).flat_map(|j| [(j, 0), (j, 1), (j, n as usize)]) {
                let pairs = drawn.iter().zip(drawn.iter().cycle().skip(ahead));
                let mean = pairs.map(|(a, b)| a[i] * b[other]).sum::<f64>() / count;
                let expected = if (other, ahead) == (i, 0) { 1.0 / 12.0 } else { 0.0 };
                // The deviation of a product of two is 1/12, of a square 0.075.
                assert!((mean - expected).abs() < 4.5 / 12.0 / count.sqrt(), "{i} {other} {ahead}: {mean}");
            }
            let mean = drawn.iter().map(|a| a[i]).sum::<f64>() / count;
            assert!(mean.abs() < 4.5 * (1.0 / 12.0_f64).sqrt() / count.sqrt(), "{i}: {mean}");
            assert!(drawn.iter().all(|a| (-0.5..0.5).contains(&a[i])));
        }
    }

    #[test]
    fn same_seed_same_numbers_other_stream_other_numbers() {
        let draw = |seed, stream, index| {
            let mut s = Sampler::new(seed, stream, index);
            (0..300).map(|_| s.next_1d()).collect::<Vec<_>>()
        };
        assert_eq!(draw(1, 2, 3), draw(1, 2, 3));
        assert_ne!(draw(1, 2, 3), draw(1, 3, 3));
        assert_ne!(draw(1, 2, 3), draw(1, 2, 3 + (1 << 16)));
    }
}
