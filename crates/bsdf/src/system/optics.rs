//! What layers do to light that keeps its direction: four numbers a direction, and how two layers become one.

/// Straight transmittance and mirror reflectance [-] of a layer at one direction: for light from outside (0), from inside (1).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Optics {
    /// Transmittance.
    pub t: [f64; 2],
    /// Reflectance.
    pub r: [f64; 2],
}

/// Two mirrors that absorb nothing keep light for ever; this much is lost on each round.
pub(super) const LEAST_LOSS: f64 = 1e-9;

/// One over what is lost on a round between two mirrors: the sum of all rounds.
fn rounds(outer: f64, inner: f64) -> f64 {
    1.0 / (1.0 - outer * inner).max(LEAST_LOSS)
}

impl Optics {
    /// Nothing there.
    pub const CLEAR: Self = Self { t: [1.0; 2], r: [0.0; 2] };

    /// This layer outside, another inside of it, with all reflections between them (Stokes 1862).
    pub fn then(self, inner: Self) -> Self {
        let gain = rounds(self.r[1], inner.r[0]);
        Self {
            t: [self.t[0] * inner.t[0] * gain, inner.t[1] * self.t[1] * gain],
            r: [
                self.r[0] + self.t[0] * inner.r[0] * self.t[1] * gain,
                inner.r[1] + inner.t[1] * self.r[1] * inner.t[0] * gain,
            ],
        }
    }

    /// The other side out.
    pub fn flipped(self) -> Self {
        let [[t0, t1], [r0, r1]] = [self.t, self.r];
        Self { t: [t1, t0], r: [r1, r0] }
    }

    /// Largest difference of any of the numbers.
    pub fn distance(&self, other: &Self) -> f64 {
        let pairs = self.t.iter().zip(&other.t).chain(self.r.iter().zip(&other.r));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// A sum with weights.
    pub fn mean(each: impl IntoIterator<Item = (f64, Self)>) -> Self {
        let mut sum = Self::default();
        for (weight, optics) in each {
            for side in 0..2 {
                sum.t[side] += weight * optics.t[side];
                sum.r[side] += weight * optics.r[side];
            }
        }
        sum
    }
}

/// Straight light around one layer of a stack: `outer` is all that lies outside of it, `inner` all that lies inside.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    outer: Optics,
    own: Optics,
    inner: Optics,
}

impl Around {
    /// A layer between two stacks.
    pub fn new(outer: Optics, own: Optics, inner: Optics) -> Self {
        Self { outer, own, inner }
    }

    /// Light on the layer's two sides, all rounds, for what comes upon them first.
    fn upon(&self, first: [f64; 2]) -> [f64; 2] {
        let (back, front) = (self.outer.r[1], self.inner.r[0]);
        // u0 = first0 + back (r0 u0 + t1 u1), u1 = first1 + front (t0 u0 + r1 u1).
        let (a, b) = (1.0 - back * self.own.r[0], -back * self.own.t[1]);
        let (c, d) = (-front * self.own.t[0], 1.0 - front * self.own.r[1]);
        let determinant = (a * d - b * c).max(LEAST_LOSS);
        [(d * first[0] - b * first[1]) / determinant, (a * first[1] - c * first[0]) / determinant]
    }

    /// Light upon the layer's outer and inner side for a unit of light from a side of the whole stack.
    pub fn arriving(&self, from: usize) -> [f64; 2] {
        match from {
            0 => self.upon([self.outer.t[0], 0.0]),
            _ => self.upon([0.0, self.inner.t[1]]),
        }
    }

    /// What leaves the stack outside and inside of a unit that leaves the layer's outer (0) or inner (1) side.
    pub fn leaving(&self, side: usize) -> [f64; 2] {
        let (back, front) = (self.outer.r[1], self.inner.r[0]);
        let mut out = [0.0; 2];
        out[side] = 1.0;
        let upon = self.upon(if side == 0 { [back, 0.0] } else { [0.0, front] });
        out[0] += self.own.r[0] * upon[0] + self.own.t[1] * upon[1];
        out[1] += self.own.t[0] * upon[0] + self.own.r[1] * upon[1];
        [out[0] * self.outer.t[1], out[1] * self.inner.t[0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(k: f64) -> Optics {
        Optics { t: [0.6 + 0.05 * k, 0.58], r: [0.2 + 0.03 * k, 0.25] }
    }

    /// Every path of up to 200 events, one after the other.
    #[test]
    fn two_layers_are_the_sum_of_all_paths() {
        let (a, b) = (some(0.0), some(1.0));
        let both = a.then(b);
        let (mut t, mut r, mut between) = (0.0, a.r[0], a.t[0]);
        for _ in 0..200 {
            t += between * b.t[0];
            let back = between * b.r[0];
            r += back * a.t[1];
            between = back * a.r[1];
        }
        assert!((both.t[0] - t).abs() < 1e-12 && (both.r[0] - r).abs() < 1e-12);
        let turned = b.flipped().then(a.flipped()).flipped();
        assert!((turned.t[1] - both.t[1]).abs() < 1e-12 && (turned.r[1] - both.r[1]).abs() < 1e-12);
    }

    #[test]
    fn what_arrives_and_leaves_adds_up_to_the_stack() {
        let (outer, own, inner) = (some(0.0), some(1.0), some(2.0));
        let around = Around::new(outer, own, inner);
        let whole = outer.then(own).then(inner);
        // The layer's own reflection and transmission as if they were scattering.
        let upon = around.arriving(0);
        let bare = Around::new(outer, Optics::default(), inner);
        let first = bare.arriving(0);
        assert!(upon[0] > first[0]);
        let inside = (own.t[0] * upon[0] + own.r[1] * upon[1]) * inner.t[0];
        assert!((inside - whole.t[0]).abs() < 1e-12);
        let outside = outer.r[0] + (own.r[0] * upon[0] + own.t[1] * upon[1]) * outer.t[1];
        assert!((outside - whole.r[0]).abs() < 1e-12);
        // A unit that leaves the inner side: the part that gets out on both sides and what is absorbed is all of it.
        let [out, into] = around.leaving(1);
        assert!(out > 0.0 && into > inner.t[0] && out + into < 1.0);
    }
}
