//! `genblinds`: the slats of a venetian blind, flat or bent.

use super::{Maker, count, real};
use crate::raw::{CommandLine, Primitive};

const USAGE: &str = "genblinds material name depth width height nslats angle [-r | +r radius]";

/// A bent slat has a flat piece for each so many degrees, and one for what is left.
const PIECE_DEG: f64 = 3.0;

pub fn run(args: &[String], command: &CommandLine) -> Result<Vec<Primitive>, String> {
    let (mut maker, rest) = Maker::new(command, args, USAGE)?;
    let [depth, width, height] =
        [(0, "the depth of a slat"), (1, "the width of the blind"), (2, "its height")]
            .map(|(at, what)| real(rest.get(at), what));
    let (depth, width, height) = (depth?, width?, height?);
    let slats = count(rest.get(3), "the number of slats")?;
    let angle = real(rest.get(4), "the angle of the slats")?.to_radians();
    let profile = match rest.get(5).map(String::as_str) {
        None => vec![[0.0, 0.0], [depth, 0.0]],
        Some(side @ ("-r" | "+r")) => {
            arc(depth, real(rest.get(6), "a radius")?, if side == "+r" { 1.0 } else { -1.0 })?
        }
        Some(word) => return Err(format!("unknown option {word}: expected {USAGE}")),
    };
    let (sine, cosine) = angle.sin_cos();
    for slat in 1..=slats {
        let middle = height * (slat as f64 - 0.5) / slats as f64;
        for (piece, ends) in profile.windows(2).enumerate() {
            let [near, far] = [ends[0], ends[1]]
                .map(|[along, up]| [along * cosine - up * sine, middle + along * sine + up * cosine]);
            let corners = [
                [near[0], 0.0, near[1]],
                [near[0], width, near[1]],
                [far[0], width, far[1]],
                [far[0], 0.0, far[1]],
            ];
            maker.add("polygon", &format!("{slat}.{piece}"), corners.concat())?;
        }
    }
    Ok(maker.made)
}

/// Points (along, above) the chord of an arc that bulges up (`side` 1) or down.
fn arc(chord: f64, radius: f64, side: f64) -> Result<Vec<[f64; 2]>, String> {
    if !(chord > 0.0 && 2.0 * radius >= chord) {
        return Err(format!(
            "the radius {radius} does not span a slat of depth {chord}: expected half of it or more"
        ));
    }
    let half = (chord / 2.0 / radius).asin();
    let pieces = (2.0 * half.to_degrees() / PIECE_DEG) as usize + 1;
    let point = |i: usize| {
        let turn = half * (2.0 * i as f64 / pieces as f64 - 1.0);
        [chord / 2.0 + radius * turn.sin(), side * radius * (turn.cos() - half.cos())]
    };
    Ok((0..=pieces).map(point).collect())
}
