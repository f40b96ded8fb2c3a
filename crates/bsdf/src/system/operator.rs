//! What layers do to light in all directions: matrices over the patches of a basis, and how two layers become one (Klems, "A new
//! method for predicting the solar heat gain of complex fenestration systems", ASHRAE Transactions 100(1), 1994).
//!
//! Entry (o, i) is the share of the flux in patch `i` that goes on in patch `o`. What keeps its direction stands on the diagonal.

use super::optics::{LEAST_LOSS, Optics};
use ndarray::{Array2, Axis, Zip};

/// A linear map of fluxes.
#[derive(Clone, Debug)]
pub enum Operator {
    /// Every patch keeps its direction.
    Diagonal(Vec<f64>),
    /// Scattering.
    Dense(Array2<f64>),
}

use Operator::{Dense, Diagonal};

/// Rounds are summed until what is left of them is below this share of the light.
const NEGLIGIBLE: f64 = 1e-11;

/// Doublings after which even light between two mirrors has died: 2^40 rounds.
const MOST_DOUBLINGS: usize = 40;

impl Operator {
    /// This after another.
    fn times(&self, first: &Self) -> Self {
        match (self, first) {
            (Diagonal(a), Diagonal(b)) => Diagonal(a.iter().zip(b).map(|(a, b)| a * b).collect()),
            (Diagonal(a), Dense(b)) => {
                let mut product = b.clone();
                product.axis_iter_mut(Axis(0)).zip(a).for_each(|(mut row, a)| row *= *a);
                Dense(product)
            }
            (Dense(a), Diagonal(b)) => {
                let mut product = a.clone();
                product.axis_iter_mut(Axis(1)).zip(b).for_each(|(mut column, b)| column *= *b);
                Dense(product)
            }
            (Dense(a), Dense(b)) => Dense(a.dot(b)),
        }
    }

    fn plus(self, other: &Self) -> Self {
        match (self, other) {
            (Diagonal(a), Diagonal(b)) => Diagonal(a.iter().zip(b).map(|(a, b)| a + b).collect()),
            (Dense(mut a), Dense(b)) => {
                a += b;
                Dense(a)
            }
            (Dense(mut a), Diagonal(b)) => {
                a.diag_mut().iter_mut().zip(b).for_each(|(a, b)| *a += b);
                Dense(a)
            }
            (a @ Diagonal(_), b @ Dense(_)) => b.clone().plus(&a),
        }
    }

    /// All rounds of `self` before and after which light is what `first` made of it: (1 - self)^-1 first, by doubling:
    /// the sum of 2^k rounds is (1 + A^(2^(k-1))) times that of half as many.
    fn rounds(self, first: Self) -> Self {
        let mut power = match self {
            Diagonal(a) => {
                return Diagonal(a.iter().map(|a| 1.0 / (1.0 - a).max(LEAST_LOSS)).collect()).times(&first);
            }
            dense @ Dense(_) => dense,
        };
        let mut sum = first;
        for _ in 0..MOST_DOUBLINGS {
            sum = power.times(&sum).plus(&sum);
            if power.most() < NEGLIGIBLE {
                break;
            }
            power = power.times(&power);
        }
        sum
    }

    /// Largest share of a patch's flux that goes on.
    fn most(&self) -> f64 {
        match self {
            Diagonal(a) => a.iter().copied().fold(0.0, f64::max),
            Dense(a) => a.sum_axis(Axis(0)).iter().copied().fold(0.0, f64::max),
        }
    }

    /// Add a share of it to a dense matrix.
    pub fn add_to(&self, sum: &mut Array2<f64>, weight: f64) {
        match self {
            Diagonal(a) => sum.diag_mut().iter_mut().zip(a).for_each(|(s, a)| *s += weight * a),
            Dense(a) => Zip::from(sum).and(a).for_each(|s, a| *s += weight * a),
        }
    }
}

/// A layer, or a stack of them: transmission and reflection for light from outside (0) and from inside (1).
#[derive(Clone, Debug)]
pub struct Operators {
    /// Transmission.
    pub t: [Operator; 2],
    /// Reflection.
    pub r: [Operator; 2],
}

