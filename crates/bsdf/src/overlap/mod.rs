//! How much of one division of the hemisphere lies in each cell of another, exactly: what flux a cell hands over to which.

mod polygon;

use crate::{basis::AngleBasis, table::Columns};
use glam::DVec2;
pub use polygon::Polygon;

/// Shares of less than this [sr] are rounding.
const NOTHING_SR: f64 = 1e-14;

/// A part of the hemisphere, as polygons in the quadrants of the disk.
pub type Region = Vec<Polygon>;

/// Cells that a region lies over, each once, with the projected solid angle [sr] that they share.
pub type Shares = Vec<(u32, f64)>;

impl Columns {
    /// The region of a cell.
    pub fn region(&self, cell: usize) -> Region {
        let pieces: Region = match self {
            Self::Square { side } => {
                let edges = |k: usize| [k, k + 1].map(|e| 2.0 * e as f64 / *side as f64 - 1.0);
                let ([a0, a1], [b0, b1]) = (edges(cell / side), edges(cell % side));
                let square = [(a0, b0), (a1, b0), (a1, b1), (a0, b1)];
                let of = |quadrant: usize| {
                    let corners = square.map(|(a, b)| into_quadrant(quadrant, a, b));
                    Polygon::new(quadrant, &corners).between_azimuths([-1.0, 1.0])
                };
                // The lines of azimuth -1 and 1 bound the opposite quadrant, too.
                (0..4).map(of).map(|p| p.clipped(DVec2::NEG_X, 0.0)).collect()
            }
            Self::Radial { side } => {
                let radius = |c: usize| (1.0 - 2.0 * c as f64 / *side as f64).max(0.0);
                let radii = [radius(cell + 1), radius(cell)];
                (0..4).map(|quadrant| Polygon::sector(quadrant, radii, [-1.0, 1.0])).collect()
            }
            Self::Patches(basis) => {
                let (ring, step) = basis.ring_of(cell);
                let radii = [ring.sin2(0.0).sqrt(), ring.sin2(1.0).sqrt()];
                let width = 8.0 / ring.phi_count as f64;
                let edges = [-0.5, 0.5].map(|e| (step as f64 + e) * width);
                sectors(radii, edges)
            }
        };
        pieces.into_iter().filter(|p| !p.is_empty()).collect()
    }

    /// What a region shares with each cell.
    pub fn shares(&self, region: &[Polygon]) -> Shares {
        let mut shares = Shares::new();
        for piece in region {
            self.add_shares(piece, &mut |cell, shared| {
                if shared > NOTHING_SR {
                    shares.push((cell as u32, shared));
                }
            });
        }
        shares.sort_unstable_by_key(|s| s.0);
        shares.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        shares
    }

    fn add_shares(&self, piece: &Polygon, add: &mut impl FnMut(usize, f64)) {
        match self {
            Self::Square { side } => square_shares(*side, piece, add),
            Self::Radial { side } => {
                let half = 0.5 * *side as f64;
                let [low, high] = piece.range(|c| (1.0 - c.x) * half);
                for ring in cells(low, high, side / 2) {
                    let radius = |c: usize| 1.0 - c as f64 / half;
                    let part = piece.between(DVec2::X, [radius(ring + 1), radius(ring)]);
                    add(ring, part.projected_solid_angle());
                }
            }
            Self::Patches(basis) => patch_shares(basis, piece, add),
        }
    }
}

/// The part of a region between two azimuths [turns of 45 degrees], the second at most 8 more.
pub fn between_azimuths(region: &[Polygon], edges: [f64; 2]) -> Region {
    let pieces = region.iter().flat_map(|piece| {
        in_quadrant(piece.quadrant, edges).into_iter().map(|ts| piece.between_azimuths(ts))
    });
    pieces.filter(|p| !p.is_empty()).collect()
}

/// The parts of a quadrant's azimuths t that lie between two azimuths.
fn in_quadrant(quadrant: usize, edges: [f64; 2]) -> Vec<[f64; 2]> {
    let middle = 2.0 * quadrant as f64;
    let turns = [-16.0, -8.0, 0.0, 8.0, 16.0].map(|turn| edges.map(|e| e - middle + turn));
    let inside = turns.map(|[low, high]| [low.max(-1.0), high.min(1.0)]);
    inside.into_iter().filter(|[low, high]| low < high).collect()
}

fn sectors(radii: [f64; 2], edges: [f64; 2]) -> Region {
    let of = |quadrant: usize| {
        in_quadrant(quadrant, edges).into_iter().map(move |ts| Polygon::sector(quadrant, radii, ts))
    };
    (0..4).flat_map(of).collect()
}

/// A point of the square of side 2 in a quadrant's coordinates.
fn into_quadrant(quadrant: usize, a: f64, b: f64) -> DVec2 {
    match quadrant {
        0 => DVec2::new(a, b),
        1 => DVec2::new(b, -a),
        2 => DVec2::new(-a, -b),
        _ => DVec2::new(-b, a),
    }
}

/// Whole numbers of cells that bounds in cells touch.
fn cells(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    (low.max(0.0) as usize).min(count)..(high.ceil().max(0.0) as usize).min(count)
}

fn square_shares(side: usize, piece: &Polygon, add: &mut impl FnMut(usize, f64)) {
    let half = 0.5 * side as f64;
    // The square's axes as the quadrant has them.
    let [along_a, along_b] = match piece.quadrant {
        0 => [DVec2::X, DVec2::Y],
        1 => [DVec2::NEG_Y, DVec2::X],
        2 => [DVec2::NEG_X, DVec2::NEG_Y],
        _ => [DVec2::Y, DVec2::NEG_X],
    };
    let edges = |k: usize| [k, k + 1].map(|e| e as f64 / half - 1.0);
    let grid = |axis: DVec2| move |c: DVec2| (axis.dot(c) + 1.0) * half;
    let [low, high] = piece.range(grid(along_a));
    for i in cells(low, high, side) {
        let strip = piece.between(along_a, edges(i));
        if strip.is_empty() {
            continue;
        }
        let [low, high] = strip.range(grid(along_b));
        for j in cells(low, high, side) {
            add(i * side + j, strip.between(along_b, edges(j)).projected_solid_angle());
        }
    }
}

fn patch_shares(basis: &AngleBasis, piece: &Polygon, add: &mut impl FnMut(usize, f64)) {
    let middle = 2.0 * piece.quadrant as f64;
    let [near, far] = piece.range(|c| c.x);
    for ring in basis.rings() {
        let radii = [ring.sin2(0.0).sqrt(), ring.sin2(1.0).sqrt()];
        if far <= radii[0] || near >= radii[1] {
            continue;
        }
        let band = piece.between(DVec2::X, radii);
        if band.is_empty() {
            continue;
        }
        if ring.phi_count == 1 {
            add(ring.first(), band.projected_solid_angle());
            continue;
        }
        let width = 8.0 / ring.phi_count as f64;
        // At the pole there is no azimuth; the other corners bound it.
        let [low, high] = band.range(|c| if c.x > 1e-12 { c.y / c.x } else { f64::NAN });
        let step = |t: f64| ((t + middle) / width + 0.5).floor() as i64;
        for k in step(low)..=step(high) {
            let edges = [-0.5, 0.5].map(|e| (k as f64 + e) * width - middle);
            let patch = ring.first() + k.rem_euclid(ring.phi_count as i64) as usize;
            add(patch, band.between_azimuths(edges).projected_solid_angle());
        }
    }
}

#[cfg(test)]
mod tests;
