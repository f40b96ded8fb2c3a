//! `genrev`: a curve turned around the z axis.

use super::{
    Maker, count,
    functions::{Functions, Options},
};
use crate::raw::{CommandLine, Primitive};

const USAGE: &str = "genrev material name 'z(t)' 'r(t)' nseg [-e expr] [-f file] [-s]";

pub fn run(
    args: &[String],
    command: &CommandLine,
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Primitive>, String> {
    let (mut maker, rest) = Maker::new(command, args, USAGE)?;
    let [height, radius, segments, rest @ ..] = rest else { return Err(format!("expected {USAGE}")) };
    let segments = count(Some(segments), "the number of segments")?;
    let mut options = Options::parse(rest, read)?;
    let is_smooth = options.take_flag("-s");
    super::no_flags(&options, USAGE)?;
    let curve = Functions::compile(&[height, radius], &options, None, command)?;
    let point = |i: usize| {
        let values = curve.at(0.0, i as f64 / segments as f64)?;
        Ok::<_, String>([values[0], values[1]])
    };
    let points = (0..=segments).map(point).collect::<Result<Vec<_>, _>>()?;
    let material = maker.material.clone();
    for i in 1..=segments {
        let [[z0, r0], [z1, r1]] = [points[i - 1], points[i]];
        if is_smooth && (z0 != z1 || r0 != r1) {
            maker.material = material.clone();
            maker.add_modifier("texfunc", SMOOTH, &SMOOTHING, smoothing(&points, i))?;
            maker.material = SMOOTH.into();
        }
        add_segment(&mut maker, i, [z0, z1], [r0, r1])?;
    }
    Ok(maker.made)
}

/// The texture that every smooth piece has, each with its own numbers.
const SMOOTH: &str = "Phong";

/// What is added to the normal: outwards `A3 r + A4`, upwards `A1 z + A2`.
const SMOOTHING: [&str; 4] =
    ["Px*(A3+A4/sqrt(Px*Px+Py*Py))", "Py*(A3+A4/sqrt(Px*Px+Py*Py))", "Pz*A1+A2", "."];

/// Numbers with which the normal turns, over piece `i`, from that of the piece before to that of the next one.
fn smoothing(points: &[[f64; 2]], i: usize) -> Vec<f64> {
    let [start, end] = [points[i - 1], points[i]];
    let own = normal(start, end);
    let before = if i > 1 { normal(points[i - 2], start) } else { [0.0; 2] };
    let after = points.get(i + 1).map_or([0.0; 2], |&next| normal(end, next));
    // Heights first, then radii; where one does not change, its part of the normal is the piece's own.
    let linear = |axis: usize| {
        let length = end[axis] - start[axis];
        if length == 0.0 {
            return [0.0, own[axis]];
        }
        let slope = (after[axis] - before[axis]) / length;
        [slope, before[axis] - slope * start[axis]]
    };
    [linear(0), linear(1)].concat()
}

/// Unit normal (up, out) of a piece of the curve.
fn normal([z0, r0]: [f64; 2], [z1, r1]: [f64; 2]) -> [f64; 2] {
    let (up, out) = (r0 - r1, z1 - z0);
    let length = up.hypot(out);
    if length > 0.0 { [up / length, out / length] } else { [0.0; 2] }
}

/// Rising pieces show their outside, falling ones their inside; level ones are rings that look up where they go inwards.
fn add_segment(maker: &mut Maker, number: usize, heights: [f64; 2], radii: [f64; 2]) -> Result<(), String> {
    let ([z0, z1], [r0, r1]) = (heights, radii);
    let name = number.to_string();
    let axis = vec![0.0, 0.0, z0, 0.0, 0.0, z1];
    if z0 == z1 {
        if r0 == r1 {
            return Ok(());
        }
        let up = if r1 > r0 { -1.0 } else { 1.0 };
        return maker.add("ring", &name, vec![0.0, 0.0, z0, 0.0, 0.0, up, r0, r1]);
    }
    let kinds = if z1 > z0 { ["cylinder", "cone"] } else { ["tube", "cup"] };
    if r0 == r1 {
        return maker.add(kinds[0], &name, [axis, vec![r0]].concat());
    }
    maker.add(kinds[1], &name, [axis, vec![r0, r1]].concat())
}