impl Operators {
    /// Layers that keep all directions.
    pub fn straight(optics: &[Optics]) -> Self {
        let each = |of: &dyn Fn(&Optics) -> f64| Diagonal(optics.iter().map(of).collect());
        Self { t: [each(&|o| o.t[0]), each(&|o| o.t[1])], r: [each(&|o| o.r[0]), each(&|o| o.r[1])] }
    }

    /// Straight and scattered together.
    pub fn with(self, scattered: &[[Array2<f64>; 2]; 2]) -> Self {
        let [t0, t1] = self.t;
        let [r0, r1] = self.r;
        let dense = |from: usize, to: usize| Dense(scattered[from][to].clone());
        Self {
            t: [t0.plus(&dense(0, 1)), t1.plus(&dense(1, 0))],
            r: [r0.plus(&dense(0, 0)), r1.plus(&dense(1, 1))],
        }
    }

    /// This outside, another inside of it, with all reflections between them.
    pub fn then(&self, inner: &Self) -> Self {
        let inwards = self.r[1].times(&inner.r[0]).rounds(self.t[0].clone());
        let outwards = inner.r[0].times(&self.r[1]).rounds(inner.t[1].clone());
        Self {
            t: [inner.t[0].times(&inwards), self.t[1].times(&outwards)],
            r: [
                self.t[1].times(&inner.r[0].times(&inwards)).plus(&self.r[0]),
                inner.t[0].times(&self.r[1].times(&outwards)).plus(&inner.r[1]),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lambertian layers: every patch gets its share of the hemisphere, so that a layer is four numbers, and two of them are
    /// the four numbers of [`Optics::then`].
    #[test]
    fn diffusers_between_each_other_are_scalars() {
        let areas = [0.1, 0.3, 0.4, 0.2];
        let diffuse = |share: f64| Array2::from_shape_fn((4, 4), |(o, _)| share * areas[o]);
        let layer = |o: Optics| {
            Operators::straight(&[Optics::default(); 4])
                .with(&[[diffuse(o.r[0]), diffuse(o.t[0])], [diffuse(o.t[1]), diffuse(o.r[1])]])
        };
        let (a, b) = (Optics { t: [0.5, 0.4], r: [0.3, 0.45] }, Optics { t: [0.2, 0.3], r: [0.7, 0.6] });
        let (got, want) = (layer(a).then(&layer(b)), a.then(b));
        let hemispherical = |operator: &Operator| {
            let Dense(m) = operator else { unreachable!() };
            m.sum_axis(Axis(0))[2]
        };
        for side in 0..2 {
            assert!((hemispherical(&got.t[side]) - want.t[side]).abs() < 1e-10);
            assert!((hemispherical(&got.r[side]) - want.r[side]).abs() < 1e-10);
        }
    }

    /// Straight layers stay straight, and a layer that scatters nothing changes nothing of that.
    #[test]
    fn straight_layers_are_their_optics() {
        let optics = [0.0, 0.5, 1.0].map(|k| Optics { t: [0.7 - 0.1 * k, 0.6], r: [0.2, 0.3 + 0.05 * k] });
        let inner = [Optics { t: [0.8, 0.7], r: [0.1, 0.15] }; 3];
        let both = Operators::straight(&optics).then(&Operators::straight(&inner));
        let nothing = || Array2::zeros((3, 3));
        let dense = Operators::straight(&optics)
            .with(&[[nothing(), nothing()], [nothing(), nothing()]])
            .then(&Operators::straight(&inner));
        for i in 0..3 {
            let want = optics[i].then(inner[i]);
            let (Diagonal(t), Dense(d)) = (&both.t[0], &dense.t[0]) else { unreachable!() };
            assert!((t[i] - want.t[0]).abs() < 1e-12 && (d[[i, i]] - want.t[0]).abs() < 1e-10);
            let (Diagonal(r), Dense(d)) = (&both.r[1], &dense.r[1]) else { unreachable!() };
            assert!((r[i] - want.r[1]).abs() < 1e-12 && (d[[i, i]] - want.r[1]).abs() < 1e-10);
        }
    }
}
