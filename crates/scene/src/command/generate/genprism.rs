//! `genprism`: a polygon in the xy plane drawn out to a prism, with sharp or rounded edges.

use super::{Maker, count, found, real};
use crate::raw::{CommandLine, Primitive};
use sunpeak_core::Vec3;

const USAGE: &str = "genprism material name { - | file | N x1 y1 … xN yN } [-l x y z] [-r radius] [-c] [-e]";

/// What takes the place of an edge where none is stated.
const UP: Vec3 = Vec3::Z;

/// Two edges that turn back on each other by less than this share of a half turn cannot be rounded.
const SHARPEST: f64 = 1e-9;

struct Prism {
    outline: Vec<[f64; 2]>,
    extrusion: Vec3,
    /// Of rounded edges; 0 is sharp.
    radius: f64,
    /// Is the last side made?
    closed: bool,
    ends: bool,
}

pub fn run(
    args: &[String],
    command: &CommandLine,
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Primitive>, String> {
    let (mut maker, rest) = Maker::new(command, args, USAGE)?;
    let prism = Prism::parse(rest, read)?;
    if prism.radius > 0.0 {
        prism.rounded(&mut maker)?
    } else {
        prism.sharp(&mut maker)?
    }
    Ok(maker.made)
}

impl Prism {
    fn parse(args: &[String], read: &mut dyn FnMut(&str) -> Result<String, String>) -> Result<Self, String> {
        let (outline, mut at) = outline(args, read)?;
        if outline.len() < 3 {
            return Err(format!("{} vertices: expected 3 or more", outline.len()));
        }
        let mut prism = Self { outline, extrusion: UP, radius: 0.0, closed: true, ends: true };
        while let Some(option) = args.get(at) {
            at += 1;
            match option.as_str() {
                "-l" => {
                    let mut next = |what| {
                        at += 1;
                        real(args.get(at - 1), what)
                    };
                    prism.extrusion = Vec3::new(
                        next("x of the extrusion")?,
                        next("y of the extrusion")?,
                        next("z of the extrusion")?,
                    );
                }
                "-r" => {
                    prism.radius = real(args.get(at), "a radius")?;
                    at += 1;
                }
                "-c" => prism.closed = false,
                "-e" => prism.ends = false,
                word => return Err(format!("unknown option {word}: expected {USAGE}")),
            }
        }
        prism.check()?;
        Ok(prism)
    }

    fn check(&self) -> Result<(), String> {
        if self.extrusion.z == 0.0 {
            return Err(
                "the extrusion -l lies in the plane of the outline: expected a z that is not 0".into()
            );
        }
        if self.radius < 0.0 {
            return Err(format!("the radius is {}: expected 0 or more", self.radius));
        }
        let is_straight = self.extrusion.x == 0.0 && self.extrusion.y == 0.0;
        if self.radius > 0.0 && !is_straight {
            return Err("rounded edges (-r) of an oblique prism (-l) are not made: expected -l 0 0 z".into());
        }
        Ok(())
    }

    fn vertex(&self, i: usize) -> Vec3 {
        let [x, y] = self.outline[i];
        Vec3::new(x, y, 0.0)
    }

    fn sides(&self) -> usize {
        self.outline.len() - usize::from(!self.closed)
    }

    fn sharp(&self, maker: &mut Maker) -> Result<(), String> {
        let bottom: Vec<Vec3> = (0..self.outline.len()).map(|i| self.vertex(i)).collect();
        let top: Vec<Vec3> = bottom.iter().map(|&p| p + self.extrusion).collect();
        self.add_ends(maker, &bottom, &top)?;
        for i in 0..self.sides() {
            let next = (i + 1) % bottom.len();
            maker.add(
                "polygon",
                &(i + 1).to_string(),
                flat(&[bottom[i], top[i], top[next], bottom[next]]),
            )?;
        }
        Ok(())
    }

    fn add_ends(&self, maker: &mut Maker, bottom: &[Vec3], top: &[Vec3]) -> Result<(), String> {
        if !self.ends {
            return Ok(());
        }
        maker.add("polygon", "b", flat(bottom))?;
        let turned: Vec<Vec3> = top.iter().rev().copied().collect();
        maker.add("polygon", "t", flat(&turned))
    }

    /// A cylinder along each edge, a sphere at each corner that bulges; the flat pieces end where the cylinders begin.
    fn rounded(&self, maker: &mut Maker) -> Result<(), String> {
        let axes = self.axes()?;
        let (radius, height) = (self.radius, self.extrusion.z);
        let lift = radius * height.signum();
        let at = |z: f64| axes.iter().map(|&p| p + z * Vec3::Z).collect::<Vec<_>>();
        self.add_ends(maker, &at(0.0), &at(height))?;
        let (low, high) = (at(lift), at(height - lift));
        if self.ends {
            self.add_edges(maker, "b", &low)?;
            self.add_edges(maker, "t", &high)?;
        }
        for i in 0..self.sides() {
            let next = (i + 1) % low.len();
            let out = -radius * self.inward(i);
            let side = [low[i], high[i], high[next], low[next]].map(|p| p + out);
            maker.add("polygon", &(i + 1).to_string(), flat(&side))?;
            if self.bulges(next) {
                maker.add("cylinder", &format!("e{}", i + 1), tube(low[next], high[next], radius))?;
            }
        }
        Ok(())
    }

    fn add_edges(&self, maker: &mut Maker, end: &str, corners: &[Vec3]) -> Result<(), String> {
        for (i, &corner) in corners.iter().enumerate() {
            let before = corners[(i + corners.len() - 1) % corners.len()];
            if self.bulges(i) {
                let sphere = [corner.to_array().as_slice(), &[self.radius]].concat();
                maker.add("sphere", &format!("{end}c{}", i + 1), sphere)?;
            }
            maker.add("cylinder", &format!("{end}e{}", i + 1), tube(before, corner, self.radius))?;
        }
        Ok(())
    }

    /// Unit vector across the side that begins at a vertex, to where the program takes the solid to be: the right hand of who
    /// walks along the outline, when the extrusion goes up.
    fn inward(&self, i: usize) -> Vec3 {
        let along = self.along(i) * self.extrusion.z.signum();
        Vec3::new(along.y, -along.x, 0.0)
    }

    fn along(&self, i: usize) -> Vec3 {
        let point = |i: usize| self.vertex(i % self.outline.len());
        (point(i + 1) - point(i)).normalize_or_zero()
    }

    /// Does the outline turn to the inside at a vertex?
    fn bulges(&self, i: usize) -> bool {
        let before = (i + self.outline.len() - 1) % self.outline.len();
        self.along(before).cross(self.along(i)).z * self.extrusion.z < 0.0
    }

    /// Where the axes of the rounded edges meet: the outline moved in by the radius.
    fn axes(&self) -> Result<Vec<Vec3>, String> {
        let count = self.outline.len();
        let axis = |i: usize| {
            let (before, after) = (self.inward((i + count - 1) % count), self.inward(i));
            let turn = 1.0 + before.dot(after);
            if turn.is_nan() || turn < SHARPEST || before.length() < 0.5 || after.length() < 0.5 {
                return Err(format!("the outline turns back at vertex {}: it cannot be rounded", i + 1));
            }
            Ok(self.vertex(i) + self.radius / turn * (before + after))
        };
        (0..count).map(axis).collect()
    }
}

/// The vertices, and how many words they took.
fn outline(
    args: &[String],
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<(Vec<[f64; 2]>, usize), String> {
    let first = args.first().ok_or_else(|| format!("expected {USAGE}"))?;
    if first == "-" {
        return Err("vertices on standard input (-): a scene has none; put them into a file".into());
    }
    if !first.starts_with(|c: char| c.is_ascii_digit()) {
        let text = read(first)?;
        let words: Vec<String> = text.split_whitespace().map(String::from).collect();
        return Ok((pairs(&words, words.len() / 2)?, 1));
    }
    let vertices = count(Some(first), "the number of vertices")?;
    if args.len() < 1 + 2 * vertices {
        return Err(format!("{vertices} vertices: expected as many pairs of x and y, found {}", found(None)));
    }
    Ok((pairs(&args[1..], vertices)?, 1 + 2 * vertices))
}

fn pairs(words: &[String], vertices: usize) -> Result<Vec<[f64; 2]>, String> {
    let pair = |i: usize| {
        Ok([real(words.get(2 * i), "x of a vertex")?, real(words.get(2 * i + 1), "y of a vertex")?])
    };
    (0..vertices).map(pair).collect()
}

fn tube(from: Vec3, to: Vec3, radius: f64) -> Vec<f64> {
    let mut reals = flat(&[from, to]);
    reals.push(radius);
    reals
}

fn flat(points: &[Vec3]) -> Vec<f64> {
    points.iter().flat_map(|p| p.to_array()).collect()
}
