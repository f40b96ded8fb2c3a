//! What is scattered between incidences that were measured: lobes on their way from one distribution to the next.
//!
//! Each pair of neighbours has a plan that moves the flux of one into the other at least cost, the square of the distance on the disk.
//! Between three of them a lobe of one is moved along its two plans at once, as the weights of the three say; that is done from each of
//! the three, weighted likewise, so that the outcome is the measurement itself at a corner, and depends on the two ends alone on an edge.

use super::{
    background::Background,
    lobes::{Lobe, Scattered},
    transport,
};
use glam::DVec2;

/// Where a lobe goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Share of its flux.
    pub share: f64,
    /// Middle there.
    pub middle: DVec2,
    /// Standard deviation there.
    pub sigma: f64,
}

/// Of each lobe of one distribution, where it goes in another.
pub type Links = Vec<Vec<Target>>;

/// Targets nearer than so many standard deviations are one.
const TOGETHER: f64 = 1.5;

/// The links from one distribution to another and back; none where one of them has no lobes.
pub fn links(from: &Scattered, to: &Scattered) -> Option<[Links; 2]> {
    if from.lobes.is_empty() || to.lobes.is_empty() {
        return None;
    }
    let fluxes = |s: &Scattered| s.lobes.iter().map(|l| l.flux).collect::<Vec<_>>();
    let cost = |i: usize, j: usize| from.lobes[i].middle.distance_squared(to.lobes[j].middle);
    let moves = transport::plan(&fluxes(from), &fluxes(to), cost);
    let one_way =
        |lobes: usize, other: &Scattered, ends: &dyn Fn(&transport::Move) -> (usize, usize)| -> Links {
            let mut all: Vec<Vec<(f64, Lobe)>> = vec![Vec::new(); lobes];
            for m in &moves {
                let (own, far) = ends(m);
                all[own].push((m.mass, other.lobes[far]));
            }
            all.into_iter().map(together).collect()
        };
    Some([
        one_way(from.lobes.len(), to, &|m| (m.from, m.to)),
        one_way(to.lobes.len(), from, &|m| (m.to, m.from)),
    ])
}

/// Targets that overlap as one: the blend does not tell them apart, and has fewer lobes.
fn together(mut targets: Vec<(f64, Lobe)>) -> Vec<Target> {
    let whole: f64 = targets.iter().map(|t| t.0).sum();
    targets.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut groups: Vec<Vec<(f64, Lobe)>> = Vec::new();
    for (mass, lobe) in targets {
        let near = |group: &&mut Vec<(f64, Lobe)>| {
            let first = group[0].1;
            first.middle.distance(lobe.middle) < TOGETHER * first.sigma.max(lobe.sigma)
        };
        match groups.iter_mut().find(near) {
            Some(group) => group.push((mass, lobe)),
            None => groups.push(vec![(mass, lobe)]),
        }
    }
    groups.iter().map(|group| mean(group, whole)).collect()
}

/// The Gaussian with the moments of a group.
fn mean(group: &[(f64, Lobe)], whole: f64) -> Target {
    let mass: f64 = group.iter().map(|g| g.0).sum();
    let middle = group.iter().map(|(m, l)| l.middle * *m).sum::<DVec2>() / mass;
    let square = |(m, l): &(f64, Lobe)| m * (l.sigma.powi(2) + 0.5 * l.middle.distance_squared(middle));
    let sigma = (group.iter().map(square).sum::<f64>() / mass).sqrt();
    Target { share: mass / whole, middle, sigma }
}

/// A neighbour of the incidence that is asked for, with its weight.
#[derive(Clone, Copy)]
pub struct Corner<'a> {
    /// Number in the mesh.
    pub node: usize,
    /// What was measured there.
    pub scattered: &'a Scattered,
    /// Weight; all add up to 1.
    pub weight: f64,
}

/// Corners with less weight than this have no lobes of their own in a blend.
const LEAST_WEIGHT: f64 = 1e-3;

/// Lobes with less of the flux than this are left out.
const LEAST_FLUX: f64 = 1e-6;

