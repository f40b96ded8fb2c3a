//! Incidences and their neighbours: on a line for isotropic samples, else triangles (Delaunay) on the disk; past the last ones towards
//! the rim their lobes go on as they moved before.

use super::{
    blend::{Corner, Links, blend, links},
    field::barycentric,
    lobes::{Lobe, Scattered},
    monotone::Monotone,
};
use delaunator::{Point, Triangulation, triangulate};
use glam::DVec2;
use rayon::prelude::*;
use std::{collections::BTreeMap, f64::consts::TAU};
use sunpeak_core::{Error, Result};

/// What is known at an incidence.
#[derive(Clone, Debug, Default)]
pub struct Node {
    /// Incident point.
    pub p: DVec2,
    /// What is scattered.
    pub scattered: Scattered,
    /// What goes straight through [-].
    pub through: f64,
}

/// All incidences with the ways between neighbours.
#[derive(Debug)]
pub struct Mesh {
    nodes: Vec<Node>,
    /// Triples of nodes; of a line pairs, with the first one twice.
    triangles: Vec<[usize; 3]>,
    links: BTreeMap<(usize, usize), Links>,
    /// Of a line: through transmittance by sine of the incidence.
    through: Option<Monotone>,
}

/// Farthest that a point beyond the rim may lie, which the last incidences are carried on to.
const FARTHEST: f64 = 1.15;

impl Mesh {
    /// Of an isotropic sample; incident points lie on the positive x axis.
    pub fn line(mut nodes: Vec<Node>) -> Self {
        nodes.sort_by(|a, b| a.p.x.total_cmp(&b.p.x));
        let through = Monotone::even(nodes.iter().map(|n| [n.p.x, n.through]).collect());
        if nodes[0].p.x > 0.0 {
            let first = &nodes[0];
            let turned = |l: &Lobe| Lobe { middle: -l.middle, ..*l };
            let lobes = first.scattered.lobes.iter().map(turned).collect();
            let background = first.scattered.background.opposite();
            let scattered = Scattered { background, lobes };
            nodes.insert(0, Node { p: -first.p, scattered, through: first.through });
        }
        match &nodes[..] {
            [.., before, last] => nodes.push(carried(last, before, DVec2::X)),
            [alone] => nodes.push(Node { p: DVec2::X, ..alone.clone() }),
            [] => {}
        }
        let triangles: Vec<[usize; 3]> = (1..nodes.len()).map(|k| [k - 1, k - 1, k]).collect();
        let links = all_links(&nodes, &triangles);
        Self { nodes, triangles, links, through: Some(through) }
    }

    /// Of a sample that is not isotropic.
    pub fn plane(mut nodes: Vec<Node>) -> Result<Self> {
        let Triangulation { triangles, hull, .. } = triangulate(&points(&nodes));
        if triangles.is_empty() {
            return Err(Error::value(format!(
                "{} incidences on one line; expected more azimuths of incidence, or symmetry isotropic",
                nodes.len()
            )));
        }
        let radius = (1.0 / (0.5 * widest_gap(&nodes, &hull)).cos()).clamp(1.0, FARTHEST);
        let beyond: Vec<Node> = hull
            .par_iter()
            .filter(|&&k| nodes[k].p.length() > 0.1)
            .map(|&k| carried(&nodes[k], inward(&nodes, k), nodes[k].p.normalize() * radius))
            .collect();
        nodes.extend(beyond);
        let triangles: Vec<[usize; 3]> =
            triangulate(&points(&nodes)).triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        let links = all_links(&nodes, &triangles);
        Ok(Self { nodes, triangles, links, through: None })
    }

    /// What is scattered at an incident point, and what goes straight through [-].
    pub fn at(&self, p: DVec2) -> (Scattered, f64) {
        let Some(through) = &self.through else {
            let (triangle, weights) = self.around(p);
            return (self.blended(triangle, weights), self.linear(triangle, weights));
        };
        let r = p.length().min(1.0);
        let (triangle, weights) = self.between(r);
        let mut scattered = self.blended(triangle, weights);
        if let Some(axis) = p.try_normalize() {
            scattered.lobes.iter_mut().for_each(|l| l.middle = axis.rotate(l.middle));
            scattered.background = scattered.background.turned(axis);
        }
        (scattered, through.at(r).max(0.0))
    }

    /// What goes straight through at an incident point [-].
    pub fn through(&self, p: DVec2) -> f64 {
        match &self.through {
            Some(through) => through.at(p.length().min(1.0)).max(0.0),
            None => {
                let (triangle, weights) = self.around(p);
                self.linear(triangle, weights)
            }
        }
    }

