//! How wavelengths weigh in the bands of a file, as WINDOW weighs them by default (NFRC 300-2003).

use std::sync::OnceLock;

/// A band of a BSDF file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Band {
    /// CIE 1931 standard observer, y, times illuminant D65.
    Visible,
    /// Direct sunlight at air mass 1.5 (ASTM E891-87, table 1), 0.3 to 2.5 um.
    Solar,
}

const PHOTOPIC: &str = include_str!("../../data/photopic_d65.txt");
const SUN: &str = include_str!("../../data/solar_e891.txt");

/// Visible wavelengths [um], where the visible values of a shade hold.
const VISIBLE_UM: [f64; 2] = [0.38, 0.78];

/// How far beside an edge of the visible what lies beyond it is taken [um]: more than a pane's own jump there, and no width to the sun.
const BESIDE_UM: f64 = 1e-5;

/// Is it light?
pub fn is_visible(wavelength_um: f64) -> bool {
    (VISIBLE_UM[0]..=VISIBLE_UM[1]).contains(&wavelength_um)
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    text.lines().filter(|line| !line.starts_with('#')).map(numbers).collect()
}

/// Trapezoidal weights of a curve; they add up to 1.
fn trapezoids(curve: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut weights: Vec<[f64; 2]> = curve.iter().map(|c| [c[0], 0.0]).collect();
    for i in 1..curve.len() {
        let half = 0.5 * (curve[i][0] - curve[i - 1][0]);
        weights[i - 1][1] += half * curve[i - 1][1];
        weights[i][1] += half * curve[i][1];
    }
    let sum: f64 = weights.iter().map(|w| w[1]).sum();
    weights.iter_mut().for_each(|w| w[1] /= sum);
    weights
}

/// A curve with each edge of the visible twice, on it and just outside. What a shade does jumps there: trapezoids that end on both sides
/// of the jump give the half interval inside to the visible and the half outside to the rest.
fn with_sharp_edges(curve: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let twice = |[um, value]: [f64; 2]| {
        let below = (um == VISIBLE_UM[0]).then_some([um - BESIDE_UM, value]);
        let above = (um == VISIBLE_UM[1]).then_some([um + BESIDE_UM, value]);
        below.into_iter().chain([[um, value]]).chain(above)
    };
    curve.flat_map(twice).collect()
}

impl Band {
    /// Wavelengths [um] and their weights [-], which add up to 1.
    pub fn weights(self) -> &'static [[f64; 2]] {
        static WEIGHTS: [OnceLock<Vec<[f64; 2]>>; 2] = [OnceLock::new(), OnceLock::new()];
        match self {
            Self::Visible => WEIGHTS[0].get_or_init(|| {
                let product = |row: Vec<f64>| [row[0] / 1000.0, row[1] * row[2]];
                trapezoids(&rows(PHOTOPIC).into_iter().map(product).collect::<Vec<_>>())
            }),
            Self::Solar => WEIGHTS[1].get_or_init(|| {
                trapezoids(&with_sharp_edges(rows(SUN).into_iter().map(|row| [row[0], row[1]])))
            }),
        }
    }

    /// Share of the visible wavelengths in its weights [-].
    pub fn visible_share(self) -> f64 {
        self.weights().iter().filter(|w| is_visible(w[0])).map(|w| w[1]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_add_up_and_lie_where_they_should() {
        for band in [Band::Visible, Band::Solar] {
            let sum: f64 = band.weights().iter().map(|w| w[1]).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
        // The mean wavelength of daylight to the eye lies near 555 nm.
        let mean: f64 = Band::Visible.weights().iter().map(|w| w[0] * w[1]).sum();
        assert!((mean - 0.56).abs() < 0.01, "{mean}");
    }

    /// Straight lines between the table's values, cut into fine steps of which each is visible or not.
    #[test]
    fn the_visible_share_of_the_sun_is_its_integral() {
        const STEPS: usize = 1000;
        let (mut visible, mut whole) = (0.0, 0.0);
        for pair in rows(SUN).windows(2) {
            let [a, b] = [&pair[0], &pair[1]];
            for step in 0..STEPS {
                let along = (step as f64 + 0.5) / STEPS as f64;
                let power = (a[1] + along * (b[1] - a[1])) * (b[0] - a[0]);
                whole += power;
                visible += if is_visible(a[0] + along * (b[0] - a[0])) { power } else { 0.0 };
            }
        }
        let share = visible / whole;
        assert!((share - 0.4949).abs() < 5e-5, "{share}");
        assert!((Band::Solar.visible_share() - share).abs() < 5e-5, "{}", Band::Solar.visible_share());
    }
}
