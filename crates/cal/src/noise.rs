//! Noise in three dimensions, equal to Radiance's.
//!
//! - Gradient noise: Perlin 2002, "Improving Noise" (SIGGRAPH), with the permutation of its reference implementation.
//! - Fractal noise: midpoint displacement of a cube's corners, edges, faces and centre, halved again and again.

/// Step of the differences that stand for slopes, and size of the fractal's smallest cube.
const STEP: f64 = 0.0005;

/// Perlin's permutation of 0 to 255.
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99,
    37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27,
    166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244,
    102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130,
    116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147,
    118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119,
    248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110,
    79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179,
    162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176,
    115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78,
    66, 215, 61, 156, 180,
];

/// Perlin's noise, -1 to 1.
pub(crate) fn noise(p: [f64; 3]) -> f64 {
    let cell = p.map(|x| x.floor());
    let at = [p[0] - cell[0], p[1] - cell[1], p[2] - cell[2]];
    let corner = cell.map(|x| x.rem_euclid(256.0) as usize);
    let hash = |i: usize, j: usize, k: usize| {
        let permuted = |i: usize| usize::from(PERMUTATION[i & 255]);
        permuted(permuted(permuted(corner[0] + i) + corner[1] + j) + corner[2] + k)
    };
    let value = |i: usize, j: usize, k: usize| {
        gradient(hash(i, j, k), [at[0] - i as f64, at[1] - j as f64, at[2] - k as f64])
    };
    let [u, v, w] = at.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let along_x = |j, k| mix(u, value(0, j, k), value(1, j, k));
    let along_y = |k| mix(v, along_x(0, k), along_x(1, k));
    mix(w, along_y(0), along_y(1))
}

fn mix(t: f64, a: f64, b: f64) -> f64 {
    a + t * (b - a)
}