    fn linear(&self, triangle: usize, weights: [f64; 3]) -> f64 {
        let corners = self.triangles[triangle];
        (0..3).map(|k| weights[k] * self.nodes[corners[k]].through).sum::<f64>().max(0.0)
    }

    fn blended(&self, triangle: usize, weights: [f64; 3]) -> Scattered {
        let corners = self.triangles[triangle];
        let corner = |k: usize| Corner {
            node: corners[k],
            scattered: &self.nodes[corners[k]].scattered,
            weight: weights[k],
        };
        let used: Vec<Corner> = (0..3).filter(|&k| weights[k] > 0.0).map(corner).collect();
        blend(&used, |from, to| self.links.get(&(from, to)))
    }

    /// The segment of a line, with the weights of its ends.
    fn between(&self, r: f64) -> (usize, [f64; 3]) {
        let last = self.triangles.len() - 1;
        let segment = self.triangles[..last].partition_point(|t| self.nodes[t[2]].p.x <= r);
        let [_, a, b] = self.triangles[segment].map(|k| self.nodes[k].p.x);
        let t = ((r - a) / (b - a)).clamp(0.0, 1.0);
        (segment, [0.0, 1.0 - t, t])
    }

    /// The triangle at a point, or nearest to it, with the weights of its corners.
    fn around(&self, p: DVec2) -> (usize, [f64; 3]) {
        let weights = |t: &[usize; 3]| barycentric(p, t.map(|k| self.nodes[k].p));
        let least = |w: &[f64; 3]| w.iter().copied().fold(f64::INFINITY, f64::min);
        let all = self.triangles.iter().map(weights).enumerate();
        let (triangle, found) =
            all.max_by(|a, b| least(&a.1).total_cmp(&least(&b.1))).unwrap_or((0, [1.0, 0.0, 0.0]));
        let inside = found.map(|w| w.max(0.0));
        let sum: f64 = inside.iter().sum();
        (triangle, inside.map(|w| w / sum))
    }
}

fn points(nodes: &[Node]) -> Vec<Point> {
    nodes.iter().map(|n| Point { x: n.p.x, y: n.p.y }).collect()
}

/// The widest angle between neighbouring azimuths of the outermost incidences [rad].
fn widest_gap(nodes: &[Node], hull: &[usize]) -> f64 {
    let mut azimuths: Vec<f64> = hull.iter().map(|&k| nodes[k].p.y.atan2(nodes[k].p.x)).collect();
    azimuths.sort_by(f64::total_cmp);
    let around = azimuths.iter().zip(azimuths.iter().cycle().skip(1));
    around.map(|(a, b)| (b - a).rem_euclid(TAU)).fold(0.0, f64::max).min(1.5)
}

/// The incidence next to one on the way to the normal.
fn inward(nodes: &[Node], outer: usize) -> &Node {
    let p = nodes[outer].p;
    let axis = p.normalize();
    let off = |n: &&Node| {
        let d = p - n.p;
        // Beside the way counts more than along it.
        d.dot(axis).abs() + 4.0 * d.perp_dot(axis).abs()
    };
    let inner = nodes.iter().filter(|n| n.p.dot(axis) < 0.97 * p.length());
    inner.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(&nodes[outer])
}

/// An incidence carried on to a point farther out: its lobes go on as they came from the one before, fluxes stay, and what goes straight
/// through falls on as it fell.
fn carried(last: &Node, before: &Node, p: DVec2) -> Node {
    let step = last.p.distance(before.p);
    if step == 0.0 {
        return Node { p, ..last.clone() };
    }
    let on = last.p.distance(p) / step;
    let mut scattered = last.scattered.clone();
    if let Some([back, _]) = links(&last.scattered, &before.scattered) {
        for (lobe, came_from) in scattered.lobes.iter_mut().zip(back) {
            let from = came_from.iter().map(|t| t.middle * t.share).sum::<DVec2>();
            lobe.middle += (lobe.middle - from) * on;
        }
    }
    let through = (last.through + (last.through - before.through) * on).clamp(0.0, last.through);
    Node { p, scattered, through }
}

/// The links along all edges.
fn all_links(nodes: &[Node], triangles: &[[usize; 3]]) -> BTreeMap<(usize, usize), Links> {
    let mut edges: Vec<(usize, usize)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| (a.min(b), a.max(b)))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    let found: Vec<_> = edges
        .into_par_iter()
        .filter(|(a, b)| a != b)
        .filter_map(|(a, b)| Some(((a, b), links(&nodes[a].scattered, &nodes[b].scattered)?)))
        .collect();
    found.into_iter().flat_map(|((a, b), [there, back])| [((a, b), there), ((b, a), back)]).collect()
}
