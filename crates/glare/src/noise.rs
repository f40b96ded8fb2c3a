//! Where in a block of pixels its noise stands.

use crate::field::Field;
use sunpeak_scene::BlockErrors;

/// Variances of the luminance of a block's pixels [cd² m⁻⁴], in the order of [`BlockErrors::pixels`]. Pixels are independent: their
/// variances sum to that of the block's sum.
///
/// A pixel is a mean over what lies in it, which is like what lies around it: between the least luminance `m` and the largest `M` of its
/// neighbours. What lies between them and has the mean L varies by (M - L) (L - m) at most (Bhatia and Davis 2000, "A better bound on
/// the variance", American Mathematical Monthly 107(4)), and by no less where an edge goes through the pixel. Shares are in
/// proportion to it: much at the rim of a bright patch, next to nothing inside. A pixel that is not between its neighbours is so by noise
/// or by something small in it, and counts by its distance.
pub(crate) fn pixel_variances(field: &Field, errors: &BlockErrors, block: usize) -> Vec<f64> {
    let pixels: Vec<usize> = errors.pixels(block, field.width, field.height).collect();
    let whole = (errors.luminance_cd_m2[block] * pixels.len() as f64).powi(2);
    let shared = |weights: Vec<f64>| {
        let sum: f64 = weights.iter().sum();
        (sum > 0.0).then(|| weights.into_iter().map(|weight| whole * weight / sum).collect())
    };
    shared(pixels.iter().map(|&index| largest_variance(field, index)).collect())
        // Where nothing differs noise stands where light is.
        .or_else(|| shared(pixels.iter().map(|&index| field.luminance(index)).collect()))
        .unwrap_or_else(|| vec![0.0; pixels.len()])
}

/// (M - L) (L - m) of a pixel [cd² m⁻⁴].
fn largest_variance(field: &Field, index: usize) -> f64 {
    let (column, row) = (index % field.width, index / field.width);
    let around = |i: usize, end: usize| i.saturating_sub(1)..(i + 2).min(end);
    let near = around(row, field.height)
        .flat_map(|row| around(column, field.width).map(move |column| row * field.width + column))
        .filter(|&near| near != index && (field.luminance(near) > 0.0 || field.is_ahead(near)));
    let (least, largest) = near.fold((f64::INFINITY, 0.0), |(least, largest): (f64, f64), near| {
        let luminance = field.luminance(near);
        (least.min(luminance), largest.max(luminance))
    });
    let luminance = field.luminance(index);
    // A picture of one pixel has no neighbours. (What lies outside of a fisheye's circle is none.)
    if least.is_finite() { ((largest - luminance) * (luminance - least)).abs() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::testing::picture;

    /// An edge between two luminances runs through a column of pixels, of which it covers more and more: each is a mean of samples that
    /// have either luminance.
    #[test]
    fn an_edge_has_the_variance_of_its_samples() {
        let (size, edge, samples) = (16, 4, 64.0);
        let (bright, dim) = (10_000.0, 500.0);
        let covered = |row: usize| (row as f64 + 0.5) / size as f64;
        let picture = picture(size, |column, row| match column {
            0..6 => bright,
            6 => dim + covered(row) * (bright - dim),
            _ => dim,
        });
        let truth =
            |row: usize| covered(row) * (1.0 - covered(row)) * (bright - dim) * (bright - dim) / samples;
        for block_row in 0..size / edge {
            let rows = block_row * edge..(block_row + 1) * edge;
            let error = rows.clone().map(truth).sum::<f64>().sqrt() / (edge * edge) as f64;
            let errors = BlockErrors { edge, columns: size / edge, luminance_cd_m2: vec![error; 16] };
            let field = Field::new(&picture).expect("a fisheye");
            let found = pixel_variances(&field, &errors, block_row * size / edge + 1);
            for (i, variance) in found.into_iter().enumerate() {
                let expected = if i % edge == 2 { truth(rows.start + i / edge) } else { 0.0 };
                assert!(
                    (variance - expected).abs() < 1e-4 * truth(8),
                    "{block_row} {i}: {variance} {expected}"
                );
            }
        }
    }

    #[test]
    fn where_nothing_differs_the_variance_stands_where_light_is() {
        let errors = BlockErrors { edge: 4, columns: 2, luminance_cd_m2: vec![3.0; 4] };
        for (luminance, expected) in [(50.0, 9.0 * 16.0), (0.0, 0.0)] {
            let picture = picture(8, |_, _| luminance);
            let found = pixel_variances(&Field::new(&picture).expect("a fisheye"), &errors, 2);
            assert_eq!(found.len(), 16);
            assert!(found.iter().all(|variance| (variance - expected).abs() < 1e-9), "{found:?}");
        }
    }
}