/// Product with one of the directions to the middles of a cube's edges.
fn gradient(hash: usize, [x, y, z]: [f64; 3]) -> f64 {
    let h = hash & 15;
    let u = if h < 8 { x } else { y };
    let v = if h < 4 {
        y
    } else if h == 12 || h == 14 {
        x
    } else {
        z
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// Slope of the noise along an axis: the difference to a point a little before, as Radiance takes it.
pub(crate) fn slope(p: [f64; 3], axis: usize) -> f64 {
    let mut before = p;
    before[axis] -= STEP;
    (noise(p) - noise(before)) / STEP
}

/// Octaves that `turbulence` adds up at most: more than the sizes of double precision have.
const MAX_OCTAVES: usize = 2200;

/// Sum of what `of` gives for the noise at the sizes s, 2 s, 4 s, …, below 1.01 times those sizes.
pub(crate) fn turbulence(p: [f64; 3], smallest: f64, of: impl Fn([f64; 3]) -> f64) -> f64 {
    sizes(smallest).map(|s| of(p.map(|x| x / s)) * s).sum()
}

/// Slope of [`turbulence`].
pub(crate) fn turbulence_slope(p: [f64; 3], smallest: f64, axis: usize) -> f64 {
    let one = |s: f64| {
        let p = p.map(|x| x / s);
        let value = noise(p);
        let sign = if value > 0.0 { 1.0 } else { -f64::from(u8::from(value < 0.0)) };
        sign * slope(p, axis)
    };
    sizes(smallest).map(one).sum()
}

/// A size that never grows to 1 makes no sum: not a number.
fn sizes(smallest: f64) -> impl Iterator<Item = f64> {
    let first = if smallest > 0.0 { smallest } else { f64::NAN };
    let all = std::iter::successors(Some(first), |s| Some(2.0 * s)).take(MAX_OCTAVES);
    all.take_while(|s| s.is_nan() || *s <= 1.01).take(if smallest > 0.0 { MAX_OCTAVES } else { 1 })
}

/// Fractal noise, -1 to 1.
pub(crate) fn fractal(p: [f64; 3]) -> f64 {
    let whole = (1.0 / STEP) as i64;
    let target = p.map(|x| (whole as f64 * x) as i64);
    let mut origin = p.map(|x| (whole as f64 * x.floor()) as i64);
    let mut corners: [f64; 8] = std::array::from_fn(|c| {
        hashed(std::array::from_fn(|i| origin[i].wrapping_add(side(c, i) as i64 * whole)))
    });
    let mut size = whole;
    loop {
        let center = corners.iter().sum::<f64>() * 0.125;
        size >>= 1;
        if size == 0 {
            return center;
        }
        let middle = origin.map(|o| o.wrapping_add(size));
        let upper: [bool; 3] = std::array::from_fn(|i| target[i] > middle[i]);
        corners = octant(&corners, center, middle, size, upper);
        for i in 0..3 {
            if upper[i] {
                origin[i] = middle[i];
            }
        }
    }
}

/// Which side of a cube is corner `c` on along axis `i`?
fn side(c: usize, i: usize) -> usize {
    c >> i & 1
}

/// The corners of one eighth of a cube. A corner that lies on k of the octant's outer faces is the middle of a face of
/// the whole of dimension 3 - k, displaced.
///
/// Means of faces and edges are taken in Radiance's order: the centre first, and each face with the corner next to the
/// far end replaced by what came before it.
fn octant(whole: &[f64; 8], center: f64, middle: [i64; 3], size: i64, upper: [bool; 3]) -> [f64; 8] {
    let mut corners = *whole;
    let branch = (0..3).map(|i| usize::from(upper[i]) << i).sum::<usize>();
    let displaced = |value: f64, at: [i64; 3]| value + size as f64 * STEP * hashed(at);
    let toward = |at: i64, up: bool| if up { at.wrapping_add(size) } else { at.wrapping_sub(size) };
    corners[!branch & 7] = displaced(center, middle);
    for i in 0..3 {
        let mut at = middle;
        at[i] = toward(at[i], upper[i]);
        let sum: f64 = (0..8).filter(|c| (c ^ branch) >> i & 1 == 0).map(|c| corners[c]).sum();
        corners[!(branch ^ 1 << i) & 7] = displaced(0.25 * sum, at);
    }
    for i in 0..3 {
        let mut at = middle;
        for j in [(i + 1) % 3, (i + 2) % 3] {
            at[j] = toward(at[j], upper[j]);
        }
        let ends = corners[branch & !(1 << i)] + corners[branch | 1 << i];
        corners[branch ^ 1 << i] = displaced(0.5 * ends, at);
    }
    corners
}

/// A number from -1 to 1 for a point of the lattice (the integer noise of Hugo Elias, "Perlin Noise", 1998).
fn hashed([x, y, z]: [i64; 3]) -> f64 {
    let seed = x.wrapping_mul(17).wrapping_add(y.wrapping_mul(23)).wrapping_add(z.wrapping_mul(29));
    let s = (seed << 13) ^ seed;
    let mixed = s.wrapping_mul(s).wrapping_mul(15731).wrapping_add(789_221);
    let bits = s.wrapping_mul(mixed).wrapping_add(1_376_312_589) & 0x7fff_ffff;
    1.0 - bits as f64 / 1_073_741_824.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_nothing_on_the_lattice_and_smooth_between() {
        for p in [[0.0, 0.0, 0.0], [3.0, -7.0, 300.0], [-1.0, 5.0, 2.0]] {
            assert_eq!(noise(p), 0.0);
        }
        // At the middle of a cell all weights are 1/2: the mean of eight gradients' products, each a multiple of 1/2.
        assert_eq!((noise([0.5, 0.5, 0.5]) * 8.0).fract(), 0.0);
        let (a, b) = (noise([0.3, -0.2, 9.1]), noise([0.3 + 1e-7, -0.2, 9.1]));
        assert!(a != 0.0 && ((b - a) / 1e-7 - slope([0.3, -0.2, 9.1], 0)).abs() < 2e-3);
    }

    #[test]
    fn far_away_and_odd_numbers_are_no_panic() {
        for x in [1e300, -1e300, f64::INFINITY, f64::NAN, 9e15] {
            let _ = (noise([x, 1.0, x]), fractal([x, x, 0.5]), turbulence([x, 0.0, 0.0], 1e-300, noise));
        }
        assert!(turbulence([1.0, 2.0, 3.0], -1.0, noise).is_nan());
    }
}
