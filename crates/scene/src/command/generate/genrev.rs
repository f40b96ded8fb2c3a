//! `genrev`: a curve turned around the z axis.

use super::{
    Maker, count,
    functions::{Functions, Options},
};
use crate::raw::{CommandLine, Primitive};

const USAGE: &str = "genrev material name 'z(t)' 'r(t)' nseg [-e expr] [-f file]";

pub fn run(
    args: &[String],
    command: &CommandLine,
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Primitive>, String> {
    let (mut maker, rest) = Maker::new(command, args, USAGE)?;
    let [height, radius, segments, rest @ ..] = rest else { return Err(format!("expected {USAGE}")) };
    let segments = count(Some(segments), "the number of segments")?;
    let options = Options::parse(rest, read)?;
    super::no_flags(&options, USAGE)?;
    let curve = Functions::compile(&[height, radius], &options, None, command)?;
    let mut before = curve.at(0.0, 0.0)?;
    for i in 1..=segments {
        let now = curve.at(0.0, i as f64 / segments as f64)?;
        add_segment(&mut maker, i, [before[0], now[0]], [before[1], now[1]])?;
        before = now;
    }
    Ok(maker.made)
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
