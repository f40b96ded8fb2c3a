//! Angle bases of matrix BSDFs: rings of theta, each cut into equal azimuths (Klems 1994; LBNL BSDF schema).

use glam::DVec2;
use std::f64::consts::PI;
use sunpeak_core::{Error, Result, warp::square_to_disk};

/// A division of the hemisphere into patches.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleBasis {
    name: String,
    rings: Vec<Ring>,
}

/// One ring of patches.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// Lower bound of theta [deg].
    pub lower_theta_deg: f64,
    /// Upper bound of theta [deg].
    pub upper_theta_deg: f64,
    /// Number of patches; the first is centred on azimuth 0.
    pub phi_count: usize,
    first: usize,
    lower_sin2: f64,
    upper_sin2: f64,
}

/// Upper theta [deg] and number of azimuths of each ring: the bases that WINDOW and genBSDF use (Klems 1994).
const KLEMS_FULL: &[(f64, usize)] = &[
    (5.0, 1),
    (15.0, 8),
    (25.0, 16),
    (35.0, 20),
    (45.0, 24),
    (55.0, 24),
    (65.0, 24),
    (75.0, 16),
    (90.0, 12),
];
const KLEMS_HALF: &[(f64, usize)] =
    &[(6.5, 1), (19.5, 8), (32.5, 12), (45.5, 16), (58.5, 20), (71.5, 12), (90.0, 8)];
const KLEMS_QUARTER: &[(f64, usize)] = &[(9.0, 1), (27.0, 8), (45.0, 12), (63.0, 12), (90.0, 8)];

impl AngleBasis {
    /// A basis from the upper theta [deg] and the number of azimuths of each ring, from the pole outwards.
    pub fn new(name: &str, rings: &[(f64, usize)]) -> Result<Self> {
        let mut lower = 0.0;
        let mut first = 0;
        let mut built = Vec::with_capacity(rings.len());
        for &(upper, phi_count) in rings {
            if !(upper > lower && upper <= 90.0) {
                return Err(Error::value(format!(
                    "angle basis '{name}': upper theta {upper} must lie above {lower} and not above 90 degrees"
                )));
            }
            if phi_count == 0 || (phi_count == 1 && lower > 0.0) {
                return Err(Error::value(format!(
                    "angle basis '{name}': {phi_count} azimuths between theta {lower} and {upper}; expected 2 or more \
                     (1 only at the pole)"
                )));
            }
            let sin2 = |deg: f64| deg.to_radians().sin().powi(2);
            built.push(Ring {
                lower_theta_deg: lower,
                upper_theta_deg: upper,
                phi_count,
                first,
                lower_sin2: sin2(lower),
                upper_sin2: sin2(upper),
            });
            first += phi_count;
            lower = upper;
        }
        if (lower - 90.0).abs() > 1e-6 {
            return Err(Error::value(format!(
                "angle basis '{name}' ends at theta {lower}; expected 90 degrees"
            )));
        }
        Ok(Self { name: name.into(), rings: built })
    }

    /// A basis that every reader knows: `LBNL/Klems Full`, `Half` or `Quarter`, in any case.
    pub fn known(name: &str) -> Option<Self> {
        let (name, rings) = [
            ("LBNL/Klems Full", KLEMS_FULL),
            ("LBNL/Klems Half", KLEMS_HALF),
            ("LBNL/Klems Quarter", KLEMS_QUARTER),
        ]
        .into_iter()
        .find(|(known, _)| known.eq_ignore_ascii_case(name))?;
        Self::new(name, rings).ok()
    }

    /// Its name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its rings, from the pole outwards.
    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.rings.last().map_or(0, |r| r.first + r.phi_count)
    }

    /// A basis has at least one patch.
    pub fn is_empty(&self) -> bool {
        self.rings.is_empty()
    }

    /// The patch that holds the point `p` = (x, y) of the unit disk.
    #[inline]
    pub fn index(&self, p: DVec2) -> usize {
        let sin2 = p.length_squared();
        let ring = self.ring_at(sin2);
        if ring.phi_count == 1 {
            return ring.first;
        }
        let turn = p.y.atan2(p.x) / (2.0 * PI);
        // From half a turn to one and a half.
        let step = ((turn + 1.0) * ring.phi_count as f64 + 0.5) as usize;
        ring.first + if step < ring.phi_count { step } else { step - ring.phi_count }
    }

    /// The ring that holds sin²(theta).
    pub fn ring_at(&self, sin2: f64) -> &Ring {
        let last = self.rings.len() - 1;
        &self.rings[self.rings[..last].partition_point(|r| r.upper_sin2 <= sin2)]
    }

    /// The ring of a patch, and the patch's place in it.
    pub fn ring_of(&self, patch: usize) -> (&Ring, usize) {
        let ring = &self.rings[self.rings.partition_point(|r| r.first + r.phi_count <= patch)];
        (ring, patch - ring.first)
    }

    /// The patches that share a border with a patch.
    pub fn neighbours(&self, patch: usize) -> Vec<usize> {
        let (own, step) = self.ring_of(patch);
        let at = self.rings.iter().position(|r| r.first == own.first).unwrap_or(0);
        let azimuths =
            |ring: &Ring, step: usize| [-0.5, 0.5].map(|edge| (step as f64 + edge) / ring.phi_count as f64);
        let [low, high] = azimuths(own, step);
        let touches = |ring: &Ring, step: usize| {
            let [a, b] = azimuths(ring, step);
            // Azimuths as turns; edges that only touch share no border.
            [-1.0, 0.0, 1.0].iter().any(|turn| a + turn < high - 1e-9 && b + turn > low + 1e-9)
        };
        let mut found = Vec::new();
        if own.phi_count > 2 {
            found.extend([own.phi_count - 1, 1].map(|d| own.first + (step + d) % own.phi_count));
        } else if own.phi_count == 2 {
            found.push(own.first + 1 - step);
        }
        for ring in &self.rings[at.saturating_sub(1)..(at + 2).min(self.rings.len())] {
            if ring.first != own.first {
                found.extend((0..ring.phi_count).filter(|&k| touches(ring, k)).map(|k| ring.first + k));
            }
        }
        found
    }

    /// Projected solid angle of a patch [sr].
    pub fn projected_solid_angle(&self, patch: usize) -> f64 {
        let (ring, _) = self.ring_of(patch);
        PI * (ring.upper_sin2 - ring.lower_sin2) / ring.phi_count as f64
    }

    /// A point of a patch in the unit disk, uniform in projected solid angle for uniform `u`; its middle at (0.5, 0.5).
    #[inline]
    pub fn point(&self, patch: usize, u: [f64; 2]) -> DVec2 {
        self.ring_of(patch).0.point(patch, u)
    }
}

