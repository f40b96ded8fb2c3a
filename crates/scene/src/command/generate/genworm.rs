//! `genworm`: a curve in space with a thickness: spheres along it, and between them the cones that touch both.

use super::{
    Maker, count,
    functions::{Functions, Options},
};
use crate::raw::{CommandLine, Primitive};
use sunpeak_core::Vec3;

const USAGE: &str = "genworm material name 'x(t)' 'y(t)' 'z(t)' 'r(t)' nseg [-e expr] [-f file]";

/// A sphere.
struct Bead {
    center: Vec3,
    radius: f64,
}

pub fn run(
    args: &[String],
    command: &CommandLine,
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Primitive>, String> {
    let (mut maker, rest) = Maker::new(command, args, USAGE)?;
    let [x, y, z, radius, segments, rest @ ..] = rest else { return Err(format!("expected {USAGE}")) };
    let segments = count(Some(segments), "the number of segments")?;
    let options = Options::parse(rest, read)?;
    super::no_flags(&options, USAGE)?;
    let curve = Functions::compile(&[x, y, z, radius], &options, None, command)?;
    let bead = |i: usize| {
        let values = curve.at(0.0, i as f64 / segments as f64)?;
        Ok::<_, String>(Bead { center: Vec3::from_slice(&values), radius: values[3] })
    };
    let mut before = bead(0)?;
    add_sphere(&mut maker, 0, &before)?;
    for i in 1..=segments {
        let now = bead(i)?;
        add_cone(&mut maker, i, &before, &now)?;
        add_sphere(&mut maker, i, &now)?;
        before = now;
    }
    Ok(maker.made)
}

fn add_sphere(maker: &mut Maker, number: usize, bead: &Bead) -> Result<(), String> {
    let reals = [bead.center.to_array().as_slice(), &[bead.radius]].concat();
    maker.add("sphere", &format!("s{number}"), reals)
}

/// The cone that touches two spheres: it meets each in a circle, at the sine of its half angle from the middle. One sphere within
/// the other has none, and its ends shrink to nothing.
fn add_cone(maker: &mut Maker, number: usize, a: &Bead, b: &Bead) -> Result<(), String> {
    let (along, name) = (b.center - a.center, format!("c{number}"));
    let distance = along.length();
    let sine = if distance > 0.0 { (b.radius - a.radius) / distance } else { 0.0 };
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let end = |bead: &Bead| bead.center - along.normalize_or_zero() * (bead.radius * sine);
    let ends = [end(a).to_array(), end(b).to_array()].concat();
    if a.radius == b.radius {
        return maker.add("cylinder", &name, [ends, vec![a.radius]].concat());
    }
    maker.add("cone", &name, [ends, vec![a.radius * cosine, b.radius * cosine]].concat())
}