/// What is scattered where the corners have these weights; `links` gives the way from one node to another.
pub fn blend<'a>(corners: &[Corner], links: impl Fn(usize, usize) -> Option<&'a Links>) -> Scattered {
    let background = Background::sum(corners.iter().map(|c| (c.weight, &c.scattered.background)));
    let flux_of = |s: &Scattered| s.lobes.iter().map(|l| l.flux).sum::<f64>();
    let flux: f64 = corners.iter().map(|c| c.weight * flux_of(c.scattered)).sum();
    let bases: Vec<&Corner> =
        corners.iter().filter(|c| c.weight > LEAST_WEIGHT && !c.scattered.lobes.is_empty()).collect();
    let weights: f64 = bases.iter().map(|c| c.weight).sum();
    let mut lobes = Vec::new();
    for base in &bases {
        let scale = flux * base.weight / weights / flux_of(base.scattered);
        let others: Vec<(&Corner, &Links)> = bases
            .iter()
            .filter(|c| c.node != base.node)
            .filter_map(|c| Some((*c, links(base.node, c.node)?)))
            .collect();
        for (k, lobe) in base.scattered.lobes.iter().enumerate() {
            if lobe.flux * scale > LEAST_FLUX * flux {
                moved(lobe, scale, base.weight, k, &others, &mut lobes);
            }
        }
    }
    let kept: f64 = lobes.iter().map(|l| l.flux).sum();
    lobes.iter_mut().for_each(|l| l.flux *= flux / kept);
    Scattered { background, lobes }
}

/// A lobe on its way to the others at once: each combination of its targets.
fn moved(lobe: &Lobe, scale: f64, weight: f64, k: usize, others: &[(&Corner, &Links)], into: &mut Vec<Lobe>) {
    let own = Lobe { middle: lobe.middle * weight, sigma: lobe.sigma * weight, flux: lobe.flux * scale };
    let mut parts = vec![(own, weight)];
    for (corner, links) in others {
        let targets = &links[k];
        if targets.is_empty() {
            continue;
        }
        let along = |(part, sum): (Lobe, f64)| {
            targets.iter().map(move |t| {
                let moved = Lobe {
                    middle: part.middle + t.middle * corner.weight,
                    sigma: part.sigma + t.sigma * corner.weight,
                    flux: part.flux * t.share,
                };
                (moved, sum + corner.weight)
            })
        };
        parts = parts.into_iter().flat_map(along).collect();
    }
    // Weights of corners without lobes are missing in the sums.
    into.extend(parts.into_iter().map(|(part, sum)| Lobe {
        middle: inside(part.middle / sum),
        sigma: part.sigma / sum,
        ..part
    }));
}

/// No lobe has its middle beyond the horizon.
fn inside(middle: DVec2) -> DVec2 {
    const RIM: f64 = 0.999;
    let length = middle.length();
    if length > RIM { middle * (RIM / length) } else { middle }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lobe_at(x: f64, flux: f64) -> Scattered {
        let at = |dx: f64| Lobe { middle: DVec2::new(x + dx, 0.1), sigma: 0.05, flux: 0.25 * flux };
        Scattered {
            background: Background::even(0.1 * flux),
            lobes: [-0.06, -0.02, 0.02, 0.06].map(at).to_vec(),
        }
    }

    #[test]
    fn a_lobe_between_two_others_lies_between_them() {
        let [a, b] = [lobe_at(0.2, 0.4), lobe_at(0.6, 0.8)];
        let [there, back] = links(&a, &b).unwrap();
        let way = |from: usize, _: usize| Some(if from == 0 { &there } else { &back });
        for t in [0.0, 0.3, 0.5, 1.0] {
            let corners = [(0, &a, 1.0 - t), (1, &b, t)];
            let found =
                blend(&corners.map(|(node, scattered, weight)| Corner { node, scattered, weight }), way);
            assert!((found.flux() - ((1.0 - t) * a.flux() + t * b.flux())).abs() < 1e-12);
            let flux: f64 = found.lobes.iter().map(|l| l.flux).sum();
            let mean = found.lobes.iter().map(|l| l.middle * l.flux).sum::<DVec2>() / flux;
            assert!(mean.distance(DVec2::new(0.2 + 0.4 * t, 0.1)) < 1e-9, "{t}: {mean}");
            let spread: f64 =
                found.lobes.iter().map(|l| l.flux * l.middle.distance_squared(mean)).sum::<f64>() / flux;
            assert!((spread.sqrt() - 0.002_f64.sqrt()).abs() < 0.015, "{t}: {}", spread.sqrt());
        }
    }
}