impl Ring {
    /// [`AngleBasis::point`] of a patch of this ring.
    #[inline]
    pub fn point(&self, patch: usize, u: [f64; 2]) -> DVec2 {
        if self.phi_count == 1 {
            return DVec2::from(square_to_disk(u)) * self.upper_sin2.sqrt(); // the pole: a disk, not a ring
        }
        let step = (patch - self.first) as f64;
        let phi = 2.0 * PI * (step + u[1] - 0.5) / self.phi_count as f64;
        DVec2::from_angle(phi) * self.sin2(u[0]).sqrt()
    }

    /// Index of the ring's first patch.
    pub fn first(&self) -> usize {
        self.first
    }

    /// sin² of theta below which the share `u` of the ring's projected solid angle lies.
    pub fn sin2(&self, u: f64) -> f64 {
        self.lower_sin2 + u * (self.upper_sin2 - self.lower_sin2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn klems_bases_have_their_published_sizes_and_cover_the_hemisphere() {
        for (name, patches) in [("LBNL/Klems Full", 145), ("lbnl/klems half", 77), ("LBNL/Klems Quarter", 41)]
        {
            let basis = AngleBasis::known(name).unwrap();
            assert_eq!(basis.len(), patches);
            let sum: f64 = (0..patches).map(|i| basis.projected_solid_angle(i)).sum();
            assert!((sum - PI).abs() < 1e-12);
        }
    }

    #[test]
    fn points_of_a_patch_lie_in_it() {
        let basis = AngleBasis::known("LBNL/Klems Full").unwrap();
        for patch in 0..basis.len() {
            for u in [[0.001, 0.001], [0.5, 0.5], [0.999, 0.999], [0.3, 0.9]] {
                assert_eq!(basis.index(basis.point(patch, u)), patch);
            }
        }
        assert_eq!(basis.index(DVec2::new(1.0, 1e-9)), basis.index(DVec2::new(0.999, 0.0)));
    }

    #[test]
    fn neighbours_are_mutual_and_touch() {
        for name in ["LBNL/Klems Full", "LBNL/Klems Half", "LBNL/Klems Quarter"] {
            let basis = AngleBasis::known(name).unwrap();
            for patch in 0..basis.len() {
                let around = basis.neighbours(patch);
                assert!(
                    around.iter().all(|&n| n != patch && basis.neighbours(n).contains(&patch)),
                    "{name} {patch}"
                );
                // Every point just outside an edge's middle lies in a neighbour.
                for u in [[-0.01, 0.5], [1.01, 0.5], [0.5, -0.01], [0.5, 1.01]] {
                    let (ring, step) = basis.ring_of(patch);
                    let sin2 = ring.sin2(u[0]);
                    if ring.phi_count == 1 || !(0.0..1.0).contains(&sin2) {
                        continue;
                    }
                    let phi = 2.0 * PI * (step as f64 + u[1] - 0.5) / ring.phi_count as f64;
                    let beside = basis.index(DVec2::from_angle(phi) * sin2.sqrt());
                    assert!(around.contains(&beside), "{name} {patch}: {beside}");
                }
            }
            assert_eq!(basis.neighbours(0).len(), basis.rings()[1].phi_count);
        }
    }

    #[test]
    fn a_basis_with_holes_is_refused() {
        assert!(AngleBasis::new("x", &[(10.0, 1), (80.0, 8)]).is_err());
        assert!(AngleBasis::new("x", &[(10.0, 1), (90.0, 0)]).is_err());
        assert!(AngleBasis::new("x", &[]).is_err());
    }
}
