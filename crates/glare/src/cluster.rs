//! Pixels that belong together: single linkage with a largest gap.
//!
//! Two glaring pixels are one source if a chain of glaring pixels leads from one to the other with no gap wider than half
//! of the search angle (the "opening angle" of the search areas in the evalglare manual page).

use crate::field::FieldPixel;
use std::collections::HashMap;

/// Groups of pixels, in the order of their first pixels. `pixels` are in picture order.
pub(crate) fn clusters(pixels: &[FieldPixel], width: usize, gap_rad: f64) -> Vec<Vec<FieldPixel>> {
    let chord = 2.0 * (gap_rad.min(std::f64::consts::PI) / 2.0).sin();
    let mut sets = DisjointSets::new(pixels.len());
    join_neighbours(pixels, width, chord, &mut sets);
    join_over_gaps(pixels, chord, &mut sets);

    let mut groups: Vec<Vec<FieldPixel>> = Vec::new();
    let mut group_of_root = HashMap::new();
    for (i, pixel) in pixels.iter().enumerate() {
        let group = *group_of_root.entry(sets.root(i)).or_insert(groups.len());
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(*pixel);
    }
    groups
}

/// Join pixels that touch in the picture: nearly all the work in large sources, in one pass.
fn join_neighbours(pixels: &[FieldPixel], width: usize, chord: f64, sets: &mut DisjointSets) {
    let mut above = 0;
    for (i, pixel) in pixels.iter().enumerate() {
        if i > 0 && pixels[i - 1].index + 1 == pixel.index && pixel.index % width > 0 {
            join_if_near(pixels, i, i - 1, chord, sets);
        }
        // Both rows are walked along together.
        while pixels[above].index + width < pixel.index {
            above += 1;
        }
        if pixels[above].index + width == pixel.index {
            join_if_near(pixels, i, above, chord, sets);
        }
    }
}

fn join_if_near(pixels: &[FieldPixel], i: usize, j: usize, chord: f64, sets: &mut DisjointSets) {
    if is_near(&pixels[i], &pixels[j], chord) {
        sets.join(i, j);
    }
}

/// Join pixels over gaps. Directions are sorted into cubes whose diagonal is the largest gap, so that a cube holds one
/// source only, and only cubes up to two apart need a closer look.
fn join_over_gaps(pixels: &[FieldPixel], chord: f64, sets: &mut DisjointSets) {
    let cubes = cubes(pixels, chord / 3.0_f64.sqrt());
    for members in cubes.values() {
        members.iter().for_each(|&member| sets.join(members[0], member));
    }
    for (key, members) in &cubes {
        for other in cubes_around(key).filter_map(|other| cubes.get(&other)) {
            if sets.root(members[0]) != sets.root(other[0]) && any_near(pixels, members, other, chord) {
                sets.join(members[0], other[0]);
            }
        }
    }
}

/// The pixels in each cube of directions.
fn cubes(pixels: &[FieldPixel], edge: f64) -> HashMap<[i32; 3], Vec<usize>> {
    let mut cubes: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
    let key = |pixel: &FieldPixel| (pixel.direction / edge).floor().to_array().map(|k| k as i32);
    let mut first = 0;
    while first < pixels.len() {
        // Pixels of a row mostly follow each other in the same cube.
        let here = key(&pixels[first]);
        let end = first + pixels[first..].iter().take_while(|pixel| key(pixel) == here).count();
        cubes.entry(here).or_default().extend(first..end);
        first = end;
    }
    cubes
}

/// Half of the cubes up to two steps away (the other half asks from its side).
fn cubes_around(&[x, y, z]: &[i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    let steps = -2..=2;
    let all = steps.clone().flat_map(move |i| {
        let steps = -2..=2;
        steps.flat_map(move |j| (-2..=2).map(move |k| [i, j, k]))
    });
    all.filter(|step| *step > [0, 0, 0]).map(move |[i, j, k]| [x + i, y + j, z + k])
}

fn any_near(pixels: &[FieldPixel], a: &[usize], b: &[usize], chord: f64) -> bool {
    a.iter().any(|&i| b.iter().any(|&j| is_near(&pixels[i], &pixels[j], chord)))
}

fn is_near(a: &FieldPixel, b: &FieldPixel, chord: f64) -> bool {
    a.direction.distance_squared(b.direction) <= chord * chord
}

/// Union-find with path halving.
struct DisjointSets {
    parent: Vec<usize>,
}

impl DisjointSets {
    fn new(n: usize) -> Self {
        Self { parent: (0..n).collect() }
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// The smaller index becomes the root, whatever the order of joins.
    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.root(i), self.root(j));
        self.parent[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Vec3;

    fn pixel(index: usize, angle_rad: f64) -> FieldPixel {
        let (sin, cos) = angle_rad.sin_cos();
        FieldPixel {
            index,
            direction: Vec3::new(sin, cos, 0.0),
            solid_angle_sr: 1e-4,
            luminance_cd_m2: 1e4,
            cosine: cos,
        }
    }

    fn sizes(angles: &[f64], gap: f64) -> Vec<usize> {
        let pixels: Vec<_> = angles.iter().enumerate().map(|(i, &a)| pixel(7 * i, a)).collect();
        clusters(&pixels, 1000, gap).iter().map(Vec::len).collect()
    }

    /// As evalglare does: five spots 0.09 rad apart are one source, 0.11 rad apart they are five.
    #[test]
    fn chains_hold_up_to_the_gap() {
        let chain = |step: f64| -> Vec<f64> { (0..5).map(|i| f64::from(i) * step).collect() };
        assert_eq!(sizes(&chain(0.09), 0.1), [5]);
        assert_eq!(sizes(&chain(0.11), 0.1), [1; 5]);
    }

    #[test]
    fn groups_stand_in_the_order_of_their_first_pixel() {
        assert_eq!(sizes(&[0.0, 1.0, 0.05, 1.05, 1.1], 0.1), [2, 3]);
        assert!(sizes(&[], 0.1).is_empty());
    }

    /// Against all pairs, on a spiral of directions.
    #[test]
    fn agrees_with_the_plain_way() {
        let n = 300;
        let pixels: Vec<_> = (0..n)
            .map(|i| {
                let z = 1.0 - 2.0 * ((i * 37) % n) as f64 / n as f64;
                let phi = (i * i) as f64 * 0.37;
                let r = (1.0 - z * z).max(0.0).sqrt();
                FieldPixel { direction: Vec3::new(r * phi.cos(), r * phi.sin(), z), ..pixel(3 * i, 0.0) }
            })
            .collect();
        for gap in [0.02, 0.08, 0.12, 0.2, 0.7] {
            let chord = 2.0 * (gap / 2.0_f64).sin();
            let mut sets = DisjointSets::new(n);
            for i in 0..n {
                for j in 0..i {
                    if is_near(&pixels[i], &pixels[j], chord) {
                        sets.join(i, j);
                    }
                }
            }
            let roots = (0..n).filter(|&i| sets.root(i) == i).count();
            assert_eq!(clusters(&pixels, 10_000, gap).len(), roots, "{gap}");
        }
    }
}
